// Values of case keys: from TOML, from an override's text, checked, and back to text.
#pragma once

#include <string>

#include "core/error.hpp"
#include "io/detail/case_keys.hpp"
#include "io/detail/toml.hpp"

namespace pelletlab::io::detail {

/// Value of a node; `name` is the key as the reader wrote it. Throws Error(bad_input) at the node for another type, a missing or wrong unit, a value
/// out of range.
CaseValue value_from_toml(const CaseKey& key, const std::string& name, const toml::node& node, const std::string& file);

/// The same from the right side of «key=value»; quotes and brackets may be left out.
CaseValue value_from_text(const CaseKey& key, const std::string& name, const std::string& text, const Place& place);

/// As it stands behind «=» in a case file; reads back to the same value.
std::string value_as_toml(const CaseKey& key, const CaseValue& value);

/// «> 0 mm», «0 to 1», …; empty when every value is allowed.
std::string range_text(const CaseKey& key);

/// An example of a right value, as it stands in a case file.
std::string example_value(const CaseKey& key);

}  // namespace pelletlab::io::detail
