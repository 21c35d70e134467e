// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "file_source.hpp"
#include "program.hpp"
#include "text_file.hpp"

#include <thermopower/io.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace io = thermopower::io;

Command add_compare(CLI::App& program) {
  const auto asked = std::make_shared<std::vector<std::string>>();
  CLI::App* const app = program.add_subcommand(
      "compare", "say in what two reports differ: two units, before and after, two simulators");
  app->add_option("report", *asked, "two reports that 'diagnose --report' wrote (JSON)");
  return {app, [asked] {
            if (asked->size() != 2)
              throw UsageError("compare: " + std::to_string(asked->size()) +
                               " reports are given; expected two, such as before.json after.json");
            const auto text_of = [](const std::string& path) {
              io::open_input(path, "a report (JSON)");
              return io::NamedReport{path, read_text(path)};
            };
            std::fputs(io::comparison(text_of((*asked)[0]), text_of((*asked)[1])).c_str(), stdout);
            return made;
          }};
}
