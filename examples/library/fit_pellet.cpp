// A clump of spheres without the command line: mesh in, LIGGGHTS files out.
//   fit_pellet                       the library's own trilobe, 30 spheres
//   fit_pellet pellet.stl mm 82      a mesh file, its unit, the number of spheres
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "core/error.hpp"
#include "meshes/check.hpp"
#include "meshes/named_body.hpp"
#include "meshes/read_mesh.hpp"
#include "shapegen/formats/formats.hpp"
#include "shapegen/make_clump.hpp"

using namespace pelletlab;

int main(int argc, char** argv) {
    try {
        // 1. A closed body, in metres. Open or crossing meshes: meshes/repair.hpp.
        const TriangleMesh as_read = argc > 2 ? meshes::read_mesh(argv[1], argv[2]) : meshes::make_named_body("trilobe:height=4mm,facets=60");
        const meshes::CheckedMesh body = meshes::require_closed_body(as_read);

        // 2. The fit. Modes, symmetry, stop criteria, DEM cost: shapegen/make_clump.hpp.
        shapegen::ClumpSettings settings;
        settings.fit.sphere_count = argc > 3 ? static_cast<std::uint32_t>(std::atoi(argv[3])) : 30;
        settings.density = 1800.0;
        shapegen::MadeClump made = shapegen::make_clump(body.mesh, settings);

        const FitQuality& quality = made.clump.quality;
        std::printf("%zu spheres: volume %+.3f %%, rms distance %.4f mm, DEM cost %.2f x Shape 2\n", made.fit.spheres.size(), 100.0 * quality.volume_error,
                    1e3 * quality.both.rms, made.relative_cost);

        // 3. Files for another program.
        made.clump.rigid.name = "pellet";
        for (const auto& file : shapegen::formats::find("liggghts").write(made.clump, {})) {
            std::ofstream(file.name) << file.content;
            std::printf("wrote %s\n", file.name.c_str());
        }
        return 0;
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return error.exit_code();
    }
}
