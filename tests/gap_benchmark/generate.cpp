// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Draws recordings whose cause is known, and seals the causes in a file of their own:
//   DIR/cases/NNN/{model.json,train.csv,heldout.csv}   what the judge sees
//   DIR/jobs.txt                                       job, case, and the effects to take out of the
//   catalogue DIR/sealed/labels.json                             what only the scorer sees

#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>
#include <thread>

#include "axis_draw.hpp"
#include "beginner_draw.hpp"
#include "bench_draw.hpp"
#include "closed_loop_draw.hpp"
#include "plan.hpp"
#include "slow_log_draw.hpp"

namespace {

using namespace gap_benchmark;
using Json = nlohmann::ordered_json;

struct Options {
  std::string out, only;
  Part part = Part::none;
  unsigned long long seed = 1;
  int count = 5, threads = 2, one = -1;
  double least_visible = 0.0, most_visible = 0.0;  // 0: as planned
  bool quick = false, leave_one_out = true;
};

constexpr const char* usage =
    "usage: gap_benchmark_generate --out DIR --seed S [options]\n"
    "  --count N     recordings per single effect (5); the other kinds are scaled along\n"
    "  --only LIST   effect ids, none, pairs, unknown, dirty, dirty_none, dirty_unknown, servo, misspecified,\n"
    "                with commas between\n"
    "  --part NAME   cases of one part alone: beginner, closed_loops or slow_logs; --count is how many of them\n"
    "  --case N      draw only this case of the plan\n"
    "  --threads N   cases drawn at once (2); the result does not depend on it\n"
    "  --visible LOW,HIGH  only causes whose RMS over the floor is in this range, in whichever recording shows less\n"
    "  --quick       do not look for the best wrong cause (no confusability in the labels)\n"
    "  --no-leave-one-out\n";

bool parse(int argc, char** argv, Options& options) {
  try {
    for (int i = 1; i < argc; ++i) {
      const std::string option = argv[i];
      const auto value = [&] {
        if (i + 1 >= argc) throw std::invalid_argument(option + " needs a value");
        return std::string(argv[++i]);
      };
      if (option == "--out") options.out = value();
      else if (option == "--seed") options.seed = std::stoull(value());
      else if (option == "--only") options.only = value();
      else if (option == "--part") {
        const std::string text = value();
        options.part = part_of(text);
        if (options.part == Part::none)
          throw std::invalid_argument("--part expects beginner, closed_loops or slow_logs, not '" + text +
                                      "'");
      } else if (option == "--count") options.count = std::stoi(value());
      else if (option == "--case") options.one = std::stoi(value());
      else if (option == "--threads") options.threads = std::stoi(value());
      else if (option == "--visible") {
        const std::string range = value();
        const std::size_t comma = range.find(',');
        if (comma == std::string::npos) throw std::invalid_argument("--visible expects LOW,HIGH");
        options.least_visible = std::stod(range.substr(0, comma));
        options.most_visible = std::stod(range.substr(comma + 1));
        if (!(options.least_visible > 0.0) || !(options.most_visible > options.least_visible))
          throw std::invalid_argument("--visible expects 0 < LOW < HIGH");
      } else if (option == "--quick") options.quick = true;
      else if (option == "--no-leave-one-out") options.leave_one_out = false;
      else throw std::invalid_argument("unknown option " + option);
    }
    if (options.out.empty()) throw std::invalid_argument("--out is missing");
    return true;
  } catch (const std::exception& error) {
    std::cerr << "gap_benchmark_generate: " << error.what() << "\n" << usage;
    return false;
  }
}

std::string numbered(const char* format, std::size_t number) {
  char text[24];
  std::snprintf(text, sizeof text, format, static_cast<int>(number));
  return text;
}

/// A case of the plan, or of a part.
DrawnCase draw(const Options& options, const CaseOrder& order, std::size_t number, Random& random) {
  const int i = static_cast<int>(number);
  if (options.part == Part::beginner) return draw_beginner_case(i, random);
  if (options.part == Part::closed_loops) return draw_closed_loop_case(i, random);
  if (options.part == Part::slow_logs) return draw_slow_log_case(i, random);
  return order.axis ? draw_axis_case(order, random) : draw_bench_case(order, random);
}

Json complete(DrawnCase& drawn, const CaseOrder& order) {
  const Assessment& a = drawn.assessment;
  Json label = drawn.label;
  label["visible"] = {{"train", a.visible_train}, {"heldout", a.visible_heldout}};
  if (order.thorough && !a.suspects.empty()) {
    label["confusability"] = a.confusability();
    label["confused_with"] = a.confused_with();
    label["left_over"] = a.left_over;
    for (const auto& suspect : a.suspects) label["likeness"][suspect.id] = suspect.likeness;
  }
  return label;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!parse(argc, argv, options)) return 2;
  const bool whole = options.part == Part::none;
  std::vector<CaseOrder> orders =
      whole ? plan(options.seed, options.count, options.only, !options.quick)
            : std::vector<CaseOrder>(static_cast<std::size_t>(std::max(0, options.count)));
  if (options.most_visible > 0.0)
    for (CaseOrder& order : orders) {
      order.gate = options.least_visible;
      order.ceiling = options.most_visible;
    }
  if (orders.empty()) {
    std::cerr << "gap_benchmark_generate: nothing is called " << options.only << "\n";
    return 2;
  }
  std::filesystem::create_directories(options.out + "/sealed");
  std::vector<Json> labels(orders.size());
  std::mutex talking;
  std::atomic<std::size_t> next{0};
  std::atomic<int> failed{0};
  const auto work = [&] {
    for (std::size_t i; (i = next++) < orders.size();) {
      if (options.one >= 0 && i != static_cast<std::size_t>(options.one)) continue;
      const CaseOrder& order = orders[i];
      Random random(options.seed * 0x100000001b3ull + i);
      const auto began = std::chrono::steady_clock::now();
      std::string line;
      try {
        DrawnCase drawn = draw(options, order, i, random);
        const std::string directory = options.out + "/cases/" + numbered("%03d", i);
        std::filesystem::create_directories(directory);
        drawn.train.write(directory + "/train.csv");
        drawn.heldout.write(directory + "/heldout.csv");
        std::ofstream(directory + "/model.json") << drawn.model.dump(1) << "\n";
        labels[i] = whole ? complete(drawn, order) : drawn.label;
        char text[200];
        if (whole)
          std::snprintf(text, sizeof text, "%6zu rows, visible %6.1f / %6.1f, confusability %.3f %s",
                        drawn.train.rows(), drawn.assessment.visible_train, drawn.assessment.visible_heldout,
                        drawn.assessment.confusability(), drawn.assessment.confused_with().c_str());
        else std::snprintf(text, sizeof text, "%6zu rows", drawn.train.rows());
        line = text;
      } catch (const std::exception& error) {
        ++failed;
        line = error.what();
      }
      const std::lock_guard<std::mutex> guard(talking);
      const std::string what =
          whole || labels[i].is_null() ? title(order) : labels[i]["title"].get<std::string>();
      std::printf("%03zu %-45s %s, %.1f s\n", i, what.c_str(), line.c_str(),
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
      std::fflush(stdout);
    }
  };
  std::vector<std::thread> pool;
  for (int t = 0; t < options.threads; ++t) pool.emplace_back(work);
  for (auto& thread : pool) thread.join();

  Json sealed;
  sealed["seed"] = options.seed;
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (!labels[i].is_null()) sealed["cases"][numbered("%03d", i)] = labels[i];

  // Leave one out: jobs that take the true cause out of the catalogue, hidden among others that do not.
  std::vector<std::string> jobs;
  Random random(options.seed ^ 0xabcdefull);
  std::vector<std::pair<std::string, Json>> drawn_jobs;
  for (std::size_t i = 0; i < labels.size() && options.leave_one_out; ++i) {
    if (labels[i].is_null() || orders[i].effects.size() != 1 || orders[i].half != Half::clean) continue;
    const std::string truth = orders[i].effects.front();
    const auto harmless = [&](const std::string& id) {
      return id != truth && (!labels[i].contains("likeness") || labels[i]["likeness"].value(id, 0.0) < 0.5);
    };
    const auto bystanders = [&] {
      std::vector<std::string> ids;
      for (const auto& id : all_ids(orders[i].axis))
        if (harmless(id)) ids.push_back(id);
      random.shuffle(ids);
      ids.resize(std::min<std::size_t>(2, ids.size()));
      return ids;
    };
    auto without = bystanders();
    without.push_back(truth);
    random.shuffle(without);
    drawn_jobs.push_back({numbered("%03d", i), without});
    if (random.chance(0.25)) drawn_jobs.push_back({numbered("%03d", i), bystanders()});
  }
  random.shuffle(drawn_jobs);
  std::ofstream list(options.out + "/jobs.txt");
  for (const auto& entry : sealed["cases"].items()) list << entry.key() << " " << entry.key() << "\n";
  for (std::size_t i = 0; i < drawn_jobs.size(); ++i) {
    list << numbered("L%04d", i) << " " << drawn_jobs[i].first;
    for (const auto& id : drawn_jobs[i].second) list << " " << id.get<std::string>();
    list << "\n";
    sealed["leave_one_out"][numbered("L%04d", i)] = {{"case", drawn_jobs[i].first},
                                                     {"without", drawn_jobs[i].second}};
  }
  std::ofstream file(options.out + "/sealed/labels.json");
  file << sealed.dump(1) << "\n";
  if (!file || !list) {
    std::cerr << "gap_benchmark_generate: cannot write to " << options.out << "\n";
    return 1;
  }
  return failed ? 1 : 0;
}
