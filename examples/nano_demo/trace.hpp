// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "rig.hpp"
#include "story.hpp"

namespace nano {

/// One axis at one update.
struct AxisPoint {
  double error_deg;  ///< Folded to half a turn.
  std::uint8_t demand, power, p_gain;
  double estimate_C;  ///< What the chip believes.
  double true_C;      ///< What the motor is.
  thermopower::LimitReason reason;
};

/// One update.
struct Point {
  double time_s;
  std::uint64_t response_cycles;
  std::array<AxisPoint, 3> axes;
};

/// The run as a person wants to see it. The chip's estimates and reasons are those of the same controller,
/// run here on the telemetry the chip received; `agreeing` says how often its commands are the chip's.
struct Trace {
  std::vector<Point> points;
  std::size_t agreeing = 0;

  static Trace of(const Rig& rig, const Story& story);
  std::string csv() const;
  std::string svg() const;  ///< picture.cpp
};

/// A reason in words.
const char* words(thermopower::LimitReason reason);

}  // namespace nano
