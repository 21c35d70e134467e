// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/probe.hpp"
#include "evidence.hpp"
#include "turn_sums.hpp"
#include "../monitor_inputs.hpp"
#include "../winding_balance_config.hpp"

/// @file monitor/detail/winding_balance.hpp
/// Whether voltage, current and temperature of a winding agree within declared bounds.

namespace thermopower {
namespace detail {

/// Has constants of a winding.
template <class Candidate, class = int>
struct HasWindingBalance {
  static constexpr bool value = false;
};
template <class Candidate>
struct HasWindingBalance<Candidate, typename Exists<decltype(Candidate::winding_balance())>::Type> {
  static constexpr bool value = true;
};

/// The balance of a winding: voltage = current times the resistance at its temperature, block by block.
/// @tparam Plant  has `static constexpr WindingBalanceConfig winding_balance()` and `monitor()`
///
/// A part of `ModelMonitor`, which steps it.
template <class Plant>
class WindingBalance {
  static constexpr WindingBalanceConfig config() { return Plant::winding_balance(); }
  static_assert(config().full_V > 0.0, "thermopower: winding_balance(): full_V must be above 0");
  static_assert(config().resistance_ohm > 0.0,
                "thermopower: winding_balance(): resistance_ohm must be above 0");
  static_assert(config().resistance_error >= 0.0 && config().resistance_error <= 0.5,
                "thermopower: winding_balance(): resistance_error is a fraction, 0 .. 0.5");
  static_assert(config().tempco_per_K >= 0.0 && config().tempco_per_K <= 0.02,
                "thermopower: winding_balance(): tempco_per_K must be within 0 .. 0.02, copper: 0.00393");
  static_assert(config().reference_C >= -50.0 && config().reference_C <= 200.0,
                "thermopower: winding_balance(): reference_C must be within -50 .. 200");
  static_assert(config().winding_error_K >= 0.0,
                "thermopower: winding_balance(): winding_error_K must not be negative");
  static_assert(config().offset_V >= 0.0, "thermopower: winding_balance(): offset_V must not be negative");
  static_assert(config().noise_V > 0.0, "thermopower: winding_balance(): noise_V must be above 0");

public:
  /// Adds a step. False: an input was not a number, or implausible, and the block will not be judged.
  /// @param ticks  time since the last step, 1/1024 s
  bool add(TurnSums& sums, const MonitorInputs& inputs, uint16_t ticks) noexcept {
    constexpr uint8_t volt = count_exponent(config().full_V), ampere = count_exponent(full_A());
    constexpr BinaryScale ohm = ohm_scale();
    constexpr int16_t reference = static_cast<int16_t>(config().reference_C * 64.0);
    constexpr BinaryScale tempco = tempco_scale();
    constexpr uint16_t most_V = upper_bits(1.9 * full_V()), most_A = upper_bits(1.9 * full_A()),
                       most_C = upper_bits(500.0);
    int16_t voltage = to_count(inputs.voltage_V, most_V, volt);
    int16_t current = to_count(inputs.current_A, most_A, ampere);
    const int16_t winding = to_count(inputs.winding_C, most_C, 6);
    if (voltage == no_count() || current == no_count() || winding == no_count()) {
      sums.at_first = no_count();
      return false;
    }
    if (current < 0) {
      current = static_cast<int16_t>(-current);
      voltage = static_cast<int16_t>(-voltage);
    }
    const int16_t warmer = saturated(times(winding - reference, tempco));  // 1/32768
    const int16_t cold = saturated(times(current, ohm));
    const int16_t drop =
        saturated(static_cast<int32_t>(cold) + fixed_point::detail::product_q15(cold, warmer));
    sums.first_sum += product(saturated(static_cast<int32_t>(voltage) - drop), ticks);
    sums.second_sum += product(drop, ticks);
    return true;
  }

  /// Closes a block. @param limit  where the sums alarm
  void close(const TurnSums& sums, uint8_t limit) noexcept {
    if (sums.at_first != no_count()) {
      constexpr uint16_t at_no_load = static_cast<uint16_t>(offset() + quarter_noise());
      constexpr uint8_t share_off = part_off();
      constexpr BinaryScale per_count = evidence_scale();
      const int16_t drop = upper(sums.second_sum);
      const uint16_t allowed = static_cast<uint16_t>(at_no_load + part(drop, share_off));
      evidence_.add(upper(sums.first_sum), allowed, per_count, limit);
    }
  }

  /// Forgets all evidence.
  void restart() noexcept { *this = WindingBalance(); }
  /// The sums of the test.
  const Evidence& evidence() const noexcept { return evidence_; }
  /// Which way the balance disagrees, once a sum is at the limit.
  Disagreement disagreement(uint8_t limit) const noexcept {
    return evidence_.more >= limit   ? Disagreement::resistance_high
           : evidence_.less >= limit ? Disagreement::resistance_low
                                     : Disagreement::none;
  }

private:
  // Voltage and current that 8192 counts are.
  static constexpr double full_V() { return counted_full(config().full_V); }
  static constexpr double full_A() { return counted_full(config().full_V / config().resistance_ohm); }
  static constexpr BinaryScale ohm_scale() {
    return binary_scale(config().resistance_ohm * full_A() / full_V());
  }
  static constexpr BinaryScale tempco_scale() { return binary_scale(config().tempco_per_K * 512.0); }
  static constexpr uint8_t part_off() {
    return static_cast<uint8_t>(
        (config().resistance_error + config().tempco_per_K * config().winding_error_K) * 256.0 + 0.999);
  }
  static constexpr double block() { return Plant::monitor().block_s * 256.0 / full_V(); }
  static constexpr uint16_t offset() { return static_cast<uint16_t>(config().offset_V * block() + 4.0); }
  static constexpr double noise() {
    return config().noise_V * block() > 4.0 ? config().noise_V * block() : 4.0;
  }
  static constexpr uint16_t quarter_noise() { return static_cast<uint16_t>(0.25 * noise() + 0.5); }
  static constexpr BinaryScale evidence_scale() { return binary_scale(0.5 * evidence_per_nat() / noise()); }

  Evidence evidence_;
};

}  // namespace detail
}  // namespace thermopower
