// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/thermopower.hpp>

#include "counter.hpp"

// An operation is a function without arguments that takes its inputs from `given` and leaves a result in a
// volatile variable. Its objects are local statics, so that a program with one operation holds nothing of the
// others: that is how flash and RAM are measured. Inputs are made to be bad: the corners of every range
// first, then anything.
namespace cost {

namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

typedef tp::motors::Bgm2606_90t::AsProgrammed Small;
typedef tp::motors::Bgm5208_200_12::AsProgrammed Large;

extern volatile uint32_t sink;
extern volatile uint8_t small_sink;
extern volatile float real_sink;

/// What an operation is given: made outside the measured call.
struct Given {
  uint8_t level;
  fixed::CoarseTemperature warm, air;  ///< -50 .. 180 degC, -60 .. 125 degC.
  float warm_C, air_C;
  uint16_t error_units;  ///< 0 .. 8192
  float error_deg;
  fixed::Rate rate;  ///< -3.8 .. 3.8 K/s
  fixed::Ticks ticks;
  tp::LimitReason fault;
  int8_t camera_C, frame_C;
  float camera_real_C, frame_real_C, level_real, power_W, elapsed_s;
  uint16_t battery_cV;
  tp::MonitorInputs work;  ///< Of an actuator at work: made by the operations that take it.
  float work_s;
};
extern Given given;

/// The inputs of a round.
void give(uint16_t round);

/// As sbgc::RealtimeData.
struct Telemetry {
  int16_t target_angle(uint8_t axis) const { return static_cast<int16_t>(given.error_units << axis); }
  int16_t imu_angle(uint8_t) const { return 0; }
  float error_deg(uint8_t axis) const { return tp::sbgc::angle_deg(target_angle(axis)); }
  int8_t imu_C() const { return given.camera_C; }
  int8_t frame_imu_C() const { return given.frame_C; }
  uint16_t battery_cV() const { return given.battery_cV; }
  float battery_V() const { return static_cast<float>(given.battery_cV) * 0.01f; }
};

/// Inputs for an operation whose worst case is not at a corner: everything else is left as it was.
typedef void (*Search)(uint16_t round);

/// Prints `symbol|median|worst|stack`: time of a call and stack below the caller's, both beyond those of
/// an empty function.
/// @param set_up  called before each measured call, not measured
/// @param search         inputs to look for a worse case in, or null
/// @param search_rounds  how many
void row(const char* symbol, counter::Operation operation, counter::Operation set_up, Search search = nullptr,
         uint16_t search_rounds = 0);

extern "C" void cost_nothing();

}  // namespace cost

/// Measures an operation, which names.txt names for the reader.
#define thermopower_cost_after(operation, set_up) cost::row(#operation, operation, set_up)
/// Measures an operation that needs nothing before.
#define thermopower_cost(operation) cost::row(#operation, operation, cost::cost_nothing)

/// Measures an operation, and looks for its worst case in inputs of its own.
#define thermopower_cost_searched(operation, set_up, search, rounds) \
  cost::row(#operation, operation, set_up, search, rounds)

/// Measures the operations of a file.
extern "C" void measure_all();
