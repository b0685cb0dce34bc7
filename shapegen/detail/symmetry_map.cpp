#include "shapegen/detail/symmetry_map.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr std::size_t most_elements = 96;
constexpr double same = 1e-9;

bool contains(const std::vector<Mat3>& list, const Mat3& m) {
    return std::any_of(list.begin(), list.end(), [&](const Mat3& other) { return (other - m).cwiseAbs().maxCoeff() < same; });
}

// Projector onto the vectors that all rows of `constraints` send to zero.
Mat3 null_projector(const Eigen::MatrixXd& constraints) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(constraints, Eigen::ComputeFullV);
    Mat3 onto = Mat3::Zero();
    for (Eigen::Index k = 0; k < 3; ++k) {
        const double value = k < svd.singularValues().size() ? svd.singularValues()[k] : 0.0;
        if (value < 1e-6) onto += svd.matrixV().col(k) * svd.matrixV().col(k).transpose();
    }
    return onto;
}

Mat3 fixed_by(const Mat3& element) {
    return null_projector(element - Mat3::Identity());
}

Mat3 common(const Mat3& a, const Mat3& b) {
    Eigen::MatrixXd rows(6, 3);
    rows << Mat3::Identity() - a, Mat3::Identity() - b;
    return null_projector(rows);
}

}  // namespace

SymmetryGroup SymmetryGroup::of(const Symmetry& symmetry) {
    std::vector<Mat3> generators;
    if (symmetry.fold == 0) throw bad_input("a symmetry of fold 0 means nothing", "give 1 for none, 2, 3, …");
    if (symmetry.fold > 1) {
        if (!(symmetry.axis.norm() > 0.0)) throw bad_input("the axis of symmetry has no direction", "give it like 0, 0, 1");
        generators.push_back(Eigen::AngleAxisd(2.0 * std::numbers::pi / static_cast<double>(symmetry.fold), symmetry.axis.normalized()).toRotationMatrix());
    }
    for (const Vec3& normal : symmetry.mirrors) {
        if (!(normal.norm() > 0.0)) throw bad_input("the normal of a mirror plane has no direction", "give it like 0, 0, 1");
        const Vec3 n = normal.normalized();
        generators.push_back(Mat3::Identity() - 2.0 * n * n.transpose());
    }
    SymmetryGroup group;
    group.elements = {Mat3::Identity()};
    for (std::size_t k = 0; k < group.elements.size(); ++k) {
        for (const Mat3& generator : generators) {
            const Mat3 product = group.elements[k] * generator;
            if (contains(group.elements, product)) continue;
            group.elements.push_back(product);
            if (group.elements.size() > most_elements) {
                throw bad_input(
                    "the axis and the mirror planes of the symmetry do not close to a group of at most " + std::to_string(most_elements) + " motions",
                    "choose planes along the axis or across it, at multiples of 180°/fold, and a smaller fold");
            }
        }
    }

    // All places: what single elements fix, and what those have in common.
    std::vector<Mat3> spaces = {Mat3::Identity()};
    for (const Mat3& element : group.elements) {
        const Mat3 fixed = fixed_by(element);
        if (!contains(spaces, fixed)) spaces.push_back(fixed);
    }
    for (std::size_t a = 0; a < spaces.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const Mat3 both = common(spaces[a], spaces[b]);
            if (!contains(spaces, both)) spaces.push_back(both);
        }
    }
    std::vector<Mat3> known;  // images of places already listed
    for (const Mat3& onto : spaces) {
        if (contains(known, onto)) continue;
        Place place;
        place.onto = onto;
        place.dimension = static_cast<int>(std::lround(onto.trace()));
        std::vector<Mat3> images;
        for (std::size_t g = 0; g < group.elements.size(); ++g) {
            const Mat3 image = group.elements[g] * onto;
            if (!contains(images, image)) {
                images.push_back(image);
                place.moves.push_back(g);
            }
            known.push_back(group.elements[g] * onto * group.elements[g].transpose());
        }
        group.places.push_back(std::move(place));
    }
    std::stable_sort(group.places.begin(), group.places.end(), [](const Place& a, const Place& b) { return a.moves.size() > b.moves.size(); });
    return group;
}

bool SymmetryGroup::can_hold(std::uint32_t spheres) const {
    std::vector<std::uint8_t> reached(spheres + 1, 0);
    reached[0] = 1;
    for (const Place& place : places) {
        const auto size = static_cast<std::uint32_t>(place.moves.size());
        if (place.dimension == 0) {  // the centre: once
            for (std::uint32_t n = spheres; n >= size; --n) {
                if (reached[n - size]) reached[n] = 1;
            }
        } else {
            for (std::uint32_t n = size; n <= spheres; ++n) {
                if (reached[n - size]) reached[n] = 1;
            }
        }
    }
    return reached[spheres] != 0;
}

Vec3 SymmetryGroup::brought_to(const Vec3& p, std::size_t place) const {
    Vec3 best = Vec3::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (const Mat3& element : elements) {
        const Vec3 moved = element * p, on = places[place].onto * moved;
        if ((moved - on).squaredNorm() < least) {
            least = (moved - on).squaredNorm();
            best = on;
        }
    }
    return best;
}

bool SymmetryGroup::in_domain(const Vec3& p) const {
    // Nearer to this direction than all its images: a Dirichlet cell.
    static const Vec3 chosen = Vec3(0.5773, 0.2139, 0.7880).normalized();
    const double mine = chosen.dot(p);
    return std::all_of(elements.begin() + 1, elements.end(), [&](const Mat3& element) { return chosen.dot(element * p) <= mine; });
}

SymmetryMap::SymmetryMap(const SymmetryGroup& group, std::vector<std::size_t> place_of_generator) : group_(group), place_(std::move(place_of_generator)) {
    for (std::size_t i = 0; i < place_.size(); ++i) {
        for (const std::size_t move : group.places[place_[i]].moves) {
            owner_.push_back(i);
            move_.push_back(move);
        }
    }
}

std::vector<Sphere> SymmetryMap::expand(std::span<const Sphere> generators) const {
    std::vector<Sphere> all(owner_.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
        const Sphere& from = generators[owner_[k]];
        all[k] = {group_.elements[move_[k]] * (group_.places[place_[owner_[k]]].onto * from.centre), from.radius};
    }
    return all;
}

std::vector<Sphere> SymmetryMap::first_of(std::span<const Sphere> all) const {
    std::vector<Sphere> generators;
    for (std::size_t k = 0; k < owner_.size(); ++k) {
        if (owner_[k] == generators.size()) {
            generators.push_back({group_.places[place_[owner_[k]]].onto * all[k].centre, all[k].radius});
        } else {
            generators.back().radius = std::min(generators.back().radius, all[k].radius);
        }
    }
    return generators;
}

VectorXd SymmetryMap::expand(const VectorXd& generators) const {
    VectorXd all(static_cast<Eigen::Index>(4 * owner_.size()));
    for (std::size_t k = 0; k < owner_.size(); ++k) {
        const auto to = static_cast<Eigen::Index>(4 * k), from = static_cast<Eigen::Index>(4 * owner_[k]);
        all.segment<3>(to) = group_.elements[move_[k]] * (group_.places[place_[owner_[k]]].onto * generators.segment<3>(from));
        all[to + 3] = generators[from + 3];
    }
    return all;
}

VectorXd SymmetryMap::reduce(const VectorXd& gradient) const {
    VectorXd result = VectorXd::Zero(static_cast<Eigen::Index>(4 * place_.size()));
    for (std::size_t k = 0; k < owner_.size(); ++k) {
        const auto from = static_cast<Eigen::Index>(4 * k), to = static_cast<Eigen::Index>(4 * owner_[k]);
        result.segment<3>(to) += group_.places[place_[owner_[k]]].onto * (group_.elements[move_[k]].transpose() * gradient.segment<3>(from));
        result[to + 3] += gradient[from + 3];
    }
    return result;
}

BlockMetric SymmetryMap::reduce(const BlockMetric& of_all) const {
    BlockMetric result;
    result.blocks.assign(place_.size(), Eigen::Matrix4d::Zero());
    for (std::size_t k = 0; k < owner_.size(); ++k) {
        Eigen::Matrix4d chain = Eigen::Matrix4d::Identity();
        chain.topLeftCorner<3, 3>() = group_.elements[move_[k]] * group_.places[place_[owner_[k]]].onto;
        result.blocks[owner_[k]] += chain.transpose() * of_all.blocks[k] * chain;
    }
    // Directions off the place have no slope; any stiffness there keeps the block invertible.
    for (std::size_t i = 0; i < place_.size(); ++i)
        result.blocks[i].topLeftCorner<3, 3>() += (result.blocks[i].trace() + 1e-12) * (Mat3::Identity() - group_.places[place_[i]].onto);
    result.scales = of_all.scales;
    for (const VectorXd& row : of_all.rows) result.rows.push_back(reduce(row));
    return result;
}

}  // namespace pelletlab::shapegen::detail
