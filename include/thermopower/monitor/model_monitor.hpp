// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../control/limit_reason.hpp"
#include "detail/heat_balance.hpp"
#include "monitor_inputs.hpp"
#include "detail/motion_balance.hpp"
#include "detail/winding_balance.hpp"

/// @file model_monitor.hpp
/// Watches whether the model still describes the actuator while it runs.

namespace thermopower {

/// What a monitor is promised, and what it does.
/// @ingroup monitor
struct MonitorConfig {
  double
      block_s;  ///< Time that is balanced at once, 1 .. 40 s: about the lag of the heat, and ten steps of the loop.
  double
      false_alarm_h;  ///< Mean time between false alarms of a plant at the edge of its bounds, at least, hours.
  bool is_cutting;    ///< Whether a disagreement cuts the power, or is only told.
};

/// The few numbers that a diagnosis on a desk starts from. Plain, so that it is stored as it is.
/// @ingroup monitor
struct MonitorRecord {
  Disagreement disagreement;  ///< Which balance, and which way.
  uint8_t suspects;           ///< What explains it, a sum of `Suspect`.
  uint16_t since_s;           ///< Time since the first evidence, s; 65535: as long or longer.
  int16_t measured_dC;        ///< The reading now, tenths of a degree.
  uint8_t
      heater_set;  ///< Changes of the heat that explain all blocks: bit k is (k + 1) steps of 1/8 of it missing, or 1/4 too much.
  uint8_t loss_set;  ///< The same of the loss: steps of 1/8 more, or less.
  uint8_t air_set;   ///< The same of the air: steps of 4 K colder, or warmer.
};

namespace detail {

/// A balance that the plant does not have.
struct NoBalance {
  bool add(const MonitorInputs&, uint16_t) noexcept { return true; }
  template <class Sums>
  bool add(Sums&, const MonitorInputs&, uint16_t) noexcept {
    return true;
  }
  void close() noexcept {}
  template <class Sums>
  void close(const Sums&, uint8_t, uint16_t) noexcept {}
  void judge(uint8_t) noexcept {}
  void finish(uint8_t) noexcept {}
  void restart() noexcept {}
  Disagreement disagreement(uint8_t) const noexcept { return Disagreement::none; }
  uint8_t suspects() const noexcept { return 0; }
  uint8_t since() const noexcept { return 0; }
  bool is_watching() const noexcept { return false; }
  void fill(MonitorRecord&) const noexcept {}
};

template <class Plant, bool has>
struct HeatPart : NoBalance {};
template <class Plant>
struct HeatPart<Plant, true> : HeatBalance<Plant> {
  uint8_t since() const noexcept { return this->evidence().since; }
  void fill(MonitorRecord& record) const noexcept {
    record.measured_dC = static_cast<int16_t>(this->measured_C() * 10.0f);
    record.heater_set = this->heater_set();
    record.loss_set = this->loss_set();
    record.air_set = this->air_set();
  }
};
template <class Plant, bool has>
struct WindingPart : NoBalance {};
template <class Plant>
struct WindingPart<Plant, true> : WindingBalance<Plant> {
  void close(const TurnSums& sums, uint8_t limit, uint16_t) noexcept {
    WindingBalance<Plant>::close(sums, limit);
  }
  uint8_t suspects() const noexcept { return static_cast<uint8_t>(Suspect::winding); }
  uint8_t since() const noexcept { return this->evidence().since; }
};
template <class Plant, bool has>
struct MotionPart : NoBalance {};
template <class Plant>
struct MotionPart<Plant, true> : MotionBalance<Plant> {
  uint8_t suspects() const noexcept { return static_cast<uint8_t>(Suspect::friction); }
  uint8_t since() const noexcept { return this->evidence().since; }
};

}  // namespace detail

/// Compares what is measured with what the model predicts within declared bounds, as a sequential test with a
/// stated rate of false alarms; says which balance disagrees, since when, and which causes explain it.
/// @tparam Plant  has `static constexpr MonitorConfig monitor()`, and any of `heat_balance()`, `winding_balance()` and
///         `motion_balance()`: those balances are watched
///
/// Guarantees: no plant whose constants are inside the bounds alarms more often than once in `false_alarm_h` hours.
/// A disagreement stays until `acknowledge()`. The set of suspects shrinks while it lasts, so a cut names the cause
/// as the body cools. Inputs that are not numbers judge nothing: a limiter has to take them as hot.
///
/// @snippet monitor_examples.cpp watch a heater
/// How to: @ref heater_with_monitor. Menu: @ref policies. Math: @ref explain_monitor.
/// @ingroup monitor
template <class Plant>
class ModelMonitor {
  static constexpr bool has_heat() { return detail::HasHeatBalance<Plant>::value; }
  static constexpr bool has_winding() { return detail::HasWindingBalance<Plant>::value; }
  static constexpr bool has_motion() { return detail::HasMotionBalance<Plant>::value; }
  static_assert(has_heat() || has_winding() || has_motion(),
                "thermopower: the parameter of ModelMonitor must have heat_balance(), winding_balance() or "
                "motion_balance(), static constexpr");
  static constexpr MonitorConfig config() { return Plant::monitor(); }
  static_assert(config().block_s >= 1.0 && config().block_s <= 40.0,
                "thermopower: monitor(): block_s must be within 1 .. 40 s");
  static_assert(config().false_alarm_h > 0.0 && config().false_alarm_h <= 100000.0,
                "thermopower: monitor(): false_alarm_h must be above 0 and at most 100 000 hours");

public:
  typedef MonitorInputs Inputs;  ///< What is measured and commanded.

  /// @param dt_s  time since the last step, 0 .. 8 s; after a longer one, or an impossible one, everything starts anew
  /// @return which balance disagrees; it stays until `acknowledge()`
  Disagreement step(const Inputs& inputs, float dt_s) noexcept {
    constexpr uint8_t limit = limit_of(config(), tests());
    constexpr uint16_t block = static_cast<uint16_t>(config().block_s * 1024.0);
    const int16_t ticks = ticks_of(dt_s);
    if (ticks < 0) {
      restart();
      return disagreement();
    }
    heat_.add(inputs, static_cast<uint16_t>(ticks));
    if (is_turn_of_winding()) winding_.add(sums_, inputs, static_cast<uint16_t>(ticks));
    else motion_.add(sums_, inputs, static_cast<uint16_t>(ticks));
    ticks_ = static_cast<uint16_t>(ticks_ + ticks);
    const bool is_full = ticks_ >= block;
    if (is_full) heat_.finish(limit);
    else heat_.judge(limit);
    decide(limit);
    if (is_full) close(limit);
    return disagreement();
  }
  /// Which balance disagrees, and which way.
  Disagreement disagreement() const noexcept { return static_cast<Disagreement>(found_ & 0x0fu); }
  /// What a limiter says of it.
  LimitReason reason() const noexcept {
    switch (disagreement()) {
      case Disagreement::none:
        break;
      case Disagreement::heat_missing:
      case Disagreement::heat_unexplained:
        return heat_.suspects() == static_cast<uint8_t>(Suspect::thermometer)
                   ? LimitReason::thermometer_disagrees
                   : LimitReason::heat_disagrees;
      case Disagreement::resistance_high:
      case Disagreement::resistance_low:
        return LimitReason::winding_disagrees;
      case Disagreement::drag_high:
      case Disagreement::drag_low:
        return LimitReason::friction_disagrees;
    }
    return LimitReason::none;
  }

  /// The demand, or the least power while a balance disagrees and the monitor is cutting.
  LimitedPower limit(uint8_t demand) const noexcept {
    constexpr bool is_cutting = config().is_cutting;
    const bool is_cut = is_cutting && disagreement() != Disagreement::none;
    const LimitedPower granted = {is_cut && demand > least_power() ? least_power() : demand,
                                  is_cut ? reason() : LimitReason::none};
    return granted;
  }

  /// Takes a disagreement back and watches anew: it was looked into.
  void acknowledge() noexcept {
    found_ = 0;
    restart();
  }
  /// Forgets everything but a disagreement and its record: after a pause of unknown length.
  void restart() noexcept {
    if (disagreement() != Disagreement::none) return;
    heat_.restart();
    winding_.restart();
    motion_.restart();
    sums_.clear();
    ticks_ = 0;
  }

  /// Causes that explain what was seen since the first evidence, a sum of `Suspect`; 0 while nothing disagrees.
  uint8_t suspects() const noexcept { return record().suspects; }
  /// What to store for the desk.
  MonitorRecord record() const noexcept {
    MonitorRecord record = {disagreement(), 0, 0, 0, 0, 0, 0};
    heat_.fill(record);
    constexpr uint16_t block = static_cast<uint16_t>(config().block_s + 0.5);
    uint8_t blocks = 0;
    switch (disagreement()) {
      case Disagreement::none:
        break;
      case Disagreement::heat_missing:
      case Disagreement::heat_unexplained:
        record.suspects = heat_.suspects();
        blocks = heat_.since();
        break;
      case Disagreement::resistance_high:
      case Disagreement::resistance_low:
        record.suspects = winding_.suspects();
        blocks = winding_.since();
        break;
      case Disagreement::drag_high:
      case Disagreement::drag_low:
        record.suspects = motion_.suspects();
        blocks = motion_.since();
        break;
    }
    record.since_s = blocks == 255 ? uint16_t(65535) : static_cast<uint16_t>(blocks * block);
    return record;
  }
  /// True while the heat balance is judged: not before lag and second mass are known after a start.
  bool is_watching_heat() const noexcept { return heat_.is_watching(); }
  /// The balances, to log their evidence.
  const detail::HeatPart<Plant, detail::HasHeatBalance<Plant>::value>& heat() const noexcept { return heat_; }
  /// Nats of evidence at which a balance alarms: ln of the blocks in `false_alarm_h` times the tests in each.
  static constexpr double limit_nat() {
    return detail::evidence_limit_nat(config().false_alarm_h, config().block_s, tests());
  }

private:
  static constexpr double tests() {
    return (has_heat() ? 2.0 : 0.0) + (has_winding() ? 2.0 : 0.0) + (has_motion() ? 2.0 : 0.0);
  }
  static constexpr uint8_t limit_of(const MonitorConfig& config, double tests) {
    return static_cast<uint8_t>(detail::evidence_limit(config.false_alarm_h, config.block_s, tests));
  }

  // In 1/1024 s; the rest of short steps is carried on, so that a loop of any rate keeps the time. Below 0: no time.
  int16_t ticks_of(float dt_s) noexcept {
    constexpr uint16_t longest_s = detail::upper_bits(8.0), short_s = detail::upper_bits(0.1171875);
    const int16_t fine = detail::to_count(dt_s, short_s, 18);
    if (fine == detail::no_count()) return detail::to_count(dt_s, longest_s, 10);
    if (fine < 0) return fine;
    const uint16_t sum = static_cast<uint16_t>(rest_ + static_cast<uint16_t>(fine));
    rest_ = static_cast<uint8_t>(sum & 0xffu);
    return static_cast<int16_t>(sum >> 8);
  }
  // Winding and motion are watched in turns, block by block, with the same sums.
  bool is_turn_of_winding() const noexcept {
    return !has_motion() || (has_winding() && (found_ & 0x80u) == 0);
  }
  void close(uint8_t limit) noexcept {
    heat_.close();
    if (is_turn_of_winding()) winding_.close(sums_, limit, ticks_);
    else motion_.close(sums_, limit, ticks_);
    sums_.clear();
    found_ ^= 0x80u;
    ticks_ = 0;
  }
  void decide(uint8_t limit) noexcept {
    if ((found_ & 0x0fu) != 0) return;
    // Of several, what explains the others: a shorted winding heats more, too.
    Disagreement found = winding_.disagreement(limit);
    if (found == Disagreement::none) found = heat_.disagreement(limit);
    if (found == Disagreement::none) found = motion_.disagreement(limit);
    found_ = static_cast<uint8_t>(found_ | static_cast<uint8_t>(found));
  }

  detail::HeatPart<Plant, detail::HasHeatBalance<Plant>::value> heat_;
  detail::WindingPart<Plant, detail::HasWindingBalance<Plant>::value> winding_;
  detail::MotionPart<Plant, detail::HasMotionBalance<Plant>::value> motion_;
  typename detail::TurnSumsOf<(detail::HasWindingBalance<Plant>::value ||
                               detail::HasMotionBalance<Plant>::value)>::Type sums_;
  uint16_t ticks_ = 0;
  uint8_t rest_ = 0;   // of the time, 1/262144 s
  uint8_t found_ = 0;  // the disagreement, and whose turn it is
};

}  // namespace thermopower
