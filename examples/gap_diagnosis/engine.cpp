// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "engine.hpp"

#include <thermopower/gap/diagnose.hpp>
#include <thermopower/gap/standard_catalogue.hpp>

namespace thermopower::gap::files {

Diagnosis run_diagnosis(const Model& model, const std::vector<Recording>& train, const std::vector<Recording>& held_out,
                        const Options& options) {
  return diagnose(model, train, held_out, options, standard_catalogue());
}

}  // namespace thermopower::gap::files
