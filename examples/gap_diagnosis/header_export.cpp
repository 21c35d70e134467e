// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "header_export.hpp"

namespace thermopower::gap::files {

std::string motor_model_header(const Diagnosis& diagnosis) {
  (void)diagnosis;
  return "#pragma once\n";
}

}  // namespace thermopower::gap::files
