// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "trace.hpp"

#include "recorded_telemetry.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace nano {
namespace {

namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

// The types of nano_gimbal.ino.
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t::AsProgrammed>> Small;
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm5208_200_12::AsProgrammed>> Large;
typedef fixed::SafetyLimiter<fixed::ThesisLimit, fixed::PerCycle> Limiter;
typedef fixed::AxisController<Small, fixed::ProgrammedLevels<>, Limiter, fixed::TruncatedGain<24, 4>> Roll;
typedef fixed::AxisController<Small, fixed::ProgrammedLevels<>, Limiter, fixed::TruncatedGain<180, 105>>
    Pitch;
typedef fixed::AxisController<Large, fixed::ProgrammedLevels<>, Limiter, fixed::TruncatedGain<40, 2>> Yaw;
typedef fixed::BasicGimbalController<fixed::ProgrammedGimbal, Roll, Pitch, Yaw> Gimbal;

template <class Axis>
AxisPoint point_of(const Axis& axis, const RecordedTelemetry& telemetry, std::uint8_t index, double true_C) {
  const std::int16_t error =
      tp::position_error_units(telemetry.target_angle(index), telemetry.imu_angle(index));
  const std::uint8_t demand =
      fixed::ProgrammedLevels<>().step(static_cast<std::uint16_t>(std::abs(int(error))));
  const tp::LimitedPower& granted = axis.state();
  return {double(tp::deg_from_units(error)), demand, granted.power, axis.p_gain(),
          double(axis.thermal().motor_C()),  true_C, granted.reason};
}

}  // namespace

Trace Trace::of(const Rig& rig, const Story& story) {
  Gimbal gimbal;
  fixed::Clock clock;
  Trace trace;
  std::size_t sample = 0;
  for (const Update& update : rig.updates()) {
    const RecordedTelemetry telemetry = {update.telemetry};
    const auto now_us =
        static_cast<std::uint32_t>(update.last_in_cycle / static_cast<std::uint64_t>(cycles_per_us));
    const Gimbal::Command& command = gimbal.step(telemetry, clock.elapsed(now_us));
    gimbal.prepare();
    trace.agreeing += std::equal(command.power, command.power + 3, update.power) &&
                      std::equal(command.p_gain, command.p_gain + 3, update.p_gain);
    while (sample + 1 < story.samples().size() && story.samples()[sample + 1].time_s <= update.time_s())
      ++sample;
    const auto& true_C = story.samples()[sample].motor_C;
    Point point = {update.time_s(),
                   update.response_cycles(),
                   {point_of(gimbal.axis<0>(), telemetry, 0, true_C[0]),
                    point_of(gimbal.axis<1>(), telemetry, 1, true_C[1]),
                    point_of(gimbal.axis<2>(), telemetry, 2, true_C[2])}};
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
    case tp::LimitReason::none:
      return "granted";
    case tp::LimitReason::safety_temperature:
      return "heating too fast";
    case tp::LimitReason::over_temperature:
      return "above 60 degC";
    case tp::LimitReason::recovering:
      return "recovering";
    default:
      return "fault";
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
    std::snprintf(buffer, sizeof buffer, "%.6f,%llu", point.time_s,
                  static_cast<unsigned long long>(point.response_cycles));
    text += buffer;
    for (const AxisPoint& axis : point.axes) {
      std::snprintf(buffer, sizeof buffer, ",%.4f,%u,%u,%u,%.3f,%.3f,%s", axis.error_deg,
                    unsigned(axis.demand), unsigned(axis.power), unsigned(axis.p_gain), axis.estimate_C,
                    axis.true_C, words(axis.reason));
      text += buffer;
    }
    text += '\n';
  }
  return text;
}

}  // namespace nano
