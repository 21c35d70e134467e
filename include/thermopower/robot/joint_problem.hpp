// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/effort_timing.hpp>
#include <thermopower/robot/family.hpp>
#include <thermopower/robot/joint.hpp>
#include <thermopower/robot/series.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace thermopower::robot {

/// Columns of the regression of one joint.
enum class Regressor : int {
  acceleration,     ///< rad/s2
  velocity,         ///< rad/s
  sign,             ///< direction of motion
  one,              ///< 1
  position,         ///< rad, from the middle of the travel
  gravity,          ///< N m that hold the weight
  moment_a,         ///< N m of 1 kg m off the axis
  moment_b,         ///< the same a quarter of a turn ahead
  stribeck_slow,    ///< direction, gone at a tenth of the usual rate
  stribeck_medium,  ///< direction, gone at a quarter of the usual rate
  stribeck_fast,    ///< direction, gone at six tenths of the usual rate
  load,             ///< direction times the torque of the rigid body
  sign_position,    ///< direction times position
  drag,             ///< rate times its magnitude
  model,            ///< the model's own torque
  ripple_sine,      ///< of the position times the number of cycles
  ripple_cosine,    ///< likewise
  effort,           ///< what is explained, less the model's own torque
};

/// Number of columns, the effort among them.
inline constexpr int regressor_count = 18;

/// @brief A joint as a linear regression: effort from motion, row by row, with the sums that every fit needs.
///
/// The rows near rest are left out: they say nothing of friction. The rest is cut into blocks of equal length; a fit is judged by
/// the blocks that it was not fitted to.
///
/// How to: @ref diagnose_a_robot.
class JointProblem {
public:
  /// @brief Products of the columns, summed over rows.
  using Sums = Eigen::Matrix<double, regressor_count, regressor_count>;

  /// Rates of the Stribeck columns, as a share of the joint's usual rate.
  static constexpr std::array<double, 3> stribeck_shares{0.1, 0.25, 0.6};

  /// Rate within which the direction turns round, as a share of the joint's usual rate.
  static constexpr double sign_share = 0.01;
  /// Rate below which a row is near rest, as a share of the joint's usual rate.
  static constexpr double slow_share = 0.09;

  /// @param series  the log
  /// @param body    what the rigid body asks for, in the same rows
  /// @param index   of the joint
  /// @param joint   its constants; kp and kd count where the log has no effort
  /// @param timing  when the effort acts
  /// @param blocks  number of blocks
  /// @param far_from_rest  leaves out the rows, too, that the filter's reach joins to rows near rest
  JointProblem(const Series& series, const BodyRows& body, Eigen::Index index, const Joint& joint,
               const EffortTiming& timing, int blocks, bool far_from_rest = false)
      : joint_(joint), stretches_(series.stretches), cutoff_(series.cutoff_Hz * series.step_s) {
    const Eigen::Index rows = series.rows();
    const Eigen::VectorXd w = series.motion.velocity.col(index), q = series.motion.position.col(index),
                          a = series.motion.acceleration.col(index);
    usual_rate_ = std::sqrt(w.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, rows)));
    const double noise = series.rate_noise.size() > index ? series.rate_noise[index] : 0.0;
    still_ = std::max(sign_share * usual_rate_, noise) + 1e-9;
    const double slow = std::max(slow_share * usual_rate_, 3.0 * noise) + 1e-9;
    middle_ = 0.5 * (q.minCoeff() + q.maxCoeff());
    span_ = q.maxCoeff() - q.minCoeff();
    const Eigen::ArrayXd sign = (w.array() / still_).tanh();
    const Eigen::ArrayXd speed = w.array().abs();
    const Eigen::VectorXd rigid = body.torque.col(index);
    columns_.resize(rows, regressor_count);
    const auto put = [&](Regressor which, const Eigen::VectorXd& values) {
      columns_.col(static_cast<int>(which)) = values;
    };
    put(Regressor::acceleration, a);
    put(Regressor::velocity, w);
    put(Regressor::sign, smooth(sign));
    put(Regressor::one, Eigen::VectorXd::Ones(rows));
    put(Regressor::position, q.array() - middle_);
    put(Regressor::gravity, body.gravity.col(index));
    put(Regressor::moment_a, body.moment_a.col(index));
    put(Regressor::moment_b, body.moment_b.col(index));
    for (int i = 0; i < 3; ++i)
      columns_.col(static_cast<int>(Regressor::stribeck_slow) + i) = smooth(
          sign * (-speed / (stribeck_shares[static_cast<std::size_t>(i)] * usual_rate_ + 1e-12)).exp());
    put(Regressor::load, smooth(sign * rigid.array().abs()));
    put(Regressor::sign_position, smooth(sign * (q.array() - middle_)));
    put(Regressor::drag, smooth(w.array() * speed));
    const Eigen::VectorXd model = rigid + joint.armature * a + joint.damping * w +
                                  joint.friction * columns_.col(static_cast<int>(Regressor::sign)) +
                                  joint.stiffness * (q.array() - joint.spring_rest).matrix();
    put(Regressor::model, model);
    set_ripple(0);
    inertia_ = std::sqrt((body.inertia.col(index).array() + joint.armature).square().mean());
    const Eigen::VectorXd effort = effort_of(series, index, joint, timing);
    put(Regressor::effort, effort - model);
    effort_ = effort;
    // The filter smears what friction does near rest over so many rows.
    const auto reach = far_from_rest ? static_cast<Eigen::Index>(std::ceil(0.5 / cutoff_)) : 0;
    std::vector<char> slow_near(static_cast<std::size_t>(rows), 0);
    for (const Stretch& one : stretches_)
      for (Eigen::Index i = one.begin; i < one.end; ++i) {
        if (speed[i] > slow) continue;
        for (Eigen::Index k = std::max(one.begin, i - reach); k <= std::min(one.end - 1, i + reach); ++k)
          slow_near[static_cast<std::size_t>(k)] = 1;
      }
    std::vector<Eigen::Index> good;
    for (Eigen::Index i = 0; i < rows; ++i) {
      const bool limited = std::fabs(effort[i]) > 0.98 * joint.effort_limit;
      const auto k = static_cast<std::size_t>(i);
      if (series.edge[k] == 0 && slow_near[k] == 0 && !limited && std::isfinite(effort[i]) &&
          std::isfinite(model[i]))
        good.push_back(i);
    }
    const auto count = static_cast<Eigen::Index>(good.size());
    block_of_.assign(static_cast<std::size_t>(rows), -1);
    block_count_ = blocks;
    for (Eigen::Index i = 0; i < count; ++i)
      block_of_[static_cast<std::size_t>(good[static_cast<std::size_t>(i)])] =
          static_cast<int>(i * blocks / std::max<Eigen::Index>(1, count));
    moving_rows_ = count;
    add_up();
  }

  /// @brief Chooses how many cycles a turn the ripple has; 0 takes it out. add_up() makes the sums anew.
  void set_ripple(int cycles) {
    cycles_ = cycles;
    const Eigen::ArrayXd q = columns_.col(static_cast<int>(Regressor::position)).array() + middle_;
    if (cycles == 0) {
      columns_.col(static_cast<int>(Regressor::ripple_sine)).setZero();
      columns_.col(static_cast<int>(Regressor::ripple_cosine)).setZero();
    } else {
      columns_.col(static_cast<int>(Regressor::ripple_sine)) = smooth((cycles * q).sin());
      columns_.col(static_cast<int>(Regressor::ripple_cosine)) = smooth((cycles * q).cos());
    }
  }

  /// Makes the sums of products of all columns, block by block.
  void add_up() {
    sums_.assign(static_cast<std::size_t>(block_count_), Sums::Zero());
    rows_of_.assign(static_cast<std::size_t>(block_count_), 0);
    for (Eigen::Index i = 0; i < columns_.rows(); ++i) {
      const int block = block_of_[static_cast<std::size_t>(i)];
      if (block < 0) continue;
      const Eigen::Matrix<double, regressor_count, 1> row = columns_.row(i).transpose();
      sums_[static_cast<std::size_t>(block)].selfadjointView<Eigen::Lower>().rankUpdate(row);
      ++rows_of_[static_cast<std::size_t>(block)];
    }
    for (Sums& one : sums_) one = one.selfadjointView<Eigen::Lower>();
  }

  /// The Stribeck column at a rate in rad/s.
  Eigen::VectorXd stribeck_column(double rate) const {
    const Eigen::ArrayXd w = columns_.col(static_cast<int>(Regressor::velocity));
    return smooth((w / still_).tanh() * (-w.abs() / rate).exp());
  }

  /// A ripple of 1 N m: its sine or its cosine.
  Eigen::VectorXd ripple_column(double cycles, bool is_cosine) const {
    const Eigen::ArrayXd angle =
        cycles * (columns_.col(static_cast<int>(Regressor::position)).array() + middle_);
    return smooth(is_cosine ? Eigen::VectorXd(angle.cos()) : Eigen::VectorXd(angle.sin()));
  }

  /// The joint with the constants of the model.
  const Joint& joint() const { return joint_; }
  /// Sums of products of all columns, for each block.
  const std::vector<Sums>& sums() const { return sums_; }
  /// Rows of each block.
  const std::vector<Eigen::Index>& rows_of() const { return rows_of_; }
  /// All columns, row by row, in the order of Regressor.
  const Eigen::MatrixXd& columns() const { return columns_; }
  /// Effort of each row in N m.
  const Eigen::VectorXd& effort() const { return effort_; }
  /// Block of each row; -1 where the row says nothing.
  const std::vector<int>& block_of() const { return block_of_; }
  /// Cycles of the ripple per turn; 0: none is chosen.
  int ripple_cycles() const { return cycles_; }
  /// Root mean square of the velocity in rad/s.
  double usual_rate() const { return usual_rate_; }
  /// Velocity in rad/s below which the direction is not known.
  double still() const { return still_; }
  /// Middle of the travel in rad.
  double middle() const { return middle_; }
  /// Travel in rad.
  double span() const { return span_; }
  /// Apparent inertia in kg m2 with the model's armature, root mean square.
  double inertia() const { return inertia_; }
  /// Rows in which the joint moves.
  Eigen::Index moving_rows() const { return moving_rows_; }

private:
  Eigen::VectorXd smooth(const Eigen::VectorXd& raw) const {
    const ZeroPhaseFilter filter(cutoff_);
    Eigen::VectorXd out(raw.size());
    for (const Stretch& one : stretches_)
      out.segment(one.begin, one.rows()) = filter(raw.segment(one.begin, one.rows()));
    return out;
  }

  Joint joint_;
  std::vector<Stretch> stretches_;
  double cutoff_ = 0.12;
  Eigen::MatrixXd columns_;
  Eigen::VectorXd effort_;
  std::vector<int> block_of_;
  std::vector<Sums> sums_;
  std::vector<Eigen::Index> rows_of_;
  int block_count_ = 0, cycles_ = 0;
  double usual_rate_ = 0.0, still_ = 0.0, middle_ = 0.0, span_ = 0.0, inertia_ = 0.0;
  Eigen::Index moving_rows_ = 0;
};

}  // namespace thermopower::robot
