// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file inline.hpp
/// Header-only, or compiled once: how the few functions that a user of the diagnosis calls are defined.
///
/// Header-only is the default: the public headers then end by including their definitions from `detail/`.
/// With THERMOPOWER_GAP_LIBRARY defined they only declare, and the definitions come from a library: the CMake
/// target `thermopower::gap`, which defines it for whoever links it, or one source file of one's own:
///
///     #define THERMOPOWER_GAP_LIBRARY
///     #include <thermopower/gap/definitions.hpp>
///
/// All sources of a program must agree on it.

/// The beginning of a definition: `inline`, or nothing where the library has the only one.
#if defined(THERMOPOWER_GAP_LIBRARY)
#define THERMOPOWER_GAP_INLINE
#else
#define THERMOPOWER_GAP_INLINE inline
#endif
