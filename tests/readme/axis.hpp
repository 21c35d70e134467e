// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

// What the README leaves to its reader.
void set_motor(uint8_t power, uint8_t p_gain);

// What the README gives.
void control_cycle(float error_deg, float supply_V, float air_C, float dt_s);
