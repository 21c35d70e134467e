// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "program.hpp"
#include "robot_command.hpp"

#include <memory>
#include <string>

Command add_diagnose(CLI::App& program) {
  const auto asked = std::make_shared<Arguments>();
  const auto robot = std::make_shared<RobotArguments>();
  CLI::App* const app = program.add_subcommand("diagnose", "find the missing effect");
  app->add_option(
      "--model", asked->model,
      "the simulation under test (JSON); a whole robot instead: --mjcf or --urdf without --model");
  add_recordings(*app, *asked, "a recording to find and fit on");
  app->add_option("--heldout", asked->held_out,
                  "a recording to judge on; without it the last 30 % of each recording");
  app->add_option("--report", asked->report, "write the report for machines (JSON)");
  app->add_option("--html", asked->html, "write the report for people (one HTML page)");
  app->add_option("--predictions", asked->predictions, "write held-out predictions (CSV)");
  app->add_option("--augmented", asked->augmented, "write the model with what was found (JSON)");
  app->add_option("--header", asked->header, "write the same as a C++11 header for firmware");
  app->add_option("--summary", asked->summary,
                  "how the answer is printed: text, or markdown to paste into an issue")
      ->check(CLI::Validator(
          [](std::string& text) {
            return text == "text" || text == "markdown" ? std::string()
                                                        : "'" + text + "' is not text or markdown";
          },
          "text|markdown"))
      ->capture_default_str();
  app->add_option("--without", asked->without, "remove an effect from the catalogue; may be repeated");
  add_horizon(*app, *asked)->capture_default_str();
  app->add_option("--tolerance", asked->tolerance, "smallest relative shrinkage of the gap that counts")
      ->check(share)
      ->capture_default_str();
  app->add_option("--threads", asked->threads,
                  "worker threads; 0: one per core. The result does not depend on it")
      ->check(whole_number(1024.0))
      ->capture_default_str();
  app->add_option("--seed", asked->seed, "of the bootstrap")
      ->check(whole_number(4294967295.0))
      ->capture_default_str();
  add_as_recorded(*app, *asked);
  add_column_choices(*app, *asked);
  add_simulator_exports(*app, *asked);
  add_robot_options(*app, *robot);
  add_training_outputs(*app, *robot);
  return {app, [asked, robot] {
            if (is_robot(*asked)) return diagnose_robot(*asked, *robot);
            if (asked->model.empty())
              throw UsageError("--model is required, or --mjcf or --urdf for a whole robot");
            return diagnose(*asked);
          }};
}
