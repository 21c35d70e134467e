// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../fixed_point/units.hpp"
#include "../../detail/probe.hpp"
#include "../air_temperature.hpp"

/// @file control/fixed_point/air_temperature.hpp
/// Air temperature from two thermometers that give whole degrees, eq 4.20: thermopower::AirTemperature in whole numbers.

namespace thermopower {
namespace fixed_point {

/// What thermopower::AirTemperature::Config::standard() has. A set of your own has the same functions.
///
/// @snippet fixed_point_examples.cpp fixed-point air
/// How to: @ref wire_up_sbgc.
/// @ingroup control
struct StandardAir {
  /// Below this a reading is rejected. -60 or more.
  static constexpr int8_t minimum_plausible_C() { return -40; }
  /// Above this a reading is rejected. 125 or less.
  static constexpr int8_t maximum_plausible_C() { return 85; }
  /// Further apart than this the two are not averaged.
  static constexpr uint8_t maximum_difference_K() { return 15; }
  /// A fall is believed no faster than this, K/s. 0: at once; at most 1.
  static constexpr double fall_per_s() { return 0.2; }
  /// The air is never warmer: no reading makes it colder. Declare your own; -128: readings are believed.
  static constexpr int8_t declared_C() { return 45; }
};
/// The same with thermometers that are believed inside their range.
///
/// @snippet fixed_point_examples.cpp fixed-point air
/// How to: @ref wire_up_sbgc.
/// @ingroup control
struct BelievedAir : StandardAir {
  static constexpr int8_t declared_C() { return -128; }  ///< Readings are believed.
};
/// The same for a program that believes its thermometers, and a fall at once, as the thesis's does.
///
/// @snippet fixed_point_examples.cpp fixed-point air
/// How to: @ref wire_up_sbgc.
/// @ingroup control
struct ProgrammedAir : BelievedAir {
  static constexpr double fall_per_s() { return 0.0; }  ///< At once.
};

}  // namespace fixed_point
namespace detail {
/// Constants of the air: what StandardAir has.
template <class Candidate, class = int>
struct IsAirConstants {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsAirConstants<
    Candidate,
    typename Exists<decltype(Candidate::minimum_plausible_C()), decltype(Candidate::maximum_plausible_C()),
                    decltype(Candidate::maximum_difference_K()), decltype(Candidate::fall_per_s()),
                    decltype(Candidate::declared_C())>::Type> {
  static constexpr bool value = true;
};
}  // namespace detail
namespace fixed_point {

/// Fuses two thermometers as thermopower::AirTemperature does, whose documentation says why.
/// @tparam Constants  StandardAir, or your own
///
/// @snippet fixed_point_examples.cpp fixed-point air
/// How to: @ref wire_up_sbgc.
/// @ingroup control
template <class Constants = StandardAir>
class AirTemperature {
  static_assert(
      thermopower::detail::IsAirConstants<Constants>::value,
      "thermopower: the parameter of AirTemperature must be constants, such as StandardAir or a type derived "
      "from it");
  static_assert(Constants::minimum_plausible_C() >= -60 && Constants::maximum_plausible_C() <= 125 &&
                    Constants::minimum_plausible_C() < Constants::maximum_plausible_C(),
                "thermopower: plausible air for a fixed-point model must be within -60 .. 125 degC");
  static_assert(Constants::declared_C() <= Constants::maximum_plausible_C(),
                "thermopower: declared_C must not be above maximum_plausible_C");

public:
  /// What one logs.
  struct State {
    CoarseTemperature
        air;           ///< The air is no warmer by the last plausible reading; 0 degC before there was one.
    AirSource source;  ///< Which thermometers the last reading rests on; `neither` keeps `air` as it was.
  };

  /// @param camera_C  thermometer of the camera's IMU
  /// @param frame_C   of the frame's IMU; an implausible one is as good as none
  /// @param ticks     time since the last reading
  const State& step(int8_t camera_C, int8_t frame_C, Ticks ticks = 0xFFFFu) noexcept {
    // Nothing but 0 so far: not fitted, or not awake yet.
    camera_moves_ = camera_moves_ || camera_C != 0;
    frame_moves_ = frame_moves_ || frame_C != 0;
    const bool camera = camera_moves_ && is_plausible(camera_C),
               frame = frame_moves_ && is_plausible(frame_C);
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
    const CoarseTemperature read = static_cast<CoarseTemperature>(doubled * 64);
    // 16 bits, which an 8-bit chip multiplies in a third of the time that 32 take.
    constexpr uint16_t fall =
        static_cast<uint16_t>(detail::nearest(Constants::fall_per_s() * 8388608.0 / detail::ticks_per_s()));
    if (fall == 0) {
      state_.air = read;
      return declare();
    }
    const Temperature lowest = air_ - static_cast<Temperature>(static_cast<uint32_t>(fall) * ticks);
    if (!has_air_ || static_cast<CoarseTemperature>(lowest >> 16) <= read) {
      air_ = static_cast<Temperature>(read) * 65536;
      state_.air = read;
    } else {
      air_ = lowest;
      state_.air = static_cast<CoarseTemperature>(lowest >> 16);
    }
    has_air_ = true;
    return declare();
  }

  /// Takes the air to be as warm as this until the first reading.
  void assume(CoarseTemperature air) noexcept { state_.air = air; }

  const State& state() const noexcept { return state_; }  ///< After the last step.

private:
  const State& declare() noexcept {
    constexpr CoarseTemperature declared = static_cast<CoarseTemperature>(Constants::declared_C() * 128);
    if (Constants::declared_C() != -128 && state_.air < declared) state_.air = declared;
    return state_;
  }
  static bool is_plausible(int8_t reading_C) noexcept {
    return reading_C >= Constants::minimum_plausible_C() && reading_C <= Constants::maximum_plausible_C();
  }

  State state_ = {0, AirSource::neither};
  Temperature air_ = 0;  // what is believed, finer than it is told
  bool camera_moves_ = false, frame_moves_ = false, has_air_ = false;
};

}  // namespace fixed_point
}  // namespace thermopower
