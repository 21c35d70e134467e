// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "trace.hpp"

#include <algorithm>
#include <cstdio>

namespace nano {
namespace {

namespace tp = thermopower;

// The types of nano_gimbal.ino.
typedef tp::StepPowerLaw<tp::ProgrammedLevels> PowerLaw;
typedef tp::SafetyLimiter<tp::PerCycle> Limiter;
typedef tp::GainScheduler<tp::TruncatedGain> Gain;
typedef tp::AxisController<tp::motors::Bgm2606_90t::AsProgrammed, PowerLaw, Limiter, Gain> Small;
typedef tp::AxisController<tp::motors::Bgm5208_200_12::AsProgrammed, PowerLaw, Limiter, Gain> Large;
typedef tp::GimbalController<Small, Small, Large> Gimbal;

template <class State>
AxisPoint point_of(const State& state, double true_C) {
  return {double(state.error_deg), state.demand, state.power, state.p_gain, double(state.motor_C), true_C, state.reason};
}

Gimbal::Inputs inputs_of(const tp::sbgc::RealtimeFields& telemetry) {
  Gimbal::Inputs inputs;
  for (int axis = 0; axis < 3; ++axis)
    inputs.error_deg[axis] = tp::sbgc::angle_deg(std::int32_t(telemetry.target_angle[axis]) - telemetry.imu_angle[axis]);
  inputs.camera_C = telemetry.imu_C;
  inputs.frame_C = telemetry.frame_imu_C;
  inputs.supply_V = static_cast<float>(telemetry.battery_cV) * 0.01f;
  return inputs;
}

}  // namespace

Trace Trace::of(const Rig& rig, const Story& story) {
  Gimbal gimbal(tp::GimbalConfig::standard(), Small::Config::with_gain({24.0f, 4.0f}), Small::Config::with_gain({180.0f, 105.0f}),
                Large::Config::with_gain({40.0f, 2.0f}));
  Trace trace;
  std::uint64_t before = 0;
  std::size_t sample = 0;
  for (const Update& update : rig.updates()) {
    const auto elapsed_us = static_cast<float>(update.last_in_cycle - before) / static_cast<float>(cycles_per_us);
    before = update.last_in_cycle;
    const Gimbal::Command& command = gimbal.step(inputs_of(update.telemetry), elapsed_us * 1e-6f);
    trace.agreeing += std::equal(command.power, command.power + 3, update.power) &&
                      std::equal(command.p_gain, command.p_gain + 3, update.p_gain);
    while (sample + 1 < story.samples().size() && story.samples()[sample + 1].time_s <= update.time_s()) ++sample;
    const auto& true_C = story.samples()[sample].motor_C;
    Point point = {update.time_s(), update.response_cycles(),
                   {point_of(gimbal.axis<0>().state(), true_C[0]), point_of(gimbal.axis<1>().state(), true_C[1]),
                    point_of(gimbal.axis<2>().state(), true_C[2])}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point.axes[axis].power = update.power[axis];
      point.axes[axis].p_gain = update.p_gain[axis];
    }
    trace.points.push_back(point);
  }
  return trace;
}

const char* words(tp::LimitReason reason) {
  switch (reason) {
    case tp::LimitReason::none: return "granted";
    case tp::LimitReason::safety_temperature: return "heating too fast";
    case tp::LimitReason::over_temperature: return "above 60 degC";
    case tp::LimitReason::recovering: return "recovering";
    default: return "fault";
  }
}

std::string Trace::csv() const {
  std::string text = "time_s,response_cycles";
  for (const char* axis : {"roll", "pitch", "yaw"})
    for (const char* column : {"error_deg", "demand", "power", "p_gain", "estimate_C", "true_C", "reason"})
      text += std::string(",") + axis + "_" + column;
  text += '\n';
  char buffer[160];
  for (const Point& point : points) {
    std::snprintf(buffer, sizeof buffer, "%.6f,%llu", point.time_s, static_cast<unsigned long long>(point.response_cycles));
    text += buffer;
    for (const AxisPoint& axis : point.axes) {
      std::snprintf(buffer, sizeof buffer, ",%.4f,%u,%u,%u,%.3f,%.3f,%s", axis.error_deg, unsigned(axis.demand), unsigned(axis.power),
                    unsigned(axis.p_gain), axis.estimate_C, axis.true_C, words(axis.reason));
      text += buffer;
    }
    text += '\n';
  }
  return text;
}

}  // namespace nano
