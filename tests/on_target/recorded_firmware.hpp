// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/thermopower.hpp>

#include "../../examples/pwm_motor/pwm_motor.h"

/// Firmwares whose runs are recorded on one machine and replayed on every other: recorded_runs.cpp, replayed_runs.cpp.
namespace on_target {

/// The gimbal of examples/nano_gimbal, in whole numbers, told what it reads of a telemetry message.
class RecordedGimbal {
public:
  struct Told {
    uint8_t is_silent;
    uint16_t target_angle[3], imu_angle[3];  // of two's complement
    uint8_t motor_power[3];
    uint8_t camera_C, frame_C;
    uint16_t battery_cV, ticks;

    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.is_silent, self.target_angle, self.imu_angle, self.motor_power, self.camera_C,
              self.frame_C, self.battery_cV, self.ticks);
    }
  };
  struct Answered {
    uint8_t power[3], p_gain[3], reason[3];
    uint16_t hottest;  // 1/128 degC

    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.power, self.p_gain, self.reason, self.hottest);
    }
  };

  Answered step(const Told& told) {
    const Telemetry telemetry = {told};
    const Gimbal::Command& command =
        told.is_silent != 0 ? gimbal_.step_silent(told.ticks) : gimbal_.step(telemetry, told.ticks);
    gimbal_.prepare();
    Answered answered;
    for (uint8_t axis = 0; axis < 3; ++axis) {
      answered.power[axis] = command.power[axis];
      answered.p_gain[axis] = command.p_gain[axis];
      answered.reason[axis] = static_cast<uint8_t>(command.reason[axis]);
    }
    answered.hottest = static_cast<uint16_t>(gimbal_.hottest());
    return answered;
  }

private:
  struct Telemetry {
    const Told& told;
    int16_t target_angle(uint8_t axis) const { return static_cast<int16_t>(told.target_angle[axis]); }
    int16_t imu_angle(uint8_t axis) const { return static_cast<int16_t>(told.imu_angle[axis]); }
    int8_t imu_C() const { return static_cast<int8_t>(told.camera_C); }
    int8_t frame_imu_C() const { return static_cast<int8_t>(told.frame_C); }
    uint16_t battery_cV() const { return told.battery_cV; }
    uint8_t motor_power(uint8_t axis) const { return told.motor_power[axis]; }
  };
  typedef thermopower::fixed_point::ThermalModel<
      thermopower::fixed_point::ThesisMotor<thermopower::motors::Bgm2606_90t::AsProgrammed> >
      Small;
  typedef thermopower::fixed_point::ThermalModel<
      thermopower::fixed_point::ThesisMotor<thermopower::motors::Bgm5208_200_12::AsProgrammed> >
      Large;
  typedef thermopower::fixed_point::SafetyLimiter<thermopower::fixed_point::ThesisLimit,
                                                  thermopower::fixed_point::PerCycle>
      Limiter;
  template <class Motor, uint8_t low, uint8_t high>
  using Axis =
      thermopower::fixed_point::AxisController<Motor, thermopower::fixed_point::ProgrammedLevels<>, Limiter,
                                               thermopower::fixed_point::TruncatedGain<low, high> >;
  typedef thermopower::fixed_point::GimbalController<Axis<Small, 24, 4>, Axis<Small, 180, 105>,
                                                     Axis<Large, 40, 2> >
      Gimbal;
  Gimbal gimbal_;
};

/// In floats with additions, products, quotients and square roots alone: the same bits on every machine.
typedef BasicPwmMotor<thermopower::EulerStep> RecordedEulerMotor;
/// With an exponential of the machine's own library: the same decisions, and a temperature that differs in its last bits.
typedef PwmMotor RecordedExactMotor;

}  // namespace on_target
