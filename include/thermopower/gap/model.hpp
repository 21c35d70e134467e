// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/model.hpp>

namespace thermopower::gap {

using namespace plant;  // NOLINT: what a user of the diagnosis names comes from both

}  // namespace thermopower::gap
