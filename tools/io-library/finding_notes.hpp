// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/finding.hpp>
#include <thermopower/io/names.hpp>

#include <vector>

namespace thermopower::io {

/// @brief What people ask of a finding.
struct FindingNotes {
  FindingKind kind;          ///< which
  const char* is;            ///< what it is
  const char* shows;         ///< how it shows, and what the check does about it
  const char* mistaken_for;  ///< what it can be mistaken for
  const char* experiment;    ///< how to record without it, or what to type
  const char* ignore_when;   ///< when it can be ignored
};

/// @brief The notes on every finding, in the order of FindingKind.
const std::vector<FindingNotes>& finding_notes();

}  // namespace thermopower::io
