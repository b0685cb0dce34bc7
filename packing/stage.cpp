#include "packing/stage.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace pelletlab::packing {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t longest_batch = 50;  // steps between two looks at the interrupt flag
constexpr double report_interval = 0.2;      // [s] of wall time

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Whole steps in a time; at least one.
std::uint64_t steps_in(double time, double step) {
    return static_cast<std::uint64_t>(std::max<long long>(1, std::llround(time / step)));
}

/// Steps from `done` to the next multiple of `interval`; 0 stands for «never».
std::uint64_t steps_to_next(std::uint64_t done, std::uint64_t interval) {
    return interval == 0 ? std::numeric_limits<std::uint64_t>::max() : interval - done % interval;
}

class Reporter {
public:
    Reporter(const Stage& stage, const solver::Simulation& simulation, const ProgressSink& sink) : stage_(stage), simulation_(simulation), sink_(sink) {}

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
        progress.rate = wall > 0.0 ? static_cast<double>(done) * static_cast<double>(simulation_.bodies().size()) / wall : 0.0;
        progress.rate_unit = "pellet-steps/s";
        if (stage_.note) progress.note = stage_.note();
        if (!last && done > 0) {
            const double left = wall * static_cast<double>(total - done) / static_cast<double>(done);
            progress.note += (progress.note.empty() ? "" : ", ") + std::string("at most ") + std::to_string(std::llround(left)) + " s left";
        }
        sink_(progress);
    }

private:
    const Stage& stage_;
    const solver::Simulation& simulation_;
    const ProgressSink& sink_;
    Clock::time_point start_ = Clock::now();
    double reported_at_ = 0.0;
};

}  // namespace

StageEnd run_stage(solver::Simulation& simulation, const Stage& stage, const FrameSink& frames, const ProgressSink& progress, RunMeter& meter) {
    const double step = simulation.definition().time_step;
    const std::uint64_t total = stage.duration > 0.0 ? steps_in(stage.duration, step) : 0;
    const std::uint64_t frame_every = stage.frame_interval > 0.0 ? steps_in(stage.frame_interval, step) : 0;
    const std::uint64_t watch_every = stage.watch_interval > 0.0 ? steps_in(stage.watch_interval, step) : 0;
    Reporter reporter(stage, simulation, progress);
    StageEnd end = StageEnd::time_is_up;
    std::uint64_t done = 0;
    bool stored = true;  // whatever there was before the stage has been stored by its owner
    while (done < total && end == StageEnd::time_is_up) {
        throw_if_interrupted();
        const std::uint64_t batch = std::min({longest_batch, total - done, steps_to_next(done, frame_every), steps_to_next(done, watch_every)});
        const Clock::time_point start = Clock::now();
        simulation.advance(batch);
        meter.wall_seconds += seconds_since(start);
        meter.steps += batch;
        done += batch;
        stored = false;
        if (watch_every > 0 && done % watch_every == 0) {
            meter.largest_overlap_ratio = std::max(meter.largest_overlap_ratio, simulation.contacts().largest_overlap_ratio);
            if (stage.watch && stage.watch(simulation)) end = StageEnd::watch_ended_it;
        }
        if (frame_every > 0 && done % frame_every == 0) {
            if (frames) frames(capture_frame(simulation));
            stored = true;
        }
        reporter.report(done, total, false);
    }
    if (!stored && frames) frames(capture_frame(simulation));
    reporter.report(done, end == StageEnd::watch_ended_it ? done : total, true);
    return end;
}

}  // namespace pelletlab::packing
