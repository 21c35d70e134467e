// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check_data.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/names.hpp>
#include <thermopower/io/recording_file.hpp>

#include <string>

namespace thermopower::io {

/// @brief Who reads a remedy.
enum class Caller {
  program,  ///< options of the program: `--column motor_C=temp:degF`
  python,   ///< arguments of the Python module: `columns=['motor_C=temp:degF']`
};

/// @brief A choice as `--column` takes it.
std::string choice_text(const ColumnChoice& choice);

/// @brief Says a remedy in the columns of the file. The check of the data knows the names of the format alone; where
/// `--column angle_deg=pos` is in force, its `--column angle_deg=angle_deg:rad` is `--column angle_deg=pos:rad` to whoever types it.
/// A column that was given as a constant has its option: with `--ambient 75.2` in force, `--column ambient_C=ambient_C:degF` is
/// `--ambient 24`.
///
/// The other options in force follow, so that the result can be put in the place of all of them, or behind them.
/// @param mend  Finding::mend; options stand in it alone or among words. Words stay, but for what Python spells otherwise
/// @param in_force  how the data were read
/// @param caller  whose options it names
std::string remedy_in_force(const std::string& mend, const ReadOptions& in_force,
                            Caller caller = Caller::program);

/// @brief The same for everything that a diagnosis says to do: its findings, and its next experiment.
void put_remedies_in_force(gap::Diagnosis& diagnosis, const ReadOptions& in_force,
                           Caller caller = Caller::program);

/// @brief The same for a check of data.
void put_remedies_in_force(gap::DataReport& report, const ReadOptions& in_force,
                           Caller caller = Caller::program);

}  // namespace thermopower::io
