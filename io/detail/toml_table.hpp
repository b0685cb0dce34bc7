// A table of a TOML file that is read strictly: every key is asked for once, and what nobody asked for is an error with a suggestion.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/detail/toml_text.hpp"

namespace pelletlab::io::detail {

class TomlTable {
public:
    TomlTable(const toml::table& table, std::string file, std::string path);

    bool has(const std::string& key) const;
    std::string text(const std::string& key);  ///< must be there
    std::string text(const std::string& key, const std::string& standard);
    double number(const std::string& key);
    double number(const std::string& key, double standard);
    int whole(const std::string& key, int standard, int lower, int upper);
    bool flag(const std::string& key, bool standard);
    std::string choice(const std::string& key, const std::string& standard, const std::vector<std::string>& allowed);
    std::vector<std::string> texts(const std::string& key);  ///< empty when absent; a single text is a list of one
    std::optional<std::vector<double>> numbers(const std::string& key);
    std::string unit(const std::string& key, const std::string& standard);  ///< a unit that core/units.hpp knows
    /// Two ascending numbers; `remedy` is what the error advises. The second must be there.
    std::optional<std::pair<double, double>> range_if_any(const std::string& key, const std::string& remedy);
    std::pair<double, double> range(const std::string& key, const std::string& remedy);
    std::optional<TomlTable> table(const std::string& key);
    /// [[key]]: calls read(table) for each.
    void each(const std::string& key, const std::function<void(TomlTable&)>& read);
    /// Every key with its number, for tables such as { sliding = 0.5 }.
    std::vector<std::pair<std::string, double>> all_numbers();

    Place place(const std::string& key) const;  ///< of the key's value, or of the table
    Place place() const { return place_; }
    Error problem(const std::string& key, const std::string& what, const std::string& remedy) const;
    /// Error(bad_input) for the first key that was never asked for.
    void finish() const;

private:
    const toml::node* find(const std::string& key);
    const toml::node& require(const std::string& key, const std::string& kind);

    const toml::table* table_;
    std::string file_, path_;
    Place place_;
    std::set<std::string> asked_;
};

}  // namespace pelletlab::io::detail
