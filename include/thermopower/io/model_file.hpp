// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/catalogue.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/io/names.hpp>

#include <string>

namespace thermopower::io {

/// @brief Reads a model file ("thermopower-model/1"). Strict: an unknown key, a repeated key, a wrong type and a constant
/// outside its range are errors, named by their line and JSON pointer (`/current/resistance_ohm`); syntax errors by line
/// and column. A block `network` makes a model of a plant::ThermalNetwork, with effects of its own.
///
/// May be left out: `name`, whole blocks, `tempco_per_K` (0) and `reference_C` (25) of the ohmic law,
/// `minimum_V_rms` (1) of the thesis laws. Effects must be in the catalogue, with all their parameters,
/// inside the parameters' bounds.
/// @throws InputError
Model read_model(const std::string& path, const Catalogue& catalogue);

/// @brief The same on text in memory; `name` stands in messages where a path would.
Model parse_model(const std::string& name, const std::string& text, const Catalogue& catalogue);

/// @brief The model file of a model: read_model() gives back the same numbers, bit by bit.
std::string to_json(const Model& model);

}  // namespace thermopower::io
