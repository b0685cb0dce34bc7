#include "campaign/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace pelletlab::campaign {

namespace {

using Key = std::vector<double>;

std::string block_name(const CampaignTable& table, const Eigen::RowVectorXd& theta) {
    std::string name;
    for (std::size_t k = 0; k < table.effects.size(); ++k)
        if (theta[static_cast<Eigen::Index>(k)] != 0.0) name += (name.empty() ? "" : " + ") + table.effects[k].name;
    return name.empty() ? "baseline" : name;
}

/// Regimes in ascending order of level, or in order of appearance when they are words.
std::vector<CampaignRegime> find_regimes(const CampaignTable& table) {
    std::vector<CampaignRegime> regimes;
    for (const auto& row : table.rows) {
        const bool known = std::any_of(regimes.begin(), regimes.end(), [&row](const CampaignRegime& r) {
            return std::isnan(row.regime_level) ? r.name == row.regime : r.level == row.regime_level;
        });
        if (!known) regimes.push_back({row.regime, row.regime_level});
    }
    if (!table.regime_unit.empty()) {
        std::sort(regimes.begin(), regimes.end(), [](const CampaignRegime& a, const CampaignRegime& b) { return a.level < b.level; });
        for (CampaignRegime& r : regimes) r.name += " " + table.regime_unit;
    }
    return regimes;
}

struct Configuration {
    Key parameters, effects;
    std::vector<int> rows;  ///< one a regime; −1 where there is none
};

}  // namespace

double scaled_amplitude(const CampaignEffect& effect, double value) {
    const double u = (value - effect.baseline) / (effect.full - effect.baseline);
    if (!effect.square_root) return u;
    return u < 0.0 ? -std::sqrt(-u) : std::sqrt(u);
}

double value_of_amplitude(const CampaignEffect& effect, double theta) {
    const double u = effect.square_root ? theta * std::abs(theta) : theta;
    return effect.baseline + u * (effect.full - effect.baseline);
}

double unit_coordinate(const CampaignParameter& p, double value) {
    if (p.logarithmic) return std::log(value / p.lower) / std::log(p.upper / p.lower);
    return (value - p.lower) / (p.upper - p.lower);
}

double value_of_coordinate(const CampaignParameter& p, double phi) {
    if (p.logarithmic) return p.lower * std::pow(p.upper / p.lower, phi);
    return p.lower + phi * (p.upper - p.lower);
}

namespace {

std::vector<Configuration> join_regimes(const CampaignTable& table, const std::vector<CampaignRegime>& regimes) {
    std::map<std::pair<Key, Key>, std::vector<std::size_t>> replicates_of;
    std::vector<Configuration> configurations;
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        const auto& row = table.rows[r];
        const auto regime = static_cast<std::size_t>(
            std::find_if(regimes.begin(), regimes.end(),
                         [&](const CampaignRegime& one) { return std::isnan(row.regime_level) ? one.name == row.regime : one.level == row.regime_level; }) -
            regimes.begin());
        auto& candidates = replicates_of[{row.parameters, row.effects}];
        // A second run of the same configuration and regime is a replicate: it opens a row of its own.
        const auto free = std::find_if(candidates.begin(), candidates.end(), [&](std::size_t c) { return configurations[c].rows[regime] < 0; });
        if (free != candidates.end()) {
            configurations[*free].rows[regime] = static_cast<int>(r);
            continue;
        }
        candidates.push_back(configurations.size());
        configurations.push_back({row.parameters, row.effects, std::vector<int>(regimes.size(), -1)});
        configurations.back().rows[regime] = static_cast<int>(r);
    }
    return configurations;
}

std::vector<CampaignOutput> find_outputs(const CampaignTable& table, std::size_t regimes, const std::vector<Configuration>& configurations) {
    std::vector<CampaignOutput> outputs;
    for (std::size_t regime = 0; regime < regimes; ++regime) {
        std::size_t column = 0;
        for (std::size_t o = 0; o < table.observables.size(); ++o)
            for (std::size_t e = 0; e < table.observables[o].columns.size(); ++e, ++column) {
                const bool seen = std::any_of(configurations.begin(), configurations.end(), [&](const Configuration& c) {
                    return c.rows[regime] >= 0 && !std::isnan(table.rows[static_cast<std::size_t>(c.rows[regime])].outputs[column]);
                });
                if (seen) outputs.push_back({static_cast<int>(regime), static_cast<int>(o), static_cast<int>(e)});
            }
    }
    return outputs;
}

std::vector<std::size_t> first_columns(const CampaignTable& table) {
    std::vector<std::size_t> first;
    std::size_t column = 0;
    for (const auto& o : table.observables) {
        first.push_back(column);
        column += o.columns.size();
    }
    return first;
}

void check_variation(const Campaign& c) {
    const std::string& file = c.description.file;
    for (Eigen::Index i = 0; i < c.parameter.cols(); ++i)
        if (c.parameter.col(i).minCoeff() == c.parameter.col(i).maxCoeff())
            throw bad_input("the parameter '" + c.description.parameters[static_cast<std::size_t>(i)].name + "' has one value only in all usable runs",
                            "take it out of the description, or vary it", {file});
    for (Eigen::Index k = 0; k < c.amplitude.cols(); ++k)
        if (c.amplitude.col(k).cwiseAbs().maxCoeff() == 0.0)
            throw bad_input("the effect '" + c.description.effects[static_cast<std::size_t>(k)].name + "' is never switched on",
                            "check its baseline and column, or take it out of the description", {file});
    const bool has_baseline = c.amplitude.cols() == 0 || (c.amplitude.cwiseAbs().rowwise().maxCoeff().array() == 0.0).any();
    if (!has_baseline) throw bad_input("no run has all effects at their baseline", "add the block of baseline runs, or correct the baseline values", {file});
}

void number_points(Campaign& c) {
    std::map<Key, int> points, replicates;
    for (Eigen::Index i = 0; i < c.parameter.rows(); ++i) {
        Key key(static_cast<std::size_t>(c.parameter.cols()));
        for (Eigen::Index j = 0; j < c.parameter.cols(); ++j) key[static_cast<std::size_t>(j)] = c.parameter(i, j);
        c.point.push_back(points.try_emplace(key, static_cast<int>(points.size())).first->second);
        for (Eigen::Index j = 0; j < c.amplitude.cols(); ++j) key.push_back(c.amplitude(i, j));
        c.replicate.push_back(replicates.try_emplace(key, static_cast<int>(replicates.size())).first->second);
    }
}

}  // namespace

Campaign assemble(CampaignTable table) {
    Campaign c;
    c.regimes = find_regimes(table);
    const auto configurations = join_regimes(table, c.regimes);
    c.outputs = find_outputs(table, c.regimes.size(), configurations);
    const auto first = first_columns(table);
    std::map<std::string, CampaignBlock> blocks;
    std::vector<Eigen::VectorXd> parameters, amplitudes, outputs;
    for (const Configuration& one : configurations) {
        Eigen::VectorXd theta(static_cast<Eigen::Index>(table.effects.size()));
        for (std::size_t k = 0; k < table.effects.size(); ++k) theta[static_cast<Eigen::Index>(k)] = scaled_amplitude(table.effects[k], one.effects[k]);
        const bool in_range = theta.size() == 0 || theta.cwiseAbs().maxCoeff() <= 1.0 + 1e-9;
        if (!in_range) {
            ++c.unused_out_of_range;
            continue;
        }
        CampaignBlock& block = blocks[block_name(table, theta.transpose())];
        block.runs += static_cast<int>(c.regimes.size());
        Eigen::VectorXd y(static_cast<Eigen::Index>(c.outputs.size()));
        std::set<int> bad;
        for (std::size_t j = 0; j < c.outputs.size(); ++j) {
            const CampaignOutput& out = c.outputs[j];
            const int r = one.rows[static_cast<std::size_t>(out.regime)];
            const CampaignTable::Row* row = r < 0 ? nullptr : &table.rows[static_cast<std::size_t>(r)];
            const double value =
                row == nullptr ? not_known : row->outputs[first[static_cast<std::size_t>(out.observable)] + static_cast<std::size_t>(out.element)];
            if (row == nullptr || row->failed || std::isnan(value)) bad.insert(out.regime);
            y[static_cast<Eigen::Index>(j)] = value;
        }
        block.failed += static_cast<int>(bad.size());
        if (!bad.empty()) continue;
        parameters.push_back(Eigen::Map<const Eigen::VectorXd>(one.parameters.data(), static_cast<Eigen::Index>(one.parameters.size())));
        amplitudes.push_back(theta);
        outputs.push_back(y);
    }
    for (auto& [name, block] : blocks) {
        block.name = name;
        if (block.failed > table.largest_failed_share * block.runs)
            throw bad_input(
                "the block '" + name + "' has " + std::to_string(block.failed) + " failed, unsteady or incomplete runs of " + std::to_string(block.runs),
                "run them again; or narrow axis_range to where every run has a value; or lower the effect's `full`; or raise largest_failed_share "
                "knowing that the runs that fail are not a random sample",
                {table.file});
        c.blocks.push_back(block);
    }
    const auto n = static_cast<Eigen::Index>(outputs.size());
    if (n == 0) throw bad_input("the campaign has no usable run", "check columns, regimes and the effects' ranges", {table.file});
    c.parameter.resize(n, parameters[0].size());
    c.amplitude.resize(n, amplitudes[0].size());
    c.output.resize(n, outputs[0].size());
    for (Eigen::Index i = 0; i < n; ++i) {
        c.parameter.row(i) = parameters[static_cast<std::size_t>(i)].transpose();
        c.amplitude.row(i) = amplitudes[static_cast<std::size_t>(i)].transpose();
        c.output.row(i) = outputs[static_cast<std::size_t>(i)].transpose();
    }
    table.rows.clear();
    c.description = std::move(table);
    check_variation(c);
    number_points(c);
    return c;
}

Campaign subset(const Campaign& campaign, const std::vector<int>& configurations) {
    Campaign c = campaign;
    c.parameter = campaign.parameter(configurations, Eigen::all);
    c.amplitude = campaign.amplitude(configurations, Eigen::all);
    c.output = campaign.output(configurations, Eigen::all);
    c.point.clear();
    c.replicate.clear();
    for (const int i : configurations) {
        c.point.push_back(campaign.point[static_cast<std::size_t>(i)]);
        c.replicate.push_back(campaign.replicate[static_cast<std::size_t>(i)]);
    }
    return c;
}

Campaign without_points(const Campaign& campaign, const std::vector<std::vector<std::pair<std::string, double>>>& points, const std::string& file) {
    if (points.empty()) return campaign;
    std::vector<bool> out(static_cast<std::size_t>(campaign.parameter.rows()), false);
    for (const auto& point : points) {
        bool found = false;
        for (Eigen::Index i = 0; i < campaign.parameter.rows(); ++i) {
            bool equal = true;
            for (const auto& [name, value] : point) {
                const auto& known = campaign.description.parameters;
                const auto p = std::find_if(known.begin(), known.end(), [&name = name](const CampaignParameter& one) { return one.name == name; });
                if (p == known.end()) throw bad_input("exclude names '" + name + "', which is no parameter of the campaign", "correct the name", {file});
                equal = equal && std::abs(campaign.parameter(i, p - known.begin()) - value) <= 1e-9 * std::max(1.0, std::abs(value));
            }
            if (equal) out[static_cast<std::size_t>(i)] = found = true;
        }
        if (!found) throw bad_input("exclude names a point that no run of the campaign has", "remove or correct it", {file});
    }
    std::vector<int> kept;
    for (std::size_t i = 0; i < out.size(); ++i)
        if (!out[i]) kept.push_back(static_cast<int>(i));
    if (kept.empty()) throw bad_input("all runs of the campaign are excluded", "exclude fewer points", {file});
    return subset(campaign, kept);
}

std::vector<int> configurations_with(const Campaign& campaign, const std::vector<int>& effects, int largest_count) {
    std::vector<int> chosen;
    for (Eigen::Index i = 0; i < campaign.amplitude.rows(); ++i) {
        int count = 0;
        bool allowed = true;
        for (Eigen::Index k = 0; k < campaign.amplitude.cols(); ++k) {
            if (campaign.amplitude(i, k) == 0.0) continue;
            ++count;
            allowed = allowed && std::find(effects.begin(), effects.end(), static_cast<int>(k)) != effects.end();
        }
        if (allowed && count <= largest_count) chosen.push_back(static_cast<int>(i));
    }
    return chosen;
}

}  // namespace pelletlab::campaign
