// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// monitor_campaign [<plants> [<hours>]]: an hour, or so many, of so many hotends, beds and motors, 10 000 of each if nothing is
// said, on all cores, none of which has a fault; then an hour of a hundredth of them with each fault. Prints both as tables, and
// fails when more than one false alarm comes in a thousand hours.

#include "monitor_campaign.hpp"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <thread>

namespace {

/// Calls a function with 0 .. count - 1, on all cores.
void in_parallel(long count, const std::function<void(long)>& call) {
  std::atomic<long> next{0};
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
    threads.emplace_back([&] {
      for (long at = next++; at < count; at = next++) call(at);
    });
  for (std::thread& thread : threads) thread.join();
}

typedef std::function<campaign::Found(std::uint32_t, bool)> Run;

/// False alarms of healthy plants, an hour each.
long false_alarms(const char* title, long plants, double hours, const Run& run) {
  std::atomic<long> alarms{0};
  in_parallel(plants, [&](long plant) {
    if (run(static_cast<std::uint32_t>(plant + 1), false).is_early) ++alarms;
  });
  const double thousands = 0.001 * hours * static_cast<double>(plants);
  // The rate below which 95 of 100 such campaigns would have shown more alarms: exact for none, close for few.
  const double seen = static_cast<double>(alarms.load());
  std::printf("| %s | %.0f | %ld | %.3f | %.3f |\n", title, 1000.0 * thousands, alarms.load(),
              seen / thousands, (seen + 3.0 + 1.65 * std::sqrt(seen)) / thousands);
  return alarms.load();
}

/// `30 s (80 %)` for the median of those that noticed and how many of all did; how many had alarmed before.
void print_times(std::vector<double> times_s, long early) {
  const std::size_t all = times_s.size();
  times_s.erase(std::remove_if(times_s.begin(), times_s.end(), [](double s) { return s < 0.0; }),
                times_s.end());
  if (times_s.empty()) {
    std::printf(" never");
  } else {
    std::sort(times_s.begin(), times_s.end());
    std::printf(" %.0f s (%.0f %%)", times_s[times_s.size() / 2],
                100.0 * static_cast<double>(times_s.size()) / static_cast<double>(all));
  }
  if (early > 0)
    std::printf(", %.0f %% before", 100.0 * static_cast<double>(early) / static_cast<double>(all));
  std::printf(" |");
}

void detections(const char* title, long plants, std::uint8_t truth, const Run& run) {
  std::vector<campaign::Found> runs(static_cast<std::size_t>(plants));
  in_parallel(plants, [&](long plant) {
    const std::uint32_t seed = static_cast<std::uint32_t>(plant + 1);
    campaign::Found& found = runs[static_cast<std::size_t>(plant)];
    found = run(seed, false);
    found.suspects = run(seed, true).suspects;  // named while it cools
  });
  std::vector<double> monitor, usual[3];
  long found = 0, right = 0, alone = 0, early = 0, usual_early[3] = {0, 0, 0};
  for (const campaign::Found& one : runs) {
    monitor.push_back(one.monitor_s);
    early += one.is_early ? 1 : 0;
    for (int i = 0; i < 3; ++i) {
      usual[i].push_back(one.usual_s[i]);
      usual_early[i] += one.is_usual_early[i] ? 1 : 0;
    }
    if (one.monitor_s < 0.0) continue;
    ++found;
    if ((one.suspects & truth) != 0) ++right;
    if (one.suspects == truth) ++alone;
  }
  std::printf("| %s |", title);
  print_times(monitor, early);
  std::printf(" %.0f %% | %.0f %% |",
              100.0 * static_cast<double>(right) / static_cast<double>(std::max(1l, found)),
              100.0 * static_cast<double>(alone) / static_cast<double>(std::max(1l, found)));
  for (int i = 0; i < 3; ++i) print_times(usual[i], usual_early[i]);
  std::printf("\n");
}

}  // namespace

int main(int argument_count, char** arguments) {
  const long plants = argument_count > 1 ? std::strtol(arguments[1], nullptr, 10) : 10000;
  const double hours = argument_count > 2 ? std::strtod(arguments[2], nullptr) : 1.0;
  if (plants < 1 || !(hours > 0.0)) {
    std::fprintf(stderr, "usage: monitor_campaign [<plants> [<hours of each>]]\n");
    return 2;
  }
  const double hour_s = 3600.0, fault_s = 1200.0;
  std::printf(
      "| healthy | hours | false alarms | in 1000 h | with 95 %%, below |\n|---|---:|---:|---:|---:|\n");
  const long alarms =
      false_alarms("hotend", plants, hours,
                   [&](std::uint32_t seed, bool) { return campaign::run_hotend(seed, hours * hour_s); }) +
      false_alarms("bed", plants, hours,
                   [&](std::uint32_t seed, bool) { return campaign::run_bed(seed, hours * hour_s); }) +
      false_alarms("motor", plants, hours,
                   [&](std::uint32_t seed, bool) { return campaign::run_motor(seed, hours * hour_s); });

  const long few = std::max(20l, plants / 100);
  std::printf(
      "\n| fault, %ld plants | watch | in the set | alone | runaway | kelvin sum | rate |\n|---|---|---:|---:|---|---|---|\n",
      few);
  for (int i = 1; i <= static_cast<int>(printer::Fault::heater_stays_on); ++i) {
    const printer::Fault fault = static_cast<printer::Fault>(i);
    for (const bool is_bed : {false, true})
      detections((std::string(is_bed ? "bed: " : "hotend: ") + printer::name(fault)).c_str(), few,
                 campaign::truth(fault), [&](std::uint32_t seed, bool is_cutting) {
                   return is_bed ? campaign::run_bed(seed, hour_s, fault, fault_s, is_cutting)
                                 : campaign::run_hotend(seed, hour_s, fault, fault_s, is_cutting);
                 });
  }
  std::printf(
      "\n| fault, %ld plants | monitor | in the set | alone | trip at 90 degC | I2t | rate |\n|---|---|---:|---:|---|---|---|\n",
      few);
  for (int i = 1; i <= static_cast<int>(campaign::MotorFault::friction_grown); ++i) {
    const campaign::MotorFault fault = static_cast<campaign::MotorFault>(i);
    detections((std::string("motor: ") + campaign::name(fault)).c_str(), few, campaign::truth(fault),
               [&](std::uint32_t seed, bool is_cutting) {
                 return campaign::run_motor(seed, hour_s, fault, fault_s, is_cutting);
               });
  }
  return static_cast<double>(alarms) <= std::max(1.0, 3.0 * hours * static_cast<double>(plants) / 1000.0) ? 0
                                                                                                          : 1;
}
