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
using figures::Panel;

struct Experiment {
  const char* title;
  bool is_large;                   // BGM5208-200-12
  double power;                    // 0: cooling
  std::vector<double> measured_C;  // Tables 5.1 to 5.3, one value a minute
};

const std::vector<Experiment> experiments = {
    {"5.1  BGM2606-90T, cooling", false, 0, {54.0, 47.1, 43.2, 40.9, 39.2, 38.0}},
    {"5.2  BGM5208-200-12, cooling", true, 0, {47.0, 45.8, 44.7, 43.4, 42.1, 41.1}},
    {"5.3  BGM5208-200-12, POWER 150", true, 150, {25.6, 27.9, 29.7, 31.1, 32.4, 33.6}},
    {"5.4  BGM5208-200-12, POWER 200", true, 200, {32.9, 34.8, 37.0, 39.0, 40.9, 42.5}},
    {"5.5  BGM5208-200-12, POWER 250", true, 250, {30.2, 32.6, 36.6, 40.1, 43.2, 46.1}},
    {"5.6  BGM2606-90T, POWER 150", false, 150, {26.8, 38.7, 48.1, 55.7, 61.3}},
    {"5.7  BGM2606-90T, POWER 200", false, 200, {30.5, 46.7, 58.0, 69.6}},
    {"5.8  BGM2606-90T, POWER 250", false, 250, {33.6, 53.5, 68.2}}};

constexpr double air_C = 26.0, supply_V = 13.0, step_s = 1.0;

// A controller's thermal model, run as the controller runs it.
template <class Motor>
std::vector<double> believed(const Experiment& experiment, std::size_t seconds) {
  typename Motor::Current current(Motor::current());
  typename Motor::Thermal thermal(Motor::thermal(), static_cast<float>(experiment.measured_C[0]));
  std::vector<double> all;
  for (std::size_t i = 0; i <= seconds; ++i) {
    all.push_back(static_cast<double>(thermal.hottest_C()));
    const auto drawn = current.at_power(static_cast<float>(experiment.power), static_cast<float>(supply_V),
                                        thermal.hottest_C());
    thermal.step({drawn.winding_power_W, drawn.v_rms_V, {static_cast<float>(air_C), 0.0f}},
                 static_cast<float>(step_s));
  }
  return all;
}

std::vector<double> simulated(const Experiment& experiment, std::size_t seconds) {
  const auto axis = experiment.is_large ? thesis_yaw<double>() : thesis_roll<double>();
  MotorBody<double> body(axis.body, {experiment.measured_C[0], experiment.measured_C[0]});
  std::vector<double> all;
  for (std::size_t i = 0; i <= seconds; ++i) {
    all.push_back(body.state().body_C);
    body.step(axis.drive.at(experiment.power, supply_V, body.state().winding_C, body.state().body_C).heat_W,
              {air_C, 0.0}, step_s);
  }
  return all;
}

double worst(const std::vector<double>& curve, const Experiment& experiment) {
  double largest = 0.0;
  for (std::size_t i = 0; i < experiment.measured_C.size(); ++i)
    largest = std::fmax(largest, std::fabs(curve[60 * i] - experiment.measured_C[i]));
  return largest;
}

}  // namespace

void chapter5::temperatures(const std::string& directory) {
  std::printf("Temperatures (Tables 5.1 to 5.3): largest difference from the thesis's measurements, K\n");
  std::printf("  %-34s %8s %12s %12s\n", "figure", "rig", "programmed", "corrected");
  std::vector<Panel> panels;
  for (const Experiment& experiment : experiments) {
    const std::size_t seconds = 60 * (experiment.measured_C.size() - 1);
    const std::vector<double> rig = simulated(experiment, seconds);
    const std::vector<double> programmed =
        experiment.is_large ? believed<motors::Bgm5208_200_12::AsProgrammed>(experiment, seconds)
                            : believed<motors::Bgm2606_90t::AsProgrammed>(experiment, seconds);
    const std::vector<double> corrected = experiment.is_large
                                              ? believed<motors::Bgm5208_200_12>(experiment, seconds)
                                              : believed<motors::Bgm2606_90t>(experiment, seconds);
    std::printf("  %-34s %8.1f %12.1f %12.1f\n", experiment.title, worst(rig, experiment),
                worst(programmed, experiment), worst(corrected, experiment));
    std::vector<double> minutes, marks;
    for (std::size_t i = 0; i <= seconds; ++i) minutes.push_back(static_cast<double>(i) / 60.0);
    for (std::size_t i = 0; i < experiment.measured_C.size(); ++i) marks.push_back(static_cast<double>(i));
    panels.push_back({experiment.title,
                      "time / min",
                      "motor / degC",
                      {{"rig", Palette::truth, Mark::line, minutes, rig},
                       {"model as programmed", Palette::thesis, Mark::dashed, minutes, programmed},
                       {"corrected model", Palette::ours, Mark::dashed, minutes, corrected},
                       {"measured in the thesis", "#c92a2a", Mark::dots, marks, experiment.measured_C}}});
  }
  figures::write_small_multiples(directory + "/figures_5_1_to_5_8.svg",
                                 "Cooling and heating (figures 5.1 to 5.8)", panels, 3);
}
