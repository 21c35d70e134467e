// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "program.hpp"

#include <thermopower/io.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <memory>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

int export_model(const Arguments& arguments) {
  const gap::Catalogue& catalogue = gap::standard_catalogue();
  refuse_overlaps(arguments);
  if (arguments.header.empty() && arguments.mjcf.empty() && arguments.urdf.empty())
    throw UsageError("export: expected at least one of --mjcf, --urdf and --header");
  io::OutputFiles outputs;
  for (const auto* path : arguments.outputs())
    if (!path->empty()) outputs.expect(*path);
  const gap::Model model = read_model(arguments, catalogue);
  write_exports(arguments, model, "from " + plain_path(arguments.model).filename().string(), catalogue,
                outputs);
  outputs.commit();
  return made;
}

}  // namespace

Command add_export(CLI::App& program) {
  const auto asked = std::make_shared<Arguments>();
  CLI::App* const app =
      program.add_subcommand("export", "write a model in the words of other simulators, or as a header");
  app->add_option("--model", asked->model, "a model, with effects or without (JSON)")->required();
  add_simulator_exports(*app, *asked);
  app->add_option("--header", asked->header, "write a C++11 header for firmware");
  return {app, [asked] { return export_model(*asked); }};
}
