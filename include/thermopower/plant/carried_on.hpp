// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/segment.hpp>

#include <Eigen/Core>

#include <utility>

namespace thermopower::plant::detail {

/// The state that a rollout carries from one segment of a recording into the next. The segment that was rolled last may be
/// rolled again: it gets what it got the first time.
template <class State>
class CarriedOn {
public:
  /// @param nothing  what is carried into the first segment
  explicit CarriedOn(State nothing = State()) : into_(nothing), out_(std::move(nothing)) {}

  /// The state carried into a segment. The reference holds until the next call.
  const State& into(const Segment& segment) {
    const bool again = inputs_ == segment.inputs && begin_ == segment.begin;
    if (!again) into_ = out_;
    inputs_ = segment.inputs;
    begin_ = segment.begin;
    return into_;
  }

  /// Leaves what the segment that was asked for last carries out.
  void leave(State state) { out_ = std::move(state); }

private:
  State into_, out_;
  const Inputs* inputs_ = nullptr;
  Eigen::Index begin_ = 0;
};

}  // namespace thermopower::plant::detail
