// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <CLI/CLI.hpp>

#include <functional>

/// A subcommand of the program: what the parser knows of it, and what runs it. Each has a file of its own; `main.cpp` lists them.
struct Command {
  CLI::App* app = nullptr;   ///< holds the options
  std::function<int()> run;  ///< does the work after parsing. @return exit status of the program
};

/// @brief Adds `diagnose`: finds the missing effect.
Command add_diagnose(CLI::App& program);
/// @brief Adds `design`: writes the schedule of the next experiment.
Command add_design(CLI::App& program);
/// @brief Adds `predict`: simulates a recording with a model.
Command add_predict(CLI::App& program);
/// @brief Adds `check`: says what is wrong with recordings.
Command add_check(CLI::App& program);
/// @brief Adds `export`: writes a model for other simulators, or as a header.
Command add_export(CLI::App& program);
/// @brief Adds `columns`: lists what is in a file and proposes a mapping.
Command add_columns(CLI::App& program);
/// @brief Adds `fleet`: diagnoses every log of a table.
Command add_fleet(CLI::App& program);
/// @brief Adds `init`: writes a model file from a robot's description, options or questions.
Command add_init(CLI::App& program);
/// @brief Adds `effects`: lists the catalogue.
Command add_effects(CLI::App& program);
/// @brief Adds `explain`: says what a code of a report means.
Command add_explain(CLI::App& program);
/// @brief Adds `compare`: says in what two reports differ.
Command add_compare(CLI::App& program);
/// @brief Adds `impact`: ranks the causes of a robot's gap.
Command add_impact(CLI::App& program);
