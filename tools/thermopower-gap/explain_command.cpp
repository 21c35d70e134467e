// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "nearest_name.hpp"
#include "program.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/io.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

struct Asked {
  std::vector<std::string> codes;
  std::string model;
  bool markdown = false;
};

int explain(const Asked& asked) {
  if (asked.markdown) {
    std::fputs(io::code_pages_markdown().c_str(), stdout);
    return made;
  }
  std::vector<gap::EffectInfo> effects;
  if (!asked.model.empty()) {
    const gap::Catalogue& standard = gap::standard_catalogue();
    effects = gap::catalogue_of(io::read_model(asked.model, standard), standard).list();
  }
  const std::vector<std::string> known = io::known_codes(effects);
  if (asked.codes.empty()) {
    std::puts("Codes that 'thermopower-gap explain CODE' explains:");
    for (const std::string& one : known) std::printf("  %s\n", one.c_str());
    std::puts("  calibration.<constant>");
    return made;
  }
  std::string text;
  for (const std::string& code : asked.codes) {
    const auto page = io::code_page(code, effects);
    if (!page) {
      const std::string nearest = io::nearest_name(code, known);
      throw UsageError(
          "explain: there is no code " + io::excerpt(code) +
          (nearest.empty() ? "; 'thermopower-gap explain' lists them" : "; did you mean " + nearest + "?"));
    }
    text += (text.empty() ? "" : "\n") + io::to_text(*page);
  }
  std::fputs(text.c_str(), stdout);
  return made;
}

}  // namespace

Command add_explain(CLI::App& program) {
  const auto asked = std::make_shared<Asked>();
  CLI::App* const app =
      program.add_subcommand("explain", "say what an effect, finding, verdict or reason of a report means");
  app->add_option("code", asked->codes,
                  "as the report spells it, such as winding_tempco; without one, all are listed");
  app->add_option("--model", asked->model, "a model with effects of its own, such as a network (JSON)");
  app->add_flag("--markdown", asked->markdown, "print all pages as Markdown");
  return {app, [asked] { return explain(*asked); }};
}
