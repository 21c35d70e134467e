// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "gimbal.h"

#include <thermopower/thermopower.hpp>

namespace tp = thermopower;

namespace {

typedef tp::AxisController<tp::motors::Bgm2606_90t> Small;
typedef tp::AxisController<tp::motors::Bgm5208_200_12> Large;

tp::GimbalController<Small, Small, Large>& gimbal() {
  static tp::GimbalController<Small, Small, Large> instance(
      tp::GimbalConfig::standard(), Small::Config::with_gain({24.0f, 4.0f}),
      Small::Config::with_gain({180.0f, 105.0f}), Large::Config::with_gain({40.0f, 2.0f}));
  return instance;
}

gimbal_command as_c(const tp::GimbalCommand<3>& command) {
  gimbal_command result;
  for (uint8_t axis = 0; axis < 3; ++axis) {
    result.power[axis] = command.power[axis];
    result.p_gain[axis] = command.p_gain[axis];
    result.reason[axis] = static_cast<uint8_t>(command.reason[axis]);
  }
  return result;
}

}  // namespace

extern "C" {

uint8_t gimbal_begin(void) { return static_cast<uint8_t>(gimbal().validate().field); }

gimbal_command gimbal_step(const float error_deg[3], float camera_C, float frame_C, float supply_V,
                           float dt_s) {
  const tp::GimbalInputs<3> inputs = {
      {error_deg[0], error_deg[1], error_deg[2]}, camera_C, frame_C, supply_V};
  return as_c(gimbal().step(inputs, dt_s));
}

gimbal_command gimbal_step_silent(float dt_s) { return as_c(gimbal().step_silent(dt_s)); }

float gimbal_motor_C(uint8_t axis) {
  switch (axis) {
    case 0:
      return gimbal().axis<0>().state().motor_C;
    case 1:
      return gimbal().axis<1>().state().motor_C;
    case 2:
      return gimbal().axis<2>().state().motor_C;
    default:
      return tp::detail::not_a_number();
  }
}

}  // extern "C"
