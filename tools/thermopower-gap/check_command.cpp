// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "robot_command.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/io.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cstdio>
#include <memory>
#include <vector>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

int check(const Arguments& arguments) {
  const gap::Catalogue& catalogue = gap::standard_catalogue();
  refuse_overlaps(arguments);
  io::OutputFiles outputs;
  if (!arguments.report.empty()) outputs.expect(arguments.report);
  gap::DataReport report;
  {
    Progress progress;
    const gap::Model model = io::read_model(arguments.model, catalogue);
    const io::ReadOptions how = reading(arguments, model);
    std::vector<gap::Finding> findings;
    const std::vector<gap::Recording> recordings = read_all(arguments.recordings, how, findings);
    const std::vector<gap::Recording> held_out = read_all(arguments.held_out, how, findings);
    gap::Options options;
    options.horizon_s = arguments.horizon_s;
    options.as_recorded = arguments.as_recorded;
    progress.stage("checking");
    report = gap::check_data(model, recordings, held_out, options, catalogue);
    report.findings.insert(report.findings.end(), findings.begin(), findings.end());
    io::put_remedies_in_force(report, how);
    if (!arguments.report.empty()) outputs.put(arguments.report, io::check_json(report));
    outputs.commit();
  }
  std::fputs(io::check_text(report).c_str(), arguments.report == "-" ? stderr : stdout);
  return gap::deciding(report.findings) != nullptr || !report.too_little.empty() ? too_little_data : made;
}

}  // namespace

Command add_check(CLI::App& program) {
  const auto asked = std::make_shared<Arguments>();
  CLI::App* const app = program.add_subcommand(
      "check", "say what is wrong with recordings, and what they can show; nothing is fitted");
  const auto robot = std::make_shared<RobotArguments>();
  app->add_option(
      "--model", asked->model,
      "the simulation under test (JSON); a whole robot instead: --mjcf or --urdf without --model");
  app->add_option("--mjcf", asked->mjcf, "a whole robot as MJCF, whose log is checked");
  app->add_option("--urdf", asked->urdf, "the same as URDF");
  add_recordings(*app, *asked, "a recording");
  app->add_option("--heldout", asked->held_out, "a recording to judge on; may be repeated");
  app->add_option("--report", asked->report, "write the same for machines (JSON)");
  add_horizon(*app, *asked)->capture_default_str();
  add_as_recorded(*app, *asked);
  add_column_choices(*app, *asked);
  add_robot_options(*app, *robot);
  return {app, [asked, robot] {
            if (is_robot(*asked)) return check_robot(*asked, *robot);
            if (asked->model.empty())
              throw UsageError("--model is required, or --mjcf or --urdf for a whole robot");
            if (!asked->mjcf.empty() || !asked->urdf.empty())
              throw UsageError(
                  "--model is of one actuator, and --mjcf and --urdf of a whole robot; expected one of them");
            return check(*asked);
          }};
}
