// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/finding.hpp>
#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/names.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A choice as `--column` takes it.
std::string choice_text(const ColumnChoice& choice);

/// @brief Says a remedy in the columns of the file. The check of the data knows the names of the format alone; where
/// `--column angle_deg=pos` is in force, its `--column angle_deg=angle_deg:rad` is `--column angle_deg=pos:rad` to whoever types it.
/// The other choices in force follow, so that the result can be put in the place of all of them.
/// @param mend  Finding::mend; a text without `--column` is left as it is
/// @param in_force  the choices with which the data were read
std::string remedy_in_force(const std::string& mend, const std::vector<ColumnChoice>& in_force);

/// @brief The same for all findings.
void put_remedies_in_force(std::vector<Finding>& findings, const std::vector<ColumnChoice>& in_force);

}  // namespace thermopower::io
