// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdexcept>

namespace thermopower::plant {

/// Thrown where the input of a plant or a diagnosis cannot be used; `what()` names the recording, column, field or
/// parameter and what was expected there.
class InvalidInput : public std::invalid_argument {
public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace thermopower::plant
