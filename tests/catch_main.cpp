// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Only needed with Catch2 2.x: version 3 brings its own main.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
