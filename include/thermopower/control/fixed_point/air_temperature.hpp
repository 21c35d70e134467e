// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../fixed_point/units.hpp"
#include "../air_temperature.hpp"

/// @file control/fixed_point/air_temperature.hpp
/// Air temperature from two thermometers that give whole degrees, eq 4.20: thermopower::AirTemperature in whole numbers.

namespace thermopower {
namespace fixed_point {

/// What thermopower::AirTemperature::Config::standard() has. A set of your own has the same functions.
/// @ingroup control
struct StandardAir {
  /// Below this a reading is rejected. -60 or more.
  static constexpr int8_t minimum_plausible_C() { return -40; }
  /// Above this a reading is rejected. 125 or less.
  static constexpr int8_t maximum_plausible_C() { return 85; }
  /// Further apart than this the two are not averaged.
  static constexpr uint8_t maximum_difference_K() { return 15; }
};

/// Fuses two thermometers as thermopower::AirTemperature does, whose documentation says why.
/// @tparam Constants  StandardAir, or your own
/// @ingroup control
template <class Constants = StandardAir>
class AirTemperature {
  static_assert(Constants::minimum_plausible_C() >= -60 && Constants::maximum_plausible_C() <= 125 &&
                    Constants::minimum_plausible_C() < Constants::maximum_plausible_C(),
                "thermopower: plausible air for a fixed-point model must be within -60 .. 125 degC");

public:
  /// What one logs.
  struct State {
    CoarseTemperature air;  ///< The last plausible air temperature; 0 degC before there was one.
    AirSource source;  ///< Which thermometers the last reading rests on; `neither` keeps `air` as it was.
  };

  /// @param camera_C  thermometer of the camera's IMU
  /// @param frame_C   of the frame's IMU; an implausible one is as good as none
  const State& step(int8_t camera_C, int8_t frame_C) noexcept {
    const bool camera = is_plausible(camera_C), frame = is_plausible(frame_C);
    const int16_t difference = static_cast<int16_t>(camera_C - frame_C);
    state_.source = AirSource::neither;
    if (!camera && !frame) return state_;
    int16_t doubled = static_cast<int16_t>(2 * (camera && (!frame || difference > 0) ? camera_C : frame_C));
    state_.source = camera ? (frame ? AirSource::warmer : AirSource::camera) : AirSource::frame;
    if (state_.source == AirSource::warmer && frame_C != 0 &&
        difference <= Constants::maximum_difference_K() &&
        difference >= -static_cast<int16_t>(Constants::maximum_difference_K())) {
      doubled = static_cast<int16_t>(camera_C + frame_C);
      state_.source = AirSource::both;
    }
    state_.air = static_cast<CoarseTemperature>(doubled * 64);
    return state_;
  }

  const State& state() const noexcept { return state_; }  ///< After the last step.

private:
  static bool is_plausible(int8_t reading_C) noexcept {
    return reading_C >= Constants::minimum_plausible_C() && reading_C <= Constants::maximum_plausible_C();
  }

  State state_ = {0, AirSource::neither};
};

}  // namespace fixed_point
}  // namespace thermopower
