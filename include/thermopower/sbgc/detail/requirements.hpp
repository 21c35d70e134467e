// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stddef.h>
#include <stdint.h>

namespace thermopower {
namespace detail {

template <class Type>
Type& sbgc_lvalue() noexcept;

/// Has `object.write(const uint8_t*, size_t)`.
template <class Wire>
struct SbgcHasWrite {
  template <class Probe>
  static char test(decltype(sbgc_lvalue<Probe>().write(static_cast<const uint8_t*>(nullptr), size_t(0)), 0)*);
  template <class Probe>
  static long test(...);
  static constexpr bool value = sizeof(test<Wire>(nullptr)) == 1;
};

/// Stands in for a sink while checking a message.
struct SbgcAnySink {
  void put(uint8_t) noexcept;
};

/// Has `id()`, `payload_size()` and `write_payload(sink)`.
template <class Message>
struct SbgcIsMessage {
  template <class Probe>
  static char test(decltype(static_cast<uint8_t>(sbgc_lvalue<const Probe>().id()),
                            static_cast<size_t>(sbgc_lvalue<const Probe>().payload_size()),
                            sbgc_lvalue<const Probe>().write_payload(sbgc_lvalue<SbgcAnySink>()), 0)*);
  template <class Probe>
  static long test(...);
  static constexpr bool value = sizeof(test<Message>(nullptr)) == 1;
};

/// Has `read(frame)` giving a bool.
template <class Message, class Frame>
struct SbgcIsReadable {
  template <class Probe>
  static char test(decltype(static_cast<bool>(sbgc_lvalue<Probe>().read(sbgc_lvalue<const Frame>())), 0)*);
  template <class Probe>
  static long test(...);
  static constexpr bool value = sizeof(test<Message>(nullptr)) == 1;
};

/// Has `power[axis]` and `p_gain[axis]`.
template <class Command>
struct SbgcHasPowerAndGain {
  template <class Probe>
  static char test(decltype(static_cast<uint8_t>(sbgc_lvalue<const Probe>().power[2]),
                            static_cast<uint8_t>(sbgc_lvalue<const Probe>().p_gain[2]), 0)*);
  template <class Probe>
  static long test(...);
  static constexpr bool value = sizeof(test<Command>(nullptr)) == 1;
};

/// How many bytes a wire took: its answer, or all of them when its write() returns nothing.
template <class Wire>
auto sbgc_write(Wire& wire, const uint8_t* data, size_t size, int)
    -> decltype(static_cast<size_t>(wire.write(data, size))) {
  return static_cast<size_t>(wire.write(data, size));
}

template <class Wire>
size_t sbgc_write(Wire& wire, const uint8_t* data, size_t size, long) {
  wire.write(data, size);
  return size;
}

}  // namespace detail
}  // namespace thermopower
