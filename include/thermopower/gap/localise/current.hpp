// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise/bench_rows.hpp>
#include <thermopower/gap/localise/least_squares.hpp>

/// @file current.hpp
/// A motor on a bench: the current, given the measured temperature.

namespace thermopower::gap::detail {

/// The current, given the measured temperature and the supply.
inline Judged judge_current(const Model& model, const BenchRows& b, double slack) {
  Judged j;
  const Thinning thin(b.runs, b.current_A, localisation_rows);
  const Eigen::VectorXd law = b.law_A;
  j.problem.slack = slack;
  j.problem.y = thin(b.current_A - law);
  j.problem.fold = thin.folds(j.problem.folds);
  j.problem.free.resize(thin.rows(), 0);
  if (const auto* ohmic = std::get_if<OhmicCurrentModel>(&model.current)) {
    Eigen::MatrixXd nuisance(law.size(), 2);
    nuisance.col(0) = -law;
    const Eigen::ArrayXd rise = ohmic->tempco_per_K * (b.winding_C.array() - ohmic->reference_C);
    nuisance.col(1) = -law.array() * rise / (1.0 + rise);
    j.problem.nuisance = thin(nuisance);
  } else if (const auto* thesis = std::get_if<ThesisCurrentModel>(&model.current)) {
    Eigen::MatrixXd nuisance(law.size(), 2);
    for (Eigen::Index i = 0; i < law.size(); ++i) {
      const bool on = law[i] > 0.0;
      nuisance(i, 0) = on ? 1e-3 * thesis->base_mA * std::pow(b.v_rms_V[i], thesis->exponent) : 0.0;
      nuisance(i, 1) = on ? law[i] - nuisance(i, 0) : 0.0;
    }
    j.problem.nuisance = thin(nuisance);
  }
  const double sigma = noise_of(b.current_A - law, b.runs);
  j.floor = sigma * sigma * static_cast<double>(thin.rows()) / static_cast<double>(thin.stride());
  const auto add = [&](const char* submodel, const std::string& variable, const std::string& words,
                       const Eigen::MatrixXd& columns) {
    j.blocks.push_back({submodel, variable, words, thin(columns)});
  };
  const Eigen::VectorXd on = (b.v_rms_V.array() > 0.0).cast<double>();
  add("sensing.current", "", "the same offset at every current, none included",
      Eigen::VectorXd::Ones(law.size()));
  add("electrical.scale", "v_rms_V", "the same factor at every voltage", law);
  const Eigen::VectorXd warm = (b.winding_C.array() - 25.0) / 10.0;
  Eigen::MatrixXd columns(law.size(), 2);
  columns.col(0) = law;
  columns.col(1) = law.cwiseProduct(warm);
  add("electrical", "motor_C", "a resistance that depends on the temperature", columns);
  Eigen::VectorXd charge = Eigen::VectorXd::Zero(law.size());
  for (const RunSpan& run : b.runs) {
    double sum = 0.0;
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      charge[i] = sum;
      const double drawn = std::isfinite(b.current_A[i]) ? b.current_A[i] : law[i];
      sum += drawn * b.v_rms_V[i] / std::max(b.supply_V[i], 1e-9) * b.step_s[i] / 3600.0;
    }
  }
  const Eigen::MatrixXd by_voltage = scaled(hats(Eigen::VectorXd(b.v_rms_V.array() + 0.0), 6), law);
  add("electrical", "v_rms_V", "a voltage lost that depends on the drive", by_voltage);
  Eigen::MatrixXd reciprocal(law.size(), 2);
  for (Eigen::Index i = 0; i < law.size(); ++i) {
    reciprocal(i, 0) = law[i];
    reciprocal(i, 1) = b.v_rms_V[i] > 0.0 ? law[i] * std::pow(b.supply_V[i] / b.v_rms_V[i], 2.0) : 0.0;
  }
  add("electrical", "v_rms_V", "a piece of the duty that is lost", reciprocal);
  Eigen::MatrixXd sag(law.size(), 3);
  sag.col(0) = law;
  sag.col(1) = law.cwiseProduct(b.v_rms_V.cwiseProduct(b.v_rms_V));
  sag.col(2) = law.cwiseProduct(charge);
  add("electrical", "v_rms_V", "a supply that gives way under load and with the charge drawn", sag);
  for (const Column& column : b.covariates) {
    const Eigen::VectorXd z =
        column.name == "rate_dps" ? Eigen::VectorXd(column.values.cwiseAbs()) : column.values;
    const double scale = std::max(z.cwiseAbs().maxCoeff(), 1e-12);
    Eigen::MatrixXd voltage(law.size(), 2), factor(law.size(), 2);
    voltage.col(0) = law;
    factor.col(0) = law;
    for (Eigen::Index i = 0; i < law.size(); ++i) {
      voltage(i, 1) = on[i] * (b.law_ohm[i] > 0.0 ? z[i] / scale / b.law_ohm[i] : 0.0);
      factor(i, 1) = law[i] * z[i] / scale;
    }
    add("electrical", column.name, "a voltage lost that grows with " + column.name, voltage);
    add("electrical", column.name, "a factor that changes with " + column.name, factor);
  }
  return j;
}

}  // namespace thermopower::gap::detail
