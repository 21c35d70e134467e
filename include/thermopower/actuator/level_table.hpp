// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/constexpr_math.hpp"
#include "../detail/fixed_point.hpp"
#include "../detail/flash.hpp"

/// @file level_table.hpp
/// Functions of the power parameter as tables in flash, made by the compiler.
///
/// The nodes are every level up to 16 and eight to an octave above: 16, 18, 20 .. 32, 36 .. 64, 72 .. 256. Between two nodes a power
/// law x^n differs from its chord by less than |n (n - 1)| / 512 of its value at any level, where equally spaced nodes would be good at
/// full power and useless at small.

namespace thermopower {
namespace detail {

/// Nodes of a level table.
constexpr int level_node_count() { return 49; }
/// Level of a node; the last is 256, so that 255 lies between two.
constexpr int level_of_node(int node) { return node < 16 ? node : (8 + node % 8) << (node / 8 - 1); }

/// Where a level lies among the nodes.
struct LevelPosition {
  uint8_t node;   ///< 0 .. 47
  uint8_t share;  ///< Way to the next node, in 1/256.
};

/// The position of a level; at most four rounds.
inline LevelPosition level_position(uint8_t level) noexcept {
  // Level and share in one 16-bit number, so that halving moves a bit from one to the other.
  uint16_t halved = static_cast<uint16_t>(static_cast<uint16_t>(level) << 8);
  uint8_t node = 0;
  while (halved >= 16u * 256u) {
    halved = static_cast<uint16_t>(halved >> 1);
    node = static_cast<uint8_t>(node + 8);
  }
  const LevelPosition position = {static_cast<uint8_t>(node + (halved >> 8)), static_cast<uint8_t>(halved)};
  return position;
}

/// The values of a function of the level at every node.
/// @tparam Source  names `Node`, a struct of `int16_t` whose first member is `first`, and has `static constexpr Node at(int level)`, level 0 .. 256. Functions that
///                 are read together are members of one Node, so that one position serves them all.
template <class Source, class Nodes = typename MakeIndices<level_node_count()>::Type>
struct LevelTable;

// A class template so that the array may be defined in a header, and in flash.
template <class Source, int... node>
struct LevelTable<Source, Indices<node...> > {
  typedef typename Source::Node Node;
  static constexpr Node nodes[level_node_count()] thermopower_flash = {Source::at(level_of_node(node))...};
  /// For `next_between` and nothing else.
  static const int16_t* table() noexcept { return flash_pointer(&nodes[0].first); }
};
template <class Source, int... node>
constexpr typename Source::Node LevelTable<Source, Indices<node...> >::nodes[level_node_count()];

#if defined(__AVR__)
/// The value between a member of a node and the same member of the next node, which lies `stride` values on; moves on to the next member.
/// @param at  in flash, from LevelTable::table()
template <uint8_t stride>
[[gnu::always_inline]] inline int16_t next_between(const int16_t*& at, uint8_t share) noexcept {
  int16_t below, above;
  asm("lpm %A[below], Z+\n\t"
      "lpm %B[below], Z+\n\t"
      "adiw r30, %[ahead]\n\t"
      "lpm %A[above], Z+\n\t"
      "lpm %B[above], Z+\n\t"
      "sbiw r30, %[back]\n\t"
      "sub %A[above], %A[below]\n\t"
      "sbc %B[above], %B[below]\n\t"
      "mul %A[above], %[share]\n\t"
      "mov %A[above], r1\n\t"
      "mulsu %B[above], %[share]\n\t"
      "clr %B[above]\n\t"
      "add %A[below], %A[above]\n\t"
      "adc %B[below], %B[above]\n\t"
      "add %A[below], r0\n\t"
      "adc %B[below], r1\n\t"
      "clr r1"
      : [below] "=&r"(below), [above] "=&a"(above), "+z"(at)
      : [share] "a"(share), [ahead] "I"(2 * stride - 2), [back] "I"(2 * stride)
      : "r0");
  return below;
}
#else
/// The value between a member of a node and the same member of the next node, which lies `stride` values on; moves on to the next member.
/// @param at  in flash, from LevelTable::table()
template <uint8_t stride>
inline int16_t next_between(const int16_t*& at, uint8_t share) noexcept {
  const int16_t below = read_flash(at), above = read_flash(at + stride);
  ++at;
  return static_cast<int16_t>(below + part_of(static_cast<int16_t>(above - below), share));
}
#endif

}  // namespace detail
}  // namespace thermopower
