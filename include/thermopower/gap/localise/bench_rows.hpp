// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise/rows.hpp>
#include <thermopower/gap/model.hpp>

/// @file bench_rows.hpp
/// What a motor on a bench recorded, and what the laws say of it.

namespace thermopower::gap::detail {

/// What a bench recorded, without holes, and what the laws say of it when each is given its measured inputs.
struct BenchRows {
  std::vector<RunSpan> runs;
  Eigen::VectorXd t_s, step_s;         ///< time, and the interval that starts at the row
  Eigen::VectorXd current_A, motor_C;  ///< measured; NaN is missing
  Eigen::VectorXd winding_C;           ///< motor_C without holes
  Eigen::VectorXd ambient_C, supply_V, v_rms_V;
  Eigen::VectorXd law_A;           ///< the law's current at the measured temperature
  Eigen::VectorXd law_ohm;         ///< the law's resistance there (V_rms / I where there is no ohmic law)
  std::vector<Column> covariates;  ///< other numeric columns, without holes
  bool has_power = false, has_current = false, has_temperature = false;
  double interval_s = 1.0;  ///< median step
};

inline double law_current(const Model& model, double v_rms_V, double winding_C) {
  if (const auto* ohmic = std::get_if<OhmicCurrentModel>(&model.current)) {
    return v_rms_V / (ohmic->resistance_ohm * (1.0 + ohmic->tempco_per_K * (winding_C - ohmic->reference_C)));
  }
  if (const auto* thesis = std::get_if<ThesisCurrentModel>(&model.current)) {
    if (v_rms_V <= thesis->minimum_V_rms) return 0.0;
    const double slope = (thesis->slope_V2_mA_per_K * v_rms_V + thesis->slope_V1_mA_per_K) * v_rms_V +
                         thesis->slope_V0_mA_per_K;
    return std::max(0.0, slope * winding_C + thesis->base_mA * std::pow(v_rms_V, thesis->exponent)) * 1e-3;
  }
  return 0.0;
}

inline BenchRows bench_rows(const Model& model, const Recording& recording) {
  BenchRows b;
  const Eigen::Index n = recording.rows();
  b.runs = recording.spans();
  b.t_s = recording.t_s;
  b.step_s = Eigen::VectorXd::Zero(n);
  std::vector<double> steps;
  for (const RunSpan& run : b.runs) {
    for (Eigen::Index i = run.begin; i + 1 < run.end; ++i) {
      b.step_s[i] = b.t_s[i + 1] - b.t_s[i];
      steps.push_back(b.step_s[i]);
    }
  }
  if (!steps.empty()) {
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                     steps.end());
    b.interval_s = steps[steps.size() / 2];
  }
  b.has_power = recording.has("power_param");
  b.has_temperature = recording.has("motor_C");
  const bool driven = !recording.has("current_A") && !b.has_power && recording.has("drive_A");
  b.has_current = recording.has("current_A") || driven;
  const Eigen::VectorXd none = Eigen::VectorXd::Constant(n, missing);
  b.current_A = b.has_current ? *recording.find(driven ? "drive_A" : "current_A") : none;
  b.motor_C = b.has_temperature ? *recording.find("motor_C") : none;
  b.winding_C = held(recording.find("motor_C"), b.runs, n, 25.0);
  b.ambient_C =
      recording.has("ambient_C") ? held(recording.find("ambient_C"), b.runs, n, 25.0) : Eigen::VectorXd();
  if (b.ambient_C.size() == 0) {
    b.ambient_C.resize(n);
    for (const RunSpan& run : b.runs)
      b.ambient_C.segment(run.begin, run.size()).setConstant(b.winding_C[run.begin]);
  }
  b.supply_V = held(recording.has("supply_V") ? recording.find("supply_V") : nullptr, b.runs, n,
                    model.supply ? model.supply->nominal_V : 12.0);
  const Eigen::VectorXd power = held(recording.find("power_param"), b.runs, n, 0.0);
  b.v_rms_V = b.supply_V.array() * (power.array().max(0.0) / 255.0).sqrt();
  b.law_A.resize(n);
  b.law_ohm.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    b.law_A[i] = b.has_power ? law_current(model, b.v_rms_V[i], b.winding_C[i]) : 0.0;
    if (const auto* ohmic = std::get_if<OhmicCurrentModel>(&model.current)) {
      b.law_ohm[i] =
          ohmic->resistance_ohm * (1.0 + ohmic->tempco_per_K * (b.winding_C[i] - ohmic->reference_C));
    } else {
      b.law_ohm[i] = b.law_A[i] > 0.0 ? b.v_rms_V[i] / b.law_A[i] : 0.0;
    }
  }
  static const char* const known[] = {"power_param", "drive_A", "supply_V", "ambient_C",
                                      "current_A",   "motor_C", "angle_deg"};
  for (const Column& column : recording.columns) {
    if (std::any_of(std::begin(known), std::end(known),
                    [&](const char* name) { return column.name == name; }))
      continue;
    if (!recording.has(column.name)) continue;
    Column copy{column.name, held(&column.values, b.runs, n, 0.0)};
    if (copy.values.maxCoeff() > copy.values.minCoeff()) b.covariates.push_back(std::move(copy));
  }
  return b;
}

}  // namespace thermopower::gap::detail
