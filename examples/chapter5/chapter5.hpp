// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>

/// The parts of the program, each one section of the thesis's chapter 5. Each prints a table and writes its
/// figures into `directory`.
namespace chapter5 {

void temperatures(const std::string& directory);  ///< Tables 5.1 to 5.3, figures 5.1 to 5.8.
void protection(const std::string& directory);    ///< Table 5.4, figures 5.9 to 5.11.
void responses(const std::string& directory);     ///< Figures 5.12 to 5.16.
void power_comparison();                          ///< Section 5.3.
void yaw_riddle(const std::string& directory);    ///< Section 5.2: errors "18 times larger".

}  // namespace chapter5
