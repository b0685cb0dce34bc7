#include "io/detail/toml_text.hpp"

#include <algorithm>

namespace pelletlab::io::detail {

namespace {

constexpr int deepest_key = 64;                // segments of a dotted key; ours have three
constexpr std::size_t largest_text = 1 << 26;  // bytes; a clump of 10,000 spheres has less than one million

Place place_of(const toml::source_region& source, const std::string& file) {
    return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

/// toml++ frees nested tables recursively: a dotted key of some ten thousand segments would overflow the stack. No honest file has one.
void refuse_deep_keys(const std::string& text, const std::string& file) {
    int dots = 0;
    int line = 1;
    char quote = 0;
    bool comment = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '\n') {
            ++line;
            dots = 0;
            quote = 0;
            comment = false;
        } else if (comment) {
            continue;
        } else if (quote != 0) {
            if (c == '\\' && quote == '"') ++i;
            if (c == quote) quote = 0;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '#') {
            comment = true;
        } else if (c == '.') {
            if (++dots >= deepest_key) throw bad_input("a key has more than " + std::to_string(deepest_key) + " parts", "remove it", {file, line});
        } else if (std::string_view("=,[]{}").find(c) != std::string_view::npos) {
            dots = 0;
        }
    }
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& file) {
    if (text.size() > largest_text) throw bad_input("the file is larger than 64 MiB", "name a TOML file of pelletlab", {file});
    refuse_deep_keys(text, file);
    try {
        return toml::parse(std::string_view(text));
    } catch (const toml::parse_error& error) {
        throw bad_input("this is no TOML: " + std::string(error.description()), "correct the text at this place (https://toml.io describes the format)",
                        place_of(error.source(), file));
    }
}

Place place_of(const toml::node& node, const std::string& file) {
    return place_of(node.source(), file);
}
Place place_of(const toml::key& key, const std::string& file) {
    return place_of(key.source(), file);
}

std::string kind_of_node(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "a list";
        case toml::node_type::string:
            return "a text";
        case toml::node_type::integer:
            return "a whole number";
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "true or false";
        case toml::node_type::date:
        case toml::node_type::time:
        case toml::node_type::date_time:
            return "a date or time";
        case toml::node_type::none:
            break;
    }
    return "nothing";
}

std::string toml_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (byte < 0x20 || byte == 0x7f) {
            out += "\\u00";
            out += "0123456789ABCDEF"[byte >> 4];
            out += "0123456789ABCDEF"[byte & 15];
        } else {
            out += c;
        }
    }
    return out + '"';
}

std::string toml_key(std::string_view name) {
    const bool bare = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
    return bare ? std::string(name) : toml_string(name);
}

}  // namespace pelletlab::io::detail
