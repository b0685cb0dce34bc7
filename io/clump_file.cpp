// The reading half of clump files.
#include "io/clump_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "core/observables.hpp"
#include "core/units.hpp"
#include "io/detail/clump_format.hpp"
#include "io/detail/toml_text.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

using namespace detail;

/// A table on the way to our structs: every key is asked for by name, what nobody asked for is an error.
class TableReader {
public:
    TableReader(const toml::table& table, std::string path, const std::string& file) : table_(table), path_(std::move(path)), file_(file) {}

    const toml::node& node(const std::string& key) {
        known_.push_back(key);
        const toml::node* found = table_.get(key);
        if (found == nullptr) throw bad_input("the key '" + full(key) + "' is missing", "make the clump again with `pelletlab shape`", place());
        return *found;
    }
    std::string text(const std::string& key) {
        const toml::node& n = node(key);
        if (!n.is_string()) throw wrong(key, n, "a text");
        return n.as_string()->get();
    }
    double quantity(const std::string& key, Dimension dimension) { return quantity_of(key, node(key), dimension); }
    double number(const std::string& key) { return number_of(key, node(key)); }

    template <std::size_t Count>
    std::array<double, Count> list(const std::string& key, Dimension dimension) {
        return list_of<Count>(key, node(key), dimension);
    }
    template <std::size_t Count>
    std::array<double, Count> list_of(const std::string& key, const toml::node& n, Dimension dimension) const {
        const toml::array* array = n.as_array();
        if (array == nullptr || array->size() != Count) throw wrong(key, n, "a list of " + std::to_string(Count) + " values");
        std::array<double, Count> values{};
        for (std::size_t i = 0; i < Count; ++i)
            values[i] = dimension == dimension::none ? number_of(key, *array->get(i)) : quantity_of(key, *array->get(i), dimension);
        return values;
    }
    TableReader table(const std::string& key) {
        const toml::node& n = node(key);
        if (!n.is_table()) throw wrong(key, n, "a table");
        return {*n.as_table(), full(key), file_};
    }
    bool has(const std::string& key) const { return table_.contains(key); }  ///< keys that files of earlier versions do not have
    std::size_t count(const std::string& key) {
        const toml::node& n = node(key);
        if (!n.is_integer() || n.as_integer()->get() < 0) throw wrong(key, n, "a whole number from 0");
        return static_cast<std::size_t>(n.as_integer()->get());
    }
    const toml::table& raw() const { return table_; }

    void finish() const {
        for (const auto& [key, ignored] : table_) {
            const std::string name(key.str());
            if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
            const std::string guess = closest_word(name, known_);
            throw bad_input("unknown key '" + full(name) + "'", guess.empty() ? "remove it" : "did you mean '" + guess + "'?", place_of(key, file_));
        }
    }
    Error wrong(const std::string& key, const toml::node& n, const std::string& wanted) const {
        return bad_input(full(key) + " must be " + wanted + ", and this is " + kind_of_node(n), "make the clump again with `pelletlab shape`",
                         place_of(n, file_));
    }
    Error impossible(const std::string& key, const std::string& why) const {
        const toml::node* n = table_.get(key);
        return bad_input(full(key) + " " + why, "make the clump again with `pelletlab shape`", n != nullptr ? place_of(*n, file_) : place());
    }
    const std::string& file() const { return file_; }

private:
    std::string full(const std::string& key) const { return (path_.empty() ? "" : path_ + ".") + toml_key(key); }
    Place place() const { return path_.empty() ? Place{file_} : place_of(table_, file_); }

    double quantity_of(const std::string& key, const toml::node& n, Dimension dimension) const {
        if (!n.is_string()) throw wrong(key, n, "a text with number and unit, for instance \"1.5 " + usual_units(dimension)[0] + "\"");
        if (n.as_string()->get() == not_known_text) return not_known;
        try {
            return parse_quantity(n.as_string()->get(), dimension);
        } catch (const Error& error) {
            throw bad_input(full(key) + ": " + error.problem(), error.remedy(), place_of(n, file_));
        }
    }
    double number_of(const std::string& key, const toml::node& n) const {
        if (n.is_string() && n.as_string()->get() == not_known_text) return not_known;
        if (n.is_integer()) return static_cast<double>(n.as_integer()->get());
        if (!n.is_floating_point()) throw wrong(key, n, "a number");
        const double value = n.as_floating_point()->get();
        if (!std::isfinite(value))
            throw bad_input(full(key) + " is not a finite number", "write \"" + std::string(not_known_text) + "\" if it is not known", place_of(n, file_));
        return value;
    }

    const toml::table& table_;
    std::string path_;
    const std::string& file_;
    std::vector<std::string> known_;
};

Vec3 vector_of(const std::array<double, 3>& v) {
    return {v[0], v[1], v[2]};
}

DistanceFigures read_distances(TableReader r) {
    DistanceFigures d{r.quantity("mean", dimension::length), r.quantity("rms", dimension::length), r.quantity("max", dimension::length),
                      r.quantity("p99", dimension::length)};
    d.signed_mean = r.has("signed_mean") ? r.quantity("signed_mean", dimension::length) : not_known;
    r.finish();
    return d;
}

SurfaceFigures read_surface(TableReader r) {
    SurfaceFigures f;
    const auto pair = [&r](const char* table, const char* a, double& first, const char* b, double& second) {
        TableReader t = r.table(table);
        first = t.quantity(a, dimension::length);
        second = t.quantity(b, dimension::length);
        t.finish();
    };
    const auto triple = [&r](const char* table, Dimension unit, const char* a, double& first, const char* b, double& second, const char* c, double& third) {
        TableReader t = r.table(table);
        first = t.quantity(a, unit);
        second = t.quantity(b, unit);
        third = t.quantity(c, unit);
        t.finish();
    };
    pair("roughness_flat", "sq", f.flat_sq, "sz", f.flat_sz);
    pair("roughness_curved", "sq", f.curved_sq, "sz", f.curved_sz);
    triple("normal_deviation", dimension::angle, "mean", f.normal_mean, "rms", f.normal_rms, "p95", f.normal_p95);
    pair("edge_gap", "mean", f.edge_gap_mean, "max", f.edge_gap_max);
    pair("edge_radius", "mean", f.edge_radius_mean, "max", f.edge_radius_max);
    triple("support_error", dimension::length, "mean", f.support_mean, "rms", f.support_rms, "max", f.support_max);
    TableReader contacts = r.table("plane_contacts");
    f.press = contacts.quantity("press", dimension::length);
    f.contacts_on_flat = contacts.number("flat_mean");
    f.most_on_flat = contacts.count("flat_most");
    f.contacts_any_way = contacts.number("any_mean");
    f.most_any_way = contacts.count("any_most");
    contacts.finish();
    pair("radius", "smallest", f.smallest_radius, "largest", f.largest_radius);
    f.components = r.count("components");
    f.sealed_volume = r.quantity("sealed_volume", dimension::volume);
    r.finish();
    return f;
}

FitQuality read_quality(TableReader r) {
    FitQuality q;
    q.volume_error = r.number("volume_error");
    q.inertia_error = vector_of(r.list<3>("inertia_error", dimension::none));
    q.centre_offset = r.quantity("centre_offset", dimension::length);
    q.symmetric_difference = r.number("symmetric_difference");
    q.missing = r.has("missing") ? r.number("missing") : not_known;
    q.outside = r.has("outside") ? r.number("outside") : not_known;
    q.target_to_union = read_distances(r.table("body_to_union"));
    q.union_to_target = read_distances(r.table("union_to_body"));
    q.both = read_distances(r.table("both"));
    q.distance_error_bound = r.quantity("distance_error_bound", dimension::length);
    if (r.has("surface")) q.surface = read_surface(r.table("surface"));
    r.finish();
    return q;
}

MassProperties read_mass(TableReader r) {
    MassProperties m;
    m.density = r.quantity("density", dimension::density);
    m.volume = r.quantity("volume", dimension::volume);
    m.mass = r.quantity("mass", dimension::mass);
    m.centre_of_mass_mesh = vector_of(r.list<3>("centre_of_mass_mesh", dimension::length));
    const auto q = r.list<4>("principal_axes", dimension::none);
    m.principal_axes = Quat(q[0], q[1], q[2], q[3]);
    m.principal_inertia = vector_of(r.list<3>("principal_inertia", dimension::moment_of_inertia));
    r.finish();
    if (!(m.density > 0.0)) throw r.impossible("density", "is not positive");
    if (!(m.volume > 0.0)) throw r.impossible("volume", "is not positive");
    if (!(m.mass > 0.0)) throw r.impossible("mass", "is not positive");
    // A file rounded by hand may miss a few digits; more than that, and the three numbers contradict each other.
    if (std::abs(m.mass / (m.density * m.volume) - 1.0) > 1e-6) throw r.impossible("mass", "is not density · volume");
    if (!m.centre_of_mass_mesh.allFinite()) throw r.impossible("centre_of_mass_mesh", "is not known");
    if (!(std::abs(m.principal_axes.norm() - 1.0) < 1e-9)) throw r.impossible("principal_axes", "is no quaternion of length 1");
    if (!(m.principal_inertia.minCoeff() > 0.0) || !m.principal_inertia.allFinite()) throw r.impossible("principal_inertia", "is not positive");
    // I_a + I_b ≥ I_c holds for every body; the slack is for rounding of flat ones.
    if (2.0 * m.principal_inertia.maxCoeff() > m.principal_inertia.sum() * (1.0 + 1e-9))
        throw r.impossible("principal_inertia", "belongs to no body: one moment is larger than the sum of the two others");
    return m;
}

MassProperties read_compared(TableReader r, double density) {
    MassProperties m;
    m.density = density;
    m.volume = r.quantity("volume", dimension::volume);
    m.mass = r.quantity("mass", dimension::mass);
    m.centre_of_mass_mesh = vector_of(r.list<3>("centre", dimension::length));
    m.principal_inertia = vector_of(r.list<3>("principal_inertia", dimension::moment_of_inertia));
    r.finish();
    return m;
}

MassComparison read_masses(TableReader r) {
    const double density = r.quantity("density", dimension::density);
    const MassComparison m{read_compared(r.table("body"), density), read_compared(r.table("union"), density), read_compared(r.table("sum"), density)};
    r.finish();
    return m;
}

std::vector<Sphere> read_spheres(TableReader& r) {
    const toml::node& node = r.node("spheres");
    const toml::array* rows = node.as_array();
    if (rows == nullptr) throw r.wrong("spheres", node, "a list of rows x, y, z, radius");
    if (rows->empty()) throw r.impossible("spheres", "is empty");
    std::vector<Sphere> spheres;
    for (const toml::node& row : *rows) {
        const auto v = r.list_of<4>("spheres", row, dimension::length);
        const Sphere sphere{{v[0], v[1], v[2]}, v[3]};
        if (!sphere.centre.allFinite() || !(sphere.radius > 0.0))
            throw bad_input("sphere " + std::to_string(spheres.size() + 1) + " has no positive radius or no known centre",
                            "make the clump again with `pelletlab shape`", place_of(row, r.file()));
        spheres.push_back(sphere);
    }
    return spheres;
}

Provenance read_provenance(TableReader r) {
    Provenance p;
    p.tool = r.text("tool");
    p.version = r.text("version");
    p.git_hash = r.text("git_hash");
    p.verb = r.text("verb");
    const std::string seed = r.text("seed");
    const auto [rest, status] = std::from_chars(seed.data(), seed.data() + seed.size(), p.seed);
    if (status != std::errc() || rest != seed.data() + seed.size()) throw r.impossible("seed", "is not a whole number as text");
    TableReader hashes = r.table("input_hashes");
    for (const auto& [key, ignored] : hashes.raw()) {
        const std::string name(key.str());
        p.input_hashes[name] = hashes.text(name);
    }
    r.finish();
    return p;
}

MassSource read_mass_source(TableReader& r) {
    const std::string word = r.text("mass_source");
    std::vector<std::string> words;
    for (const MassSource source : {MassSource::target_mesh, MassSource::union_of_spheres, MassSource::density_matched_union}) {
        if (word == mass_source_name(source)) return source;
        words.push_back(mass_source_name(source));
    }
    const std::string guess = closest_word(word, words);
    throw r.impossible("mass_source", "is '" + word + "', which is not known" + (guess.empty() ? "" : "; did you mean '" + guess + "'?"));
}

}  // namespace

ClumpTemplate parse_clump(const std::string& text, const std::string& file) {
    const toml::table table = parse_toml(text, file);
    TableReader r(table, "", file);
    const auto* format = table.get_as<std::string>("format");
    if (format == nullptr || format->get() != clump_format_name)
        throw bad_input("this is no clump template of pelletlab",
                        "name a file made by `pelletlab shape`: it says format = \"" + std::string(clump_format_name) + "\"", {file});
    r.node("format");
    const toml::node& version = r.node("format_version");
    if (!version.is_integer() || version.as_integer()->get() != clump_format_version)
        throw bad_input("this version of the clump format is not known to this pelletlab", "use the pelletlab that wrote it, or make the clump again",
                        place_of(version, file));
    ClumpTemplate c;
    c.rigid.name = r.text("name");
    c.mass_source = read_mass_source(r);
    c.rigid.spheres = read_spheres(r);
    c.rigid.bounding_radius = bounding_radius(c.rigid.spheres);
    c.rigid.mass_properties = read_mass(r.table("mass_properties"));
    c.quality = read_quality(r.table("quality"));
    if (r.has("masses")) c.masses = read_masses(r.table("masses"));
    TableReader mesh = r.table("mesh");
    c.mesh_file = mesh.text("file");
    c.mesh_unit = mesh.text("unit");
    c.mesh_hash = mesh.text("sha256");
    mesh.finish();
    c.provenance = read_provenance(r.table("provenance"));
    r.finish();
    return c;
}

ClumpTemplate read_clump(const std::filesystem::path& file) {
    return parse_clump(read_text(file), file.string());
}

}  // namespace pelletlab::io
