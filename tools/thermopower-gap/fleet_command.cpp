// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "fleet.hpp"
#include "program.hpp"

#include <thermopower/plant/standard_catalogue.hpp>

#include <memory>
#include <string>

namespace gap = thermopower::gap;

Command add_fleet(CLI::App& program) {
  struct Asked {
    FleetArguments fleet;
    Arguments each;  ///< of every diagnosis
  };
  const auto asked = std::make_shared<Asked>();
  FleetArguments& fleet = asked->fleet;
  CLI::App* const app = program.add_subcommand(
      "fleet", "diagnose every log of a table, several at a time; the same command resumes");
  app->add_option(
         "manifest", fleet.manifest,
         "the logs (CSV): log, model, and where needed unit, time, heldout, map; paths from its folder on")
      ->required();
  app->add_option("--out", fleet.out, "folder of the results: reports/, fleet.html, logs.csv and others")
      ->required();
  app->add_option("--workers", fleet.workers,
                  "processes at a time; 0: one per core. The results do not depend on it")
      ->check(whole_number(1024.0))
      ->capture_default_str();
  app->add_flag("!--no-pages", fleet.pages, "write no page (HTML) for each log");
  app->add_option("--column", asked->each.columns, "as for diagnose, of every log");
  app->add_option("--without", asked->each.without, "as for diagnose");
  const CLI::Option* const horizon = add_horizon(*app, asked->each);
  return {app, [asked, horizon] {
            FleetArguments& work = asked->fleet;
            const Arguments& each = asked->each;
            check_ids(each.without, gap::standard_catalogue());
            for (const std::string& one : each.columns) expect_choice(one);
            work.options = options_of_fleet(each, horizon->count() > 0);
            work.diagnose = [&each](const FleetDiagnosis& one) { return diagnose_of_fleet(one, each); };
            return run_fleet(work);
          }};
}
