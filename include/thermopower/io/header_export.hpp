// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/plant/standard_catalogue.hpp>
#include <thermopower/io/names.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// A model for firmware.
struct MotorModelHeader {
  std::string text;                   ///< the header
  std::vector<std::string> left_out;  ///< one sentence each: what firmware's types cannot express
};

/// @brief A model with its effects as a C++11 header for firmware: `motor_model::Motor`, a motor type as
/// `AxisController` takes it.
///
/// Effects write themselves: their own equations are traced with an Expression and printed as code, those of
/// the catalogue and a user's own alike. What they do to the circuit becomes `v_rms_V()`, to the heat
/// `heat_W()`, to the loss the policy `Cooling`, to drive, load and friction `drive_Nm()`, `load_Nm()` and
/// `dry_friction_Nm()`; the errors of sensors are undone by `true_...()`. The shape of the model (nodes, lags, delays,
/// springs) is a policy of the library or a named constant. Compiles wherever the library's firmware headers do (avr-gcc
/// 5.4 with -std=gnu++11).
///
/// A part without a counterpart in firmware is listed in the header and in `left_out`, and its parameters are kept as
/// constants: nothing is dropped silently.
/// @param model      with its effects
/// @param origin     one line that says where it comes from, for the comment on top
/// @param catalogue  knows the equations of the model's effects; of others the constants are kept
MotorModelHeader motor_model_header(const Model& model, const std::string& origin,
                                    const Catalogue& catalogue = standard_catalogue());

}  // namespace thermopower::io
