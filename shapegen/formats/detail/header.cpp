#include "shapegen/formats/detail/header.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/units.hpp"
#include "shapegen/formats/detail/scan.hpp"

namespace pelletlab::shapegen::formats::detail {

namespace {

constexpr std::string_view mark = "PelletLab clump:";

/// The word after `key` in `text`, up to a comma or a blank.
std::string word_after(std::string_view text, std::string_view key) {
    const std::size_t at = text.find(key);
    if (at == std::string_view::npos) return {};
    text.remove_prefix(at + key.size());
    return std::string(text.substr(0, std::min(text.find_first_of(", \t\r\""), text.size())));
}

/// The factor of a unit that the file itself names.
double factor_in_file(const FormatFile& file, const std::string& unit, Dimension dimension) {
    try {
        return unit_factor(unit, dimension);
    } catch (const Error& error) {
        throw bad_input(error.problem(), error.remedy(), {file.name});
    }
}

double unit_of(const FormatFile& file, const std::string& said, const std::string& asked, Dimension dimension, const std::string& quantity,
               const std::string& option) {
    if (said.empty() && asked.empty())
        throw bad_input("this file does not say in which unit its " + quantity + " is", "give the unit, for instance " + option, {file.name});
    const double by_file = said.empty() ? 0.0 : factor_in_file(file, said, dimension);
    const double by_option = asked.empty() ? 0.0 : unit_factor(asked, dimension);
    if (!said.empty() && !asked.empty() && by_file != by_option)
        throw bad_input("the file says its " + quantity + " is in " + quoted(said) + ", the option says " + quoted(asked), "leave the option away",
                        {file.name});
    return said.empty() ? by_option : by_file;
}

}  // namespace

Header find_header(const std::vector<FormatFile>& files) {
    Header header;
    for (const FormatFile& file : files) {
        const std::size_t at = file.content.find(mark);
        if (at == std::string::npos) continue;
        std::string_view line = file.content;
        line = line.substr(at + mark.size(), file.content.find_first_of("\r\n", at) - at - mark.size());
        header.name = word_after(line, " name ");
        header.length_unit = word_after(line, " length in ");
        header.mass_unit = word_after(line, " mass in ");
        if (const std::optional<double> density = parse_number(word_after(line, " density ")); density && *density > 0.0) header.density = density;
        return header;
    }
    return header;
}

double metre_of(const std::vector<FormatFile>& files, const Header& header, const ReadOptions& options) {
    return unit_of(main_file(files), header.length_unit, options.length_unit, dimension::length, "length", "mm or m");
}

double kilogram_of(const std::vector<FormatFile>& files, const Header& header, const ReadOptions& options) {
    return unit_of(main_file(files), header.mass_unit, options.mass_unit, dimension::mass, "mass", "kg or g");
}

const FormatFile& main_file(const std::vector<FormatFile>& files) {
    if (files.empty()) throw usage_error("no file to read a clump from");
    return files.front();
}

const FormatFile* companion(const std::vector<FormatFile>& files, std::string_view ending) {
    for (std::size_t i = 1; i < files.size(); ++i) {
        const std::string name = lower_case(files[i].name);
        if (name.size() >= ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0) return &files[i];
    }
    return nullptr;
}

void finish(const FormatFile& file, const Header& header, ImportedClump& clump) {
    check_count(file, clump.spheres);
    if (clump.name.empty()) clump.name = header.name;
    if (!clump.density) clump.density = header.density;
    if (!clump.mass && clump.volume && clump.density) clump.mass = *clump.volume * *clump.density;
    if (!clump.density && clump.volume && clump.mass) clump.density = *clump.mass / *clump.volume;
    if (!clump.volume && clump.mass && clump.density) clump.volume = *clump.mass / *clump.density;
    if (!clump.inertia && clump.unit_density_inertia && clump.density) clump.inertia = Mat3(*clump.unit_density_inertia * *clump.density);
    for (const std::optional<double>& value : {clump.mass, clump.volume, clump.density})
        if (value && !(std::isfinite(*value) && *value > 0.0))
            throw bad_input("mass, volume and density must be positive and finite", "check the units", {file.name});
    if (clump.centre_of_mass && !clump.centre_of_mass->allFinite()) throw bad_input("the centre of mass is not finite", {}, {file.name});
    if (!clump.inertia) return;
    if (!clump.inertia->allFinite()) throw bad_input("the inertia is not finite", "check the units", {file.name});
    const double largest = clump.inertia->cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) throw bad_input("the inertia is zero", "check the units", {file.name});
    const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(*clump.inertia / largest, Eigen::EigenvaluesOnly).eigenvalues();
    if (!(moments.allFinite() && moments[0] > 0.0))
        throw bad_input("the inertia is not that of a body: its principal moments must be positive", {}, {file.name});
    if (moments[0] + moments[1] < moments[2] * (1.0 - 1e-6))
        clump.notes.emplace_back("the largest principal moment exceeds the sum of the others: no body has such an inertia");
}

}  // namespace pelletlab::shapegen::formats::detail
