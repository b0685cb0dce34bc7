// Prints the accuracy table of the fit: bodies × modes × numbers of spheres, with errors, roughness, DEM cost and seconds, and the other methods.
// clump_table [cylinder|trilobe|ring|scan|all] [N …] [mean|minimax|inside|outside|flat …] [symmetric] [baselines], one thread; environment: VOXEL (share of the
// smallest extent, 0: exact query), EFFORT, SEED, CSV (folder for the spheres).
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/check.hpp"
#include "meshes/makers.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/pellet_makers.hpp"
#include "shapegen/baselines/baselines.hpp"
#include "shapegen/make_clump.hpp"
#include "shapegen/quality.hpp"

using namespace pelletlab;

namespace {

struct Body {
    std::string name;
    TriangleMesh mesh;
};

std::vector<Body> bodies() {
    return {{"cylinder", meshes::make_cylinder(3.12e-3, 2.96e-3, 128, true)},
            {"trilobe", meshes::make_pellet(meshes::LobedExtrudate{}, 120)},
            {"ring", meshes::make_pellet(meshes::HollowCylinder{}, 96)},
            {"scan", meshes::make_scan_like(meshes::ScanLike{}, 5)}};
}

void print_row(const std::string& name, const shapegen::MadeClump& made) {
    const FitQuality& q = made.clump.quality;
    const shapegen::SurfaceReport& s = made.surface;
    std::printf("%-22s %5zu %+8.3f %+8.3f  %.4f %.4f %.4f  %.4f %.4f  %5.1f  %6.1f %5zu %6.2f  %.2f %.2f %.2f %.2f %.2f  %d\n", name.c_str(),
                made.clump.rigid.spheres.size(), 100 * q.volume_error, 100 * q.inertia_error.cwiseAbs().maxCoeff(), 1e3 * q.both.mean, 1e3 * q.both.rms,
                1e3 * q.both.max, 1e3 * s.flat_sq, 1e3 * s.curved_sq, s.normal_mean * 57.29578, s.contacts_on_flat, s.most_any_way, made.relative_cost,
                made.times.distance, made.fit.times.seeds, made.fit.times.search, made.fit.times.finish, made.times.quality, static_cast<int>(made.fit.status));
    std::fflush(stdout);
}

// Rows x, y, z, r in mm, for other judges.
void write_csv(const std::vector<Sphere>& spheres, const std::string& file) {
    std::FILE* out = std::fopen(file.c_str(), "w");
    if (out == nullptr) return;
    for (const Sphere& s : spheres) std::fprintf(out, "%.12g,%.12g,%.12g,%.12g\n", 1e3 * s.centre.x(), 1e3 * s.centre.y(), 1e3 * s.centre.z(), 1e3 * s.radius);
    std::fclose(out);
}

void print_head(const std::string& body) {
    std::printf("\n%s\n%-22s %5s %8s %8s  %-20s  %-13s  %5s  %6s %5s %6s  %s\n", body.c_str(), "shape", "N", "dV %", "|dI| %", "mean  rms  max  mm",
                "Sq flat curved", "deg", "flat", "most", "cost", "seconds: sdf seeds search finish quality; status");
}

}  // namespace

int main(int argc, char** argv) {
    set_thread_count(1);
    const std::string wanted = argc > 1 ? argv[1] : "all";
    std::vector<std::uint32_t> counts;
    std::vector<std::pair<std::string, shapegen::FitMode>> modes;
    bool with_baselines = false, symmetric = false;
    for (int k = 2; k < argc; ++k) {
        const std::string word = argv[k];
        const std::pair<const char*, shapegen::FitMode> names[] = {{"mean", shapegen::FitMode::mean},
                                                                   {"minimax", shapegen::FitMode::minimax},
                                                                   {"inside", shapegen::FitMode::inside},
                                                                   {"outside", shapegen::FitMode::outside},
                                                                   {"flat", shapegen::FitMode::flat}};
        bool known = false;
        for (const auto& [name, mode] : names) {
            if (word != name) continue;
            modes.emplace_back(name, mode);
            known = true;
        }
        if (word == "baselines") with_baselines = known = true;
        if (word == "symmetric") symmetric = known = true;
        if (!known) counts.push_back(static_cast<std::uint32_t>(std::strtoul(word.c_str(), nullptr, 10)));
    }
    if (counts.empty()) counts = {24, 82, 200};
    if (modes.empty() && !with_baselines) modes = {{"mean", shapegen::FitMode::mean}};
    for (const Body& body : bodies()) {
        if (wanted != "all" && wanted != body.name) continue;
        const meshes::CheckedMesh checked = meshes::require_closed_body(body.mesh);
        print_head(body.name + ", " + std::to_string(checked.mesh.faces.size()) + " triangles");
        for (const std::uint32_t n : counts) {
            for (const auto& [name, mode] : modes) {
                shapegen::ClumpSettings settings;
                settings.fit.sphere_count = n;
                settings.fit.mode = mode;
                if (symmetric) settings.fit.symmetry_choice = shapegen::SymmetryChoice::own;
                if (const char* voxel = std::getenv("VOXEL")) settings.voxel_fraction = std::atof(voxel);
                if (const char* seed = std::getenv("SEED")) settings.fit.seed = std::strtoull(seed, nullptr, 10);
                if (const char* effort = std::getenv("EFFORT")) settings.fit.effort = std::atof(effort);
                const shapegen::MadeClump made = shapegen::make_clump(checked.mesh, settings);
                if (const char* folder = std::getenv("CSV"))
                    write_csv(made.fit.spheres, std::string(folder) + "/" + body.name + "_" + name + "_" + std::to_string(n) + ".csv");
                print_row(name + (symmetric ? " " + shapegen::describe(made.fit.symmetry) : ""), made);
            }
            if (!with_baselines) continue;
            const auto exact = meshes::exact_signed_distance(checked.mesh);
            const double volume = meshes::mass_properties(checked.mesh, 1.0).volume;
            for (const auto& method : shapegen::baselines::methods()) {
                shapegen::baselines::BaselineSettings settings;
                settings.sphere_count = n;
                std::vector<Sphere> spheres;
                try {
                    spheres = shapegen::baselines::baseline(method.id, checked.mesh, *exact, settings);
                } catch (const Error& error) {
                    std::printf("%-22s %s\n", method.id.c_str(), error.problem().c_str());
                    continue;
                }
                print_row(method.id, shapegen::judged_clump(spheres, checked.mesh, *exact, {}));
                print_row(method.id + ", V matched", shapegen::judged_clump(shapegen::baselines::volume_matched(spheres, volume), checked.mesh, *exact, {}));
            }
        }
    }
    return 0;
}
