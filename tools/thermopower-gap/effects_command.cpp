// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "program.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/io.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

int list_effects(const std::string& model_path) {
  const gap::Catalogue& standard = gap::standard_catalogue();
  gap::Model model;
  if (!model_path.empty()) model = io::read_model(model_path, standard);
  std::fputs(io::catalogue_text(gap::catalogue_of(model, standard).list()).c_str(), stdout);
  return made;
}

}  // namespace

Command add_effects(CLI::App& program) {
  const auto model = std::make_shared<std::string>();
  CLI::App* const app = program.add_subcommand("effects", "list the catalogue");
  app->add_option("--model", *model, "a model with effects of its own, such as a network (JSON)");
  return {app, [model] { return list_effects(*model); }};
}
