// What every TOML file of ours needs: parsing with a place for each mistake, and writing strings and keys.
#pragma once

#include <string>
#include <string_view>

#include "core/error.hpp"
#include "io/detail/toml.hpp"

namespace pelletlab::io::detail {

/// Throws Error(bad_input) with line and column for text that is no TOML, or nested deeper than any file of ours.
toml::table parse_toml(const std::string& text, const std::string& file);

Place place_of(const toml::node& node, const std::string& file);
Place place_of(const toml::key& key, const std::string& file);

/// «a text», «a whole number», «a table», …
std::string kind_of_node(const toml::node& node);

/// A TOML string with quotes, everything awkward escaped.
std::string toml_string(std::string_view text);
/// A key as it may stand in front of «=»: bare when it can be, in quotes otherwise.
std::string toml_key(std::string_view name);

}  // namespace pelletlab::io::detail
