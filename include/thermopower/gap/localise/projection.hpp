// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise/least_squares.hpp>
#include <thermopower/gap/localise/rows.hpp>
#include <thermopower/gap/localise/test_functions.hpp>
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
  const Eigen::VectorXd& from = balance.noise_from.size() > 0 ? balance.noise_from : balance.measured;
  return std::max(balance.noise_gain * plant::sample_noise(from, balance.rows->runs), 1e-9);
}

/// The capacity of a balance at every row; 1 where it has none.
inline Eigen::VectorXd capacity_of(const plant::Balance& balance) {
  return balance.capacity.size() > 0 ? balance.capacity
                                     : Eigen::VectorXd(Eigen::VectorXd::Ones(balance.rows->size()));
}

/// The values of a part of a direction, made where they are not at hand.
class PartValues {
public:
  /// Keeps a reference to `part`, which must outlive it.
  explicit PartValues(const plant::BalancePart& part)
      : part_(part), made_(part.make ? part.make() : Eigen::VectorXd()) {}
  /// One per row; empty where there are none.
  const Eigen::VectorXd& operator()() const { return part_.make ? made_ : part_.values; }

private:
  const plant::BalancePart& part_;
  Eigen::VectorXd made_;
};

/// Rows in which a balance, and every direction in which it may be off, is compared.
class Projection {
public:
  virtual ~Projection() = default;
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
    Eigen::MatrixXd out;
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const Eigen::VectorXd one = column(directions[k]);
      if (k == 0) out.resize(one.size(), static_cast<Eigen::Index>(directions.size()));
      out.col(static_cast<Eigen::Index>(k)) = one;
    }
    return out;
  }
};

/// Row by row, averaged where there are very many.
class AlgebraicProjection : public Projection {
public:
  /// Keeps a reference to `balance`, which must outlive it.
  AlgebraicProjection(const plant::Balance& balance, const LocalisationThresholds& limit)
      : b_(balance), average_(balance.rows->runs, balance.measured, limit.rows) {}

  Eigen::VectorXd residual() const override {
    assert(b_.flow_sampled.size() == b_.rows->size());
    Eigen::VectorXd left = b_.measured - b_.flow_sampled;
    if (b_.flow_held.size() > 0) left -= b_.flow_held;
    return average_(left);
  }
  Eigen::VectorXd column(const plant::Direction& direction) const override {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(b_.rows->size());
    for (const plant::BalancePart& part : direction) {
      const PartValues values(part);
      if (values().size() > 0) sum += part.factor * values();
    }
    return average_(sum);
  }
  Eigen::MatrixXd starts() const override { return Eigen::MatrixXd(average_.rows(), 0); }
  Eigen::VectorXi stretches(int folds) const override { return average_.folds(folds); }
  double floor() const override {
    const double sigma = state_noise(b_);
    return sigma * sigma * static_cast<double>(average_.rows()) / static_cast<double>(average_.stride());
  }

private:
  const plant::Balance& b_;
  Thinning average_;
};

/// Responses of the baseline's own linear filter to missing flow.
class FilteredProjection : public Projection {
public:
  /// Keeps a reference to `balance`, which must outlive it.
  FilteredProjection(const plant::Balance& balance, const LocalisationThresholds& limit)
      : b_(balance),
        most_starts_(limit.most_starts),
        average_(balance.rows->runs, balance.measured, limit.rows),
        capacity_(capacity_of(balance)),
        kept_(balance.rows->size()) {
    for (const RunSpan& run : b_.rows->runs)
      for (Eigen::Index i = run.begin; i < run.end; ++i)
        kept_[i] = std::exp(-b_.relaxation_per_s[i] * step_s(i, run));
    // From the measured start on, with everything but the state itself as measured: then what is left is exact
    // however far a constant is off.
    Eigen::VectorXd flow = b_.flow_sampled;
    if (b_.flow_held.size() > 0) flow += b_.flow_held;
    simulated_ = filtered(flow.cwiseQuotient(capacity_) + b_.relaxation_per_s.cwiseProduct(b_.state), true);
  }

  Eigen::VectorXd residual() const override { return average_(b_.measured - simulated_); }

  Eigen::VectorXd column(const plant::Direction& direction) const override {
    using Kind = plant::BalancePart::Kind;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(b_.rows->size());
    for (const plant::BalancePart& part : direction) {
      const PartValues values(part);
      switch (part.kind) {
        case Kind::flow_sampled:
        case Kind::flow_held:
          sum += part.factor * filtered(values().cwiseQuotient(capacity_), false);
          break;
        case Kind::store:
          sum += part.factor * stored(values(), part.weight);
          break;
        case Kind::reading:
          sum += part.factor * values();
          break;
        case Kind::reading_late:
          sum += part.factor *
                 (plant::lagged(simulated_, part.delay_s, false, b_.rows->t_s, b_.rows->runs) - simulated_);
          break;
      }
    }
    return average_(sum);
  }

  Eigen::MatrixXd starts() const override {
    const auto& runs = b_.rows->runs;
    const Eigen::Index count = static_cast<Eigen::Index>(runs.size());
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(b_.rows->size(), count <= most_starts_ ? count : 0);
    for (Eigen::Index r = 0; r < out.cols(); ++r) {
      double left = 1.0;
      const RunSpan& run = runs[static_cast<std::size_t>(r)];
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        out(i, r) = left;
        left *= kept_[i];
      }
    }
    return average_(out);
  }
  Eigen::VectorXi stretches(int folds) const override { return average_.folds(folds); }
  double floor() const override {
    const double sigma = state_noise(b_);
    return sigma * sigma * static_cast<double>(average_.rows()) / static_cast<double>(average_.stride());
  }

private:
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
  Eigen::VectorXd kept_;  // of a state after each row's interval, if nothing flows: 0..1
  Eigen::VectorXd simulated_;
};

/// Integrals against test functions of one or several widths, each in units of its noise.
class WeakProjection : public Projection {
public:
  /// Keeps a reference to `balance`, which must outlive it.
  WeakProjection(const plant::Balance& balance, const LocalisationThresholds& limit)
      : b_(balance), capacity_(capacity_of(balance)) {
    const double state = state_noise(balance) * capacity_.cwiseAbs().mean();
    const double flow = balance.flow_measured.size() > 0
                            ? plant::sample_noise(balance.flow_measured, balance.rows->runs)
                            : 0.0;
    Eigen::VectorXd needed = balance.measured;
    if (balance.flow_measured.size() > 0) needed += balance.flow_measured;
    for (const int half_width : balance.half_widths) {
      Width width{TestFunctions(balance.rows, needed, half_width,
                                widths_.empty() ? limit.narrow_functions : limit.wide_functions),
                  {},
                  1.0};
      width.held = width.functions.held_weights(balance.held_delay_s);
      width.weight =
          1.0 / std::hypot(state * width.functions.derivative_gain(), flow * width.functions.integral_gain());
      rows_ += width.functions.size();
      widths_.push_back(std::move(width));
    }
  }

  Eigen::VectorXd residual() const override {
    return joined([&](const Width& width) {
      const TestFunctions& f = width.functions;
      Eigen::VectorXd left =
          f.integral(capacity_).cwiseProduct(f.derivative(b_.state)) - f.integral(b_.flow_sampled);
      if (b_.flow_held.size() > 0) left -= f.integral(width.held, b_.flow_held);
      return left;
    });
  }

  Eigen::VectorXd column(const plant::Direction& direction) const override {
    using Kind = plant::BalancePart::Kind;
    return joined([&](const Width& width) {
      const TestFunctions& f = width.functions;
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(f.size());
      for (const plant::BalancePart& part : direction) {
        const PartValues values(part);
        switch (part.kind) {
          case Kind::flow_sampled:
            sum += part.factor * f.integral(values());
            break;
          case Kind::flow_held:
            sum += part.factor * (part.delay_s == 0.0
                                      ? f.integral(width.held, values())
                                      : f.held_integral(values(), b_.held_delay_s + part.delay_s));
            break;
          case Kind::store: {
            Eigen::VectorXd taken = f.integral(capacity_).cwiseProduct(f.derivative(values()));
            if (part.weight.size() > 0) taken = taken.cwiseProduct(f.integral(part.weight));
            sum -= part.factor * taken;
            break;
          }
          case Kind::reading:
          case Kind::reading_late:
            break;  // of the other forms
        }
      }
      return sum;
    });
  }

  Eigen::MatrixXd starts() const override { return Eigen::MatrixXd(rows_, 0); }

  Eigen::VectorXi stretches(int folds) const override {
    Eigen::VectorXi fold(rows_);
    Eigen::Index at = 0;
    for (const Width& width : widths_)
      for (const auto& one : width.functions.list())
        fold[at++] = static_cast<int>(static_cast<double>(one.begin) * folds /
                                      static_cast<double>(std::max<Eigen::Index>(1, b_.rows->size())));
    return fold;
  }
  double floor() const override { return static_cast<double>(rows_); }

private:
  struct Width {
    TestFunctions functions;
    TestFunctions::HeldWeights held;  // at the balance's own delay
    double weight;
  };

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
  switch (balance.form) {
    case plant::BalanceForm::algebraic:
      return std::make_unique<AlgebraicProjection>(balance, limit);
    case plant::BalanceForm::filtered:
      return std::make_unique<FilteredProjection>(balance, limit);
    case plant::BalanceForm::weak:
      return std::make_unique<WeakProjection>(balance, limit);
  }
  return nullptr;
}

/// The directions of a freedom; of a scan those that leave least.
inline Block block_of(const plant::Freedom& freedom, const Projection& projection, const Problem& problem) {
  Block block;
  block.lower = freedom.least;
  block.penalty = freedom.penalty;
  if (freedom.scan.empty()) {
    block.columns = projection.columns(freedom.directions(0.0));
    return block;
  }
  double least = std::numeric_limits<double>::infinity();
  const auto attempt = [&](double at) {
    Eigen::MatrixXd columns = projection.columns(freedom.directions(at));
    const double left = sum_of_squares_left(problem, columns);
    if (!(left < least)) return;
    least = left;
    block.columns = std::move(columns);
    block.at = at;
  };
  for (const double at : freedom.scan) attempt(at);
  const double coarse = block.at;
  for (const double factor : freedom.refine) attempt(coarse * factor);
  if (block.columns.size() == 0) block.columns = Eigen::MatrixXd::Zero(problem.y.size(), 1);
  return block;
}

/// The residual of a balance with what its constants may take from it.
/// @param slack  how far a constant may be off, as a fraction
inline Problem problem_of(const plant::Balance& balance, const Projection& projection, double slack) {
  Problem problem;
  problem.slack = slack;
  problem.y = projection.residual();
  std::vector<Eigen::VectorXd> moved;
  for (const plant::ConstantDirection& constant : balance.constants) {
    const plant::Direction direction = constant.direction();
    if (!direction.empty()) moved.push_back(projection.column(direction));
  }
  problem.nuisance.resize(problem.y.size(), static_cast<Eigen::Index>(moved.size()));
  for (std::size_t k = 0; k < moved.size(); ++k)
    problem.nuisance.col(static_cast<Eigen::Index>(k)) = moved[k];
  problem.free = projection.starts();
  assert(problem.free.rows() == problem.y.size());
  problem.fold = projection.stretches(problem.folds);
  assert(problem.fold.size() == problem.y.size());
  return problem;
}

}  // namespace thermopower::gap::engine
