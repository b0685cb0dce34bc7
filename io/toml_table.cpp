#include "io/detail/toml_table.hpp"

#include <algorithm>
#include <cmath>

#include "core/units.hpp"

namespace pelletlab::io::detail {

namespace {

std::optional<double> as_number(const toml::node& node) {
    if (node.is_integer()) return static_cast<double>(node.as_integer()->get());
    if (node.is_floating_point()) return node.as_floating_point()->get();
    return std::nullopt;
}

}  // namespace

TomlTable::TomlTable(const toml::table& table, std::string file, std::string path)
    : table_(&table), file_(std::move(file)), path_(std::move(path)), place_(detail::place_of(table, file_)) {}

bool TomlTable::has(const std::string& key) const {
    return table_->contains(key);
}

const toml::node* TomlTable::find(const std::string& key) {
    asked_.insert(key);
    return table_->get(key);
}

Place TomlTable::place(const std::string& key) const {
    const toml::node* node = table_->get(key);
    return node == nullptr ? place_ : detail::place_of(*node, file_);
}

Error TomlTable::problem(const std::string& key, const std::string& what, const std::string& remedy) const {
    return bad_input((path_.empty() ? key : path_ + "." + key) + " " + what, remedy, place(key));
}

const toml::node& TomlTable::require(const std::string& key, const std::string& kind) {
    const toml::node* node = find(key);
    if (node != nullptr) return *node;
    throw bad_input((path_.empty() ? "the file" : path_) + " has no '" + key + "'", "add " + key + " = " + kind + " (docs/diagnosis.md lists all keys)",
                    place_);
}

std::string TomlTable::text(const std::string& key) {
    const toml::node& node = require(key, "\"…\"");
    if (!node.is_string()) throw problem(key, "must be a text, and this is " + kind_of_node(node), "write it in quotes");
    return node.as_string()->get();
}

std::string TomlTable::text(const std::string& key, const std::string& standard) {
    return find(key) == nullptr ? standard : text(key);
}

double TomlTable::number(const std::string& key) {
    const toml::node& node = require(key, "a number");
    const auto value = as_number(node);
    if (!value || !std::isfinite(*value)) throw problem(key, "must be a finite number, and this is " + kind_of_node(node), "write a number without quotes");
    return *value;
}

double TomlTable::number(const std::string& key, double standard) {
    return find(key) == nullptr ? standard : number(key);
}

int TomlTable::whole(const std::string& key, int standard, int lower, int upper) {
    const toml::node* node = find(key);
    if (node == nullptr) return standard;
    if (!node->is_integer() || node->as_integer()->get() < lower || node->as_integer()->get() > upper)
        throw problem(key, "must be a whole number from " + std::to_string(lower) + " to " + std::to_string(upper), "correct it");
    return static_cast<int>(node->as_integer()->get());
}

bool TomlTable::flag(const std::string& key, bool standard) {
    const toml::node* node = find(key);
    if (node == nullptr) return standard;
    if (!node->is_boolean()) throw problem(key, "must be true or false, and this is " + kind_of_node(*node), "write true or false without quotes");
    return node->as_boolean()->get();
}

std::string TomlTable::choice(const std::string& key, const std::string& standard, const std::vector<std::string>& allowed) {
    const std::string word = text(key, standard);
    if (std::find(allowed.begin(), allowed.end(), word) != allowed.end()) return word;
    std::string list;
    for (const std::string& one : allowed) list += (list.empty() ? "\"" : ", \"") + one + "\"";
    const std::string guess = closest_word(word, allowed);
    throw problem(key, "= \"" + word + "\" is not known", (guess.empty() ? "" : "did you mean \"" + guess + "\"? ") + ("allowed: " + list));
}

std::vector<std::string> TomlTable::texts(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return {};
    if (node->is_string()) return {node->as_string()->get()};
    if (!node->is_array()) throw problem(key, "must be a list of texts, and this is " + kind_of_node(*node), "write [\"…\", \"…\"]");
    std::vector<std::string> list;
    for (const toml::node& element : *node->as_array()) {
        if (!element.is_string()) throw problem(key, "must hold texts, and one element is " + kind_of_node(element), "write [\"…\", \"…\"]");
        list.push_back(element.as_string()->get());
    }
    return list;
}

std::optional<std::vector<double>> TomlTable::numbers(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_array()) throw problem(key, "must be a list of numbers, and this is " + kind_of_node(*node), "write [0.1, 0.2]");
    std::vector<double> list;
    for (const toml::node& element : *node->as_array()) {
        const auto value = as_number(element);
        if (!value || !std::isfinite(*value)) throw problem(key, "must hold finite numbers, and one element is " + kind_of_node(element), "write [0.1, 0.2]");
        list.push_back(*value);
    }
    return list;
}

std::string TomlTable::unit(const std::string& key, const std::string& standard) {
    const std::string unit = text(key, standard);
    try {
        unit_dimension(unit);
    } catch (const Error& error) {
        throw bad_input(error.problem(), error.remedy(), place(key));
    }
    return unit;
}

std::optional<std::pair<double, double>> TomlTable::range_if_any(const std::string& key, const std::string& remedy) {
    const auto values = numbers(key);
    if (!values) return std::nullopt;
    if (values->size() != 2 || !((*values)[0] < (*values)[1])) throw problem(key, "must be two ascending numbers", remedy);
    return std::pair{(*values)[0], (*values)[1]};
}

std::pair<double, double> TomlTable::range(const std::string& key, const std::string& remedy) {
    const auto found = range_if_any(key, remedy);
    if (!found) throw problem(key, "must be two ascending numbers", remedy);
    return *found;
}

std::optional<TomlTable> TomlTable::table(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_table()) throw problem(key, "must be a table, and this is " + kind_of_node(*node), "write [" + key + "] on a line of its own");
    return TomlTable(*node->as_table(), file_, path_.empty() ? key : path_ + "." + key);
}

void TomlTable::each(const std::string& key, const std::function<void(TomlTable&)>& read) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_array_of_tables() && !(node->is_array() && node->as_array()->empty()))
        throw problem(key, "must be a list of tables, and this is " + kind_of_node(*node), "write [[" + key + "]] with two brackets");
    int index = 0;
    for (const toml::node& element : *node->as_array()) {
        TomlTable one(*element.as_table(), file_, (path_.empty() ? key : path_ + "." + key) + "[" + std::to_string(++index) + "]");
        read(one);
        one.finish();
    }
}

std::vector<std::pair<std::string, double>> TomlTable::all_numbers() {
    std::vector<std::pair<std::string, double>> list;
    for (const auto& [key, node] : *table_) {
        (void)node;
        list.emplace_back(std::string(key.str()), number(std::string(key.str())));
    }
    return list;
}

void TomlTable::finish() const {
    for (const auto& [key, node] : *table_) {
        const std::string name(key.str());
        if (asked_.count(name) != 0) continue;
        const std::string guess = closest_word(name, asked_);
        throw bad_input("unknown key '" + (path_.empty() ? name : path_ + "." + name) + "'",
                        guess.empty() ? "remove it; docs/diagnosis.md lists all keys" : "did you mean '" + guess + "'?", detail::place_of(key, file_));
    }
}

}  // namespace pelletlab::io::detail
