// Schema and reference page: complete, valid, and the same as the files in docs/.
#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include "io/case_file.hpp"
#include "io/detail/case_keys.hpp"
#include "io/detail/case_value.hpp"
#include "io/files.hpp"
#include "tests/unit/io/support.hpp"

using namespace pelletlab;
using nlohmann::json;

namespace {

const json* schema_of(const json& root, const std::vector<std::string>& path) {
    const json* at = &root;
    for (const std::string& segment : path) {
        if (segment == "*") {
            at = &at->at("additionalProperties");
            continue;
        }
        if (!at->at("properties").contains(segment)) return nullptr;
        at = &at->at("properties").at(segment);
    }
    return at;
}

/// Does this JSON Schema (of the few words that ours uses) accept the value?
bool accepts(const json& schema, const json& value) {
    if (schema.contains("anyOf")) return std::any_of(schema["anyOf"].begin(), schema["anyOf"].end(), [&](const json& one) { return accepts(one, value); });
    if (schema.contains("enum")) return std::find(schema["enum"].begin(), schema["enum"].end(), value) != schema["enum"].end();
    const std::string type = schema.at("type");
    if (type == "string")
        return value.is_string() &&
               (!schema.contains("pattern") || std::regex_search(value.get<std::string>(), std::regex(schema["pattern"].get<std::string>())));
    if (type == "boolean") return value.is_boolean();
    if (type == "array")
        return value.is_array() && value.size() == schema.at("minItems") &&
               std::all_of(value.begin(), value.end(), [&](const json& v) { return accepts(schema["items"], v); });
    if (type == "integer" ? !value.is_number_integer() : !value.is_number()) return false;
    const double number = value.get<double>();
    return (!schema.contains("minimum") || number >= schema["minimum"].get<double>()) &&
           (!schema.contains("maximum") || number <= schema["maximum"].get<double>()) &&
           (!schema.contains("exclusiveMinimum") || number > schema["exclusiveMinimum"].get<double>()) &&
           (!schema.contains("exclusiveMaximum") || number < schema["exclusiveMaximum"].get<double>());
}

/// PELLETLAB_REGENERATE=1 writes the file anew instead of comparing.
void expect_same_as_file(const std::string& text, const std::string& name) {
    const std::filesystem::path file = std::filesystem::path(PELLETLAB_SOURCE_DIR) / "docs" / name;
    if (std::getenv("PELLETLAB_REGENERATE") != nullptr) io::write_text(file, text);
    EXPECT_TRUE(io::read_text(file) == text) << "docs/" << name << " is stale: run unit_io with PELLETLAB_REGENERATE=1 in the environment and commit the file";
}

}  // namespace

TEST(CaseDocuments, SchemaCoversEveryKeyAndAcceptsItsDefault) {
    const json root = json::parse(io::case_json_schema());
    Case c = io::default_case(Rig::drum);
    c.walls["vessel"] = {};
    for (const io::detail::CaseKey& key : io::detail::case_keys()) {
        const json* schema = schema_of(root, key.path);
        ASSERT_NE(schema, nullptr) << io::detail::path_text(key.path);
        const std::string name = key.path[0] == "contacts" ? "pellet-vessel" : "vessel";
        const json value = json::parse(io::detail::value_as_toml(key, key.get(c, name)));  // our TOML values are JSON, too
        EXPECT_TRUE(accepts(*schema, value)) << io::detail::path_text(key.path) << " = " << value;
        EXPECT_FALSE(accepts(*schema, json::object())) << io::detail::path_text(key.path);
        EXPECT_FALSE(schema->at("description").get<std::string>().empty());
        if (!key.has_dimension()) continue;
        EXPECT_FALSE(accepts(*schema, 5.0)) << io::detail::path_text(key.path);
        EXPECT_FALSE(accepts(*schema, "5")) << io::detail::path_text(key.path);
    }
    EXPECT_EQ(root.at("additionalProperties"), false);
    EXPECT_FALSE(accepts(*schema_of(root, {"contacts", "*", "restitution"}), 0.0));
    EXPECT_TRUE(accepts(*schema_of(root, {"contacts", "*", "restitution"}), "40 %"));
}

TEST(CaseDocuments, SchemaHasNoKeyThatTheTableLacks) {
    const json root = json::parse(io::case_json_schema());
    std::size_t leaves = 0;
    const std::function<void(const json&)> count = [&](const json& schema) {
        if (schema.contains("properties"))
            for (const auto& item : schema["properties"].items()) count(item.value());
        else if (schema.contains("additionalProperties"))
            count(schema["additionalProperties"]);
        else
            ++leaves;
    };
    count(root);
    EXPECT_EQ(leaves, io::detail::case_keys().size());
}

TEST(CaseDocuments, EveryKeyStandsInASectionAndHasAFullRow) {
    std::size_t rows = 0;
    for (const io::detail::CaseSection& section : io::detail::case_sections()) rows += io::detail::keys_of(section).size();
    EXPECT_EQ(rows, io::detail::case_keys().size());
    const std::string page = io::case_reference_markdown();
    for (const io::detail::CaseKey& key : io::detail::case_keys()) {
        EXPECT_THAT(page, testing::HasSubstr("| `" + key.leaf() + "` |"));
        EXPECT_FALSE(key.doc.empty()) << io::detail::path_text(key.path);
        EXPECT_EQ(key.doc.back(), '.') << io::detail::path_text(key.path);
    }
}

TEST(CaseDocuments, DefaultsLieInTheirRanges) {
    // Reading the default back through the parser applies the range of every key.
    for (const Rig rig : all_rigs) EXPECT_NO_THROW(io::parse_case(io::resolved_case_text(io::default_case(rig)), "a.toml"));
}

TEST(CaseDocuments, FilesInDocsAreUpToDate) {
    expect_same_as_file(io::case_reference_markdown(), "case-reference.md");
    expect_same_as_file(io::case_json_schema(), "case.schema.json");
}
