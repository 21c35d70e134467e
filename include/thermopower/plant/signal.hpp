// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/open_name.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace thermopower::plant {

/// A measured output of a plant, by its place in the plant's list of signals.
///
/// The members are the signals of our own plants. A plant of the user's own counts its signals from 0, too
/// (`static_cast<Signal>(i)`); what they are called, and their units, then stands in its list, and
/// `to_string` and `unit_of` do not apply.
enum class Signal : int {
  current_A = 0,    ///< motor current; of an axis under a servo, its measured effort
  motor_C = 1,      ///< what the motor's thermometer shows
  angle_deg = 2,    ///< angle of the axis
  rate_dps = 3,     ///< its rate
  power_param = 4,  ///< duty of the heater in 255 parts, where a loop makes it; not judged
};

/// Number of signals of our own plants.
inline constexpr int actuator_signal_count = 5;

/// Most signals that a plant may have, a user's own included: three joints have six. Arrays by signal are this long;
/// the places that a plant does not use stay empty.
inline constexpr int signal_count = 8;

/// A value for each place of an array by signal, all alike.
template <class T>
std::array<T, signal_count> for_each_signal(T value) {
  std::array<T, signal_count> all;
  all.fill(value);
  return all;
}

/// Number of signals in the closed set.
inline constexpr int count_of(Signal) { return actuator_signal_count; }

/// Column name of a signal of our own plants.
inline const char* to_string(Signal signal) {
  constexpr const char* names[] = {"current_A", "motor_C", "angle_deg", "rate_dps", "power_param"};
  return names[static_cast<int>(signal)];
}

/// Unit of a signal of our own plants as reports spell it.
inline const char* unit_of(Signal signal) {
  constexpr const char* units[] = {"A", "degC", "deg", "deg/s", ""};
  return units[static_cast<int>(signal)];
}

/// A signal in a report: one of our plants, or a column of a user's own.
using SignalName = OpenName<Signal>;

/// One value for each signal of a plant, indexed by the signal.
///
/// @snippet plant_examples.cpp per signal
/// How to: @ref gap_method.
template <class T>
class PerSignal {
public:
  /// For the signals of our own plants, all values alike.
  PerSignal(const T& value = T())
      : PerSignal(actuator_signal_count, value) {}  // NOLINT(google-explicit-constructor)
  /// For a plant of `count` signals, >= 0, all values alike.
  PerSignal(int count, const T& value) : values_(static_cast<std::size_t>(count), value) {}

  /// The value of a signal, which must be one of the plant's.
  T& operator[](Signal signal) { return values_[static_cast<std::size_t>(signal)]; }
  /// The value of a signal, which must be one of the plant's.
  const T& operator[](Signal signal) const { return values_[static_cast<std::size_t>(signal)]; }

  /// Number of signals.
  int count() const { return static_cast<int>(values_.size()); }

  /// The values in the order of the signals.
  typename std::vector<T>::iterator begin() { return values_.begin(); }
  /// One past the last.
  typename std::vector<T>::iterator end() { return values_.end(); }
  /// The values in the order of the signals.
  typename std::vector<T>::const_iterator begin() const { return values_.begin(); }
  /// One past the last.
  typename std::vector<T>::const_iterator end() const { return values_.end(); }

private:
  std::vector<T> values_;
};

}  // namespace thermopower::plant
