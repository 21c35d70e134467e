// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/bent_command.hpp>
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
/// What of a command the motion follows, before any model: the acceleration between rows, regressed on terms of the command
/// and on what else turns most axes.

namespace thermopower::gap::engine {

/// How an axis moves at a row, as it was measured: the acceleration from its rate over the interval after the row, or without
/// a rate from its angle over the intervals before and after.
struct MeasuredMotion {
  double acceleration_dps2;  ///< deg/s^2
  double rate_dps;           ///< mean over the same, deg/s

  /// @param row  neither the first nor the last of its run
  MeasuredMotion(const Inputs& inputs, Eigen::Index row) {
    const bool by_rate = inputs.judged(Signal::rate_dps);
    const Eigen::VectorXd& values = inputs.of(by_rate ? Signal::rate_dps : Signal::angle_deg);
    const double step_s = inputs.t_s[row + 1] - inputs.t_s[row],
                 after = (values[row + 1] - values[row]) / step_s;
    if (by_rate) {
      acceleration_dps2 = after;
      rate_dps = 0.5 * (values[row] + values[row + 1]);
      return;
    }
    const double before_s = inputs.t_s[row] - inputs.t_s[row - 1],
                 before = (values[row] - values[row - 1]) / before_s;
    acceleration_dps2 = 2.0 * (after - before) / (step_s + before_s);
    rate_dps = 0.5 * (after + before);
  }
};

/// Thresholds of a regression of the motion on its command.
/// Held by tests/gap/observe/command_test.cpp and tests/gap/observe/lagging_output_test.cpp.
struct MotionThresholds {
  std::size_t least_rows = 300;   ///< that move: fewer do not tell
  std::size_t most_rows = 30000;  ///< that are looked at
  std::size_t blocks = 20;        ///< of the jackknife
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

  /// A number made of the coefficients, and its standard error.
  template <class Of>
  std::pair<double, double> estimate(Of&& of) const {
    std::vector<double> left_out;
    for (const Eigen::VectorXd& one : without) left_out.push_back(of(one));
    return {of(value), jackknife_error(left_out)};
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

  /// Adds a recording of an axis that is driven by `command`; of what is none nothing. Keeps references to both: they must outlive this object.
  void add(const Inputs& inputs, const Eigen::VectorXd& command) {
    if (command.size() > 0 && inputs.axis()) recordings_.push_back({&inputs, &command});
  }

  /// What was added.
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

  /// What turns the axis beside its command, by a fit: friction, a spring, an imbalance, a constant and cogs, in deg/s^2.
  /// @param dps  the rate
  /// @param rad  the angle
  static double beside(const MotionFit& fit, double dps, double rad) {
    return beside_terms(dps, rad, fit.cogs).dot(fit.beside_value);
  }

  /// The angle of a row as the regression has it, 0 where none is judged, rad.
  static double angle_rad(const Inputs& inputs, Eigen::Index row) {
    if (!inputs.judged(Signal::angle_deg)) return 0.0;
    const Eigen::VectorXd& deg = inputs.of(Signal::angle_deg);
    return (inputs.judged(Signal::rate_dps) ? 0.5 * (deg[row] + deg[row + 1]) : deg[row]) * rad_per_deg;
  }

  /// The coefficients; nothing where too few rows move.
  /// @param together  rows whose mean, under a bell, is a sample of the regression. The regression is linear, so that means obey it, too,
  ///                  but differences of positions from row to row are mostly their noise, and its means hardly any
  std::optional<MotionFit> fit(const TermsOf& terms_of, Eigen::Index together = 1) const {
    constexpr MotionThresholds limit;
    const std::vector<Row> rows = moving_rows(terms_of, together);
    if (rows.size() < limit.least_rows) return std::nullopt;
    const Regressors regressors(rows);
    const Eigen::Index count = regressors.terms().rows(), terms = rows.front().terms.size();
    std::vector<NormalEquations> blocks;
    NormalEquations all(regressors.terms().cols());
    const auto parts = static_cast<Eigen::Index>(limit.blocks);
    for (Eigen::Index k = 0; k < parts; ++k) {
      const Eigen::Index begin = (count * k + parts - 1) / parts, end = (count * (k + 1) + parts - 1) / parts;
      blocks.emplace_back(regressors.terms().middleRows(begin, end - begin),
                          regressors.responses().segment(begin, end - begin));
      all.add(blocks.back(), 1.0);
    }
    MotionFit fit;
    const Eigen::VectorXd solved = all.solve();
    fit.value = solved.head(terms);
    if (!fit.value.allFinite()) return std::nullopt;
    fit.beside_value = solved.tail(solved.size() - terms);
    fit.cogs = regressors.cogs();
    for (const NormalEquations& one : blocks) {
      NormalEquations rest = all;
      rest.add(one, -1.0);
      fit.without.push_back(rest.solve().head(terms));
    }
    double squares = 0.0;
    for (const Row& row : rows) {
      const double by_dps = fit.value[0] * row.terms[0] * row.step_s;
      squares += by_dps * by_dps / static_cast<double>(rows.size());
    }
    const double left_squares =
        (regressors.responses() - regressors.terms() * solved).squaredNorm() / static_cast<double>(count);
    fit.first_dps = std::sqrt(squares);
    fit.left_dps2 = std::sqrt(left_squares);
    return fit;
  }

private:
  struct Row {
    double response = 0.0, dps = 0.0, rad = 0.0, step_s = 0.0;
    Terms terms;
  };

  /// Makes means of neighbours, each window half a window after the one before.
  class Means {
  public:
    explicit Means(Eigen::Index together) : together_(static_cast<std::size_t>(together)) {}

    /// Takes a row of a recording. @param next  it is the neighbour of the one before
    void take(const Row& row, bool next, std::vector<Row>& means) {
      if (!next) rows_.clear();
      rows_.push_back(row);
      if (rows_.size() < together_) return;
      means.push_back(mean());
      rows_.erase(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>((together_ + 1) / 2));
    }

  private:
    Row mean() const {
      Row all = rows_.front();
      if (rows_.size() == 1) return all;
      all.response = all.dps = all.rad = all.step_s = 0.0;
      all.terms.setZero();
      double sum = 0.0;
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        constexpr double turn = 6.283185307179586;
        const double weight =
            1.0 - std::cos(turn * (static_cast<double>(i) + 0.5) / static_cast<double>(rows_.size()));
        sum += weight;
        all.response += weight * rows_[i].response;
        all.dps += weight * rows_[i].dps;
        all.rad += weight * rows_[i].rad;
        all.step_s += weight * rows_[i].step_s;
        all.terms += weight * rows_[i].terms;
      }
      for (double* one : {&all.response, &all.dps, &all.rad, &all.step_s}) *one /= sum;
      all.terms /= sum;
      return all;
    }

    std::size_t together_;
    std::vector<Row> rows_;
  };

  static constexpr Eigen::Index others =
      7;  ///< of what turns the axis beside the command, the cogs not counted

  /// What turns the axis beside the command and its cogs.
  static Eigen::Matrix<double, others, 1> uncogged_terms(double dps, double rad) {
    const plant::SineCosine once(rad);
    Eigen::Matrix<double, others, 1> x;
    x << dps, std::abs(dps), dps > 0.0 ? 1.0 : -1.0, rad, once.sine, once.cosine, 1.0;
    return x;
  }

  static Eigen::VectorXd beside_terms(double dps, double rad, const std::vector<int>& cogs_a_turn) {
    Eigen::VectorXd x(others + 2 * static_cast<Eigen::Index>(cogs_a_turn.size()));
    x.head(others) = uncogged_terms(dps, rad);
    Eigen::Index at = others;
    for (const int cogs : cogs_a_turn) {
      const plant::SineCosine often(cogs * rad);
      x[at++] = often.sine;
      x[at++] = often.cosine;
    }
    return x;
  }

  /// The rows of the regression: the command's terms and what turns the axis beside it, the cogs last.
  class Regressors {
  public:
    explicit Regressors(const std::vector<Row>& rows) {
      const Eigen::Index terms = rows.front().terms.size(), count = static_cast<Eigen::Index>(rows.size()),
                         uncogged = terms + others;
      terms_.resize(count, uncogged + 2 * MotionThresholds().periods);
      responses_.resize(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        const Row& row = rows[static_cast<std::size_t>(i)];
        terms_.row(i).head(terms) = row.terms;
        terms_.row(i).segment(terms, others) = uncogged_terms(row.dps, row.rad);
        responses_[i] = row.response;
      }
      for (int found = 0; found < MotionThresholds().periods; ++found) {
        const Eigen::Index used = uncogged + 2 * found;
        cogs_.push_back(strongest_beside(used, uncogged - 2));
        for (Eigen::Index i = 0; i < count; ++i) {
          const plant::SineCosine often(cogs_.back() * rows[static_cast<std::size_t>(i)].rad);
          terms_(i, used) = often.sine;
          terms_(i, used + 1) = often.cosine;
        }
      }
    }

    const Eigen::MatrixXd& terms() const { return terms_; }
    const Eigen::VectorXd& responses() const { return responses_; }
    /// Periods a turn that are among the terms.
    const std::vector<int>& cogs() const { return cogs_; }

  private:
    /// Cogs a turn of the strongest period of the angle in what the first terms leave.
    /// @param used    so many of them
    /// @param cosine  column of the cosine of the angle; the sine's is the one before
    int strongest_beside(Eigen::Index used, Eigen::Index cosine) const {
      const auto by = terms_.leftCols(used);
      const Eigen::VectorXd left = responses_ - by * NormalEquations(by, responses_).solve();
      const auto cos = terms_.col(cosine).array(), sin = terms_.col(cosine - 1).array();
      Eigen::ArrayXd real = left.array() * cos, imaginary = left.array() * sin,
                     turned;  // of one period a turn
      int strongest = 0;
      double most = -1.0;
      // From two on: one is an imbalance.
      for (int cogs = 2; cogs <= MotionThresholds().most_cogs + 2; ++cogs) {
        turned = real * cos - imaginary * sin;
        imaginary = real * sin + imaginary * cos;
        real.swap(turned);
        const double size = std::norm(std::complex<double>(real.sum(), imaginary.sum()));
        if (size > most) most = size, strongest = cogs;
      }
      return strongest;
    }

    Eigen::MatrixXd terms_;
    Eigen::VectorXd responses_;
    std::vector<int> cogs_;
  };

  /// Hands each row with an acceleration to `use(driven, run, row, motion)`.
  using UseRow = std::function<void(const Driven& driven, const RunSpan& run, Eigen::Index row,
                                    const MeasuredMotion& motion)>;
  void for_each_row(const UseRow& use) const {
    for (const Driven& one : recordings_) {
      const Inputs& inputs = *one.inputs;
      for (const RunSpan& run : inputs.runs)
        for (Eigen::Index k = run.begin + 1; k + 1 < run.end; ++k)
          use(one, run, k, MeasuredMotion(inputs, k));
    }
  }

  /// What each row with a motion turns by, deg/s, without its sign.
  std::vector<double> speeds() const {
    std::vector<double> all;
    for_each_row([&](const Driven&, const RunSpan&, Eigen::Index, const MeasuredMotion& motion) {
      if (std::isfinite(motion.rate_dps)) all.push_back(std::abs(motion.rate_dps));
    });
    return all;
  }

  /// The speed below which an axis may be stuck, of such speeds. Reorders them.
  static double slowest_of(std::vector<double>& speeds) {
    return MotionThresholds().moving * quantile_of(speeds, 0.95);
  }

  /// Rows that move, at most as many as are needed.
  std::vector<Row> moving_rows(const TermsOf& terms_of, Eigen::Index together) const {
    constexpr MotionThresholds limit;
    std::vector<double> all = speeds();
    const double slowest = slowest_of(all);
    const auto fast = std::count_if(all.begin(), all.end(), [&](double speed) { return speed > slowest; });
    const std::size_t stride =
        together > 1 ? 1 : static_cast<std::size_t>(fast) / limit.most_rows + 1;  // means need neighbours
    std::vector<Row> moving;
    Means means(together);
    const RunSpan* last_run = nullptr;
    Eigen::Index last = -1;
    std::size_t count = 0;
    for_each_row([&](const Driven& one, const RunSpan& run, Eigen::Index k, const MeasuredMotion& motion) {
      if (!(std::abs(motion.rate_dps) > slowest) || count++ % stride != 0) return;
      const Inputs& inputs = *one.inputs;
      const bool by_rate = inputs.judged(Signal::rate_dps);
      Row row;
      row.response = motion.acceleration_dps2;
      row.dps = motion.rate_dps;
      row.step_s = inputs.t_s[k + 1] - inputs.t_s[k];
      row.rad = angle_rad(inputs, k);
      row.terms = terms_of(inputs, *one.command, run, k);
      if (!by_rate && row.terms.size() > 0) {  // a second difference: of the intervals before and after
        const Terms before = terms_of(inputs, *one.command, run, k - 1);
        if (before.size() == 0) return;
        row.terms = 0.5 * (row.terms + before);
      }
      if (row.terms.size() > 0 && row.terms.allFinite() && std::isfinite(row.response) &&
          std::isfinite(row.rad)) {
        means.take(row, last_run == &run && last + 1 == k, moving);
        last_run = &run;
        last = k;
      }
    });
    return moving;
  }

  std::vector<Driven> recordings_;
};

}  // namespace thermopower::gap::engine
