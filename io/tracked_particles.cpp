#include "io/tracked_particles.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>

#include "core/error.hpp"
#include "io/detail/track_rates.hpp"
#include "io/detail/tracked_columns.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

using detail::Table;
using detail::TrackedColumns;
using detail::TrackedRow;
using R = detail::TrackedRole;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Rows in the order of time; a frame is filled from its rows when it is asked for.
class TrackedSource final : public FrameSource {
public:
    TrajectoryHeader head;
    std::vector<TrackedRow> rows;
    std::vector<std::size_t> first_row;  ///< (times + 1)

    const TrajectoryHeader& header() const override { return head; }
    std::size_t frame_count() const override { return first_row.size() - 1; }
    double time(std::size_t index) const override { return rows[first_row.at(index)].time; }
    Frame frame(std::size_t index) const override {
        const std::size_t bodies = head.shape_of_body.size();
        Frame frame;
        frame.time = time(index);
        frame.positions.assign(bodies, Vec3::Constant(nan));
        frame.orientations.assign(bodies, Quat::Identity());
        frame.velocities.assign(bodies, Vec3::Constant(nan));
        frame.spins.assign(bodies, Vec3::Zero());
        for (std::size_t k = first_row[index]; k < first_row[index + 1]; ++k) {
            const TrackedRow& row = rows[k];
            frame.positions[row.body] = row.position;
            frame.orientations[row.body] = row.orientation;
            frame.velocities[row.body] = row.velocity;
            frame.spins[row.body] = row.spin;
        }
        return frame;
    }
};

class Reading {
public:
    Reading(Table& table, const TrackedSettings& settings) : table_(table), settings_(settings), columns_(detail::tracked_columns(table, settings)) {}

    TrackedParticles finish(const std::string& name) {
        read_rows();
        auto source = std::make_unique<TrackedSource>();
        summary_.rows = rows_.size();
        sort_rows();
        add_times(*source);
        add_shapes(source->head);
        detail::RateSettings rates{settings_.largest_gap, !has_velocity(), !columns_.has(R::wx) && columns_.has(R::qw)};
        const detail::RateCounts counts = detail::add_rates(rows_, bodies_.size(), rates);
        summary_.without_velocity = counts.without_velocity;
        summary_.lost = counts.missing;
        summary_.tracks = bodies_.size();
        summary_.times = source->first_row.size() - 1;
        summary_.velocities_from_file = has_velocity();
        summary_.spins_from_file = columns_.has(R::wx);
        summary_.orientations_from_file = columns_.has(R::qw) || columns_.has(R::axis_x);
        summary_.flat = !columns_.has(R::x) ? 'x' : !columns_.has(R::y) ? 'y' : !columns_.has(R::z) ? 'z' : ' ';
        summary_.ignored_columns = columns_.ignored;
        for (TrackedRow& row : rows_) to_world(row);
        source->head.case_name = std::filesystem::path(name).stem().string();
        source->rows = std::move(rows_);
        return {std::move(source), std::move(summary_)};
    }

private:
    bool has_velocity() const { return columns_.has(R::vx) || columns_.has(R::vy) || columns_.has(R::vz); }

    Vec3 vector(R x, R y, R z) const {
        const auto one = [&](R role) { return columns_.has(role) ? columns_.value(table_, role) : 0.0; };
        return {one(x), one(y), one(z)};
    }

    void read_rows() {
        while (table_.next()) {
            TrackedRow row;
            row.line = table_.place(0).line;
            row.time = columns_.value(table_, R::time);
            if (!std::isfinite(row.time)) throw bad_input("this row has no time", "fill it in or take the row out", table_.place(columns_.of(R::time).column));
            row.body = body_of_row();
            row.position = vector(R::x, R::y, R::z);
            if (!row.position.allFinite()) {
                ++summary_.rows_without_place;
                continue;
            }
            if (has_velocity()) row.velocity = vector(R::vx, R::vy, R::vz);
            if (columns_.has(R::wx)) row.spin = vector(R::wx, R::wy, R::wz);
            if (!row.spin.allFinite()) row.spin.setZero();
            row.orientation = orientation_of_row();
            note_radius(row.body);
            rows_.push_back(row);
        }
        if (rows_.empty()) throw bad_input("the table has no row with a place in it", "give one row a pellet and time", table_.header_place(0));
    }

    std::uint32_t body_of_row() {
        if (!columns_.has(R::id)) {
            bodies_.emplace("", 0);
            return 0;
        }
        const std::size_t column = columns_.of(R::id).column;
        const std::string_view text = table_.cell(column);
        if (text.empty()) throw bad_input("this row has no id", "fill it in or take the row out", table_.place(column));
        const auto [found, is_new] = bodies_.try_emplace(std::string(text), static_cast<std::uint32_t>(bodies_.size()));
        return found->second;
    }

    Quat orientation_of_row() const {
        if (columns_.has(R::qw)) {
            const Quat q(columns_.value(table_, R::qw), columns_.value(table_, R::qx), columns_.value(table_, R::qy), columns_.value(table_, R::qz));
            if (!(q.norm() > 0.5 && q.norm() < 2.0))
                throw bad_input("this row's orientation is no unit quaternion", "give qw, qx, qy, qz with qw² + qx² + qy² + qz² = 1",
                                table_.place(columns_.of(R::qw).column));
            return q.normalized();
        }
        if (columns_.has(R::axis_x)) {
            const Vec3 axis = vector(R::axis_x, R::axis_y, R::axis_z);
            if (!(axis.norm() > 0.0)) throw bad_input("this row's axis has no length", "give a direction", table_.place(columns_.of(R::axis_x).column));
            return Quat::FromTwoVectors(Vec3::UnitZ(), axis);
        }
        return Quat::Identity();
    }

    void note_radius(std::uint32_t body) {
        const bool radius = columns_.has(R::radius);
        if (!radius && !columns_.has(R::diameter)) return;
        const R role = radius ? R::radius : R::diameter;
        const double value = columns_.value(table_, role) * (radius ? 2.0 : 1.0);
        const Place place = table_.place(columns_.of(role).column);
        if (!(value > 0.0)) throw bad_input("this pellet has no size", "give a positive radius or diameter", place);
        if (body >= diameters_.size()) diameters_.resize(body + 1, nan);
        if (std::isfinite(diameters_[body]) && std::abs(diameters_[body] - value) > 1e-6 * value)
            throw bad_input(
                "the size of pellet '" + std::string(columns_.has(R::id) ? table_.cell(columns_.of(R::id).column) : "") + "' changes along its track",
                "give every pellet one size", place);
        diameters_[body] = value;
    }

    void sort_rows() {
        std::stable_sort(rows_.begin(), rows_.end(),
                         [](const TrackedRow& a, const TrackedRow& b) { return a.time < b.time || (a.time == b.time && a.body < b.body); });
        for (std::size_t k = 1; k < rows_.size(); ++k)
            if (rows_[k].time == rows_[k - 1].time && rows_[k].body == rows_[k - 1].body) {
                Place place = table_.header_place(0);
                place.line = std::max(rows_[k].line, rows_[k - 1].line);
                place.column = 1;
                throw bad_input(columns_.has(R::id) ? "two rows hold the same pellet at the same time (the other one is line " +
                                                          std::to_string(std::min(rows_[k].line, rows_[k - 1].line)) + ")"
                                                    : "several rows have the same time and there is no column of ids",
                                columns_.has(R::id) ? "take one of them out" : "name the pellets in a column 'id'", place);
            }
    }

    void add_times(TrackedSource& source) const {
        for (std::size_t k = 0; k < rows_.size(); ++k)
            if (k == 0 || rows_[k].time != rows_[k - 1].time) source.first_row.push_back(k);
        source.first_row.push_back(rows_.size());
    }

    void add_shapes(TrajectoryHeader& head) const {
        head.shape_of_body.assign(bodies_.size(), 0);
        if (settings_.pellet) {
            head.shapes = {*settings_.pellet};
            return;
        }
        if (diameters_.empty())
            throw bad_input("the table does not say how large the pellets are", "add a column 'diameter [mm]', or give --pellet-diameter or --pellet",
                            table_.header_place(0));
        std::map<double, std::uint32_t> shape_of_size;
        for (std::size_t body = 0; body < bodies_.size(); ++body) {
            const auto [found, is_new] = shape_of_size.try_emplace(diameters_.at(body), static_cast<std::uint32_t>(head.shapes.size()));
            if (is_new) head.shapes.push_back(sphere_shape(diameters_[body]));
            head.shape_of_body[body] = found->second;
        }
    }

    void to_world(TrackedRow& row) const {
        row.position = settings_.axes * (row.position - settings_.origin);
        row.velocity = settings_.axes * row.velocity;
        row.spin = settings_.axes * row.spin;
        row.orientation = Quat(settings_.axes) * row.orientation * (columns_.has(R::qw) ? settings_.body_in_file : Quat::Identity());
    }

    Table& table_;
    const TrackedSettings& settings_;
    TrackedColumns columns_;
    TrackedSummary summary_;
    std::vector<TrackedRow> rows_;
    std::unordered_map<std::string, std::uint32_t> bodies_;
    std::vector<double> diameters_;  ///< (bodies)
};

}  // namespace

PelletShape sphere_shape(double diameter) {
    if (!(diameter > 0.0) || !std::isfinite(diameter)) throw bad_input("a sphere needs a positive diameter");
    PelletShape shape;
    shape.rigid.name = "sphere";
    shape.rigid.spheres = {{Vec3::Zero(), 0.5 * diameter}};
    shape.rigid.bounding_radius = 0.5 * diameter;
    shape.rigid.mass_properties.volume = std::numbers::pi / 6.0 * diameter * diameter * diameter;
    return shape;
}

TrackedParticles parse_tracked_particles(std::string text, const std::string& file_name, const TrackedSettings& settings) {
    Table table(std::move(text), file_name);
    return Reading(table, settings).finish(file_name);
}

TrackedParticles read_tracked_particles(const std::filesystem::path& file, const TrackedSettings& settings) {
    return parse_tracked_particles(read_text(file), file.string(), settings);
}

}  // namespace pelletlab::io
