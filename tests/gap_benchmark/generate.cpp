// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Draws recordings whose cause is known, and seals the causes in a file of their own.
//   gap_benchmark_generate --out DIR --seed S [--only effect] [--count N] [--quick]

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>
#include <thread>

#include "axis_draw.hpp"
#include "bench_draw.hpp"

using namespace gap_benchmark;

int main(int argc, char** argv) {
  std::string out, only;
  unsigned long long seed = 1;
  int count = 0;
  bool quick = false;
  int threads = 2;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const auto value = [&] { return i + 1 < argc ? std::string(argv[++i]) : std::string(); };
    if (option == "--out") out = value();
    else if (option == "--seed") seed = std::stoull(value());
    else if (option == "--only") only = value();
    else if (option == "--count") count = std::stoi(value());
    else if (option == "--threads") threads = std::stoi(value());
    else if (option == "--quick") quick = true;
    else { std::cerr << "unknown option " << option << "\n"; return 2; }
  }
  if (out.empty()) { std::cerr << "usage: gap_benchmark_generate --out DIR --seed S [--only effect] [--count N] [--quick]\n"; return 2; }

  std::vector<CaseOrder> orders;
  for (const auto& e : bench_effects())
    for (int i = 0; i < 3; ++i) {
      CaseOrder o; o.effects = {e.id}; o.thesis = e.id == "supply_power_heating"; o.thorough = !quick;
      if (only.empty() || only == e.id) orders.push_back(o);
    }
  for (const auto& u : bench_unknowns()) {
    CaseOrder o; o.unknown = static_cast<int>(u.first); o.thorough = true;
    if (only.empty() || only == "unknown") orders.push_back(o);
  }
  for (int i = 0; i < 8; ++i) { CaseOrder o; o.thesis = i % 4 == 3; if (only.empty() || only == "none") orders.push_back(o); }
  if (count) orders.clear();
  for (const auto& e : axis_effects())
    for (int i = 0; i < 3; ++i) {
      CaseOrder o; o.axis = true; o.effects = {e.id}; o.thorough = !quick;
      if (only.empty() || only == e.id) orders.push_back(o);
    }
  for (const auto& u : axis_unknowns()) {
    CaseOrder o; o.axis = true; o.unknown = static_cast<int>(u.first); o.thorough = !quick;
    if (only.empty() || only == "unknown") orders.push_back(o);
  }
  for (int i = 0; i < 4; ++i) { CaseOrder o; o.axis = true; if (only.empty() || only == "none") orders.push_back(o); }


  nlohmann::ordered_json labels;
  std::mutex lock;
  std::atomic<std::size_t> next{0};
  std::vector<nlohmann::ordered_json> made(orders.size());
  const auto work = [&] {
    for (std::size_t i; (i = next++) < orders.size();) {
      Random random(seed * 1000003ull + i);
      const auto t0 = std::chrono::steady_clock::now();
      std::string name = orders[i].effects.empty() ? (orders[i].unknown ? "unknown " + std::to_string(orders[i].unknown) : "none") : orders[i].effects[0];
      try {
        DrawnCase drawn = orders[i].axis ? draw_axis_case(orders[i], random) : draw_bench_case(orders[i], random);
        char id[16]; std::snprintf(id, sizeof id, "%03d", static_cast<int>(i));
        const std::string dir = out + "/cases/" + id;
        std::filesystem::create_directories(dir);
        drawn.train.write(dir + "/train.csv");
        drawn.heldout.write(dir + "/heldout.csv");
        std::ofstream(dir + "/model.json") << drawn.model.dump(1) << "\n";
        const auto& a = drawn.assessment;
        drawn.label["visible"] = {{"train", a.visible_train}, {"heldout", a.visible_heldout}};
        drawn.label["confusability"] = a.confusability;
        drawn.label["confused_with"] = a.confused_with;
        drawn.label["left_over"] = a.left_over;
        for (const auto& o : a.others) drawn.label["others"][o.first] = o.second;
        made[i] = drawn.label;
        std::lock_guard<std::mutex> guard(lock);
        std::printf("%s %-26s rows %6zu visible %7.1f %7.1f conf %.3f (%s) left %.1f  %.1f s\n", id, name.c_str(), drawn.train.rows(), a.visible_train, a.visible_heldout,
                    a.confusability, a.confused_with.c_str(), a.left_over, std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count());
        std::fflush(stdout);
      } catch (const std::exception& error) {
        std::lock_guard<std::mutex> guard(lock);
        std::printf("--- %s: %s\n", name.c_str(), error.what());
      }
    }
  };
  std::vector<std::thread> pool;
  for (int t = 0; t < threads; ++t) pool.emplace_back(work);
  for (auto& t : pool) t.join();
  for (std::size_t i = 0; i < made.size(); ++i) { char id[16]; std::snprintf(id, sizeof id, "%03d", static_cast<int>(i)); if (!made[i].is_null()) labels[id] = made[i]; }
  std::filesystem::create_directories(out + "/sealed");
  std::ofstream(out + "/sealed/labels.json") << labels.dump(1) << "\n";
}
