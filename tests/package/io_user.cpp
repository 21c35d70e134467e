// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A program that links what reads and writes the files of the diagnosis, from an installed package.
#include <thermopower/io.hpp>

#include <cstdio>

namespace io = thermopower::io;
namespace gap = thermopower::gap;

int main() {
  const gap::Model model = io::parse_model("here",
                                           R"({"format": "thermopower-model/1", "name": "motor",
          "current": {"law": "ohmic", "resistance_ohm": 8.25}})",
                                           gap::standard_catalogue());
  const char csv[] = "t_s,motor_C\n0,20\n1,21.5\n";
  const gap::Recording recording =
      io::to_recording(io::parse_csv("here", csv, sizeof csv - 1, io::known_columns())).recording;
  const bool page = io::report_html({}, model.name, {}).find("</html>") != std::string::npos;
  const bool header = io::motor_model_header(model, "a test").text.find("8.25f") != std::string::npos;
  std::printf("read %g degC, page %d, header %d\n", recording.column("motor_C")[1], page, header);
  return recording.column("motor_C")[1] == 21.5 && page && header ? 0 : 1;
}
