// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/simulation/random.hpp>
#include <thermopower/simulation/scenario.hpp>
#include <thermopower/simulation/thesis_gimbal.hpp>

/// @file scenarios.hpp
/// The runs on which policies are compared.
///
/// | scenario | what happens |
/// |---|---|
/// | `rest` | nothing: hold the pose |
/// | `motion` | the drone sways and turns, up to 20 degrees |
/// | `gusts` | sway, and a wind with a spectrum up to 3 Hz |
/// | `impacts` | short pushes on every axis, one of which carries yaw across 180 degrees |
/// | `hot_start` | the motors come from a hard run: 50 degC in air of 35 degC, then gusts |
/// | `weak_battery` | the end of a three-cell battery with a high resistance, in sway and gusts |

namespace thermopower::simulation {

namespace detail {

inline Scenario blank(const char* name, double duration_s) {
  Scenario scenario;
  scenario.name = name;
  scenario.duration_s = duration_s;
  scenario.supply = bench_supply<double>();
  return scenario;
}

/// A drone that sways: slow attitude changes and a wobble.
inline void sway(Scenario& scenario, double amplitude_deg, double from_s, double to_s, std::uint64_t seed) {
  Random random(seed);
  for (AxisScenario& axis : scenario.axes) {
    const auto wave = [&](double amplitude, double least_Hz, double most_Hz) {
      axis.base.push_back({amplitude * random.between(0.8, 1.0), random.between(least_Hz, most_Hz),
                           random.between(0.0, 2.0 * M_PI), from_s, to_s});
    };
    wave(amplitude_deg, 0.15, 0.3);
    wave(0.3 * amplitude_deg, 0.5, 0.9);
    wave(0.08 * amplitude_deg, 1.5, 2.5);
  }
}

/// Wind torque on the camera: sines of random phase whose amplitude falls with frequency as Dryden's spectrum
/// does.
inline void gusts(Scenario& scenario, const std::array<double, 3>& rms_Nm, double from_s, double to_s,
                  std::uint64_t seed) {
  Random random(seed);
  constexpr int count = 14;
  for (std::size_t index = 0; index < 3; ++index) {
    double amplitude[count], frequency_Hz[count], sum = 0.0;
    for (int i = 0; i < count; ++i) {
      frequency_Hz[i] = 0.05 * std::pow(60.0, (i + random.between(0.0, 1.0)) / count);
      const double ratio = frequency_Hz[i] / 0.3;
      amplitude[i] = std::sqrt(frequency_Hz[i] / (1.0 + ratio * ratio));
      sum += 0.5 * amplitude[i] * amplitude[i];
    }
    for (int i = 0; i < count; ++i)
      scenario.axes[index].wind.push_back({rms_Nm[index] * amplitude[i] / std::sqrt(sum), frequency_Hz[i],
                                           random.between(0.0, 2.0 * M_PI), from_s, to_s});
  }
}

/// Torque of the gusts on a camera of this size.
inline constexpr std::array<double, 3> gust_rms_Nm = {0.0015, 0.0020, 0.0080};

}  // namespace detail

/// Nothing happens. @param duration_s  length
inline Scenario rest(double duration_s = 300.0) { return detail::blank("rest", duration_s); }

/// The drone sways. @param seed  equal seeds give equal runs
inline Scenario motion(double duration_s = 300.0, std::uint64_t seed = 11) {
  Scenario scenario = detail::blank("motion", duration_s);
  detail::sway(scenario, 15.0, 0.0, duration_s, seed);
  return scenario;
}

/// Sway and wind.
inline Scenario gusts(double duration_s = 300.0, std::uint64_t seed = 12) {
  Scenario scenario = detail::blank("gusts", duration_s);
  scenario.airspeed_mps = 1.0;
  detail::sway(scenario, 5.0, 0.0, duration_s, seed);
  detail::gusts(scenario, detail::gust_rms_Nm, 0.0, duration_s, seed + 1000);
  return scenario;
}

/// Pushes every few seconds, some of them beyond what the motors can hold; one carries yaw across 180
/// degrees.
inline Scenario impacts(double duration_s = 300.0, std::uint64_t seed = 13) {
  Scenario scenario = detail::blank("impacts", duration_s);
  Random random(seed);
  const std::array<double, 3> peak_Nm = {0.02, 0.04, 0.10};
  for (std::size_t index = 0; index < 3; ++index)
    for (double at_s = 8.0 + 2.0 * static_cast<double>(index); at_s < duration_s - 6.0;
         at_s += random.between(6.0, 12.0))
      scenario.axes[index].pushes.push_back(
          {at_s, random.between(0.03, 0.12),
           random.between(-1.0, 1.0) < 0.0 ? -peak_Nm[index] : peak_Nm[index]});
  scenario.axes[2].target_deg = 170.0;
  scenario.axes[2].pushes.push_back({0.5 * duration_s, 0.5, 0.35});
  return scenario;
}

/// Motors that are warm from a run before which nobody told the controller of.
inline Scenario hot_start(double duration_s = 300.0, std::uint64_t seed = 14) {
  Scenario scenario = gusts(duration_s, seed);
  scenario.name = "hot start";
  scenario.airspeed_mps = 0.0;
  scenario.air_C = 35.0;
  for (AxisScenario& axis : scenario.axes) axis.winding_C = 52.0, axis.body_C = 50.0;
  return scenario;
}

/// The end of a battery: 11 V without load, 1.2 ohm, and falling.
inline Scenario weak_battery(double duration_s = 300.0, std::uint64_t seed = 15) {
  Scenario scenario = gusts(duration_s, seed);
  scenario.name = "weak battery";
  scenario.supply = {12.6, 9.6, 1800.0, 1.2};
  scenario.charge = 0.45;
  return scenario;
}

/// All of the above, in that order. @param draw  other numbers give other winds, motions and pushes
inline std::vector<Scenario> standard_scenarios(double duration_s = 300.0, std::uint64_t draw = 0) {
  const std::uint64_t seed = 11 + 100 * draw;
  return {rest(duration_s),
          motion(duration_s, seed),
          gusts(duration_s, seed + 1),
          impacts(duration_s, seed + 2),
          hot_start(duration_s, seed + 3),
          weak_battery(duration_s, seed + 4)};
}

}  // namespace thermopower::simulation
