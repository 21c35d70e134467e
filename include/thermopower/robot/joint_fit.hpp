// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/joint_problem.hpp>
#include <thermopower/robot/joint_result.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::robot {

/// @brief Finds the causes of one joint: the regression of effort on motion, with forward selection by cross-validation.
///
/// One family after another is added while it lowers the held-out effort materially and reliably. Then each is taken out once more,
/// and stays out where it is not missed. A friction that would drive the motion is refused, and so is a negative inertia.
///
/// How to: @ref diagnose_a_robot.
class JointFitter {
public:
  /// @param problem  the regression; a ripple's number of cycles is chosen in it
  JointFitter(JointProblem& problem, const FitOptions& options) : problem_(problem), options_(options) {}

  /// @param wanted  families to begin with, whatever they gain
  JointFit fit(const std::vector<Family>& wanted = {}) {
    begin();
    if (problem_.moving_rows() < 20 * options_.blocks) return finish();
    for (const Family family : wanted) add_wanted(family);
    Score now = score(chosen_);
    while (static_cast<int>(chosen_.size()) < options_.most_terms) {
      std::optional<Choice> best;
      double best_cost = std::numeric_limits<double>::infinity();
      search_ripple();
      for (const Choice& candidate : candidates()) {
        std::vector<Choice> with = chosen_;
        with.push_back(candidate);
        if (!is_physical(with)) continue;
        const Score then = score(with);
        if (!is_better(now, then)) continue;
        const double cost = then.rms * (1.0 + options_.price * static_cast<double>(columns_of(with).size()));
        if (cost < best_cost) best_cost = cost, best = candidate;
      }
      if (!best) break;
      chosen_.push_back(*best);
      now = score(chosen_);
      drop_what_is_not_missed(now, static_cast<int>(wanted.size()));
    }
    return finish();
  }

  /// @brief The fit with exactly these families.
  JointFit exactly(const std::vector<Family>& families) {
    begin();
    for (const Family family : families) add_wanted(family);
    return finish();
  }

  /// @brief Logarithm of the held-out effort of each block with exactly these families; empty where they are not physical.
  std::vector<double> block_errors(const std::vector<Family>& families) {
    begin();
    for (const Family family : families) add_wanted(family);
    std::vector<double> out;
    if (!families.empty() && !is_physical(chosen_)) return out;
    for (const double square : score(chosen_).by_block) out.push_back(0.5 * std::log(square));
    return out;
  }

  /// Held-out effort in N m with exactly these families.
  double held_out(const std::vector<Family>& families) {
    begin();
    for (const Family family : families) add_wanted(family);
    return score(chosen_).rms;
  }

  /// What is left, and the armature with which.
  struct Left {
    double effort = 0.0;    ///< held out, in N m
    double armature = 0.0;  ///< added to the model's, in kg m2
    int numbers = 0;        ///< that were fitted
  };
  /// @brief What exactly these families leave.
  Left left_with(const std::vector<Family>& families) {
    begin();
    for (const Family family : families) add_wanted(family);
    return left_now();
  }
  /// @brief What the families of the last fit() leave.
  Left left_now() const {
    Left out;
    out.effort = score(chosen_).rms;
    const std::vector<int> columns = columns_of(chosen_);
    const Eigen::VectorXd value = solve(total_, columns);
    out.numbers = static_cast<int>(columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i] == static_cast<int>(Regressor::acceleration))
        out.armature = value[static_cast<Eigen::Index>(i)];
    return out;
  }

private:
  static constexpr int last = static_cast<int>(Regressor::effort);

  void begin() {
    chosen_.clear();
    total_ = JointProblem::Sums::Zero();
    for (const auto& one : problem_.sums()) total_ += one;
  }

  JointFit finish() const {
    JointFit out;
    out.rows = problem_.moving_rows();
    const double n = static_cast<double>(std::max<Eigen::Index>(1, out.rows));
    double effort = 0.0;
    for (Eigen::Index i = 0; i < problem_.effort().size(); ++i)
      if (problem_.block_of()[static_cast<std::size_t>(i)] >= 0)
        effort += problem_.effort()[i] * problem_.effort()[i];
    out.effort_rms = std::sqrt(effort / n);
    out.before = out.after = std::sqrt(total_(last, last) / n);
    if (chosen_.empty()) return out;
    const Score now = score(chosen_);
    out.after = now.rms;
    describe(out, now);
    return out;
  }

  struct Choice {
    Family family;
    int stribeck = 1;
  };
  struct Score {
    double rms = 0.0;                ///< over all held-out blocks
    std::vector<double> by_block{};  ///< mean square
  };

  static std::vector<int> own_columns(const Choice& choice) {
    const auto i = [](Regressor one) { return static_cast<int>(one); };
    switch (choice.family) {
      case Family::armature:
        return {i(Regressor::acceleration)};
      case Family::damping:
        return {i(Regressor::velocity)};
      case Family::friction:
        return {i(Regressor::sign)};
      case Family::constant:
        return {i(Regressor::one)};
      case Family::spring:
        return {i(Regressor::position), i(Regressor::one)};
      case Family::gravity:
        return {i(Regressor::gravity)};
      case Family::imbalance:
        return {i(Regressor::moment_a), i(Regressor::moment_b)};
      case Family::stribeck:
        return {i(Regressor::stribeck_slow) + choice.stribeck, i(Regressor::sign)};
      case Family::load_friction:
        return {i(Regressor::load)};
      case Family::position_friction:
        return {i(Regressor::sign_position), i(Regressor::sign)};
      case Family::drag:
        return {i(Regressor::drag)};
      case Family::effort_scale:
        return {i(Regressor::model)};
      case Family::ripple:
        return {i(Regressor::ripple_sine), i(Regressor::ripple_cosine)};
    }
    return {};
  }

  static std::vector<int> columns_of(const std::vector<Choice>& set) {
    std::vector<int> all;
    for (const Choice& one : set)
      for (const int column : own_columns(one))
        if (std::find(all.begin(), all.end(), column) == all.end()) all.push_back(column);
    return all;
  }

  // Smallest value that a column's coefficient may have.
  double least(int column) const {
    const Joint& joint = problem_.joint();
    switch (static_cast<Regressor>(column)) {
      case Regressor::acceleration:
        return -joint.armature;
      case Regressor::velocity:
        return -joint.damping;
      case Regressor::sign:
        return -joint.friction;
      case Regressor::load:
      case Regressor::drag:
      case Regressor::stribeck_slow:
      case Regressor::stribeck_medium:
      case Regressor::stribeck_fast:
        return 0.0;
      case Regressor::model:
        return -0.5;
      default:
        return -std::numeric_limits<double>::infinity();
    }
  }

  // Least squares within the bounds; columns at a bound stay there.
  Eigen::VectorXd solve(const JointProblem::Sums& sums, const std::vector<int>& columns) const {
    const auto count = static_cast<Eigen::Index>(columns.size());
    Eigen::VectorXd value = Eigen::VectorXd::Zero(count);
    std::vector<char> bound(columns.size(), 0);
    for (int pass = 0; pass <= static_cast<int>(columns.size()); ++pass) {
      std::vector<Eigen::Index> open;
      for (Eigen::Index i = 0; i < count; ++i)
        if (bound[static_cast<std::size_t>(i)] == 0) open.push_back(i);
      const auto size = static_cast<Eigen::Index>(open.size());
      if (size == 0) return value;
      Eigen::MatrixXd a(size, size);
      Eigen::VectorXd b(size);
      for (Eigen::Index i = 0; i < size; ++i) {
        const int ci = columns[static_cast<std::size_t>(open[static_cast<std::size_t>(i)])];
        b[i] = sums(ci, last);
        for (Eigen::Index k = 0; k < count; ++k)
          if (bound[static_cast<std::size_t>(k)] != 0)
            b[i] -= sums(ci, columns[static_cast<std::size_t>(k)]) * value[k];
        for (Eigen::Index k = 0; k < size; ++k)
          a(i, k) = sums(ci, columns[static_cast<std::size_t>(open[static_cast<std::size_t>(k)])]);
      }
      // Columns of different units: each is scaled by its own size.
      const Eigen::VectorXd scale = a.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
      Eigen::MatrixXd scaled = scale.asDiagonal() * a * scale.asDiagonal();
      scaled.diagonal().array() += 1e-9;
      const Eigen::VectorXd found = scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * b);
      bool is_within = true;
      for (Eigen::Index i = 0; i < size; ++i) {
        const Eigen::Index k = open[static_cast<std::size_t>(i)];
        const double bottom = least(columns[static_cast<std::size_t>(k)]);
        value[k] = found[i];
        if (found[i] < bottom) {
          value[k] = bottom;
          bound[static_cast<std::size_t>(k)] = 1;
          is_within = false;
        }
      }
      if (is_within) return value;
    }
    return value;
  }

  static double squares(const JointProblem::Sums& sums, const std::vector<int>& columns,
                        const Eigen::VectorXd& value) {
    double out = sums(last, last);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double vi = value[static_cast<Eigen::Index>(i)];
      out -= 2.0 * vi * sums(columns[i], last);
      for (std::size_t k = 0; k < columns.size(); ++k)
        out += vi * value[static_cast<Eigen::Index>(k)] * sums(columns[i], columns[k]);
    }
    return std::max(0.0, out);
  }

  Score score(const std::vector<Choice>& set) const {
    const std::vector<int> columns = columns_of(set);
    Score out;
    double sum = 0.0, rows = 0.0;
    for (std::size_t block = 0; block < problem_.sums().size(); ++block) {
      const double n = static_cast<double>(problem_.rows_of()[block]);
      if (n < 4.0) continue;
      const Eigen::VectorXd value = solve(total_ - problem_.sums()[block], columns);
      const double left = squares(problem_.sums()[block], columns, value);
      out.by_block.push_back(left / n + 1e-300);
      sum += left;
      rows += n;
    }
    out.rms = std::sqrt(sum / std::max(1.0, rows));
    return out;
  }

  bool is_better(const Score& now, const Score& then) const {
    if (then.rms > (1.0 - options_.least_gain) * now.rms) return false;
    const auto n = static_cast<double>(now.by_block.size());
    double mean = 0.0, square = 0.0;
    for (std::size_t i = 0; i < now.by_block.size(); ++i) {
      const double gain = 0.5 * std::log(now.by_block[i] / then.by_block[i]);
      mean += gain / n;
      square += gain * gain / n;
    }
    const double error = std::sqrt(std::max(0.0, square - mean * mean) / std::max(1.0, n - 1.0));
    return mean > options_.standard_errors * error;
  }

  // A cause whose own number stands at its bound explains nothing, and numbers that cancel each other are none. Three families
  // are torques of the position alone: one of them is enough.
  bool is_physical(const std::vector<Choice>& set) const {
    int of_position = 0;
    for (const Choice& one : set)
      of_position +=
          one.family == Family::spring || one.family == Family::gravity || one.family == Family::imbalance;
    if (of_position > 1) return false;
    const std::vector<int> columns = columns_of(set);
    if (!is_well_posed(columns)) return false;
    const Eigen::VectorXd value = solve(total_, columns);
    for (const Choice& one : set) {
      const int own = own_columns(one).front();
      const auto at = std::find(columns.begin(), columns.end(), own) - columns.begin();
      const bool may_be_zero =
          one.family == Family::armature || one.family == Family::damping || one.family == Family::friction;
      if (!may_be_zero && !(value[at] > least(own))) return false;
      if (one.family == Family::gravity && std::fabs(value[at]) > options_.most_gravity) return false;
      if (one.family == Family::effort_scale && value[at] > options_.most_effort) return false;
    }
    return true;
  }

  // What is left of each column without the others, as a share of its square.
  bool is_well_posed(const std::vector<int>& columns) const {
    const auto count = static_cast<Eigen::Index>(columns.size());
    Eigen::MatrixXd a(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index k = 0; k < count; ++k)
        a(i, k) = total_(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(k)]);
    const Eigen::VectorXd size = a.diagonal().cwiseSqrt();
    if (!(size.minCoeff() > 0.0)) return false;
    a = size.cwiseInverse().asDiagonal() * a * size.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd inverse = a.inverse();
    return inverse.allFinite() && inverse.diagonal().maxCoeff() < options_.most_inflation &&
           inverse.diagonal().minCoeff() > 0.0;
  }

  bool has(Family family) const {
    return std::any_of(chosen_.begin(), chosen_.end(),
                       [&](const Choice& one) { return one.family == family; });
  }

  std::vector<Choice> candidates() const {
    std::vector<Choice> out;
    for (std::size_t i = 0; i < family_count; ++i) {
      const auto family = static_cast<Family>(i);
      if (has(family)) continue;
      if (family == Family::ripple && problem_.ripple_cycles() == 0) continue;
      if (family != Family::stribeck) {
        out.push_back({family});
        continue;
      }
      for (int rate = 0; rate < 3; ++rate) out.push_back({family, rate});
    }
    return out;
  }

  void add_wanted(Family family) {
    if (has(family)) return;
    if (family == Family::ripple) search_ripple();
    Choice best{family};
    if (family == Family::stribeck) {
      double least_rms = std::numeric_limits<double>::infinity();
      for (int rate = 0; rate < 3; ++rate) {
        std::vector<Choice> with = chosen_;
        with.push_back({family, rate});
        const double rms = score(with).rms;
        if (rms < least_rms) least_rms = rms, best.stribeck = rate;
      }
    }
    chosen_.push_back(best);
  }

  // The number of cycles whose sine and cosine what is left resembles most.
  void search_ripple() {
    if (has(Family::ripple)) return;
    const std::vector<int> columns = columns_of(chosen_);
    const Eigen::VectorXd value = solve(total_, columns);
    const Eigen::MatrixXd& all = problem_.columns();
    // Fewer cycles than four over the travel are no ripple, but a shape that any smooth torque has.
    constexpr double pi = 3.14159265358979323846;
    const int first = std::max(2, static_cast<int>(std::ceil(8.0 * pi / std::max(0.02, problem_.span()))));
    if (first > options_.most_cycles) return;
    const auto count = static_cast<std::size_t>(options_.most_cycles - first + 1);
    std::vector<double> sine(count, 0.0), cosine(count, 0.0);
    const Eigen::Index stride = std::max<Eigen::Index>(1, problem_.moving_rows() / 4000);
    Eigen::Index seen = 0;
    for (Eigen::Index row = 0; row < all.rows(); ++row) {
      if (problem_.block_of()[static_cast<std::size_t>(row)] < 0 || seen++ % stride != 0) continue;
      double left = all(row, last);
      for (std::size_t i = 0; i < columns.size(); ++i)
        left -= value[static_cast<Eigen::Index>(i)] * all(row, columns[i]);
      const double q = all(row, static_cast<int>(Regressor::position)) + problem_.middle();
      // The angles' sine and cosine follow from those before.
      const double cs = std::cos(q), sn = std::sin(q);
      double c = std::cos(first * q), s = std::sin(first * q);
      for (std::size_t k = 0; k < count; ++k) {
        sine[k] += left * s;
        cosine[k] += left * c;
        const double next = c * cs - s * sn;
        s = s * cs + c * sn;
        c = next;
      }
    }
    std::size_t best = 0;
    for (std::size_t k = 1; k < count; ++k)
      if (std::hypot(sine[k], cosine[k]) > std::hypot(sine[best], cosine[best])) best = k;
    const int cycles = first + static_cast<int>(best);
    if (cycles == problem_.ripple_cycles()) return;
    problem_.set_ripple(cycles);
    problem_.add_up();
    total_ = JointProblem::Sums::Zero();
    for (const auto& one : problem_.sums()) total_ += one;
  }

  void drop_what_is_not_missed(Score& now, int kept_first) {
    for (std::size_t i = static_cast<std::size_t>(kept_first); i + 1 < chosen_.size();) {
      std::vector<Choice> without = chosen_;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
      const Score then = score(without);
      if (is_better(then, now)) {
        ++i;
        continue;
      }
      chosen_ = without;
      now = then;
    }
  }

  void describe(JointFit& out, const Score& now) const {
    const std::vector<int> columns = columns_of(chosen_);
    const Eigen::VectorXd value = solve(total_, columns);
    // The jackknife over blocks holds for noise that is correlated in time.
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(value.size()), square = mean;
    double used = 0.0;
    for (const auto& block : problem_.sums()) {
      const Eigen::VectorXd one = solve(total_ - block, columns);
      mean += one;
      square += one.cwiseAbs2();
      used += 1.0;
    }
    mean /= used;
    const Eigen::VectorXd error =
        ((square / used - mean.cwiseAbs2()).cwiseMax(0.0) * (used - 1.0)).cwiseSqrt();
    out.ripple_cycles = has(Family::ripple) ? problem_.ripple_cycles() : 0;
    for (const Choice& one : chosen_) {
      if (one.family == Family::stribeck) out.stribeck = one.stribeck;
      Term term;
      term.family = one.family;
      for (const int column : own_columns(one)) {
        const auto at = std::find(columns.begin(), columns.end(), column) - columns.begin();
        term.numbers.push_back(
            {name_of(column), unit_of(column, problem_.joint().slides), value[at], error[at]});
      }
      std::vector<Choice> without;
      for (const Choice& other : chosen_)
        if (other.family != one.family) without.push_back(other);
      term.kept = now.rms / score(without).rms;
      for (const Choice& other : candidates()) {
        std::vector<Choice> instead = without;
        instead.push_back(other);
        if (is_physical(instead) && score(instead).rms < (1.0 + options_.alike) * now.rms &&
            std::find(term.predicts_alike.begin(), term.predicts_alike.end(), other.family) ==
                term.predicts_alike.end())
          term.predicts_alike.push_back(other.family);
      }
      out.terms.push_back(term);
    }
  }

  JointProblem& problem_;
  FitOptions options_;
  JointProblem::Sums total_ = JointProblem::Sums::Zero();
  std::vector<Choice> chosen_;
};

}  // namespace thermopower::robot
