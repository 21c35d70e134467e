// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../air_celsius.hpp"
#include "../detail/check.hpp"
#include "air_witness.hpp"

/// @file control/air_temperature.hpp
/// Air temperature from the two thermometers on a gimbal, eq 4.20, and what to do when one of them is missing
/// or lies.

namespace thermopower {

/// Where an air temperature came from.
/// @ingroup control
enum class AirSource : uint8_t {
  neither = 0,  ///< No plausible reading: `air_C` is NaN.
  camera = 1,   ///< Only the camera's IMU is plausible.
  frame = 2,    ///< Only the frame's IMU is plausible.
  both = 3,     ///< Both, averaged (eq 4.20).
  warmer = 4    ///< Both are plausible, but they disagree or the frame reads exactly 0: the warmer one.
};

/// Fuses two thermometers. A frame IMU that is not fitted reads 0 degC on a SimpleBGC, and the average would
/// be half the truth. So a frame that reads exactly 0 is not averaged, nor are two that disagree: the warmer
/// one is taken, because an air that is believed too warm costs power, and one that is believed too cold
/// costs the motor.
///
/// A thermometer that has never read anything but exactly 0 is not believed at all: it is not fitted, or not
/// awake yet. (One in air of 0 degC is warmed by its own chip, and does not stand there.) Where the time is
/// told, a fall is believed no faster than air can fall; a rise is believed at once.
///
/// Two thermometers that drift together, or both stick, agree with each other. So readings alone take the air to be no colder than
/// `declared_C`. With an AirWitness, a thermometer on the actuator and its model, they do.
///
/// @snippet control_examples.cpp air
/// How to: @ref wire_up_sbgc, @ref faults_and_reasons.
/// @ingroup control
class AirTemperature {
public:
  /// What one tunes.
  struct Config {
    float minimum_plausible_C;   ///< Below this a reading is rejected.
    float maximum_plausible_C;   ///< Above this a reading is rejected.
    float maximum_difference_K;  ///< Further apart than this the two are not averaged. Above 0.
    float fall_per_s;            ///< A fall is believed no faster than this, K/s. Above 0, may be infinite.
    float
        declared_C;  ///< The air is never warmer: no reading alone makes it colder. -INFINITY: readings are believed.

    /// -40 to 85 degC (the sensor's own range), 15 K apart; 0.2 K/s, which carries a rig from a warm room into
    /// frost in two minutes; the air as warm as 45 degC. Declare your own: each kelvin less is power.
    static Config standard() noexcept { return declared(45.0f); }
    /// The same with the warmest air there is. @param warmest_C  the air is never warmer
    static Config declared(float warmest_C) noexcept {
      const Config config = {-40.0f, 85.0f, 15.0f, 0.2f, warmest_C};
      return config;
    }
    /// The same with thermometers that are believed whatever they say inside their range, as the thesis's program does:
    /// two that drift or stick together are not noticed.
    static Config believing() noexcept { return declared(-static_cast<float>(INFINITY)); }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.minimum_plausible_C, self.maximum_plausible_C, self.maximum_difference_K, self.fall_per_s,
              self.declared_C);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      if (!detail::is_finite(minimum_plausible_C)) return ConfigError::minimum_plausible_C;
      if (!detail::is_finite(maximum_plausible_C) || maximum_plausible_C <= minimum_plausible_C)
        return ConfigError::maximum_plausible_C;
      if (!(fall_per_s > 0.0f)) return ConfigError::fall_per_s;
      if (!(declared_C <= maximum_plausible_C)) return ConfigError::declared_C;
      return detail::require_positive(maximum_difference_K, ConfigError::maximum_difference_K);
    }
  };

  /// What one logs.
  struct State {
    float air_C;  ///< The air is no warmer; NaN when `source` is `neither`.
    float
        read_C;  ///< What the thermometers say; NaN when `source` is `neither`. A witness's model stands in this air.
    AirSource source;   ///< Which thermometers `read_C` rests on.
    bool is_witnessed;  ///< Whether `air_C` rests on a witness, and not on what is declared.

    /// What to tell an axis whose motor declares its air: the air is no warmer than both declarations say. Thermometers that read more
    /// than the motor's range holds are told as they are, which is a fault.
    /// @param range  what the motor declares
    AxisAirCelsius bound_within(const AirRange& range) const noexcept {
      const bool is_declared_only = air_C > range.highest_C && read_C <= range.highest_C;
      return AxisAirCelsius::bound(is_declared_only ? range.highest_C : air_C);
    }
  };

  /// @param config  constants; ask `validate()` once
  explicit AirTemperature(const Config& config = Config::standard()) noexcept : config_(config) {
    state_.air_C = state_.read_C = detail::not_a_number();
    state_.source = AirSource::neither;
    state_.is_witnessed = false;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param camera_C  thermometer of the camera's IMU; NaN when not fitted
  /// @param frame_C   thermometer of the frame's IMU; NaN when not fitted
  /// @param dt_s      time since the last reading; infinite: a fall is believed at once
  const State& step(float camera_C, float frame_C, float dt_s = static_cast<float>(INFINITY)) noexcept {
    read(camera_C, frame_C, dt_s);
    declare();
    return state_;
  }
  /// The same beside a witness, stepped before with a model in `read_C` of the last step. @param witness  while it vouches and
  /// both thermometers agree, the air is the warmer one and its margin, where that is colder than declared
  const State& step(float camera_C, float frame_C, const AirWitness& witness, float dt_s) noexcept {
    read(camera_C, frame_C, dt_s);
    const float warmer_C = state_.read_C + 0.5f * detail::magnitude(camera_C - frame_C) + witness.margin_K();
    if (state_.source == AirSource::both && witness.is_vouching() && warmer_C < config_.declared_C) {
      state_.air_C = warmer_C;
      state_.is_witnessed = true;
    } else {
      declare();
    }
    return state_;
  }

  const State& state() const noexcept { return state_; }  ///< After the last step.

private:
  void read(float camera_C, float frame_C, float dt_s) noexcept {
    const float before_C = state_.read_C;
    camera_moves_ = camera_moves_ || is_nonzero(camera_C);
    frame_moves_ = frame_moves_ || is_nonzero(frame_C);
    const bool camera = camera_moves_ && is_plausible(camera_C),
               frame = frame_moves_ && is_plausible(frame_C);
    if (camera && frame) {
      const bool agree =
          is_nonzero(frame_C) && detail::magnitude(camera_C - frame_C) <= config_.maximum_difference_K;
      state_.read_C = agree ? 0.5f * (camera_C + frame_C) : (camera_C > frame_C ? camera_C : frame_C);
      state_.source = agree ? AirSource::both : AirSource::warmer;
    } else {
      state_.read_C = camera ? camera_C : (frame ? frame_C : detail::not_a_number());
      state_.source = camera ? AirSource::camera : (frame ? AirSource::frame : AirSource::neither);
    }
    // Asked this way round so that no time known, or none before, is no limit.
    if (dt_s >= 0.0f && detail::is_finite(dt_s) && state_.read_C < before_C - config_.fall_per_s * dt_s)
      state_.read_C = before_C - config_.fall_per_s * dt_s;
    state_.air_C = state_.read_C;
  }
  // No reading at all stays none.
  void declare() noexcept {
    state_.is_witnessed = false;
    if (state_.air_C < config_.declared_C) state_.air_C = config_.declared_C;
  }

  bool is_plausible(float reading_C) const noexcept {
    return reading_C >= config_.minimum_plausible_C && reading_C <= config_.maximum_plausible_C;
  }

  static bool is_nonzero(float reading_C) noexcept { return reading_C < 0.0f || reading_C > 0.0f; }

  Config config_;
  State state_;
  bool camera_moves_ = false, frame_moves_ = false;  // has it ever read anything but 0?
};

}  // namespace thermopower
