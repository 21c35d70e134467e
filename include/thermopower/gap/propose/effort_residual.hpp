// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/statistical_model.hpp>
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

/// A number of an EffortPoint that a fit moves, and what is known of it.
struct EffortCoordinate {
  bool is_constant = false;   ///< a factor; else a parameter
  std::size_t constant = 0;   ///< place among the factors
  std::size_t effect = 0;     ///< place among the effects
  std::size_t parameter = 0;  ///< place among its parameters
  double lower = 0.0;         ///< of the number
  double upper = 0.0;         ///< of the number
  bool logarithmic = false;   ///< a parameter that moves by factors
  bool is_place = false;      ///< a constant that is off by a difference
  Prior prior;                ///< of a constant's logarithm or place; none of a parameter
  double first_reach = 0.0;   ///< of a constant: standard deviation of where the first step looks for it

  /// The number.
  double& of(EffortPoint& point) const {
    assert(is_constant ? constant < point.factors.size() : effect < point.effects.size());
    return is_constant ? point.factors[constant] : point.effects[effect].parameters[parameter];
  }

  /// What the prior is on: the logarithm of a factor, else the number.
  double away(double number) const { return is_place || !is_constant ? number : std::log(number); }

  /// Change of that per change of the number; a factor near 0 is not held there.
  double away_per_number(double number) const {
    constexpr double least = 0.1;
    return is_place || !is_constant ? 1.0 : 1.0 / std::max(number, least);
  }
};

/// Residuals of effort at some rows.
struct EffortResiduals {
  Eigen::VectorXd effort;     ///< measured less needed, A or V
  Eigen::MatrixXd jacobian;   ///< its derivatives by the coordinates; no columns where not asked for
  std::vector<bool> is_flat;  ///< of each row: another effort would not change the torque

  /// Rows that are flat.
  double flat() const { return static_cast<double>(std::count(is_flat.begin(), is_flat.end(), true)); }
};

/// A row of the grid.
struct EffortRow {
  std::size_t piece = 0;  ///< it is of
  Eigen::Index row = 0;   ///< of the grid
};

/// The rows of one part of the data at which residuals are compared. They move, are away from the ends, and are as many as
/// the low-pass leaves independent.
struct ComparedRows {
  std::vector<EffortRow> rows;  ///< in order
  Eigen::VectorXd effort;       ///< measured, A or V
  double effort_rms = 0.0;      ///< of that

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
    constexpr Eigen::Index edge = propose_thresholds.at_the_edge;
    for (std::size_t k = 0; k < rows.pieces.size(); ++k) {
      const EffortPiece& piece = rows.pieces[k];
      for (Eigen::Index row = piece.begin; row < piece.end; ++row) all_.push_back({k, row});
      for (Eigen::Index row = piece.begin + edge; row < piece.end - edge;
           row += propose_thresholds.rows_between) {
        if (!(std::abs(rows.rate_rad_per_s[row]) > rest_rad_per_s)) continue;
        compared_.rows.push_back({k, row});
        compared_in_all_.push_back(static_cast<Eigen::Index>(all_.size()) - (piece.end - row));
        effort.push_back(rows.effort(piece, row, -early_rows(piece)));
      }
    }
    compared_.effort =
        Eigen::Map<const Eigen::VectorXd>(effort.data(), static_cast<Eigen::Index>(effort.size()));
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
    EffortResiduals all = unfiltered(point, free, all_);
    constexpr double cutoff = propose_thresholds.residual_cutoff;
    Eigen::Index begin = 0;
    for (const EffortPiece& piece : rows_.pieces) {
      low_pass(all.effort.segment(begin, piece.rows()), cutoff);
      for (Eigen::Index c = 0; c < all.jacobian.cols(); ++c)
        low_pass(all.jacobian.col(c).segment(begin, piece.rows()), cutoff);
      begin += piece.rows();
    }
    EffortResiduals kept{
        Eigen::VectorXd(compared_.size()), Eigen::MatrixXd(compared_.size(), all.jacobian.cols()), {}};
    for (Eigen::Index i = 0; i < compared_.size(); ++i) {
      const Eigen::Index at = compared_in_all_[static_cast<std::size_t>(i)];
      kept.effort[i] = all.effort[at];
      kept.jacobian.row(i) = all.jacobian.row(at);
      kept.is_flat.push_back(all.is_flat[static_cast<std::size_t>(at)]);
    }
    return kept;
  }

  /// The same at some of the compared rows, with unfiltered residuals: to compare starts by.
  EffortResiduals glance(const EffortPoint& point, const std::vector<EffortCoordinate>& free) const {
    const std::size_t size = compared_.rows.size();
    const std::size_t every = std::max<std::size_t>(1, size / propose_thresholds.scan_rows);
    std::vector<EffortRow> some;
    for (std::size_t k = 0; k < size / every; ++k) some.push_back(compared_.rows[k * every]);
    return unfiltered(point, free, some);
  }

private:
  double early_rows(const EffortPiece& piece) const { return 2.0 * early_samples_ * piece.half_sample; }

  template <class Scalar>
  static Scalar delay_of(const plant::Instance<Scalar>& instance) {
    const auto& shape = instance.axis_structure;
    return shape.delayed ? shape.delay_s : plant::constant<Scalar>(0.0);
  }

  /// Residuals at some rows. Derivatives by more coordinates than a scalar carries are taken in passes; direction 0 is the effort's.
  EffortResiduals unfiltered(const EffortPoint& point, const std::vector<EffortCoordinate>& free,
                             const std::vector<EffortRow>& at) const {
    constexpr std::size_t most = static_cast<std::size_t>(plant::wide_dual_width) - 1;
    const Eigen::Index count = static_cast<Eigen::Index>(at.size());
    EffortResiduals all{Eigen::VectorXd(count),
                        Eigen::MatrixXd(count, static_cast<Eigen::Index>(free.size())),
                        std::vector<bool>(at.size())};
    for (std::size_t first = 0; first == 0 || first < free.size(); first += most) {
      const std::vector<EffortCoordinate> some(
          free.begin() + static_cast<std::ptrdiff_t>(first),
          free.begin() + static_cast<std::ptrdiff_t>(std::min(first + most, free.size())));
      with_scalar(static_cast<int>(some.size()), [&](auto scalar) {
        const Needed<decltype(scalar)> needed(*this, point, some);
        Eigen::MatrixXd slopes(count, static_cast<Eigen::Index>(some.size()));
        for (Eigen::Index i = 0; i < count; ++i) {
          const EffortRow& one = at[static_cast<std::size_t>(i)];
          all.is_flat[static_cast<std::size_t>(i)] =
              needed.at(rows_.pieces[one.piece], one.row, all.effort, slopes, i);
        }
        all.jacobian.middleCols(static_cast<Eigen::Index>(first), slopes.cols()) = slopes;
      });
    }
    return all;
  }

  template <class Use>
  static void with_scalar(int directions, Use&& use) {
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
  std::vector<EffortRow> all_;  ///< of the pieces
  ComparedRows compared_;
  std::vector<Eigen::Index> compared_in_all_;  ///< place of each in `all_`
};

}  // namespace thermopower::gap::engine
