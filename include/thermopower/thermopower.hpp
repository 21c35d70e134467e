// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file thermopower.hpp
/// Everything that runs in firmware, and nothing else. No heap, no exception, no clock, no global, no
/// standard library beyond
/// `<stdint.h> <stddef.h> <math.h> <string.h>`.

#include "actuator/cached_current.hpp"
#include "actuator/cooling.hpp"
#include "actuator/current_model.hpp"
#include "actuator/duty.hpp"
#include "actuator/energy_meter.hpp"
#include "actuator/field_oriented.hpp"
#include "actuator/fixed_thermal_model.hpp"
#include "actuator/heating.hpp"
#include "actuator/observer_measurement.hpp"
#include "actuator/observer_thermal.hpp"
#include "actuator/ohmic_current.hpp"
#include "actuator/power_up.hpp"
#include "actuator/stored_state.hpp"
#include "actuator/tabulated_current.hpp"
#include "actuator/temperature_observer.hpp"
#include "actuator/thermal_model.hpp"
#include "actuator/thesis_current.hpp"
#include "actuator/two_node_thermal_model.hpp"
#include "control/adaptive_holding_law.hpp"
#include "control/air_temperature.hpp"
#include "control/axis_controller.hpp"
#include "control/certified_limiter.hpp"
#include "control/eased_gain.hpp"
#include "control/fixed_gimbal_controller.hpp"
#include "control/gain_scheduler.hpp"
#include "control/gimbal_controller.hpp"
#include "control/limit_reason.hpp"
#include "control/node_limits.hpp"
#include "control/position_error.hpp"
#include "control/safety_limiter.hpp"
#include "control/reserve_law.hpp"
#include "control/sag_aware_law.hpp"
#include "control/step_power_law.hpp"
#include "control/voltage_gain.hpp"
#include "motors/bgm2606_90t.hpp"
#include "motors/bgm5208_200_12.hpp"
#include "sbgc/codec.hpp"
#include "sbgc/poller.hpp"
#include "sbgc/power_and_gain.hpp"
#include "version.hpp"
