// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/probe.hpp"
#include "evidence.hpp"
#include "turn_sums.hpp"
#include "../monitor_inputs.hpp"
#include "../motion_balance_config.hpp"

/// @file monitor/detail/motion_balance.hpp
/// Whether torque, acceleration and friction agree within declared bounds.

namespace thermopower {
namespace detail {

/// Has constants of a shaft.
template <class Candidate, class = int>
struct HasMotionBalance {
  static constexpr bool value = false;
};
template <class Candidate>
struct HasMotionBalance<Candidate, typename Exists<decltype(Candidate::motion_balance())>::Type> {
  static constexpr bool value = true;
};

/// The balance of a shaft: the motor's torque accelerates it and overcomes friction, block by block.
/// @tparam Plant  has `static constexpr MotionBalanceConfig motion_balance()` and `monitor()`
///
/// A part of `ModelMonitor`, which steps it.
template <class Plant>
class MotionBalance {
  static constexpr MotionBalanceConfig config() { return Plant::motion_balance(); }
  static_assert(config().full_A > 0.0, "thermopower: motion_balance(): full_A must be above 0");
  static_assert(config().least_rad_per_s > 0.0 && config().full_rad_per_s > config().least_rad_per_s,
                "thermopower: motion_balance(): least_rad_per_s must be above 0 and below full_rad_per_s");
  static_assert(config().torque_constant_Nm_per_A > 0.0,
                "thermopower: motion_balance(): torque_constant_Nm_per_A must be above 0");
  static_assert(config().torque_error >= 0.0 && config().torque_error <= 0.5,
                "thermopower: motion_balance(): torque_error is a fraction, 0 .. 0.5");
  static_assert(config().inertia_kg_m2 >= 0.0,
                "thermopower: motion_balance(): inertia_kg_m2 must not be negative");
  static_assert(config().inertia_error >= 0.0 && config().inertia_error <= 0.5,
                "thermopower: motion_balance(): inertia_error is a fraction, 0 .. 0.5");
  static_assert(config().dry_friction_Nm >= 0.0,
                "thermopower: motion_balance(): dry_friction_Nm must not be negative");
  static_assert(config().damping_Nm_s_per_rad >= 0.0,
                "thermopower: motion_balance(): damping_Nm_s_per_rad must not be negative");
  static_assert(config().friction_error >= 0.0 && config().friction_error <= 0.5,
                "thermopower: motion_balance(): friction_error is a fraction, 0 .. 0.5");
  static_assert(config().load_Nm >= 0.0, "thermopower: motion_balance(): load_Nm must not be negative");
  static_assert(config().noise_Nm > 0.0, "thermopower: motion_balance(): noise_Nm must be above 0");

public:
  /// Adds a step. False: an input was not a number, or implausible, and the block will not be judged.
  /// @param ticks  time since the last step, 1/1024 s
  bool add(TurnSums& sums, const MonitorInputs& inputs, uint16_t ticks) noexcept {
    constexpr uint8_t ampere = count_exponent(config().full_A),
                      speed_exponent = count_exponent(config().full_rad_per_s);
    constexpr int16_t least = slowest();
    constexpr uint16_t most_A = upper_bits(1.9 * full_A()), fastest = upper_bits(1.9 * full_rate());
    const int16_t current = to_count(inputs.current_A, most_A, ampere);
    const int16_t rate = to_count(inputs.rate_rad_per_s, fastest, speed_exponent);
    const int16_t speed = rate < 0 ? static_cast<int16_t>(-rate) : rate;
    const bool is_new = sums.at_first == 0, is_turned = (sums.at_first < 0) != (rate < 0);
    if (current == no_count() || rate == no_count() || speed < least || (!is_new && is_turned)) {
      sums.at_first = no_count();
      return false;
    }
    if (is_new) sums.at_first = rate;
    sums.at_last = speed;
    sums.first_sum += product(rate < 0 ? static_cast<int16_t>(-current) : current, ticks);
    sums.second_sum += product(speed, ticks);
    return true;
  }

  /// Closes a block. @param limit  where the sums alarm  @param ticks  how long it was, 1/1024 s
  void close(const TurnSums& sums, uint8_t limit, uint16_t ticks) noexcept {
    if (sums.at_first != 0 && sums.at_first != no_count()) {
      constexpr BinaryScale inertia = inertia_scale(), dry = dry_scale(), damping = damping_scale(),
                            load = load_scale(), per_count = evidence_scale();
      constexpr uint8_t torque_error = fraction(config().torque_error),
                        inertia_error = fraction(config().inertia_error),
                        friction_error = fraction(config().friction_error);
      constexpr uint16_t least = static_cast<uint16_t>(4u + quarter_noise());
      const int16_t drive = upper(sums.first_sum);
      const int16_t gained =
          saturated(times(sums.at_last - static_cast<int16_t>(size_of(sums.at_first)), inertia));
      const int16_t friction = saturated(times(ticks, dry) + times(upper(sums.second_sum), damping));
      const uint32_t allowed = static_cast<uint32_t>(times(ticks, load)) + least + part(drive, torque_error) +
                               part(gained, inertia_error) + part(friction, friction_error);
      evidence_.add(saturated(static_cast<int32_t>(drive) - gained - friction),
                    static_cast<uint16_t>(allowed > 32000u ? 32000u : allowed), per_count, limit);
    }
  }

  /// Forgets all evidence.
  void restart() noexcept { *this = MotionBalance(); }
  /// The sums of the test.
  const Evidence& evidence() const noexcept { return evidence_; }
  /// Which way the balance disagrees, once a sum is at the limit.
  Disagreement disagreement(uint8_t limit) const noexcept {
    return evidence_.more >= limit   ? Disagreement::drag_high
           : evidence_.less >= limit ? Disagreement::drag_low
                                     : Disagreement::none;
  }

private:
  // What 8192 counts are.
  static constexpr double full_A() { return counted_full(config().full_A); }
  static constexpr double full_rate() { return counted_full(config().full_rad_per_s); }
  static constexpr double full_Nm() { return config().torque_constant_Nm_per_A * full_A(); }
  static constexpr int16_t slowest() {
    return static_cast<int16_t>(config().least_rad_per_s / full_rate() * 8192.0);
  }
  // Torque and time in 1/256 s of the full torque.
  static constexpr BinaryScale inertia_scale() {
    return binary_scale(config().inertia_kg_m2 * full_rate() / full_Nm() / 32.0);
  }
  static constexpr BinaryScale dry_scale() {
    return binary_scale(config().dry_friction_Nm / full_Nm() / 4.0);
  }
  static constexpr BinaryScale load_scale() { return binary_scale(config().load_Nm / full_Nm() / 4.0); }
  static constexpr BinaryScale damping_scale() {
    return binary_scale(config().damping_Nm_s_per_rad * full_rate() / full_Nm());
  }
  static constexpr double told_noise() {
    return config().noise_Nm / full_Nm() * Plant::monitor().block_s * 256.0;
  }
  static constexpr double noise() { return told_noise() > 4.0 ? told_noise() : 4.0; }
  static constexpr uint16_t quarter_noise() { return static_cast<uint16_t>(0.25 * noise() + 0.5); }
  static constexpr BinaryScale evidence_scale() { return binary_scale(0.5 * evidence_per_nat() / noise()); }
  static constexpr uint8_t fraction(double error) { return static_cast<uint8_t>(error * 256.0 + 0.999); }

  Evidence evidence_;
};

}  // namespace detail
}  // namespace thermopower
