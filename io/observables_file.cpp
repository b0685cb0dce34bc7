#include "io/observables_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format_name = "pelletlab-observables";
constexpr int format_version = 1;

// ---- writing ----------------------------------------------------------------------------------------------------------------

Json number(double value, const std::string& of) {
    if (std::isnan(value)) return nullptr;
    if (std::isinf(value)) throw numerical_failure("the observable " + of + " is infinite", "this is a defect of its method: please report it");
    return value;
}

Json numbers(const std::vector<double>& values, const std::string& of) {
    Json list = Json::array();
    for (const double value : values) list.push_back(number(value, of));
    return list;
}

Json window_json(const TimeWindow& window) {
    return {{"begin", number(window.begin, "window")}, {"end", number(window.end, "window")}};
}

Json to_json(const Observable& o) {
    return {{"name", o.name},
            {"unit", o.unit},
            {"value", number(o.value, o.name)},
            {"standard_error", number(o.standard_error, o.name)},
            {"window", window_json(o.window)},
            {"method", o.method}};
}

Json to_json(const Profile& p) {
    return {{"name", p.name},
            {"unit", p.unit},
            {"axis_name", p.axis_name},
            {"axis_unit", p.axis_unit},
            {"axis", numbers(p.axis, p.name)},
            {"value", numbers(p.value, p.name)},
            {"standard_error", numbers(p.standard_error, p.name)},
            {"window", window_json(p.window)},
            {"method", p.method}};
}

Json to_json(const FieldMap& m) {
    return {{"name", m.name},
            {"unit", m.unit},
            {"horizontal_axis", m.horizontal_axis},
            {"vertical_axis", m.vertical_axis},
            {"origin_horizontal", number(m.origin_horizontal, m.name)},
            {"origin_vertical", number(m.origin_vertical, m.name)},
            {"spacing", number(m.spacing, m.name)},
            {"columns", m.columns},
            {"rows", m.rows},
            {"value", numbers(m.value, m.name)},
            {"sample_count", numbers(m.sample_count, m.name)},
            {"window", window_json(m.window)},
            {"method", m.method}};
}

Json to_json(const Provenance& p) {
    Json hashes = Json::object();
    for (const auto& [file, hash] : p.input_hashes) hashes[file] = hash;
    return {{"tool", p.tool}, {"version", p.version}, {"git_hash", p.git_hash}, {"verb", p.verb}, {"seed", p.seed}, {"input_hashes", hashes}};
}

template <class Item>
Json list_json(const std::vector<Item>& items) {
    Json list = Json::array();
    for (const Item& item : items) list.push_back(to_json(item));
    return list;
}

// ---- reading ----------------------------------------------------------------------------------------------------------------

/// A JSON object on the way to our structs: every member is asked for by name, what nobody asked for is an error.
class Reader {
public:
    Reader(const Json& json, std::string where, const std::string& file) : json_(json), where_(std::move(where)), file_(file) {
        if (!json.is_object()) throw problem("is not an object");
    }

    const Json& member(const char* name) {
        known_.emplace_back(name);
        const auto found = json_.find(name);
        if (found == json_.end()) throw problem("has no member '" + std::string(name) + "'");
        return *found;
    }
    std::string text(const char* name) {
        const Json& value = member(name);
        if (!value.is_string()) throw problem("member '" + std::string(name) + "' is not a text");
        return value.get<std::string>();
    }
    double number(const char* name) { return number_of(member(name), name); }
    std::uint64_t whole(const char* name) {
        const Json& value = member(name);
        if (!value.is_number_unsigned()) throw problem("member '" + std::string(name) + "' is not a whole number ≥ 0");
        return value.get<std::uint64_t>();
    }
    std::vector<double> numbers(const char* name) {
        const Json& list = array(name);
        std::vector<double> values;
        values.reserve(list.size());
        for (const Json& value : list) values.push_back(number_of(value, name));
        return values;
    }
    const Json& array(const char* name) {
        const Json& list = member(name);
        if (!list.is_array()) throw problem("member '" + std::string(name) + "' is not a list");
        return list;
    }
    Reader object(const char* name) { return {member(name), where_ + "/" + name, file_}; }
    TimeWindow window() {
        Reader reader = object("window");
        const TimeWindow result{reader.number("begin"), reader.number("end")};
        reader.finish();
        return result;
    }
    const Json& json() const { return json_; }
    const std::string& where() const { return where_; }

    void finish() const {
        for (const auto& item : json_.items()) {
            if (std::find(known_.begin(), known_.end(), item.key()) != known_.end()) continue;
            const std::string guess = closest_word(item.key(), known_);
            throw problem("has an unknown member '" + item.key() + "'", guess.empty() ? "remove it" : "did you mean '" + guess + "'?");
        }
    }
    Error problem(const std::string& what, const std::string& remedy = "write the file with this version of pelletlab") const {
        return bad_input((where_.empty() ? "the file" : where_) + " " + what, remedy, {file_});
    }

private:
    double number_of(const Json& value, const char* name) const {
        if (value.is_null()) return not_known;
        if (!value.is_number()) throw problem("member '" + std::string(name) + "' is not a number or null");
        return value.get<double>();
    }

    const Json& json_;
    std::string where_;
    const std::string& file_;
    std::vector<std::string> known_;
};

Observable read_observable(Reader& r) {
    return {r.text("name"), r.text("unit"), r.number("value"), r.number("standard_error"), r.window(), r.text("method")};
}

Profile read_profile(Reader& r) {
    Profile p{r.text("name"), r.text("unit"),  r.text("axis_name"), r.text("axis_unit"), r.numbers("axis"), r.numbers("value"), r.numbers("standard_error"),
              r.window(),     r.text("method")};
    if (p.value.size() != p.axis.size() || (!p.standard_error.empty() && p.standard_error.size() != p.axis.size()))
        throw r.problem("has lists of different lengths");
    return p;
}

FieldMap read_map(Reader& r) {
    FieldMap m;
    m.name = r.text("name");
    m.unit = r.text("unit");
    m.horizontal_axis = r.text("horizontal_axis");
    m.vertical_axis = r.text("vertical_axis");
    m.origin_horizontal = r.number("origin_horizontal");
    m.origin_vertical = r.number("origin_vertical");
    m.spacing = r.number("spacing");
    m.columns = r.whole("columns");
    m.rows = r.whole("rows");
    m.value = r.numbers("value");
    m.sample_count = r.numbers("sample_count");
    m.window = r.window();
    m.method = r.text("method");
    const bool fits = m.columns == 0 ? m.value.empty() : m.value.size() % m.columns == 0 && m.value.size() / m.columns == m.rows;
    if (!fits || (!m.sample_count.empty() && m.sample_count.size() != m.value.size())) throw r.problem("has lists that do not fit its columns and rows");
    return m;
}

Provenance read_provenance(Reader r) {
    Provenance p{r.text("tool"), r.text("version"), r.text("git_hash"), r.text("verb"), r.whole("seed"), {}};
    const Json& hashes = r.member("input_hashes");
    if (!hashes.is_object()) throw r.problem("member 'input_hashes' is not an object");
    for (const auto& item : hashes.items()) {
        if (!item.value().is_string()) throw r.problem("input hash of '" + item.key() + "' is not a text");
        p.input_hashes[item.key()] = item.value().get<std::string>();
    }
    r.finish();
    return p;
}

template <class Item, class Read>
std::vector<Item> read_list(Reader& parent, const char* name, const std::string& file, const Read& read) {
    std::vector<Item> items;
    for (const Json& json : parent.array(name)) {
        Reader reader(json, std::string("/") + name + "/" + std::to_string(items.size()), file);
        items.push_back(read(reader));
        reader.finish();
    }
    return items;
}

/// Line and column of a byte of the text, both from 1.
Place place_of_byte(const std::string& text, std::size_t byte, const std::string& file) {
    const std::size_t end = std::min(byte == 0 ? 0 : byte - 1, text.size());
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n') + 1;
    const std::size_t line_start = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
    const std::size_t column = end - (line_start == std::string::npos ? 0 : line_start + 1) + 1;
    return {file, static_cast<int>(line), static_cast<int>(column)};
}

}  // namespace

std::string observables_text(const Observables& o) {
    const Json json = {{"format", format_name},     {"format_version", format_version},   {"case_name", o.case_name},
                       {"status", o.status},        {"values", list_json(o.values)},      {"profiles", list_json(o.profiles)},
                       {"maps", list_json(o.maps)}, {"provenance", to_json(o.provenance)}};
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Observables parse_observables(const std::string& text, const std::string& file) {
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::parse_error& error) {
        throw bad_input("this is no JSON: " + std::string(error.what()), "write the file again", place_of_byte(text, error.byte, file));
    } catch (const Json::exception& error) {
        throw bad_input("this JSON cannot be read: " + std::string(error.what()), "write the file again", {file});
    }
    Reader r(json, "", file);
    const auto format = json.find("format");
    if (format == json.end() || *format != format_name) throw r.problem("is not an observables file of pelletlab", "name an observables.json");
    r.member("format");
    if (r.whole("format_version") != format_version)
        throw r.problem("has a format version that this pelletlab does not know", "use the pelletlab that wrote it");
    Observables o;
    o.case_name = r.text("case_name");
    o.status = r.text("status");
    o.values = read_list<Observable>(r, "values", file, read_observable);
    o.profiles = read_list<Profile>(r, "profiles", file, read_profile);
    o.maps = read_list<FieldMap>(r, "maps", file, read_map);
    o.provenance = read_provenance(r.object("provenance"));
    r.finish();
    return o;
}

void write_observables(const Observables& observables, const std::filesystem::path& file) {
    write_text(file, observables_text(observables));
}

void write_profiles(const Observables& observables, const std::filesystem::path& file) {
    std::string text = "profile,unit,axis_name,axis_unit,axis,value,standard_error\n";
    const auto cell = [](double value) {
        std::array<char, 32> digits{};
        return std::isfinite(value) ? std::string(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr) : std::string();
    };
    for (const Profile& profile : observables.profiles)
        for (std::size_t k = 0; k < profile.axis.size(); ++k) {
            const double error = k < profile.standard_error.size() ? profile.standard_error[k] : not_known;
            for (const std::string& one : {profile.name, profile.unit, profile.axis_name, profile.axis_unit, cell(profile.axis[k]), cell(profile.value[k])})
                text += one + ",";
            text += cell(error) + "\n";
        }
    write_text(file, text);
}

Observables read_observables(const std::filesystem::path& file) {
    return parse_observables(read_text(file), file.string());
}

}  // namespace pelletlab::io
