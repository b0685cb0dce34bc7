// pelletlab shape export: a clump template in the files of other programs, each read back and compared before it is written.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <set>

#include "apps/shape_verbs.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "io/clump_file.hpp"
#include "io/files.hpp"
#include "shapegen/formats/formats.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;
namespace formats = shapegen::formats;

namespace {

struct ExportOptions {
    std::string clump, folder = ".", surface_voxel;
    std::vector<std::string> to;
    formats::WriteOptions write;
};

std::vector<const formats::Format*> chosen(const std::vector<std::string>& ids) {
    std::vector<const formats::Format*> list;
    std::set<std::string> seen;
    for (const std::string& id : ids) {
        if (id == "all") {
            for (const formats::Format& format : formats::all())
                if (seen.insert(format.id).second) list.push_back(&format);
        } else if (const formats::Format& format = formats::find(id); seen.insert(id).second) {
            list.push_back(&format);
        }
    }
    return list;
}

/// What came back differs by no more than the format promises; the largest difference of a centre or radius [m]. NaN for a format that is only written.
double read_back(const formats::Format& format, const std::vector<formats::FormatFile>& files, const ClumpTemplate& clump, const formats::WriteOptions& write) {
    if (format.read == nullptr) return std::numeric_limits<double>::quiet_NaN();
    const std::string length = write.length_unit.empty() ? format.length_unit : write.length_unit,
                      mass = write.mass_unit.empty() ? format.mass_unit : write.mass_unit;
    const formats::ImportedClump again = format.read(files, {format.length_unit.empty() ? "" : length, format.mass_unit.empty() ? "" : mass});
    const auto& spheres = clump.rigid.spheres;
    double largest = again.spheres.size() == spheres.size() ? 0.0 : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < spheres.size() && std::isfinite(largest); ++i)
        largest =
            std::max({largest, (again.spheres[i].centre - spheres[i].centre).cwiseAbs().maxCoeff(), std::abs(again.spheres[i].radius - spheres[i].radius)});
    // 1e-14: the unit of the file is multiplied in and out again.
    if (!(largest <= std::max(format.precision, 1e-14) * clump.rigid.bounding_radius))
        throw numerical_failure("the " + format.program + " files do not read back to the same spheres", "please report this with the clump file");
    return largest;
}

void run_export(const ExportOptions& options) {
    const std::vector<const formats::Format*> list = chosen(options.to);
    const ClumpTemplate clump = io::read_clump(options.clump);
    formats::WriteOptions write = options.write;
    if (!options.surface_voxel.empty()) write.surface_voxel = parse_quantity(options.surface_voxel, dimension::length);

    struct Made {
        const formats::Format* format;
        std::vector<formats::FormatFile> files;
        double difference;
    };
    std::vector<Made> all;  // made and checked before the first one is written
    for (const formats::Format* format : list) {
        Made made{format, format->write(clump, write), 0.0};
        made.difference = read_back(*format, made.files, clump, write);
        all.push_back(std::move(made));
    }
    const fs::path folder = options.folder;
    for (const Made& made : all) {
        for (const formats::FormatFile& file : made.files) {
            const fs::path path = folder / file.name;
            io::prepare_output_folder(path.parent_path().empty() ? fs::path(".") : path.parent_path());
            io::write_text(path, file.content);
        }
        std::string what = made.format->program;
        if (std::isfinite(made.difference)) what += fmt::format("; read back, spheres differ by at most {:.1g} mm", 1e3 * made.difference);
        print_written(folder / made.files.front().name, what);
        for (std::size_t i = 1; i < made.files.size(); ++i) print_written(folder / made.files[i].name, "goes with it");
    }
    const MassProperties& mass = clump.rigid.mass_properties;
    print_line(fmt::format("  every file carries mass {:.5g} mg and inertia {:.5g}  {:.5g}  {:.5g} kg m² of the template, never a sum over overlapping spheres",
                           1e6 * mass.mass, mass.principal_inertia.x(), mass.principal_inertia.y(), mass.principal_inertia.z()));
}

std::string table_of_formats() {
    std::string text = "Formats:\n";
    for (const formats::Format& format : formats::all()) text += fmt::format("  {:<9} {}: {}\n", format.id, format.program, format.description);
    return text;
}

}  // namespace

void add_shape_export(CLI::App& shape) {
    auto options = std::make_shared<ExportOptions>();
    CLI::App* verb = shape.add_subcommand("export",
                                          "Write a clump for another DEM program, a table, ParaView or a surface mesh\n"
                                          "  example: pelletlab shape export pellet.clump.toml --to liggghts,yade -o exported");
    verb->add_option("clump", options->clump, "Clump template (pellet.clump.toml)")->required();
    verb->add_option("--to", options->to, "Formats, separated by commas, or all")->required()->delimiter(',');
    verb->add_option("-o,--output", options->folder, "Folder")->capture_default_str();
    verb->add_option("--length-unit", options->write.length_unit, "Unit of lengths in the files: mm, m, cm, … (default: the usual one of the program)");
    verb->add_option("--mass-unit", options->write.mass_unit, "Unit of masses: kg, g, … (default: the usual one of the program)");
    verb->add_option("--atom-type", options->write.atom_type, "LIGGGHTS, LAMMPS: type of the spheres")->check(CLI::Range(1, 1000000))->capture_default_str();
    verb->add_option("--template-type", options->write.template_type, "LIGGGHTS: number of the template")->check(CLI::Range(1, 1000000))->capture_default_str();
    verb->add_option("--surface-voxel", options->surface_voxel, "STL of the union: sampling cell, with unit");
    verb->footer(table_of_formats());
    verb->callback([options, &shape, verb] {
        refuse_options_of_shape(shape, *verb);
        run_export(*options);
    });
}

}  // namespace pelletlab::apps
