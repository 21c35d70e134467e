// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "story.hpp"

#include <cmath>

namespace nano {
namespace {

namespace tp = thermopower;

constexpr double supply_V = 13.0;
constexpr double air_C = 38.0;  // in the sun

}  // namespace

const std::vector<Phase>& Story::phases() {
  static const std::vector<Phase> all = {{"rest", 0, 4},          {"small motion", 4, 10},
                                         {"gusts", 10, 17},       {"push across 180 degrees", 17, 21},
                                         {"full demand", 21, 46}, {"recovery", 46, 60}};
  return all;
}

const Phase& Story::phase_at(double time_s) {
  for (const Phase& phase : phases())
    if (time_s < phase.to_s) return phase;
  return phases().back();
}

template <class Motor>
Story::Axis Story::axis_of() {
  const Thermal::Config thermal = {Motor::template heating_law<double>(),
                                   Motor::template cooling_law<double>()};
  return Axis{Current(Motor::template current_law<double>()), Thermal(thermal, air_C), {}, {}};
}

Story::Story()
    : axes_{axis_of<tp::motors::Bgm2606_90t>(), axis_of<tp::motors::Bgm2606_90t>(),
            axis_of<tp::motors::Bgm5208_200_12>()} {}

Rig::Truth Story::advance(double time_s, const Rig::Board& board) {
  Rig::Truth truth;
  Sample sample = {time_s, {}};
  for (int axis = 0; axis < 3; ++axis) {
    Axis& motor = axes_[static_cast<std::size_t>(axis)];
    const Current::State drawn =
        motor.current.at_power(double(board.power(axis)), supply_V, motor.thermal.hottest_C());
    const Thermal::Inputs heat = {drawn.winding_power_W, drawn.v_rms_V, {air_C, 0.0}};
    motor.thermal.step(heat, time_s - last_s_);
    motor.winding.step(drawn.v_rms_V, supply_V, drawn.current_A, time_s - last_s_);
    motor.supply.step(drawn.v_rms_V, supply_V, drawn.current_A, time_s - last_s_);
    truth.current_A += drawn.current_A;
    sample.motor_C[static_cast<std::size_t>(axis)] = motor.thermal.hottest_C();
  }
  last_s_ = time_s;
  samples_.push_back(sample);

  const double ripple = 0.03 * std::sin(19 * time_s);
  double error_deg[3] = {ripple, -ripple, ripple};
  const std::string phase = phase_at(time_s).name;
  const double into_s = time_s - phase_at(time_s).from_s;
  if (phase == "small motion") {
    error_deg[0] += 0.25 * std::sin(2.4 * into_s);
    error_deg[1] += 0.45 * std::sin(1.7 * into_s);
    error_deg[2] += 0.15 * std::sin(1.1 * into_s);
  } else if (phase == "gusts") {
    const double gust = std::exp(-2 * std::pow(std::fmod(into_s, 3.0) - 0.8, 2));
    error_deg[0] += 1.3 * gust * std::sin(9 * into_s);
    error_deg[1] += 0.9 * gust;
    error_deg[2] += 0.7 * gust * std::cos(5 * into_s);
  } else if (phase == "push across 180 degrees") {
    error_deg[2] += 200 * std::sin(3.14159265 * into_s / 4);
    error_deg[0] += 0.3 * std::sin(4 * into_s);
  } else if (phase == "full demand") {
    error_deg[0] += 1.6 + 0.3 * std::sin(3 * into_s);
    error_deg[1] += -1.4;
    error_deg[2] += 1.2 + 0.1 * std::sin(2 * into_s);
  } else if (phase == "recovery") {
    error_deg[0] += 0.15 + 1.1 * std::exp(-into_s / 4);
    error_deg[1] += -0.3 - 0.9 * std::exp(-into_s / 6);
    error_deg[2] += 1.2 * std::exp(-into_s / 2);
  }
  for (int axis = 0; axis < 3; ++axis) truth.angle_deg[axis] = truth.target_deg[axis] - error_deg[axis];
  truth.camera_air_C = truth.frame_air_C = air_C;
  truth.battery_V = supply_V - 0.05 * truth.current_A;
  return truth;
}

}  // namespace nano
