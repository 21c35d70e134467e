// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command_options.hpp"

#include <cmath>
#include <cstdio>
#include <string>

// What Options::validate() takes, as a fault of the usage.
const CLI::Validator seconds(
    [](std::string& text) {
      double value = 0.0;
      const bool fine = CLI::detail::lexical_cast(text, value) && value >= 1e-6 && value <= 1e9;
      return fine ? std::string() : "'" + text + "' is not a number of seconds from 1e-6 to 1e9";
    },
    "1e-6..1e9");
// CLI11's own tells its type and no more.
CLI::Validator whole_number(double most) {
  char range[40];
  std::snprintf(range, sizeof range, "0..%.0f", most);
  const std::string from_to = range;
  return CLI::Validator(
      [most, from_to](std::string& text) {
        double value = 0.0;
        const bool fine = CLI::detail::lexical_cast(text, value) && value >= 0.0 && value <= most &&
                          value == std::floor(value);
        return fine ? std::string() : "'" + text + "' is not a whole number; expected " + from_to;
      },
      from_to);
}

// Rows a second of a log.
const CLI::Validator rate(
    [](std::string& text) {
      double value = 0.0;
      const bool fine = CLI::detail::lexical_cast(text, value) && value >= 1e-6 && value <= 1e7;
      return fine ? std::string() : "'" + text + "' is not a number of rows a second from 1e-6 to 1e7";
    },
    "1e-6..1e7");
// CLI11's own takes nan for a number within.
const CLI::Validator share(
    [](std::string& text) {
      double value = 0.0;
      const bool fine = CLI::detail::lexical_cast(text, value) && value >= 0.0 && value <= 0.5;
      return fine ? std::string() : "'" + text + "' is not a number from 0 to 0.5";
    },
    "0..0.5");

const CLI::Validator a_number(
    [](std::string& text) {
      double value = 0.0;
      const bool fine = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
      return fine ? std::string() : "'" + text + "' is not a number";
    },
    "number");

CLI::Validator number_within(double low, double high, const char* what) {
  char range[64];
  std::snprintf(range, sizeof range, "%g..%g", low, high);
  const std::string from_to = range, of = what;
  return CLI::Validator(
      [low, high, from_to, of](std::string& text) {
        double value = 0.0;
        const bool fine = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return fine ? std::string() : "'" + text + "' is not " + of + "; expected " + from_to;
      },
      from_to);
}

const char* const recording_kinds =
    "CSV, MCAP, rosbag2, klippy.log, Marlin, candump, JSON lines, npz, SimpleBGC";

void add_recordings(CLI::App& app, Arguments& arguments, const char* help) {
  app.add_option("--recording", arguments.recordings,
                 std::string(help) + " (" + recording_kinds + "); may be repeated")
      ->required();
}

// What a finding says to type is put behind the options in force: the last one counts.
const auto last_counts = CLI::MultiOptionPolicy::TakeLast;

void add_column_choices(CLI::App& app, Arguments& arguments) {
  app.add_option("--column", arguments.columns,
                 "NAME=HEADER[:UNIT]: which column of the files it is, and in which unit "
                 "(motor_C=temp:degF, t_s=stamp:ms, drive_A=current:-mA); may be repeated");
  app.add_option("--map", arguments.maps, "a file of such lines, as 'columns FILE --proposal' writes it");
  app.add_option("--rate", arguments.rows_per_s, "rows a second of CSV files without time, in Hz")
      ->multi_option_policy(last_counts)
      ->check(rate);
  app.add_option("--ambient", arguments.ambient_C, "the air's temperature in degC, where no column has it")
      ->multi_option_policy(last_counts)
      ->check(number_within(-90.0, 200.0, "a temperature in degC"))
      ->each([&arguments](const std::string&) { arguments.has_ambient = true; });
  app.add_option("--supply", arguments.supply_V, "the supply in V, where no column has it")
      ->multi_option_policy(last_counts)
      ->check(number_within(0.01, 1e5, "a voltage in V"))
      ->each([&arguments](const std::string&) { arguments.has_supply = true; });
  app.add_option("--constant", arguments.constants,
                 "NAME=NUMBER: another column that the files lack and that did not change; may be repeated");
}

CLI::Option* add_horizon(CLI::App& app, Arguments& arguments) {
  return app.add_option("--horizon", arguments.horizon_s, "length of the axis' windows in s")
      ->multi_option_policy(last_counts)
      ->check(seconds);
}

void add_as_recorded(CLI::App& app, Arguments& arguments) {
  app.add_flag("--as-recorded", arguments.as_recorded,
               "mask and cut nothing: say what is wrong with the data, and use them all the same");
}

void add_simulator_exports(CLI::App& app, Arguments& arguments) {
  app.add_option("--mjcf", arguments.mjcf, "write the axis as a model of MuJoCo (MJCF)");
  app.add_option("--urdf", arguments.urdf, "write the axis as a joint (URDF)");
}
