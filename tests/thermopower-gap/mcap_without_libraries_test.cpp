// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A build without the libraries of zstd and lz4 says what is missing.

#include "../catch.hpp"

#include "chunk_compression.hpp"

namespace io = thermopower::io;

TEST_CASE("without a library its chunks are refused by the library's name, and plain ones are read") {
  const unsigned char bytes[4] = {1, 2, 3, 4};
  std::vector<unsigned char> out;
  CHECK(io::unpack_chunk("zstd", bytes, 4, 9, out) ==
        "compressed with zstd, which this build cannot unpack; expected a build with Debian's libzstd-dev");
  CHECK(io::unpack_chunk("lz4", bytes, 4, 9, out) ==
        "compressed with lz4, which this build cannot unpack; expected a build with Debian's liblz4-dev");
  CHECK(io::unpack_chunk("", bytes, 4, 4, out).empty());
  CHECK(out == std::vector<unsigned char>{1, 2, 3, 4});
  CHECK(io::unpack_chunk("", bytes, 4, 5, out) == "unpacks to 4 bytes; the chunk says 5");
}
