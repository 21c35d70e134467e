// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/where/least_squares.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/gap/where/test_functions.hpp>
#include <thermopower/gap/where/thresholds.hpp>
#include <thermopower/plant/balance.hpp>
#include <thermopower/plant/samples.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

/// @file
/// A balance as a least-squares problem: its residual, and every direction in which it may be off. Both are brought to rows
/// that can be compared with noise. It knows the three forms of a balance and no equation.

namespace thermopower::gap::engine {

/// Noise of one sample of the state that a balance is about.
inline double state_noise(const plant::Balance& balance) {
  if (balance.noise > 0.0) return balance.noise;
  const Eigen::VectorXd& from = balance.noise_from.size() > 0 ? balance.noise_from : balance.measured;
  return std::max(balance.noise_gain * plant::sample_noise(from, balance.rows->runs), 1e-9);
}

/// The capacity of a balance at every row; 1 where it has none.
inline Eigen::VectorXd capacity_of(const plant::Balance& balance) {
  return balance.capacity.size() > 0 ? balance.capacity
                                     : Eigen::VectorXd(Eigen::VectorXd::Ones(balance.rows->size()));
}

/// The flow into a balance at every row.
inline Eigen::VectorXd flow_of(const plant::Balance& balance) {
  return balance.flow_held.size() > 0 ? Eigen::VectorXd(balance.flow_sampled + balance.flow_held)
                                      : balance.flow_sampled;
}

/// The samples that a test function of a balance must find: NaN where one is missing.
inline Eigen::VectorXd needed_by(const plant::Balance& balance) {
  return balance.flow_measured.size() > 0 ? Eigen::VectorXd(balance.measured + balance.flow_measured)
                                          : balance.measured;
}

/// The missing quantity of a balance as test functions see it.
/// @param held  integrals of the flow that holds over intervals
inline Eigen::VectorXd missing_of(const plant::Balance& balance, const TestFunctions& functions,
                                  const RowIntegrals& held) {
  const RowIntegrals &integral = functions.integral(), &derivative = functions.derivative();
  Eigen::VectorXd missing = integral.of(capacity_of(balance)).cwiseProduct(derivative.of(balance.state)) -
                            integral.of(balance.flow_sampled);
  if (balance.flow_held.size() > 0) missing -= held.of(balance.flow_held);
  return missing;
}

/// Averages some rows at a time inside each run, so that a million rows cost what ten thousand do.
class Thinning {
public:
  /// @param most  rows that are left, about; rows where `measured` has none do not count into an average
  Thinning(const std::vector<RunSpan>& runs, const Eigen::VectorXd& measured, Eigen::Index most) {
    Eigen::Index rows = 0;
    for (const RunSpan& run : runs) rows += run.size();
    stride_ = std::max<Eigen::Index>(1, (rows + most - 1) / most);
    for (const RunSpan& run : runs)
      for (Eigen::Index i = run.begin; i < run.end; i += stride_) {
        const std::size_t before = kept_.size();
        for (Eigen::Index k = i; k < std::min(i + stride_, run.end); ++k)
          if (std::isfinite(measured[k])) kept_.push_back(k);
        if (kept_.size() > before) end_.push_back(kept_.size());
      }
  }

  /// How many rows are left.
  Eigen::Index rows() const { return static_cast<Eigen::Index>(end_.size()); }
  /// How many rows an average is of, at most.
  Eigen::Index stride() const { return stride_; }

  /// The averages of a column of the full length: rows() of them.
  Eigen::VectorXd operator()(const Eigen::VectorXd& full) const {
    assert(kept_.empty() || kept_.back() < full.size());
    Eigen::VectorXd out(rows());
    std::size_t k = 0;
    for (Eigen::Index i = 0; i < rows(); ++i) {
      const std::size_t begin = k, end = end_[static_cast<std::size_t>(i)];
      double sum = 0.0;
      for (; k < end; ++k) sum += full[kept_[k]];
      out[i] = sum / static_cast<double>(end - begin);
    }
    return out;
  }

private:
  Eigen::Index stride_ = 1;
  std::vector<Eigen::Index> kept_;  // those of the first average, then of the second
  std::vector<std::size_t> end_;    // of each average in them
};

/// The values of a part of a direction, made where they are not at hand.
inline Eigen::VectorXd values_of(const plant::BalancePart& part) {
  return part.make ? part.make() : part.values;
}

/// Rows in which a balance, and every direction in which it may be off, is compared.
class Projection {
public:
  virtual ~Projection() = default;
  /// How many they are.
  virtual Eigen::Index rows() const = 0;
  /// The baseline's residual; positive if flow is missing.
  virtual Eigen::VectorXd residual() const = 0;
  /// The change by a direction.
  virtual Eigen::VectorXd column(const plant::Direction& direction) const = 0;
  /// The change by the unknown starts of runs; may have no column.
  virtual Eigen::MatrixXd starts() const { return Eigen::MatrixXd(rows(), 0); }
  /// The stretch of each row, 0..folds-1; rows of a stretch lie together.
  virtual Eigen::VectorXi stretches(int folds) const = 0;
  /// Sum of squares that noise alone would leave.
  virtual double floor() const = 0;

  /// The change by several directions, one column each.
  Eigen::MatrixXd columns(const std::vector<plant::Direction>& directions) const {
    Eigen::MatrixXd out(rows(), static_cast<Eigen::Index>(directions.size()));
    for (Eigen::Index k = 0; k < out.cols(); ++k)
      out.col(k) = column(directions[static_cast<std::size_t>(k)]);
    return out;
  }
};

/// Row by row, averaged where there are very many. Of a filtered balance these are responses of the baseline's own linear
/// filter to the missing flow.
class RowProjection : public Projection {
public:
  /// Keeps a reference to `balance`, which must outlive it.
  explicit RowProjection(const plant::Balance& balance)
      : b_(balance),
        average_(balance.rows->runs, balance.measured, where_limits.rows),
        simulated_(flow_of(balance)) {
    if (b_.form != plant::BalanceForm::filtered) return;
    const Eigen::VectorXd& t_s = b_.rows->t_s;
    capacity_ = capacity_of(balance);
    kept_ = reach_s_ = Eigen::VectorXd::Ones(t_s.size());
    for (const RunSpan& run : b_.rows->runs)
      for (Eigen::Index i = run.begin; i + 1 < run.end; ++i) {
        const double relaxation = b_.relaxation_per_s[i], step_s = t_s[i + 1] - t_s[i];
        kept_[i] = std::exp(-relaxation * step_s);
        reach_s_[i] = relaxation > 0.0 ? (1.0 - kept_[i]) / relaxation : step_s;
      }
    // From the measured start on, with everything but the state itself as measured: then what is left is exact
    // however far a constant is off.
    const Eigen::VectorXd pace =
        simulated_.cwiseQuotient(capacity_) + b_.relaxation_per_s.cwiseProduct(b_.state);
    simulated_ = carried(b_.state, pace.cwiseProduct(reach_s_));
  }

  Eigen::Index rows() const override { return average_.rows(); }
  Eigen::VectorXd residual() const override { return average_(b_.measured - simulated_); }

  Eigen::VectorXd column(const plant::Direction& direction) const override {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(b_.rows->size());
    for (const plant::BalancePart& part : direction) sum += part.factor * response(part);
    return average_(sum);
  }

  Eigen::MatrixXd starts() const override {
    const auto& runs = b_.rows->runs;
    const bool few = has_state() && static_cast<Eigen::Index>(runs.size()) <= where_limits.most_starts;
    Eigen::MatrixXd out(rows(), few ? static_cast<Eigen::Index>(runs.size()) : 0);
    const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(b_.rows->size());
    for (Eigen::Index r = 0; r < out.cols(); ++r) {
      Eigen::VectorXd start = nothing;
      start[runs[static_cast<std::size_t>(r)].begin] = 1.0;
      out.col(r) = average_(carried(start, nothing));
    }
    return out;
  }
  Eigen::VectorXi stretches(int folds) const override {
    Eigen::VectorXi fold(rows());
    for (Eigen::Index i = 0; i < fold.size(); ++i) fold[i] = static_cast<int>(i * folds / fold.size());
    return fold;
  }
  double floor() const override {
    const double sigma = state_noise(b_);
    return sigma * sigma * static_cast<double>(rows()) / static_cast<double>(average_.stride());
  }

private:
  bool has_state() const { return kept_.size() > 0; }

  Eigen::VectorXd response(const plant::BalancePart& part) const {
    using Kind = plant::BalancePart::Kind;
    if (part.kind == Kind::reading_late)
      return plant::lagged(simulated_, part.delay_s, false, b_.rows->t_s, b_.rows->runs) - simulated_;
    const Eigen::VectorXd values = values_of(part);
    if (!has_state() || part.kind == Kind::reading) return values;
    const Eigen::Index last = values.size() - 1;
    Eigen::VectorXd gain = Eigen::VectorXd::Zero(values.size());
    if (part.kind != Kind::store) gain = values.cwiseQuotient(capacity_).cwiseProduct(reach_s_);
    else gain.head(last) = values.head(last) - values.tail(last);
    if (part.kind == Kind::store && part.weight.size() > 0) gain = gain.cwiseProduct(part.weight);
    return carried(Eigen::VectorXd::Zero(values.size()), gain);
  }

  /// A state that relaxes over each row's interval and gains something in it.
  /// @param start  read at the first row of each run
  Eigen::VectorXd carried(const Eigen::VectorXd& start, const Eigen::VectorXd& gain) const {
    assert(start.size() == kept_.size() && gain.size() == kept_.size());
    Eigen::VectorXd out = start;
    for (const RunSpan& run : b_.rows->runs)
      for (Eigen::Index i = run.begin; i + 1 < run.end; ++i) out[i + 1] = kept_[i] * out[i] + gain[i];
    return out;
  }

  const plant::Balance& b_;
  Thinning average_;
  Eigen::VectorXd capacity_, kept_,
      reach_s_;  // of a state: share left after an interval, gain of a pace; or empty
  Eigen::VectorXd simulated_;
};

/// Integrals against test functions of one or several widths, each in units of its noise.
class WeakProjection : public Projection {
public:
  /// Keeps a reference to `balance`, which must outlive it.
  explicit WeakProjection(const plant::Balance& balance) : b_(balance), capacity_(capacity_of(balance)) {
    const double state = state_noise(balance) * capacity_.cwiseAbs().mean();
    const double flow = balance.flow_measured.size() > 0
                            ? plant::sample_noise(balance.flow_measured, balance.rows->runs)
                            : 0.0;
    for (const int half_width : balance.half_widths) {
      TestFunctions functions(balance.rows, needed_by(balance), half_width,
                              widths_.empty() ? where_limits.narrow_functions : where_limits.wide_functions);
      const double noise =
          std::hypot(state * functions.derivative().gain(), flow * functions.integral().gain());
      rows_ += functions.size();
      RowIntegrals held = functions.held(balance.held_delay_s);
      widths_.push_back({std::move(functions), std::move(held), 1.0 / noise});
    }
  }

  Eigen::Index rows() const override { return rows_; }
  Eigen::VectorXd residual() const override {
    return joined([&](const Width& width) { return missing_of(b_, width.functions, width.held); });
  }

  Eigen::VectorXd column(const plant::Direction& direction) const override {
    return joined([&](const Width& width) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(width.functions.size());
      for (const plant::BalancePart& part : direction) sum += part.factor * integral(width, part);
      return sum;
    });
  }

  Eigen::VectorXi stretches(int folds) const override {
    Eigen::VectorXi fold(rows_);
    Eigen::Index at = 0;
    for (const Width& width : widths_)
      for (Eigen::Index i = 0; i < width.functions.size(); ++i)
        fold[at++] = static_cast<int>(width.functions.begin(i) * folds / b_.rows->size());
    return fold;
  }
  double floor() const override { return static_cast<double>(rows_); }

private:
  struct Width {
    TestFunctions functions;
    RowIntegrals held;  // at the balance's own delay
    double weight;
  };

  Eigen::VectorXd integral(const Width& width, const plant::BalancePart& part) const {
    using Kind = plant::BalancePart::Kind;
    const TestFunctions& f = width.functions;
    const Eigen::VectorXd values = values_of(part);
    switch (part.kind) {
      case Kind::flow_sampled:
        return f.integral().of(values);
      case Kind::flow_held:
        return part.delay_s == 0.0 ? width.held.of(values)
                                   : f.held(b_.held_delay_s + part.delay_s).of(values);
      case Kind::store: {
        Eigen::VectorXd taken = f.integral().of(capacity_).cwiseProduct(f.derivative().of(values));
        if (part.weight.size() > 0) taken = taken.cwiseProduct(f.integral().of(part.weight));
        return -taken;
      }
      case Kind::reading:
      case Kind::reading_late:
        break;  // of the other forms
    }
    return Eigen::VectorXd::Zero(f.size());
  }

  template <class Make>
  Eigen::VectorXd joined(Make&& make) const {
    Eigen::VectorXd out(rows_);
    Eigen::Index at = 0;
    for (const Width& width : widths_) {
      out.segment(at, width.functions.size()) = width.weight * make(width);
      at += width.functions.size();
    }
    assert(at == rows_);
    return out;
  }

  const plant::Balance& b_;
  Eigen::VectorXd capacity_;
  std::vector<Width> widths_;
  Eigen::Index rows_ = 0;
};

/// The projection of a balance's form; the balance must outlive it.
inline std::unique_ptr<Projection> projection_of(const plant::Balance& balance) {
  if (balance.form == plant::BalanceForm::weak) return std::make_unique<WeakProjection>(balance);
  return std::make_unique<RowProjection>(balance);
}

/// The directions of a freedom; of a scan those that leave least.
inline Block block_of(const plant::Freedom& freedom, const Projection& projection, const Problem& problem) {
  Block block;
  block.lower = freedom.least;
  double least = std::numeric_limits<double>::infinity();
  const auto attempt = [&](double at) {
    Eigen::MatrixXd columns = projection.columns(freedom.directions(at));
    const double left = freedom.scan.empty() ? 0.0 : sum_of_squares_left(problem, columns);
    if (!(left < least)) return;
    least = left;
    block.columns = std::move(columns);
    block.at = at;
  };
  for (const double at : freedom.scan.empty() ? std::vector<double>{0.0} : freedom.scan) attempt(at);
  if (block.columns.size() == 0) block.columns = Eigen::MatrixXd::Zero(problem.y.size(), 1);
  return block;
}

/// The residual of a balance with what its constants may take from it.
inline Problem problem_of(const plant::Balance& balance, const Projection& projection) {
  Problem problem;
  problem.y = projection.residual();
  std::vector<plant::Direction> moved;
  for (const plant::ConstantDirection& constant : balance.constants) {
    plant::Direction direction = constant.direction();
    if (!direction.empty()) moved.push_back(std::move(direction));
  }
  problem.nuisance = projection.columns(moved);
  problem.free = projection.starts();
  problem.fold = projection.stretches(Problem::folds);
  return problem;
}

}  // namespace thermopower::gap::engine
