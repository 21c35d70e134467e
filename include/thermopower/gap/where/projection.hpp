// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/where/least_squares.hpp>
#include <thermopower/gap/where/rows.hpp>
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
  virtual Eigen::MatrixXd starts() const = 0;
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

protected:
  /// The values of a part of a direction, made where they are not at hand.
  static Eigen::VectorXd values_of(const plant::BalancePart& part) {
    return part.make ? part.make() : part.values;
  }
};

/// Row by row, averaged where there are very many. Of a filtered balance these are responses of the baseline's own linear
/// filter to the missing flow.
class RowProjection : public Projection {
public:
  /// Keeps a reference to `balance`, which must outlive it.
  RowProjection(const plant::Balance& balance, const LocalisationThresholds& limit)
      : b_(balance),
        most_starts_(limit.most_starts),
        average_(balance.rows->runs, balance.measured, limit.rows),
        capacity_(capacity_of(balance)) {
    Eigen::VectorXd flow = b_.flow_sampled;
    if (b_.flow_held.size() > 0) flow += b_.flow_held;
    simulated_ = flow;
    if (b_.form != plant::BalanceForm::filtered) return;
    kept_.resize(b_.rows->size());
    for (const RunSpan& run : b_.rows->runs)
      for (Eigen::Index i = run.begin; i < run.end; ++i)
        kept_[i] = std::exp(-b_.relaxation_per_s[i] * step_s(i, run));
    // From the measured start on, with everything but the state itself as measured: then what is left is exact
    // however far a constant is off.
    simulated_ = filtered(flow.cwiseQuotient(capacity_) + b_.relaxation_per_s.cwiseProduct(b_.state), true);
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
    const bool few = kept_.size() > 0 && static_cast<Eigen::Index>(runs.size()) <= most_starts_;
    Eigen::MatrixXd out(average_.rows(), few ? static_cast<Eigen::Index>(runs.size()) : 0);
    for (Eigen::Index r = 0; r < out.cols(); ++r) {
      Eigen::VectorXd left = Eigen::VectorXd::Zero(b_.rows->size());
      const RunSpan& run = runs[static_cast<std::size_t>(r)];
      for (Eigen::Index i = run.begin; i < run.end; ++i)
        left[i] = i == run.begin ? 1.0 : left[i - 1] * kept_[i - 1];
      out.col(r) = average_(left);
    }
    return out;
  }
  Eigen::VectorXi stretches(int folds) const override {
    Eigen::VectorXi fold(average_.rows());
    for (Eigen::Index i = 0; i < fold.size(); ++i) fold[i] = static_cast<int>(i * folds / fold.size());
    return fold;
  }
  double floor() const override {
    const double sigma = state_noise(b_);
    return sigma * sigma * static_cast<double>(average_.rows()) / static_cast<double>(average_.stride());
  }

private:
  Eigen::VectorXd response(const plant::BalancePart& part) const {
    using Kind = plant::BalancePart::Kind;
    if (part.kind == Kind::reading_late)
      return plant::lagged(simulated_, part.delay_s, false, b_.rows->t_s, b_.rows->runs) - simulated_;
    const Eigen::VectorXd values = values_of(part);
    if (kept_.size() == 0 || part.kind == Kind::reading) return values;
    return part.kind == Kind::store ? stored(values, part.weight)
                                    : filtered(values.cwiseQuotient(capacity_), false);
  }

  double step_s(Eigen::Index i, const RunSpan& run) const {
    return i + 1 < run.end ? b_.rows->t_s[i + 1] - b_.rows->t_s[i] : 0.0;
  }

  /// x' = pace - relaxation x, exactly for a pace that is held over the interval.
  Eigen::VectorXd filtered(const Eigen::VectorXd& pace, bool from_state) const {
    assert(pace.size() == kept_.size() && (!from_state || b_.state.size() == kept_.size()));
    Eigen::VectorXd out(pace.size());
    for (const RunSpan& run : b_.rows->runs) {
      double x = from_state ? b_.state[run.begin] : 0.0;
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        out[i] = x;
        const double keep = kept_[i], relax = b_.relaxation_per_s[i];
        x = keep * x + pace[i] * (relax > 0.0 ? (1.0 - keep) / relax : step_s(i, run));
      }
    }
    return out;
  }

  /// Response to the flow that a further store of this content takes.
  Eigen::VectorXd stored(const Eigen::VectorXd& content, const Eigen::VectorXd& weight) const {
    assert(content.size() == kept_.size() && (weight.size() == 0 || weight.size() == content.size()));
    Eigen::VectorXd out(content.size());
    for (const RunSpan& run : b_.rows->runs) {
      double x = 0.0;
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        out[i] = x;
        if (i + 1 == run.end) break;
        x = kept_[i] * x - (weight.size() > 0 ? weight[i] : 1.0) * (content[i + 1] - content[i]);
      }
    }
    return out;
  }

  const plant::Balance& b_;
  Eigen::Index most_starts_;
  Thinning average_;
  Eigen::VectorXd capacity_;
  Eigen::VectorXd
      kept_;  // of a state after each row's interval, if nothing flows: 0..1; empty: there is no state
  Eigen::VectorXd simulated_;
};

/// Integrals against test functions of one or several widths, each in units of its noise.
class WeakProjection : public Projection {
public:
  /// Keeps a reference to `balance`, which must outlive it.
  WeakProjection(const plant::Balance& balance, const LocalisationThresholds& limit)
      : b_(balance), capacity_(capacity_of(balance)) {
    const double state = state_noise(balance) * capacity_.cwiseAbs().mean();
    Eigen::VectorXd needed = balance.measured;
    double flow = 0.0;
    if (balance.flow_measured.size() > 0) {
      needed += balance.flow_measured;
      flow = plant::sample_noise(balance.flow_measured, balance.rows->runs);
    }
    for (const int half_width : balance.half_widths) {
      TestFunctions functions(balance.rows, needed, half_width,
                              widths_.empty() ? limit.narrow_functions : limit.wide_functions);
      const double noise =
          std::hypot(state * functions.derivative().gain(), flow * functions.integral().gain());
      rows_ += functions.size();
      RowIntegrals held = functions.held(balance.held_delay_s);
      widths_.push_back({std::move(functions), std::move(held), 1.0 / noise});
    }
  }

  Eigen::Index rows() const override { return rows_; }
  Eigen::VectorXd residual() const override {
    return joined([&](const Width& width) {
      const TestFunctions& f = width.functions;
      Eigen::VectorXd left = f.integral().of(capacity_).cwiseProduct(f.derivative().of(b_.state)) -
                             f.integral().of(b_.flow_sampled);
      if (b_.flow_held.size() > 0) left -= width.held.of(b_.flow_held);
      return left;
    });
  }

  Eigen::VectorXd column(const plant::Direction& direction) const override {
    return joined([&](const Width& width) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(width.functions.size());
      for (const plant::BalancePart& part : direction) sum += part.factor * integral(width, part);
      return sum;
    });
  }

  Eigen::MatrixXd starts() const override { return Eigen::MatrixXd(rows_, 0); }

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
inline std::unique_ptr<Projection> projection_of(const plant::Balance& balance,
                                                 const LocalisationThresholds& limit) {
  if (balance.form == plant::BalanceForm::weak) return std::make_unique<WeakProjection>(balance, limit);
  return std::make_unique<RowProjection>(balance, limit);
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
/// @param slack  how far a constant may be off, as a fraction
inline Problem problem_of(const plant::Balance& balance, const Projection& projection, double slack) {
  Problem problem;
  problem.slack = slack;
  problem.y = projection.residual();
  std::vector<plant::Direction> moved;
  for (const plant::ConstantDirection& constant : balance.constants) {
    plant::Direction direction = constant.direction();
    if (!direction.empty()) moved.push_back(std::move(direction));
  }
  problem.nuisance = projection.columns(moved);
  problem.free = projection.starts();
  problem.fold = projection.stretches(problem.folds);
  return problem;
}

}  // namespace thermopower::gap::engine
