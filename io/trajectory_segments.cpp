#include "io/trajectory_segments.hpp"

#include <cstdio>
#include <system_error>
#include <utility>

#include "core/error.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

namespace fs = std::filesystem;

fs::path piece_file(const fs::path& folder, std::size_t index) {
    char name[40];
    std::snprintf(name, sizeof name, "frames.%04zu.h5", index);
    return folder / name;
}

/// A piece repeats no mesh: how many bodies and walls there are is all that its frames need.
TrajectoryHeader without_meshes(const TrajectoryHeader& header) {
    TrajectoryHeader small = header;
    for (PelletShape& shape : small.shapes) shape.surface_body = {};
    for (WallShape& wall : small.walls) wall.mesh = {};
    return small;
}

void remove_piece(const fs::path& file) {
    std::error_code ignored;
    fs::remove(file, ignored);
    fs::remove(fs::path(file) += ".part", ignored);
}

}  // namespace

SegmentedTrajectoryWriter::SegmentedTrajectoryWriter(fs::path folder, const TrajectoryHeader& header, std::size_t frames)
    : folder_(std::move(folder)), header_(header) {
    for (std::size_t found = 0; found < frames; ++closed_) {
        const fs::path file = piece_file(folder_, closed_);
        const bool there = fs::exists(file);
        if (there) found += open_trajectory(file)->frame_count();
        if (!there || found > frames)
            throw bad_input("the stored frames do not fit the checkpoint beside them", "start the run again with --force", {file.string()});
    }
    for (std::size_t k = closed_; fs::exists(piece_file(folder_, k)) || fs::exists(fs::path(piece_file(folder_, k)) += ".part"); ++k)
        remove_piece(piece_file(folder_, k));
}

SegmentedTrajectoryWriter::~SegmentedTrajectoryWriter() = default;

void SegmentedTrajectoryWriter::append(const Frame& frame) {
    if (!open_) open_ = std::make_unique<TrajectoryWriter>(piece_file(folder_, closed_), closed_ == 0 ? header_ : without_meshes(header_));
    open_->append(frame);
}

void SegmentedTrajectoryWriter::secure() {
    if (!open_) return;
    open_->finish();
    open_.reset();
    bring_to_disk(piece_file(folder_, closed_++));
}

void SegmentedTrajectoryWriter::finish(const fs::path& file) {
    secure();
    if (closed_ == 1) {
        std::error_code failure;
        fs::remove(file, failure);
        fs::create_hard_link(piece_file(folder_, 0), file, failure);
        if (!failure) return;  // some file systems have no links: then it is copied
    }
    TrajectoryWriter whole(file, header_);
    for (std::size_t k = 0; k < closed_; ++k) {
        const auto piece = open_trajectory(piece_file(folder_, k));
        for (std::size_t f = 0; f < piece->frame_count(); ++f) whole.append(piece->frame(f));
    }
    whole.finish();
}

SegmentedFrames::SegmentedFrames(const fs::path& folder) {
    for (std::size_t k = 0; fs::exists(piece_file(folder, k)); ++k) pieces_.push_back(open_trajectory(piece_file(folder, k)));
}

std::size_t SegmentedFrames::frame_count() const {
    std::size_t count = 0;
    for (const auto& piece : pieces_) count += piece->frame_count();
    return count;
}

Frame SegmentedFrames::frame(std::size_t index) const {
    for (const auto& piece : pieces_) {
        if (index < piece->frame_count()) return piece->frame(index);
        index -= piece->frame_count();
    }
    throw bad_input("the stored frames end before the checkpoint beside them", "start the run again with --force");
}

}  // namespace pelletlab::io
