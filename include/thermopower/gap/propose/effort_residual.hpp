// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/propose/effort_rows.hpp>
#include <thermopower/gap/propose/low_pass.hpp>
#include <thermopower/gap/propose/thresholds.hpp>
#include <thermopower/plant/axis_effort.hpp>
#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/instance.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file effort_residual.hpp
/// Effort that was measured less the effort that the plant needs for the measured motion.

namespace thermopower::gap::engine {

/// Constants and effects that a needed effort is computed with.
struct EffortPoint {
  std::vector<double> factors;                      ///< of Model::calibrated(), as ParameterPoint has them
  std::vector<plant::AddedEffect<double>> effects;  ///< that act besides the model's own
};

/// A number of an EffortPoint that a fit moves.
struct EffortCoordinate {
  bool is_constant = false;   ///< a factor; else a parameter
  std::size_t constant = 0;   ///< place among the factors
  std::size_t effect = 0;     ///< place among the effects
  std::size_t parameter = 0;  ///< place among its parameters

  /// The number.
  double& of(EffortPoint& point) const {
    assert(is_constant ? constant < point.factors.size() : effect < point.effects.size());
    return is_constant ? point.factors[constant] : point.effects[effect].parameters[parameter];
  }
};

/// The residuals at the rows that count.
struct EffortResiduals {
  Eigen::VectorXd effort;     ///< measured less needed, A or V
  Eigen::MatrixXd jacobian;   ///< its derivatives by the coordinates; empty where not asked for
  Eigen::Index flat = 0;      ///< rows at which another effort would not change the torque
  std::vector<bool> is_flat;  ///< of each row
};

/// The rows of one part of the data at which residuals are compared. They move, are away from the ends, and are as many as
/// the low-pass leaves independent.
struct ComparedRows {
  std::vector<Eigen::Index> rows;  ///< of the grid
  std::vector<std::size_t> piece;  ///< of each
  Eigen::VectorXd effort;          ///< measured, A or V
  double effort_rms = 0.0;         ///< of that

  /// How many there are.
  Eigen::Index size() const { return static_cast<Eigen::Index>(rows.size()); }
};

/// Computes residuals of effort.
class EffortResidual {
public:
  /// Keeps references: all must outlive this object.
  /// @param rest_rad_per_s  slower rows rest
  /// @param early_samples   by which an effort's stamp is ahead of a held one's: 0.5 where it is measured at its stamp
  EffortResidual(const Model& model, const Catalogue& catalogue, const EffortRows& rows,
                 double rest_rad_per_s, double early_samples)
      : model_(model),
        catalogue_(catalogue),
        rows_(rows),
        still_rad_per_s_(rest_rad_per_s / propose_thresholds.rest),
        early_samples_(early_samples) {
    std::vector<double> effort;
    for (std::size_t k = 0; k < rows.pieces.size(); ++k) {
      const EffortPiece& piece = rows.pieces[k];
      const Eigen::Index edge = propose_thresholds.at_the_edge;
      for (Eigen::Index row = piece.begin + edge; row < piece.end - edge;
           row += propose_thresholds.rows_between) {
        if (!(std::abs(rows.rate_rad_per_s[row]) > rest_rad_per_s)) continue;
        compared_.rows.push_back(row);
        compared_.piece.push_back(k);
        effort.push_back(rows.effort(piece, row, -early_rows(piece)));
      }
    }
    compared_.effort =
        Eigen::Map<const Eigen::VectorXd>(effort.data(), static_cast<Eigen::Index>(effort.size()));
    assert(compared_.rows.size() == compared_.piece.size());
    compared_.effort_rms =
        effort.empty() ? 0.0 : std::sqrt(compared_.effort.squaredNorm() / static_cast<double>(effort.size()));
  }

  /// The rows that are compared.
  const ComparedRows& compared() const { return compared_; }
  /// All rows.
  const EffortRows& rows() const { return rows_; }
  /// Rate below which the sign of the motion is not known, rad/s.
  double still_rad_per_s() const { return still_rad_per_s_; }

  /// Current at standstill per unit of effort: 1 of a current, 1/ohm of a voltage.
  double ampere_per_effort() const {
    return model_.axis->voltage_driven() ? 1.0 / model_.axis->resistance_ohm : 1.0;
  }

  /// Residuals at a point, at the compared rows.
  /// @param free  coordinates that derivatives are wanted of; empty: none
  EffortResiduals evaluate(const EffortPoint& point, const std::vector<EffortCoordinate>& free) const {
    EffortResiduals all;
    const Eigen::Index n = rows_.rows(), columns = static_cast<Eigen::Index>(free.size());
    Eigen::VectorXd effort(n);
    Eigen::MatrixXd slopes(n, columns);
    std::vector<bool> flat(static_cast<std::size_t>(n), false);
    in_passes(free, [&](auto scalar, const std::vector<EffortCoordinate>& some, Eigen::Index first) {
      typedef decltype(scalar) Scalar;
      const Needed<Scalar> needed(*this, point, some);
      Eigen::MatrixXd part(n, static_cast<Eigen::Index>(some.size()));
      for (const EffortPiece& piece : rows_.pieces)
        for (Eigen::Index row = piece.begin; row < piece.end; ++row)
          flat[static_cast<std::size_t>(row)] = needed.at(piece, row, effort, part, row);
      slopes.middleCols(first, part.cols()) = part;
    });
    const LowPass low_pass(propose_thresholds.residual_cutoff);
    for (const EffortPiece& piece : rows_.pieces) {
      const Eigen::Index length = piece.end - piece.begin;
      low_pass(effort.segment(piece.begin, length));
      for (Eigen::Index c = 0; c < columns; ++c) low_pass(slopes.col(c).segment(piece.begin, length));
    }
    const Eigen::Index kept = compared_.size();
    assert(kept <= n);
    all.effort.resize(kept);
    all.jacobian.resize(kept, columns);
    all.is_flat.resize(static_cast<std::size_t>(kept));
    for (Eigen::Index i = 0; i < kept; ++i) {
      const Eigen::Index row = compared_.rows[static_cast<std::size_t>(i)];
      all.effort[i] = effort[row];
      all.jacobian.row(i) = slopes.row(row);
      all.is_flat[static_cast<std::size_t>(i)] = flat[static_cast<std::size_t>(row)];
      all.flat += flat[static_cast<std::size_t>(row)];
    }
    return all;
  }

  /// The same at some of the compared rows, with unfiltered residuals: to compare starts by.
  EffortResiduals glance(const EffortPoint& point, const std::vector<EffortCoordinate>& free) const {
    const Eigen::Index every = std::max<Eigen::Index>(1, compared_.size() / propose_thresholds.scan_rows);
    const Eigen::Index kept = compared_.size() / every, columns = static_cast<Eigen::Index>(free.size());
    EffortResiduals all;
    all.effort.resize(kept);
    all.jacobian.resize(kept, columns);
    in_passes(free, [&](auto scalar, const std::vector<EffortCoordinate>& some, Eigen::Index first) {
      typedef decltype(scalar) Scalar;
      const Needed<Scalar> needed(*this, point, some);
      Eigen::MatrixXd part(kept, static_cast<Eigen::Index>(some.size()));
      Eigen::Index flat = 0;
      for (Eigen::Index i = 0; i < kept; ++i) {
        const std::size_t at = static_cast<std::size_t>(i * every);
        flat += needed.at(rows_.pieces[compared_.piece[at]], compared_.rows[at], all.effort, part, i);
      }
      all.flat = flat;
      all.jacobian.middleCols(first, part.cols()) = part;
    });
    return all;
  }

  /// From effort to torque in s at a point, the servo's own delay included.
  double delay_s(const EffortPoint& point) const {
    const plant::Instance<double> instance(model_, point.factors, point.effects, catalogue_);
    return delay_of(instance);
  }

private:
  double early_rows(const EffortPiece& piece) const { return 2.0 * early_samples_ * piece.half_sample; }

  template <class Scalar>
  static Scalar delay_of(const plant::Instance<Scalar>& instance) {
    const auto& shape = instance.axis_structure;
    return shape.delayed ? shape.delay_s : plant::constant<Scalar>(0.0);
  }

  /// Derivatives by more coordinates than a scalar carries are taken in passes. Direction 0 is the effort's.
  template <class Use>
  static void in_passes(const std::vector<EffortCoordinate>& free, Use&& use) {
    constexpr std::size_t most = static_cast<std::size_t>(plant::wide_dual_width) - 1;
    for (std::size_t first = 0; first == 0 || first < free.size(); first += most) {
      const auto from = free.begin() + static_cast<std::ptrdiff_t>(first);
      const std::vector<EffortCoordinate> some(
          from, from + static_cast<std::ptrdiff_t>(std::min(most, free.size() - first)));
      with_scalar(static_cast<Eigen::Index>(some.size()),
                  [&](auto scalar) { use(scalar, some, static_cast<Eigen::Index>(first)); });
    }
  }

  template <class Use>
  static void with_scalar(Eigen::Index directions, Use&& use) {
    if (directions == 0) use(0.0);
    else if (directions < plant::dual_width) use(plant::Dual());
    else use(plant::WideDual());
  }

  /// The effort that a motion needs, at one point. Direction 0 of the scalar is the effort itself.
  template <class Scalar>
  class Needed {
  public:
    Needed(const EffortResidual& of, const EffortPoint& point, const std::vector<EffortCoordinate>& free)
        : of_(of),
          directions_(static_cast<int>(free.size())),
          plain_instance_(of.model_, point.factors, point.effects, of.catalogue_),
          instance_(of.model_, factors(point, free), effects(point, free), of.catalogue_),
          plain_(plain_instance_, of.rows_.grid, of.still_rad_per_s_),
          exact_(instance_, of.rows_.grid, of.still_rad_per_s_),
          per_effort_(std::abs(plain_.torque_per_effort())) {}

    /// Writes the residual at a row, and its derivatives, to line `to`. Returns whether the drive is flat there.
    bool at(const EffortPiece& piece, Eigen::Index row, Eigen::VectorXd& effort, Eigen::MatrixXd& slopes,
            Eigen::Index to) const {
      const plant::MotionAtRow motion{row, of_.rows_.grid.t_s[row], of_.rows_.angle_rad[row],
                                      of_.rows_.rate_rad_per_s[row], of_.rows_.acceleration_rad_per_s2[row]};
      const double late = plant::value_of(delay_of(instance_)) / piece.interval_s - of_.early_rows(piece);
      const double measured = of_.rows_.effort(piece, row, late);
      const double step = 1e-3 * of_.compared_.effort_rms + 1e-12;
      // Newton's steps; a drive that is flat is left by steps of limited length.
      double needed = measured, slope = 0.0, left = 0.0;
      for (int i = 0; i < 4; ++i) {
        left = plain_.surplus_Nm(needed, motion);
        if (i > 0 && std::abs(left) < 1e-2 * step * per_effort_) break;
        slope = (plain_.surplus_Nm(needed + step, motion) - left) / step;
        const double least = propose_thresholds.flat * per_effort_;
        needed -= left / (std::abs(slope) > least ? slope : least);
        if (!is_bent()) break;
      }
      const bool flat = is_bent() && std::abs(slope) < propose_thresholds.flat * per_effort_;
      if (flat) {
        needed = measured - plain_.surplus_Nm(measured, motion) / per_effort_;
        slope = per_effort_;
      }
      effort[to] = measured - needed;
      if (directions_ == 0) return flat;
      Scalar at = plant::constant<Scalar>(flat ? measured : needed);
      plant::seed(at, 0);
      const Scalar balance = exact_.surplus_Nm(at, motion);
      const double by_effort = plant::derivative_of(balance, 0);
      const double per =
          flat || std::abs(by_effort) < 1e-9 * per_effort_ ? 1.0 / per_effort_ : 1.0 / by_effort;
      const Scalar delay = delay_of(instance_);
      const double by_delay = instance_.axis_structure.delayed
                                  ? of_.rows_.effort_slope(piece, row, late) / piece.interval_s
                                  : 0.0;
      for (int k = 0; k < directions_; ++k)
        slopes(to, k) =
            plant::derivative_of(balance, k + 1) * per + by_delay * plant::derivative_of(delay, k + 1);
      return flat;
    }

  private:
    /// Whether torque need not be straight in effort.
    bool is_bent() const { return !plain_instance_.drive.empty() || !plain_instance_.friction.empty(); }

    static std::vector<Scalar> factors(const EffortPoint& point, const std::vector<EffortCoordinate>& free) {
      std::vector<Scalar> list(point.factors.begin(), point.factors.end());
      for (std::size_t k = 0; k < free.size(); ++k) {
        assert(!free[k].is_constant || free[k].constant < list.size());
        if (free[k].is_constant) plant::seed(list[free[k].constant], static_cast<int>(k) + 1);
      }
      return list;
    }

    static std::vector<plant::AddedEffect<Scalar>> effects(const EffortPoint& point,
                                                           const std::vector<EffortCoordinate>& free) {
      std::vector<plant::AddedEffect<Scalar>> list;
      for (const plant::AddedEffect<double>& one : point.effects)
        list.push_back({one.entry, std::vector<Scalar>(one.parameters.begin(), one.parameters.end())});
      for (std::size_t k = 0; k < free.size(); ++k) {
        if (free[k].is_constant) continue;
        assert(free[k].effect < list.size() && free[k].parameter < list[free[k].effect].parameters.size());
        plant::seed(list[free[k].effect].parameters[free[k].parameter], static_cast<int>(k) + 1);
      }
      return list;
    }

    const EffortResidual& of_;
    const int directions_;
    const plant::Instance<double> plain_instance_;
    const plant::Instance<Scalar> instance_;
    const plant::AxisEffort<double> plain_;
    const plant::AxisEffort<Scalar> exact_;
    const double per_effort_;
  };

  const Model& model_;
  const Catalogue& catalogue_;
  const EffortRows& rows_;
  const double still_rad_per_s_;
  const double early_samples_;
  ComparedRows compared_;
};

}  // namespace thermopower::gap::engine
