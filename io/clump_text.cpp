// The writing half of clump files.
#include <cmath>
#include <cstdio>

#include "core/units.hpp"
#include "io/clump_file.hpp"
#include "io/detail/clump_format.hpp"
#include "io/detail/toml_text.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

using namespace detail;

std::string quantity(double value, const char* unit) {
    return toml_string(std::isfinite(value) ? format_quantity(value, unit) : not_known_text);
}

std::string plain(double value) {
    return std::isfinite(value) ? format_quantity(value, "") : toml_string(not_known_text);
}

std::string quantities(const Vec3& v, const char* unit) {
    return "[" + quantity(v[0], unit) + ", " + quantity(v[1], unit) + ", " + quantity(v[2], unit) + "]";
}

std::string distances_text(const char* name, const DistanceFigures& d) {
    return std::string(name) + " = { mean = " + quantity(d.mean, "mm") + ", rms = " + quantity(d.rms, "mm") + ", max = " + quantity(d.max, "mm") +
           ", p99 = " + quantity(d.p99, "mm") + ", signed_mean = " + quantity(d.signed_mean, "mm") + " }\n";
}

std::string rounded(double value, const char* format) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, format, value);
    return buffer;
}

/// A comment for people; nothing reads it back.
std::string header_text(const ClumpTemplate& clump) {
    const FitQuality& q = clump.quality;
    std::string text = "# Clump template of pelletlab: " + std::to_string(clump.rigid.spheres.size()) + " spheres, bounding radius " +
                       rounded(bounding_radius(clump.rigid.spheres) * 1e3, "%.4f") + " mm, mass " + rounded(clump.rigid.mass_properties.mass * 1e6, "%.3f") +
                       " mg\n";
    if (!std::isfinite(q.volume_error)) return text;
    text += "# Union of the spheres against the body: volume " + rounded(q.volume_error * 100.0, "%+.3f") + " %, symmetric difference " +
            rounded(q.symmetric_difference * 100.0, "%.3f") + " %, centre off by " + rounded(q.centre_offset * 1e3, "%.5f") + " mm,\n";
    text += "# moments of inertia " + rounded(q.inertia_error[0] * 100.0, "%+.3f") + ", " + rounded(q.inertia_error[1] * 100.0, "%+.3f") + ", " +
            rounded(q.inertia_error[2] * 100.0, "%+.3f") + " %; surface distance: mean " + rounded(q.both.mean * 1e3, "%.4f") + " mm, 99th percentile " +
            rounded(q.both.p99 * 1e3, "%.4f") + " mm, largest " + rounded(q.both.max * 1e3, "%.4f") + " mm\n";
    return text;
}

std::string angle(double value) {
    return quantity(value, "deg");
}

std::string surface_text(const SurfaceFigures& f) {
    return "[quality.surface]\n"
           "roughness_flat = { sq = " +
           quantity(f.flat_sq, "mm") + ", sz = " + quantity(f.flat_sz, "mm") + " }\n" + "roughness_curved = { sq = " + quantity(f.curved_sq, "mm") +
           ", sz = " + quantity(f.curved_sz, "mm") + " }\n" + "normal_deviation = { mean = " + angle(f.normal_mean) + ", rms = " + angle(f.normal_rms) +
           ", p95 = " + angle(f.normal_p95) + " }\n" + "edge_gap = { mean = " + quantity(f.edge_gap_mean, "mm") + ", max = " + quantity(f.edge_gap_max, "mm") +
           " }\n" + "edge_radius = { mean = " + quantity(f.edge_radius_mean, "mm") + ", max = " + quantity(f.edge_radius_max, "mm") + " }\n" +
           "support_error = { mean = " + quantity(f.support_mean, "mm") + ", rms = " + quantity(f.support_rms, "mm") +
           ", max = " + quantity(f.support_max, "mm") + " }\n" + "plane_contacts = { press = " + quantity(f.press, "mm") +
           ", flat_mean = " + plain(f.contacts_on_flat) + ", flat_most = " + std::to_string(f.most_on_flat) + ", any_mean = " + plain(f.contacts_any_way) +
           ", any_most = " + std::to_string(f.most_any_way) + " }\n" + "radius = { smallest = " + quantity(f.smallest_radius, "mm") +
           ", largest = " + quantity(f.largest_radius, "mm") + " }\n" + "components = " + std::to_string(f.components) + "\n" +
           "sealed_volume = " + quantity(f.sealed_volume, "mm^3") + "\n";
}

std::string quality_text(const FitQuality& q) {
    return "[quality]  # union of the spheres against the body\n"
           "volume_error = " +
           plain(q.volume_error) + "  # V_union / V_body - 1\n" + "inertia_error = [" + plain(q.inertia_error[0]) + ", " + plain(q.inertia_error[1]) + ", " +
           plain(q.inertia_error[2]) + "]  # smallest moment first\n" + "centre_offset = " + quantity(q.centre_offset, "mm") + "\n" +
           "symmetric_difference = " + plain(q.symmetric_difference) + "  # (missing + outside volume) / V_body\n" + "missing = " + plain(q.missing) +
           "\noutside = " + plain(q.outside) + "\n" + distances_text("body_to_union", q.target_to_union) + distances_text("union_to_body", q.union_to_target) +
           distances_text("both", q.both) + "distance_error_bound = " + quantity(q.distance_error_bound, "mm") + "\n\n" + surface_text(q.surface);
}

std::string mass_text(const MassProperties& m) {
    const Quat& q = m.principal_axes;
    return "[mass_properties]\n"
           "density = " +
           quantity(m.density, "kg/m^3") + "\n" + "volume = " + quantity(m.volume, "mm^3") + "\n" + "mass = " + quantity(m.mass, "mg") + "\n" +
           "centre_of_mass_mesh = " + quantities(m.centre_of_mass_mesh, "mm") + "  # in the frame of the mesh file\n" + "principal_axes = [" + plain(q.w()) +
           ", " + plain(q.x()) + ", " + plain(q.y()) + ", " + plain(q.z()) + "]  # quaternion w, x, y, z: body to mesh frame\n" +
           "principal_inertia = " + quantities(m.principal_inertia, "mg*mm^2") + "\n";
}

std::string compared_text(const char* name, const MassProperties& m) {
    return std::string(name) + " = { volume = " + quantity(m.volume, "mm^3") + ", mass = " + quantity(m.mass, "mg") +
           ", centre = " + quantities(m.centre_of_mass_mesh, "mm") + ", principal_inertia = " + quantities(m.principal_inertia, "mg*mm^2") + " }\n";
}

/// Nothing when nothing is known.
std::string masses_text(const MassComparison& m) {
    if (!(m.mesh.volume > 0.0)) return "";
    return "[masses]  # of the body, of the union of the spheres, and of their sum, which counts overlaps again and again; centre in the frame of the mesh "
           "file\n"
           "density = " +
           quantity(m.mesh.density, "kg/m^3") + "\n" + compared_text("body", m.mesh) + compared_text("union", m.of_union) + compared_text("sum", m.sum) + "\n";
}

std::string provenance_text(const Provenance& p) {
    std::string text = "[provenance]\ntool = " + toml_string(p.tool) + "\nversion = " + toml_string(p.version) + "\ngit_hash = " + toml_string(p.git_hash) +
                       "\nverb = " + toml_string(p.verb) + "\nseed = " + toml_string(std::to_string(p.seed)) + "\n\n[provenance.input_hashes]  # SHA-256\n";
    for (const auto& [file, hash] : p.input_hashes) text += toml_key(file) + " = " + toml_string(hash) + "\n";
    return text;
}

std::string spheres_text(const std::vector<Sphere>& spheres) {
    std::string text =
        "# Body frame: origin in the centre of mass, axes along the principal axes of inertia. One row a sphere: x, y, z, radius.\nspheres = [\n";
    for (const Sphere& s : spheres)
        text += "  [" + quantity(s.centre[0], "mm") + ", " + quantity(s.centre[1], "mm") + ", " + quantity(s.centre[2], "mm") + ", " +
                quantity(s.radius, "mm") + "],\n";
    return text + "]\n";
}

}  // namespace

std::string clump_text(const ClumpTemplate& c) {
    return header_text(c) + "format = " + toml_string(clump_format_name) + "\nformat_version = " + std::to_string(clump_format_version) +
           "\nname = " + toml_string(c.rigid.name) + "\nmass_source = " + toml_string(mass_source_name(c.mass_source)) + "\n\n" +
           spheres_text(c.rigid.spheres) + "\n" + mass_text(c.rigid.mass_properties) + "\n" + quality_text(c.quality) + "\n" + masses_text(c.masses) +
           "[mesh]\nfile = " + toml_string(c.mesh_file) + "\nunit = " + toml_string(c.mesh_unit) + "\nsha256 = " + toml_string(c.mesh_hash) + "\n\n" +
           provenance_text(c.provenance);
}

void write_clump(const ClumpTemplate& clump, const std::filesystem::path& file) {
    const std::string text = clump_text(clump);
    parse_clump(text, file.string());  // a clump that could not be read back is told now, not when it is needed
    write_text(file, text);
}

}  // namespace pelletlab::io
