// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check_data.hpp>
#include <thermopower/gap/detail/check.hpp>
#include <thermopower/gap/detail/enough_data.hpp>
#include <thermopower/gap/data/neighbour_motion.hpp>
#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/fit/judgeable.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/actuator_plant.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap {

namespace engine {

/// Some of a recording that spans its excitation: of an axis four stretches of consecutive rows, of a bench every n-th
/// row with the mean power, so that it spans a time in which temperatures move.
inline Recording sampled(const Recording& recording, bool axis) {
  constexpr Eigen::Index most = 3000;  // rows that are simulated
  if (recording.rows() <= most) return recording;
  Recording part;
  part.name = recording.name;
  std::vector<Eigen::Index> rows;
  const Eigen::Index stride = axis ? 1 : (recording.rows() + most - 1) / most;
  constexpr Eigen::Index parts = 4;
  const auto add = [&](Eigen::Index from, Eigen::Index end, const std::string& label) {
    const auto begin = static_cast<Eigen::Index>(rows.size());
    for (Eigen::Index i = from; i < end; i += stride) rows.push_back(i);
    if (static_cast<Eigen::Index>(rows.size()) - begin > 1)
      part.runs.push_back({begin, static_cast<Eigen::Index>(rows.size()), label});
    else rows.resize(static_cast<std::size_t>(begin));
  };
  for (const RunSpan& run : recording.spans()) {
    if (!axis) add(run.begin, run.end, run.label);
    for (Eigen::Index p = 0; axis && p < parts; ++p) {
      const Eigen::Index begin = p * (recording.rows() - most / parts) / (parts - 1);
      add(std::max(begin, run.begin), std::min(begin + most / parts, run.end), run.label);
    }
  }
  const auto count = static_cast<Eigen::Index>(rows.size());
  const auto pick = [&](const Eigen::VectorXd& values, bool mean) {
    Eigen::VectorXd picked(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index row = rows[static_cast<std::size_t>(k)];
      picked[k] = mean ? values.segment(row, std::min(stride, values.size() - row)).mean() : values[row];
    }
    return picked;
  };
  part.t_s = pick(recording.t_s, false);
  for (const Column& column : recording.columns)
    part.columns.push_back({column.name, pick(column.values, column.name == "power_param" && stride > 1)});
  return part;
}

/// Thresholds of what a recording can show.
/// Held by tests/gap/known_inputs_test.cpp and tests/gap/network_test.cpp.
struct WorthThresholds {
  double step = 0.01;        ///< relative step of a constant for its derivative
  double gain = 1.1;         ///< usual size of an effect that starts as a factor of 1
  double prior = 0.05;       ///< how well constants are known before, as a share
  double determined = 0.05;  ///< standard deviation below which a constant counts as determined
  double takes_part = 0.3;   ///< component of a constant in a combination, of 1
  double absorbed = 0.1;     ///< share of a signature that must remain when constants move
  double alike = 0.95;       ///< cosine above which two effects look the same
  double visible = 0.5;      ///< noise units below which an effect of usual size does not show
};

/// Simulated signals of a recording in noise units, one vector; 0 where nothing was measured.
class Responses {
public:
  /// @param sample     a part of a recording that spans its excitation
  /// @param horizon_s  length of the axis' windows in s
  Responses(const Model& model, const Recording& sample, double horizon_s, const Catalogue& catalogue)
      : sample_(sample), catalogue_(catalogue) {
    options_.horizon_s = horizon_s;
    for (const SimulatedSignal& signal : simulate(model, sample, options_, catalogue)) {
      const Eigen::VectorXd measured = unwrapped(sample.column(to_string(signal.signal)), sample.spans());
      SignalReport report;
      report.signal = to_string(signal.signal);
      const auto known = signal.signal.known();
      if (known) report.unit = unit_of(*known);
      else if (const plant::PlantInfo* own = plant_of(model).info())
        for (const plant::PlantSignal& one : own->signals)
          if (one.name == report.signal) report.unit = one.unit;
      double squares = 0.0;
      Eigen::VectorXd used = Eigen::VectorXd::Zero(sample.rows());
      for (Eigen::Index i = 0; i < sample.rows(); ++i) {
        const double error = signal.values[i] - measured[i];
        const bool restarts = std::abs(error) <= 1e-9 * std::max(1.0, std::abs(measured[i]));
        if (!std::isfinite(error) || restarts) continue;
        used[i] = 1.0;
        squares += error * error;
      }
      report.samples = static_cast<Eigen::Index>(used.sum());
      // A sensor's noise is what neighbours do not tell of each other, whatever the model.
      report.noise = std::max(noise_on_motion(measured, &sample.t_s, sample.spans()),
                              quantum_of(measured) / std::sqrt(12.0));
      report.misfit = report.samples == 0 ? 0.0 : std::sqrt(squares / used.sum());
      std::vector<double> values = finite_samples(measured);
      report.range = middle_range_of(values);
      signals_.push_back(std::move(report));
      used_.push_back(std::move(used));
    }
    base_ = of(model);
  }

  /// The measured part of each signal.
  const std::vector<SignalReport>& signals() const { return signals_; }
  /// The model's own response.
  const Eigen::VectorXd& base() const { return base_; }

  /// The response of a model: all signals one after the other.
  Eigen::VectorXd of(const Model& model) const {
    Eigen::VectorXd all(static_cast<Eigen::Index>(signals_.size()) * sample_.rows());
    std::size_t k = 0;
    for (const SimulatedSignal& signal : simulate(model, sample_, options_, catalogue_)) {
      assert(k < signals_.size() && signal.values.size() == sample_.rows());
      const double noise = std::max(signals_[k].noise, 1e-12);
      for (Eigen::Index i = 0; i < sample_.rows(); ++i) {
        const double value = signal.values[i] / noise;
        all[static_cast<Eigen::Index>(k) * sample_.rows() + i] =
            used_[k][i] > 0.0 && std::isfinite(value) ? std::clamp(value, -1e9, 1e9) : 0.0;
      }
      ++k;
    }
    return all;
  }

  /// Largest root mean square of a change over the signals.
  double size(const Eigen::VectorXd& change) const {
    assert(change.size() == static_cast<Eigen::Index>(signals_.size()) * sample_.rows());
    double most = 0.0;
    for (std::size_t k = 0; k < signals_.size(); ++k) {
      const double count = std::max(1.0, used_[k].sum());
      most = std::max(most,
                      change.segment(static_cast<Eigen::Index>(k) * sample_.rows(), sample_.rows()).norm() /
                          std::sqrt(count));
    }
    return most;
  }

private:
  const Recording& sample_;
  const Catalogue& catalogue_;
  SimulationOptions options_;
  std::vector<SignalReport> signals_;
  std::vector<Eigen::VectorXd> used_;
  Eigen::VectorXd base_;
};

/// Whether a need is a column of the recording.
inline bool is_column(plant::Need need) {
  constexpr plant::Need columns[] = {
      plant::Need::current_A,   plant::Need::motor_C,      plant::Need::angle_deg,  plant::Need::rate_dps,
      plant::Need::power_param, plant::Need::airspeed_mps, plant::Need::neighbour_C};
  return std::find(std::begin(columns), std::end(columns), need) != std::end(columns);
}

/// A parameter of usual size: where fits begin.
inline double usual_size(const Parameter& parameter, const Model& model, const Recording& recording) {
  assert(!parameter.starts.empty() && parameter.lower <= parameter.upper);
  double value = parameter.starts.front();
  const bool is_drive = parameter.starts_relative_to == plant::Input::drive_A;
  const bool voltage_driven = is_drive && model.axis && model.axis->voltage_driven();
  const char* const input = is_drive ? (voltage_driven ? "voltage_V" : "drive_A")
                            : parameter.starts_relative_to == plant::Input::power_param ? "power_param"
                            : parameter.starts_relative_to == plant::Input::supply_V    ? "supply_V"
                                                                                        : nullptr;
  if (input != nullptr && recording.has(input)) {
    std::vector<double> sizes = finite_samples(recording.column(input).cwiseAbs());
    value *= quantile_of(sizes, 1.0);
    if (voltage_driven) value /= model.axis->resistance_ohm;  // as a current at standstill
  } else if (is_drive && model.has_servo()) {
    value *= model.get("servo.limit_A");
  }
  constexpr double of_range = 0.1;
  if (value == 0.0) value = of_range * (parameter.upper > 0.0 ? parameter.upper : parameter.lower);
  return std::clamp(value, parameter.lower, parameter.upper);
}

/// Constants: derivative of the responses by each, and what follows for them.
inline Eigen::MatrixXd judge_constants(const Model& model, const Responses& responses, DataReport& report) {
  constexpr WorthThresholds limit;
  const std::vector<CalibratedConstant> constants = model.calibrated();
  Eigen::MatrixXd slopes(responses.base().size(), 0);
  std::vector<std::string> names;
  std::vector<bool> places;
  for (const CalibratedConstant& constant : constants) {
    if (!constant.may_be_cause) continue;
    Model moved = model;
    for (const std::string& field : constant.fields) {
      const std::string name = constant.block + "." + field;
      moved.set(name, constant.moved(moved.get(name),
                                     constant.is_place ? std::log1p(limit.step) : 1.0 + limit.step));
    }
    const Eigen::VectorXd slope = (responses.of(moved) - responses.base()) / std::log1p(limit.step);
    if (!(slope.squaredNorm() > 0.0)) continue;  // its block is not judged
    slopes.conservativeResize(Eigen::NoChange, slopes.cols() + 1);
    slopes.col(slopes.cols() - 1) = slope;
    names.push_back(constant.id);
    places.push_back(constant.is_place);
  }
  if (names.empty()) return slopes;
  const Eigen::MatrixXd information = slopes.transpose() * slopes;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(information);
  const double floor = 1e-12 * std::max(modes.eigenvalues().maxCoeff(), 1e-300);
  const Eigen::VectorXd variances = modes.eigenvalues().cwiseMax(floor).cwiseInverse();
  const Eigen::MatrixXd covariance =
      modes.eigenvectors() * variances.asDiagonal() * modes.eigenvectors().transpose();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    report.constants.push_back({names[i], 1.0 / std::sqrt(std::max(information(at, at), 1e-300)),
                                std::sqrt(std::max(covariance(at, at), 0.0)), places[i]});
  }
  for (Eigen::Index k = 0; k < variances.size(); ++k) {
    const double sd = std::sqrt(variances[k]);
    if (!(sd > limit.determined)) continue;
    Combination weak;
    weak.sd = sd;
    const Eigen::VectorXd mode = modes.eigenvectors().col(k);
    Eigen::Index first = 0;
    mode.cwiseAbs().maxCoeff(&first);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double part = mode[static_cast<Eigen::Index>(i)] * (mode[first] > 0.0 ? 1.0 : -1.0);
      if (std::abs(part) > limit.takes_part) weak.constants.push_back((part < 0.0 ? "-" : "") + names[i]);
    }
    report.only_together.push_back(std::move(weak));
  }
  sort_by(report.only_together, [](const Combination& one) { return -one.sd; });
  return slopes;
}

/// Effects: what one of usual size changes that constants, moving as far as they are unknown, cannot imitate.
inline void judge_effects(const Model& model, const Recording& recording, const std::vector<Inputs>& inputs,
                          const Responses& responses, const Eigen::MatrixXd& slopes,
                          const Catalogue& catalogue, DataReport& report) {
  constexpr WorthThresholds limit;
  std::vector<Eigen::VectorXd> signatures;
  Eigen::MatrixXd penalised = slopes.transpose() * slopes;
  penalised.diagonal().array() += 1.0 / (limit.prior * limit.prior);
  const Eigen::LDLT<Eigen::MatrixXd> solver(penalised);
  bool bench = false, axis = false;
  for (const Inputs& one : inputs) bench = bench || one.bench(), axis = axis || one.axis();
  for (const CatalogueEntry& entry : catalogue.entries()) {
    if (model.effects.count(entry.info.id) > 0) continue;
    const bool concerns = (entry.hooks.any_bench() && bench) || (entry.hooks.any_axis() && axis);
    if (!can_be_judged(entry, model, inputs)) {
      std::vector<std::string> needs;
      for (const plant::Need need : entry.info.needs)
        if (is_column(need) && !recording.has(to_string(need))) needs.push_back(to_string(need));
      if (concerns && !needs.empty()) report.need_columns.push_back(entry.info.id + ": " + listed(needs));
      continue;
    }
    Model with = model;
    EffectParameters& parameters = with.effects[entry.info.id];
    for (const Parameter& parameter : entry.info.parameters)
      parameters[parameter.name] = usual_size(parameter, model, recording);
    Eigen::VectorXd change = responses.of(with) - responses.base();
    if (!(change.squaredNorm() > 0.0)) {  // a gain starts at 1, where it does nothing
      for (auto& [name, value] : parameters) value *= limit.gain;
      change = responses.of(with) - responses.base();
    }
    Eigen::VectorXd own = change;
    if (slopes.cols() > 0) own -= slopes * solver.solve(slopes.transpose() * change);
    EffectReport one;
    one.effect = entry.info.id;
    one.visible = responses.size(own);
    one.absorbed = one.visible < limit.visible && own.norm() < limit.absorbed * change.norm();
    report.effects.push_back(std::move(one));
    signatures.push_back(std::move(own));
  }
  assert(signatures.size() == report.effects.size());
  for (std::size_t a = 0; a < signatures.size(); ++a)
    for (std::size_t b = 0; b < signatures.size(); ++b) {
      const double norm = signatures[a].norm() * signatures[b].norm();
      if (a == b || !(norm > 0.0) || report.effects[a].visible < limit.visible ||
          report.effects[b].visible < limit.visible)
        continue;
      if (std::abs(signatures[a].dot(signatures[b])) > limit.alike * norm)
        report.effects[a].alike.push_back(report.effects[b].effect);
    }
  sort_by(report.effects, [](const EffectReport& one) { return -one.visible; });
}

}  // namespace engine

THERMOPOWER_GAP_INLINE DataReport check_data(const Model& model, const std::vector<Recording>& train,
                                             const std::vector<Recording>& held_out, const Options& options,
                                             const Catalogue& given) {
  options.validate();
  const Catalogue& catalogue = catalogue_of(model, given);
  if (const auto problem = model.validate()) throw InvalidInput("model '" + model.name + "': " + *problem);
  if (train.empty()) throw InvalidInput("there is no recording to look at");
  engine::CheckedRecordings checked =
      engine::check(model, train, held_out, {options.horizon_s, options.as_recorded}, catalogue);
  DataReport report;
  report.findings = std::move(checked.findings);
  const engine::PreparedRecording* longest = &checked.train.front();
  std::vector<Inputs> inputs;
  for (const engine::PreparedRecording& one : checked.train) {
    inputs.push_back(one.inputs());
    if (one.recording().rows() > longest->recording().rows()) longest = &one;
  }
  report.not_judged = engine::not_judged_in({&inputs});
  std::vector<Inputs> judged_on;
  for (const engine::PreparedRecording& one : checked.held_out) judged_on.push_back(one.inputs());
  report.too_little = engine::lacking(model, inputs, false, options.horizon_s, report.next_experiment);
  if (report.too_little.empty() && !judged_on.empty())
    report.too_little = engine::lacking(model, judged_on, true, options.horizon_s, report.next_experiment);
  constexpr Eigen::Index few = 12;
  const Recording sample = engine::sampled(longest->recording(), longest->inputs().axis());
  if (sample.rows() < few) return report;
  const engine::Responses responses(model, sample, options.horizon_s, catalogue);
  report.signals = responses.signals();
  if (deciding(report.findings) != nullptr) return report;  // nothing that follows could be believed
  const Eigen::MatrixXd slopes = engine::judge_constants(model, responses, report);
  engine::judge_effects(model, longest->recording(), inputs, responses, slopes, catalogue, report);
  return report;
}

}  // namespace thermopower::gap
