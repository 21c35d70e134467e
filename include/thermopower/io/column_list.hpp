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
  bool rises = true;        ///< its numbers never fall, but where a run begins anew
  bool whole = false;       ///< all its numbers are whole
  int sign_bit =
      0;  ///< the numbers look like those of a register whose bit of this number is the sign; 0: they do not
  std::string file_unit;  ///< in the row of units below the header; empty: there is none
  std::string proposed;   ///< name of the format that it seems to be; empty: a covariate
  std::string unit;       ///< of the file, where the name or the range tells; empty: the format's
  std::string why;        ///< what the proposal rests on
};

/// @brief Lists the columns of a recording, whatever they are called, and proposes what they are. A proposal is a guess from
/// names, units and ranges; nothing is converted. It never contradicts a unit in the header.
/// @param joint  word in the headers of the joint that is meant, such as `knee`; empty: the one that moves most
/// @throws InputError where the file is no table of numbers, see read_csv()
std::vector<ListedColumn> list_columns(const std::string& path, const std::string& joint = {});

/// @brief The same on the bytes of a CSV file in memory; `name` stands in messages where a path would.
std::vector<ListedColumn> list_columns(const std::string& name, const char* bytes, std::size_t size,
                                       const std::string& joint = {});

/// @brief What a recording of any kind holds.
struct LogContents {
  std::string file;   ///< path
  std::string about;  ///< topics, frames, a controller's gains: lines for a person; may be empty
  std::vector<ListedColumn> columns;  ///< what may be mapped, with proposals
  bool needs_time = true;             ///< time is a column; false: the recording has a clock of its own
};

/// @brief Lists a recording of any kind that read_recording() reads. @throws InputError
LogContents list_log(const std::string& path, const std::string& joint = {});

/// @brief The contents as text for a person, with the command that diagnoses the file with the proposals.
std::string columns_text(const LogContents& contents);

/// @brief The list as text for a person, with the command that diagnoses the file with the proposals.
/// @param file  as the command names it
std::string columns_text(const std::vector<ListedColumn>& columns, const std::string& file = "log.csv");

/// @brief The proposals as a mapping file, see read_column_map(), for a person to go through.
std::string column_map_text(const std::vector<ListedColumn>& columns);

/// @brief The command that diagnoses a file with what is proposed.
/// @param file  as the command names it
std::string diagnose_command(const std::string& file, const std::vector<ListedColumn>& columns);

}  // namespace thermopower::io
