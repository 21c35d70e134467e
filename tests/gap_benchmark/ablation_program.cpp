// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// `diagnose` of the program and nothing else, linked to the library in which a rule can be taken away: as judge.sh calls it.
#include <thermopower/gap.hpp>
#include <thermopower/gap/rule.hpp>
#include <thermopower/io.hpp>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

int main(int count, char** values) {
  try {
    std::string model_path, report;
    std::vector<gap::Recording> train, held_out;
    gap::Options options;
    options.threads = 1;
    for (int i = 2; i + 1 < count; i += 2) {
      const std::string option = values[i], value = values[i + 1];
      if (option == "--model") model_path = value;
      else if (option == "--recording") train.push_back(io::read_recording(value).recording);
      else if (option == "--heldout") held_out.push_back(io::read_recording(value).recording);
      else if (option == "--report") report = value;
      else if (option == "--without") options.without.push_back(value);
    }
    const gap::Model model = io::read_model(model_path, gap::standard_catalogue());
    const gap::Diagnosis diagnosis = gap::diagnose(model, train, held_out, options);
    io::OutputFiles files;
    files.put(report, io::report_json(diagnosis));
    files.commit();
    std::printf("%s\nasked", gap::to_string(diagnosis.verdict));
    for (const std::string& rule : gap::engine::rules_asked_for()) std::printf(" %s", rule.c_str());
    std::printf("\n");
    return diagnosis.verdict == gap::Verdict::insufficient ? 4 : 0;
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "gap_ablation_program: %s\n", problem.what());
    return 3;
  }
}
