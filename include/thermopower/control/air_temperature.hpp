// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"

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

    /// -40 to 85 degC (the sensor's own range), 15 K apart; 0.2 K/s, which carries a rig from a warm room into
    /// frost in two minutes.
    static Config standard() noexcept {
      Config config = {-40.0f, 85.0f, 15.0f, 0.2f};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.minimum_plausible_C, self.maximum_plausible_C, self.maximum_difference_K, self.fall_per_s);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      if (!detail::is_finite(minimum_plausible_C)) return ConfigError::minimum_plausible_C;
      if (!detail::is_finite(maximum_plausible_C) || maximum_plausible_C <= minimum_plausible_C)
        return ConfigError::maximum_plausible_C;
      if (!(fall_per_s > 0.0f)) return ConfigError::fall_per_s;
      return detail::require_positive(maximum_difference_K, ConfigError::maximum_difference_K);
    }
  };

  /// What one logs.
  struct State {
    float air_C;       ///< NaN when `source` is `neither`.
    AirSource source;  ///< Which thermometers it rests on.
  };

  /// @param config  constants; ask `validate()` once
  explicit AirTemperature(const Config& config = Config::standard()) noexcept : config_(config) {
    state_.air_C = detail::not_a_number();
    state_.source = AirSource::neither;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param camera_C  thermometer of the camera's IMU; NaN when not fitted
  /// @param frame_C   thermometer of the frame's IMU; NaN when not fitted
  /// @param dt_s      time since the last reading; infinite: a fall is believed at once
  const State& step(float camera_C, float frame_C, float dt_s = static_cast<float>(INFINITY)) noexcept {
    const float before_C = state_.air_C;
    camera_moves_ = camera_moves_ || is_nonzero(camera_C);
    frame_moves_ = frame_moves_ || is_nonzero(frame_C);
    const bool camera = camera_moves_ && is_plausible(camera_C),
               frame = frame_moves_ && is_plausible(frame_C);
    if (camera && frame) {
      const bool agree =
          is_nonzero(frame_C) && detail::magnitude(camera_C - frame_C) <= config_.maximum_difference_K;
      state_.air_C = agree ? 0.5f * (camera_C + frame_C) : (camera_C > frame_C ? camera_C : frame_C);
      state_.source = agree ? AirSource::both : AirSource::warmer;
    } else {
      state_.air_C = camera ? camera_C : (frame ? frame_C : detail::not_a_number());
      state_.source = camera ? AirSource::camera : (frame ? AirSource::frame : AirSource::neither);
    }
    // Asked this way round so that no time known, or none before, is no limit.
    if (dt_s >= 0.0f && detail::is_finite(dt_s) && state_.air_C < before_C - config_.fall_per_s * dt_s)
      state_.air_C = before_C - config_.fall_per_s * dt_s;
    return state_;
  }

  const State& state() const noexcept { return state_; }  ///< After the last step.

private:
  bool is_plausible(float reading_C) const noexcept {
    return reading_C >= config_.minimum_plausible_C && reading_C <= config_.maximum_plausible_C;
  }

  static bool is_nonzero(float reading_C) noexcept { return reading_C < 0.0f || reading_C > 0.0f; }

  Config config_;
  State state_;
  bool camera_moves_ = false, frame_moves_ = false;  // has it ever read anything but 0?
};

}  // namespace thermopower
