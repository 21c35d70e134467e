// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>

namespace thermopower::io {

/// @brief What people ask of an effect beside what the catalogue says of it.
struct EffectNotes {
  const char* id;             ///< of the effect
  const char* shows;          ///< how it shows in a recording
  const char* mistaken_for;   ///< what it can be mistaken for, and why
  const char* in_simulators;  ///< how simulators write it
  const char* ignore_when;    ///< when it can be ignored
};

/// @brief The notes on an effect of the standard catalogue; null for any other.
const EffectNotes* notes_of(const std::string& effect);

}  // namespace thermopower::io
