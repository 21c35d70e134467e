// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include "program.hpp"

#include <CLI/CLI.hpp>

/// @brief What `--recording` takes, for help texts.
extern const char* const recording_kinds;

/// @brief Takes a number of seconds, as Options::validate() does.
extern const CLI::Validator seconds;
/// @brief Takes a share from 0 to 0.5; nan is none.
extern const CLI::Validator share;

/// @brief Takes any number.
extern const CLI::Validator a_number;
/// @brief Takes a number within bounds. @param what  it is, as in "a temperature in degC"
CLI::Validator number_within(double low, double high, const char* what);
/// @brief Adds `--recording`, required and repeatable.
void add_recordings(CLI::App& app, Arguments& arguments, const char* help);
/// @brief Takes a whole number from 0 on.
CLI::Validator whole_number(double most);
/// @brief Takes rows a second.
extern const CLI::Validator rate;

/// @brief Adds `--column`, `--map`, `--rate`, `--ambient`, `--supply` and `--constant`.
void add_column_choices(CLI::App& app, Arguments& arguments);
/// @brief Adds `--horizon`.
CLI::Option* add_horizon(CLI::App& app, Arguments& arguments);
/// @brief Adds `--as-recorded`.
void add_as_recorded(CLI::App& app, Arguments& arguments);
/// @brief Adds `--mjcf` and `--urdf`.
void add_simulator_exports(CLI::App& app, Arguments& arguments);
