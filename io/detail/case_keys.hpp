// The one table that knows every key of a case file: parser, defaults, `case new`, JSON Schema and reference page all walk through it.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "core/case.hpp"
#include "core/units.hpp"

namespace pelletlab::io::detail {

/// Value of a key in SI; which alternative it is follows from KeyKind.
using CaseValue = std::variant<double, std::uint64_t, bool, std::string, Vec3>;

enum class KeyKind {
    number,    ///< double; with a dimension it is a text «number unit» in the file
    whole,     ///< std::uint64_t
    flag,      ///< bool
    text,      ///< std::string
    choice,    ///< std::string, one of `choices`
    vector3d,  ///< Vec3: a list of three numbers with unit
};

/// Allowed values in SI; an open end excludes the limit itself.
struct Range {
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();
    bool lower_open = true;
    bool upper_open = true;
};

struct CaseKey {
    std::vector<std::string> path;  ///< {"tube", "diameter"}; the segment "*" stands for any name: {"materials", "*", "density"}
    KeyKind kind = KeyKind::number;
    Dimension dimension;
    std::string unit;  ///< printed with the value; empty for plain numbers
    Range range;
    std::vector<std::string> choices;                                    ///< of KeyKind::choice
    bool optional = false;                                               ///< a material, contact or wall of any name may leave it out
    std::string doc;                                                     ///< one line
    std::function<CaseValue(const Case&, const std::string& name)> get;  ///< `name` fills the «*»
    std::function<void(Case&, const std::string& name, const CaseValue&)> set;

    bool has_dimension() const { return dimension != dimension::none; }
    std::string leaf() const { return path.back(); }
};

/// A table of the file, [tube] for instance; the keys of the file itself belong to the section with an empty path.
struct CaseSection {
    std::vector<std::string> path;
    std::string doc;
};

const std::vector<CaseKey>& case_keys();
/// Rows of it that stand in a file of their own.
std::vector<CaseKey> keys_of_piles_and_testers();
std::vector<CaseKey> keys_of_extra_walls();
const std::vector<CaseSection>& case_sections();

/// Keys that stand directly in the section, in the order of the table.
std::vector<const CaseKey*> keys_of(const CaseSection& section);

/// «tube.diameter», «materials.<name>.density».
std::string path_text(const std::vector<std::string>& path);

/// True when the rig takes no notice of the section: [drum] for a tube.
bool is_idle_section(const CaseSection& section, Rig rig);

/// Names that fill the «*» of a section in this case: its materials, contacts, walls; one empty name for a section without «*».
std::vector<std::string> names_in(const Case& c, const CaseSection& section);

/// Materials and contacts that need not be written: the study's pellet and vessel. Null when there is none of that name.
const Material* default_material(const std::string& name);
const ContactParameters* default_contact(const std::string& name);

/// Material of the rig's walls.
const std::string& wall_material(const Case& c);

}  // namespace pelletlab::io::detail
