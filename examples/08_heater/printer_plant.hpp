// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

// A printer's heater as it is: an element in a block, a second mass behind it, a thermometer that lags, a fan, a supply.
// It shares no code with the library, and knows more than the monitor's model does.

#include <cmath>
#include <cstdint>
#include <random>

namespace printer {

/// What the heater is made of.
struct Plant {
  double supply_V, ohm_at_20C, tempco_per_K;
  double element_J_per_K, element_W_per_K;  // the element, and its contact to the block
  double block_J_per_K;
  double second_J_per_K, second_W_per_K;  // glass on a bed, the sleeve of a hotend
  double loss_W_per_K, fan_W_per_K;
  double thermometer_s, noise_K, step_K;
};
inline Plant hotend() { return {24.0, 14.4, 0.0002, 2.0, 1.0, 13.0, 3.0, 0.04, 0.10, 0.05, 1.5, 0.06, 0.03}; }
inline Plant bed() { return {24.0, 2.6, 0.0039, 150.0, 40.0, 700.0, 450.0, 6.0, 1.3, 0.8, 4.0, 0.04, 0.02}; }

/// What may go wrong.
enum class Fault {
  none,
  thermistor_loose,
  thermistor_stuck,
  heater_weak,
  fan_lost,
  room_warmer,
  heater_stays_on
};
inline const char* name(Fault fault) {
  static const char* const names[] = {
      "none",     "thermistor loose", "thermistor stuck", "heater 20 % weaker",
      "fan lost", "room 15 K warmer", "heater stays on"};
  return names[static_cast<int>(fault)];
}

class Heater {
public:
  Heater(const Plant& plant, double air_C, std::uint32_t seed)
      : plant_(plant),
        random_(seed),
        element_C_(air_C),
        block_C_(air_C),
        second_C_(air_C),
        sensor_C_(air_C) {}

  void fail(Fault fault) {
    stuck_C_ = reading_C();
    fault_ = fault;
  }

  /// @param duty, fan  0 .. 1  @param air_C  of the room as it is told  @param volt  the supply's voltage
  void pass(double duty, double fan, double air_C, double volt, double seconds) {
    const double real_air_C = air_C + (fault_ == Fault::room_warmer ? 15.0 : 0.0);
    const double real_fan = fault_ == Fault::fan_lost ? 0.0 : fan;
    const double real_duty = fault_ == Fault::heater_stays_on ? 1.0 : duty;
    const double strength = fault_ == Fault::heater_weak ? 0.8 : 1.0;
    while (seconds > 1e-9) {
      const double dt_s = std::fmin(seconds, 0.05);
      const double ohm = plant_.ohm_at_20C * (1.0 + plant_.tempco_per_K * (element_C_ - 20.0));
      const double heat_W = strength * real_duty * volt * volt / ohm;
      const double into_block_W = plant_.element_W_per_K * (element_C_ - block_C_);
      const double into_second_W = plant_.second_W_per_K * (block_C_ - second_C_);
      const double lost_W = (plant_.loss_W_per_K + plant_.fan_W_per_K * real_fan) * (block_C_ - real_air_C);
      // A loose thermistor sees the room as well, and late.
      const bool is_loose = fault_ == Fault::thermistor_loose;
      const double seen_C = is_loose ? 0.6 * block_C_ + 0.4 * real_air_C : block_C_;
      sensor_C_ += dt_s * (seen_C - sensor_C_) / (is_loose ? 15.0 : plant_.thermometer_s);
      element_C_ += dt_s * (heat_W - into_block_W) / plant_.element_J_per_K;
      block_C_ += dt_s * (into_block_W - into_second_W - lost_W) / plant_.block_J_per_K;
      second_C_ += dt_s * into_second_W / plant_.second_J_per_K;
      seconds -= dt_s;
    }
    const double noisy_C = sensor_C_ + plant_.noise_K * gauss_(random_);
    reading_C_ = std::round(noisy_C / plant_.step_K) * plant_.step_K;
  }
  double reading_C() const { return fault_ == Fault::thermistor_stuck ? stuck_C_ : reading_C_; }
  double block_C() const { return block_C_; }

private:
  Plant plant_;
  std::mt19937 random_;
  std::normal_distribution<double> gauss_;
  Fault fault_ = Fault::none;
  double element_C_, block_C_, second_C_, sensor_C_, reading_C_ = sensor_C_, stuck_C_ = 0.0;
};

}  // namespace printer
