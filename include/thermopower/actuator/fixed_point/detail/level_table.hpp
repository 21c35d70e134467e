// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../../detail/constexpr_math.hpp"
#include "../../../fixed_point/units.hpp"
#include "../../../detail/flash.hpp"

/// @file actuator/fixed_point/detail/level_table.hpp
/// Functions of the power parameter as tables in flash, made by the compiler.
///
/// The nodes are every level up to 16 and eight to an octave above: 16, 18, 20 .. 32, 36 .. 64, 72 .. 256.
/// Between two nodes a power law x^n differs from its chord by less than |n (n - 1)| / 512 of its value at
/// any level, where equally spaced nodes would be good at full power and useless at small.

namespace thermopower {
namespace fixed_point {
namespace detail {

/// Nodes of a level table.
constexpr int level_node_count() { return 49; }
/// Level of a node; the last is 256, so that 255 lies between two.
constexpr int level_of_node(int node) { return node < 16 ? node : (8 + node % 8) << (node / 8 - 1); }

/// Four functions of the level, which are read together so that one position serves them all.
struct LevelNode {
  int16_t first;   ///< Scaled as the source likes.
  int16_t second;  ///< @copydoc first
  int16_t third;   ///< @copydoc first
  int16_t fourth;  ///< @copydoc first
};

/// Where a level lies among the nodes.
struct LevelPosition {
  uint8_t node;   ///< 0 .. 47
  uint8_t share;  ///< Way to the next node, in 1/256.
};

/// The position of a level.
inline LevelPosition level_position(uint8_t level) noexcept {
  LevelPosition position = {level, 0};
  if (level < 16) return position;
  // What is above the node comes into the product's low byte: an 8-bit chip multiplies faster than it shifts.
  uint8_t node = 8, factor = 128;
  if (level >= 128) {
    node = 32, factor = 16;
  } else if (level >= 64) {
    node = 24, factor = 32;
  } else if (level >= 32) {
    node = 16, factor = 64;
  }
  const uint16_t shifted = static_cast<uint16_t>(level * factor);
  position.node = static_cast<uint8_t>(node + (shifted >> 8));
  position.share = static_cast<uint8_t>(shifted);
  return position;
}

/// The values of four functions of the level at every node.
/// @tparam Source  has `static constexpr LevelNode at(int level)`, level 0 .. 256
template <class Source, class Nodes = typename thermopower::detail::MakeIndices<level_node_count()>::Type>
struct LevelTable;

// A class template so that the array may be defined in a header, and in flash.
template <class Source, int... node>
struct LevelTable<Source, thermopower::detail::Indices<node...> > {
  static constexpr LevelNode nodes[level_node_count()] thermopower_flash = {
      Source::at(level_of_node(node))...};
  /// For `between_nodes` and nothing else.
  static const int16_t* table() noexcept { return thermopower::detail::flash_pointer(&nodes[0].first); }
};
template <class Source, int... node>
constexpr LevelNode LevelTable<Source, thermopower::detail::Indices<node...> >::nodes[level_node_count()];

#if defined(__AVR__)
/// The values at a position of a table. @param table  LevelTable::table()
[[gnu::always_inline]] inline LevelNode between_nodes(const int16_t* table, LevelPosition position) noexcept {
  LevelNode values;
  const int16_t* at = table + static_cast<uint8_t>(position.node * 4);
  int16_t above;
  uint8_t zero;
  // A node and the next one are read as they lie; each value grows by (next - value) share / 256.
  asm("clr %[zero]\n\t"
      "lpm %A[first], Z+\n\t"
      "lpm %B[first], Z+\n\t"
      "lpm %A[second], Z+\n\t"
      "lpm %B[second], Z+\n\t"
      "lpm %A[third], Z+\n\t"
      "lpm %B[third], Z+\n\t"
      "lpm %A[fourth], Z+\n\t"
      "lpm %B[fourth], Z+\n\t"
      "lpm %A[above], Z+\n\t"
      "lpm %B[above], Z+\n\t"
      "sub %A[above], %A[first]\n\t"
      "sbc %B[above], %B[first]\n\t"
      "mul %A[above], %[share]\n\t"
      "add %A[first], r1\n\t"
      "adc %B[first], %[zero]\n\t"
      "mulsu %B[above], %[share]\n\t"
      "add %A[first], r0\n\t"
      "adc %B[first], r1\n\t"
      "lpm %A[above], Z+\n\t"
      "lpm %B[above], Z+\n\t"
      "sub %A[above], %A[second]\n\t"
      "sbc %B[above], %B[second]\n\t"
      "mul %A[above], %[share]\n\t"
      "add %A[second], r1\n\t"
      "adc %B[second], %[zero]\n\t"
      "mulsu %B[above], %[share]\n\t"
      "add %A[second], r0\n\t"
      "adc %B[second], r1\n\t"
      "lpm %A[above], Z+\n\t"
      "lpm %B[above], Z+\n\t"
      "sub %A[above], %A[third]\n\t"
      "sbc %B[above], %B[third]\n\t"
      "mul %A[above], %[share]\n\t"
      "add %A[third], r1\n\t"
      "adc %B[third], %[zero]\n\t"
      "mulsu %B[above], %[share]\n\t"
      "add %A[third], r0\n\t"
      "adc %B[third], r1\n\t"
      "lpm %A[above], Z+\n\t"
      "lpm %B[above], Z+\n\t"
      "sub %A[above], %A[fourth]\n\t"
      "sbc %B[above], %B[fourth]\n\t"
      "mul %A[above], %[share]\n\t"
      "add %A[fourth], r1\n\t"
      "adc %B[fourth], %[zero]\n\t"
      "mulsu %B[above], %[share]\n\t"
      "add %A[fourth], r0\n\t"
      "adc %B[fourth], r1\n\t"
      "clr r1"
      : [first] "=&r"(values.first), [second] "=&r"(values.second), [third] "=&r"(values.third),
        [fourth] "=&r"(values.fourth), [above] "=&a"(above), [zero] "=&r"(zero), "+z"(at)
      : [share] "a"(position.share)
      : "r0");
  return values;
}
#else
/// The values at a position of a table. @param table  LevelTable::table()
inline LevelNode between_nodes(const int16_t* table, LevelPosition position) noexcept {
  int16_t values[4];
  const int16_t* below = table + 4 * position.node;
  for (uint8_t index = 0; index < 4; ++index) {
    const int16_t value = thermopower::detail::read_flash(below + index);
    const int16_t rise = static_cast<int16_t>(thermopower::detail::read_flash(below + index + 4) - value);
    values[index] = static_cast<int16_t>(value + part_of(rise, position.share));
  }
  const LevelNode node = {values[0], values[1], values[2], values[3]};
  return node;
}
#endif

}  // namespace detail
}  // namespace fixed_point
}  // namespace thermopower
