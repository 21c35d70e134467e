// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include "field_tree.hpp"
#include "mcap_records.hpp"

namespace thermopower::io {

/// @brief Reads a JSON message into a tree of fields. Numbers are read as std::from_chars does, `true` and `false` are
/// 1 and 0, `null` and `NaN` are missing.
/// @throws FieldError with the byte and what was expected
void read_json_message(ByteView message, FieldTree& tree);

}  // namespace thermopower::io
