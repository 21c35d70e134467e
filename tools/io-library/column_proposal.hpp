// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <thermopower/io/column_list.hpp>
#include <thermopower/io/csv_table.hpp>
#include <thermopower/io/mcap_file.hpp>
#include <thermopower/io/sbgc_capture.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief What is known of a column besides its header and its numbers.
struct ColumnHint {
  std::string unit = {};     ///< in which it is, whatever the header says, as `--column` takes it
  std::string because = {};  ///< where the unit or the refusal comes from
  bool not_meant = false;    ///< the column is none of the format's
  std::string name = {};     ///< of the format, where that is known
};

/// @brief Proposes what the columns of a file are, one column for each name at most: those of one joint, the one that moves, in
/// the units of their headers.
/// @param hints  one for each column, or none at all
/// @param joint  word in the headers of the joint that is meant; empty: the one that moves most
/// @param table  the numbers themselves, where they are at hand: a rate and its angle then say each other's unit
void propose(std::vector<ListedColumn>& list, const std::vector<ColumnHint>& hints, const std::string& joint,
             const CsvTable* table = nullptr);

/// What `--column` takes for a proposal; empty where there is none, or none is needed.
std::string choice_text(const ListedColumn& column);

/// The list alone.
std::string list_text(const std::vector<ListedColumn>& columns);

/// What to do next: the command, and what is missing for it.
std::string next_text(const std::string& file, const std::vector<ListedColumn>& columns, bool needs_time);

/// The topics of an MCAP file as lines.
std::string topics_text(const McapContents& contents);

/// What a capture of a SimpleBGC board holds, as lines.
std::string capture_text(const SbgcCaptureContents& contents);

}  // namespace thermopower::io
