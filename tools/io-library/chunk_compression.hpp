// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief Unpacks a chunk.
/// @param compression  `zstd`, `lz4` or empty
/// @param size  what it should come to
/// @return what is wrong; empty where `out` holds the chunk. A library that is not built in says so, and what it needs
std::string unpack_chunk(const std::string& compression, const unsigned char* bytes, std::size_t count,
                         std::size_t size, std::vector<unsigned char>& out);

}  // namespace thermopower::io
