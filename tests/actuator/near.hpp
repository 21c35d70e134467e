// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../catch.hpp"

// Catch's Approx, also in Catch2 2.x, where a matcher function of the same name hides the class.
using Near = class ::Approx;
