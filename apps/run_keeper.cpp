#include "apps/run_keeper.hpp"

#include <fmt/format.h>

#include <utility>

#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "io/files.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

fs::path state_file(const fs::path& folder) {
    return folder / "run.checkpoint";
}

}  // namespace

std::optional<packing::RunCheckpoint> checkpoint_to_go_on_from(const fs::path& folder, const std::string& owner, const RunRequest& request) {
    const fs::path file = state_file(folder);
    if (request.force || !fs::exists(file)) {
        if (request.resume == Resume::yes && !request.force) print_line("There is no checkpoint to go on from: the run begins at the beginning");
        return {};
    }
    std::optional<packing::RunCheckpoint> found;
    try {
        found = packing::checkpoint_from(io::read_text(file), owner, file.string());
    } catch (const Error&) {
        if (request.resume == Resume::yes) throw;
        print_line("The checkpoint in " + folder.string() + " is of another case or damaged: it is given up");
        return {};
    }
    if (request.resume == Resume::refuse)
        throw bad_input("an interrupted run of this case has left a checkpoint", "go on from it with --resume, or begin again with --force", {file.string()});
    print_line(fmt::format("Going on from the checkpoint after {} steps", found->meter.steps));
    return found;
}

RunKeeper::RunKeeper(StageFolder& stage, std::string owner, double interval, std::optional<packing::RunCheckpoint> from)
    : stage_(stage), owner_(std::move(owner)), interval_(interval), from_(std::move(from)), has_checkpoint_(from_.has_value()) {}

packing::FrameSink RunKeeper::open(const TrajectoryHeader& header) {
    writer_ = std::make_unique<io::SegmentedTrajectoryWriter>(stage_.resume_folder(), header, from_ ? static_cast<std::size_t>(from_->frames) : 0);
    stored_ = std::make_unique<io::SegmentedFrames>(stage_.resume_folder());
    return [this](const Frame& frame) { writer_->append(frame); };
}

packing::RunKeeping RunKeeper::keeping() {
    packing::RunKeeping keeping;
    keeping.due = [this] { return interval_ > 0.0 && std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count() >= interval_; };
    keeping.keep = [this](const packing::RunCheckpoint& checkpoint) { keep(checkpoint); };
    keeping.from = from_;
    keeping.stored_frame = [this](std::size_t index) { return stored_->frame(index); };
    return keeping;
}

/// First the frames, then the state that counts them: whenever the program is killed, the state on the disk finds the frames that it needs.
void RunKeeper::keep(const packing::RunCheckpoint& checkpoint) {
    writer_->secure();
    const std::string bytes = packing::to_bytes(checkpoint, owner_);
    io::write_atomically(state_file(stage_.resume_folder()), [&](const fs::path& temporary) {
        io::write_text(temporary, bytes);
        io::bring_to_disk(temporary);
    });
    stage_.keep_resume_folder();
    has_checkpoint_ = true;
    last_ = std::chrono::steady_clock::now();
}

void RunKeeper::finish(const fs::path& trajectory_file) {
    writer_->finish(trajectory_file);
}

}  // namespace pelletlab::apps
