// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace thermopower::io {

/// Bytes of a message, a schema or a chunk; valid only while a handler runs.
struct ByteView {
  const unsigned char* data = nullptr;
  std::size_t size = 0;
};

/// Where something stands in an MCAP file, as messages have it.
struct McapPlace {
  std::uint64_t byte = 0;        ///< in the file, of the record or of the chunk that it is in
  bool in_chunk = false;         ///< it is in a chunk
  std::uint64_t chunk_byte = 0;  ///< then: in the unpacked chunk
  /// `byte 123`, or `chunk at byte 123, byte 45 of what it unpacks to`
  std::string text() const;
};

struct McapSchema {
  std::uint16_t id = 0;
  std::string name, encoding;
  ByteView text;
};

struct McapChannel {
  std::uint16_t id = 0, schema = 0;  ///< schema 0: none
  std::string topic, encoding;
};

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint64_t log_ns = 0, publish_ns = 0;
  ByteView data;
  McapPlace place;
};

/// What is called with each record, in the order of the file.
struct McapHandlers {
  std::function<void(const McapSchema&)> schema;
  std::function<void(const McapChannel&)> channel;
  std::function<void(const McapMessage&)> message;
};

/// Where bytes come from: fills a buffer and says how many there were; fewer than asked for at the end.
using ByteSource = std::function<std::size_t(unsigned char* to, std::size_t size)>;

/// Whether these are the first bytes of an MCAP file.
bool begins_like_mcap(const unsigned char* bytes, std::size_t size);

/// @brief Reads an MCAP file from its first byte to its end, one chunk in memory at a time, and checks its check sums.
/// Index and summary are not needed and not read.
/// @param name  of the file, for messages
/// @throws InputError with file, byte and what was expected
void read_mcap_records(const std::string& name, const ByteSource& source, const McapHandlers& handlers);

}  // namespace thermopower::io
