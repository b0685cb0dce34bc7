// From what a file says to the template the solver uses.
#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/error.hpp"
#include "shapegen/formats/formats.hpp"

namespace pelletlab::shapegen::formats {

namespace {

/// Axes (columns) along which `inertia` is diagonal: the file's own ones where they are principal to 1e-9 already, else its eigenvectors.
Mat3 principal_axes(const Mat3& inertia) {
    const Mat3 off_diagonal = inertia - Mat3(inertia.diagonal().asDiagonal());
    if (off_diagonal.cwiseAbs().maxCoeff() <= 1e-9 * inertia.cwiseAbs().maxCoeff()) return Mat3::Identity();
    const double scale = inertia.cwiseAbs().maxCoeff();
    Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(inertia / scale).eigenvectors();
    for (int k = 0; k < 3; ++k) {  // largest component positive: the same frame whatever the solver's signs
        Eigen::Index largest = 0;
        axes.col(k).cwiseAbs().maxCoeff(&largest);
        if (axes(largest, k) < 0.0) axes.col(k) *= -1.0;
    }
    if (axes.determinant() < 0.0) axes.col(1) *= -1.0;
    return axes;
}

}  // namespace

RigidTemplate rigid_template(const ImportedClump& clump, std::optional<double> density) {
    if (clump.spheres.empty()) throw bad_input("the imported clump has no spheres", "read it again");
    if (density && !(std::isfinite(*density) && *density > 0.0)) throw bad_input("the density must be positive", {});
    if (!density) density = clump.density;
    std::optional<double> mass = clump.mass;
    if (!mass && clump.volume && density) mass = *clump.volume * *density;
    std::optional<Mat3> inertia = clump.inertia;
    if (!inertia && clump.unit_density_inertia && density) inertia = Mat3(*clump.unit_density_inertia * *density);
    if (!mass || !inertia)
        throw bad_input(std::string("the imported clump has no ") + (!mass ? "mass" : "inertia"),
                        "read its companion file too, or compute the mass properties from the spheres or from the mesh");
    if (!clump.volume && !density) throw bad_input("the imported clump has neither volume nor density", "give the density");

    RigidTemplate rigid;
    rigid.name = clump.name;
    MassProperties& properties = rigid.mass_properties;
    properties.mass = *mass;
    properties.volume = clump.volume ? *clump.volume : *mass / *density;
    properties.density = properties.mass / properties.volume;
    properties.centre_of_mass_mesh = clump.centre_of_mass.value_or(Vec3::Zero());
    const Mat3 axes = principal_axes(*inertia);
    properties.principal_axes = Quat(axes).normalized();
    properties.principal_inertia = (axes.transpose() * *inertia * axes).diagonal();
    rigid.spheres = clump.spheres;
    for (Sphere& sphere : rigid.spheres) sphere.centre = axes.transpose() * (sphere.centre - properties.centre_of_mass_mesh);
    rigid.bounding_radius = bounding_radius(rigid.spheres);
    return rigid;
}

}  // namespace pelletlab::shapegen::formats
