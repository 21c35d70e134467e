// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string_view>

namespace thermopower::plant {

/// The beginning of the ids of curves.
inline constexpr std::string_view curve_prefix = "unknown.";

/// Whether an effect is a curve: a smooth function of a recorded variable that nobody has named, such as
/// `unknown.load(angle_deg)`.
/// @param id  of the effect
inline bool is_curve(std::string_view id) { return id.substr(0, curve_prefix.size()) == curve_prefix; }

}  // namespace thermopower::plant
