// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/propose/effort_residual.hpp>
#include <thermopower/gap/propose/effort_rows.hpp>
#include <thermopower/gap/propose/thresholds.hpp>
#include <thermopower/plant/catalogue.hpp>

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace thermopower::gap::engine {

/// Rate below which rows rest, rad/s.
inline double rest_rate(const EffortRows& rows) {
  const Eigen::VectorXd& rate = rows.rate_rad_per_s;
  const double rms = rate.size() > 0 ? std::sqrt(rate.squaredNorm() / static_cast<double>(rate.size())) : 0.0;
  return propose_thresholds.rest * (std::max(propose_thresholds.still_share * rms, rows.rate_noise) + 1e-9);
}

/// A fit of inertia, drag, friction, gravity and a constant to effort: a first look that tells how the data must be
/// filtered.
class PlainFit {
public:
  /// @param rows  of training data; model and catalogue read the instruments
  PlainFit(const Model& model, const Catalogue& catalogue, const EffortRows& rows) {
    for (const double candidate : {0.0, 0.5}) {
      const EffortResidual data(model, catalogue, rows, rest_rate(rows), candidate);
      const ComparedRows& compared = data.compared();
      const Eigen::Index n = compared.size();
      if (n < propose_thresholds.least_residuals || !(compared.effort_rms > 0.0)) return;
      Eigen::MatrixXd columns(n, 6);
      for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Index row = compared.rows[static_cast<std::size_t>(i)].row;
        const double rate = rows.rate_rad_per_s[row], angle = rows.angle_rad[row];
        columns.row(i) << rows.acceleration_rad_per_s2[row], rate, std::tanh(rate / data.still_rad_per_s()),
            1.0, std::sin(angle), std::cos(angle);
      }
      const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(columns);
      const Eigen::VectorXd found = solver.solve(compared.effort);
      const double square = (compared.effort - columns * found).squaredNorm() / static_cast<double>(n);
      if (is_known_ && square >= (1.0 - propose_thresholds.stamped) * residual_square_) continue;
      is_known_ = true;
      early_samples_ = candidate;
      residual_square_ = square;
      effort_square_ = compared.effort_rms * compared.effort_rms;
      inertia_ = found[0];
      // Of a coefficient: what its column adds to the others.
      const Eigen::MatrixXd others = columns.rightCols(5);
      const Eigen::VectorXd own =
          columns.col(0) - others * Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(others).solve(columns.col(0));
      inertia_error_ = std::sqrt(square / std::max(own.squaredNorm(), 1e-300));
    }
  }

  /// How many samples an effort's stamp is ahead of a held one's. It is 0 if it holds from its stamp on, and half a sample
  /// if it is a measurement at its stamp. The data say which.
  double early_samples() const { return early_samples_; }

  /// Whether noise of the motion spoils this fit more than one with a lower cutoff. Noise of the acceleration hides the
  /// inertia, so the inertia grows there, or the residual falls by more than the effort does.
  bool is_noisier_than(const PlainFit& lower) const {
    if (!is_known_ || !lower.is_known_) return false;
    const double grown = lower.inertia_ - inertia_;
    const bool hidden = lower.inertia_ > 0.0 && grown > propose_thresholds.hidden_inertia * lower.inertia_ &&
                        grown > propose_thresholds.certain * lower.inertia_error_;
    const double fallen = residual_square_ - lower.residual_square_,
                 less_effort = std::max(0.0, effort_square_ - lower.effort_square_);
    return hidden || (fallen > propose_thresholds.fallen * residual_square_ && fallen > 2.0 * less_effort);
  }

private:
  bool is_known_ = false;
  double early_samples_ = 0.0, residual_square_ = 0.0, effort_square_ = 0.0, inertia_ = 0.0,
         inertia_error_ = 0.0;
};

}  // namespace thermopower::gap::engine
