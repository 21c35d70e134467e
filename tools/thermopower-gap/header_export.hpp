// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>

#include <string>

namespace thermopower::gap::files {

/// @brief A model with its effects as a C++11 header for firmware: `motor_model::Motor`, a motor type as
/// `AxisController` takes it.
///
/// Policies of the library where there is one for an effect (cooling by convection, radiation or airflow, a
/// second thermal mass, the current law), small functions for the other thermal, electrical and sensing
/// effects, and named constants for the axis. Compiles wherever the library's firmware headers do (avr-gcc
/// 5.4 with -std=gnu++11). What has no counterpart in firmware is listed in a comment and kept as constants:
/// nothing is dropped silently.
/// @param origin one line that says where it comes from, for the comment on top
std::string motor_model_header(const Model& model, const std::string& origin);

}  // namespace thermopower::gap::files
