// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file definitions.hpp
/// Every definition that the public headers of the diagnosis leave to a library if THERMOPOWER_GAP_LIBRARY is defined. The
/// one source file that compiles them includes it.

#include <thermopower/gap/detail/check.hpp>
#include <thermopower/gap/detail/check_data.hpp>
#include <thermopower/gap/detail/diagnose.hpp>
#include <thermopower/gap/detail/simulate.hpp>
#include <thermopower/plant/detail/actuator_plant.hpp>
#include <thermopower/plant/detail/catalogue.hpp>
#include <thermopower/plant/detail/expression.hpp>
#include <thermopower/plant/detail/model.hpp>
#include <thermopower/plant/detail/network_plant.hpp>
#include <thermopower/plant/detail/standard_catalogue.hpp>
