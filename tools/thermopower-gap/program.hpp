// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/output_files.hpp>
#include <thermopower/io/provenance.hpp>
#include <thermopower/io/recording_file.hpp>
#include <thermopower/gap/finding.hpp>
#include <thermopower/plant/catalogue.hpp>

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

/// Exit status of the program, as its help tells it.
enum ExitStatus : int { made = 0, failed = 1, wrong_usage = 2, invalid_input = 3, too_little_data = 4 };

/// What was typed is wrong; the program ends with `wrong_usage` and this text.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What the subcommands are asked for; each uses a part of it.
struct Arguments {
  std::string model, report, html, predictions, augmented, header, mjcf, urdf;
  /// Every output that may be asked for.
  std::vector<const std::string*> outputs() const {
    return {&report, &html, &predictions, &augmented, &header, &mjcf, &urdf};
  }
  std::string summary = "text";  ///< how the answer is printed
  std::vector<std::string> recordings, held_out, without, columns, maps, starts;
  std::vector<std::string> constants;  ///< NAME=VALUE of columns that the files lack
  double ambient_C = 0.0, supply_V = 0.0;
  bool has_ambient = false, has_supply = false;
  double rows_per_s = 0.0;  ///< of files without time; 0: they have one
  bool as_recorded = false;
  bool of_fleet = false;  ///< one log of it: nothing is printed, and its paths are the fleet's own
  double horizon_s = 0.5;
  double tolerance = 0.05;
  unsigned threads = 0;
  unsigned seed = 1;
};

/// @brief How the files are read: the mapping files, `--column`, which goes before them, `--rate` and the constants. Of two `--column`
/// for one name the later one is taken.
/// @throws UsageError or InputError that names the option or the line
thermopower::io::ReadOptions reading(const Arguments& arguments, const thermopower::gap::Model& model);

/// @brief What a report is made of: the files and the options that change the answer, as typed.
thermopower::io::Provenance provenance_of(const Arguments& arguments);

/// @brief Checks a `--column` before the models are known. @throws UsageError
void expect_choice(const std::string& text);

/// @brief Reads recordings; what the reader noticed goes to the end of `findings`. @throws InputError
std::vector<thermopower::gap::Recording> read_all(const std::vector<std::string>& paths,
                                                  const thermopower::io::ReadOptions& how,
                                                  std::vector<thermopower::gap::Finding>& findings);

/// @brief A path without detours: absolute, links followed as far as it exists.
std::filesystem::path plain_path(const std::string& path);

/// @brief Refuses two outputs in one file, and an output over an input: one of them would be lost. @throws UsageError
void refuse_overlaps(const Arguments& arguments);

/// @brief Refuses an effect that the catalogue does not have: a misspelt one would silently remove nothing.
/// @throws UsageError
void check_ids(const std::vector<std::string>& ids, const thermopower::gap::Catalogue& catalogue);

/// @brief Writes a model as header, MJCF and URDF, as asked. Parts that the other format cannot hold are named on standard error.
void write_exports(const Arguments& arguments, const thermopower::gap::Model& model,
                   const std::string& origin, const thermopower::gap::Catalogue& catalogue,
                   thermopower::io::OutputFiles& outputs);

/// @brief Reads the model, and refuses one that the exports asked for cannot describe. @throws InputError
thermopower::gap::Model read_model(const Arguments& arguments, const thermopower::gap::Catalogue& catalogue);

/// @brief Diagnoses and writes what is asked for. @return exit status @throws UsageError, InputError and others
int diagnose(const Arguments& arguments);

/// @brief Runs some work. @return its exit status; where it throws, the status for that, and `fault` gets the message
int guarded(const std::function<int()>& work, std::string& fault);
