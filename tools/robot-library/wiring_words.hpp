// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/wiring.hpp>

#include <cstddef>
#include <vector>

namespace thermopower::robot {

/// @brief The findings that a wiring amounts to, one sentence each.
/// @param lost  joints whose positions lie outside their range, for no reason that the table has
std::vector<WiringFinding> wiring_words(const Robot& robot, const Wiring& wiring,
                                        const std::vector<std::size_t>& lost);

}  // namespace thermopower::robot
