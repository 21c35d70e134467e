// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/detail/diagnoser.hpp>
#include <thermopower/gap/diagnose.hpp>

#include <vector>

namespace thermopower::gap {

THERMOPOWER_GAP_INLINE Diagnosis diagnose(const Model& model, const std::vector<Recording>& train,
                                          const std::vector<Recording>& held_out, const Options& options,
                                          const Catalogue& catalogue) {
  return engine::Diagnoser(model, options, catalogue).run(train, held_out);
}

}  // namespace thermopower::gap
