// Quantities as people write them, «3.12 mm», «20 rpm», «1800 kg/m^3», turned into SI numbers and back.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pelletlab {

/// Exponents of the base units; an angle counts as a base unit here so that «20 rpm» is not mistaken for «20 Hz».
struct Dimension {
    int metre = 0, kilogram = 0, second = 0, radian = 0;
    bool operator==(const Dimension&) const = default;
};

namespace dimension {
inline constexpr Dimension none{};
inline constexpr Dimension length{1, 0, 0, 0};
inline constexpr Dimension area{2, 0, 0, 0};
inline constexpr Dimension volume{3, 0, 0, 0};
inline constexpr Dimension mass{0, 1, 0, 0};
inline constexpr Dimension time{0, 0, 1, 0};
inline constexpr Dimension angle{0, 0, 0, 1};
inline constexpr Dimension moment_of_inertia{2, 1, 0, 0};
inline constexpr Dimension density{-3, 1, 0, 0};
inline constexpr Dimension pressure{-1, 1, -2, 0};
inline constexpr Dimension velocity{1, 0, -1, 0};
inline constexpr Dimension acceleration{1, 0, -2, 0};
inline constexpr Dimension rotation_speed{0, 0, -1, 1};
inline constexpr Dimension force{1, 1, -2, 0};
inline constexpr Dimension energy{2, 1, -2, 0};
inline constexpr Dimension surface_energy{0, 1, -2, 0};
inline constexpr Dimension frequency{0, 0, -1, 0};
inline constexpr Dimension viscosity{-1, 1, -1, 0};
}  // namespace dimension

/// Value in SI units of a text «number unit»: blanks between them are optional, the number may be 1e-5, a unit is a product of
/// powers such as kg/m^3 or m/s^2. Rounded once where the unit is a power of ten of SI: «3.12 mm» is the double nearest to 0.00312. Throws Error(bad_input) for
/// a missing unit, an unknown one (with a suggestion) or one of another dimension.
double parse_quantity(std::string_view text, Dimension expected);

/// Factor that turns a number in `unit` into SI: unit_factor("mm") == 1e-3. Throws as parse_quantity.
double unit_factor(std::string_view unit, Dimension expected);

/// Dimension of a unit: unit_dimension("mm/s") == dimension::velocity. Throws Error(bad_input) for an unknown one.
Dimension unit_dimension(std::string_view unit);

/// «3.12 mm» for (0.00312, "mm"): the shortest text that parse_quantity turns into the same double; in SI units where `unit` has no such text
/// (that happens to units that are no power of ten of SI, such as rpm, and near the ends of the range of a double).
std::string format_quantity(double value_in_si, std::string_view unit);

/// The SI unit of a dimension in words of this reader, for instance «kg/m^3»; empty for a plain number.
std::string si_unit(Dimension dimension);

/// A few usual units of the dimension, the first one preferred: for error messages, help texts and the JSON Schema.
std::vector<std::string> usual_units(Dimension dimension);

/// «length», «density», …: the name for messages and the reference page.
std::string dimension_name(Dimension dimension);

}  // namespace pelletlab
