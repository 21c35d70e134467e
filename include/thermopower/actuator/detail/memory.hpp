// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "../../detail/probe.hpp"

/// @file actuator/detail/memory.hpp
/// What a journal asks of the memory that keeps its records.

namespace thermopower {
namespace detail {

template <class Memory>
auto is_memory_ready(Memory& memory, int) noexcept -> decltype(memory.is_ready()) {
  return memory.is_ready();
}
template <class Memory>
bool is_memory_ready(Memory&, long) noexcept {
  return true;
}

/// A memory: what a byte is, and makes it another.
template <class Candidate, class = int>
struct IsMemory {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsMemory<Candidate, typename Exists<decltype(probe<Candidate>().read(size_t(0)) + 0),
                                           decltype(probe<Candidate>().write(size_t(0), uint8_t(0)))>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail
}  // namespace thermopower
