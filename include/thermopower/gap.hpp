// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file gap.hpp
/// The diagnosis of a sim-to-real gap, for whoever uses it: models and recordings in, a diagnosis out.

#include <thermopower/gap/diagnose.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/standard_catalogue.hpp>
