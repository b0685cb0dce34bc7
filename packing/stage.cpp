#include "packing/stage.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.hpp"
#include "packing/energy_watch.hpp"

namespace pelletlab::packing {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t longest_batch = 50;  // steps between two looks at the interrupt flag
constexpr double report_interval = 0.2;      // [s] of wall time

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Steps from `done` to the next multiple of `interval`; 0 stands for «never».
std::uint64_t steps_to_next(std::uint64_t done, std::uint64_t interval) {
    return interval == 0 ? std::numeric_limits<std::uint64_t>::max() : interval - done % interval;
}

class Reporter {
public:
    Reporter(const Stage& stage, const solver::Simulation& simulation, const ProgressSink& sink, std::uint64_t begin)
        : stage_(stage), simulation_(simulation), sink_(sink), begin_(begin) {}

    void report(std::uint64_t done, std::uint64_t total, bool last) {
        if (!sink_) return;
        const double wall = seconds_since(start_);
        if (!last && wall - reported_at_ < report_interval) return;
        reported_at_ = wall;
        const double step = simulation_.definition().time_step;
        Progress progress;
        progress.stage = stage_.name;
        progress.done = static_cast<double>(done) * step;
        progress.total = static_cast<double>(total) * step;
        progress.unit = "s of simulated time";
        progress.rate = wall > 0.0 ? static_cast<double>(done - begin_) * static_cast<double>(simulation_.bodies().size()) / wall : 0.0;
        progress.rate_unit = "pellet-steps/s";
        if (stage_.note) progress.note = stage_.note();
        if (!last && done > begin_) {
            const double left = wall * static_cast<double>(total - done) / static_cast<double>(done - begin_);
            progress.note += (progress.note.empty() ? "" : ", ") + std::string("at most ") + std::to_string(std::llround(left)) + " s left";
        }
        sink_(progress);
    }

private:
    const Stage& stage_;
    const solver::Simulation& simulation_;
    const ProgressSink& sink_;
    std::uint64_t begin_;  // steps that a resumed run had behind it
    Clock::time_point start_ = Clock::now();
    double reported_at_ = 0.0;
};

}  // namespace

std::uint64_t steps_in(double time, double step) {
    return static_cast<std::uint64_t>(std::max<long long>(1, std::llround(time / step)));
}

Course::Course(solver::Simulation& simulation, ProgressSink progress, RunKeeping keeping)
    : simulation_(simulation), progress_(std::move(progress)), keeping_(std::move(keeping)) {
    if (!keeping_.from) return;
    simulation_.restore(keeping_.from->simulation, "checkpoint");
    meter = keeping_.from->meter;
    frames_stored_ = static_cast<std::size_t>(keeping_.from->frames);
}

void Course::open(FrameSink frames, const Frame& first) {
    frames_ = std::move(frames);
    if (!is_catching_up()) store(first);
}

void Course::store(const Frame& frame) {
    if (frames_) frames_(frame);
    ++frames_stored_;
}

void Course::keep(const Stage& stage, std::uint64_t done) {
    if (keeping_.keep) keeping_.keep({simulation_.checkpoint(), ended_, done, stage.memory, frames_stored_, meter});
}

StageEnd Course::run(Stage& stage) {
    const double step = simulation_.definition().time_step;
    const std::uint64_t total = stage.duration > 0.0 ? steps_in(stage.duration, step) : 0;
    const std::uint64_t frame_every = stage.frame_interval > 0.0 ? steps_in(stage.frame_interval, step) : 0;
    const std::uint64_t watch_every = stage.watch_interval > 0.0 ? steps_in(stage.watch_interval, step) : 0;
    std::uint64_t done = 0;
    if (keeping_.from) {
        const RunCheckpoint& from = *keeping_.from;
        if (ended_.size() < from.ended.size()) {
            ended_.push_back(from.ended[ended_.size()]);
            return ended_.back();
        }
        done = from.done;
        stage.memory = from.memory;
        keeping_.from.reset();
        if (done >= total) throw bad_input("the checkpoint lies behind the end of its stage", "start the run again with --force", {"checkpoint"});
    }
    Reporter reporter(stage, simulation_, progress_, done);
    EnergyWatch energy(simulation_);
    StageEnd end = StageEnd::time_is_up;
    bool stored = done == 0 || (frame_every > 0 && done % frame_every == 0);  // whatever there was before the stage has been stored by its owner
    while (done < total && end == StageEnd::time_is_up) {
        if (interrupt_requested() || (keeping_.due && keeping_.due())) keep(stage, done);
        throw_if_interrupted();
        const std::uint64_t batch = std::min({longest_batch, total - done, steps_to_next(done, frame_every), steps_to_next(done, watch_every)});
        const Clock::time_point start = Clock::now();
        simulation_.advance(batch);
        meter.wall_seconds += seconds_since(start);
        meter.steps += batch;
        done += batch;
        stored = false;
        if (watch_every > 0 && done % watch_every == 0) {
            const double overlap = simulation_.contacts().largest_overlap_ratio;
            meter.largest_overlap_ratio = std::max(meter.largest_overlap_ratio, overlap);
            energy.look(simulation_, overlap);
            if (stage.watch && stage.watch(simulation_, stage.memory)) end = StageEnd::watch_ended_it;
        }
        if (frame_every > 0 && done % frame_every == 0) {
            store(capture_frame(simulation_, pellets_in_all));
            stored = true;
        }
        reporter.report(done, total, false);
    }
    if (!stored) store(capture_frame(simulation_, pellets_in_all));
    reporter.report(done, end == StageEnd::watch_ended_it ? done : total, true);
    ended_.push_back(end);
    return end;
}

}  // namespace pelletlab::packing
