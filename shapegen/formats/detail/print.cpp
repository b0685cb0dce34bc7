#include "shapegen/formats/detail/print.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "core/units.hpp"

namespace pelletlab::shapegen::formats::detail {

std::string exact(double value) {
    if (value == 0.0) return "0";
    std::array<char, 32> text{};
    const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), result.ptr};
}

std::string plain(double value, int decimals) {
    std::array<char, 512> text{};
    const auto result = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals);
    if (result.ec != std::errc()) return exact(value);
    std::string digits(text.data(), result.ptr);
    if (digits.find('.') != std::string::npos) {
        digits.erase(digits.find_last_not_of('0') + 1);
        if (digits.back() == '.') digits.pop_back();
    }
    return digits == "-0" ? "0" : digits;
}

Units units_for(const WriteOptions& options, const std::string& usual_length, const std::string& usual_mass) {
    Units units;
    units.length = options.length_unit.empty() ? usual_length : options.length_unit;
    units.mass = options.mass_unit.empty() ? usual_mass : options.mass_unit;
    units.metre = unit_factor(units.length, dimension::length);
    units.kilogram = unit_factor(units.mass, dimension::mass);
    return units;
}

void require_complete(const ClumpTemplate& clump) {
    const RigidTemplate& rigid = clump.rigid;
    const MassProperties& mass = rigid.mass_properties;
    if (rigid.spheres.empty()) throw bad_input("the clump '" + rigid.name + "' has no spheres", "make it again");
    for (const Sphere& sphere : rigid.spheres)
        if (!sphere.centre.allFinite() || !std::isfinite(sphere.radius) || !(sphere.radius > 0.0))
            throw bad_input("the clump '" + rigid.name + "' has a sphere without a finite centre and a positive radius", "make it again");
    const bool usable = std::isfinite(mass.mass) && mass.mass > 0.0 && std::isfinite(mass.volume) && mass.volume > 0.0 && std::isfinite(mass.density) &&
                        mass.density > 0.0 && mass.principal_inertia.allFinite() && mass.principal_inertia.minCoeff() > 0.0;
    if (!usable) throw bad_input("the clump '" + rigid.name + "' lacks a positive mass, volume, density or inertia", "give it mass properties first");
}

std::string safe_name(const ClumpTemplate& clump) {
    std::string name;
    for (const char c : clump.rigid.name) {
        const bool allowed = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (allowed)
            name += c;
        else if (!name.empty() && name.back() != '_')
            name += '_';
        if (name.size() == 60) break;
    }
    while (!name.empty() && name.back() == '_') name.pop_back();
    if (name.empty()) return "pellet";
    return (name.front() >= '0' && name.front() <= '9') ? "pellet_" + name : name;
}

std::string header_line(const ClumpTemplate& clump, const Units& units) {
    return "PelletLab clump: name " + safe_name(clump) + ", length in " + units.length + ", mass in " + units.mass + ", density " +
           exact(clump.rigid.mass_properties.density) + " kg/m^3";
}

}  // namespace pelletlab::shapegen::formats::detail
