#include "apps/shape_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
