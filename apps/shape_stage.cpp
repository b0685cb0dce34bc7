#include "apps/shape_stage.hpp"

#include <fmt/format.h>

#include <span>
#include <vector>

#include "apps/stage.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "io/clump_file.hpp"
#include "io/files.hpp"
#include "meshes/check.hpp"
#include "meshes/read_mesh.hpp"
#include "meshes/signed_distance.hpp"
#include "report/pictures.hpp"
#include "shapegen/hand_made.hpp"
#include "shapegen/make_clump.hpp"
#include "shapegen/quality.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

constexpr const char* stage_hash = "stage";

std::string mm(double metres) {
    return fmt::format("{:.4f} mm", 1e3 * metres);
}
std::string percent(double share) {
    return fmt::format("{:+.2f} %", 100.0 * share);
}

const char* name_of(MassSource source) {
    switch (source) {
        case MassSource::target_mesh:
            return "the mesh";
        case MassSource::union_of_spheres:
            return "the union of the spheres";
        case MassSource::density_matched_union:
            return "the union of the spheres, density matched to the mesh's mass";
    }
    return "";
}

StageKey key_of(const ShapeRequest& request) {
    StageKey key;
    key.verb = "shape";
    key.settings = fmt::format("unit {} n {} density {:.17g} min_radius {:.17g} mass {} seed {}", request.unit, request.sphere_count, request.density,
                               request.min_radius, static_cast<int>(request.mass_source), request.seed);
    key.inputs["mesh"] = io::sha256_of_file(request.mesh_file);
    return key;
}

bool is_up_to_date(const ShapeRequest& request, const StageKey& key, const fs::path& picture) {
    if (request.force || !fs::exists(request.output) || (request.picture && !fs::exists(picture))) return false;
    const auto hashes = io::read_clump(request.output).provenance.input_hashes;
    const auto found = hashes.find(stage_hash);
    return found != hashes.end() && found->second == key.fingerprint();
}

fs::path picture_beside(const fs::path& clump_file) {
    std::string name = clump_file.filename().string();
    for (const std::string suffix : {".toml", ".clump"})
        if (name.ends_with(suffix)) name.resize(name.size() - suffix.size());
    return clump_file.parent_path() / (name + ".png");
}

void print_mesh(const meshes::CheckedMesh& checked, const fs::path& file) {
    const Vec3 extent = 1e3 * checked.report.extent;
    print_line(fmt::format("Body {}: {} triangles, {:.4g} x {:.4g} x {:.4g} mm, {:.5g} mm³, closed", file.filename().string(), checked.report.faces, extent.x(),
                           extent.y(), extent.z(), 1e9 * checked.report.volume));
    for (const std::string& repair : checked.report.repairs) print_line("  repaired: " + repair);
}

void print_mass(const ClumpTemplate& clump) {
    const MassProperties& mass = clump.rigid.mass_properties;
    const Vec3 inertia = mass.principal_inertia;
    print_pairs({{"mass properties from", name_of(clump.mass_source)},
                 {"mass", fmt::format("{:.4f} mg at {:.5g} kg/m³", 1e6 * mass.mass, mass.density)},
                 {"principal inertia", fmt::format("{:.5g}  {:.5g}  {:.5g} kg m²", inertia.x(), inertia.y(), inertia.z())}});
}

std::vector<std::string> quality_row(const std::string& name, std::size_t spheres, const FitQuality& q) {
    return {name,
            std::to_string(spheres),
            percent(q.volume_error),
            percent(q.inertia_error.cwiseAbs().maxCoeff() == q.inertia_error.maxCoeff() ? q.inertia_error.maxCoeff() : q.inertia_error.minCoeff()),
            mm(q.both.mean),
            mm(q.both.rms),
            mm(q.both.max),
            fmt::format("{:.2f} %", 100.0 * q.symmetric_difference)};
}

void print_quality(const ClumpTemplate& clump, const TriangleMesh& body, int study_shape) {
    std::vector<std::vector<std::string>> rows{{"shape", "spheres", "volume", "worst inertia", "mean", "rms", "max", "sym. difference"}};
    rows.push_back(quality_row("fitted", clump.rigid.spheres.size(), clump.quality));
    if (study_shape > 0) {
        const auto exact = meshes::exact_signed_distance(body);
        const std::vector<Sphere> spheres = shapegen::hand_made_shape(study_shape);
        rows.push_back(quality_row(fmt::format("study's Shape {}", study_shape), spheres.size(), shapegen::measure_quality(spheres, body, *exact)));
    }
    print_line("Distance between the surface of the clump and the body, both ways:");
    print_table(rows);
    print_line(fmt::format("  (error of the distance query itself: at most {:.1e} mm)", 1e3 * clump.quality.distance_error_bound));
}

void write_picture(const TriangleMesh& body, const shapegen::FitResult& fit, const fs::path& file) {
    const auto exact = meshes::exact_signed_distance(body);
    const auto distance = [&exact](std::span<const Vec3> points) { return exact->values(points); };
    report::write_png(report::picture_of_clump(body, fit.spheres, distance, {}), file);
    print_written(file, "the body, and the clump coloured by its distance from it");
}

}  // namespace

void run_shape(const ShapeRequest& request) {
    const Stopwatch stopwatch;
    const TriangleMesh as_read = meshes::read_mesh(request.mesh_file, request.unit);
    const StageKey key = key_of(request);
    const fs::path picture = picture_beside(request.output);
    if (is_up_to_date(request, key, picture)) {
        print_line(request.output.string() + " is up to date (same mesh, same settings, same program)");
        return;
    }
    const meshes::CheckedMesh checked = meshes::require_closed_body(as_read);
    print_mesh(checked, request.mesh_file);

    const fs::path folder = request.output.has_parent_path() ? request.output.parent_path() : fs::path(".");
    io::prepare_output_folder(folder);

    ProgressPrinter progress;
    shapegen::ClumpSettings settings;
    settings.fit.sphere_count = request.sphere_count;
    settings.fit.min_radius = request.min_radius;
    settings.fit.seed = request.seed;
    settings.density = request.density;
    settings.mass_source = request.mass_source;
    shapegen::MadeClump made = shapegen::make_clump(checked.mesh, settings, progress.sink());
    progress.finish();
    throw_if_interrupted();

    made.clump.rigid.name = request.mesh_file.stem().string();
    made.clump.mesh_file = fs::proximate(fs::absolute(request.mesh_file), fs::absolute(folder)).generic_string();
    made.clump.mesh_unit = request.unit;
    made.clump.mesh_hash = key.inputs.at("mesh");
    made.clump.provenance = provenance_of(key, request.seed);
    made.clump.provenance.input_hashes[stage_hash] = key.fingerprint();

    print_mass(made.clump);
    print_quality(made.clump, checked.mesh, request.study_shape);
    if (request.picture) write_picture(checked.mesh, made.fit, picture);
    io::write_clump(made.clump, request.output);
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
