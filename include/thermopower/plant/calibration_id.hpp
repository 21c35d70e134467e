// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>

namespace thermopower::plant {

/// The beginning of the ids of causes that are constants.
inline constexpr char calibration_prefix[] = "calibration.";

/// The name of a constant as a cause. @param constant  its id, such as `resistance`
inline std::string calibration_id(const std::string& constant) { return calibration_prefix + constant; }

/// Whether a cause or a coordinate is a constant, and no effect.
inline bool is_calibration(const std::string& id) { return id.rfind(calibration_prefix, 0) == 0; }

}  // namespace thermopower::plant
