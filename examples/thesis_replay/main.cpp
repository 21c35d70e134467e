// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Replays every measured experiment of the thesis through the models, and says how far they are from what was
// measured.

#include <CLI/CLI.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "replay.hpp"
#include "table.hpp"

namespace {

namespace fs = std::filesystem;

constexpr int wrong_usage = 2, wrong_file = 3;

/// The tables: beside the installed program, or in the source tree it was built from.
std::string default_data() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path installed = program.parent_path().parent_path() / THERMOPOWER_DATA_DIR / "thesis";
    if (fs::is_directory(installed, error)) return installed.string();
  }
  return THERMOPOWER_SOURCE_DATA;
}

/// Writes beside the target and renames, so that a target is whole or as it was. What is no file (a pipe, a
/// terminal) is written to.
void write_whole(const std::string& path, const std::string& contents) {
  std::error_code status;
  const bool is_special = fs::exists(path, status) && !fs::is_regular_file(path, status);
  const std::string partial = is_special ? path : path + ".part";
  {
    std::ofstream file(partial, std::ios::binary | std::ios::trunc);
    file << contents;
    file.flush();
    if (!file) {
      std::error_code ignored;
      if (!is_special) fs::remove(partial, ignored);
      throw std::runtime_error(path + ": cannot be written; expected a path in a writable directory");
    }
  }
  if (is_special) return;
  std::error_code error;
  fs::rename(partial, path, error);
  if (!error) return;
  std::error_code ignored;
  fs::remove(partial, ignored);
  throw std::runtime_error(path + ": cannot be written (" + error.message() + ")");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Replays the thesis's measured experiments through the motor models: predicted against measured.");
  std::string data = default_data(), csv, svg;
  double air_C = 26.0;
  app.add_option("--data", data, "Folder with table4_1.csv ... table5_4.csv")->capture_default_str();
  app.add_option("--csv", csv, "Write every curve to this file");
  app.add_option("--svg", svg, "Write a picture of every experiment to this file");
  app.add_option("--air", air_C,
                 "Air temperature of chapter 5 in degC, which the text does not give (25.5 .. 26.3 fits)")
      ->check(
          [](const std::string& text) {
            // Not CLI::Range, which lets NaN pass.
            char* end = nullptr;
            const double value = std::strtod(text.c_str(), &end);
            return *end == 0 && value >= 0.0 && value <= 50.0 ? std::string() : "expected 0 .. 50, in degC";
          },
          "0 .. 50")
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : wrong_usage;
  }

  try {
    const std::vector<thesis::Experiment> experiments = thesis::replay(data, air_C);
    if (!csv.empty()) write_whole(csv, thesis::traces(experiments));
    if (!svg.empty()) write_whole(svg, thesis::picture(experiments));
    std::cout << thesis::report(experiments) << std::flush;
    if (!std::cout) throw std::runtime_error("standard output: cannot be written");
  } catch (const std::exception& error) {
    std::cerr << "thesis_replay: " << error.what() << "\n";
    return wrong_file;
  }
  return 0;
}
