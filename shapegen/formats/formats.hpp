// Clump templates in the files of other DEM programs and of general tools: one table of formats, one writer and one reader each.
// Nothing here touches the disk: writers return the files' contents, readers take them; the caller writes them atomically.
// What each program expects, where that is documented and what is uncertain: docs/clump-formats.md.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/clump_template.hpp"

namespace pelletlab::shapegen::formats {

/// One file of an export or an import. A writer's names are relative («pellet.liggghts.txt», «pellet/Inertia/TOI.txt»); a reader uses the name
/// in its error messages and to tell companion files apart.
struct FormatFile {
    std::string name;
    std::string content;
};

struct WriteOptions {
    std::string length_unit;     ///< «mm», «m», …; empty: the usual one of the format
    std::string mass_unit;       ///< «kg», «g», …; empty: the usual one; LIGGGHTS, EDEM and VTK get kg always
    int atom_type = 1;           ///< LIGGGHTS, LAMMPS: type of the spheres
    int template_type = 1;       ///< LIGGGHTS: number of the multisphere template, 1 … number of templates
    double surface_voxel = 0.0;  ///< [m], STL: edge of the sampling cells; 0: 1/128 of the longest edge, finer for small spheres
};

struct ReadOptions {
    std::string length_unit;  ///< unit of the file's coordinates; may stay empty where the file says it
    std::string mass_unit;    ///< unit of the file's masses; likewise
};

/// What a file says about a clump, in SI units and in the frame of the file. A quantity the file does not hold is empty.
struct ImportedClump {
    std::string name;
    std::vector<Sphere> spheres;               ///< [m]
    std::optional<double> volume;              ///< [m³]
    std::optional<double> density;             ///< [kg/m³]
    std::optional<double> mass;                ///< [kg]
    std::optional<Vec3> centre_of_mass;        ///< [m]
    std::optional<Mat3> inertia;               ///< [kg m²], about the centre of mass, along the axes of the file
    std::optional<Mat3> unit_density_inertia;  ///< [m⁵], likewise for a density of 1 kg/m³: what PFC keeps
    std::vector<std::string> notes;            ///< what a person should know of this reading: «no header: columns taken as x, y, z, radius»
};

struct Format {
    std::string id;              ///< «liggghts»: what a user types
    std::string program;         ///< «LIGGGHTS multisphere template»
    std::string extension;       ///< of the main file, with its dot: «.liggghts.txt»
    std::string description;     ///< one sentence: files, what they hold
    std::string documented_in;   ///< URL or repository and path where the format is described
    std::string length_unit;     ///< usual unit of the coordinates
    std::string mass_unit;       ///< usual unit of the masses; empty when the format holds none
    bool holds_mass_properties;  ///< mass and inertia survive writing and reading (companion files included)
    double precision;            ///< written and read back, centres and radii change by at most precision · bounding radius

    /// All files of the export; the first is the main one. Throws Error(bad_input) for a template that the program cannot take (and says why).
    std::vector<FormatFile> (*write)(const ClumpTemplate& clump, const WriteOptions& options);

    /// files[0] is the main file, the others its companions in any order. Throws Error(bad_input) with file, line and column. Null: cannot be read.
    ImportedClump (*read)(const std::vector<FormatFile>& files, const ReadOptions& options);
};

/// Every format, in a fixed order.
const std::vector<Format>& all();

/// The format of that id; Error(usage) with a suggestion for an unknown one.
const Format& find(std::string_view id);

/// The imported clump in the body frame (origin in the centre of mass, principal axes; the file's own axes are kept where they are principal already).
/// Needs mass and inertia; volume or density may come from `density` [kg/m³]. Throws Error(bad_input) that names what is missing.
RigidTemplate rigid_template(const ImportedClump& clump, std::optional<double> density = std::nullopt);

}  // namespace pelletlab::shapegen::formats
