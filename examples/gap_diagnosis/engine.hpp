// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/catalogue.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/options.hpp>
#include <thermopower/gap/recording.hpp>

#include <vector>

namespace thermopower::gap::files {

/// @brief The diagnosis with the standard catalogue, compiled once: the templates behind it take a compiler minutes.
Diagnosis run_diagnosis(const Model& model, const std::vector<Recording>& train, const std::vector<Recording>& held_out,
                        const Options& options);

}  // namespace thermopower::gap::files
