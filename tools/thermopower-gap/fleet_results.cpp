// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "fleet_results.hpp"

#include "html_text.hpp"

#include <thermopower/gap/fit/in_parallel.hpp>
#include <thermopower/gap/lacks.hpp>
#include <thermopower/io/output_files.hpp>
#include <thermopower/io/text_table.hpp>
#include <thermopower/plant/calibration_id.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <limits>
#include <sstream>
#include <thread>
#include <utility>

namespace io = thermopower::io;
namespace pool = thermopower::gap::pool;

namespace {

using Json = nlohmann::ordered_json;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

double number_of(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : missing;
}

std::string joined(const std::vector<std::string>& ids) {
  std::string text;
  for (const std::string& one : ids) text += (text.empty() ? "" : " + ") + one;
  return text;
}

pool::FittedExplanation explanation_of(const nlohmann::json& entry) {
  pool::FittedExplanation one;
  const std::vector<std::string> effects = entry.at("effects");
  one.name = joined(effects);
  one.effects = effects.size();
  one.probability = number_of(entry, "probability");
  one.misfit = number_of(entry, "misfit");
  one.train_gain = number_of(entry, "train_gain");
  one.held_out_gain = number_of(entry, "held_out_gain");
  one.hidden_starts = entry.value("hidden_starts", 0);
  one.on_bounds = entry.at("lacks") == thermopower::gap::in_words(thermopower::gap::Lacks::room).id;
  const nlohmann::json& fitted = entry.at("fitted");
  one.names = fitted.at("names").get<std::vector<std::string>>();
  one.logarithmic = fitted.at("logarithmic").get<std::vector<bool>>();
  one.at_bound = fitted.at("at_bound").get<std::vector<bool>>();
  const std::size_t count = one.names.size();
  const nlohmann::json &at = fitted.at("at"), &covariance = fitted.at("covariance");
  if (one.logarithmic.size() != count || one.at_bound.size() != count || at.size() != count)
    throw std::runtime_error("fitted");
  const auto value = [](const nlohmann::json& cell) {
    return cell.is_number() ? cell.get<double>() : missing;
  };
  const auto k = static_cast<Eigen::Index>(count);
  one.fit.at.resize(k);
  for (std::size_t i = 0; i < count; ++i) one.fit.at[static_cast<Eigen::Index>(i)] = value(at[i]);
  if (covariance.size() != count * (count + 1) / 2) return one;
  one.fit.covariance.resize(k, k);
  std::size_t next = 0;
  for (Eigen::Index row = 0; row < k; ++row)
    for (Eigen::Index column = 0; column <= row; ++column)
      one.fit.covariance(row, column) = one.fit.covariance(column, row) = value(covariance[next++]);
  return one;
}

/// What one report says; a fault where it is none.
void read_report(FleetLog& log, pool::LogResult& result, std::vector<std::string>& causes,
                 double& probability) {
  if (log.report.empty()) {
    result.reason = log.fault;
    return;
  }
  try {
    std::ifstream file(log.report, std::ios::binary);
    const nlohmann::json told = nlohmann::json::parse(file);
    const std::string verdict = told.at("verdict").get<std::string>();
    result.verdict = thermopower::gap::verdict_of(verdict);
    if (!result.verdict) throw std::invalid_argument("\"verdict\" is \"" + verdict + "\", which is none");
    result.reason = told.value("reason", std::string());
    for (const auto& one : told.at("cause")) {
      causes.push_back(one.at("effect").get<std::string>());
      if (causes.size() == 1) probability = number_of(one, "probability");
    }
    result.chosen_effects = causes.size();
    for (const auto& entry : told.at("ranking")) result.ranking.push_back(explanation_of(entry));
  } catch (const std::exception&) {
    result = {};
    causes.clear();
    probability = missing;
    result.reason = log.fault = log.report + " is not a report of this version; remove it and run again";
  }
}

std::string shortest(double value, const char* format = "%.6g") {
  if (!std::isfinite(value)) return {};
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string logs_csv(const FleetResults& fleet) {
  std::string table = "line,unit,log,verdict,cause,probability,report,fault\n";
  for (std::size_t i = 0; i < fleet.logs.size(); ++i) {
    const FleetLog& log = fleet.logs[i];
    const auto add = [&](const std::string& cell, char end) {
      io::append_csv_cell(table, cell);
      table += end;
    };
    std::string cause;
    for (const std::string& one : fleet.causes[i]) cause += (cause.empty() ? "" : "+") + one;
    add(std::to_string(log.manifest->line), ',');
    add(log.manifest->cell("unit"), ',');
    add(log.manifest->cell("log"), ',');
    add(spelt(fleet.results[i].verdict), ',');
    add(cause, ',');
    add(shortest(fleet.probability[i], "%.17g"), ',');
    add(!fleet.results[i].verdict ? std::string() : "reports/" + log.manifest->id + ".json", ',');
    add(log.fault, '\n');
  }
  return table;
}

std::string units_csv(const FleetResults& fleet) {
  std::string table =
      "unit,logs,family,member,odd,parameter,standard_deviations,p,misfit,drift,since_days,until_days\n";
  for (const pool::UnitVerdict& unit : fleet.verdict.units) {
    const auto add = [&](const std::string& cell, char end) {
      io::append_csv_cell(table, cell);
      table += end;
    };
    const pool::Family* family =
        unit.family >= 0 ? &fleet.verdict.families[static_cast<std::size_t>(unit.family)] : nullptr;
    const bool compared = family != nullptr && unit.estimate.has_value() && family->spread.size() > 0;
    add(unit.unit, ',');
    add(std::to_string(unit.logs.size()), ',');
    add(family == nullptr ? "" : family->cause.empty() ? "none" : family->cause, ',');
    add(unit.member ? "1" : "0", ',');
    add(to_string(unit.oddity), ',');
    add(compared ? parameter_name(family->coordinates[static_cast<std::size_t>(unit.standing.coordinate)])
                 : "",
        ',');
    add(compared ? shortest(unit.standing.standard_deviations, "%.3g") : "", ',');
    add(compared ? shortest(unit.standing.p, "%.3g") : "", ',');
    add(shortest(unit.misfit, "%.4g"), ',');
    const pool::UnitDrift* drift = unit.drifts.empty() ? nullptr : &unit.drifts.front();
    add(drift != nullptr ? parameter_name(drift->coordinate) : "", ',');
    add(drift != nullptr ? shortest(drift->drift.since, "%.10g") : "", ',');
    add(drift != nullptr ? shortest(drift->drift.until, "%.10g") : "", '\n');
  }
  return table;
}

Json number(double value) { return std::isfinite(value) ? Json(value == 0.0 ? 0.0 : value) : Json(nullptr); }

Json prevalence(const pool::Prevalence& one) {
  return {{"cause", one.explanation},
          {"share", number(one.share)},
          {"share_ci90", {number(one.share90.low), number(one.share90.high)}},
          {"units", number(one.units)}};
}

Json drift_json(const pool::UnitDrift& one, bool logarithmic) {
  return {{"parameter", parameter_name(one.coordinate)},
          {"kind", to_string(one.drift.kind)},
          {"p", number(one.drift.p)},
          {"size", number(logarithmic ? std::expm1(one.drift.size) : one.drift.size)},
          {"relative", logarithmic},
          {"since_days", number(one.drift.since)},
          {"until_days", number(one.drift.until)}};
}

}  // namespace

std::string parameter_name(const std::string& coordinate) {
  return thermopower::plant::is_calibration(coordinate)
             ? coordinate.substr(sizeof thermopower::plant::calibration_prefix - 1)
             : coordinate;
}

double shown_value(double at, bool logarithmic) { return logarithmic ? std::exp(at) : at; }

std::string fleet_json(const FleetResults& fleet) {
  const pool::FleetVerdict& verdict = fleet.verdict;
  Json root;
  root["format"] = "thermopower-fleet/1";
  root["logs"] = fleet.logs.size();
  root["structure_differs"] = verdict.structure_differs;
  root["parameters_differ"] = verdict.parameters_differ;
  root["drift_not_judged"] = drift_not_judged(fleet);
  root["causes"] = Json::array();
  for (const pool::Prevalence& one : verdict.causes) root["causes"].push_back(prevalence(one));
  root["families"] = Json::array();
  for (const pool::Family& family : verdict.families) {
    Json one = prevalence(family.prevalence);
    one["parameters"] = Json::array();
    for (std::size_t c = 0; c < family.coordinates.size() && family.spread.size() > 0; ++c) {
      const auto at = static_cast<Eigen::Index>(c);
      const bool logarithmic = family.logarithmic[c];
      const double mean = family.spread.mean[at], error = std::sqrt(family.spread.mean_covariance(at, at)),
                   reach = pool::t_quantile(0.05, family.spread.degrees[at]) * error;
      const pool::Range range = pool::prediction_range(family.spread, at, 0.9);
      one["parameters"].push_back(
          {{"name", parameter_name(family.coordinates[c])},
           {"relative", logarithmic},
           {"mean", number(shown_value(mean, logarithmic))},
           {"mean_ci95",
            {number(shown_value(mean - reach, logarithmic)), number(shown_value(mean + reach, logarithmic))}},
           {"between_units_sd", number(std::sqrt(family.spread.between(at, at)))},
           {"between_logs_sd", number(std::sqrt(family.scatter[c].variance))},
           {"differs", static_cast<bool>(family.differs[c])},
           {"p", number(family.spread.heterogeneity_p[at])},
           {"range90",
            {number(shown_value(range.low, logarithmic)), number(shown_value(range.high, logarithmic))}}});
    }
    Json covariance = Json::array();
    for (Eigen::Index row = 0; row < family.spread.between.rows(); ++row)
      for (Eigen::Index column = 0; column <= row; ++column)
        covariance.push_back(number(family.spread.between(row, column)));
    one["between_units_covariance"] = covariance;
    root["families"].push_back(std::move(one));
  }
  root["weak_effects"] = Json::array();
  for (const pool::WeakEffect& one : verdict.weak)
    root["weak_effects"].push_back({{"cause", one.explanation},
                                    {"stands", one.stands},
                                    {"p", number(one.p)},
                                    {"units", one.units},
                                    {"held_out_gain", number(one.held_out_median)},
                                    {"gain", number(one.gain)},
                                    {"not_told_from", one.not_told_from}});
  root["weak_shift"] = Json::object();
  for (const auto& [name, shift] : verdict.weak_shift)
    root["weak_shift"][parameter_name(name)] = {{"by", number(shift.by)},
                                                {"sd", number(std::sqrt(shift.variance))}};
  root["units"] = Json::array();
  for (const pool::UnitVerdict& unit : verdict.units) {
    Json one = {{"unit", unit.unit},
                {"logs", unit.logs.size()},
                {"family", unit.family},
                {"member", unit.member},
                {"own_cause", unit.own_cause},
                {"own_probability", number(unit.own_probability)},
                {"odd", to_string(unit.oddity)},
                {"misfit", number(unit.misfit)}};
    if (unit.family >= 0 && unit.estimate) {
      const pool::Family& family = verdict.families[static_cast<std::size_t>(unit.family)];
      one["distance"] = number(unit.standing.distance);
      one["p"] = number(unit.standing.p);
      one["furthest"] =
          parameter_name(family.coordinates[static_cast<std::size_t>(unit.standing.coordinate)]);
      one["standard_deviations"] = number(unit.standing.standard_deviations);
      one["parameters"] = Json::object();
      for (std::size_t c = 0; c < family.coordinates.size() && unit.shrunken; ++c) {
        const auto at = static_cast<Eigen::Index>(c);
        const bool logarithmic = family.logarithmic[c];
        const double reach = pool::reach95(family.spread, *unit.shrunken, at);
        one["parameters"][parameter_name(family.coordinates[c])] = {
            {"value", number(shown_value(unit.shrunken->at[at], logarithmic))},
            {"ci95",
             {number(shown_value(unit.shrunken->at[at] - reach, logarithmic)),
              number(shown_value(unit.shrunken->at[at] + reach, logarithmic))}},
            {"own", number(shown_value(unit.estimate->at[at], logarithmic))}};
      }
      one["drifts"] = Json::array();
      for (const pool::UnitDrift& drift : unit.drifts) {
        const auto place = std::find(family.coordinates.begin(), family.coordinates.end(), drift.coordinate);
        one["drifts"].push_back(drift_json(
            drift, family.logarithmic[static_cast<std::size_t>(place - family.coordinates.begin())]));
      }
    }
    root["units"].push_back(std::move(one));
  }
  root["bad_logs"] = Json::array();
  for (const pool::BadLog& one : verdict.bad_logs)
    root["bad_logs"].push_back({{"log", fleet.results[one.log].log}, {"reason", one.reason}});
  return root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string date_of(double days) {
  if (!std::isfinite(days)) return {};
  if (!(days > 3650.0 && days < 100000.0))
    return "day " + io::readable(days, 4);  // no date that a log is from
  // Howard Hinnant's civil_from_days.
  const int shifted = static_cast<int>(std::floor(days)) + 719468, era = shifted / 146097,
            of_era = shifted - era * 146097,
            year_of_era = (of_era - of_era / 1460 + of_era / 36524 - of_era / 146096) / 365,
            of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100),
            month_from_march = (5 * of_year + 2) / 153, day = of_year - (153 * month_from_march + 2) / 5 + 1,
            month = month_from_march < 10 ? month_from_march + 3 : month_from_march - 9,
            year = year_of_era + era * 400 + (month <= 2 ? 1 : 0);
  char text[40];
  std::snprintf(text, sizeof text, "%04d-%02d-%02d", year, month, day);
  return text;
}

std::string drift_not_judged(const FleetResults& fleet) {
  constexpr std::size_t fewest = 4;
  std::string the_only;
  std::size_t several = 0, enough = 0;
  for (const pool::UnitVerdict& unit : fleet.verdict.units) {
    std::size_t dated = 0;
    for (const std::size_t log : unit.logs) dated += std::isfinite(fleet.results[log].time) ? 1 : 0;
    enough += dated >= fewest ? 1 : 0;
    if (dated >= 2 && several++ == 0) the_only = unit.unit;
  }
  if (enough == 0) return "no unit has four dated logs";
  return several == 1 ? "only unit " + the_only + " has several dated logs" : std::string();
}

std::string fleet_summary(const FleetResults& fleet) {
  const pool::FleetVerdict& verdict = fleet.verdict;
  std::ostringstream text;
  char line[400];
  std::size_t odd = 0, drifting = 0;
  for (const pool::UnitVerdict& one : verdict.units) {
    odd += one.oddity != pool::Oddity::none ? 1 : 0;
    drifting += one.drifts.empty() ? 0 : 1;
  }
  std::map<std::string, std::size_t> verdicts;
  for (const pool::LogResult& one : fleet.results)
    ++verdicts[one.verdict ? to_string(*one.verdict) : "no report"];
  for (const auto& [name, count] : verdicts) {
    std::snprintf(line, sizeof line, "  %-14s %zu\n", name.c_str(), count);
    text << line;
  }
  const auto name_of = [](const std::string& cause) { return cause.empty() ? std::string("no gap") : cause; };
  const auto count_of = [](std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
  };
  const std::string not_judged = drift_not_judged(fleet);
  text << count_of(verdict.units.size(), "unit", "units") << ", "
       << count_of(verdict.families.size(), "family", "families") << ", " << odd << " odd, "
       << (drifting > 0 || not_judged.empty() ? std::to_string(drifting) + " drifting"
                                              : "drift not judged (" + not_judged + ")")
       << ", " << count_of(verdict.bad_logs.size(), "log", "logs") << " without a statement\n";
  for (const pool::Family& family : verdict.families) {
    std::snprintf(line, sizeof line, "  %-34s %.0f %s (%.0f to %.0f %%)\n", name_of(family.cause).c_str(),
                  family.prevalence.units, std::lround(family.prevalence.units) == 1 ? "unit" : "units",
                  100.0 * family.prevalence.share90.low, 100.0 * family.prevalence.share90.high);
    text << line;
    for (std::size_t c = 0; c < family.coordinates.size() && family.spread.size() > 0; ++c) {
      const auto at = static_cast<Eigen::Index>(c);
      const double sd = std::sqrt(family.spread.between(at, at));
      const pool::Range range = pool::prediction_range(family.spread, at, 0.9);
      const bool logarithmic = family.logarithmic[c];
      std::snprintf(line, sizeof line,
                    "    %-32s mean %.4g, units spread by %.2g%s%s, 90 %% within %.4g to %.4g\n",
                    parameter_name(family.coordinates[c]).c_str(),
                    shown_value(family.spread.mean[at], logarithmic), logarithmic ? 100.0 * sd : sd,
                    logarithmic ? " %" : "", family.differs[c] ? "" : " (not beyond their errors)",
                    shown_value(range.low, logarithmic), shown_value(range.high, logarithmic));
      text << line;
    }
  }
  for (const pool::WeakEffect& one : verdict.weak) {
    if (!one.stands) break;
    text << "  in units without a cause of their own a little of " << one.explanation << " (p "
         << shortest(one.p, "%.2g") << " on held-out data)";
    for (const std::string& other : one.not_told_from) text << ", which could be " << other;
    text << "\n";
    for (const auto& [name, shift] : verdict.weak_shift) {
      std::snprintf(line, sizeof line, "    %-32s %+.2g %% by it, in all units' values above and below\n",
                    parameter_name(name).c_str(), 100.0 * shift.by);
      text << line;
    }
    break;
  }
  for (const pool::UnitVerdict& unit : verdict.units) {
    if (unit.oddity == pool::Oddity::none) continue;
    const pool::Family& family = verdict.families[static_cast<std::size_t>(unit.family)];
    text << "  odd: " << unit.unit << ", ";
    if (unit.oddity == pool::Oddity::misfit) {
      text << "the cause of its family (" << name_of(family.cause) << ") leaves "
           << shortest(unit.misfit, "%.3g") << " times the others' error";
    } else {
      const auto c = static_cast<std::size_t>(unit.standing.coordinate);
      const auto at = static_cast<Eigen::Index>(c);
      text << parameter_name(family.coordinates[c]) << " is "
           << shortest(shown_value(unit.estimate->at[at], family.logarithmic[c]), "%.4g") << ", "
           << shortest(std::abs(unit.standing.standard_deviations), "%.3g") << " standard deviations "
           << (unit.standing.standard_deviations < 0.0 ? "below" : "above") << " the others";
    }
    if (!unit.member && !unit.own_cause.empty()) text << "; its own logs say " << unit.own_cause;
    text << "\n";
  }
  for (const pool::UnitVerdict& unit : verdict.units)
    for (const pool::UnitDrift& one : unit.drifts) {
      const pool::Family& family = verdict.families[static_cast<std::size_t>(unit.family)];
      const auto place = std::find(family.coordinates.begin(), family.coordinates.end(), one.coordinate);
      const bool logarithmic =
          family.logarithmic[static_cast<std::size_t>(place - family.coordinates.begin())];
      text << "  drift: " << unit.unit << ", " << parameter_name(one.coordinate) << " by "
           << (logarithmic ? shortest(100.0 * std::expm1(one.drift.size), "%+.3g") + " %"
                           : shortest(one.drift.size, "%+.3g"))
           << (one.drift.kind == pool::DriftKind::slope ? " steadily, " : " at once, between ")
           << date_of(one.drift.since) << (one.drift.kind == pool::DriftKind::slope ? " to " : " and ")
           << date_of(one.drift.until) << "\n";
    }
  return text.str();
}

std::size_t write_fleet_results(std::vector<FleetLog>& logs, const std::string& folder) {
  FleetResults fleet{logs, {}, {}, {}, {}};
  fleet.results.resize(logs.size());
  fleet.causes.resize(logs.size());
  fleet.probability.assign(logs.size(), missing);
  thermopower::gap::engine::in_parallel(
      logs.size(), std::max(1u, std::thread::hardware_concurrency()), [&](std::size_t i) {
        read_report(logs[i], fleet.results[i], fleet.causes[i], fleet.probability[i]);
        fleet.results[i].log = logs[i].manifest->cell("log");
        fleet.results[i].unit = logs[i].manifest->cell("unit");
        fleet.results[i].time = logs[i].manifest->time_days;
      });
  fleet.verdict = pool::judge_fleet(fleet.results);
  io::OutputFiles outputs;
  const auto put = [&](const char* name, std::string contents) {
    outputs.put(folder + "/" + name, std::move(contents));
  };
  put("logs.csv", logs_csv(fleet));
  put("units.csv", units_csv(fleet));
  put("fleet.json", fleet_json(fleet));
  put("fleet.html", fleet_page(fleet));
  put("summary.txt", fleet_summary(fleet));
  if (std::string database = fleet_database(fleet, folder); !database.empty())
    put("fleet.sqlite", std::move(database));
  outputs.commit();
  return static_cast<std::size_t>(
      std::count_if(logs.begin(), logs.end(), [](const FleetLog& one) { return !one.fault.empty(); }));
}
