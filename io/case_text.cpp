#include <algorithm>
#include <cmath>

#include "io/case_file.hpp"
#include "io/detail/case_keys.hpp"
#include "io/detail/case_value.hpp"
#include "io/detail/toml_text.hpp"

namespace pelletlab::io {

namespace {

using namespace detail;

/// «[materials.glass]», or nothing for the keys of the file itself.
std::string heading(const CaseSection& section, const std::string& name) {
    if (section.path.empty()) return "";
    return "[" + section.path[0] + (section.path.size() > 1 ? "." + toml_key(name) : "") + "]\n";
}

struct Line {
    std::string assignment, comment;
};

/// Assignments with their comments in one column.
std::string aligned(const std::vector<Line>& lines) {
    std::size_t width = 0;
    for (const Line& line : lines) width = std::max(width, std::min<std::size_t>(line.assignment.size(), 44));
    std::string text;
    for (const Line& line : lines) {
        text += line.assignment;
        if (line.assignment.size() < width) text.append(width - line.assignment.size(), ' ');
        text += "  # " + line.comment + "\n";
    }
    return text;
}

/// As a comment, broken into lines of up to 120 letters.
std::string wrapped_comment(const std::string& words) {
    std::string text, line = "#";
    std::size_t begin = 0;
    while (begin < words.size()) {
        const std::size_t end = std::min(words.find(' ', begin), words.size());
        if (line.size() + 1 + end - begin > 120) {
            text += line + "\n";
            line = "#";
        }
        line += " " + words.substr(begin, end - begin);
        begin = end + 1;
    }
    return text + line + "\n";
}

std::string subject_of(Rig rig) {
    switch (rig) {
        case Rig::drum:
            return "a rotating drum";
        case Rig::pile:
            return "a pile on a plate";
        case Rig::tester:
            return "an attrition tester";
        case Rig::tube:
            break;
    }
    return "filling a tube";
}

std::string comment_of(const CaseKey& key) {
    std::string comment = key.doc;
    if (!key.choices.empty()) {
        std::string choices;
        for (const std::string& choice : key.choices) choices += (choices.empty() ? "\"" : " or \"") + choice + "\"";
        comment += " " + choices;
    }
    if (!range_text(key).empty()) comment += " (" + range_text(key) + ")";
    return comment;
}

}  // namespace

std::string resolved_case_text(const Case& c) {
    std::string text;
    for (const CaseSection& section : case_sections()) {
        for (const std::string& name : names_in(c, section)) {
            if (!text.empty()) text += "\n";
            text += heading(section, name);
            for (const CaseKey* key : keys_of(section)) text += key->leaf() + " = " + value_as_toml(*key, key->get(c, name)) + "\n";
        }
    }
    return text;
}

std::string new_case_text(Rig rig) {
    const Case c = default_case(rig);
    std::string text = "# A case for pelletlab: " + subject_of(rig) +
                       ".\n# Every value below is the default: delete what you do not change. Values with a dimension carry their unit as text.\n\n";
    for (const CaseSection& section : case_sections()) {
        if (is_idle_section(section, rig)) continue;
        if (!section.path.empty()) text += "\n" + wrapped_comment(section.doc);
        bool first = true;
        for (const std::string& name : names_in(c, section)) {
            if (!first) text += "\n";
            first = false;
            text += heading(section, name);
            std::vector<Line> lines;
            for (const CaseKey* key : keys_of(section)) {
                const CaseValue value = key->get(c, name);
                const bool empty = key->kind == KeyKind::text && std::get<std::string>(value).empty();
                lines.push_back({(empty ? "# " : "") + key->leaf() + " = " + value_as_toml(*key, value), comment_of(*key)});
            }
            text += aligned(lines);
        }
    }
    return text;
}

}  // namespace pelletlab::io
