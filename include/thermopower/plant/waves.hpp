// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/sine_cosine.hpp>

#include <Eigen/Core>

#include <memory>
#include <utility>

namespace thermopower::plant {

/// Sines and cosines of multiples of an angle. Those of a multiple come from those of the one before, which a scan asks for in turn,
/// by the sum of two angles: a few products in place of a polynomial each.
///
/// How the whole works: @ref gap_method.
class Waves {
public:
  /// @param angle  rad; worked out when it is first asked for
  explicit Waves(std::shared_ptr<const Eigen::VectorXd> angle) : angle_(std::move(angle)) {}

  /// The sine and the cosine of so many times the angle, one column each. @param count  1 or more, whole
  Eigen::MatrixXd operator()(double count) {
    if (once_.size() == 0) begin();
    if (count < count_) restart();
    for (; count_ < count; count_ += 1.0) {
      const Eigen::VectorXd sine =
          at_.col(0).cwiseProduct(once_.col(1)) + at_.col(1).cwiseProduct(once_.col(0));
      at_.col(1) = at_.col(1).cwiseProduct(once_.col(1)) - at_.col(0).cwiseProduct(once_.col(0));
      at_.col(0) = sine;
    }
    return at_;
  }

private:
  void begin() {
    once_.resize(angle_->size(), 2);
    for (Eigen::Index i = 0; i < angle_->size(); ++i) {
      const SineCosine at((*angle_)[i]);
      once_(i, 0) = at.sine;
      once_(i, 1) = at.cosine;
    }
    restart();
  }
  void restart() {
    at_ = once_;
    count_ = 1.0;
  }

  std::shared_ptr<const Eigen::VectorXd> angle_;
  Eigen::MatrixXd once_, at_;
  double count_ = 0.0;  ///< of what `at_` holds
};

}  // namespace thermopower::plant
