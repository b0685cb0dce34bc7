#include "io/detail/case_value.hpp"

#include <charconv>
#include <cmath>

#include "io/case_file.hpp"
#include "io/detail/toml_text.hpp"

namespace pelletlab::io::detail {

namespace {

std::string quoted_list(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "\"" : ", \"") + word + "\"";
    return text;
}

/// «write for instance diameter = "52 mm"»
std::string advice(const CaseKey& key) {
    return "write for instance " + key.leaf() + " = " + example_value(key);
}

std::string number_text(const CaseKey& key, double value) {
    return format_quantity(value, key.unit);
}

void check_range(const CaseKey& key, const std::string& name, double value, const Place& place) {
    const Range& r = key.range;
    const bool low = r.lower_open ? !(value > r.lower) : !(value >= r.lower);
    const bool high = r.upper_open ? !(value < r.upper) : !(value <= r.upper);
    if ((low && std::isfinite(r.lower)) || (high && std::isfinite(r.upper)) || !std::isfinite(value))
        throw bad_input(name + " = " + number_text(key, value) + " is out of range",
                        "allowed: " + (range_text(key).empty() ? "any finite number" : range_text(key)), place);
}

double checked_quantity(const CaseKey& key, const std::string& name, const std::string& text, const Place& place) {
    try {
        return parse_quantity(text, key.dimension);
    } catch (const Error& error) {
        throw bad_input(name + ": " + error.problem(), error.remedy().empty() ? advice(key) : error.remedy(), place);
    }
}

Error wrong_type(const CaseKey& key, const std::string& name, const std::string& wanted, const std::string& found, const Place& place) {
    return bad_input(name + " must be " + wanted + ", and this is " + found, advice(key), place);
}

double number_from_node(const CaseKey& key, const std::string& name, const toml::node& node, const Place& place) {
    if (const auto* text = node.as_string()) return checked_quantity(key, name, text->get(), place);
    const bool is_number = node.is_integer() || node.is_floating_point();
    if (key.has_dimension()) {
        if (!is_number) throw wrong_type(key, name, "a text with number and unit", kind_of_node(node), place);
        std::string units;
        for (const std::string& unit : usual_units(key.dimension)) units += (units.empty() ? "" : ", ") + unit;
        throw bad_input(name + " is a bare number without a unit", advice(key) + "; units of this quantity (" + dimension_name(key.dimension) + "): " + units,
                        place);
    }
    if (!is_number) throw wrong_type(key, name, "a number", kind_of_node(node), place);
    return node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
}

std::string check_choice(const CaseKey& key, const std::string& name, const std::string& word, const Place& place) {
    for (const std::string& choice : key.choices)
        if (word == choice) return word;
    const std::string guess = closest_word(word, key.choices);
    throw bad_input(name + " = \"" + word + "\" is not known",
                    (guess.empty() ? "" : "did you mean \"" + guess + "\"? ") + ("allowed: " + quoted_list(key.choices)), place);
}

std::string unquoted(std::string text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.erase(text.begin());
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.pop_back();
    if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front()) return text.substr(1, text.size() - 2);
    return text;
}

CaseValue vector_from_text(const CaseKey& key, const std::string& name, std::string text, const Place& place) {
    text = unquoted(text);
    if (text.size() >= 2 && text.front() == '[' && text.back() == ']') text = text.substr(1, text.size() - 2);
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == ',')
            parts.emplace_back();
        else
            parts.back() += c;
    }
    if (parts.size() != 3) throw bad_input(name + " needs three values, and there are " + std::to_string(parts.size()), advice(key), place);
    Vec3 vector;
    for (int i = 0; i < 3; ++i) {
        vector[i] = checked_quantity(key, name, unquoted(parts[static_cast<std::size_t>(i)]), place);
        check_range(key, name, vector[i], place);
    }
    return vector;
}

}  // namespace

CaseValue value_from_toml(const CaseKey& key, const std::string& name, const toml::node& node, const std::string& file) {
    const Place place = place_of(node, file);
    switch (key.kind) {
        case KeyKind::number: {
            const double value = number_from_node(key, name, node, place);
            check_range(key, name, value, place);
            return value;
        }
        case KeyKind::whole: {
            if (!node.is_integer()) throw wrong_type(key, name, "a whole number", kind_of_node(node), place);
            const std::int64_t value = node.as_integer()->get();
            check_range(key, name, static_cast<double>(value), place);
            return static_cast<std::uint64_t>(value);
        }
        case KeyKind::flag:
            if (!node.is_boolean()) throw wrong_type(key, name, "true or false", kind_of_node(node), place);
            return node.as_boolean()->get();
        case KeyKind::text:
        case KeyKind::choice: {
            if (!node.is_string()) throw wrong_type(key, name, "a text", kind_of_node(node), place);
            const std::string& text = node.as_string()->get();
            return key.kind == KeyKind::choice ? check_choice(key, name, text, place) : text;
        }
        case KeyKind::vector3d:
            break;
    }
    const toml::array* list = node.as_array();
    if (list == nullptr)
        throw wrong_type(key, name, key.has_dimension() ? "a list of three texts with number and unit" : "a list of three numbers", kind_of_node(node), place);
    if (list->size() != 3) throw bad_input(name + " needs three values, and there are " + std::to_string(list->size()), advice(key), place);
    Vec3 vector;
    for (std::size_t i = 0; i < 3; ++i) {
        const toml::node& element = *list->get(i);
        const Place element_place = place_of(element, file);
        vector[static_cast<Eigen::Index>(i)] = number_from_node(key, name, element, element_place);
        check_range(key, name, vector[static_cast<Eigen::Index>(i)], element_place);
    }
    return vector;
}

CaseValue value_from_text(const CaseKey& key, const std::string& name, const std::string& text, const Place& place) {
    const std::string word = unquoted(text);
    switch (key.kind) {
        case KeyKind::number: {
            const double value = checked_quantity(key, name, word, place);
            check_range(key, name, value, place);
            return value;
        }
        case KeyKind::whole: {
            std::int64_t value = 0;
            const auto [rest, status] = std::from_chars(word.data(), word.data() + word.size(), value);
            if (status != std::errc() || rest != word.data() + word.size() || word.empty())
                throw wrong_type(key, name, "a whole number", "'" + word + "'", place);
            check_range(key, name, static_cast<double>(value), place);
            return static_cast<std::uint64_t>(value);
        }
        case KeyKind::flag:
            if (word != "true" && word != "false") throw wrong_type(key, name, "true or false", "'" + word + "'", place);
            return word == "true";
        case KeyKind::text:
            return word;
        case KeyKind::choice:
            return check_choice(key, name, word, place);
        case KeyKind::vector3d:
            break;
    }
    return vector_from_text(key, name, text, place);
}

std::string value_as_toml(const CaseKey& key, const CaseValue& value) {
    switch (key.kind) {
        case KeyKind::number: {
            const std::string text = number_text(key, std::get<double>(value));
            return key.has_dimension() ? toml_string(text) : text;
        }
        case KeyKind::whole:
            return std::to_string(std::get<std::uint64_t>(value));
        case KeyKind::flag:
            return std::get<bool>(value) ? "true" : "false";
        case KeyKind::text:
        case KeyKind::choice:
            return toml_string(std::get<std::string>(value));
        case KeyKind::vector3d:
            break;
    }
    const Vec3& vector = std::get<Vec3>(value);
    std::string text;
    for (int i = 0; i < 3; ++i) text += (i == 0 ? "" : ", ") + (key.has_dimension() ? toml_string(number_text(key, vector[i])) : number_text(key, vector[i]));
    return "[" + text + "]";
}

std::string range_text(const CaseKey& key) {
    const Range& r = key.range;
    const bool lower = std::isfinite(r.lower), upper = std::isfinite(r.upper);
    const std::string low = number_text(key, r.lower), high = number_text(key, r.upper);
    if (lower && upper && !r.lower_open && !r.upper_open) return low + " to " + high;
    std::string text;
    if (lower) text += (r.lower_open ? "> " : "≥ ") + low;
    if (lower && upper) text += " and ";
    if (upper) text += (r.upper_open ? "< " : "≤ ") + high;
    return text;
}

std::string example_value(const CaseKey& key) {
    Case example = default_case(Rig::tube);
    ExtraWall& wall = example.walls["pellet"];
    wall.radius = wall.far_radius = wall.length = 0.01, wall.size = Vec3::Constant(0.01);
    const std::string name = key.path[0] == "contacts" ? "pellet-pellet" : "pellet";
    return value_as_toml(key, key.get(example, name));
}

}  // namespace pelletlab::io::detail
