// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <thermopower/io/column_list.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// Says what a column may be, from its header and range.
void propose(ListedColumn& column);

/// Of columns that seem to be the same one keeps its proposal: the one with the format's name, else the first.
void settle_rivals(std::vector<ListedColumn>& list);

/// What `--column` takes for a proposal; empty where there is none, or none is needed.
std::string choice_text(const ListedColumn& column);

/// The list and the options, without a word about time.
std::string list_text(const std::vector<ListedColumn>& columns);

}  // namespace thermopower::io
