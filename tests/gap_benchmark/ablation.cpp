// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// The worth of each rule of the diagnosis: how many ask for it, and how many answers change without it. Reads what ablation.sh left.
//   gap_benchmark_ablation --dir DIR --out FILE.md [--real FOLDER] [--note TEXT] RULE ...
// Reports with all rules are in DIR/reports (of real recordings in DIR/real/reports), those without one in DIR/reports_without_RULE.

#include <filesystem>
#include <fstream>
#include <iostream>

#include "answer.hpp"

namespace {

using namespace gap_benchmark;

/// What changes without a rule.
struct Change {
  int right_to_wrong = 0, wrong_to_right = 0, other = 0;
  std::vector<std::string> jobs;  ///< whose answer became wrong
};

/// Answers to the same recordings, with all rules and without one.
class Answers {
public:
  /// @param truth  whether an answer to a case is right
  template <class Right>
  void compare(const std::string& job, const std::string& with, const std::string& without, Right&& right) {
    const Verdict a = read_verdict(with);
    const bool before = right(a);
    ++cases_;
    right_ += before;
    if (!std::filesystem::exists(without)) return;  // it did not ask for the rule
    ++asked_;
    const Verdict b = read_verdict(without);
    const bool after = right(b);
    if (before && !after) {
      ++change_.right_to_wrong;
      change_.jobs.push_back(job);
    } else if (!before && after) {
      ++change_.wrong_to_right;
    } else if (a.verdict != b.verdict || a.cause != b.cause) {
      ++change_.other;
    }
  }

  int cases() const { return cases_; }
  int asked() const { return asked_; }
  int right() const { return right_; }
  const Change& change() const { return change_; }

private:
  int cases_ = 0, asked_ = 0, right_ = 0;
  Change change_;
};

Answers of_benchmark(const std::string& directory, const std::string& rule) {
  std::ifstream file(directory + "/sealed/labels.json");
  const Json sealed = Json::parse(file);
  Answers answers;
  for (const auto& entry : sealed["cases"].items())
    answers.compare(entry.key(), directory + "/reports/" + entry.key(),
                    directory + "/reports_without_" + rule + "/" + entry.key(),
                    [&](const Verdict& v) { return is_right(v, entry.value()); });
  return answers;
}

Answers of_real(const std::string& directory, const std::string& real, const std::string& rule) {
  std::ifstream file(real + "/truths.json");
  const Json truths = Json::parse(file);
  Answers answers;
  for (const auto& entry : truths.items())
    answers.compare(entry.key(), directory + "/real/reports/" + entry.key(),
                    directory + "/real/reports_without_" + rule + "/" + entry.key(),
                    [&](const Verdict& v) { return is_right_of_real(v, entry.value()); });
  return answers;
}

void print(std::ostream& out, const std::string& rule, const Answers& drawn, const Answers* real) {
  out << "| `" << rule << "` |";
  for (const Answers* one : {&drawn, real})
    if (one != nullptr)
      out << " " << one->asked() << " | " << one->change().right_to_wrong << " | "
          << one->change().wrong_to_right << " | " << one->change().other << " |";
  std::string jobs;
  for (std::size_t i = 0; i < drawn.change().jobs.size() && i < 6; ++i)
    jobs += (i ? ", " : "") + drawn.change().jobs[i];
  out << " " << jobs << " |\n";
}

}  // namespace

int main(int argc, char** argv) {
  std::string directory, out_path, real, note;
  std::vector<std::string> rules;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    std::string* const value = option == "--dir"    ? &directory
                               : option == "--out"  ? &out_path
                               : option == "--real" ? &real
                               : option == "--note" ? &note
                                                    : nullptr;
    if (value != nullptr && i + 1 < argc) *value = argv[++i];
    else rules.push_back(option);
  }
  if (directory.empty() || out_path.empty() || rules.empty()) {
    std::cerr
        << "usage: gap_benchmark_ablation --dir DIR --out FILE.md [--real FOLDER] [--note TEXT] RULE ...\n";
    return 2;
  }
  try {
    const Answers all = of_benchmark(directory, rules.front());
    std::ofstream out(out_path);
    out << "# The worth of each rule of the diagnosis\n<!-- page gap_ablation -->\n\n"
           "For engineers who change the diagnosis. One rule is taken away at a time, and the same recordings are diagnosed\n"
           "again. The table says how many asked for it, because it would change something there, and how many answers change.\n"
           "Rules without which nothing becomes worse are the next to go. The rules are listed in `thermopower/gap/rule.hpp`.\n\n"
        << (note.empty() ? "" : note + "\n\n") << "With all rules " << all.right() << " of " << all.cases()
        << " drawn recordings are answered rightly or honestly";
    if (!real.empty()) {
      const Answers measured = of_real(directory, real, rules.front());
      out << ", and " << measured.right() << " of " << measured.cases() << " real ones";
    }
    out << ".\n\n| without | drawn: asked for it | right to wrong | wrong to right | other answer |"
        << (real.empty() ? "" : " real: asked for it | right to wrong | wrong to right | other answer |")
        << " drawn ones that become wrong |\n|---|---|---|---|---|"
        << (real.empty() ? "" : "---|---|---|---|") << "---|\n";
    for (const std::string& rule : rules) {
      const Answers drawn = of_benchmark(directory, rule);
      if (real.empty()) {
        print(out, rule, drawn, nullptr);
      } else {
        const Answers measured = of_real(directory, real, rule);
        print(out, rule, drawn, &measured);
      }
    }
    if (!out) throw std::runtime_error("cannot write " + out_path);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "gap_benchmark_ablation: " << error.what() << "\n";
    return 1;
  }
}
