// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/inline.hpp>

namespace thermopower::plant {

/// The catalogue that comes with the library; copy it and add() to the copy to extend it.
const Catalogue& standard_catalogue();

}  // namespace thermopower::plant

#ifndef THERMOPOWER_GAP_LIBRARY
#include <thermopower/plant/detail/standard_catalogue.hpp>
#endif
