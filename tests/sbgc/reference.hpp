// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

// What the receiver is compared with: an independent, slow reading of a whole recorded stream, written from
// the protocol's definition. It shares no code with the library.

namespace reference {

using Data = std::vector<std::uint8_t>;

inline std::uint8_t sum(const std::uint8_t* data, std::size_t size) {
  unsigned total = 0;
  for (std::size_t i = 0; i < size; ++i) total += data[i];
  return static_cast<std::uint8_t>(total % 256);
}

// Polynomial 0x8005, initial 0, data bits least significant first, register shifted left.
inline std::uint16_t crc(const std::uint8_t* data, std::size_t size) {
  unsigned reg = 0;
  for (std::size_t i = 0; i < size; ++i) {
    for (int k = 0; k < 8; ++k) {
      const bool in = (data[i] >> k) & 1;
      const bool top = (reg >> 15) & 1;
      reg = (reg << 1) & 0xFFFF;
      if (in != top) reg ^= 0x8005;
    }
  }
  return static_cast<std::uint16_t>(reg);
}

struct Frame {
  std::size_t begin = 0;  // position of the first byte in the stream
  std::size_t end = 0;    // position behind the last byte
  std::uint8_t start = 0;
  std::uint8_t id = 0;
  Data payload;

  friend bool operator==(const Frame& a, const Frame& b) {
    return a.start == b.start && a.id == b.id && a.payload == b.payload;
  }
};

struct Rules {
  std::size_t payload_capacity = 255;
  bool v1 = true;
  bool v2 = true;
};

inline Data make_frame(std::uint8_t start, std::uint8_t id, const Data& payload) {
  Data
      frame;  // byte by byte: g++ 12 at -O3 sees an insertion behind four bytes run out of bounds, which it does not
  frame.reserve(payload.size() + 6);
  for (const std::size_t byte : {std::size_t{start}, std::size_t{id}, payload.size(), id + payload.size()})
    frame.push_back(static_cast<std::uint8_t>(byte));
  for (const std::uint8_t byte : payload) frame.push_back(byte);
  if (start == 0x3E) {
    frame.push_back(sum(payload.data(), payload.size()));
  } else {
    const std::uint16_t check = crc(frame.data() + 1, frame.size() - 1);
    frame.push_back(static_cast<std::uint8_t>(check & 0xFF));
    frame.push_back(static_cast<std::uint8_t>(check >> 8));
  }
  return frame;
}

// Is there a valid frame at `at` that ends within `end`?
inline bool frame_at(const Data& stream, std::size_t at, std::size_t end, const Rules& rules, Frame& frame) {
  const std::uint8_t start = stream[at];
  if (!(rules.v1 && start == 0x3E) && !(rules.v2 && start == 0x24)) return false;
  if (at + 4 > end) return false;
  const std::uint8_t id = stream[at + 1];
  const std::size_t size = stream[at + 2];
  if (id == 0 || size > rules.payload_capacity) return false;
  const std::size_t length = size + (start == 0x3E ? 5 : 6);
  if (at + length > end) return false;
  const auto from = stream.begin() + static_cast<std::ptrdiff_t>(at);
  frame.payload.assign(from + 4, from + 4 + static_cast<std::ptrdiff_t>(size));
  frame.begin = at;
  frame.end = at + length;
  frame.start = start;
  frame.id = id;
  return make_frame(start, id, frame.payload) == Data(from, from + static_cast<std::ptrdiff_t>(length));
}

// At each position either a valid frame starts, or one byte is skipped. No frame goes across a pause;
// `pauses` are positions in ascending order.
inline std::vector<Frame> leftmost_reading(const Data& stream, const Rules& rules,
                                           const std::vector<std::size_t>& pauses = {}) {
  std::vector<Frame> frames;
  std::size_t next_pause = 0;
  for (std::size_t at = 0; at < stream.size();) {
    while (next_pause < pauses.size() && pauses[next_pause] <= at) ++next_pause;
    const std::size_t end = next_pause < pauses.size() ? pauses[next_pause] : stream.size();
    Frame frame;
    if (frame_at(stream, at, end, rules, frame)) {
      at = frame.end;
      frames.push_back(frame);
    } else {
      ++at;
    }
  }
  return frames;
}

}  // namespace reference
