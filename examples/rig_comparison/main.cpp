// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  which way to choose POWER points the camera best for the least energy, and keeps every motor
// below its limit? Model:    the simulated rig of the thesis's gimbal, richer than what any of the
// controllers believes; energy at the supply. Notation: error is that of the line of sight (root of the sum
// of the axes' squares); blur by eq 2.1 to 2.3; body is the warmest
//           motor body, whose bracket bears 60 degC.
#include <thermopower/desktop.hpp>

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "small_multiples.hpp"

namespace {

using namespace thermopower;
using namespace thermopower::simulation;
using figures::Palette;

// What a run left behind, averaged over the draws.
struct Row {
  double energy_J = 0, rms_deg = 0, peak_deg = 0, blur_px = 0, blurred = 0, body_C = -1e9, winding_C = -1e9,
         over_s = 0, limiting_s = 0;
  std::vector<double> minutes, body_curve_C;  // of the first draw
};

struct Policy {
  const char* name;
  const char* colour;
  std::function<Row(const Scenario&)> run;
};

template <class Make>
Policy policy(const char* name, const char* colour, Make make) {
  return {name, colour, [make](const Scenario& scenario) {
            auto controller = make(scenario);
            Row row;
            long count = 0;
            const RigMetrics figures =
                run_rig(RigConfig::thesis(), scenario, controller, [&](const RigSample& sample) {
                  if (count++ % 30 != 0) return;
                  row.minutes.push_back(sample.t_s / 60.0);
                  double hottest_C = -1e9;
                  for (std::size_t i = 0; i < 3; ++i)
                    hottest_C = std::max(hottest_C, sample.rig.plant(i).temperatures().body_C);
                  row.body_curve_C.push_back(hottest_C);
                });
            row.energy_J = figures.energy_J, row.rms_deg = figures.error_rms_deg(),
            row.peak_deg = figures.error_peak_deg();
            row.blur_px = figures.blur_rms_px(), row.body_C = figures.peak_body_C(),
            row.winding_C = figures.peak_winding_C();
            for (const AxisMetrics& axis : figures.axes)
              row.blurred = std::max(row.blurred, axis.blurred_share);
            row.over_s = figures.over_limit_s(), row.limiting_s = figures.limiting_s();
            return row;
          }};
}

// What ours is made of; a part can be left out, to see what it is for.
AdaptiveTuning tuning;

void leave_out(const std::string& part) {
  if (part == "reserve") tuning.reserve_power = {1, 1, 1};
  if (part == "easing") tuning.ease_from_deg = 1000.0f;
  if (part == "stiffness") tuning.stiffness = 1.0f;
}

// Ours knows from a stored state and the time off how warm each motor is, to 3 K, and measures the air before it starts;
// the others assume what they assume.
AdaptiveGimbal ours(const Scenario& scenario) {
  std::array<float, 3> started_C;
  for (std::size_t i = 0; i < 3; ++i) {
    const double winding_C = scenario.axes[i].winding_C;
    started_C[i] = static_cast<float>((std::isnan(winding_C) ? scenario.air_C : winding_C) + 3.0);
  }
  return AdaptiveGimbal(started_C, tuning, static_cast<float>(scenario.air_C));
}

std::vector<Policy> policies() {
  return {policy("constant power", Palette::constant, [](const Scenario&) { return constant_power(); }),
          policy("constant, stiff", "#343a40", [](const Scenario&) { return stiff_constant_power(tuning); }),
          policy("thesis", Palette::thesis, [](const Scenario&) { return thesis_gimbal(); }),
          policy("corrected", Palette::corrected, [](const Scenario&) { return corrected_gimbal(); }),
          policy("ours, not told", "#66d9e8",
                 [](const Scenario&) {
                   return AdaptiveGimbal({60.0f, 60.0f, 60.0f}, tuning);
                 }),
          policy("ours", Palette::ours, ours)};
}

// Where one is not at least as good as another: in words.
void judge(const char* own_name, const Row& ours, const Row& other, const char* name) {
  const double count_deg = 360.0 / 16384.0;  // what telemetry can tell apart
  std::string worse;
  if (ours.energy_J > other.energy_J) worse += " energy";
  if (ours.rms_deg > other.rms_deg + count_deg) worse += " rms";
  if (ours.peak_deg > other.peak_deg + 2.0 * count_deg) worse += " peak";
  if (ours.blur_px > std::fmax(other.blur_px, 0.5)) worse += " blur";
  if (ours.over_s > other.over_s) worse += " over-limit";
  std::printf("  %-14s against %-16s energy %+6.1f %%, rms %+7.1f %%  %s%s\n", own_name, name,
              100.0 * (ours.energy_J / other.energy_J - 1.0),
              other.rms_deg > count_deg ? 100.0 * (ours.rms_deg / other.rms_deg - 1.0) : 0.0,
              worse.empty() ? "at least as good in everything" : "worse in:", worse.c_str());
}

Row average(const std::vector<Row>& rows) {
  Row mean = rows.front();
  const double share = 1.0 / static_cast<double>(rows.size());
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Row& row = rows[i];
    mean.energy_J += row.energy_J, mean.rms_deg += row.rms_deg, mean.blur_px += row.blur_px,
        mean.blurred += row.blurred;
    mean.limiting_s += row.limiting_s, mean.over_s = std::max(mean.over_s, row.over_s);
    mean.peak_deg = std::max(mean.peak_deg, row.peak_deg), mean.body_C = std::max(mean.body_C, row.body_C);
    mean.winding_C = std::max(mean.winding_C, row.winding_C);
  }
  mean.energy_J *= share, mean.rms_deg *= share, mean.blur_px *= share, mean.blurred *= share,
      mean.limiting_s *= share;
  return mean;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Compares ways to choose POWER on the simulated rig: a table on the terminal, pictures as SVG."};
  std::string directory = "rig_comparison";
  double duration_s = 300.0;
  unsigned draws = 3, first_draw = 0;
  std::string without;
  app.add_option("--out", directory, "Directory for the pictures; made when it is missing")
      ->capture_default_str();
  app.add_option("--duration", duration_s, "Length of each run in seconds")
      ->capture_default_str()
      ->check([](const std::string& text) {
        // CLI::Range takes nan for a number within.
        double value = 0.0;
        const bool fine = CLI::detail::lexical_cast(text, value) && value >= 20.0 && value <= 36000.0;
        return fine ? std::string() : "'" + text + "' is no number of seconds from 20 to 36000";
      });
  app.add_option("--draws", draws, "Runs of each scenario with other winds and pushes, averaged")
      ->capture_default_str()
      ->check(CLI::Range(1u, 1000u));
  app.add_option("--first-draw", first_draw, "The first of them; ours was tuned on 100 to 107")
      ->capture_default_str();
  app.add_option("--without", without, "Leaves a part of ours out")
      ->check(CLI::IsMember({"reserve", "easing", "stiffness"}));
  CLI11_PARSE(app, argc, argv);
  leave_out(without);
  try {
    std::filesystem::create_directories(directory);
    const std::vector<Policy> all = policies();
    std::vector<figures::Panel> trade, warmth;
    std::vector<std::vector<Scenario>> drawn;
    for (unsigned draw = 0; draw < draws; ++draw)
      drawn.push_back(standard_scenarios(duration_s, first_draw + draw));
    std::printf(
        "%u draws of %g s each; energy of all motors at the supply; limit of the bodies 60 degC, of the "
        "windings 120 degC\n",
        draws, duration_s);
    for (std::size_t index = 0; index < drawn.front().size(); ++index) {
      const std::string& name = drawn.front()[index].name;
      std::printf("\n%s\n  %-16s %9s %9s %9s %9s %9s %8s %9s %8s %9s\n", name.c_str(), "policy", "energy/J",
                  "rms/deg", "peak/deg", "blur/px", ">0.5 px", "body/C", "winding/C", "over/s", "limited/s");
      figures::Panel panel = {name, "energy / J", "error rms / deg", {}, 0.0, 0.0, 0.0, 0.0, 0.0};
      figures::Panel curves = {name, "time / min", "warmest body / degC", {}, 0.0, 0.0, 60.0, 0.0, 0.0};
      std::vector<Row> outcome;
      for (const Policy& one : all) {
        std::vector<Row> rows;
        for (const auto& scenarios : drawn) rows.push_back(one.run(scenarios[index]));
        outcome.push_back(average(rows));
        const Row& row = outcome.back();
        std::printf("  %-16s %9.1f %9.3f %9.2f %9.3f %8.1f%% %8.1f %9.1f %8.1f %9.1f\n", one.name,
                    row.energy_J, row.rms_deg, row.peak_deg, row.blur_px, 100.0 * row.blurred, row.body_C,
                    row.winding_C, row.over_s, row.limiting_s);
        panel.series.push_back({one.name, one.colour, figures::Mark::dots, {row.energy_J}, {row.rms_deg}});
        curves.series.push_back({one.name, one.colour, figures::Mark::line, row.minutes, row.body_curve_C});
      }
      for (std::size_t own : {all.size() - 1, all.size() - 2})
        for (std::size_t i = 0; i + 2 < all.size(); ++i)
          judge(all[own].name, outcome[own], outcome[i], all[i].name);
      for (const Row& row : outcome) {
        panel.x_to = std::fmax(panel.x_to, 1.08 * row.energy_J);
        panel.y_to = std::fmax(std::fmax(panel.y_to, 0.05), 1.1 * row.rms_deg);
      }
      trade.push_back(panel);
      warmth.push_back(curves);
    }
    figures::write_small_multiples(directory + "/error_and_energy.svg",
                                   "Pointing error against energy: lower left is better", trade, 3);
    figures::write_small_multiples(directory + "/temperatures.svg", "Warmest motor body, limit 60 degC",
                                   warmth, 3);
  } catch (const std::exception& error) {
    std::cerr << "rig_comparison: " << error.what() << '\n';
    return 3;
  }
}
