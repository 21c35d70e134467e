// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise/bench_rows.hpp>
#include <thermopower/gap/localise/least_squares.hpp>

#include <cstdio>

/// @file thermal.hpp
/// A motor on a bench: the temperature, given the heat.

namespace thermopower::gap::detail {

/// Where the heat of a thermal judgement comes from.
enum class HeatSource { law, measured_current, electrical_power };

/// Heat into the motor in W by one source; empty where it is not to be had.
/// @param offset_A what the current sensor reads too much
inline Eigen::VectorXd heat_of(const Model& model, const BenchRows& b, HeatSource source,
                               double offset_A = 0.0) {
  const bool ohmic = std::holds_alternative<OhmicCurrentModel>(model.current);
  const bool polynomial = std::holds_alternative<ThesisThermalModel>(model.thermal);
  const Eigen::Index n = b.t_s.size();
  Eigen::VectorXd heat(n);
  Eigen::VectorXd measured = b.has_current ? held(&b.current_A, b.runs, n, 0.0) : Eigen::VectorXd();
  measured.array() -= offset_A;
  switch (source) {
    case HeatSource::law:
      if (!b.has_power || !model.has_current()) return {};
      return b.v_rms_V.cwiseProduct(b.law_A);
    case HeatSource::measured_current:
      if (!b.has_current || (polynomial && !b.has_power) || (!polynomial && !ohmic)) return {};
      if (polynomial) return b.v_rms_V.cwiseProduct(measured);
      return measured.cwiseProduct(measured).cwiseProduct(b.law_ohm);
    case HeatSource::electrical_power:
      if (!b.has_current || !b.has_power || polynomial) return {};
      return b.v_rms_V.cwiseProduct(measured);
  }
  return {};
}

/// The temperature, given the heat: responses of the baseline's own linear filter to missing watts.
class ThermalJudge {
public:
  ThermalJudge(const Model& model, const BenchRows& rows, const Eigen::VectorXd& heat_W)
      : b_(rows), heat_(heat_W), thin_(rows.runs, rows.motor_C, localisation_rows) {
    const Eigen::Index n = b_.t_s.size();
    capacity_.resize(n);
    relax_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      if (const auto* lumped = std::get_if<LumpedThermalModel>(&model.thermal)) {
        capacity_[i] = lumped->heat_capacity_J_per_K;
        relax_[i] = lumped->conductance_W_per_K / lumped->heat_capacity_J_per_K;
      } else if (const auto* thesis = std::get_if<ThesisThermalModel>(&model.thermal)) {
        const double v = b_.v_rms_V[i];
        const double rinv = (thesis->rinv_slope_V1 * v + thesis->rinv_slope_V0) * b_.winding_C[i] +
                            thesis->rinv_offset_V1 * v + thesis->rinv_offset_V0;
        capacity_[i] = v > thesis->minimum_V_rms ? 60.0 * std::max(rinv, 1e-3) : 60.0 * 1e3;
        relax_[i] = thesis->cooling_per_min / 60.0;
        if (v <= thesis->minimum_V_rms) heat_[i] = 0.0;
      }
    }
    time_constant_s_ = 1.0 / std::max(relax_.mean(), 1e-12);
    polynomial_ = std::holds_alternative<ThesisThermalModel>(model.thermal);
    loss_ = capacity_.cwiseProduct(relax_);
    if (polynomial_) loss_ = Eigen::VectorXd::Constant(n, 1.0);
    simulate();
  }

  /// Temperature response to extra watts from a start at 0.
  Eigen::VectorXd response(const Eigen::VectorXd& watts) const {
    return filtered(watts.cwiseQuotient(capacity_));
  }

  Judged judge(double slack, HeatSource source) const {
    Judged j;
    j.problem.slack = slack;
    j.problem.y = thin_(b_.motor_C - baseline_);
    j.problem.fold = thin_.folds(j.problem.folds);
    const Eigen::Index n = baseline_.size();
    const Eigen::VectorXd rise = b_.winding_C - b_.ambient_C;
    // Written with the measured temperature these are exact however far a constant is off: the baseline's
    // filter is linear.
    const Eigen::VectorXd scale_heat = response(heat_), scale_loss = filtered(-relax_.cwiseProduct(rise));
    const Eigen::VectorXd scale_storage = stored(b_.winding_C);
    Eigen::MatrixXd nuisance(n, source == HeatSource::electrical_power ? 2 : 3);
    nuisance.col(0) = scale_storage;
    nuisance.col(1) = scale_loss;
    if (nuisance.cols() == 3) nuisance.col(2) = scale_heat;
    j.problem.nuisance = thin_(nuisance);
    const Eigen::Index runs = static_cast<Eigen::Index>(b_.runs.size());
    Eigen::MatrixXd starts = Eigen::MatrixXd::Zero(n, runs <= 6 ? runs : 0);
    for (Eigen::Index r = 0; r < starts.cols(); ++r) {
      const RunSpan& run = b_.runs[static_cast<std::size_t>(r)];
      double left = 1.0;
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        starts(i, r) = left;
        left *= std::exp(-relax_[i] * b_.step_s[i]);
      }
    }
    j.problem.free = thin_(starts);
    const double sigma = noise_of(b_.motor_C, b_.runs);
    j.floor = sigma * sigma * static_cast<double>(thin_.rows()) / static_cast<double>(thin_.stride());

    const double unbounded = std::numeric_limits<double>::infinity();
    const auto add = [&](const char* submodel, const std::string& variable, const std::string& words,
                         const Eigen::MatrixXd& columns, double lower) {
      j.blocks.push_back({submodel, variable, words, thin_(columns), lower, unbounded});
    };
    const auto responses = [&](const Eigen::MatrixXd& watts) {
      Eigen::MatrixXd out(watts.rows(), watts.cols());
      for (Eigen::Index k = 0; k < watts.cols(); ++k) out.col(k) = response(watts.col(k));
      return out;
    };
    const Eigen::VectorXd loss = loss_.cwiseProduct(rise);
    add("sensing.temperature", "rise_K", "a thermometer that shows another rise than the heat makes",
        scale_heat, -unbounded);
    add("thermal.storage", "dT_dt", "another heat capacity", scale_storage, -unbounded);
    add("thermal.loss", "rise_K", "another conductance", scale_loss, -unbounded);
    add("thermal.loss", "rise_K", "a loss that is there without a rise", response(loss_), -unbounded);
    add("thermal.loss", "rise_K", "a conductance that depends on the rise",
        responses(scaled(even_hats(rise, 4), loss)), -unbounded);
    add("thermal.storage", "motor_C", "a heat capacity that depends on the temperature", by_capacity(7),
        -unbounded);
    add("thermal.heating", "heat_W", "a heat that is not in proportion to the law's",
        responses(scaled(even_hats(heat_, 4), heat_)), -unbounded);
    if (b_.has_power && polynomial_) {
      Eigen::VectorXd supply(n);
      for (Eigen::Index i = 0; i < n; ++i)
        supply[i] = b_.v_rms_V[i] > 0.0 ? heat_[i] * (b_.supply_V[i] / b_.v_rms_V[i] - 1.0) : 0.0;
      add("thermal.heating", "v_rms_V", "heat by the power at the supply and not at the motor",
          response(supply), 0.0);
    }
    Eigen::MatrixXd fast(n, 5);
    const double shortest = std::max(2.0 * b_.interval_s, 0.004 * time_constant_s_),
                 longest = std::max(0.4 * time_constant_s_, 1.5 * shortest);
    for (Eigen::Index k = 0; k < 5; ++k)
      fast.col(k) = lag(heat_, shortest * std::pow(longest / shortest, static_cast<double>(k) / 4.0), true);
    add("thermal.storage", "dT_dt", "a part that follows the heat faster than the whole", fast, 0.0);
    Eigen::VectorXd latest;
    double least = unbounded, at = 0.0;
    for (int k = 0; k < 14; ++k) {
      const double tau = shortest * std::pow(longest / shortest, k / 13.0);
      const Eigen::VectorXd column = thin_(lag(baseline_, tau, false) - baseline_);
      const double left = quick_fit(j.problem, column);
      if (left < least) {
        least = left;
        latest = column;
        at = tau;
      }
    }
    char words[80];
    std::snprintf(words, sizeof words, "a reading that comes %.3g s after the temperature", at);
    j.blocks.push_back({"sensing.temperature", "dT_dt", words, latest, 0.0, unbounded, 1});
    for (const Column& column : b_.covariates) {
      const Eigen::VectorXd z =
          column.name == "rate_dps" ? Eigen::VectorXd(column.values.cwiseAbs()) : column.values;
      const double scale = std::max(z.cwiseAbs().maxCoeff(), 1e-12);
      const Eigen::VectorXd unit = z / scale;
      Eigen::MatrixXd two(n, 2);
      two.col(0) = loss.cwiseProduct(unit);
      two.col(1) = loss.array() * unit.array().sign() * unit.array().abs().sqrt();
      add("thermal.loss", column.name, "a conductance that changes with " + column.name, responses(two),
          -unbounded);
      if (column.name.size() > 2 && column.name.compare(column.name.size() - 2, 2, "_C") == 0) {
        add("thermal.heating", column.name, "heat that flows in from " + column.name,
            response(loss_.cwiseProduct(column.values - b_.winding_C)), -unbounded);
      } else {
        add("thermal.heating", column.name, "heat with the square of " + column.name,
            response(loss_.cwiseProduct(unit.cwiseProduct(unit))), -unbounded);
        two.col(0) = loss_.cwiseProduct(unit);
        two.col(1) = loss_.cwiseProduct(unit.cwiseProduct(unit));
        add("thermal.heating", column.name, "heat that comes with " + column.name, responses(two),
            -unbounded);
      }
    }
    return j;
  }

  /// Whom to accuse when no block helps: a heat of its own course in time, a conductance of its own course,
  /// or a store at some temperature, whichever follows the residual best for its number of directions.
  /// @return submodel and the sum of squares it leaves, as if it had no more directions than a block
  std::pair<std::string, double> unnamed(const Judged& j) const {
    const Eigen::Index rows = j.problem.y.size(),
                       knots = std::max<Eigen::Index>(6, std::min<Eigen::Index>(60, rows / 20));
    const Eigen::VectorXd order = Eigen::VectorXd::LinSpaced(b_.t_s.size(), 0.0, 1.0);
    const Eigen::MatrixXd course = even_hats(order, static_cast<int>(knots));
    const Eigen::VectorXd rise = b_.winding_C - b_.ambient_C;
    std::pair<std::string, double> best{"", std::numeric_limits<double>::infinity()};
    const auto attempt = [&](const char* submodel, const Eigen::MatrixXd& columns) {
      const double n = static_cast<double>(rows), k = static_cast<double>(columns.cols());
      const double left = quick_fit(j.problem, columns) * n * n / std::pow(std::max(1.0, n - 2.0 * k), 2.0);
      if (left < best.second) best = {submodel, left};
    };
    // Both may lean on a loss that is constantly wrong: only what changes with time is to tell them apart.
    Eigen::MatrixXd heat(rows, course.cols() + 2), loss(rows, course.cols() + 2);
    heat.col(course.cols()) = loss.col(course.cols()) = thin_(response(loss_.cwiseProduct(rise)));
    heat.col(course.cols() + 1) = loss.col(course.cols() + 1) = thin_(response(loss_));
    for (Eigen::Index k = 0; k < course.cols(); ++k) {
      heat.col(k) = thin_(response(loss_.cwiseProduct(course.col(k))));
      loss.col(k) = thin_(response(loss_.cwiseProduct(rise).cwiseProduct(course.col(k))));
    }
    attempt("thermal.heating", heat);
    attempt("thermal.loss", loss);
    attempt("thermal.storage", thin_(by_capacity(24)));
    return best;
  }

  /// J/K, W and W of each row: what multiplies dT/dt, what the baseline loses at the measured temperature,
  /// what it is heated by.
  const Eigen::VectorXd& capacity() const { return capacity_; }
  Eigen::VectorXd loss_W() const {
    return capacity_.cwiseProduct(relax_).cwiseProduct(b_.winding_C - b_.ambient_C);
  }
  const Eigen::VectorXd& heat() const { return heat_; }

private:
  // x' = drive - relax x, exactly for a drive that is held over the interval.
  Eigen::VectorXd filtered(const Eigen::VectorXd& drive) const {
    Eigen::VectorXd out(drive.size());
    for (const RunSpan& run : b_.runs) {
      double x = 0.0;
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        out[i] = x;
        const double keep = std::exp(-relax_[i] * b_.step_s[i]);
        x = keep * x + drive[i] * (relax_[i] > 0.0 ? (1.0 - keep) / relax_[i] : b_.step_s[i]);
      }
    }
    return out;
  }

  Eigen::VectorXd lag(const Eigen::VectorXd& input, double tau, bool from_zero) const {
    Eigen::VectorXd out(input.size());
    for (const RunSpan& run : b_.runs) {
      double x = from_zero ? 0.0 : input[run.begin];
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        out[i] = x;
        x += (input[i] - x) * (1.0 - std::exp(-b_.step_s[i] / tau));
      }
    }
    return out;
  }

  // Response to the watts that a heat store of content A(T), in units of the heat capacity, takes: lag(A) -
  // A.
  Eigen::VectorXd stored(const Eigen::VectorXd& content) const {
    Eigen::VectorXd out(content.size());
    for (const RunSpan& run : b_.runs) {
      double x = content[run.begin];
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        out[i] = x - content[i];
        x += (content[i] - x) * (1.0 - std::exp(-relax_[i] * b_.step_s[i]));
      }
    }
    return out;
  }

  Eigen::MatrixXd by_capacity(Eigen::Index bins) const {
    const double from = b_.winding_C.minCoeff(), to = b_.winding_C.maxCoeff();
    const double width = (to - from) / static_cast<double>(bins);
    Eigen::MatrixXd out(b_.winding_C.size(), bins);
    for (Eigen::Index k = 0; k < bins; ++k) {
      const double begin = from + width * static_cast<double>(k);
      const Eigen::VectorXd content = (b_.winding_C.array() - begin).max(0.0).min(width);
      out.col(k) = stored(content);
    }
    return out;
  }

  void simulate() {
    baseline_.resize(heat_.size());
    for (const RunSpan& run : b_.runs) {
      double temperature = b_.winding_C[run.begin];
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        baseline_[i] = temperature;
        const double keep = std::exp(-relax_[i] * b_.step_s[i]);
        const double target = b_.ambient_C[i] + heat_[i] / capacity_[i] / relax_[i];
        temperature = target + (temperature - target) * keep;
      }
    }
  }

  const BenchRows& b_;
  Eigen::VectorXd heat_, capacity_, relax_, loss_, baseline_;
  Thinning thin_;
  double time_constant_s_ = 1.0;
  bool polynomial_ = false;
};

}  // namespace thermopower::gap::detail
