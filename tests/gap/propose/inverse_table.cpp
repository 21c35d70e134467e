// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Prints what the inverse problem says of case folders (model.json, train*.csv, heldout*.csv): a tool for developers.

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/propose/effort_problem.hpp>
#include <thermopower/io/model_file.hpp>
#include <thermopower/io/recording_file.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <ctime>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

std::vector<Recording> recordings(const fs::path& folder, const std::string& prefix) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().rfind(prefix, 0) == 0 && entry.path().extension() == ".csv")
      paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Recording> list;
  for (const fs::path& path : paths) list.push_back(thermopower::io::read_recording(path.string()).recording);
  return list;
}

std::vector<Inputs> inputs_of(std::vector<PreparedRecording>& prepared) {
  std::vector<Inputs> list;
  for (PreparedRecording& one : prepared) list.push_back(std::move(one).take_inputs());
  return list;
}

void print(const char* what, const InverseScore& score, const Model& model, bool details) {
  std::string ids;
  for (const auto* effect : score.effects) ids += (ids.empty() ? "" : " + ") + effect->info.id;
  if (!score.judged) {
    if (details) std::printf("  %-8s %-44s %s\n", what, ids.c_str(), to_string(score.refusal));
    return;
  }
  std::printf("  %-8s %-44s %5.1f %% (train %5.1f)  gain %7.2f +- %6.2f of %zu", what, ids.c_str(),
              100.0 * score.share, 100.0 * score.train_share, score.gain, score.gain_error,
              score.block_gain.size());
  if (score.refusal != InverseRefusal::none) std::printf("  [%s]", to_string(score.refusal));
  for (const InverseEstimate& one : score.parameters)
    if (one.fitted)
      std::printf("  %s %.3g(%.1g)", one.effect->info.parameters[one.parameter].name.c_str(), one.value,
                  one.standard_error);
  const auto constants = model.calibrated();
  for (const InverseConstant& one : score.constants)
    std::printf("  %s x%.3g", constants[one.constant].id.c_str(), one.moved_by);
  std::printf("\n");
}

}  // namespace

int main(int count, char** arguments) {
  bool details = false;
  for (int k = 1; k < count; ++k) {
    const std::string argument = arguments[k];
    if (argument == "--all") {
      details = true;
      continue;
    }
    try {
      const fs::path folder = argument;
      const auto& catalogue = thermopower::plant::standard_catalogue();
      const Model model = thermopower::io::read_model((folder / "model.json").string(), catalogue);
      CheckedRecordings checked =
          check(model, recordings(folder, "train"), recordings(folder, "heldout"), CheckOptions{}, catalogue);
      const std::vector<Inputs> train = inputs_of(checked.train), held = inputs_of(checked.held_out);
      Eigen::Index rows = 0;
      for (const Inputs& one : train) rows += one.rows();
      const std::clock_t start = std::clock();
      EffortProblem problem(model, catalogue, train, held);
      const std::vector<InverseProposal> proposals = problem.proposals();
      const InverseScore told = problem.told();
      const double took = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      const std::string name = fs::path(fs::absolute(folder).lexically_normal()).filename().string();
      std::string ids;
      for (const auto* effect : told.effects) ids += (ids.empty() ? "" : " + ") + effect->info.id;
      std::printf("%-18s %5.0f %% -> %3.0f %%  %-55s loop %s (%.2f)  %.3g Hz  %.2f s of %ld rows\n",
                  name.c_str(), 100.0 * problem.nothing().share, 100.0 * told.share,
                  !problem.is_judged() ? to_string(problem.refusal())
                  : ids.empty()        ? "nothing"
                                       : ids.c_str(),
                  to_string(problem.loop().kind), problem.loop().followed_share, problem.low_pass_Hz(), took,
                  static_cast<long>(rows));
      if (!details) continue;
      print("nothing", problem.nothing(), model, true);
      for (const InverseScore& one : problem.singles()) print("single", one, model, true);
      std::size_t shown = 0;
      for (const InverseProposal& one : proposals)
        if (one.score.effects.size() > 1 && shown++ < 8)
          print(one.is_told ? "told" : "tried", one.score, model, true);
    } catch (const std::exception& error) {
      std::printf("%s: %s\n", argument.c_str(), error.what());
    }
  }
  return 0;
}
