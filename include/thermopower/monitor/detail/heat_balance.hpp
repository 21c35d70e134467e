// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/probe.hpp"
#include "evidence.hpp"
#include "../heat_balance_config.hpp"
#include "../monitor_inputs.hpp"

/// @file monitor/detail/heat_balance.hpp
/// Whether heat in, heat stored and heat lost agree within declared bounds.

namespace thermopower {
namespace detail {

/// Has constants of a heat balance.
template <class Candidate, class = int>
struct HasHeatBalance {
  static constexpr bool value = false;
};
template <class Candidate>
struct HasHeatBalance<Candidate, typename Exists<decltype(Candidate::heat_balance())>::Type> {
  static constexpr bool value = true;
};

/// Sum of the fan's part of the loss, where there is a fan.
template <bool has_fan>
struct FanSum {
  int32_t fan_rise = 0;
  uint8_t fan_share = 0xff;  // changes of the fan's loss that still explain all blocks, in eighths
  int16_t taken = 0;         // by the fan, in the block that is judged
  void blow(int16_t loss) noexcept { taken = loss; }
  int16_t blown() const noexcept { return taken; }
  void add_fan(int32_t rise_and_time) noexcept { fan_rise += rise_and_time; }
  void clear_fan() noexcept { fan_rise = 0; }
  int32_t fan_sum() const noexcept { return fan_rise; }
  void keep_fan(uint8_t set) noexcept { fan_share = set; }
  uint8_t fan_set() const noexcept { return fan_share; }
};
template <>
struct FanSum<false> {
  void blow(int16_t) noexcept {}
  int16_t blown() const noexcept { return 0; }
  void add_fan(int32_t) noexcept {}
  void clear_fan() noexcept {}
  int32_t fan_sum() const noexcept { return 0; }
  void keep_fan(uint8_t) noexcept {}
  uint8_t fan_set() const noexcept { return 0; }
};

/// The temperature of the second mass, where there is one.
template <bool has_second>
struct SecondMass {
  int16_t into = 0;   // heat into it, a time constant later
  int16_t whole = 0;  // 1/64 K
  uint8_t low = 0;    // 1/16384 K
  int32_t second() const noexcept { return static_cast<int32_t>(whole) * 256 + low; }
  void warm(int32_t change) noexcept {
    const int32_t now = second() + change;
    low = static_cast<uint8_t>(now & 0xff);
    whole = static_cast<int16_t>(now >> 8);
  }
};
template <>
struct SecondMass<false> {};

/// The balance of a heated body: heat in = heat stored + heat lost, block by block. A residual beyond what the
/// bounds explain is evidence; the changes of one constant that explain all blocks since then are the suspects.
/// @tparam Plant  has `static constexpr HeatBalanceConfig heat_balance()` and `static constexpr MonitorConfig monitor()`
///
/// A part of `ModelMonitor`, which steps it.
template <class Plant>
class HeatBalance : FanSum<(Plant::heat_balance().fan_W_per_K > 0.0)>,
                    SecondMass<(Plant::heat_balance().second_J_per_K > 0.0)> {
  static_assert(
      HasHeatBalance<Plant>::value,
      "thermopower: the parameter of HeatBalance must have heat_balance(), a constexpr HeatBalanceConfig");
  static constexpr HeatBalanceConfig config() { return Plant::heat_balance(); }
  static_assert(config().full_W > 0.0, "thermopower: heat_balance(): full_W must be above 0");
  static_assert(config().heat_error >= 0.0 && config().heat_error <= 0.5,
                "thermopower: heat_balance(): heat_error is a fraction, 0 .. 0.5");
  static_assert(config().capacity_J_per_K > 0.0,
                "thermopower: heat_balance(): capacity_J_per_K must be above 0");
  static_assert(config().capacity_error >= 0.0 && config().capacity_error <= 0.5,
                "thermopower: heat_balance(): capacity_error is a fraction, 0 .. 0.5");
  static_assert(config().second_J_per_K >= 0.0,
                "thermopower: heat_balance(): second_J_per_K must not be negative");
  static_assert(config().second_J_per_K == 0.0 || config().second_s > 0.0,
                "thermopower: heat_balance(): second_s must be above 0 where there is a second mass");
  static_assert(config().second_error >= 0.0 && config().second_error <= 0.5,
                "thermopower: heat_balance(): second_error is a fraction, 0 .. 0.5");
  static_assert(config().lag_s >= 0.0, "thermopower: heat_balance(): lag_s must not be negative");
  static_assert(config().lag_error >= 0.0 && config().lag_error <= 0.5,
                "thermopower: heat_balance(): lag_error is a fraction, 0 .. 0.5");
  static_assert(config().loss_W_per_K > 0.0, "thermopower: heat_balance(): loss_W_per_K must be above 0");
  static_assert(config().loss_error >= 0.0 && config().loss_error <= 0.5,
                "thermopower: heat_balance(): loss_error is a fraction, 0 .. 0.5");
  static_assert(config().fan_W_per_K >= 0.0, "thermopower: heat_balance(): fan_W_per_K must not be negative");
  static_assert(config().fan_error >= 0.0 && config().fan_error <= 0.5,
                "thermopower: heat_balance(): fan_error is a fraction, 0 .. 0.5");
  static_assert(config().air_error_K >= 0.0, "thermopower: heat_balance(): air_error_K must not be negative");
  static_assert(config().noise_K > 0.0, "thermopower: heat_balance(): noise_K must be above 0");
  static_assert(config().resolution_K >= 0.0,
                "thermopower: heat_balance(): resolution_K must not be negative");
  static_assert(config().heat_noise_J >= 0.0,
                "thermopower: heat_balance(): heat_noise_J must not be negative");
  // Of the plant itself, so that the compiler asks once.
  static constexpr bool has_fan = Plant::heat_balance().fan_W_per_K > 0.0;
  static constexpr bool has_second = Plant::heat_balance().second_J_per_K > 0.0;
  static constexpr bool has_lag = Plant::heat_balance().lag_s > 0.0;
  static constexpr bool sees_standstill = Plant::heat_balance().resolution_K <= Plant::heat_balance().noise_K;
  typedef FanSum<(Plant::heat_balance().fan_W_per_K > 0.0)> Fan;

public:
  /// Seconds that are balanced at once.
  static constexpr double block_s() { return Plant::monitor().block_s; }

  /// Adds a step. False: an input was not a number, or implausible, and the block will not be judged.
  /// @param ticks  time since the last step, 1/1024 s
  bool add(const MonitorInputs& inputs, uint16_t ticks) noexcept {
    constexpr uint8_t heat_exponent = count_exponent(config().full_W);
    constexpr uint16_t most_heat = upper_bits(1.9 * full_W()), most_air_C = upper_bits(100.0),
                       most_C = upper_bits(500.0);
    // Heat in 1/8192 of the full, temperatures in 1/64 K.
    const int16_t heat = to_count(inputs.heat_W, most_heat, heat_exponent);
    const int16_t air = to_count(inputs.air_C, most_air_C, 6);
    const int16_t now = to_count(inputs.measured_C, most_C, 6);
    if (heat < 0 || air == no_count() || now == no_count()) {
      flags_ |= is_void;
      return false;
    }
    const int16_t rise = static_cast<int16_t>(now - air);
    if (rise < -hottest_rise || rise > hottest_rise) {
      flags_ |= is_void;
      return false;
    }
    if ((flags_ & has_start) == 0) start(now, rise);
    if (now != last_) flags_ = static_cast<uint8_t>(flags_ & ~is_flat);
    last_ = now;
    heat_ += static_cast<uint32_t>(product(heat, ticks));
    rise_ += product(rise, ticks);
    if (has_fan) Fan::add_fan(product(fixed_point::detail::part_of(rise, inputs.fan), ticks));
    return true;
  }

  /// Does what is left of the work on the last block: a loop may be so slow that it has few steps in a block.
  /// @param limit  where the evidence alarms
  void finish(uint8_t limit) noexcept {
    while (is_judging()) judge(limit);
  }
  /// Ends a block; `judge()` then weighs it in the next steps. Call `finish()` before.
  void close() noexcept {
    constexpr BinaryScale loss = loss_scale(), fan = fan_scale();
    heat_in_ = upper(static_cast<int32_t>(heat_));                // 1/256 s of full heat, as all that follows
    residual_ = saturated(static_cast<int32_t>(last_) - start_);  // what balance() begins with
    lost_ = saturated(times(rise_, loss));
    if (has_fan) Fan::blow(saturated(times(Fan::fan_sum(), fan)));
    // A reading that was refused or missing stands still for nobody.
    if ((flags_ & is_flat) == 0) flat_ = 0;
    else if ((flags_ & is_void) == 0 && flat_ < 255) ++flat_;
    if (settling_ > 0) {
      --settling_;
      flags_ |= is_void;
    }
    flags_ = static_cast<uint8_t>(((flags_ & is_void) != 0 ? was_void : 0) | has_start | is_flat | a_stage);
    start_ = last_;
    heat_ = 0;
    rise_ = 0;
    Fan::clear_fan();
  }

  /// Does a part of the work on the last block, if there is any left: a step must not take long.
  /// @param limit  where the evidence alarms
  void judge(uint8_t limit) noexcept {
    const bool is_judged = (flags_ & was_void) == 0;
    switch (flags_ & stages) {
      case 1 * a_stage:
        arrive();
        break;
      case 2 * a_stage:
        balance();
        break;
      case 3 * a_stage:
        if (!is_judged) break;
        if (is_found(limit)) {
          evidence_.count_down(limit);
        } else {
          constexpr BinaryScale per_count = evidence_scale();
          evidence_.add(residual_, allowed_, per_count, limit);
          if (is_found(limit)) evidence_.settle(limit, blocks_after);
        }
        break;
      case 4 * a_stage:
        if (is_judged && is_naming(limit)) suspect_heat_and_air();
        break;
      case 5 * a_stage:
        if (is_judged && is_naming(limit)) suspect_losses();
        break;
      default:
        flags_ = static_cast<uint8_t>(flags_ & ~stages);
        return;
    }
    flags_ = static_cast<uint8_t>(flags_ + a_stage);
  }
  /// True while a block waits to be judged.
  bool is_judging() const noexcept { return (flags_ & stages) != 0; }

  /// Forgets everything but how warm it is: after a pause of unknown length.
  void restart() noexcept { *this = HeatBalance(); }

  /// The sums of the test.
  const Evidence& evidence() const noexcept { return evidence_; }
  /// Which way the balance disagrees, once a sum is at the limit and the block has been judged to its end.
  Disagreement disagreement(uint8_t limit) const noexcept {
    return is_judging() || !is_found(limit) ? Disagreement::none
           : evidence_.more >= limit        ? Disagreement::heat_missing
                                            : Disagreement::heat_unexplained;
  }
  /// Constant changes that explain every block since the first evidence, a sum of `Suspect`.
  uint8_t suspects() const noexcept {
    const bool is_stuck = sees_standstill && flat_ >= 2 && flat_ + 1 >= evidence_.since;
    if (is_stuck) return static_cast<uint8_t>(Suspect::thermometer);
    // A thermometer that reads a constant share of the rise looks like a weak heater or, once it is steady, a larger loss or colder air.
    const bool is_scale =
        evidence_.more >= evidence_.less ? (heater_ | loss_ | air_) != 0 : (heater_ & 0x7f) != 0;
    const uint8_t found =
        static_cast<uint8_t>((heater_ != 0 ? 1 : 0) | (loss_ != 0 ? 2 : 0) | (Fan::fan_set() != 0 ? 4 : 0) |
                             (air_ != 0 ? 8 : 0) | (is_scale ? 16 : 0));
    return found != 0 ? found : static_cast<uint8_t>(Suspect::thermometer);
  }
  /// True while blocks are judged: not before the lag and the second mass are known after a start.
  bool is_watching() const noexcept { return (flags_ & has_start) != 0 && settling_ == 0; }
  /// The last reading that was taken, degC.
  float measured_C() const noexcept { return static_cast<float>(last_) * (1.0f / 64.0f); }
  /// Changes of a constant that still explain all blocks, in steps of `share_step()`: bit k is k + 1 steps.
  uint8_t heater_set() const noexcept { return heater_; }
  uint8_t loss_set() const noexcept { return loss_; }  ///< @copydoc heater_set
  uint8_t air_set() const noexcept { return air_; }    ///< The same in steps of 4 K.

private:
  static constexpr int16_t hottest_rise = 400 * 64;
  static constexpr uint8_t is_void = 1, is_flat = 2, has_start = 4, was_void = 8, a_stage = 16,
                           stages = 7 * 16;

  // What a share of 1 is: the highest heat, or up to twice as much.
  static constexpr double full_W() { return counted_full(config().full_W); }
  static constexpr double share(double seconds) {
    return seconds > 0.0 ? 1.0 - constexpr_exp(-block_s() / seconds) : 1.0;
  }
  static constexpr uint16_t share_factor(double seconds) { return binary_factor(share(seconds)); }
  static constexpr uint8_t fraction(double error) { return static_cast<uint8_t>(error * 256.0 + 0.999); }
  static constexpr BinaryScale stored_scale() {
    return binary_scale(4.0 * config().capacity_J_per_K / full_W());
  }
  static constexpr BinaryScale loss_scale() { return binary_scale(config().loss_W_per_K / full_W() / 256.0); }
  static constexpr BinaryScale fan_scale() { return binary_scale(config().fan_W_per_K / full_W() / 255.0); }
  static constexpr BinaryScale second_scale() {
    return binary_scale(config().second_J_per_K / full_W() / 64.0);
  }
  static constexpr BinaryScale lag_scale() { return binary_scale(config().lag_s / block_s()); }
  // Noise of the difference of two readings, as heat; never below what rounding leaves.
  static constexpr double reading_noise() {
    return at_least(362.0 * config().capacity_J_per_K / full_W() * config().noise_K, 4.0);
  }
  // Of the heat of a block.
  static constexpr double heat_noise() {
    return 256.0 * config().heat_noise_J / full_W() * square_root(block_s());
  }
  static constexpr double noise() { return square_root(squared(reading_noise()) + squared(heat_noise())); }
  static constexpr double square_root(double x) { return constexpr_pow(x, 0.5); }
  static constexpr double at_least(double value, double bound) { return value > bound ? value : bound; }
  // Noise of readings does not add up: of the sum over any blocks the first and the last reading are left. So of
  // n blocks none alarms falsely in exp(L) where the sum may be 2 sqrt(L) of it; white noise of the heat needs 2 L.
  static constexpr double least_limit_nat() {
    return evidence_limit_nat(Plant::monitor().false_alarm_h, block_s(), 2.0);
  }
  static constexpr BinaryScale evidence_scale() {
    return binary_scale(0.5 * evidence_per_nat() /
                        (reading_noise() / square_root(least_limit_nat()) + heat_noise()));
  }
  static constexpr uint16_t air_part(double loss_W_per_K) {
    return static_cast<uint16_t>(loss_W_per_K / full_W() * config().air_error_K * block_s() * 256.0 + 0.5);
  }
  static constexpr uint16_t air_allowance() {  // what rounding leaves, and what white noise may be
    return static_cast<uint16_t>(air_part(config().loss_W_per_K) + 4.0 + 0.25 * heat_noise());
  }
  static constexpr uint16_t air_step() {
    return static_cast<uint16_t>(config().loss_W_per_K / full_W() * 4.0 * block_s() * 256.0 + 1.0);
  }
  static constexpr int16_t full_block() {
    return static_cast<int16_t>(block_s() * 256.0 * config().full_W / full_W());
  }
  // Heat by which a start may be wrong: no more than a quarter of what wrong air does, or a hundredth of the highest.
  static constexpr double tolerable_W() {
    return at_least(0.25 * config().loss_W_per_K * config().air_error_K, 0.01 * config().full_W);
  }
  // Blocks in which an error of the start falls to what is tolerable; below 0 where it is less from the beginning.
  static constexpr int16_t settling_blocks(double seconds, double error_W) {
    return static_cast<int16_t>(within(seconds / block_s() * constexpr_log(error_W / tolerable_W()), 255.0));
  }
  static constexpr double within(double value, double bound) {
    return value > bound ? bound : (value < -bound ? -bound : value);
  }
  static constexpr double second_W_per_K() {
    return has_second ? config().second_J_per_K / config().second_s : 1.0;
  }

  void start(int16_t now, int16_t rise) noexcept {
    flags_ |= has_start | is_flat;
    start_ = last_ = now;
    set_second_of(this, now);
    // How much heat is on its way nobody knows.
    constexpr int16_t for_lag = settling_blocks(config().lag_s, config().full_W);
    int16_t blocks = for_lag;
    // As warm as the air, the second mass is where the first is; otherwise it may be anywhere between.
    const bool is_cold = rise < 5 * 64 && rise > -5 * 64;
    if (has_second && !is_cold) {
      constexpr int16_t of_1_K = settling_blocks(config().second_s, second_W_per_K()),
                        of_a_doubling =
                            static_cast<int16_t>(settling_blocks(config().second_s, 2.0 * tolerable_W()) + 1);
      int16_t for_second = of_1_K;
      for (uint16_t left_K = size_of(rise) >> 6; left_K != 0; left_K >>= 1)
        for_second = static_cast<int16_t>(for_second + of_a_doubling);
      if (for_second > blocks) blocks = for_second;
    }
    settling_ = blocks > 253 ? uint8_t(255) : (blocks < 0 ? uint8_t(2) : static_cast<uint8_t>(blocks + 2));
  }
  static void set_second_of(SecondMass<true>* mass, int16_t now) noexcept {
    mass->whole = now;
    mass->low = 0;
  }
  static void set_second_of(SecondMass<false>*, int16_t) noexcept {}

  /// Heat as it arrives, and as it would a lag later: the difference is what a change of the lag does.
  void arrive() noexcept {
    constexpr uint8_t lag_error = fraction(config().lag_error), heat_error = fraction(config().heat_error);
    constexpr uint16_t air = air_allowance();
    allowed_ = air;
    if (has_lag) {
      heat_in_ = delayed(heat_in_, late_);
      allow(saturated(static_cast<int32_t>(heat_in_) - delayed(heat_in_, later_)), lag_error);
    }
    allow(heat_in_, heat_error);
  }
  /// The residual of the block, and how much of it the bounds explain.
  void balance() noexcept {
    constexpr uint8_t stored_error = fraction(config().capacity_error),
                      loss_error = fraction(config().loss_error), fan_error = fraction(config().fan_error);
    constexpr BinaryScale per_count = stored_scale();
    const int16_t change = residual_;
    const int16_t stored = saturated(times(change, per_count));
    allow(stored, stored_error);
    allow(lost_, loss_error);
    int32_t rest = static_cast<int32_t>(heat_in_) - stored - lost_ - flow_into(this, change);
    if (has_fan && Fan::blown() != 0) {
      constexpr uint16_t air = air_part(config().fan_W_per_K);
      allow(Fan::blown(), fan_error);
      allowed_ = static_cast<uint16_t>(allowed_ + air);
      rest -= Fan::blown();
    }
    residual_ = saturated(rest);
  }
  void allow(int16_t term, uint8_t error) noexcept {
    // Seven terms of at most 16 001 counts fit.
    const uint16_t more = part(term, error);
    allowed_ = static_cast<uint16_t>(allowed_ > 20000u ? 20000u : allowed_ + (more > 12000u ? 12000u : more));
  }
  static int16_t delayed(int16_t heat, int16_t& late) noexcept {
    constexpr uint16_t share = share_factor(config().lag_s);
    constexpr BinaryScale lag = lag_scale();
    const int16_t change = static_cast<int16_t>(scaled(static_cast<int32_t>(heat) - late, share));
    late = static_cast<int16_t>(late + change);
    return saturated(heat - times(change, lag));
  }
  /// Heat that the second mass took. @param change  of the reading over the block
  int16_t flow_into(SecondMass<true>* mass, int16_t change) noexcept {
    constexpr uint16_t share = share_factor(config().second_s);
    constexpr uint8_t error = fraction(config().second_error);
    constexpr BinaryScale per_count = second_scale();
    const int32_t middle = (static_cast<int32_t>(start_) * 2 - change) * 128;
    const int32_t warmer = scaled(middle - mass->second(), share);
    mass->warm(warmer);
    const int16_t flow = saturated(times(warmer, per_count));
    mass->into = static_cast<int16_t>(mass->into + scaled(static_cast<int32_t>(flow) - mass->into, share));
    // A change of its heat capacity, and one of its time constant.
    allow(flow, error);
    allow(saturated(static_cast<int32_t>(flow) - mass->into), error);
    return flow;
  }
  int16_t flow_into(SecondMass<false>*, int16_t) noexcept { return 0; }

  /// Takes from a set the changes that do not explain this block: residual = k * step, k = 1 .. 8.
  [[gnu::noinline]] static uint8_t explained(uint8_t set, int16_t residual, int16_t step,
                                             uint16_t allowed) noexcept {
    if (step < 0) step = 0;  // a term that is not there explains no more than the bounds do
    // Beyond an eighth of the range nothing is explained that is not larger still.
    uint16_t slack = static_cast<uint16_t>(allowed + (static_cast<uint16_t>(step) >> 1));
    if (slack > 16000u) slack = 16000u;
    int16_t rest = residual;
    for (uint8_t change = 1; change != 0; change = static_cast<uint8_t>(change << 1)) {
      if (rest > -16000) rest = static_cast<int16_t>(rest - step);
      if (rest > static_cast<int16_t>(slack) || rest < -static_cast<int16_t>(slack))
        set = static_cast<uint8_t>(set & ~change);
    }
    return set;
  }
  static constexpr uint16_t four_sigma() { return static_cast<uint16_t>(4.0 * noise()); }
  // Blocks after the alarm in which the suspects become fewer: a fault may end.
  static constexpr uint8_t blocks_after = 32;
  bool is_found(uint8_t limit) const noexcept { return evidence_.more >= limit || evidence_.less >= limit; }
  bool is_naming(uint8_t limit) const noexcept {
    return !is_found(limit) || (evidence_.more != 0 && evidence_.less != 0);
  }
  /// What the changes of one constant have to explain: the residual, towards its side, and the slack.
  int16_t towards_side() const noexcept {
    return evidence_.more >= evidence_.less ? residual_ : static_cast<int16_t>(-residual_);
  }
  void suspect_heat_and_air() noexcept {
    if (evidence_.since < 2) {  // none yet; and a fault may have begun within the first block
      heater_ = loss_ = air_ = 0xff;
      Fan::keep_fan(0xff);
      return;
    }
    if (evidence_.since == 255) return;
    constexpr uint16_t noise = four_sigma();
    constexpr int16_t block = full_block(), air_change = static_cast<int16_t>(air_step());
    const int16_t rest = towards_side();
    const uint16_t slack = static_cast<uint16_t>(allowed_ + noise);
    air_ = explained(air_, rest, air_change, slack);
    if (evidence_.more >= evidence_.less) {  // an eighth to all of the heat is missing
      heater_ = explained(heater_, rest, static_cast<int16_t>(heat_in_ >> 3), slack);
      return;
    }
    // A quarter too much and more; the last bit: full heat or nearly, whatever is commanded.
    const int16_t off = saturated(static_cast<int32_t>(rest) - block + heat_in_);
    const uint8_t stuck_on =
        size_of(off) <= static_cast<uint16_t>(slack + (block >> 2)) ? uint8_t(heater_ & 0x80) : uint8_t(0);
    heater_ = static_cast<uint8_t>(
        (explained(heater_, rest, static_cast<int16_t>(heat_in_ >> 2), slack) & 0x7f) | stuck_on);
  }
  void suspect_losses() noexcept {
    if (evidence_.since < 2 || evidence_.since == 255) return;
    constexpr uint16_t noise = four_sigma();
    const int16_t rest = towards_side();
    const uint16_t slack = static_cast<uint16_t>(allowed_ + noise);
    // An eighth to all of it, more or less.
    loss_ = explained(loss_, rest, static_cast<int16_t>(lost_ >> 3), slack);
    if (has_fan)
      Fan::keep_fan(explained(Fan::fan_set(), rest, static_cast<int16_t>(Fan::blown() >> 3), slack));
  }

  uint32_t heat_ = 0;
  int32_t rise_ = 0;
  int16_t start_ = 0, last_ = 0, late_ = 0, later_ = 0;
  int16_t heat_in_ = 0, residual_ = 0, lost_ = 0;  // of the block that is judged
  uint16_t allowed_ = 0;
  Evidence evidence_;
  uint8_t heater_ = 0xff, loss_ = 0xff, air_ = 0xff, settling_ = 255, flat_ = 0, flags_ = 0;
};

}  // namespace detail
}  // namespace thermopower
