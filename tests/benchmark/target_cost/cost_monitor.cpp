// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The cost of the monitor: of a step in which a block closes above all. And of what people write on their own.
#include "cost.hpp"
#include "rivals.hpp"

using namespace cost;

namespace {

/// A printer's hotend: two masses, a lag, a fan.
struct Hotend {
  static constexpr tp::MonitorConfig monitor() { return {8.0, 1000.0, true}; }
  static constexpr tp::HeatBalanceConfig heat_balance() {
    return {40.0, 0.06, 14.0, 0.06, 4.0, 90.0, 0.15, 4.0, 0.15, 0.13, 0.06, 0.07, 0.1, 5.0, 0.15, 0.05, 0.2};
  }
};
/// A motor with a thermometer on its housing, measured current, voltage and speed.
struct Motor {
  static constexpr tp::MonitorConfig monitor() { return {10.0, 1000.0, true}; }
  static constexpr tp::HeatBalanceConfig heat_balance() {
    return tp::HeatBalanceConfig::measured_body(30.0, 8.0, 80.0, 1.0, 0.2, 0.1, 0.3);
  }
  static constexpr tp::WindingBalanceConfig winding_balance() {
    return {24.0, 12.0, 0.05, 0.00393, 25.0, 15.0, 0.2, 0.1};
  }
  static constexpr tp::MotionBalanceConfig motion_balance() {
    return {4.0, 400.0, 2.0, 0.05, 0.05, 1e-5, 0.05, 0.004, 1e-5, 0.3, 0.002, 0.002};
  }
};

uint32_t random_number = 1;
float between(float low, float high) {
  random_number = random_number * 1664525u + 1013904223u;
  return low + (high - low) * static_cast<float>(random_number >> 16) * (1.0f / 65536.0f);
}

/// What an actuator at work gives, in steps of which ten close a block.
void give_work() {
  given.work = tp::MonitorInputs::motor(between(0.0f, 40.0f), between(-20.0f, 280.0f), between(-10.0f, 45.0f),
                                        between(-24.0f, 24.0f), between(-3.9f, 3.9f), between(-20.0f, 180.0f),
                                        between(-400.0f, 400.0f));
  given.work.fan = static_cast<uint8_t>(between(0.0f, 255.0f));
  given.work_s = between(0.5f, 1.5f);
}

void give_more(uint16_t) {}

template <class Plant>
void step_monitor() {
  static tp::ModelMonitor<Plant> monitor;
  small_sink = static_cast<uint8_t>(monitor.step(given.work, given.work_s));
}

}  // namespace

extern "C" void monitor_heater() { step_monitor<Hotend>(); }
extern "C" void monitor_motor() { step_monitor<Motor>(); }

extern "C" void rival_model() {
  static rivals::EightLineModel model(14.0f, 0.23f, 110.0f, 25.0f);
  small_sink = model.step(given.power_W, given.level, given.elapsed_s);
}
extern "C" void rival_derating() {
  static rivals::LinearDerating derating(70.0f, 90.0f);
  small_sink = derating.step(given.warm_C, given.level);
}
extern "C" void rival_square() {
  static rivals::CurrentSquareOverTime square(1.4f, 30.0f);
  small_sink = square.step(given.power_W, given.level, given.elapsed_s);
}

extern "C" void measure_all() {
  thermopower_cost_searched(monitor_heater, give_work, give_more, counter::searches / 20);
  thermopower_cost_searched(monitor_motor, give_work, give_more, counter::searches / 20);
  thermopower_cost(rival_model);
  thermopower_cost(rival_derating);
  thermopower_cost(rival_square);
}
