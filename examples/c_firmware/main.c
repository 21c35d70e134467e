/* SPDX-License-Identifier: MIT */
/* Copyright (c) 2026 the thermopower authors */

/* Problem:  a firmware written in C wants the gimbal controller. It includes one header and calls three functions. */
#include "gimbal.h"

#include <stdio.h>

int main(void) {
  const float calm[3] = {0.05f, 0.05f, 0.05f};
  const float gust[3] = {0.55f, 2.0f, -359.0f};
  gimbal_command command;
  int i;

  if (gimbal_begin() != 0) return 1;
  command = gimbal_step_silent(0.01f);
  printf("before telemetry: power %d, reason %d\n", command.power[0], command.reason[0]);
  if (command.power[0] != 1 || command.reason[0] < 64) return 1;

  for (i = 0; i < 100; ++i) command = gimbal_step(calm, 25.0f, 25.0f, 12.6f, 0.01f);
  printf("at rest:   power %3d %3d %3d\n", command.power[0], command.power[1], command.power[2]);
  for (i = 0; i < 6000; ++i) command = gimbal_step(gust, 25.0f, 25.0f, 12.6f, 0.01f);
  printf("in a gust: power %3d %3d %3d, motors %.1f %.1f %.1f degC\n", command.power[0], command.power[1], command.power[2],
         (double)gimbal_motor_C(0), (double)gimbal_motor_C(1), (double)gimbal_motor_C(2));
  /* A minute at full power brings the small pitch motor to its limit; roll asks for half, and yaw's -359 degrees are one. */
  return command.power[0] == 125 && command.power[1] < 250 && command.power[2] == 250 ? 0 : 1;
}
