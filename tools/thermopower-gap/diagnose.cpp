// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "program.hpp"
#include "progress.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/gap/observe/heater_duty.hpp>
#include <thermopower/io.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <cstdio>
#include <thread>
#include <utility>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

int diagnose(const Arguments& arguments) {
  const gap::Catalogue& catalogue = gap::standard_catalogue();
  if (!arguments.of_fleet) refuse_overlaps(arguments);
  io::OutputFiles outputs;
  const std::vector<const std::string*> outputs_asked = arguments.outputs();
  for (const auto* path : outputs_asked) {
    if (!path->empty() && !arguments.of_fleet) outputs.expect(*path);
  }
  gap::Diagnosis diagnosis;
  gap::Model model;
  std::vector<gap::EffectInfo> effects;
  io::Provenance made_of;
  {
    Progress progress;
    model = read_model(arguments, catalogue);
    const io::ReadOptions how = reading(arguments, model);
    check_ids(arguments.without, gap::catalogue_of(model, catalogue));
    std::vector<gap::Finding> findings;
    std::vector<gap::Recording> recordings = read_all(arguments.recordings, how, findings);
    std::vector<gap::Recording> held_out = read_all(arguments.held_out, how, findings);
    gap::Options options;
    options.horizon_s = arguments.horizon_s;
    options.tolerance = arguments.tolerance;
    options.without = arguments.without;
    options.threads =
        arguments.threads != 0 ? arguments.threads : std::max(1u, std::thread::hardware_concurrency());
    options.seed = arguments.seed;
    options.as_recorded = arguments.as_recorded;
    if (held_out.empty()) {
      for (auto& recording : recordings) {
        auto [first, last] = gap::split(model, std::move(recording), options.held_out_fraction);
        recording = std::move(first);
        held_out.push_back(std::move(last));
      }
    }
    options.at_stage = [&progress](const char* words) { progress.stage(words); };
    diagnosis = gap::diagnose(model, recordings, held_out, options, catalogue);
    diagnosis.findings.insert(diagnosis.findings.end(), findings.begin(), findings.end());
    io::put_remedies_in_force(diagnosis, how);
    progress.stage("writing the results");
    effects = gap::catalogue_of(model, catalogue).list();
    // A fleet compares its reports byte by byte, wherever its logs lie.
    if (!arguments.of_fleet) made_of = provenance_of(arguments);
    if (!arguments.report.empty())
      outputs.put(arguments.report, io::report_json(diagnosis, model, effects, made_of));
    if (!arguments.html.empty())
      outputs.put(arguments.html, io::report_html(diagnosis, model.name, effects, held_out, made_of));
    if (!arguments.predictions.empty()) {
      outputs.put(arguments.predictions,
                  io::predictions_csv(model, diagnosis, held_out, arguments.horizon_s, catalogue));
    }
    if (!arguments.augmented.empty()) outputs.put(arguments.augmented, io::to_json(diagnosis.augmented));
    write_exports(arguments, diagnosis.augmented, io::one_sentence(diagnosis), catalogue, outputs);
    outputs.commit();
  }
  // Where an output is standard output, it has that for itself.
  const bool taken = std::any_of(outputs_asked.begin(), outputs_asked.end(),
                                 [](const std::string* path) { return *path == "-"; });
  if (!arguments.of_fleet) {
    const std::string text = arguments.summary == "markdown"
                                 ? io::summary_markdown(diagnosis, model.name, effects, made_of)
                                 : io::summary(diagnosis, effects);
    std::fputs(text.c_str(), taken ? stderr : stdout);
  }
  return diagnosis.verdict == gap::Verdict::insufficient ? too_little_data : made;
}
