// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <math.h>
#include <stdint.h>

#include "../../detail/numeric.hpp"
#include "composition.hpp"

/// @file control/detail/gimbal_axes.hpp
/// What a gimbal controller asks of a telemetry message and of its axes.

namespace thermopower {
namespace detail {

/// The highest measurement that agrees with the nominal supply; infinite where the measurement is what counts.
template <class Supply>
auto highest_nominal_V(float nominal_V, int) noexcept -> decltype(nominal_V * Supply::margin()) {
  return nominal_V * (1.0f + Supply::margin());
}
template <class Supply>
float highest_nominal_V(float, long) noexcept {
  return static_cast<float>(INFINITY);
}

/// Whether a board says that it has stopped its motors because of heat; false from a telemetry that does not say.
template <class Telemetry>
auto is_board_overheated(const Telemetry& telemetry, int) noexcept
    -> decltype(static_cast<bool>(telemetry.is_overheated())) {
  return telemetry.is_overheated();
}
template <class Telemetry>
bool is_board_overheated(const Telemetry&, long) noexcept {
  return false;
}

/// Where an axis stands, from a telemetry that says so; NaN from one that does not.
template <class Telemetry>
auto pose_of(const Telemetry& telemetry, uint8_t axis, int) noexcept
    -> decltype(telemetry.imu_angle_deg(axis)) {
  return telemetry.imu_angle_deg(axis);
}
template <class Telemetry>
float pose_of(const Telemetry&, uint8_t, long) noexcept {
  return not_a_number();
}

/// Whether an axis has a law that asks for its pose; what is no axis is refused in a sentence further down.
template <class Axis, bool = IsAxis<Axis>::value>
struct AsksForPose {
  static constexpr bool value = false;
};
template <class Axis>
struct AsksForPose<Axis, true> {
  static constexpr bool value = Axis::takes_pose();
};

/// Whether any axis has a law that asks for its pose.
template <class... Axes>
struct AnyTakesPose {
  static constexpr bool value = false;
};
template <class First, class... Rest>
struct AnyTakesPose<First, Rest...> {
  static constexpr bool value = AsksForPose<First>::value || AnyTakesPose<Rest...>::value;
};

/// The poses of a gimbal's axes; nothing at all where no law asks for them.
template <uint8_t axis_count, bool is_asked>
struct GimbalPoses {
  template <class Telemetry>
  void read_poses(const Telemetry&) noexcept {}
  void clear_poses() noexcept {}
  template <class Axis>
  const typename Axis::State& step_axis(Axis& axis, const typename Axis::Inputs& inputs, uint8_t,
                                        float dt_s) noexcept {
    return axis.step(inputs, dt_s);
  }
};
template <uint8_t axis_count>
struct GimbalPoses<axis_count, true> {
  float pose_deg[axis_count];
  template <class Telemetry>
  void read_poses(const Telemetry& telemetry) noexcept {
    for (uint8_t index = 0; index < axis_count; ++index) pose_deg[index] = pose_of(telemetry, index, 0);
  }
  void clear_poses() noexcept {
    for (uint8_t index = 0; index < axis_count; ++index) pose_deg[index] = not_a_number();
  }
  template <class Axis>
  const typename Axis::State& step_axis(Axis& axis, const typename Axis::Inputs& inputs, uint8_t index,
                                        float dt_s) noexcept {
    return axis.step(inputs, pose_deg[index], dt_s);
  }
};

/// The axes one after the other; a tuple that C++11 without a standard library can have.
template <uint8_t index, class... Axes>
struct AxisChain {
  AxisChain() noexcept {}
  template <class Visitor>
  void visit(Visitor&) noexcept {}
};

template <uint8_t index, class First, class... Rest>
struct AxisChain<index, First, Rest...> : AxisChain<index + 1, Rest...> {
  static_assert(IsAxis<First>::value,
                "thermopower: every parameter of GimbalController must be an AxisController");
  typedef AxisChain<index + 1, Rest...> Next;
  AxisChain() noexcept {}
  explicit AxisChain(const typename First::Config& first, const typename Rest::Config&... rest) noexcept
      : Next(rest...), axis(first) {}
  template <class Visitor>
  void visit(Visitor& visitor) noexcept {
    visitor(index, axis);
    Next::visit(visitor);
  }
  First axis;
};

template <uint8_t index, class First, class... Rest>
First& axis_at(AxisChain<index, First, Rest...>& chain) noexcept {
  return chain.axis;
}
template <uint8_t index, class First, class... Rest>
const First& axis_at(const AxisChain<index, First, Rest...>& chain) noexcept {
  return chain.axis;
}

}  // namespace detail

}  // namespace thermopower
