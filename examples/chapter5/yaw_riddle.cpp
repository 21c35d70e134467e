// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "chapter5.hpp"
#include "runs.hpp"
#include "small_multiples.hpp"

namespace {

using namespace thermopower;
using namespace thermopower::simulation;

struct Candidate {
  const char* name;
  std::function<void(RigConfig&, Scenario&)> change;
};

// Factor that a camera's heading reads too large when its Euler pitch is near the nadir. Put in by hand, as
// the units are: the rig's axes are not coupled by geometry, so it shows what such a factor does, not that
// the board has it.
double near_nadir(double pitch_deg) { return 1.0 / std::cos(pitch_deg / deg_per_rad); }

const std::vector<Candidate> candidates = {
    {"a healthy board", [](RigConfig&, Scenario&) {}},
    {"telemetry in units of the gyro (x 2.78)",
     [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = 0.06103701895 / (360.0 / 16384.0); }},
    {"16-bit turns read as 14-bit (x 4)", [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = 4.0; }},
    {"turns for radians (x 2 pi)", [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = 2.0 * M_PI; }},
    {"electrical for mechanical angle (x 7)", [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = 7.0; }},
    {"radians for degrees (x 57.3)", [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = deg_per_rad; }},
    {"target off by a whole turn", [](RigConfig& c, Scenario&) { c.faults[2].sent_offset_deg = 360.0; }},
    {"camera pitched 45 deg, Euler yaw",
     [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = near_nadir(45.0); }},
    {"camera pitched 60 deg, Euler yaw",
     [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = near_nadir(60.0); }},
    {"camera pitched 80 deg, Euler yaw",
     [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = near_nadir(80.0); }},
    {"camera pitched 85 deg, Euler yaw",
     [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = near_nadir(85.0); }},
    {"camera pitched 86.8 deg, Euler yaw",
     [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = near_nadir(86.8); }},
    {"camera pitched 88 deg, Euler yaw",
     [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = near_nadir(88.0); }},
    {"camera pitched 89 deg, Euler yaw",
     [](RigConfig& c, Scenario&) { c.faults[2].sent_gain = near_nadir(89.0); }},
    {"frame IMU missing: field astray", [](RigConfig& c, Scenario&) { c.faults[2].field_slip = 7.0; }},
    {"board's own loop sees x 18", [](RigConfig& c, Scenario&) { c.faults[2].seen_gain = 18.0; }},
    {"P 20 times too large", [](RigConfig& c, Scenario&) { c.axes[2].pid.share_per_deg *= 20.0; }},
    {"P falls from 36 to 2, little integral",
     [](RigConfig& c, Scenario&) { c.axes[2].pid.share_per_deg_s *= 0.05; }},
    {"the same, cable four times as stiff",
     [](RigConfig& c, Scenario&) {
       c.axes[2].pid.share_per_deg_s *= 0.05, c.axes[2].mechanics.cable_Nm_per_rad *= 4.0;
     }},
    {"lever: ten times the yaw inertia",
     [](RigConfig& c, Scenario&) { c.axes[2].mechanics.inertia_kg_m2 *= 10.0; }},
};

}  // namespace

void chapter5::yaw_riddle(const std::string& directory) {
  std::printf(
      "\nThe yaw riddle (section 5.2): yaw errors read 18 times larger than those of roll and pitch\n"
      "  (a) against roll and pitch, as the thesis says it; (b) against the yaw of a healthy board in the "
      "same run\n");
  std::printf("  %-40s %9s %9s %9s %6s %6s %11s\n", "explanation", "read/deg", "true/deg", "at rest", "(a)",
              "(b)", "mean POWER");
  std::vector<figures::Panel> panels;
  double healthy = 0.0;
  for (const Candidate& candidate : candidates) {
    RigConfig config = RigConfig::thesis();
    Scenario scenario = moving_then_disturbed();
    candidate.change(config, scenario);
    ThesisGimbal gimbal = thesis_gimbal();
    double read_square = 0.0, other_square = 0.0, true_square = 0.0, rest_square = 0.0, power = 0.0;
    long count = 0, rest_count = 0;
    std::vector<double> t_s, scaled, powers;
    run_rig(config, scenario, gimbal, [&](const RigSample& sample) {
      if (sample.t_s < scenario.settle_s) return;
      const double read = static_cast<double>(wrap_deg(sample.telemetry.error_deg(2))),
                   truth = sample.rig.error_deg(2);
      ++count;
      read_square += read * read;
      for (const std::uint8_t other : {std::uint8_t(0), std::uint8_t(1)}) {
        const double error = static_cast<double>(wrap_deg(sample.telemetry.error_deg(other)));
        other_square += 0.5 * error * error;
      }
      true_square += truth * truth;
      power += sample.command.power[2];
      if (sample.t_s > 82.0) rest_square += read * read, ++rest_count;
      t_s.push_back(sample.t_s), scaled.push_back(std::fmin(250.0 * std::fabs(read), 255.0)),
          powers.push_back(sample.command.power[2]);
    });
    const double n = static_cast<double>(count), read = std::sqrt(read_square / n);
    if (panels.empty()) healthy = read;
    std::printf("  %-40s %9.3f %9.3f %9.3f %6.1f %6.1f %11.0f\n", candidate.name, read,
                std::sqrt(true_square / n), std::sqrt(rest_square / static_cast<double>(rest_count)),
                read / std::sqrt(other_square / n), read / healthy, power / n);
    figures::Panel panel = {
        candidate.name, "time / s", "POWER; error x 250 per deg", {}, 0.0, 260.0, 0.0, 0.0, 0.0};
    panel.series = {{"yaw error as read, scaled and cropped", figures::Palette::constant,
                     figures::Mark::dashed, t_s, scaled},
                    {"POWER", figures::Palette::power, figures::Mark::line, t_s, powers}};
    panels.push_back(panel);
  }
  figures::write_small_multiples(directory + "/yaw_riddle.svg",
                                 "The yaw riddle: figure 5.16 under each explanation", panels, 3);
}
