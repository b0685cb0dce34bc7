#include "apps/shape_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/terminal.hpp"

namespace pelletlab::apps {

std::string millimetres(double metres) {
    return fmt::format("{:.4f} mm", 1e3 * metres);
}

std::string signed_percent(double share) {
    const std::string text = fmt::format("{:+.2f} %", 100.0 * share);
    return text == "-0.00 %" || text == "+0.00 %" ? "0.00 %" : text;
}

std::string name_of(MassSource source) {
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

void print_mass_of(const ClumpTemplate& clump, const std::string& source) {
    const MassProperties& mass = clump.rigid.mass_properties;
    const Vec3 inertia = mass.principal_inertia;
    print_pairs({{"mass properties from", source},
                 {"mass", fmt::format("{:.4f} mg at {:.5g} kg/m³", 1e6 * mass.mass, mass.density)},
                 {"principal inertia", fmt::format("{:.5g}  {:.5g}  {:.5g} kg m²", inertia.x(), inertia.y(), inertia.z())}});
}

void print_masses(const shapegen::MadeClump& made) {
    const MassSource source = made.clump.mass_source;
    std::vector<std::vector<std::string>> rows{{"mass properties", "volume mm³", "mass mg", "density kg/m³", "principal inertia mg mm², ascending", ""}};
    const auto add = [&rows](const std::string& name, const MassProperties& m, bool exported) {
        Vec3 i = 1e12 * m.principal_inertia;
        std::sort(i.data(), i.data() + 3);  // the bodies' axes are ordered in other ways
        rows.push_back({name, fmt::format("{:.4f}", 1e9 * m.volume), fmt::format("{:.4f}", 1e6 * m.mass), fmt::format("{:.5g}", m.density),
                        fmt::format("{:.4f} {:.4f} {:.4f}", i.x(), i.y(), i.z()), exported ? "<- the clump's" : ""});
    };
    add("mesh", made.clump.masses.mesh, source == MassSource::target_mesh);
    add("union of the spheres", made.clump.masses.of_union, source == MassSource::union_of_spheres);
    if (source == MassSource::density_matched_union) add("union, density matched", made.clump.rigid.mass_properties, true);
    add("sum of the spheres", made.clump.masses.sum, false);
    print_table(rows);
}

void print_surface(const shapegen::MadeClump& made) {
    const shapegen::SurfaceReport& s = made.surface;
    const double degree = 180.0 / std::numbers::pi;
    std::vector<std::pair<std::string, std::string>> rows;
    const auto roughness = [](double sq, double sz) { return fmt::format("Sq {:.4f} mm, Sz {:.4f} mm", 1e3 * sq, 1e3 * sz); };
    if (s.flat_sq > 0.0) rows.emplace_back("roughness of flat faces", roughness(s.flat_sq, s.flat_sz));
    if (s.curved_sq > 0.0) rows.emplace_back("roughness of curved faces", roughness(s.curved_sq, s.curved_sz));
    rows.emplace_back("normals off by", fmt::format("{:.1f}° mean, {:.1f}° for 95 %", degree * s.normal_mean, degree * s.normal_p95));
    if (std::isfinite(s.edge_radius_mean))
        rows.emplace_back("edges rounded", fmt::format("{:.3f} mm mean, {:.3f} mm most", 1e3 * s.edge_radius_mean, 1e3 * s.edge_radius_max));
    rows.emplace_back("a plane rests off by", fmt::format("{:.4f} mm rms, {:.4f} mm most", 1e3 * s.support_rms, 1e3 * s.support_max));
    const std::string flat = std::isfinite(s.contacts_on_flat) ? fmt::format("; on flat faces {:.3g}, most {}", s.contacts_on_flat, s.most_on_flat) : "";
    rows.emplace_back("spheres touching a plane",
                      fmt::format("{:.3g} mean, {} most (pressed in {:.4f} mm){}", s.contacts_any_way, s.most_any_way, 1e3 * s.press, flat));
    std::string pieces = s.components == 1 ? "" : fmt::format("; {} pieces that do not touch each other", s.components);
    if (s.sealed_volume > 0.0) pieces += fmt::format("; {:.3g} mm³ sealed inside", 1e9 * s.sealed_volume);
    rows.emplace_back("radii", fmt::format("{:.4f} to {:.4f} mm{}", 1e3 * s.smallest_radius, 1e3 * s.largest_radius, pieces));
    print_pairs(rows);
}

void print_cost(const shapegen::MadeClump& made) {
    print_pairs({{"DEM cost", fmt::format("{:.2f} x the study's Shape 2 (time step {:.3g} s, {:.3g} contacts a plane)", made.relative_cost, made.cost.time_step,
                                          made.cost.contacts_mean)}});
}

void print_fit(const shapegen::MadeClump& made, double reading) {
    std::string status = "converged";
    if (made.fit.status == shapegen::FitStatus::stopped_early)
        status = "stopped early: the steps were used up while it still gained a little; the fit is sound";
    if (made.fit.status == shapegen::FitStatus::limit_not_met) status = "the limit on contacts could not be kept: this is the nearest";
    if (made.fit.status == shapegen::FitStatus::criterion_not_met) status = "the criterion is not met within what was allowed: this is the best allowed";
    std::vector<std::pair<std::string, std::string>> rows{{"fit", status}};
    if (made.attempts > 1) rows.emplace_back("fits made", std::to_string(made.attempts));
    if (!made.fit.symmetry.trivial()) rows.emplace_back("symmetry", shapegen::describe(made.fit.symmetry));
    rows.emplace_back("search distance", fmt::format("off by at most {:.2g} mm (figures use the exact one)", 1e3 * made.search_error));
    rows.emplace_back("time", fmt::format("{:.2f} s reading, {:.2f} s distance, {:.2f} s seeds, {:.2f} s search, {:.2f} s finish, {:.2f} s figures", reading,
                                          made.times.distance, made.fit.times.seeds, made.fit.times.search, made.fit.times.finish, made.times.quality));
    print_pairs(rows);
}

double worst_inertia_error(const FitQuality& quality) {
    const Vec3& error = quality.inertia_error;
    return error.maxCoeff() >= -error.minCoeff() ? error.maxCoeff() : error.minCoeff();
}

void print_quality_table(const std::vector<QualityRow>& list) {
    std::vector<std::vector<std::string>> rows{{"shape", "spheres", "volume", "worst inertia", "mean", "rms", "max", "sym. difference"}};
    double bound = 0.0;
    for (const QualityRow& row : list) {
        const FitQuality& q = row.quality;
        rows.push_back({row.name, std::to_string(row.spheres), signed_percent(q.volume_error), signed_percent(worst_inertia_error(q)), millimetres(q.both.mean),
                        millimetres(q.both.rms), millimetres(q.both.max), fmt::format("{:.2f} %", 100.0 * q.symmetric_difference)});
        bound = std::max(bound, q.distance_error_bound);
    }
    print_line("Distance between the surface of the clump and the body, both ways:");
    print_table(rows);
    print_line(fmt::format("  (error of the distance query itself: at most {:.1e} mm)", 1e3 * bound));
}

}  // namespace pelletlab::apps
