// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  the thesis's chapter 5 shows on a real gimbal that the temperature model, the protection and the
// power law work; its
//           gimbal is gone, its power comparison uses two definitions of power, and its yaw errors were never
//           explained.
// Model:    the simulated rig (two thermal nodes, friction, imbalance, cable, cogging, the board's loop)
// under the thesis's program. Notation: axes roll, pitch, yaw; temperatures in degC; POWER and P are the
// board's parameters, 0 .. 255.
#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>

#include "chapter5.hpp"

int main(int argc, char** argv) {
  CLI::App app{
      "Re-makes chapter 5 of the thesis on the simulated rig: tables on the terminal, figures as SVG."};
  std::string directory = "chapter5";
  app.add_option("--out", directory, "Directory for the figures; made when it is missing")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::filesystem::create_directories(directory);
    chapter5::temperatures(directory);
    chapter5::protection(directory);
    chapter5::responses(directory);
    chapter5::power_comparison();
    chapter5::yaw_riddle(directory);
  } catch (const std::exception& error) {
    std::cerr << "chapter5: " << error.what() << '\n';
    return 3;
  }
  std::cout << "\nall of chapter 5: figures are in " << directory << '\n';
}
