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
  LevelPosition position = {0, 0};
  while (level >= 16) {
    position.share = static_cast<uint8_t>((position.share >> 1) | (level << 7));
    level = static_cast<uint8_t>(level >> 1);
    position.node = static_cast<uint8_t>(position.node + 8);
  }
  position.node = static_cast<uint8_t>(position.node + level);
  return position;
}

/// The values of a function of the level at every node.
/// @tparam Source  names `Node`, a struct of `int16_t`, and has `static constexpr Node at(int level)`, level 0 .. 256. Functions that
///                 are read together are members of one Node, so that one position serves them all.
template <class Source, class Nodes = typename MakeIndices<level_node_count()>::Type>
struct LevelTable;

// A class template so that the array may be defined in a header, and in flash.
template <class Source, int... node>
struct LevelTable<Source, Indices<node...> > {
  typedef typename Source::Node Node;
  static constexpr Node nodes[level_node_count()] thermopower_flash = {Source::at(level_of_node(node))...};
  /// For `between` and nothing else.
  static const Node* table() noexcept { return flash_pointer(&nodes[0]); }
};
template <class Source, int... node>
constexpr typename Source::Node LevelTable<Source, Indices<node...> >::nodes[level_node_count()];

/// A value between two neighbouring nodes. @param below, above  the same member of both, in flash
inline int16_t between(const int16_t* below, const int16_t* above, uint8_t share) noexcept {
  const int16_t start = read_flash(below);
  return static_cast<int16_t>(start + part_of(static_cast<int16_t>(read_flash(above) - start), share));
}

}  // namespace detail
}  // namespace thermopower
