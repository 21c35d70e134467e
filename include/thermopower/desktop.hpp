// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file desktop.hpp
/// Everything that needs a desk: the firmware's models and policies, and the simulation they are tried on.
/// The diagnosis of gaps is in gap.hpp.

#include <thermopower/simulation/axis_batch.hpp>
#include <thermopower/simulation/rig_ours.hpp>
#include <thermopower/simulation/rig_policies.hpp>
#include <thermopower/simulation/rig_world.hpp>
#include <thermopower/simulation/scenarios.hpp>
#include <thermopower/thermopower.hpp>
