// Contact events in checkpoints: a run that goes on from one has the spectra of the unbroken run, bit for bit.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/detail/checkpoint_bytes.hpp"
#include "solver/detail/contact_recorder.hpp"

namespace pelletlab::solver::detail {

namespace {

/// By their keys: bytes do not depend on where bodies lie.
void put_events(CheckpointWriter& w, const std::vector<OpenEvent>& events) {
    std::vector<OpenEvent> open;
    std::copy_if(events.begin(), events.end(), std::back_inserter(open), [](const OpenEvent& e) { return e.goes_on(); });
    std::sort(open.begin(), open.end(), [](const OpenEvent& a, const OpenEvent& b) { return a.key < b.key; });
    w.put(static_cast<std::uint64_t>(open.size()));
    for (const OpenEvent& event : open) w.put(event);
}

std::vector<OpenEvent> get_events(CheckpointReader& r, std::uint64_t steps) {
    std::vector<OpenEvent> events(r.get_count(sizeof(OpenEvent)));
    for (OpenEvent& event : events) {
        event = r.get<OpenEvent>();
        const bool sound = event.goes_on() && event.since <= steps && std::isfinite(event.impact) && std::isfinite(event.normal) && std::isfinite(event.total);
        if (!sound) r.broken();
    }
    return events;
}

ContactEvents get_kind(CheckpointReader& r) {
    const auto kind = r.get<ContactEvents>();
    bool sound = std::isfinite(kind.complete) && std::isfinite(kind.duration) && std::isfinite(kind.dissipated) && std::isfinite(kind.dissipated_complete);
    for (const EventSpectrum& spectrum : kind.spectra)
        for (std::size_t bin = 0; bin < spectrum_bins; ++bin) sound = sound && std::isfinite(spectrum.count[bin]) && std::isfinite(spectrum.energy[bin]);
    if (!sound) r.broken();
    return kind;
}

}  // namespace

void put_recorder(CheckpointWriter& w, const ContactRecorder& recorder) {
    w.put(recorder.started);
    if (recorder.started == 0) return;
    for (const ContactEvents& kind : recorder.kinds) w.put(kind);
    put_events(w, recorder.pairs);
    for (const auto& events : recorder.walls) put_events(w, events);
}

ContactRecorder get_recorder(CheckpointReader& r, std::size_t wall_count, std::uint64_t steps, std::size_t bodies) {
    ContactRecorder recorder;
    recorder.started = r.get<std::uint64_t>();
    if (recorder.started == 0) return recorder;
    if (recorder.started > steps + 1) r.broken();
    for (std::size_t k = 0; k < 1 + wall_count; ++k) recorder.kinds.push_back(get_kind(r));
    recorder.pairs = get_events(r, steps);
    for (const OpenEvent& event : recorder.pairs)
        if ((event.key >> 32) >= bodies || (event.key & 0xffffffffU) >= bodies) r.broken();
    for (std::size_t k = 0; k < wall_count; ++k) {
        std::vector<OpenEvent> events(bodies);
        for (const OpenEvent& event : get_events(r, steps)) {
            if (event.key >= bodies) r.broken();
            events[event.key] = event;
        }
        recorder.walls.push_back(std::move(events));
    }
    recorder.seen_rebuilds = std::numeric_limits<std::uint64_t>::max();  // brings the pairs' events to their records in the next step
    return recorder;
}

}  // namespace pelletlab::solver::detail
