// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include <thermopower/desktop.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

#include "chapter5.hpp"
#include "small_multiples.hpp"

namespace {

using namespace thermopower;
using namespace thermopower::simulation;
using figures::Mark;
using figures::Palette;

// A demand that does not depend on the error: what the protection test switches on.
struct FixedDemand {
  struct Config {
    std::uint8_t power;
    static Config standard() noexcept { return {255}; }
    ConfigError validate() const noexcept { return ConfigError::none; }
  };
  explicit FixedDemand(const Config& config) noexcept : power_(config.power) {}
  std::uint8_t step(float) noexcept { return power_; }

private:
  std::uint8_t power_;
};

struct Experiment {
  const char* title;
  std::uint8_t power;
  double believed_C;               // Table 5.4, calculated at the start
  std::vector<double> measured_C;  // one value a minute
};

const std::vector<Experiment> experiments = {
    {"5.9  POWER 150 (9.97 V)", 150, 35.0, {34.6, 43.9, 51.1, 56.3, 57.2, 57.4}},
    {"5.10  POWER 200 (11.5 V)", 200, 34.8, {34.4, 49.3, 53.7, 54.1, 54.5, 55.0}},
    {"5.11  POWER 250 (12.9 V)", 250, 32.9, {33.0, 48.9, 54.0, 54.2, 54.5, 55.0}}};

}  // namespace

void chapter5::protection(const std::string& directory) {
  using Axis =
      AxisController<motors::Bgm2606_90t::AsProgrammed, FixedDemand, SafetyLimiter<PerCycle>, NoGain>;
  std::printf(
      "\nOver-temperature protection (Table 5.4), BGM2606-90T, limit 60 degC, program of the thesis at 30.4 "
      "ms\n");
  std::printf("  %-26s %14s %14s %14s %16s\n", "figure", "hottest body", "after 5 min", "believed then",
              "thesis measured");
  std::vector<figures::Panel> panels;
  for (const Experiment& experiment : experiments) {
    Axis::Config config = Axis::Config::standard();
    config.power_law.power = experiment.power;
    Axis controller(config);
    controller.start(static_cast<float>(experiment.believed_C));
    const auto axis = thesis_roll<double>();
    MotorBody<double> body(axis.body, {experiment.measured_C[0], experiment.measured_C[0]});
    const double cycle_s = 0.0304;
    std::vector<double> minutes, body_C, believed_C, power;
    double hottest_C = -1e9;
    for (double t_s = 0.0; t_s < 300.0; t_s += cycle_s) {
      const auto& decided = controller.step({0.0f, 13.0f, 26.0f, LimitReason::none},
                                            t_s > 0.0 ? static_cast<float>(cycle_s) : 0.0f);
      minutes.push_back(t_s / 60.0);
      body_C.push_back(body.state().body_C);
      believed_C.push_back(static_cast<double>(decided.motor_C));
      power.push_back(decided.power);
      hottest_C = std::fmax(hottest_C, body.state().body_C);
      body.step(axis.drive.at(decided.power, 13.0, body.state().winding_C, body.state().body_C).heat_W,
                {26.0, 0.0}, cycle_s);
    }
    std::printf("  %-26s %14.1f %14.1f %14.1f %16.1f\n", experiment.title, hottest_C, body_C.back(),
                believed_C.back(), experiment.measured_C.back());
    figures::Panel temperatures = {
        experiment.title, "time / min", "motor / degC", {}, 30.0, 63.0, 60.0, 0.0, 0.0};
    temperatures.series = {
        {"rig", Palette::truth, Mark::line, minutes, body_C},
        {"believed by the program", Palette::thesis, Mark::dashed, minutes, believed_C},
        {"measured in the thesis", "#c92a2a", Mark::dots, {0, 1, 2, 3, 4, 5}, experiment.measured_C}};
    panels.push_back(temperatures);
    figures::Panel powers = {"POWER granted", "time / min", "POWER", {}, 0.0, 260.0, 0.0, 0.0, 0.0};
    powers.series = {{"POWER", Palette::ours, Mark::line, minutes, power}};
    panels.push_back(powers);
  }
  figures::write_small_multiples(directory + "/figures_5_9_to_5_11.svg",
                                 "Over-temperature protection (figures 5.9 to 5.11)", panels, 2);
}
