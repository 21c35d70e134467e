// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief What a column of a file holds, and what it may be.
struct ListedColumn {
  std::string header;       ///< as in the file
  bool text = false;        ///< holds words: the numbers below say nothing
  std::size_t samples = 0;  ///< numbers in it
  std::size_t missing = 0;  ///< empty cells and `nan`
  double least = 0.0;       ///< of its numbers
  double greatest = 0.0;    ///< of its numbers
  std::string proposed;     ///< name of the format that it seems to be; empty: a covariate
  std::string unit;         ///< of the file, where the name or the range tells; empty: the format's
  std::string why;          ///< what the proposal rests on
};

/// @brief Lists the columns of a CSV file, whatever they are called, and proposes what they are. A proposal is a guess from
/// names, units in names and ranges; nothing is converted.
/// @throws InputError where the file is no table of numbers, see read_csv()
std::vector<ListedColumn> list_columns(const std::string& path);

/// @brief The same on bytes in memory; `name` stands in messages where a path would.
std::vector<ListedColumn> list_columns(const std::string& name, const char* bytes, std::size_t size);

/// @brief The list as text for a person, with the options `--column` that take the proposals.
std::string columns_text(const std::vector<ListedColumn>& columns);

/// @brief The proposals as a mapping file, see read_column_map(), for a person to go through.
std::string column_map_text(const std::vector<ListedColumn>& columns);

}  // namespace thermopower::io
