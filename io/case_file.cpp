#include "io/case_file.hpp"

#include <algorithm>
#include <tuple>

#include "io/detail/case_check.hpp"
#include "io/detail/case_keys.hpp"
#include "io/detail/case_value.hpp"
#include "io/detail/toml_text.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

using namespace detail;
using Path = std::vector<std::string>;

/// As the reader wrote it: «materials.glass.density», names in quotes where TOML wants them.
std::string written_path(const Path& path) {
    std::string text;
    for (const std::string& segment : path) text += (text.empty() ? "" : ".") + toml_key(segment);
    return text;
}

bool matches(const Path& pattern, const Path& path, std::size_t segments) {
    for (std::size_t i = 0; i < segments; ++i)
        if (pattern[i] != "*" && pattern[i] != path[i]) return false;
    return true;
}

const CaseKey* find_key(const Path& path) {
    for (const CaseKey& key : case_keys())
        if (key.path.size() == path.size() && matches(key.path, path, path.size())) return &key;
    return nullptr;
}

bool is_table_of_keys(const Path& path) {
    return std::any_of(case_keys().begin(), case_keys().end(),
                       [&path](const CaseKey& key) { return key.path.size() > path.size() && matches(key.path, path, path.size()); });
}

/// Name that fills the «*» of the key; empty when it has none.
std::string wildcard_name(const CaseKey& key, const Path& path) {
    for (std::size_t i = 0; i < path.size(); ++i)
        if (key.path[i] == "*") return path[i];
    return {};
}

Error unknown_key(const Path& path, const Place& place) {
    std::vector<std::string> siblings;
    std::string homes;  // tables that do have a key of this name
    for (const CaseKey& key : case_keys()) {
        if (key.path.size() >= path.size() && matches(key.path, path, path.size() - 1) && key.path[path.size() - 1] != "*")
            siblings.push_back(key.path[path.size() - 1]);
        if (key.leaf() == path.back()) homes += (homes.empty() ? "" : ", ") + path_text(key.path);
    }
    const std::string guess = closest_word(path.back(), siblings);
    std::string remedy = "remove it; `pelletlab case reference` lists all keys";
    if (!homes.empty()) remedy = "this name stands elsewhere: " + homes;
    if (!guess.empty())
        remedy = "did you mean '" + written_path([&] {
                     Path better = path;
                     better.back() = guess;
                     return better;
                 }()) +
                 "'?";
    return bad_input("unknown key '" + written_path(path) + "'", remedy, place);
}

struct Entry {
    Path path;
    Place key_place;
    const toml::node* node;
};

/// Leaves and unknown keys in the order in which they stand in the file; tables go to `places`.
class CaseReader {
public:
    explicit CaseReader(std::string file) : file_(std::move(file)), places_(file_) {}

    Case read(const std::string& text, const std::vector<std::string>& overrides) {
        const toml::table table = parse_toml(text, file_);
        std::vector<Entry> entries;
        collect(table, {}, entries);
        std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
            return std::tie(a.key_place.line, a.key_place.column) < std::tie(b.key_place.line, b.key_place.column);
        });
        std::vector<Override> changes;
        for (const std::string& override_text : overrides) changes.push_back(split_override(override_text));

        Case rig_only;  // the rig decides the other defaults, so it is read first
        for (const Entry& entry : entries)
            if (entry.path == Path{"rig"}) read_entry(rig_only, entry);
        for (const Override& change : changes)
            if (change.path == Path{"rig"}) apply(rig_only, change);

        Case c = default_case(rig_only.rig);
        c.materials.clear();
        c.contacts.clear();
        for (const auto& [section, name] : named_) add_named(c, section, name);
        for (const Entry& entry : entries) read_entry(c, entry);
        for (const Override& change : changes) apply(c, change);
        require_all_keys(c);
        add_default_materials(c);
        check_case(c, places_);
        return c;
    }

private:
    struct Override {
        Path path;
        std::string value;
        Place place;
    };

    void collect(const toml::table& table, const Path& path, std::vector<Entry>& entries) {
        for (const auto& [key, node] : table) {
            Path child = path;
            child.emplace_back(key.str());
            const Place place = place_of(key, file_);
            if (find_key(child) == nullptr && is_table_of_keys(child) && node.is_table()) {
                places_.set(written_path(child), place);
                if (child.size() == 2) named_.emplace_back(child[0], child[1]);
                collect(*node.as_table(), child, entries);
            } else {
                entries.push_back({std::move(child), place, &node});
            }
        }
    }

    void read_entry(Case& c, const Entry& entry) {
        const CaseKey* key = find_key(entry.path);
        const std::string name = written_path(entry.path);
        if (key == nullptr && is_table_of_keys(entry.path))
            throw bad_input(name + " is a table of keys, and this is " + kind_of_node(*entry.node),
                            "write [" + name + "] on a line of its own and its keys below", entry.key_place);
        if (key == nullptr) throw unknown_key(entry.path, entry.key_place);
        set_value(c, *key, entry.path, value_from_toml(*key, name, *entry.node, file_), place_of(*entry.node, file_));
    }

    void apply(Case& c, const Override& change) {
        const CaseKey* key = find_key(change.path);
        if (key == nullptr && is_table_of_keys(change.path))
            throw bad_input(written_path(change.path) + " is a table of keys", "name one of its keys", change.place);
        if (key == nullptr) throw unknown_key(change.path, change.place);
        set_value(c, *key, change.path, value_from_text(*key, written_path(change.path), change.value, change.place), change.place);
    }

    void set_value(Case& c, const CaseKey& key, const Path& path, const CaseValue& value, const Place& place) {
        const std::string name = wildcard_name(key, path);
        if (key.path.size() > 1 && key.path[1] == "*") add_named(c, path[0], name);
        key.set(c, name, value);
        places_.set(written_path(path), place);
    }

    static void add_named(Case& c, const std::string& section, const std::string& name) {
        if (section == "materials") {
            const Material* known = default_material(name);
            c.materials.try_emplace(name, known != nullptr ? *known : Material{});
        } else if (section == "walls") {
            c.walls.try_emplace(name);
        } else {
            const ContactParameters* known = default_contact(name);
            c.contacts.try_emplace(name, known != nullptr ? *known : ContactParameters{});
        }
    }

    /// A material, contact or wall without a default of its own states all its keys.
    void require_all_keys(const Case& c) const {
        for (const CaseSection& section : case_sections()) {
            if (section.path.size() < 2) continue;
            for (const std::string& name : names_in(c, section)) {
                const bool has_default = (section.path[0] == "materials" && default_material(name) != nullptr) ||
                                         (section.path[0] == "contacts" && default_contact(name) != nullptr);
                if (has_default) continue;
                for (const CaseKey* key : keys_of(section)) {
                    const std::string table = written_path({section.path[0], name});
                    if (key->optional || places_.has(table + "." + key->leaf())) continue;
                    throw bad_input(table + " has no " + key->leaf(), "write for instance " + key->leaf() + " = " + example_value(*key),
                                    place_of_table(table, section));
                }
            }
        }
    }

    Place place_of_table(const std::string& table, const CaseSection& section) const {
        std::vector<std::string> paths{table};
        for (const CaseKey* key : keys_of(section)) paths.push_back(table + "." + key->leaf());  // a table that only overrides made
        return places_.of(paths);
    }

    /// «drum.speed=50 rpm»; a segment with dots or blanks stands in quotes.
    static Override split_override(const std::string& text) {
        Override result;
        result.place = {"override '" + text + "'"};
        char quote = 0;
        std::string segment;
        std::size_t i = 0;
        for (; i < text.size() && (quote != 0 || text[i] != '='); ++i) {
            const char c = text[i];
            if (quote != 0 && c == quote)
                quote = 0;
            else if (quote == 0 && (c == '"' || c == '\''))
                quote = c;
            else if (quote == 0 && c == '.') {
                result.path.push_back(segment);
                segment.clear();
            } else if (quote != 0 || (c != ' ' && c != '\t'))
                segment += c;
        }
        if (i == text.size() || (segment.empty() && result.path.empty()))
            throw bad_input("an override is key=value", "write for instance \"drum.speed=50 rpm\"", result.place);
        result.path.push_back(segment);
        result.value = text.substr(i + 1);
        return result;
    }

    std::string file_;
    CasePlaces places_;
    std::vector<std::pair<std::string, std::string>> named_;  // («materials», «glass») as written in the file
};

}  // namespace

Case parse_case(const std::string& text, const std::string& file_name, const std::vector<std::string>& overrides) {
    return CaseReader(file_name).read(text, overrides);
}

Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    Case c = parse_case(read_text(file), file.string(), overrides);
    c.folder = file.parent_path().string();
    return c;
}

std::filesystem::path path_in_case(const Case& c, const std::string& path) {
    return std::filesystem::path(c.folder) / path;
}

}  // namespace pelletlab::io
