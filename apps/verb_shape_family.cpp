// pelletlab shape family: clumps of worn, oval, long and large pellets, same number of spheres, for «rounded pellets» and «size spread».
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>

#include "apps/body_options.hpp"
#include "apps/shape_report.hpp"
#include "apps/shape_settings.hpp"
#include "apps/shape_stage.hpp"
#include "apps/shape_verbs.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "io/files.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

struct FamilyOptions {
    BodyOptions body;
    std::string folder = "family", density = "1800 kg/m^3", mode = "mean";
    std::vector<std::string> rim_radii, ovalities;
    std::string size_spread, length_spread;
    std::uint32_t spheres = 24;
    std::uint64_t seed = 1;
    bool force = false;
};

/// One pellet of the family. Weights of members that belong together add up to 1: a mean over them is that over a normal distribution, exact for polynomials
/// up to the fifth degree (three-point Gauss–Hermite rule).
struct Member {
    std::string name, what;
    std::string value;
    double weight = 1.0;
    BodyRequest body;
};

double share(const std::string& text, const std::string& option) {
    const double value = share_of(text, option);
    if (!(value >= 0.0 && value < 0.5)) throw bad_input(option + " of " + text + " is out of reach", "give less than 50%");
    return value;
}

void add_spread(std::vector<Member>& members, const FamilyOptions& options, const std::string& kind, const std::string& text, bool along_z_only) {
    if (text.empty()) return;
    const double sigma = share(text, "--" + kind + "-spread"), step = std::sqrt(3.0) * sigma;
    if (sigma == 0.0) throw bad_input("a spread of " + text + " makes the same pellet three times", "give for instance 3%, or leave --" + kind + "-spread out");
    for (const auto& [name, factor, weight] : {std::tuple{"small", 1.0 - step, 1.0 / 6.0}, {"middle", 1.0, 2.0 / 3.0}, {"large", 1.0 + step, 1.0 / 6.0}}) {
        Member member{kind + "-" + name, kind + " factor", fmt::format("{:.6g}", factor), weight, body_request(options.body)};
        member.body.stretch = along_z_only ? Vec3(1.0, 1.0, factor) : Vec3::Constant(factor);
        members.push_back(member);
    }
}

std::vector<Member> members_of(const FamilyOptions& options) {
    std::vector<Member> members;
    for (const std::string& text : options.rim_radii) {
        const double radius = parse_quantity(text, dimension::length);
        if (!options.body.parametric.starts_with("cylinder"))
            throw usage_error("rims are rounded on a parametric cylinder only", "give --body cylinder:diameter=3.12mm,height=2.96mm instead of a mesh file");
        if (options.body.parametric.find("rim_radius") != std::string::npos) throw usage_error("rim_radius is given twice", "leave it out of --body");
        Member member{fmt::format("rim-{:.3g}mm", 1e3 * radius), "rim radius", fmt::format("{:.6g} mm", 1e3 * radius), 1.0, body_request(options.body)};
        const bool bare = options.body.parametric.find(':') == std::string::npos;
        member.body.parametric += (bare ? ":" : ",") + fmt::format("rim_radius={:.17g}m", radius);
        members.push_back(member);
    }
    for (const std::string& text : options.ovalities) {
        const double oval = share(text, "--ovality");
        Member member{fmt::format("oval-{:.3g}", oval), "ovality", fmt::format("{:.6g}", oval), 1.0, body_request(options.body)};
        member.body.stretch = Vec3(std::sqrt(1.0 + oval), 1.0 / std::sqrt(1.0 + oval), 1.0);  // widest / narrowest = 1 + ovality, the same cross-section
        members.push_back(member);
    }
    add_spread(members, options, "size", options.size_spread, false);
    add_spread(members, options, "length", options.length_spread, true);
    if (members.empty())
        throw usage_error("a family needs something that varies", "give --rim-radius 0mm,0.1mm,0.2mm, --ovality 0,5%, --size-spread 3% or --length-spread 3%");
    return members;
}

void run_family(const FamilyOptions& options) {
    const Stopwatch stopwatch;
    const std::vector<Member> members = members_of(options);
    const fs::path folder = options.folder;
    ProgressPrinter printer;
    const ProgressSink tell = printer.sink();
    std::vector<QualityRow> rows;
    std::string csv = "member,varies,value,weight,spheres,volume [mm^3],mass [mg],mean [mm],rms [mm],max [mm],volume_error,worst_inertia_error,clump\n";
    std::size_t there = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const Member& member = members[i];
        tell({"family", static_cast<double>(i), static_cast<double>(members.size()), "clumps",
              i > 0 ? 60.0 * static_cast<double>(i) / stopwatch.seconds() : 0.0, "a minute", member.name});
        ShapeRequest request;
        request.body = member.body;
        request.settings.density = parse_quantity(options.density, dimension::density);
        request.settings.fit.mode = fit_modes().at(options.mode);
        request.settings.fit.sphere_count = options.spheres;
        request.settings.fit.seed = options.seed;
        request.settings.measure_surface = false;
        request.force = options.force;
        request.picture = false;
        request.output = folder / (member.name + ".clump.toml");
        BodyOnDisk body(member.body, folder / member.name, true);
        const QuietClump quiet = ensure_clump(request, body, {});
        body.keep();
        there += quiet.was_there ? 1 : 0;
        const FitQuality& q = quiet.clump.quality;
        const MassProperties& mass = quiet.clump.rigid.mass_properties;
        rows.push_back({member.name, quiet.clump.rigid.spheres.size(), q});
        csv += fmt::format("{},{},{},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", member.name, member.what, member.value, member.weight,
                           options.spheres, 1e9 * mass.volume, 1e6 * mass.mass, 1e3 * q.both.mean, 1e3 * q.both.rms, 1e3 * q.both.max, q.volume_error,
                           worst_inertia_error(q), member.name + ".clump.toml");
    }
    printer.finish();
    print_quality_table(rows);
    if (there > 0) print_line(fmt::format("  {} of {} clumps were there already", there, members.size()));
    io::write_text(folder / "family.csv", csv);
    print_written(folder / "family.csv", fmt::format("{} clumps and what sets them apart", members.size()));
    print_line(fmt::format("  took {}, peak memory {:.0f} MB", duration_text(stopwatch.seconds()), peak_memory_megabytes()));
}

}  // namespace

void add_shape_family(CLI::App& shape) {
    auto options = std::make_shared<FamilyOptions>();
    CLI::App* verb =
        shape.add_subcommand("family",
                             "Clumps of worn, oval, long and large pellets with the same number of spheres\n"
                             "  example: pelletlab shape family --body cylinder --rim-radius 0mm,0.1mm,0.2mm,0.3mm,0.4mm --size-spread 3% -n 24 -o family");
    add_body_options(*verb, options->body);
    verb->add_option("--rim-radius", options->rim_radii, "Wear: radii of the rims, with unit (parametric cylinder)")->delimiter(',');
    verb->add_option("--ovality", options->ovalities, "Widest / narrowest − 1, at the same cross-section: 0,5%")->delimiter(',');
    verb->add_option("--size-spread", options->size_spread,
                     "Standard deviation of the size: three pellets that stand for a normal distribution, with their weights");
    verb->add_option("--length-spread", options->length_spread, "The same for the length along z");
    verb->add_option("-n,--spheres", options->spheres, "Number of spheres of each")->check(CLI::Range(1, 2000))->capture_default_str();
    verb->add_option("--mode", options->mode, "Mode of the fit: mean, minimax, inside, outside, flat")
        ->check(CLI::IsMember(fit_modes()))
        ->capture_default_str();
    verb->add_option("--density", options->density, "Particle density, with unit")->capture_default_str();
    verb->add_option("--seed", options->seed, "Seed of the search")->capture_default_str();
    verb->add_option("-o,--output", options->folder, "Folder: every clump with its mesh, and family.csv")->capture_default_str();
    verb->add_flag("--force", options->force, "Make every clump again");
    verb->callback([options, &shape, verb] {
        refuse_options_of_shape(shape, *verb);
        run_family(*options);
    });
}

}  // namespace pelletlab::apps
