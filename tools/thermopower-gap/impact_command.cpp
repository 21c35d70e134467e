// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "robot_command.hpp"

#include <memory>

Command add_impact(CLI::App& program) {
  const auto asked = std::make_shared<Arguments>();
  const auto robot = std::make_shared<RobotArguments>();
  CLI::App* const app = program.add_subcommand(
      "impact",
      "rank the causes of a robot's gap by the error in what you care about: a joint, a link, a foot");
  app->add_option("--mjcf", asked->mjcf, "the robot as MJCF");
  app->add_option("--urdf", asked->urdf, "the robot as URDF");
  add_recordings(*app, *asked, "a log of the robot, with targets");
  app->add_option("--heldout", asked->held_out, "a log to judge on; may be repeated");
  app->add_option("--of", robot->of,
                  "joint:NAME, body:NAME, site:NAME or geom:NAME; without it all joints together");
  app->add_option("--report", asked->report, "write the ranking for machines (JSON)");
  add_robot_options(*app, *robot);
  add_as_recorded(*app, *asked);
  return {app, [asked, robot] {
            if (!is_robot(*asked))
              throw UsageError("--mjcf or --urdf is required: impact is of a whole robot");
            return rank_impact(*asked, *robot);
          }};
}
