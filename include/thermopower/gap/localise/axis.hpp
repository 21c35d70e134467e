// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise/test_functions.hpp>
#include <thermopower/gap/localise/least_squares.hpp>
#include <thermopower/gap/model.hpp>

#include <cstdio>

/// @file axis.hpp
/// A moving axis: torques against measured motion, and the angle against the rate. Bumps of two widths see
/// fast and slow faults.

namespace thermopower::gap::detail {

/// A torque that no block of few directions describes.
struct UnnamedTorque {
  std::string submodel, variable, words;
  double left = std::numeric_limits<
      double>::infinity();  ///< sum of squares, as if it had no more directions than a block
};

/// The torques, given the measured motion.
class AxisJudge {
public:
  AxisJudge(const RigidAxisModel& axis, const AxisRows& rows)
      : m_(axis), a_(rows), narrow_(rows, rows.raw_rate, 4, 5000), wide_(rows, rows.raw_rate, 24, 1500) {}

  /// @param rate_error rad/s that the gyro reads too much
  Judged judge(double slack, double rate_error = 0.0) const {
    Judged j;
    j.problem.slack = slack;
    const Eigen::VectorXd rate = a_.rate.array() - rate_error;
    const Eigen::Index n = rate.size();
    std::vector<double> middle;
    for (const auto* bumps : {&narrow_, &wide_}) {
      for (const auto& one : bumps->list()) middle.push_back(static_cast<double>(one.begin));
    }
    const Eigen::Index rows = static_cast<Eigen::Index>(middle.size());
    j.problem.fold.resize(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      j.problem.fold[i] = static_cast<int>(middle[static_cast<std::size_t>(i)] * j.problem.folds /
                                           static_cast<double>(std::max<Eigen::Index>(1, n)));
    }
    const double sigma = std::max(a_.rate_noise, 1e-9) * m_.inertia_kgm2;
    const double narrow_weight = 1.0 / (sigma * narrow_.derivative_gain()),
                 wide_weight = 1.0 / (sigma * wide_.derivative_gain());
    const auto both = [&](const Eigen::VectorXd& narrow, const Eigen::VectorXd& wide) {
      Eigen::VectorXd out(rows);
      out << narrow * narrow_weight, wide * wide_weight;
      return out;
    };
    const auto sampled = [&](const Eigen::VectorXd& values) {
      return both(narrow_.integral(values), wide_.integral(values));
    };
    const auto driven = [&](const Eigen::VectorXd& values, double delay) {
      return both(narrow_.held_integral(values, delay), wide_.held_integral(values, delay));
    };
    const Eigen::VectorXd acceleration = both(narrow_.derivative(rate), wide_.derivative(rate));
    const Eigen::VectorXd drag = sampled(rate), drive = driven(a_.drive_A, 0.0);
    j.problem.y =
        m_.inertia_kgm2 * acceleration + m_.viscous_Nms_per_rad * drag - m_.torque_constant_Nm_per_A * drive;
    j.problem.nuisance.resize(rows, 3);
    j.problem.nuisance.col(0) = -m_.inertia_kgm2 * acceleration;
    j.problem.nuisance.col(1) = -m_.viscous_Nms_per_rad * drag;
    j.problem.nuisance.col(2) = m_.torque_constant_Nm_per_A * drive;
    j.problem.free.resize(rows, 0);
    j.floor = static_cast<double>(rows);

    const double unbounded = std::numeric_limits<double>::infinity();
    const auto add = [&](const char* submodel, const std::string& variable, const std::string& words,
                         const std::vector<Eigen::VectorXd>& list,
                         double lower = -std::numeric_limits<double>::infinity(), int penalty = 0) {
      Eigen::MatrixXd columns(rows, static_cast<Eigen::Index>(list.size()));
      for (std::size_t k = 0; k < list.size(); ++k) columns.col(static_cast<Eigen::Index>(k)) = list[k];
      j.blocks.push_back({submodel, variable, words, columns, lower, unbounded, penalty});
    };
    const auto split = [&](const Eigen::MatrixXd& columns) {
      std::vector<Eigen::VectorXd> list;
      for (Eigen::Index k = 0; k < columns.cols(); ++k) list.push_back(sampled(columns.col(k)));
      return list;
    };
    const auto split_driven = [&](const Eigen::MatrixXd& columns) {
      std::vector<Eigen::VectorXd> list;
      for (Eigen::Index k = 0; k < columns.cols(); ++k) list.push_back(driven(columns.col(k), 0.0));
      return list;
    };
    const Eigen::VectorXd direction =
        rate.array().unaryExpr([&](double w) { return std::tanh(w / std::max(2.0 * a_.rate_noise, 1e-9)); });
    const Eigen::VectorXd speed = rate.cwiseAbs();
    add("mechanical.friction", "rate_dps", "a friction that takes an angle to turn round",
        split(-turning(rate)), 0.0);
    add("mechanical.friction", "rate_dps", "a friction of the same size at every rate", {sampled(direction)});
    // At rest, dry friction takes whatever the drive gives.
    const Eigen::VectorXd moving =
        rate.array().abs().unaryExpr([&](double w) { return w > 4.0 * a_.rate_noise ? 1.0 : 0.0; });
    const Eigen::VectorXd stuck = driven(a_.drive_A.cwiseProduct((1.0 - moving.array()).matrix()), 0.0);
    add("mechanical.friction", "rate_dps", "a friction that holds the axis at rest",
        {sampled(direction.cwiseProduct(moving)), stuck});
    add("mechanical.friction", "rate_dps", "another viscous friction", {drag});
    add("mechanical.friction", "rate_dps", "a friction that depends on the rate",
        split(scaled(hats(speed, 5), direction)));
    add("mechanical.friction", "rate_dps", "a friction that differs with the direction",
        {sampled(direction), sampled(Eigen::VectorXd::Ones(n))});
    add("mechanical.friction", "rate_dps", "a friction that depends on rate and direction",
        split(hats(rate, 9)));
    add("mechanical.friction", "drive_A", "a friction that grows with the torque",
        {driven(direction.cwiseProduct(a_.drive_A.cwiseAbs()), 0.0)});
    add("mechanical.drive", "drive_A", "another torque constant", {drive});
    const Eigen::VectorXd size = a_.drive_A.cwiseAbs();
    add("mechanical.drive", "drive_A", "a torque that is not in proportion to the command",
        split_driven(scaled(hats(size, 6), a_.drive_A)));
    std::vector<Eigen::VectorXd> late;
    const double unit_s = std::max(a_.interval_s, 0.004);
    for (const double k : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0}) {
      late.push_back(m_.torque_constant_Nm_per_A * (driven(a_.drive_A, k * unit_s) - drive) *
                     (m_.torque_constant_Nm_per_A > 0.0 ? 1.0 : -1.0));
    }
    add("mechanical.drive", "drive_A_per_s", "a torque that comes after the command", late, 0.0);
    if (a_.motor_C.size() > 0) {
      add("mechanical.drive", "motor_C", "a torque constant that changes with the temperature",
          {drive, driven(a_.drive_A.cwiseProduct((a_.motor_C.array() - a_.motor_C.mean()).matrix()), 0.0)});
    }
    if (a_.has_angle) {
      const Eigen::VectorXd sine = a_.angle.array().sin(), cosine = a_.angle.array().cos();
      const Eigen::VectorXd one = Eigen::VectorXd::Ones(n);
      add("mechanical.load", "angle_deg", "a torque with the sine of the angle",
          {sampled(sine), sampled(cosine)});
      add("mechanical.load", "angle_deg", "a torque in proportion to the angle",
          {sampled(a_.angle), sampled(one)});
      add("mechanical.load", "angle_deg", "a torque that depends on the angle",
          split(even_hats(a_.angle, 9)));
      add_periodic(j, both);
    }
    add("mechanical.load", "t_s", "a constant torque", {sampled(Eigen::VectorXd::Ones(n))});
    add("mechanical.structure", "acceleration_rad_per_s2", "another inertia", {-acceleration});
    add_resonance(j, rate, both);
    for (const Column& column : a_.covariates) {
      const double scale = std::max(column.values.cwiseAbs().maxCoeff(), 1e-12);
      const Eigen::VectorXd z = column.values / scale;
      add("mechanical.drive", column.name, "a torque constant that changes with " + column.name,
          {drive, driven(a_.drive_A.cwiseProduct(z), 0.0)}, -unbounded, 1);
      add("mechanical.friction", column.name, "a friction that changes with " + column.name,
          {sampled(rate.cwiseProduct(z)), sampled(direction.cwiseProduct(z))}, -unbounded, 1);
      add("mechanical.load", column.name, "a torque that comes with " + column.name,
          {sampled(z), sampled(Eigen::VectorXd::Ones(n))}, -unbounded, 1);
    }
    return j;
  }

  /// Whom to accuse when no block helps: friction or load that change with time or position in a way of their
  /// own.
  UnnamedTorque unnamed(const Judged& j) const {
    const double sigma = std::max(a_.rate_noise, 1e-9) * m_.inertia_kgm2;
    const double narrow_weight = 1.0 / (sigma * narrow_.derivative_gain()),
                 wide_weight = 1.0 / (sigma * wide_.derivative_gain());
    const Eigen::Index rows = j.problem.y.size();
    UnnamedTorque best;
    const auto attempt = [&](const char* submodel, const char* variable, const char* words,
                             const Eigen::MatrixXd& samples) {
      Eigen::MatrixXd columns(rows, samples.cols());
      for (Eigen::Index k = 0; k < samples.cols(); ++k) {
        columns.col(k) << narrow_.integral(samples.col(k)) * narrow_weight,
            wide_.integral(samples.col(k)) * wide_weight;
      }
      const double n = static_cast<double>(rows), spent = static_cast<double>(samples.cols());
      const double left =
          quick_fit(j.problem, columns) * n * n / std::pow(std::max(1.0, n - 4.0 * spent), 2.0);
      if (left < best.left) best = {submodel, variable, words, left};
    };
    const Eigen::VectorXd direction = a_.rate.array().unaryExpr(
        [&](double w) { return std::tanh(w / std::max(2.0 * a_.rate_noise, 1e-9)); });
    const Eigen::VectorXd order = Eigen::VectorXd::LinSpaced(a_.rate.size(), 0.0, 1.0);
    Eigen::MatrixXd friction(a_.rate.size(), 24);
    friction << scaled(even_hats(order, 12), direction), scaled(even_hats(order, 12), a_.rate);
    attempt("mechanical.friction", "t_s", "a friction that changes in the course of time", friction);
    attempt("mechanical.load", "t_s", "a torque of its own course in time", even_hats(order, 48));
    if (a_.has_angle) {
      attempt("mechanical.friction", "angle_deg", "a friction that depends on the angle",
              scaled(even_hats(a_.angle, 24), direction));
      attempt("mechanical.load", "angle_deg", "a torque of its own course over the angle",
              even_hats(a_.angle, 48));
    }
    return best;
  }

private:
  // Dry friction that builds up over an angle after each reversal (Dahl's state), for several angles.
  Eigen::MatrixXd turning(const Eigen::VectorXd& rate) const {
    const double reach = std::max(a_.has_angle ? a_.angle.maxCoeff() - a_.angle.minCoeff() : 1.0, 1e-3);
    Eigen::MatrixXd out(rate.size(), 4);
    for (Eigen::Index k = 0; k < out.cols(); ++k) {
      const double width = std::min(0.5, reach) * std::pow(0.3, static_cast<double>(k) + 1.0);
      for (const RunSpan& run : a_.runs) {
        double z = 0.0;
        for (Eigen::Index i = run.begin; i < run.end; ++i) {
          out(i, k) = z;
          if (i + 1 == run.end) break;
          const double moved = 0.5 * (rate[i] + rate[i + 1]) * (a_.t_s[i + 1] - a_.t_s[i]);
          const double goal = moved > 0.0 ? 1.0 : -1.0;
          z = goal + (z - goal) * std::exp(-std::fabs(moved) / width);
        }
      }
    }
    return out;
  }

  // A torque that repeats n times a turn: the best n of a scan.
  template <class Both>
  void add_periodic(Judged& j, const Both& both) const {
    Block best;
    double least = std::numeric_limits<double>::infinity();
    const double travel = a_.angle.maxCoeff() - a_.angle.minCoeff();
    for (int count = 2; count <= 64; ++count) {
      if (travel * count < 3.0 || count * a_.interval_s * a_.rate.cwiseAbs().mean() > 1.5) continue;
      const Eigen::VectorXd sine = (count * a_.angle.array()).sin(),
                            cosine = (count * a_.angle.array()).cos();
      Eigen::MatrixXd columns(j.problem.y.size(), 2);
      columns.col(0) = both(narrow_.integral(sine), wide_.integral(sine));
      columns.col(1) = both(narrow_.integral(cosine), wide_.integral(cosine));
      const double left = quick_fit(j.problem, columns);
      if (left < least) {
        least = left;
        best = {"mechanical.load", "angle_deg",
                "a torque that repeats " + std::to_string(count) + " times a turn", columns};
      }
    }
    if (std::isfinite(least)) {
      best.penalty = 2;
      j.blocks.push_back(std::move(best));
    }
  }

  // A second inertia that follows the measured motion through a spring: the best of a scan of its frequency.
  template <class Both>
  void add_resonance(Judged& j, const Eigen::VectorXd& rate, const Both& both) const {
    Block best;
    double least = std::numeric_limits<double>::infinity(), at = 0.0;
    const auto attempt = [&](double hertz, double damping) {
      const double w = 2.0 * 3.14159265358979323846 * hertz;
      Eigen::VectorXd relative(rate.size()), twist(rate.size());
      for (const RunSpan& run : a_.runs) {
        double q = 0.0, v = 0.0;  // twist of the spring, and its rate: q'' = rate' - w^2 q - 2 z w q'
        for (Eigen::Index i = run.begin; i < run.end; ++i) {
          relative[i] = v;
          twist[i] = q;
          if (i + 1 == run.end) break;
          const double step = a_.t_s[i + 1] - a_.t_s[i], pull = (rate[i + 1] - rate[i]) / step;
          const int parts = std::max(1, static_cast<int>(std::ceil(w * step / 0.15)));
          for (int p = 0; p < parts; ++p) {
            const double h = step / parts;
            const double k1 = pull - w * w * q - 2.0 * damping * w * v;
            const double q2 = q + 0.5 * h * v, v2 = v + 0.5 * h * k1;
            const double k2 = pull - w * w * q2 - 2.0 * damping * w * v2;
            q += h * v2;
            v += h * k2;
          }
        }
      }
      Eigen::MatrixXd columns(j.problem.y.size(), 2);
      columns.col(0) = both(narrow_.derivative(relative), wide_.derivative(relative));
      columns.col(1) = w * w * both(narrow_.integral(twist), wide_.integral(twist));
      const double left = quick_fit(j.problem, columns);
      if (left < least) {
        least = left;
        at = hertz;
        best = {"mechanical.structure", "acceleration_rad_per_s2", "", columns};
      }
    };
    const double highest = std::min(40.0, 0.3 / a_.interval_s);
    for (double hertz = 1.5; hertz <= highest; hertz *= 1.12) attempt(hertz, 0.05);
    const double coarse = at;
    for (double factor = 0.93; factor < 1.08; factor += 0.02) attempt(coarse * factor, 0.03);
    if (!std::isfinite(least)) return;
    char words[80];
    std::snprintf(words, sizeof words, "an inertia behind a spring, %.1f Hz", at);
    best.words = words;
    best.penalty = 2;
    j.blocks.push_back(std::move(best));
  }

  RigidAxisModel m_;
  const AxisRows& a_;
  Bumps narrow_, wide_;
};

/// The angle against the rate: two instruments that must agree.
inline Judged judge_instruments(const AxisRows& a) {
  Judged j;
  Eigen::VectorXd needed = a.raw_rate + a.raw_angle;
  const Bumps bumps(a, needed, 16, 4000);
  const Eigen::Index rows = bumps.size();
  const Eigen::VectorXd rate = bumps.integral(a.rate);
  double gain = bumps.derivative_gain() * std::max(a.angle_noise, 1e-9);
  gain = std::sqrt(gain * gain + std::pow(a.rate_noise, 2.0) / 12.0);
  const double weight = 1.0 / gain;
  j.problem.y = weight * (bumps.derivative(a.angle) - rate);
  j.problem.slack = 0.0;
  j.problem.nuisance.resize(rows, 0);
  j.problem.free.resize(rows, 0);
  j.problem.fold.resize(rows);
  for (Eigen::Index i = 0; i < rows; ++i)
    j.problem.fold[i] = static_cast<int>(i * j.problem.folds / std::max<Eigen::Index>(1, rows));
  j.floor = static_cast<double>(rows);
  j.blocks.push_back({"sensing.bias", "t_s", "the rate's integral and the angle part at a constant pace",
                      weight * Eigen::VectorXd::Ones(rows)});
  j.blocks.push_back(
      {"sensing.angle", "rate_dps", "the angle moves by another factor than the rate says", weight * rate});
  Eigen::MatrixXd wave(rows, 2);
  wave.col(0) = weight * bumps.integral(a.rate.cwiseProduct(Eigen::VectorXd(a.angle.array().sin())));
  wave.col(1) = weight * bumps.integral(a.rate.cwiseProduct(Eigen::VectorXd(a.angle.array().cos())));
  j.blocks.push_back({"sensing.angle", "angle_deg", "the angle's error repeats every turn", wave});
  return j;
}

}  // namespace thermopower::gap::detail
