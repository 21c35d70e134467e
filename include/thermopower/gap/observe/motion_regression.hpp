// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/normal_equations.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/plant/rows.hpp>
#include <thermopower/plant/sine_cosine.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

/// @file motion_regression.hpp
/// How the motion follows a command, before any model: the acceleration between rows, regressed on terms of the command
/// and on what else turns most axes.

namespace thermopower::gap::engine {

/// How an axis moves at a row, as it was measured: the acceleration from its rate over the interval after the row, or without
/// a rate from its angle over the intervals before and after.
struct MeasuredMotion {
  double acceleration_dps2;  ///< deg/s^2
  double rate_dps;           ///< mean over the same, deg/s
  double angle_rad = 0.0;    ///< the same, rad; 0 where no angle is judged

  /// @param row  neither the first nor the last of its run
  MeasuredMotion(const Inputs& inputs, Eigen::Index row) {
    const Eigen::VectorXd &dps = inputs.of(Signal::rate_dps), &deg = inputs.of(Signal::angle_deg);
    const double step_s = inputs.t_s[row + 1] - inputs.t_s[row];
    if (inputs.judged(Signal::rate_dps)) {
      acceleration_dps2 = (dps[row + 1] - dps[row]) / step_s;
      rate_dps = 0.5 * (dps[row] + dps[row + 1]);
      if (inputs.judged(Signal::angle_deg)) angle_rad = 0.5 * (deg[row] + deg[row + 1]) * rad_per_deg;
      return;
    }
    const double before_s = inputs.t_s[row] - inputs.t_s[row - 1],
                 before = (deg[row] - deg[row - 1]) / before_s, after = (deg[row + 1] - deg[row]) / step_s;
    acceleration_dps2 = 2.0 * (after - before) / (step_s + before_s);
    rate_dps = 0.5 * (after + before);
    angle_rad = deg[row] * rad_per_deg;
  }
};

/// The torque that a drive may give beside one in proportion to its command: less of a small one, as a dead band does, less of a large
/// one, as saturation does, and less of one that its gears rub. In a loop the command falls as it is followed, and what a small one gives
/// less of passes for a part of the next one without these.
class BentCommand {
public:
  /// @param commands  that there are, in one unit
  explicit BentCommand(const std::vector<const Eigen::VectorXd*>& commands) {
    const double squares = sum_over(commands, [](double c) { return c * c; }),
                 count = sum_over(commands, [](double) { return 1.0; });
    if (!(squares > 0.0)) return;
    usual_ = std::sqrt(squares / count);
    small_part_ = sum_over(commands, [&](double c) { return c * part_of_small(c); }) / squares;
    large_part_ = sum_over(commands, [&](double c) { return c * part_of_large(c); }) / squares;
  }

  /// Grows in the smallest commands alone; without what of it is in proportion to all of them.
  double small(double command) const { return part_of_small(command) - small_part_ * command; }
  /// Grows most in the largest; without the same.
  double large(double command) const { return part_of_large(command) - large_part_ * command; }
  /// The part that gears rub off, against the motion. @param rate  its sign counts
  static double rubbed(double command, double rate) { return std::copysign(command, rate); }

private:
  template <class Of>
  static double sum_over(const std::vector<const Eigen::VectorXd*>& commands, Of&& of) {
    double sum = 0.0;
    for (const Eigen::VectorXd* all : commands)
      for (const double one : *all)
        if (std::isfinite(one)) sum += of(one);
    return sum;
  }
  double part_of_small(double command) const {
    constexpr double small = 0.1;  // of what is usual
    return command / std::hypot(command, small * usual_);
  }
  double part_of_large(double command) const { return command * std::abs(command) / usual_; }

  double usual_ = 1.0;  ///< root mean square
  double small_part_ = 0.0, large_part_ = 0.0;
};

/// Thresholds of a regression of the motion on its command.
/// Held by tests/gap/observe/command_test.cpp and tests/gap/observe/lagging_output_test.cpp.
struct MotionThresholds {
  std::size_t most_rows = 30000;  ///< that move and are looked at
  double moving = 0.05;           ///< of the rate's 95th percentile: slower rows may be stuck
  int periods = 2;                ///< of the angle that are taken away
  int most_cogs = 60;             ///< a turn
};

/// Coefficients of a command's terms, with those that are found when a block of the rows is left out.
struct MotionFit {
  Eigen::VectorXd value;                 ///< deg/s^2 for each unit of a term
  std::vector<Eigen::VectorXd> without;  ///< the same without a block each
  double first_dps = 0.0;  ///< root mean square of what the first term changes the rate by between two rows
  double left_dps2 = 0.0;  ///< root mean square of the acceleration that the fit leaves
  Eigen::VectorXd beside_value = {};  ///< coefficients of what turns the axis beside the command
  std::vector<int> cogs = {};         ///< periods a turn among that

  /// The second term's coefficient by the first one's. @param more  that is added to it
  Estimate second_by_first(double more = 0.0) const {
    const auto ratio = [more](const Eigen::VectorXd& of) { return more + of[1] / of[0]; };
    std::vector<double> left_out;
    for (const Eigen::VectorXd& one : without) left_out.push_back(ratio(one));
    return {ratio(value), jackknife_error(left_out)};
  }

  /// Terms of what turns an axis beside its command and its cogs: friction, a spring, an imbalance and a constant.
  static Eigen::Matrix<double, 7, 1> beside_terms(double dps, double rad) {
    const plant::SineCosine once(rad);
    return {dps, std::abs(dps), dps > 0.0 ? 1.0 : -1.0, rad, once.sine, once.cosine, 1.0};
  }

  /// The acceleration beside that by the command, deg/s^2. @param dps  the rate @param rad  the angle
  double beside(double dps, double rad) const {
    Eigen::VectorXd terms(beside_value.size());
    Eigen::Index at = 7;
    terms.head(at) = beside_terms(dps, rad);
    for (const int one : cogs) {
      const plant::SineCosine often(one * rad);
      terms[at++] = often.sine;
      terms[at++] = often.cosine;
    }
    return terms.dot(beside_value);
  }
};

/// Regresses the acceleration between rows on terms of the command beside friction, a spring, an imbalance, a constant and
/// cogs.
class MotionRegression {
public:
  /// Terms of a command over the interval from row `row` of a run to the next: at most fourteen; none where the run does not hold
  /// the rows that they are made of.
  using Terms = Eigen::VectorXd;
  /// Makes the terms of a command.
  using TermsOf = std::function<Terms(const Inputs& inputs, const Eigen::VectorXd& command,
                                      const RunSpan& run, Eigen::Index row)>;

  /// A recording and its command.
  struct Driven {
    const Inputs* inputs;            ///< of the recording
    const Eigen::VectorXd* command;  ///< one for each row
  };

  /// Adds a recording of an axis that is driven by `command`, and nothing else. Both must outlive this object.
  void add(const Inputs& inputs, const Eigen::VectorXd& command) {
    if (command.size() > 0 && inputs.axis()) recordings_.push_back({&inputs, &command});
  }

  /// All that were added.
  const std::vector<Driven>& recordings() const { return recordings_; }

  /// Noise scale of a signal in the worst recording; 0 where none is judged.
  double noise(Signal signal) const {
    double scale = 0.0;
    for (const Driven& one : recordings_)
      if (one.inputs->judged(signal))
        scale = std::max(scale, white_scale(one.inputs->of(signal), one.inputs->runs));
    return scale;
  }

  /// How a drive may bend the commands.
  BentCommand bent_command() const {
    std::vector<const Eigen::VectorXd*> commands;
    for (const Driven& one : recordings_) commands.push_back(one.command);
    return BentCommand(commands);
  }

  /// The rate below which an axis may be stuck, deg/s: slower rows are left out.
  double slowest_dps() const {
    std::vector<double> all = speeds();
    return slowest_of(all);
  }

  /// The coefficients; nothing where too few rows move.
  /// @param together  rows whose mean, under a bell, is a sample of the regression. The regression is linear, so that means obey it, too,
  ///                  but differences of positions from row to row are mostly their noise, and its means hardly any
  std::optional<MotionFit> fit(const TermsOf& terms_of, std::size_t together = 1) const {
    constexpr auto parts = static_cast<Eigen::Index>(JackknifeThresholds().blocks);
    const std::vector<Row> rows = moving_rows(terms_of, together);
    if (rows.size() < JackknifeThresholds().least_rows) return std::nullopt;
    const Regressors regressors(rows);
    const Eigen::Index count = regressors.terms.rows(), terms = rows.front().size() - first_term;
    std::vector<NormalEquations> blocks;
    for (Eigen::Index k = 0; k < parts; ++k) {
      const Eigen::Index begin = (count * k + parts - 1) / parts, end = (count * (k + 1) + parts - 1) / parts;
      blocks.emplace_back(regressors.terms.middleRows(begin, end - begin),
                          regressors.responses.segment(begin, end - begin));
    }
    MotionFit fit;
    const auto coefficients = [&](const NormalEquations& some) -> Eigen::VectorXd {
      return some.solve().head(terms);
    };
    const auto [all, without] = left_out(blocks, coefficients);
    const Eigen::VectorXd solved = all.solve();
    fit.value = solved.head(terms);
    if (!fit.value.allFinite()) return std::nullopt;
    fit.without = without;
    fit.beside_value = solved.tail(solved.size() - terms);
    fit.cogs = regressors.cogs;
    double squares = 0.0;
    for (const Row& row : rows) {
      const double by_dps = fit.value[0] * row[first_term] * row[step_s];
      squares += by_dps * by_dps / static_cast<double>(rows.size());
    }
    const double left_squares =
        (regressors.responses - regressors.terms * solved).squaredNorm() / static_cast<double>(count);
    fit.first_dps = std::sqrt(squares);
    fit.left_dps2 = std::sqrt(left_squares);
    return fit;
  }

private:
  /// A sample of the regression: what the enumerators say, and the command's terms.
  using Row = Eigen::VectorXd;
  enum : Eigen::Index { response_dps2, rate_dps, angle_rad, step_s, first_term };

  /// Mean of neighbours, under a bell.
  static Row mean_of(const std::vector<Row>& rows) {
    constexpr double turn = 6.283185307179586;
    Row all = Row::Zero(rows.front().size());
    double sum = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double weight =
          1.0 - std::cos(turn * (static_cast<double>(i) + 0.5) / static_cast<double>(rows.size()));
      sum += weight;
      all += weight * rows[i];
    }
    return all / sum;
  }

  /// The rows of the regression: the command's terms and what turns the axis beside it, the cogs last.
  struct Regressors {
    Eigen::MatrixXd terms;
    Eigen::VectorXd responses;
    std::vector<int> cogs;  ///< periods a turn that are among the terms

    explicit Regressors(const std::vector<Row>& rows) {
      constexpr MotionThresholds limit;
      const Eigen::Index of_command = rows.front().size() - first_term,
                         count = static_cast<Eigen::Index>(rows.size()), uncogged = of_command + 7;
      terms.resize(count, uncogged + 2 * limit.periods);
      responses.resize(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        const Row& row = rows[static_cast<std::size_t>(i)];
        terms.row(i).head(of_command) = row.tail(of_command);
        terms.row(i).segment(of_command, 7) = MotionFit::beside_terms(row[rate_dps], row[angle_rad]);
        responses[i] = row[response_dps2];
      }
      for (Eigen::Index used = uncogged; used < terms.cols(); used += 2) {
        cogs.push_back(strongest_beside(used, uncogged - 2));
        for (Eigen::Index i = 0; i < count; ++i) {
          const plant::SineCosine often(cogs.back() * rows[static_cast<std::size_t>(i)][angle_rad]);
          terms(i, used) = often.sine;
          terms(i, used + 1) = often.cosine;
        }
      }
    }

    /// Cogs a turn of the strongest period of the angle in what the first terms leave.
    /// @param used    so many of them
    /// @param cosine  column of the cosine of the angle; the sine's is the one before
    int strongest_beside(Eigen::Index used, Eigen::Index cosine) const {
      const auto by = terms.leftCols(used);
      const Eigen::VectorXd left = responses - by * NormalEquations(by, responses).solve();
      const auto cos = terms.col(cosine).array(), sin = terms.col(cosine - 1).array();
      Eigen::ArrayXd real = left.array() * cos, imaginary = left.array() * sin,
                     turned;  // of one period a turn
      int strongest = 0;
      double most = -1.0;
      // From two on: one is an imbalance.
      for (int often = 2; often <= MotionThresholds().most_cogs + 2; ++often) {
        turned = real * cos - imaginary * sin;
        imaginary = real * sin + imaginary * cos;
        real.swap(turned);
        const double size = std::norm(std::complex<double>(real.sum(), imaginary.sum()));
        if (size > most) most = size, strongest = often;
      }
      return strongest;
    }
  };

  /// The speed of each row with a motion, deg/s.
  std::vector<double> speeds() const {
    std::vector<double> all;
    for (const Driven& one : recordings_)
      for (const RunSpan& run : one.inputs->runs)
        for (Eigen::Index k = run.begin + 1; k + 1 < run.end; ++k)
          if (const double dps = MeasuredMotion(*one.inputs, k).rate_dps; std::isfinite(dps))
            all.push_back(std::abs(dps));
    return all;
  }

  /// The speed below which an axis may be stuck, of such speeds. Reorders them.
  static double slowest_of(std::vector<double>& speeds) {
    return MotionThresholds().moving * quantile_of(speeds, 0.95);
  }

  /// The terms of a row; without a rate its acceleration is one of the intervals before and after, and so are they.
  static Terms terms_at(const Driven& one, const TermsOf& terms_of, const RunSpan& run, Eigen::Index row) {
    const Terms after = terms_of(*one.inputs, *one.command, run, row);
    if (one.inputs->judged(Signal::rate_dps) || after.size() == 0) return after;
    const Terms before = terms_of(*one.inputs, *one.command, run, row - 1);
    return before.size() == 0 ? before : Terms(0.5 * (after + before));
  }

  /// Rows that move, at most as many as are needed, or means of them, each window half a window after the one before.
  std::vector<Row> moving_rows(const TermsOf& terms_of, std::size_t together) const {
    std::vector<double> all = speeds();
    const double slowest = slowest_of(all);
    const auto fast = std::count_if(all.begin(), all.end(), [&](double speed) { return speed > slowest; });
    const std::size_t stride = together > 1 ? 1
                                            : static_cast<std::size_t>(fast) / MotionThresholds().most_rows +
                                                  1;  // means need neighbours
    std::vector<Row> moving;
    std::size_t count = 0;
    for (const Driven& one : recordings_)
      for (const RunSpan& run : one.inputs->runs) {
        std::vector<Row> neighbours;
        Eigen::Index last = -1;
        for (Eigen::Index k = run.begin + 1; k + 1 < run.end; ++k) {
          const MeasuredMotion motion(*one.inputs, k);
          if (!(std::abs(motion.rate_dps) > slowest) || count++ % stride != 0) continue;
          const Terms terms = terms_at(one, terms_of, run, k);
          Row row(first_term + terms.size());
          row << motion.acceleration_dps2, motion.rate_dps, motion.angle_rad,
              one.inputs->t_s[k + 1] - one.inputs->t_s[k], terms;
          if (terms.size() == 0 || !row.allFinite()) continue;
          if (k != last + 1) neighbours.clear();
          last = k;
          neighbours.push_back(std::move(row));
          if (neighbours.size() < together) continue;
          moving.push_back(mean_of(neighbours));
          neighbours.erase(neighbours.begin(),
                           neighbours.begin() + static_cast<std::ptrdiff_t>((together + 1) / 2));
        }
      }
    return moving;
  }

  std::vector<Driven> recordings_;
};

}  // namespace thermopower::gap::engine
