// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/instance.hpp>
#include <thermopower/plant/rows.hpp>

namespace thermopower::plant {

/// The values of the states that effects bring to the joint. Copies no more than there are.
///
/// How the whole works: @ref gap_method.
template <class Scalar>
struct OwnValues {
  int count = 0;               ///< of the states that there are
  Scalar at[most_own_states];  ///< in the order of the effects; beyond `count` unset

  OwnValues() {}  // NOLINT: what is beyond the count stays unset
  /// Copies what is set.
  OwnValues(const OwnValues& other) { *this = other; }
  /// Copies what is set.
  OwnValues& operator=(const OwnValues& other) {
    count = other.count;
    for (int i = 0; i < count; ++i) at[i] = other.at[i];
    return *this;
  }
};

/// The state of an axis. The far side is stated relative to the near one: 0 while the spring is relaxed.
template <class Scalar>
struct AxisState {
  Scalar angle_rad;             ///< of the driven inertia
  Scalar rate_rad_per_s;        ///< its derivative
  Scalar twist_rad;             ///< far side minus near side; unused on a rigid axis
  Scalar twist_rate_rad_per_s;  ///< its derivative
  OwnValues<Scalar> own = {};   ///< states of the effects' own
  int touching = 0;             ///< the end of the free play at which the sides touch; AxisStep keeps it
};

/// The inputs of an axis over an interval.
template <class Scalar>
struct AxisDrive {
  Scalar torque_Nm;          ///< after the drive's own effects; of a motor at a voltage, at standstill
  double motor_C = missing;  ///< recorded; NaN where it is not
  double external_Nm = 0.0;  ///< recorded torque on the driven inertia
  Scalar back_Nms_per_rad =
      constant<Scalar>(0.0);  ///< what a motor at a voltage loses of its torque by its rate
};

}  // namespace thermopower::plant
