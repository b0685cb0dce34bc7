#include "apps/observe_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "apps/print_observables.hpp"
#include "apps/stage.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "io/files.hpp"
#include "io/observables_file.hpp"
#include "report/pictures.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

double given(const std::string& text, Dimension dimension, double otherwise) {
    return text.empty() ? otherwise : parse_quantity(text, dimension);
}

double needed(const std::string& text, Dimension dimension, const std::optional<double>& of_case, const char* option, const char* what) {
    if (!text.empty()) return parse_quantity(text, dimension);
    if (!of_case) throw usage_error(fmt::format("{} is not known", what), fmt::format("give it with {}", option));
    return *of_case;
}

const Case* case_of(const OpenedTrajectory& opened, Rig rig) {
    if (!opened.resolved_case) return nullptr;
    if (opened.resolved_case->rig != rig)
        throw usage_error("this is a run of a " + rig_name(opened.resolved_case->rig),
                          "observe it with: pelletlab observe " + rig_name(opened.resolved_case->rig));
    return &*opened.resolved_case;
}

TimeWindow window_of(const ObserveRequest& request, const FrameSource& frames, double begin) {
    if (frames.frame_count() == 0) throw bad_input("the trajectory holds no frame", "run the case again", {request.trajectory.file.string()});
    TimeWindow window{given(request.from, dimension::time, begin), given(request.until, dimension::time, frames.time(frames.frame_count() - 1))};
    if (!(window.begin <= window.end)) throw usage_error("the window ends before it begins", "give --from a time before --until");
    return window;
}

void finish(const ObserveRequest& request, const char* rig, const OpenedTrajectory& opened, const std::function<Observables()>& measure,
            const ObservedPictures& pictures) {
    const Stopwatch stopwatch;
    StageKey key;
    key.verb = std::string("observe ") + rig;
    key.settings = request.settings();
    key.inputs = opened.inputs;
    if (const fs::path of_run = request.trajectory.file.parent_path() / "observables.json"; opened.resolved_case && fs::exists(of_run))
        key.inputs["observables of the run"] = io::sha256_of_file(of_run);
    const fs::path folder = request.output.empty() ? fs::path("observed") : request.output;
    if (!request.force && stage_is_finished(folder, key)) {
        print_line(folder.string() + " is up to date (same trajectory, same options, same program)");
        return;
    }
    StageFolder stage(folder);
    Observables observables = measure();
    throw_if_interrupted();
    const std::uint64_t seed = observables.provenance.seed;
    observables.provenance = provenance_of(key, seed);
    print_observables(observables);
    io::write_observables(observables, stage.unfinished() / "observables.json");
    if (!observables.profiles.empty()) io::write_profiles(observables, stage.unfinished() / "profiles.csv");
    if (request.pictures && pictures) pictures(observables, stage.unfinished());
    throw_if_interrupted();
    std::vector<std::string> written;
    for (const auto& entry : fs::directory_iterator(stage.unfinished()))
        if (entry.is_regular_file()) written.push_back(entry.path().filename().string());
    std::sort(written.begin(), written.end());
    stage.finish(key);
    for (const std::string& file : written)
        print_written(folder / file, file.ends_with(".png")   ? "picture"
                                     : file.ends_with(".csv") ? "profiles as a table"
                                                              : "measured values, profiles and maps");
    print_line("  took " + duration_text(stopwatch.seconds()));
}

void write_map(const Observables& observables, const char* map, double circle, const fs::path& file) {
    for (const FieldMap& one : observables.maps)
        if (one.name == map) {
            report::PictureSettings settings;
            settings.circle_diameter = circle;
            report::write_png(report::picture_of_map(observables, map, settings), file);
        }
}

void write_chart(const std::optional<report::Chart>& chart, const fs::path& file) {
    if (chart) report::write_png(report::picture_of_chart(*chart, {}), file);
}

std::optional<Observables> observables_beside(const fs::path& trajectory) {
    const fs::path file = trajectory.parent_path() / "observables.json";
    if (!fs::exists(file)) return std::nullopt;
    return io::read_observables(file);
}

}  // namespace pelletlab::apps
