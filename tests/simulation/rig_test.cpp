// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/simulation/rig_ours.hpp>
#include <thermopower/simulation/rig_policies.hpp>
#include <thermopower/simulation/scenarios.hpp>

#include <cmath>

#include "../catch.hpp"

using namespace thermopower;
using namespace thermopower::simulation;

TEST_CASE("The same run twice gives the same figures") {
  const Scenario scenario = gusts(20.0);
  CorrectedGimbal one = corrected_gimbal(), two = corrected_gimbal();
  const RigMetrics first = run_rig(RigConfig::thesis(), scenario, one),
                   second = run_rig(RigConfig::thesis(), scenario, two);
  CHECK(first.energy_J == second.energy_J);
  CHECK(first.error_rms_deg() == second.error_rms_deg());
}

TEST_CASE("The energy of the axes is what the supply delivered") {
  for (const Scenario& scenario : {motion(30.0), weak_battery(30.0)}) {
    Rig rig(RigConfig::thesis(), scenario);
    rig.command(std::array<std::uint8_t, 3>{120, 90, 200}, std::array<std::uint8_t, 3>{12, 150, 15});
    while (rig.time_s() < 30.0) rig.cycle();
    const double axes_J = rig.axis_energy_J(0) + rig.axis_energy_J(1) + rig.axis_energy_J(2);
    CHECK(axes_J == Approx(rig.battery().state().energy_J).epsilon(0.002));
  }
}

TEST_CASE("A command waits until the board parses, at most 8 ms") {
  Rig rig(RigConfig::thesis(), rest(1.0));
  rig.cycle();
  const auto before = rig.power(0);
  rig.command(std::array<std::uint8_t, 3>{200, 200, 200}, std::array<std::uint8_t, 3>{5, 5, 5});
  for (int i = 0; i < 9; ++i) {
    CHECK(rig.power(0) == before);
    rig.cycle();
  }
  rig.cycle();
  CHECK(rig.power(0) == 200);
}

TEST_CASE("Telemetry has the resolution of the wire") {
  Scenario scenario = motion(10.0);
  scenario.axes[1].target_deg = 33.3;
  Rig rig(RigConfig::thesis(), scenario);
  rig.command(std::array<std::uint8_t, 3>{60, 60, 60}, std::array<std::uint8_t, 3>{10, 150, 20});
  while (rig.time_s() < 5.0) rig.cycle();
  const RigTelemetry seen = rig.telemetry();
  for (std::uint8_t i = 0; i < 3; ++i)
    CHECK(std::fabs(static_cast<double>(seen.error_deg(i)) - rig.error_deg(i)) <= 360.0 / 16384.0);
  CHECK(seen.target_deg(1) == Approx(33.3).margin(0.012));
  CHECK(seen.battery_V() == Approx(13.0f));
  CHECK(seen.motor_power(1) == 60);
}

TEST_CASE("Without power the camera goes where the weight takes it; with power it stays") {
  const Scenario scenario = rest(20.0);
  ConstantPower none({0, 0, 0}, {10, 150, 20}), some = constant_power();
  CHECK(run_rig(RigConfig::thesis(), scenario, none).axes[0].error_peak_deg > 20.0);
  CHECK(run_rig(RigConfig::thesis(), scenario, some).axes[0].error_peak_deg < 0.05);
}

TEST_CASE("A camera pushed across 180 degrees comes back the short way") {
  Scenario scenario = rest(30.0);
  scenario.axes[2].target_deg = 170.0;
  scenario.axes[2].pushes.push_back({5.0, 0.3, 0.30});
  ConstantPower some = constant_power();
  Rig rig(RigConfig::thesis(), scenario);
  rig.command(some.command.power, some.command.p_gain);
  double farthest = 0.0;
  while (rig.time_s() < 30.0) {
    rig.cycle();
    farthest = std::fmax(farthest, rig.plant(2).angle_deg());
  }
  CHECK(farthest > 190.0);
  CHECK(std::fabs(rig.error_deg(2)) < 0.1);
  CHECK(std::fabs(static_cast<double>(wrap_deg(rig.telemetry().error_deg(2)))) < 0.1);
}

TEST_CASE("The board's cycle is short enough: half of it gives the same run") {
  RigConfig coarse = RigConfig::thesis(), fine = coarse;
  fine.board_cycle_s *= 0.5;
  fine.cycles_per_parse *= 2;
  fine.cycles_per_control *= 2;
  ConstantPower one = constant_power(), two = constant_power();
  const RigMetrics a = run_rig(coarse, gusts(30.0), one), b = run_rig(fine, gusts(30.0), two);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(a.axes[i].error_rms_deg == Approx(b.axes[i].error_rms_deg).epsilon(0.03));
    CHECK(a.axes[i].energy_J == Approx(b.axes[i].energy_J).epsilon(1e-3));
  }
}

TEST_CASE("Blur follows eq 2.1 to 2.3") {
  const Optics optics = {50.0, 5.5e-6, 0.016, 0.005};
  CHECK(optics.sampling_m() == Approx(0.0171875));
  CHECK(optics.blur_px(optics.sharp_mps()) == Approx(0.5));
  CHECK(optics.blur_of_rate_px(1.0) == Approx(M_PI / 180.0 * 0.005 * 0.016 / 5.5e-6));
}

TEST_CASE("Our law points better for less energy than constant power and the thesis's program") {
  // A draw that neither its tuning nor the documentation's tables use.
  const std::vector<Scenario> scenarios = standard_scenarios(30.0, 50);
  for (const Scenario& scenario : {scenarios[1], scenarios[2], scenarios[5]}) {
    INFO(scenario.name);
    const float warm_C = static_cast<float>(scenario.air_C + 3.0);
    AdaptiveGimbal ours({warm_C, warm_C, warm_C}, {}, static_cast<float>(scenario.air_C));
    ConstantPower constant = constant_power();
    ThesisGimbal thesis = thesis_gimbal();
    const RigMetrics own = run_rig(RigConfig::thesis(), scenario, ours);
    for (const RigMetrics& other :
         {run_rig(RigConfig::thesis(), scenario, constant), run_rig(RigConfig::thesis(), scenario, thesis)}) {
      CHECK(own.energy_J < other.energy_J);
      CHECK(own.error_rms_deg() < other.error_rms_deg());
      CHECK(own.error_peak_deg() < other.error_peak_deg());
      CHECK(own.blur_rms_px() < other.blur_rms_px());
    }
    CHECK(own.over_limit_s() == 0.0);
  }
}

TEST_CASE(
    "Our law is at most 10 % worse than constant power with the same stiff gain, for at most half its energy") {
  // Draws that neither its tuning nor the documentation's tables use.
  for (const std::uint64_t draw : {50u, 51u})
    for (const Scenario& scenario : standard_scenarios(60.0, draw)) {
      INFO(scenario.name << ", draw " << draw);
      std::array<float, 3> started_C;
      for (std::size_t i = 0; i < 3; ++i) {
        const double winding_C = scenario.axes[i].winding_C;
        started_C[i] = static_cast<float>((std::isnan(winding_C) ? scenario.air_C : winding_C) + 3.0);
      }
      AdaptiveGimbal ours(started_C, {}, static_cast<float>(scenario.air_C));
      ConstantPower constant = stiff_constant_power();
      const RigMetrics own = run_rig(RigConfig::thesis(), scenario, ours),
                       other = run_rig(RigConfig::thesis(), scenario, constant);
      // At rest both stand still: half of what telemetry can tell apart is no difference.
      const double half_a_count_deg = 0.5 * 360.0 / 16384.0;
      CHECK(own.error_rms_deg() < std::fmax(1.10 * other.error_rms_deg(), half_a_count_deg));
      CHECK(own.energy_J < 0.5 * other.energy_J);
      CHECK(own.over_limit_s() == 0.0);
    }
}
