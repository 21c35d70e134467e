// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The controller itself, apart from the loop that feeds it: what runs on the chip can be run on a PC as it
// is.
#pragma once

#include <thermopower/thermopower.hpp>

typedef thermopower::StepPowerLaw<thermopower::HysteresisLevels> PowerLaw;
typedef thermopower::SafetyLimiter<thermopower::PerSecond> Limiter;
typedef thermopower::GainScheduler<thermopower::RoundedGain> Gain;
typedef thermopower::AxisController<thermopower::motors::Bgm2606_90t, PowerLaw, Limiter, Gain> Small;
typedef thermopower::AxisController<thermopower::motors::Bgm5208_200_12, PowerLaw, Limiter, Gain> Large;
typedef thermopower::GimbalController<Small, Small, Large> Gimbal;

// A three-cell battery is empty at 9 V, and no room of this rig is warmer than 30 degC; your rig's supply, limits and gains go here.
inline Gimbal new_gimbal() {
  const thermopower::GimbalConfig config = {13.0f, 9.0f, 0.5f,
                                            thermopower::AirTemperature::Config::declared(30.0f), 20.0f};
  return Gimbal(config, Small::Config::with_gain({24.0f, 4.0f}), Small::Config::with_gain({180.0f, 105.0f}),
                Large::Config::with_gain({40.0f, 2.0f}));
}

// What happens to the motors while the chip has no power? Here one switch feeds it and the board. A board with a supply of
// its own keeps its last command: thermopower::DrivenOn<110>, where 110 degC is what its largest POWER makes of the motors.
typedef thermopower::OffTogether WhileOff;

// Without a record of what was, the motors may be as hot as their limit.
inline int16_t hottest_start_C() { return 60; }

inline void start(Gimbal& gimbal, float motor_C) {
  gimbal.axis<0>().start(motor_C);
  gimbal.axis<1>().start(motor_C);
  gimbal.axis<2>().start(motor_C);
}

// The largest POWER of all axes that may be in force.
inline uint8_t largest_power(const Gimbal& gimbal) {
  uint8_t largest = 0;
  for (uint8_t axis = 0; axis < 3; ++axis) {
    const uint8_t power = gimbal.force().expected(axis, gimbal.state().command.power[axis]);
    if (power > largest) largest = power;
  }
  return largest;
}

// The hottest motor in 1/128 degC and not below it. No temperature at all is the hottest there is.
inline int16_t hottest(const Gimbal& gimbal) {
  float hottest = gimbal.axis<0>().state().motor_C;
  if (!(hottest > gimbal.axis<1>().state().motor_C)) hottest = gimbal.axis<1>().state().motor_C;
  if (!(hottest > gimbal.axis<2>().state().motor_C)) hottest = gimbal.axis<2>().state().motor_C;
  return static_cast<int16_t>(hottest < 190.0f ? hottest * 128.0f + 1.0f : 190.0f * 128.0f);
}
