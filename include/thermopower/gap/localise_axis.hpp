// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise_bench.hpp>

/// @file localise_axis.hpp
/// A moving axis: torques against measured motion, and the angle against the rate.
///
/// Equations are integrated against smooth bumps (the weak form), so that no noisy signal is ever differentiated: the derivative
/// goes to the bump. Bumps of two widths see fast and slow faults.

namespace thermopower::gap::detail {

/// What an axis recorded, without holes, in SI.
struct AxisRows {
  std::vector<RunSpan> runs;
  Eigen::VectorXd t_s, drive_A, rate, angle;  ///< s, A, rad/s, rad
  Eigen::VectorXd raw_rate, raw_angle;        ///< with holes
  Eigen::VectorXd motor_C;                    ///< empty where not recorded
  std::vector<Column> covariates;
  bool has_rate = false, has_angle = false;
  double interval_s = 0.01, rate_noise = 0.0, angle_noise = 0.0;
};

constexpr double rad_per_deg = 3.14159265358979323846 / 180.0;
constexpr Eigen::Index axis_rows_kept = 60000;

/// At most `most` rows: evenly spread stretches of consecutive ones, each a run of its own.
inline Recording stretches(const Recording& recording, Eigen::Index most) {
  if (recording.rows() <= most) return recording;
  constexpr Eigen::Index parts = 40;
  const Eigen::Index length = most / parts;
  Recording out;
  out.name = recording.name;
  out.t_s.resize(length * parts);
  for (const Column& column : recording.columns) out.columns.push_back({column.name, Eigen::VectorXd(length * parts)});
  for (Eigen::Index p = 0; p < parts; ++p) {
    const Eigen::Index begin = p * (recording.rows() - length) / (parts - 1), to = p * length;
    out.t_s.segment(to, length) = recording.t_s.segment(begin, length);
    for (std::size_t c = 0; c < recording.columns.size(); ++c) {
      out.columns[c].values.segment(to, length) = recording.columns[c].values.segment(begin, length);
    }
    for (const RunSpan& run : recording.spans()) {
      const Eigen::Index from = std::max(run.begin, begin), end = std::min(run.end, begin + length);
      if (from < end) out.runs.push_back({from - begin + to, end - begin + to, run.label});
    }
  }
  return out;
}

inline AxisRows axis_rows(const Recording& full) {
  const Recording recording = stretches(full, axis_rows_kept);
  AxisRows a;
  const Eigen::Index n = recording.rows();
  a.runs = recording.spans();
  a.t_s = recording.t_s;
  std::vector<double> steps;
  for (const RunSpan& run : a.runs) {
    for (Eigen::Index i = run.begin; i + 1 < run.end; ++i) steps.push_back(a.t_s[i + 1] - a.t_s[i]);
  }
  if (!steps.empty()) {
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
    a.interval_s = steps[steps.size() / 2];
  }
  a.drive_A = held(recording.find("drive_A"), a.runs, n, 0.0);
  a.has_rate = recording.has("rate_dps");
  a.has_angle = recording.has("angle_deg");
  if (a.has_angle) {
    a.raw_angle = *recording.find("angle_deg") * rad_per_deg;
    a.angle = held(recording.find("angle_deg"), a.runs, n, 0.0) * rad_per_deg;
  } else {
    a.angle = Eigen::VectorXd::Zero(n);
  }
  if (a.has_rate) {
    a.raw_rate = *recording.find("rate_dps") * rad_per_deg;
    a.rate = held(recording.find("rate_dps"), a.runs, n, 0.0) * rad_per_deg;
  } else if (a.has_angle) {  // slopes over four intervals
    a.raw_rate = Eigen::VectorXd::Constant(n, missing);
    for (const RunSpan& run : a.runs) {
      for (Eigen::Index i = run.begin + 2; i + 2 < run.end; ++i) {
        a.raw_rate[i] = (2.0 * (a.raw_angle[i + 2] - a.raw_angle[i - 2]) + (a.raw_angle[i + 1] - a.raw_angle[i - 1])) /
                        (2.0 * (a.t_s[i + 2] - a.t_s[i - 2]) + (a.t_s[i + 1] - a.t_s[i - 1]));
      }
    }
    a.rate = held(&a.raw_rate, a.runs, n, 0.0);
  }
  a.rate_noise = a.has_rate ? noise_of(a.raw_rate, a.runs) : noise_of(a.raw_angle, a.runs) / (3.2 * a.interval_s);
  if (a.has_angle) a.angle_noise = noise_of(a.raw_angle, a.runs);
  if (recording.has("motor_C")) a.motor_C = held(recording.find("motor_C"), a.runs, n, 25.0);
  for (const Column& column : recording.columns) {
    if (column.name == "drive_A" || column.name == "rate_dps" || column.name == "angle_deg" || column.name == "motor_C") continue;
    if (!recording.has(column.name)) continue;
    Column copy{column.name, held(&column.values, a.runs, n, 0.0)};
    if (copy.values.maxCoeff() > copy.values.minCoeff()) a.covariates.push_back(std::move(copy));
  }
  return a;
}

/// Bumps (1 - s^2)^4 of unit area over the rows, and integrals against them.
class Bumps {
public:
  struct One {
    Eigen::Index begin, end;  ///< rows [begin, end) inside its support
    double middle, half;      ///< s
    std::size_t weights;      ///< where its weights begin
  };

  Bumps(const AxisRows& rows, const Eigen::VectorXd& needed, int half_rows, Eigen::Index most) : a_(rows) {
    const double half = half_rows * a_.interval_s;
    Eigen::Index count = 0;
    for (const RunSpan& run : a_.runs) count += run.size() / std::max(1, half_rows);
    const Eigen::Index keep = std::max<Eigen::Index>(1, (count + most - 1) / most);
    Eigen::Index number = 0;
    for (const RunSpan& run : a_.runs) {
      for (Eigen::Index i = run.begin + half_rows + 1; i + half_rows + 1 < run.end; i += half_rows) {
        if (number++ % keep != 0) continue;
        if (a_.t_s[i + half_rows] - a_.t_s[i - half_rows] > 2.5 * half) continue;  // a hole in the stamps
        One one{i - half_rows, i + half_rows + 1, a_.t_s[i], half, bump_.size()};
        bool whole = true;
        for (Eigen::Index k = one.begin; k < one.end; ++k) whole = whole && std::isfinite(needed[k]);
        if (!whole) continue;
        list_.push_back(one);
        for (Eigen::Index k = one.begin; k < one.end; ++k) {
          const double from = k == one.begin ? a_.t_s[k] : a_.t_s[k - 1], to = k + 1 == one.end ? a_.t_s[k] : a_.t_s[k + 1];
          bump_.push_back(0.5 * (area(one, to) - area(one, from)));
          slope_.push_back(mean_before(one, k) - mean_before(one, k + 1));
        }
      }
    }
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(list_.size()); }
  const std::vector<One>& list() const { return list_; }

  /// Integral of the bump times values that are straight between their samples, each interval at its mean.
  Eigen::VectorXd integral(const Eigen::VectorXd& values) const {
    return sum(bump_, values);
  }

  /// Integral of the bump times the derivative of sampled values.
  Eigen::VectorXd derivative(const Eigen::VectorXd& values) const {
    return sum(slope_, values);
  }

  /// Integral of the bump times values that are held over the interval that starts at their row, `delay_s` later.
  Eigen::VectorXd held_integral(const Eigen::VectorXd& values, double delay_s = 0.0) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
    for (Eigen::Index r = 0; r < size(); ++r) {
      const One& one = list_[static_cast<std::size_t>(r)];
      const RunSpan& run = run_of(one.begin);
      for (Eigen::Index k = one.end - 1; k >= run.begin; --k) {
        const double from = a_.t_s[k] + delay_s, to = (k + 1 < run.end ? a_.t_s[k + 1] : a_.t_s[k] + a_.interval_s) + delay_s;
        if (to <= one.middle - one.half) break;
        out[r] += values[k] * (area(one, to) - area(one, from));
      }
    }
    return out;
  }

  /// Standard deviation of derivative() per unit of white noise on the samples.
  double derivative_gain() const {
    double sum = 0.0;
    if (list_.empty()) return 1.0;
    const One& one = list_[list_.size() / 2];
    for (Eigen::Index k = 0; k < one.end - one.begin; ++k) sum += std::pow(slope_[one.weights + static_cast<std::size_t>(k)], 2.0);
    return std::sqrt(sum);
  }

private:
  // Mean of the bump over the interval that ends at a row. Differences of such means integrate the bump times the derivative of a
  // signal that is straight between its samples without error: as a rate is while the torque is held.
  double mean_before(const One& one, Eigen::Index k) const {
    if (k == one.begin || k == one.end) return 0.0;
    return (area(one, a_.t_s[k]) - area(one, a_.t_s[k - 1])) / (a_.t_s[k] - a_.t_s[k - 1]);
  }
  double area(const One& one, double t) const {  // integral of the bump up to t
    const double s = std::min(1.0, std::max(-1.0, (t - one.middle) / one.half)), q = s * s;
    return 0.5 + 315.0 / 256.0 * s * (1.0 + q * (-4.0 / 3.0 + q * (6.0 / 5.0 + q * (-4.0 / 7.0 + q / 9.0))));
  }
  const RunSpan& run_of(Eigen::Index row) const {
    for (const RunSpan& run : a_.runs) {
      if (row >= run.begin && row < run.end) return run;
    }
    return a_.runs.front();
  }
  Eigen::VectorXd sum(const std::vector<double>& weights, const Eigen::VectorXd& values) const {
    Eigen::VectorXd out(size());
    for (Eigen::Index r = 0; r < size(); ++r) {
      const One& one = list_[static_cast<std::size_t>(r)];
      out[r] = values.segment(one.begin, one.end - one.begin)
                   .dot(Eigen::Map<const Eigen::VectorXd>(weights.data() + one.weights, one.end - one.begin));
    }
    return out;
  }

  const AxisRows& a_;
  std::vector<One> list_;
  std::vector<double> bump_, slope_;  ///< weights of values and of derivatives, bump after bump
};

/// A torque that no block of few directions describes.
struct UnnamedTorque {
  std::string submodel, variable, words;
  double left = std::numeric_limits<double>::infinity();  ///< sum of squares, as if it had no more directions than a block
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
      j.problem.fold[i] = static_cast<int>(middle[static_cast<std::size_t>(i)] * j.problem.folds / static_cast<double>(std::max<Eigen::Index>(1, n)));
    }
    const double sigma = std::max(a_.rate_noise, 1e-9) * m_.inertia_kgm2;
    const double narrow_weight = 1.0 / (sigma * narrow_.derivative_gain()), wide_weight = 1.0 / (sigma * wide_.derivative_gain());
    const auto both = [&](const Eigen::VectorXd& narrow, const Eigen::VectorXd& wide) {
      Eigen::VectorXd out(rows);
      out << narrow * narrow_weight, wide * wide_weight;
      return out;
    };
    const auto sampled = [&](const Eigen::VectorXd& values) { return both(narrow_.integral(values), wide_.integral(values)); };
    const auto driven = [&](const Eigen::VectorXd& values, double delay) {
      return both(narrow_.held_integral(values, delay), wide_.held_integral(values, delay));
    };
    const Eigen::VectorXd acceleration = both(narrow_.derivative(rate), wide_.derivative(rate));
    const Eigen::VectorXd drag = sampled(rate), drive = driven(a_.drive_A, 0.0);
    j.problem.y = m_.inertia_kgm2 * acceleration + m_.viscous_Nms_per_rad * drag - m_.torque_constant_Nm_per_A * drive;
    j.problem.nuisance.resize(rows, 3);
    j.problem.nuisance.col(0) = -m_.inertia_kgm2 * acceleration;
    j.problem.nuisance.col(1) = -m_.viscous_Nms_per_rad * drag;
    j.problem.nuisance.col(2) = m_.torque_constant_Nm_per_A * drive;
    j.problem.free.resize(rows, 0);
    j.floor = static_cast<double>(rows);

    const double unbounded = std::numeric_limits<double>::infinity();
    const auto add = [&](const char* submodel, const std::string& variable, const std::string& words, const std::vector<Eigen::VectorXd>& list,
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
    const Eigen::VectorXd direction = rate.array().unaryExpr([&](double w) { return std::tanh(w / std::max(2.0 * a_.rate_noise, 1e-9)); });
    const Eigen::VectorXd speed = rate.cwiseAbs();
    add("mechanical.friction", "rate_dps", "a friction that takes an angle to turn round", split(-turning(rate)), 0.0);
    add("mechanical.friction", "rate_dps", "a friction of the same size at every rate", {sampled(direction)});
    // At rest, dry friction takes whatever the drive gives.
    const Eigen::VectorXd moving = rate.array().abs().unaryExpr([&](double w) { return w > 4.0 * a_.rate_noise ? 1.0 : 0.0; });
    const Eigen::VectorXd stuck = driven(a_.drive_A.cwiseProduct((1.0 - moving.array()).matrix()), 0.0);
    add("mechanical.friction", "rate_dps", "a friction that holds the axis at rest", {sampled(direction.cwiseProduct(moving)), stuck});
    add("mechanical.friction", "rate_dps", "another viscous friction", {drag});
    add("mechanical.friction", "rate_dps", "a friction that depends on the rate", split(scaled(hats(speed, 5), direction)));
    add("mechanical.friction", "rate_dps", "a friction that differs with the direction", {sampled(direction), sampled(Eigen::VectorXd::Ones(n))});
    add("mechanical.friction", "rate_dps", "a friction that depends on rate and direction", split(hats(rate, 9)));
    add("mechanical.friction", "drive_A", "a friction that grows with the torque", {driven(direction.cwiseProduct(a_.drive_A.cwiseAbs()), 0.0)});
    add("mechanical.drive", "drive_A", "another torque constant", {drive});
    const Eigen::VectorXd size = a_.drive_A.cwiseAbs();
    add("mechanical.drive", "drive_A", "a torque that is not in proportion to the command",
        split_driven(scaled(hats(size, 6), a_.drive_A)));
    std::vector<Eigen::VectorXd> late;
    const double unit_s = std::max(a_.interval_s, 0.004);
    for (const double k : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0}) {
      late.push_back(m_.torque_constant_Nm_per_A * (driven(a_.drive_A, k * unit_s) - drive) * (m_.torque_constant_Nm_per_A > 0.0 ? 1.0 : -1.0));
    }
    add("mechanical.drive", "drive_A_per_s", "a torque that comes after the command", late, 0.0);
    if (a_.motor_C.size() > 0) {
      add("mechanical.drive", "motor_C", "a torque constant that changes with the temperature",
          {drive, driven(a_.drive_A.cwiseProduct((a_.motor_C.array() - a_.motor_C.mean()).matrix()), 0.0)});
    }
    if (a_.has_angle) {
      const Eigen::VectorXd sine = a_.angle.array().sin(), cosine = a_.angle.array().cos();
      const Eigen::VectorXd one = Eigen::VectorXd::Ones(n);
      add("mechanical.load", "angle_deg", "a torque with the sine of the angle", {sampled(sine), sampled(cosine)});
      add("mechanical.load", "angle_deg", "a torque in proportion to the angle", {sampled(a_.angle), sampled(one)});
      add("mechanical.load", "angle_deg", "a torque that depends on the angle", split(even_hats(a_.angle, 9)));
      add_periodic(j, both);
    }
    add("mechanical.load", "t_s", "a constant torque", {sampled(Eigen::VectorXd::Ones(n))});
    add("mechanical.structure", "acceleration_rad_per_s2", "another inertia", {-acceleration});
    add_resonance(j, rate, both);
    for (const Column& column : a_.covariates) {
      const double scale = std::max(column.values.cwiseAbs().maxCoeff(), 1e-12);
      const Eigen::VectorXd z = column.values / scale;
      add("mechanical.drive", column.name, "a torque constant that changes with " + column.name, {drive, driven(a_.drive_A.cwiseProduct(z), 0.0)}, -unbounded, 1);
      add("mechanical.friction", column.name, "a friction that changes with " + column.name, {sampled(rate.cwiseProduct(z)), sampled(direction.cwiseProduct(z))}, -unbounded, 1);
      add("mechanical.load", column.name, "a torque that comes with " + column.name, {sampled(z), sampled(Eigen::VectorXd::Ones(n))}, -unbounded, 1);
    }
    return j;
  }

  /// Whom to accuse when no block helps: friction or load that change with time or position in a way of their own.
  UnnamedTorque unnamed(const Judged& j) const {
    const double sigma = std::max(a_.rate_noise, 1e-9) * m_.inertia_kgm2;
    const double narrow_weight = 1.0 / (sigma * narrow_.derivative_gain()), wide_weight = 1.0 / (sigma * wide_.derivative_gain());
    const Eigen::Index rows = j.problem.y.size();
    UnnamedTorque best;
    const auto attempt = [&](const char* submodel, const char* variable, const char* words, const Eigen::MatrixXd& samples) {
      Eigen::MatrixXd columns(rows, samples.cols());
      for (Eigen::Index k = 0; k < samples.cols(); ++k) {
        columns.col(k) << narrow_.integral(samples.col(k)) * narrow_weight, wide_.integral(samples.col(k)) * wide_weight;
      }
      const double n = static_cast<double>(rows), spent = static_cast<double>(samples.cols());
      const double left = quick_fit(j.problem, columns) * n * n / std::pow(std::max(1.0, n - 4.0 * spent), 2.0);
      if (left < best.left) best = {submodel, variable, words, left};
    };
    const Eigen::VectorXd direction = a_.rate.array().unaryExpr([&](double w) { return std::tanh(w / std::max(2.0 * a_.rate_noise, 1e-9)); });
    const Eigen::VectorXd order = Eigen::VectorXd::LinSpaced(a_.rate.size(), 0.0, 1.0);
    Eigen::MatrixXd friction(a_.rate.size(), 24);
    friction << scaled(even_hats(order, 12), direction), scaled(even_hats(order, 12), a_.rate);
    attempt("mechanical.friction", "t_s", "a friction that changes in the course of time", friction);
    attempt("mechanical.load", "t_s", "a torque of its own course in time", even_hats(order, 48));
    if (a_.has_angle) {
      attempt("mechanical.friction", "angle_deg", "a friction that depends on the angle", scaled(even_hats(a_.angle, 24), direction));
      attempt("mechanical.load", "angle_deg", "a torque of its own course over the angle", even_hats(a_.angle, 48));
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
      const Eigen::VectorXd sine = (count * a_.angle.array()).sin(), cosine = (count * a_.angle.array()).cos();
      Eigen::MatrixXd columns(j.problem.y.size(), 2);
      columns.col(0) = both(narrow_.integral(sine), wide_.integral(sine));
      columns.col(1) = both(narrow_.integral(cosine), wide_.integral(cosine));
      const double left = quick_fit(j.problem, columns);
      if (left < least) {
        least = left;
        best = {"mechanical.load", "angle_deg", "a torque that repeats " + std::to_string(count) + " times a turn", columns};
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
  for (Eigen::Index i = 0; i < rows; ++i) j.problem.fold[i] = static_cast<int>(i * j.problem.folds / std::max<Eigen::Index>(1, rows));
  j.floor = static_cast<double>(rows);
  j.blocks.push_back({"sensing.bias", "t_s", "the rate's integral and the angle part at a constant pace", weight * Eigen::VectorXd::Ones(rows)});
  j.blocks.push_back({"sensing.angle", "rate_dps", "the angle moves by another factor than the rate says", weight * rate});
  Eigen::MatrixXd wave(rows, 2);
  wave.col(0) = weight * bumps.integral(a.rate.cwiseProduct(Eigen::VectorXd(a.angle.array().sin())));
  wave.col(1) = weight * bumps.integral(a.rate.cwiseProduct(Eigen::VectorXd(a.angle.array().cos())));
  j.blocks.push_back({"sensing.angle", "angle_deg", "the angle's error repeats every turn", wave});
  return j;
}

}  // namespace thermopower::gap::detail
