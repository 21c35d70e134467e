// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "program.hpp"
#include "progress.hpp"

#include <thermopower/design/design.hpp>
#include <thermopower/io.hpp>
#include <thermopower/io/design_files.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

namespace design = thermopower::design;
namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

struct DesignArguments {
  std::string report, limits, out, c_array, html;
  unsigned seed = 1;
};

int run_design(const DesignArguments& asked) {
  const gap::Catalogue& catalogue = gap::standard_catalogue();
  io::OutputFiles outputs;
  for (const std::string* path : {&asked.out, &asked.c_array, &asked.html})
    if (!path->empty()) outputs.expect(*path);
  design::Design design;
  design::Limits limits;
  {
    Progress progress;
    progress.stage("reading");
    const design::DiagnosedGap diagnosed = io::read_report(asked.report, catalogue);
    limits = io::read_limits(asked.limits);
    progress.stage("designing");
    design::DesignOptions options;
    options.seed = asked.seed;
    try {
      design = design::design_experiment(diagnosed, limits, options, catalogue);
    } catch (const gap::InvalidInput& error) {
      const std::string what = error.what(), of_limits = "limits: ";
      if (what.compare(0, of_limits.size(), of_limits) != 0) throw io::InputError(asked.report + ": " + what);
      throw io::InputError(asked.limits + ": " + what.substr(of_limits.size()));
    }
    if (design.ending == design::Ending::schedule) {
      outputs.put(asked.out, io::schedule_csv(design));
      if (!asked.c_array.empty()) outputs.put(asked.c_array, io::schedule_header(design, limits));
    }
    // An older schedule under that name would be taken for the answer.
    if (design.ending != design::Ending::schedule)
      for (const std::string& path : {asked.out, asked.c_array})
        if (std::error_code ignored; path != "-" && std::filesystem::is_regular_file(path, ignored))
          std::filesystem::remove(path, ignored);
    if (!asked.html.empty()) outputs.put(asked.html, io::design_html(design, limits, diagnosed.model.name));
    outputs.commit();
  }
  const bool taken = asked.out == "-" || asked.c_array == "-" || asked.html == "-";
  std::fputs(io::design_summary(design, limits).c_str(), taken ? stderr : stdout);
  // Scripts go by it: with `made` there is a schedule, or none is needed.
  const bool helped = design.ending == design::Ending::schedule || design.ending == design::Ending::enough;
  return helped ? made : too_little_data;
}

}  // namespace

Command add_design(CLI::App& program) {
  const auto asked = std::make_shared<DesignArguments>();
  CLI::App* const app = program.add_subcommand(
      "design", "write the experiment that best tells apart what a report leaves open");
  app->add_option("--report", asked->report, "the report of diagnose (JSON)")->required();
  app->add_option("--limits", asked->limits, "what the experiment may do (JSON)")->required();
  app->add_option("--out", asked->out, "write the schedule (CSV)")->required();
  app->add_option("--c-array", asked->c_array, "write the schedule as a header for firmware, too");
  app->add_option("--html", asked->html, "write a page with the predicted curves");
  app->add_option("--seed", asked->seed, "of the search")
      ->check(whole_number(4294967295.0))
      ->capture_default_str();
  return {app, [asked] { return run_design(*asked); }};
}
