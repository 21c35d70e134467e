// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file version.hpp
/// The one place that holds the version: CMake and the package manifests read it from here.

namespace thermopower {

/// Version of the library, in the sense of semantic versioning 2.0.
///
/// @snippet control_examples.cpp version
/// How to: @ref other_firmware.
/// @ingroup control
struct Version {
  static constexpr int major_number() { return 0; }  ///< Incompatible changes.
  static constexpr int minor_number() { return 1; }  ///< Compatible additions.
  static constexpr int patch_number() { return 0; }  ///< Corrections.
};

}  // namespace thermopower
