// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>

#include <string>

namespace thermopower::gap::files {

/// @brief The augmented model as a C++11 header for firmware: constants and policies in `namespace motor_model`.
///
/// Self-contained: it includes nothing, so that any firmware can take it, avr-gcc 5.4 with -std=gnu++11 included. Effects without a
/// counterpart in a firmware model (a sensor's error, an axis effect) appear as named constants and a comment that says so.
std::string motor_model_header(const Diagnosis& diagnosis);

}  // namespace thermopower::gap::files
