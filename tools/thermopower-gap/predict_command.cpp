// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "html_text.hpp"
#include "program.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/io.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/plant_info.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

// A number as recordings have it: decimal and finite, or nothing.
std::optional<double> decimal_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || last != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

// Where a run can start at all: no motor is colder than nothing, or whole where metal boils.
struct StartRange {
  double low, high;
  const char* unit;
};
StartRange range_of_start(const std::string& name) {
  const auto ends = [&name](const std::string& with) {
    return name.size() >= with.size() && name.compare(name.size() - with.size(), with.size(), with) == 0;
  };
  if (ends("_C")) return {-273.15, 5000.0, "degC"};
  if (ends("_deg")) return {-1e7, 1e7, "deg"};
  if (ends("_dps")) return {-1e6, 1e6, "deg/s"};
  return {-1e12, 1e12, ""};
}

std::map<std::string, double> starts_of(const std::vector<std::string>& texts, const gap::Model& model) {
  std::vector<std::string> names;
  if (model.has_thermal()) names = {"motor_C"};
  if (model.axis) names.insert(names.end(), {"angle_deg", "rate_dps"});
  if (model.own) {
    for (const auto& signal : model.own->equations->info()->signals) names.push_back(signal.name);
  }
  std::string expected;
  for (std::size_t i = 0; i < names.size(); ++i)
    expected += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + names[i] + "=";
  std::map<std::string, double> starts;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const bool known = std::find(names.begin(), names.end(), name) != names.end();
    const std::optional<double> value =
        equals == std::string::npos ? std::nullopt : decimal_number(text.substr(equals + 1));
    if (!known || !value)
      throw UsageError("--start " + text + ": " +
                       (expected.empty() ? "this model has nothing that starts somewhere"
                                         : "expected " + expected + " with a decimal number"));
    const StartRange range = range_of_start(name);
    if (!(*value >= range.low && *value <= range.high))
      throw UsageError("--start " + text + ": expected " + io::readable(range.low, 5) + " to " +
                       io::readable(range.high, 5) + " " + range.unit);
    if (!starts.emplace(name, *value).second) throw UsageError("--start " + name + " is given twice");
  }
  return starts;
}

// Inputs with missing cells leave holes in what is predicted: nothing fills them here, as the check of a diagnosis does.
void warn_of_holes(const gap::Recording& recording, const gap::Model& model) {
  std::vector<std::string> inputs{"power_param", "drive_A",   "voltage_V", "target_deg", "target_dps",
                                  "target_C",    "torque_Nm", "heat_W",    "supply_V",   "ambient_C"};
  if (model.own) {
    inputs.clear();
    for (const auto& one : model.own->equations->info()->inputs) inputs.push_back(one.name);
  }
  for (const std::string& name : inputs) {
    if (!recording.has(name)) continue;
    const auto known = recording.column(name).array().isFinite();
    const Eigen::Index missing = recording.rows() - known.count();
    if (missing == 0) continue;
    Eigen::Index first = 0;
    while (known[first]) ++first;
    std::fprintf(
        stderr,
        "thermopower-gap: %s: column '%s': %td of %td cells are missing, first at t_s = %s: what is predicted from "
        "there on cannot be trusted, and may be empty; fill them, or cut the recording into runs there\n",
        recording.name.c_str(), name.c_str(), static_cast<std::ptrdiff_t>(missing),
        static_cast<std::ptrdiff_t>(recording.rows()), io::readable(recording.t_s[first]).c_str());
  }
}

int predict(const Arguments& arguments) {
  const gap::Catalogue& catalogue = gap::standard_catalogue();
  refuse_overlaps(arguments);
  io::OutputFiles outputs;
  outputs.expect(arguments.predictions);
  const gap::Model augmented = io::read_model(arguments.model, catalogue);
  std::vector<gap::Finding> findings;
  std::vector<gap::Recording> recordings =
      read_all(arguments.recordings, reading(arguments, augmented), findings);
  const std::map<std::string, double> starts = starts_of(arguments.starts, augmented);
  for (const gap::Recording& one : recordings) warn_of_holes(one, augmented);
  for (gap::Recording& one : recordings) one = io::with_starts(std::move(one), augmented, starts);
  gap::Model bare = augmented;
  bare.effects.clear();
  outputs.put(arguments.predictions,
              io::predictions_csv(bare, augmented, recordings, arguments.horizon_s, catalogue));
  outputs.commit();
  return made;
}

}  // namespace

Command add_predict(CLI::App& program) {
  const auto asked = std::make_shared<Arguments>();
  CLI::App* const app = program.add_subcommand("predict", "simulate a recording with a model");
  app->add_option("--model", asked->model, "a model, with effects or without (JSON)")->required();
  add_recordings(*app, *asked, "a recording");
  app->add_option("--predictions", asked->predictions, "where the predictions go (CSV)")->required();
  app->add_option("--start", asked->starts,
                  "where a run starts, as in motor_C=40 (also angle_deg, rate_dps); without it as "
                  "measured, else at the air's temperature and at rest");
  add_horizon(*app, *asked)->capture_default_str();
  add_column_choices(*app, *asked);
  return {app, [asked] { return predict(*asked); }};
}
