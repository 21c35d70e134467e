// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "fleet.hpp"
#include "program.hpp"

#include <thermopower/plant/standard_catalogue.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace gap = thermopower::gap;

namespace {

/// Diagnoses one log of a fleet. @return what is wrong; empty where its report is written
std::string diagnose_one(const FleetDiagnosis& asked, Arguments arguments) {
  arguments.model = asked.model;
  arguments.recordings = {asked.recording};
  if (!asked.held_out.empty()) arguments.held_out = {asked.held_out};
  if (!asked.map.empty()) arguments.maps = {asked.map};
  arguments.report = asked.report;
  arguments.html = asked.page;
  arguments.threads = 1;
  arguments.of_fleet = true;
  std::string fault;
  guarded([&] { return diagnose(arguments); }, fault);
  return fault;
}

// No two numbers have the same.
std::string text_of(double value) {
  std::string text = std::to_string(value);
  if (std::stod(text) == value) return text;
  char exact[40];
  std::snprintf(exact, sizeof exact, "%.17g", value);
  return exact;
}

}  // namespace

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
            for (const std::string& one : each.columns)
              work.options.insert(work.options.end(), {"--column", one});
            for (const std::string& one : each.without)
              work.options.insert(work.options.end(), {"--without", one});
            if (horizon->count() > 0)
              work.options.insert(work.options.end(), {"--horizon", text_of(each.horizon_s)});
            work.diagnose = [&each](const FleetDiagnosis& one) { return diagnose_one(one, each); };
            return run_fleet(work);
          }};
}
