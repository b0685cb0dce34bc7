#include "apps/run_stage.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "apps/print_observables.hpp"
#include "apps/run_keeper.hpp"
#include "apps/shape_stage.hpp"
#include "apps/stage.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "experiments/attrition_tester.hpp"
#include "experiments/effects/effects.hpp"
#include "experiments/rotating_drum.hpp"
#include "experiments/sandpile.hpp"
#include "io/case_file.hpp"
#include "io/clump_file.hpp"
#include "io/files.hpp"
#include "io/observables_file.hpp"
#include "io/paraview.hpp"
#include "io/trajectory_file.hpp"
#include "packing/fill_tube.hpp"
#include "report/pictures.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

std::string verb_of(Rig rig) {
    return rig == Rig::tube ? "fill" : rig_name(rig);
}

/// Files of a user's own walls; empty where the walls are made.
std::vector<std::string*> wall_meshes(Case& c) {
    return {&c.tube.mesh_file, &c.drum.mesh_file, &c.pile.mesh_file, &c.funnel.mesh_file, &c.tester.mesh_file, &c.tester.baffle_mesh_file};
}

StageKey key_of(const Case& c, const fs::path& clump_file) {
    StageKey key;
    key.verb = verb_of(c.rig);
    key.settings = io::resolved_case_text(c);
    key.inputs["clump"] = io::sha256_of_file(clump_file);
    Case own = c;
    for (const std::string* mesh : wall_meshes(own))
        if (!mesh->empty()) key.inputs["wall mesh " + *mesh] = io::sha256_of_file(io::path_in_case(c, *mesh));
    return key;
}

}  // namespace

std::string run_key(const Case& c) {
    const StageKey key = key_of(c, io::path_in_case(c, c.pellet.clump_file));
    std::string text = build_version() + "\n" + key.verb + "\n" + key.settings + "\n";
    for (const auto& [name, hash] : key.inputs) text += name + " " + hash + "\n";
    return io::sha256_of_text(text);
}

Case case_with_effects(const fs::path& file, const std::vector<std::string>& overrides, const std::vector<std::string>& effects) {
    Case c = io::read_case(file, overrides);
    if (effects.empty()) return c;
    for (const std::string& text : effects) {
        const auto [effect, amplitude] = experiments::parse_effect(text);
        c = experiments::with_effect(*effect, std::move(c), amplitude);
    }
    try {
        Case checked = io::parse_case(io::resolved_case_text(c), file.string());  // what the effects made is checked as what a person writes
        checked.folder = c.folder;
        return checked;
    } catch (const Error& error) {
        throw bad_input("with its effects the case is not possible: " + error.problem(), error.remedy(), {file.string()});
    }
}

namespace {

packing::RunResult run_rig(const Case& c, const packing::RunInputs& inputs, RunKeeper& keeper, const fs::path& trajectory_file) {
    const auto open_sink = [&](const TrajectoryHeader& header) { return keeper.open(header); };
    ProgressPrinter progress;
    const auto run = c.rig == Rig::tube   ? packing::fill_tube
                     : c.rig == Rig::drum ? experiments::run_drum
                     : c.rig == Rig::pile ? experiments::run_pile
                                          : experiments::run_tester;
    packing::RunResult result = run(c, inputs, open_sink, progress.sink(), keeper.keeping());
    progress.finish();
    keeper.finish(trajectory_file);
    return result;
}

using Written = std::vector<std::pair<std::string, std::string>>;  // file name in the stage's folder, what it is

void write_pictures(const Case& c, const FrameSource& trajectory, const Observables& observables, const fs::path& folder, Written& written) {
    report::PictureSettings settings;
    settings.width = c.output.picture_width;
    settings.draw_spheres = c.output.picture_spheres;
    if (c.rig == Rig::drum) settings.circle_diameter = c.drum.diameter;
    const Frame last = trajectory.frame(trajectory.frame_count() - 1);
    const std::string bed = rig_name(c.rig) + ".png";
    const auto draw = [&] {
        switch (c.rig) {
            case Rig::drum:
            case Rig::tester:
                return report::picture_of_drum(trajectory.header(), last, settings);
            case Rig::pile:
                return report::picture_of_pile(trajectory.header(), last, settings);
            case Rig::tube:
                if (c.tube.lying) return report::picture_of_drum(trajectory.header(), last, settings);
                break;
        }
        return report::picture_of_tube(trajectory.header(), last, settings);
    };
    report::write_png(draw(), folder / bed);
    written.emplace_back(bed, settings.draw_spheres ? "last frame, the clumps' spheres" : "last frame, true pellet surface");
    if (c.rig == Rig::pile && !observables.maps.empty()) {
        report::write_png(report::picture_of_map(observables, "pile_top_surface", settings), folder / "top-surface.png");
        written.emplace_back("top-surface.png", "height of the pile, seen from above");
    }
    if (c.rig == Rig::tester) {
        settings.circle_diameter = c.tester.diameter;
        settings.range = report::ValueRange{0.0, 0.6};  // one scale for all eight
        for (const FieldMap& map : observables.maps) {
            report::write_png(report::picture_of_map(observables, map.name, settings), folder / (map.name + ".png"));
            written.emplace_back(map.name + ".png", "solid fraction, baffle at " + map.name.substr(map.name.size() - 3) + " degrees");
        }
    }
    if (c.rig == Rig::drum) {
        report::write_png(report::picture_of_map(observables, "speed", settings), folder / "velocity-map.png");
        written.emplace_back("velocity-map.png", "mean velocity over the end view");
    }
}

/// The case with its relative paths turned so that they lead to the same files from `folder`.
Case as_seen_from(Case c, const fs::path& folder) {
    std::vector<std::string*> files = wall_meshes(c);
    files.push_back(&c.pellet.clump_file);
    for (std::string* file : files)
        if (!file->empty() && fs::path(*file).is_relative()) *file = fs::relative(io::path_in_case(c, *file), folder).generic_string();
    return c;
}

/// Steps the rig, measures, and puts the results in their place.
RunSummary finish_run(const Case& c, const StageKey& key, const packing::RunInputs& inputs, StageFolder& stage, RunKeeper& keeper, RunSummary summary,
                      const Stopwatch& stopwatch) {
    const fs::path& folder = stage.unfinished();
    packing::RunResult result = run_rig(c, inputs, keeper, folder / "run.h5");
    result.observables.provenance = inputs.provenance;
    print_observables(result.observables);
    if (!result.energy_book.empty()) print_line("Energy book [mJ] (docs/observables.md):");
    for (const packing::BookLine& line : result.energy_book) print_line(fmt::format("  {:<30} {:.6g}", line.name, line.value));
    io::write_text(folder / "case.resolved.toml", io::resolved_case_text(as_seen_from(c, summary.folder)));
    io::write_observables(result.observables, folder / "observables.json");
    Written written{{"run.h5", "trajectory, HDF5"}, {"observables.json", "measured values, profiles and maps"}};
    const auto trajectory = io::open_trajectory(folder / "run.h5");
    if (c.output.paraview) {
        const io::ParaviewFiles files = io::write_paraview(*trajectory, folder / "paraview", c.output.paraview_every);
        written.emplace_back("paraview/bodies.pvd", files.surface.empty()
                                                        ? "ParaView; spheres.pvd and walls.pvd beside it; too many triangles for surface-last.vtp: "
                                                          "let glyphs of pellet-0.vtp draw the pellets"
                                                        : "ParaView; spheres.pvd, walls.pvd and surface-last.vtp beside it");
    }
    if (c.output.pictures) write_pictures(c, *trajectory, result.observables, folder, written);
    throw_if_interrupted();
    stage.finish(key);
    for (const auto& [file, what] : written) print_written(summary.folder / file, what);

    summary.status = result.observables.status;
    summary.state_hash = result.state_hash;
    summary.wall_seconds = stopwatch.seconds();
    summary.pellet_steps_per_second = result.pellet_steps_per_second;
    print_line(fmt::format("  {} steps, {:.3g} pellet-steps/s, state hash {:016x}, took {}, peak memory {:.0f} MB", result.steps,
                           result.pellet_steps_per_second, result.state_hash, duration_text(summary.wall_seconds), peak_memory_megabytes()));
    return summary;
}

}  // namespace

RunSummary run_case(const RunRequest& request, Rig expected) {
    const Stopwatch stopwatch;
    const Case c = case_with_effects(request.case_file, request.overrides, request.effects);
    if (c.rig != expected)
        throw usage_error(fmt::format("'{}' is a case for the {}", request.case_file.string(), rig_name(c.rig)), "run it with: pelletlab " + verb_of(c.rig));

    const fs::path clump_file = io::path_in_case(c, c.pellet.clump_file);
    if (!fs::exists(clump_file))
        throw bad_input("the clump template '" + clump_file.string() + "' is not there",
                        "make it with: pelletlab shape MESH --unit mm -o " + clump_file.string(), {request.case_file.string()});
    packing::RunInputs inputs;
    inputs.clump = io::read_clump(clump_file);
    if (!inputs.clump.mesh_file.empty()) inputs.pellet_surface_body = true_surface(inputs.clump, clump_file);

    RunSummary summary;
    summary.folder = request.output.empty() ? fs::path("out") / c.name : request.output;
    const StageKey key = key_of(c, clump_file);
    if (!request.force && stage_is_finished(summary.folder, key)) {
        print_line(summary.folder.string() + " is up to date (same case, same clump, same program)");
        summary.status = io::read_observables(summary.folder / "observables.json").status;
        summary.was_up_to_date = true;
        return summary;
    }
    inputs.resolved_case = key.settings;
    inputs.provenance = provenance_of(key, c.seed);

    const std::string owner = key.fingerprint();
    const auto from = checkpoint_to_go_on_from(StageFolder::resume_folder_of(summary.folder), owner, request);
    StageFolder stage(summary.folder, from ? StageFolder::Leftovers::resume : StageFolder::Leftovers::remove);
    RunKeeper keeper(stage, owner, request.checkpoint_interval, from);
    try {
        return finish_run(c, key, inputs, stage, keeper, std::move(summary), stopwatch);
    } catch (const Error& error) {
        if (!keeper.has_checkpoint()) throw;
        throw Error(error.kind(), error.problem() + "; a checkpoint is kept in " + stage.resume_folder().string(),
                    (error.remedy().empty() ? "" : error.remedy() + "; ") + "--resume goes on from the checkpoint", error.place());
    }
}

}  // namespace pelletlab::apps
