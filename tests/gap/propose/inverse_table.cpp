// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Prints what the inverse problem says of case folders (model.json, train*.csv, heldout*.csv): a tool for developers.
//
//     gap_inverse_table [--all] CASE_DIR ...    a line for each; with --all every effect and the sets that were tried
//     gap_inverse_table --benchmark DIR         what gap_benchmark_generate drew, scored: is what is told of the right kind?

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/propose/effort_problem.hpp>
#include <thermopower/io/model_file.hpp>
#include <thermopower/io/recording_file.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ctime>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
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

void print(const char* what, const InverseScore& score, const Model& model) {
  std::string ids;
  for (const auto* effect : score.effects) ids += (ids.empty() ? "" : " + ") + effect->info.id;
  if (score.refusal == InverseRefusal::not_told) {
    std::printf("  %-8s %-44s not told\n", what, ids.c_str());
    return;
  }
  std::printf("  %-8s %-44s %5.1f %%", what, ids.c_str(), 100.0 * score.share);
  if (score.refusal != InverseRefusal::none)
    std::printf("  [%s]", score.refusal == InverseRefusal::of_stamps ? "of stamps" : "not itself");
  for (const InverseEstimate& one : score.parameters)
    if (one.fitted)
      std::printf("  %s %.3g(%.1g)", one.effect->info.parameters[one.parameter].name.c_str(), one.value,
                  one.standard_error);
  const auto constants = model.calibrated();
  for (const InverseConstant& one : score.constants)
    std::printf("  %s x%.3g", constants[one.constant].id.c_str(), one.moved_by);
  std::printf("\n");
}

/// Says what is told of a case. @return the ids, in the order told
std::vector<std::string> tell(const fs::path& folder, bool details) {
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
  const double took_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::vector<std::string> list;
  std::string ids;
  for (const auto* effect : told.effects) {
    list.push_back(effect->info.id);
    ids += (ids.empty() ? "" : " + ") + effect->info.id;
  }
  std::printf("%-18s %4.0f %% -> %3.0f %%  %-45s loop %s, %.2f s of %ld rows\n",
              fs::absolute(folder).lexically_normal().filename().string().c_str(),
              100.0 * problem.score({}).share, 100.0 * told.share,
              !problem.is_judged() ? "not judged"
              : ids.empty()        ? "nothing"
                                   : ids.c_str(),
              to_string(problem.loop()), took_s, static_cast<long>(rows));
  if (!details) return list;
  print("nothing", problem.score({}), model);
  for (const auto& entry : catalogue.entries())
    if (entry.hooks.any_axis()) print("single", problem.score({&entry}), model);
  constexpr std::size_t most = 8;
  std::size_t shown = 0;
  for (const InverseProposal& one : proposals)
    if (one.score.effects.size() > 1 && shown++ < most)
      print(one.is_told ? "told" : "tried", one.score, model);
  return list;
}

/// How many cases of a kind are right.
struct Tally {
  int cases = 0, right = 0, false_named = 0;
};

/// Scores a directory of the benchmark: right is the kind of what is told first, or nothing where nothing is missing.
void score_benchmark(const fs::path& directory) {
  std::ifstream file(directory / "sealed/labels.json");
  if (!file) throw std::runtime_error("no sealed/labels.json in it: draw it with gap_benchmark_generate");
  const nlohmann::json labels = nlohmann::json::parse(file);
  std::map<std::string, Tally> tallies;
  for (const auto& [name, label] : labels.at("cases").items()) {
    if (label.at("kind") != "axis" || !label.at("unknown").is_null()) continue;
    const std::vector<std::string> told = tell(directory / "cases" / name, false);
    const auto causes = label.at("effects").get<std::vector<std::string>>();
    const auto family = label.value("family", causes);
    const bool right = causes.empty()
                           ? told.empty()
                           : !told.empty() && std::count(family.begin(), family.end(), told.front()) > 0;
    for (const std::string& key :
         {causes.empty() ? std::string("nothing") : causes.front(), std::string("all")}) {
      Tally& tally = tallies[key];
      ++tally.cases;
      tally.right += right;
      tally.false_named += !right && !told.empty();
    }
  }
  for (const auto& [key, tally] : tallies)
    std::printf("%-24s %3d of %3d right, %d told falsely\n", key.c_str(), tally.right, tally.cases,
                tally.false_named);
}

}  // namespace

int main(int count, char** arguments) {
  bool details = false;
  int failed = 0;
  for (int k = 1; k < count; ++k) {
    const std::string argument = arguments[k];
    try {
      if (argument == "--all") details = true;
      else if (argument == "--benchmark" && k + 1 < count) score_benchmark(arguments[++k]);
      else tell(argument, details);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "gap_inverse_table: %s: %s\n", arguments[k], error.what());
      failed = 1;
    }
  }
  return failed;
}
