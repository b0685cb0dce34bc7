#include "report/animation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "core/error.hpp"
#include "report/colour_bar.hpp"
#include "report/detail/bed_scene.hpp"

namespace pelletlab::report {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure || !fs::is_directory(folder)) throw bad_input("the folder for the pictures cannot be made: " + failure.message(), {}, {folder.string()});
}

fs::path numbered(const fs::path& folder, const std::string& stem, std::size_t number) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "_%05zu.png", number);
    return folder / (stem + digits);
}

void tell(const ProgressSink& progress, std::size_t done, std::size_t total) {
    if (progress) progress({"drawing", static_cast<double>(done), static_cast<double>(total), "pictures", 0.0, {}, {}});
}

double wall_floor(const TrajectoryHeader& header, const Frame& frame) {
    const Box walls = detail::wall_box(header, frame);
    return walls.isEmpty() ? 0.0 : walls.min().z();
}

/// Tube: as high as any pellet ever is, coloured by height over the last frame's bed, so that the settled bed uses the whole colour map.
void fix_tube(const FrameSource& trajectory, const std::vector<std::size_t>& frames, PictureSettings& picture) {
    const TrajectoryHeader& header = trajectory.header();
    double pellet = 0.0;
    for (const PelletShape& shape : header.shapes) pellet = std::max(pellet, detail::shape_radius(shape));
    double top = -std::numeric_limits<double>::infinity(), bed = 0.0;
    for (const std::size_t index : frames) {
        const Frame frame = trajectory.frame(index);
        bed = 0.0;
        for (const Vec3& position : frame.positions) {
            top = std::max(top, position.z() + 2.0 * pellet);
            bed = std::max(bed, position.z() - wall_floor(header, frame));
        }
    }
    if (!picture.view_top && std::isfinite(top)) picture.view_top = top;
    if (!picture.range) picture.range = ValueRange{0.0, bed > 0.0 ? round_up(bed / 1e-3) * 1e-3 : 1e-3};
}

/// Drum: the widest of the ranges that the single frames would take.
void fix_drum(const FrameSource& trajectory, const std::vector<std::size_t>& frames, PictureSettings& picture) {
    if (picture.range) return;
    ValueRange widest{0.0, 0.0};
    for (const std::size_t index : frames) {
        std::vector<double> speeds;
        for (const Vec3& velocity : trajectory.frame(index).velocities) speeds.push_back(velocity.norm());
        if (std::all_of(speeds.begin(), speeds.end(), [](double speed) { return speed == 0.0; })) continue;
        widest.upper = std::max(widest.upper, detail::automatic_range(speeds, 0.98).upper);
    }
    if (widest.upper > 0.0) picture.range = widest;
}

}  // namespace

std::vector<fs::path> render_animation(const FrameSource& trajectory, Subject subject, const fs::path& folder, const AnimationSettings& settings,
                                       const ProgressSink& progress) {
    if (settings.every == 0) throw bad_input("an animation of each 0th frame", "take each 1st, 2nd, …");
    std::vector<std::size_t> frames;
    for (std::size_t index = 0; index < trajectory.frame_count(); index += settings.every) frames.push_back(index);
    if (frames.empty()) throw bad_input("the trajectory to draw has no frames");
    make_folder(folder);
    PictureSettings picture = settings.picture;
    subject == Subject::tube ? fix_tube(trajectory, frames, picture) : fix_drum(trajectory, frames, picture);

    std::vector<fs::path> files;
    for (const std::size_t index : frames) {
        throw_if_interrupted();
        tell(progress, files.size(), frames.size());
        const Frame frame = trajectory.frame(index);
        const TrajectoryHeader& header = trajectory.header();
        const fs::path file = numbered(folder, settings.stem, files.size());
        write_png(subject == Subject::tube ? picture_of_tube(header, frame, picture) : picture_of_drum(header, frame, picture), file);
        files.push_back(file);
    }
    tell(progress, files.size(), frames.size());
    return files;
}

std::vector<fs::path> render_turntable(const TrajectoryHeader& header, const Frame& frame, std::size_t steps, const fs::path& folder,
                                       const AnimationSettings& settings, const ProgressSink& progress) {
    if (steps == 0) throw bad_input("a turntable of no pictures");
    make_folder(folder);
    std::vector<fs::path> files;
    for (std::size_t step = 0; step < steps; ++step) {
        throw_if_interrupted();
        tell(progress, step, steps);
        PictureSettings picture = settings.picture;
        picture.azimuth += 2.0 * std::numbers::pi * static_cast<double>(step) / static_cast<double>(steps);
        const fs::path file = numbered(folder, settings.stem, step);
        write_png(picture_of_tube(header, frame, picture), file);
        files.push_back(file);
    }
    tell(progress, steps, steps);
    return files;
}

}  // namespace pelletlab::report
