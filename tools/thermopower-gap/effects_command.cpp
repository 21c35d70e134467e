// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "nearest_name.hpp"
#include "program.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/io.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

int list_effects(const std::string& model_path, const std::vector<std::string>& ids) {
  const gap::Catalogue& standard = gap::standard_catalogue();
  gap::Model model;
  if (!model_path.empty()) model = io::read_model(model_path, standard);
  std::vector<gap::EffectInfo> list = gap::catalogue_of(model, standard).list();
  if (!ids.empty()) {
    std::vector<gap::EffectInfo> chosen;
    std::vector<std::string> known;
    for (const gap::EffectInfo& one : list) known.push_back(one.id);
    for (const std::string& id : ids) {
      const auto found = std::find(known.begin(), known.end(), id);
      if (found == known.end()) {
        const std::string nearest = io::nearest_name(id, known);
        throw UsageError(
            "effects: there is no effect " + io::excerpt(id) +
            (nearest.empty() ? "; 'thermopower-gap effects' lists them" : "; did you mean " + nearest + "?"));
      }
      chosen.push_back(list[static_cast<std::size_t>(found - known.begin())]);
    }
    list = chosen;
  }
  std::fputs(io::catalogue_text(list).c_str(), stdout);
  return made;
}

}  // namespace

Command add_effects(CLI::App& program) {
  struct Asked {
    std::string model;
    std::vector<std::string> ids;
  };
  const auto asked = std::make_shared<Asked>();
  CLI::App* const app = program.add_subcommand("effects", "list the catalogue");
  app->add_option("id", asked->ids, "these effects only");
  app->add_option("--model", asked->model, "a model with effects of its own, such as a network (JSON)");
  return {app, [asked] { return list_effects(asked->model, asked->ids); }};
}
