// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

namespace thermopower::io {

/// @brief Columns of a terminal that texts use.
inline constexpr std::size_t text_width = 100;

/// @brief Wraps words, and indents every line but the first: the first stands behind a label that is as wide.
inline std::string wrapped(const std::string& text, std::size_t indent) {
  std::string out;
  std::size_t column = indent, i = 0;
  while (i < text.size()) {
    const std::size_t end = std::min(text.find(' ', i), text.size());
    if (column > indent && column + 1 + (end - i) > text_width) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      out += ' ';
      ++column;
    }
    out.append(text, i, end - i);
    column += end - i;
    i = end + 1;
  }
  return out;
}

}  // namespace thermopower::io
