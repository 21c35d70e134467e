// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check_data.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/options.hpp>
#include <thermopower/gap/recording.hpp>

#include <string>
#include <vector>

namespace thermopower::gap::files {

/// @brief The diagnosis with the standard catalogue, compiled once: the templates behind it take a compiler
/// minutes.
Diagnosis run_diagnosis(const Model& model, const std::vector<Recording>& train,
                        const std::vector<Recording>& held_out, const Options& options);

/// @brief What data are worth before anything is fitted, with the standard catalogue.
DataReport run_check(const Model& model, const std::vector<Recording>& train,
                     const std::vector<Recording>& held_out, const Options& options);

/// @brief One simulated signal, a value per row; NaN where it could not be simulated.
struct SimulatedColumn {
  std::string signal;
  Eigen::VectorXd values;
};

/// @brief Free-running simulation with the standard catalogue, as held-out data is judged.
/// @param horizon_s length of the windows in which an axis runs freely, in s
std::vector<SimulatedColumn> run_simulation(const Model& model, const Recording& recording, double horizon_s);

}  // namespace thermopower::gap::files
