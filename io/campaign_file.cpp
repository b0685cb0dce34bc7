#include "io/campaign_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/csv_table.hpp"
#include "io/detail/campaign_quantities.hpp"
#include "io/detail/toml_table.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

using detail::TomlTable;

/// The axis value in a column's name, for a pattern with one «*»: z(-0.65) under z(*) is −0.65.
bool matches(const std::string& pattern, const std::string& column, double& value) {
    const std::size_t star = pattern.find('*');
    const std::string before = pattern.substr(0, star), after = pattern.substr(star + 1);
    if (column.size() <= before.size() + after.size() || !column.starts_with(before) || !column.ends_with(after)) return false;
    std::string middle = column.substr(before.size(), column.size() - before.size() - after.size());
    if (middle.front() == '+') middle.erase(0, 1);
    const auto [rest, status] = std::from_chars(middle.data(), middle.data() + middle.size(), value);
    return status == std::errc() && rest == middle.data() + middle.size();
}

CampaignObservable read_observable(TomlTable& t, const CsvTable& csv) {
    CampaignObservable o;
    o.name = t.text("name");
    o.unit = t.unit("unit", "1");
    o.tolerance = t.number("tolerance");
    if (o.tolerance <= 0.0)
        throw t.problem("tolerance", "must be positive", "write the difference that does not matter to you; without one every campaign is wrong somewhere");
    if (!t.has("columns")) {
        o.columns = {t.text("column", o.name)};
        csv.column(o.columns[0]);
        return o;
    }
    const std::string pattern = t.text("columns");
    if (std::count(pattern.begin(), pattern.end(), '*') != 1)
        throw t.problem("columns", "needs one «*» where the axis value stands", "write columns = \"z(*)\"");
    o.axis_name = t.text("axis", "x");
    o.axis_unit = t.unit("axis_unit", "1");
    const auto range = t.range_if_any("axis_range", "write axis_range = [-0.6, 0.6]");
    std::vector<std::pair<double, std::string>> found;
    for (const std::string& column : csv.columns) {
        double value = 0.0;
        if (matches(pattern, column, value) && (!range || (value >= range->first - 1e-9 && value <= range->second + 1e-9))) found.emplace_back(value, column);
    }
    if (found.size() < 2) throw t.problem("columns", "finds " + std::to_string(found.size()) + " columns of the table", "check pattern and axis_range");
    std::sort(found.begin(), found.end());
    for (const auto& [value, column] : found) {
        o.axis.push_back(value);
        o.columns.push_back(column);
    }
    return o;
}

template <class Item>
void refuse_equal_names(const std::vector<Item>& items, const std::string& kind, const std::string& file) {
    for (std::size_t i = 0; i < items.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (items[i].name == items[j].name) throw bad_input("two " + kind + "s are named '" + items[i].name + "'", "rename one", {file});
}

struct StatusColumn {
    std::size_t column = 0;
    bool present = false;
    std::vector<std::string> good;
};

void read_rows(CampaignTable& campaign, const CsvTable& csv, const std::string& regime_column, const StatusColumn& status) {
    std::vector<std::size_t> parameters, effects, outputs;
    for (const auto& p : campaign.parameters) parameters.push_back(csv.column(p.column));
    for (const auto& e : campaign.effects) effects.push_back(csv.column(e.column));
    for (const auto& o : campaign.observables)
        for (const auto& c : o.columns) outputs.push_back(csv.column(c));
    const bool has_regime = !regime_column.empty();
    const std::size_t regime = has_regime ? csv.column(regime_column) : 0;
    const auto given = [&csv](std::size_t row, std::size_t column) {
        const double value = csv.number(row, column);
        if (std::isnan(value))
            throw bad_input("the field of column '" + csv.columns[column] + "' is empty", "every run needs all parameters and amplitudes",
                            csv.place(row, column));
        return value;
    };
    campaign.rows.reserve(csv.fields.size());
    for (std::size_t r = 0; r < csv.fields.size(); ++r) {
        CampaignTable::Row row;
        row.line = csv.lines[r];
        if (has_regime) {
            row.regime = csv.fields[r][regime];
            row.regime_level = campaign.regime_unit.empty() ? not_known : given(r, regime);
        }
        if (status.present) row.failed = std::find(status.good.begin(), status.good.end(), csv.fields[r][status.column]) == status.good.end();
        for (const std::size_t c : parameters) row.parameters.push_back(given(r, c));
        for (const std::size_t c : effects) row.effects.push_back(given(r, c));
        for (const std::size_t c : outputs) row.outputs.push_back(csv.number(r, c));
        campaign.rows.push_back(std::move(row));
    }
}

}  // namespace

CampaignTable read_campaign(const std::filesystem::path& file) {
    const std::string text = read_text(file);
    const toml::table toml = detail::parse_toml(text, file.string());
    TomlTable t(toml, file.string(), "");
    CampaignTable campaign;
    campaign.file = file.string();
    campaign.name = t.text("name", file.stem().string());
    campaign.source = t.text("source", "");
    campaign.largest_failed_share = t.number("largest_failed_share", 0.05);
    const std::filesystem::path table_file = file.parent_path() / t.text("table");
    std::error_code ignored;
    if (!std::filesystem::exists(table_file, ignored)) throw t.problem("table", "names a file that does not exist: " + table_file.string(), "correct the path");
    const CsvTable csv = read_csv(table_file);
    campaign.table_file = table_file.string();
    campaign.sha256 = sha256_of_text(text + sha256_of_file(table_file));
    std::string regime_column;
    if (auto regime = t.table("regime")) {
        regime_column = regime->text("column");
        campaign.regime_name = regime->text("name", regime_column);
        if (regime->has("unit")) campaign.regime_unit = regime->unit("unit", "1");
        regime->finish();
    }
    StatusColumn status;
    if (auto s = t.table("status")) {
        status.present = true;
        status.column = csv.column(s->text("column"));
        status.good = s->texts("good");
        if (status.good.empty()) throw s->problem("good", "is missing", "write good = [\"complete\"]");
        s->finish();
    }
    t.each("parameter", [&](TomlTable& one) {
        campaign.parameters.push_back(detail::read_campaign_parameter(one));
        campaign.parameters.back().column = one.text("column", campaign.parameters.back().name);
    });
    t.each("effect", [&](TomlTable& one) {
        campaign.effects.push_back(detail::read_campaign_effect(one));
        campaign.effects.back().column = one.text("column", campaign.effects.back().name);
    });
    t.each("observable", [&](TomlTable& one) { campaign.observables.push_back(read_observable(one, csv)); });
    t.finish();
    if (campaign.parameters.empty()) throw bad_input("the campaign has no [[parameter]]", "name at least one calibration parameter", {file.string()});
    if (campaign.observables.empty()) throw bad_input("the campaign has no [[observable]]", "name the columns that hold results", {file.string()});
    refuse_equal_names(campaign.parameters, "parameter", campaign.file);
    refuse_equal_names(campaign.effects, "effect", campaign.file);
    refuse_equal_names(campaign.observables, "observable", campaign.file);
    read_rows(campaign, csv, regime_column, status);
    return campaign;
}

}  // namespace pelletlab::io
