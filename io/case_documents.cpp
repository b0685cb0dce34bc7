// JSON Schema and reference page, both from the table of keys.
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/case_file.hpp"
#include "io/detail/case_keys.hpp"
#include "io/detail/case_value.hpp"

namespace pelletlab::io {

namespace {

using namespace detail;
using Json = nlohmann::ordered_json;

const char* const number_pattern = "^\\s*[+-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+-]?[0-9]+)?\\s*";

std::string unit_words(const CaseKey& key) {
    std::string words;
    for (const std::string& unit : usual_units(key.dimension)) words += (words.empty() ? "" : ", ") + unit;
    return words;
}

Json quantity_schema(const CaseKey& key) {
    Json schema = {{"type", "string"}, {"pattern", std::string(number_pattern) + "[^\\s0-9.].*$"}};
    schema["examples"] = {format_quantity(1.0, key.unit)};
    return schema;
}

Json number_schema(const CaseKey& key) {
    if (key.has_dimension()) return quantity_schema(key);
    Json number = {{"type", key.kind == KeyKind::whole ? "integer" : "number"}};
    const Range& r = key.range;
    if (std::isfinite(r.lower)) number[r.lower_open ? "exclusiveMinimum" : "minimum"] = r.lower;
    if (std::isfinite(r.upper)) number[r.upper_open ? "exclusiveMaximum" : "maximum"] = r.upper;
    if (key.kind == KeyKind::whole) return number;
    return {{"anyOf", Json::array({number, {{"type", "string"}, {"pattern", std::string(number_pattern) + "%?\\s*$"}}})}};
}

Json value_schema(const CaseKey& key) {
    switch (key.kind) {
        case KeyKind::number:
        case KeyKind::whole:
            return number_schema(key);
        case KeyKind::flag:
            return {{"type", "boolean"}};
        case KeyKind::text:
            return {{"type", "string"}};
        case KeyKind::choice:
            return {{"enum", key.choices}};
        case KeyKind::vector3d:
            break;
    }
    return {{"type", "array"}, {"items", number_schema(key)}, {"minItems", 3}, {"maxItems", 3}};
}

std::string description(const CaseKey& key) {
    std::string text = key.doc;
    if (!range_text(key).empty()) text += " Allowed: " + range_text(key) + ".";
    if (key.has_dimension()) text += " Text with a unit of " + dimension_name(key.dimension) + ": " + unit_words(key) + ", …";
    return text;
}

/// Default of the key as it stands in a file; for materials and contacts those of the named ones, those of other rigs where they differ; empty where a wall
/// must state it.
std::string default_words(const CaseKey& key) {
    const Case tube = default_case(Rig::tube);
    if (key.path[0] == "walls") {
        if (!key.optional) return "";
        Case example = tube;
        example.walls["one"] = {};
        return value_as_toml(key, key.get(example, "one"));
    }
    if (key.path.size() == 3) {
        std::string words;
        for (const std::string& name : names_in(tube, {{key.path[0], "*"}, ""}))
            words += (words.empty() ? "" : ", ") + name + ": " + value_as_toml(key, key.get(tube, name));
        return words;
    }
    if (key.path[0] == "rig") return value_as_toml(key, key.get(tube, ""));
    const std::string in_tube = value_as_toml(key, key.get(tube, ""));
    std::string others;
    for (const Rig rig : all_rigs)
        if (const std::string in_rig = value_as_toml(key, key.get(default_case(rig), "")); in_rig != in_tube)
            others += (others.empty() ? "" : ", ") + rig_name(rig) + ": " + in_rig;
    return others.empty() ? in_tube : in_tube + " (" + others + ")";
}

Json section_schema(const CaseSection& section) {
    Json properties = Json::object();
    for (const CaseKey* key : keys_of(section)) {
        Json schema = value_schema(*key);
        const std::string words = default_words(*key);
        schema["description"] = description(*key) + (words.empty() ? "" : " Default: " + words + ".");
        if (key->has_dimension()) schema["x-dimension"] = dimension_name(key->dimension);
        properties[key->leaf()] = schema;
    }
    return {{"type", "object"}, {"description", section.doc}, {"properties", properties}, {"additionalProperties", false}};
}

std::string type_words(const CaseKey& key) {
    switch (key.kind) {
        case KeyKind::number:
            return key.has_dimension() ? dimension_name(key.dimension) : "number";
        case KeyKind::whole:
            return "whole number";
        case KeyKind::flag:
            return "true or false";
        case KeyKind::text:
            return "text";
        case KeyKind::choice: {
            std::string words;
            for (const std::string& choice : key.choices) words += (words.empty() ? "`\"" : " or `\"") + choice + "\"`";
            return words;
        }
        case KeyKind::vector3d:
            break;
    }
    return "three × " + (key.has_dimension() ? dimension_name(key.dimension) : std::string("number"));
}

}  // namespace

std::string case_json_schema() {
    Json root = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "PelletLab case"}};
    for (const CaseSection& section : case_sections()) {
        const Json schema = section_schema(section);
        if (section.path.empty())
            root.update(schema);
        else if (section.path.size() == 1)
            root["properties"][section.path[0]] = schema;
        else
            root["properties"][section.path[0]] = {{"type", "object"}, {"description", section.doc}, {"additionalProperties", schema}};
    }
    return root.dump(2) + "\n";
}

std::string case_reference_markdown() {
    std::string text =
        "# Keys of a case file\n\n"
        "Made by `pelletlab case reference` from the table in `io/case_keys.cpp`; a test compares the two.\n\n"
        "A case is a TOML file. A value with a dimension is a text with its unit (`\"3.12 mm\"`, `\"20 rpm\"`); a bare number there is an error. "
        "Plain numbers may be written in percent (`\"20 %\"`). Every key has a default; unknown keys are errors. On the command line `--set key=value` "
        "replaces a value, for instance `--set \"drum.speed=50 rpm\"`.\n\n"
        "Units are products of powers of m, dm, cm, mm, um, nm, km, in, kg, g, mg, t, s, ms, us, min, h, rad, deg, rev, rpm, Hz, kHz, N, mN, kN, Pa, kPa, MPa, "
        "GPa, bar, J, mJ, W: `kg/m^3`, `m/s^2`, `rad/s`.\n";
    for (const CaseSection& section : case_sections()) {
        text += "\n## " + (section.path.empty() ? std::string("Top of the file") : "[" + path_text(section.path) + "]") + "\n\n" + section.doc + "\n\n";
        text += "| key | value | default | allowed | meaning |\n| --- | --- | --- | --- | --- |\n";
        for (const CaseKey* key : keys_of(section)) {
            const std::string words = default_words(*key);
            text += "| `" + key->leaf() + "` | " + type_words(*key) + " | " + (words.empty() ? "none" : "`" + words + "`") + " | " + range_text(*key) + " | " +
                    key->doc + " |\n";
        }
    }
    return text;
}

}  // namespace pelletlab::io
