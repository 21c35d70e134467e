// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstddef>
#include <string>

namespace thermopower::io {

/// Line, from 1, on which a JSON pointer's value begins in a text; of a value that is not there, the line of what it
/// would be in. The text must be JSON.
std::size_t line_of_pointer(const std::string& text, const std::string& pointer);

}  // namespace thermopower::io
