// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/predictions_file.hpp>

#include <thermopower/gap/simulate.hpp>
#include <thermopower/io/input_error.hpp>
#include <thermopower/io/text_table.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/plant_info.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace thermopower::io {
namespace {

void append(std::string& out, double value) {
  if (!std::isfinite(value)) return;
  char text[32];
  out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

const Eigen::VectorXd* find(const std::vector<SimulatedSignal>& signals, const std::string& name) {
  for (const auto& one : signals) {
    if (to_string(one.signal) == name) return &one.values;
  }
  return nullptr;
}

// What a model predicts, with what its prediction starts from where nobody measured it.
struct Start {
  Signal signal;
  bool predicted;
  double value;
};

// The same for a plant of one's own: what nobody measured starts as warm as the first temperature that is given, other
// quantities at their initial value.
Recording with_own_starts(Recording recording, const plant::PlantInfo& info,
                          const std::map<std::string, double>& starts) {
  const auto air = std::find_if(info.inputs.begin(), info.inputs.end(), [&](const plant::PlantInput& one) {
    return one.unit == "degC" && recording.has(one.name);
  });
  for (const plant::PlantState& state : info.states) {
    if (state.measured_by < 0) continue;
    const plant::PlantSignal& signal = info.signals[static_cast<std::size_t>(state.measured_by)];
    const auto given = starts.find(signal.name);
    if (recording.has(signal.name) && given == starts.end()) continue;
    const bool warm = signal.unit == "degC" && air != info.inputs.end();
    Eigen::VectorXd values =
        recording.has(signal.name)
            ? recording.column(signal.name)
            : Eigen::VectorXd::Constant(recording.rows(), std::numeric_limits<double>::quiet_NaN());
    for (const RunSpan& run : recording.spans())
      values[run.begin] = given != starts.end() ? given->second
                          : warm                ? recording.column(air->name)[run.begin]
                                                : state.initial;
    recording.set(signal.name, values);
  }
  return recording;
}

// The file of what was simulated before and after, by recording.
std::string predictions_csv(const std::vector<HeldOutPrediction>& predictions,
                            const std::vector<Recording>& recordings) {
  std::vector<std::string> signals;  // of all recordings, in order of appearance: one header fits all rows
  std::size_t runs = 0;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    runs += recordings[r].spans().size();
    for (const auto* simulated : {&predictions[r].baseline, &predictions[r].augmented}) {
      for (const auto& one : *simulated) {
        const std::string name = to_string(one.signal);
        if (std::find(signals.begin(), signals.end(), name) == signals.end()) signals.push_back(name);
      }
    }
  }
  if (signals.empty()) {
    throw InputError(
        (recordings.empty() ? std::string() : recordings.front().name + ": ") +
        "nothing to predict: the columns that the model's laws need (power_param, or a heater's target_C, with a supply and "
        "ambient_C, or heat_W and ambient_C, or drive_A, voltage_V or a servo's target) are not recorded");
  }
  std::string out = "t_s";
  if (runs > 1) out += ",run";
  for (const auto& signal : signals) out += "," + signal + "_baseline," + signal + "_augmented";
  out += "\n";
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    std::vector<const Eigen::VectorXd*> columns;
    for (const auto& signal : signals) {
      columns.push_back(find(predictions[r].baseline, signal));
      columns.push_back(find(predictions[r].augmented, signal));
    }
    const auto spans = recordings[r].spans();
    for (std::size_t s = 0; s < spans.size(); ++s) {
      // Labels may repeat (the same file twice) or be empty; a reader needs to see where a run begins.
      std::string label = spans[s].label;
      if (label.empty()) label = std::to_string(s + 1);
      if (recordings.size() > 1) label = std::to_string(r + 1) + ":" + label;
      for (Eigen::Index row = spans[s].begin; row < spans[s].end; ++row) {
        append(out, recordings[r].t_s[row]);
        if (runs > 1) {
          out += ',';
          append_csv_cell(out, label);
        }
        for (const auto* column : columns) {
          out += ',';
          if (column != nullptr) append(out, (*column)[row]);
        }
        out += '\n';
      }
    }
  }
  return out;
}

// Whether an axis' motion is recorded in more rows than its first.
bool is_measured_throughout(const Recording& recording) {
  for (const char* column : {"angle_deg", "rate_dps"}) {
    if (recording.has(column) && recording.column(column).array().isFinite().count() > 1) return true;
  }
  return false;
}

}  // namespace

Recording with_starts(Recording recording, const Model& model, const std::map<std::string, double>& starts) {
  if (model.own) return with_own_starts(std::move(recording), *model.own->equations->info(), starts);
  const bool powered = (recording.has("power_param") || (model.has_heater() && recording.has("target_C"))) &&
                       (model.supply || recording.has("supply_V"));
  const bool heated = (model.has_current() && powered) || recording.has("current_A") ||
                      recording.has("drive_A") || recording.has("heat_W");
  const double missing_value = std::numeric_limits<double>::quiet_NaN();
  const bool body = model.has_thermal() && recording.has("ambient_C") && heated;
  const bool commanded =
      model.has_axis() && recording.has(model.axis->voltage_driven() ? "voltage_V" : "drive_A");
  const bool joint =
      commanded || (model.has_servo() && (recording.has("target_deg") || recording.has("target_dps")));
  for (const Start& start : {Start{Signal::motor_C, body, missing_value},
                             Start{Signal::current_A, model.has_current() && powered, 0.0},
                             Start{Signal::angle_deg, joint, 0.0}, Start{Signal::rate_dps, joint, 0.0}}) {
    const std::string name = to_string(start.signal);
    const auto given = starts.find(name);
    if (!start.predicted || (recording.has(name) && given == starts.end())) continue;
    // Windows of a measured angle begin with the rate of its slope, as in a diagnosis: a rate at rest would be none of theirs.
    if (start.signal == Signal::rate_dps && given == starts.end() && is_measured_throughout(recording))
      continue;
    Eigen::VectorXd values = recording.has(name) ? recording.column(name)
                                                 : Eigen::VectorXd::Constant(recording.rows(), missing_value);
    for (const RunSpan& run : recording.spans()) {
      // A body that nobody measured has the temperature of its air.
      const double rest =
          start.signal == Signal::motor_C ? recording.column("ambient_C")[run.begin] : start.value;
      values[run.begin] = given != starts.end() ? given->second : rest;
    }
    recording.set(name, values);
  }
  return recording;
}

std::string predictions_csv(const Model& baseline, const Model& augmented,
                            const std::vector<Recording>& recordings, double horizon_s,
                            const Catalogue& catalogue) {
  SimulationOptions options;
  options.horizon_s = horizon_s;
  std::vector<HeldOutPrediction> predictions;
  for (const auto& recording : recordings) {
    const bool restarts = augmented.has_axis() && !augmented.own && is_measured_throughout(recording);
    const auto predicted = [&](const Model& model) {
      return restarts ? simulate_as_believed(model, recording, horizon_s, catalogue)
                      : simulate(model, recording, options, catalogue);
    };
    predictions.push_back({predicted(baseline), predicted(augmented)});
  }
  return predictions_csv(predictions, recordings);
}

std::string predictions_csv(const Model& model, const Diagnosis& diagnosis,
                            const std::vector<Recording>& held_out, double horizon_s,
                            const Catalogue& catalogue) {
  if (diagnosis.predictions.size() != held_out.size())  // the data were not believed
    return predictions_csv(model, diagnosis.augmented, held_out, horizon_s, catalogue);
  return predictions_csv(diagnosis.predictions, held_out);
}

}  // namespace thermopower::io
