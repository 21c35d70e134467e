/* SPDX-License-Identifier: MIT */
/* Copyright (c) 2026 the thermopower authors */
#pragma once

/* A thin C face of one gimbal controller, for a firmware written in C. Only this header is seen by C; gimbal.cpp is the one C++ file. */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  uint8_t power[3];  /* POWER of roll, pitch, yaw */
  uint8_t p_gain[3]; /* P of roll, pitch, yaw */
  uint8_t reason[3]; /* thermopower::LimitReason as a number; 0 is none, 64 and up are faults */
} gimbal_command;

/* Makes the controller. Returns 0, or the number of the first wrong field (thermopower::ConfigError). */
uint8_t gimbal_begin(void);

/* One cycle: errors in degrees, temperatures in degC (NAN when not fitted), supply in volt, seconds since the last cycle. */
gimbal_command gimbal_step(const float error_deg[3], float camera_C, float frame_C, float supply_V, float dt_s);

/* One cycle without telemetry. */
gimbal_command gimbal_step_silent(float dt_s);

/* Estimated temperature of an axis's motor, degC; NAN before the first telemetry, and for an axis that does not exist. */
float gimbal_motor_C(uint8_t axis);

#ifdef __cplusplus
}
#endif
