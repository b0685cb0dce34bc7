#include "apps/shape_stage.hpp"

#include <fmt/format.h>

#include <span>
#include <vector>

#include "apps/shape_report.hpp"
#include "apps/shape_settings.hpp"
#include "apps/stage.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "io/clump_file.hpp"
#include "io/files.hpp"
#include "meshes/check.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/read_mesh.hpp"
#include "meshes/signed_distance.hpp"
#include "report/pictures.hpp"
#include "shapegen/baselines/baselines.hpp"
#include "shapegen/quality.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

constexpr const char* stage_hash = "stage";

StageKey key_of(const ShapeRequest& request) {
    StageKey key;
    key.verb = "shape";
    key.settings = describe(request.body) + fmt::format(" method {} volume_matched {} ", request.method, request.volume_matched) + describe(request.settings);
    key.inputs["mesh"] = hash_of(request.body);
    return key;
}

bool is_up_to_date(const ShapeRequest& request, const StageKey& key, const fs::path& picture) {
    if (request.force || !fs::exists(request.output) || (request.picture && !fs::exists(picture))) return false;
    const ClumpTemplate clump = io::read_clump(request.output);
    const auto found = clump.provenance.input_hashes.find(stage_hash);
    return found != clump.provenance.input_hashes.end() && found->second == key.fingerprint() && fs::exists(request.output.parent_path() / clump.mesh_file);
}

fs::path picture_beside(const fs::path& clump_file) {
    return stem_of(clump_file).string() + ".png";
}

std::string name_of_result(const ShapeRequest& request) {
    if (request.method == fit_method) return "fitted";
    return find_method(request.method).name + (request.volume_matched ? ", volume-matched" : "");
}

void print_quality(const ShapeRequest& request, const shapegen::MadeClump& made, const TriangleMesh& body, const meshes::SignedDistance& exact) {
    std::vector<QualityRow> rows{{name_of_result(request), made.fit.spheres.size(), made.clump.quality}};
    if (!request.against.empty()) {
        const double volume = meshes::mass_properties(body, 1.0).volume;
        for (const std::string& id : request.against) {
            const std::vector<Sphere> spheres =
                spheres_of_method(id, body, exact, static_cast<std::uint32_t>(made.fit.spheres.size()), request.settings.fit.seed);
            rows.push_back({find_method(id).name, spheres.size(), shapegen::measure_quality(spheres, body, exact)});
            const std::vector<Sphere> matched = shapegen::baselines::volume_matched(spheres, volume);
            rows.push_back({"  the same, volume-matched", matched.size(), shapegen::measure_quality(matched, body, exact)});
        }
    }
    print_quality_table(rows);
}

void write_picture(const TriangleMesh& body, const meshes::SignedDistance& exact, const shapegen::FitResult& fit, const fs::path& file) {
    const auto distance = [&exact](std::span<const Vec3> points) { return exact.values(points); };
    report::write_png(report::picture_of_clump(body, fit.spheres, distance, {}), file);
    print_written(file, "the body, and the clump coloured by its distance from it");
}

// What the clump is called and where it comes from.
void label(ClumpTemplate& clump, const ShapeRequest& request, const BodyOnDisk& body, const StageKey& key) {
    const fs::path folder = request.output.has_parent_path() ? request.output.parent_path() : fs::path(".");
    clump.rigid.name = request.body.parametric.empty() ? request.body.mesh_file.stem().string() : stem_of(request.output).filename().string();
    clump.mesh_file = fs::proximate(fs::absolute(body.file()), fs::absolute(folder)).generic_string();
    clump.mesh_unit = body.unit();
    clump.mesh_hash = io::sha256_of_file(body.file());
    clump.provenance = provenance_of(key, request.settings.fit.seed);
    clump.provenance.input_hashes[stage_hash] = key.fingerprint();
}

void check(const ShapeRequest& request) {
    find_method(request.method);
    for (const std::string& id : request.against)
        if (find_method(id).id == fit_method) throw usage_error("the fit cannot be compared with itself", "name other methods: --against shape4,openvdb");
    if (request.method == fit_method && request.volume_matched)
        throw usage_error("the fit has the body's volume anyway", "leave --volume-matched away, or choose another --method");
}

}  // namespace

fs::path stem_of(const fs::path& clump_file) {
    std::string name = clump_file.filename().string();
    for (const std::string suffix : {".toml", ".clump"})
        if (name.ends_with(suffix)) name.resize(name.size() - suffix.size());
    return clump_file.parent_path() / name;
}

shapegen::MadeClump make_by_method(const TriangleMesh& body, const std::string& method, bool volume_matched, const shapegen::ClumpSettings& settings,
                                   const ProgressSink& progress, std::shared_ptr<const meshes::SignedDistance> exact) {
    if (method == fit_method) {
        shapegen::ClumpSettings aimed = settings;
        aim_symmetry(body, aimed.fit);
        return shapegen::make_clump(body, aimed, progress, std::move(exact));
    }
    if (progress) progress({"placing spheres by " + find_method(method).name, 0.0, 1.0, "", 0.0, "", ""});
    if (!exact) exact = meshes::exact_signed_distance(body);
    std::vector<Sphere> spheres = spheres_of_method(method, body, *exact, settings.fit.sphere_count, settings.fit.seed);
    if (volume_matched) spheres = shapegen::baselines::volume_matched(spheres, meshes::mass_properties(body, 1.0).volume);
    return shapegen::judged_clump(spheres, body, *exact, settings);
}

QuietClump ensure_clump(const ShapeRequest& request, const BodyOnDisk& body, const ProgressSink& progress) {
    check(request);
    const StageKey key = key_of(request);
    if (is_up_to_date(request, key, {})) return {io::read_clump(request.output), true};
    shapegen::MadeClump made = make_by_method(body.mesh(), request.method, request.volume_matched, request.settings, progress);
    throw_if_interrupted();
    label(made.clump, request, body, key);
    io::write_clump(made.clump, request.output);
    return {made.clump, false};
}

void run_shape(const ShapeRequest& request) {
    const Stopwatch stopwatch;
    check(request);
    const StageKey key = key_of(request);
    const fs::path picture = picture_beside(request.output);
    if (is_up_to_date(request, key, picture)) {
        print_line(request.output.string() + " is up to date (same mesh, same settings, same program)");
        return;
    }
    BodyOnDisk body(request.body, stem_of(request.output));
    const double reading = stopwatch.seconds();
    const std::shared_ptr<const meshes::SignedDistance> exact = meshes::exact_signed_distance(body.mesh());
    const double exact_distance = stopwatch.seconds() - reading;
    const fs::path folder = request.output.has_parent_path() ? request.output.parent_path() : fs::path(".");

    ProgressPrinter progress;
    shapegen::MadeClump made = make_by_method(body.mesh(), request.method, request.volume_matched, request.settings, progress.sink(), exact);
    progress.finish();
    made.times.distance += exact_distance;
    throw_if_interrupted();

    label(made.clump, request, body, key);
    print_masses(made);
    print_quality(request, made, body.mesh(), *exact);
    print_surface(made);
    print_cost(made);
    if (request.method == fit_method) print_fit(made, reading);
    io::prepare_output_folder(folder);
    if (request.picture) write_picture(body.mesh(), *exact, made.fit, picture);
    io::write_clump(made.clump, request.output);
    body.keep();
    if (body.made_here()) print_written(body.file(), "the body");
    print_written(request.output, fmt::format("clump of {} spheres", made.clump.rigid.spheres.size()));
    print_line(fmt::format("  took {}, peak memory {:.0f} MB", duration_text(stopwatch.seconds()), peak_memory_megabytes()));
}

TriangleMesh true_surface(const ClumpTemplate& clump, const fs::path& clump_file) {
    const fs::path file = clump_file.parent_path() / clump.mesh_file;
    const std::string remedy = "make the clump again: pelletlab shape " + file.string() + " --unit " + clump.mesh_unit + " -o " + clump_file.string();
    if (!fs::exists(file))
        throw bad_input("the mesh '" + file.string() + "' that this clump was made from is not there", "put it back, or " + remedy, {clump_file.string()});
    if (io::sha256_of_file(file) != clump.mesh_hash)
        throw bad_input("the mesh '" + file.string() + "' has changed since this clump was made from it", remedy, {clump_file.string()});
    const TriangleMesh body = meshes::require_closed_body(meshes::read_mesh(file, clump.mesh_unit)).mesh;
    const Pose body_in_mesh = clump.rigid.mass_properties.body_in_mesh();
    return transformed(body, {body_in_mesh.to_body(Vec3::Zero()), body_in_mesh.orientation.conjugate()});
}

}  // namespace pelletlab::apps
