// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a motor is asked for full power for half an hour and bears a tenth of it. What does it get?
// Model:    a winding and a body, written out here (8 and 80 J/K, 1 and 0.2 W/K, copper), limits 110 and 60 degC, air
//           25 degC, 60 W at full power. Once with a step at the threshold, as a thermal switch does it: off at 60 degC, on
//           again at 55; once with the certified limiter, told every constant to 5 %.
// Notation: POWER 1 to 255; a jump is a change by more than 25 counts from one tenth of a second to the next.
//
//     derating derating.svg       draws the picture in docs/figures
#include <thermopower/thermopower.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "small_multiples.hpp"

namespace {

namespace tp = thermopower;

constexpr double step_s = 0.1, run_s = 1800.0, air_C = 25.0, limit_C = 60.0, again_C = 55.0;

struct Motor {
  double winding_C = air_C, body_C = air_C;
  void pass(int power) {
    const double heat_W = 60.0 * power / 255.0 / (1.0 + 0.0039 * (winding_C - 25.0));
    const double across_W = 1.0 * (winding_C - body_C);
    winding_C += step_s * (heat_W - across_W) / 8.0;
    body_C += step_s * (across_W - 0.2 * (body_C - air_C)) / 80.0;
  }
};

struct Switch {
  bool is_off = false;
  int step(const Motor& motor) {
    is_off = motor.body_C > (is_off ? again_C : limit_C);
    return is_off ? 1 : 255;
  }
};

class Derating {
public:
  Derating() : limiter_(config()) { limiter_.start(static_cast<float>(air_C), static_cast<float>(air_C)); }
  int step(const Motor&) {
    return limiter_.step({255, 12.0f, static_cast<float>(air_C)}, static_cast<float>(step_s)).power;
  }
  bool is_valid() const { return limiter_.validate() == tp::ConfigError::none; }

private:
  typedef tp::CertifiedLimiter<> Limiter;
  static Limiter::Config config() {
    Limiter::Config config = Limiter::Config::standard();
    config.network = {
        tp::Bounds::around(8.0f, 0.05f), tp::Bounds::around(80.0f, 0.05f), 0.95f, 0.19f, 110.0f, 60.0f};
    config.use.heat = tp::HeatBounds::ohmic(12.0f, 0.02f, tp::Bounds::around(2.4f, 0.05f), {0.0038f, 0.0040f},
                                            25.0f, 0.0f, 110.0f, 9.0f);
    config.use.highest_air_C = 30.0f;
    config.use.hold_s = 0.2f;
    config.air_error_K = 1.0f;
    return config;
  }
  Limiter limiter_;
};

struct Run {
  std::vector<double> minutes, body_C, power;
  double hottest_C = 0.0, late_power = 0.0,
         swing = 0.0;  // `late_`: over the last 15 minutes; swing: most less least
  int jumps = 0;
};

template <class Policy>
Run run(Policy policy) {
  Run run;
  Motor motor;
  const int steps = static_cast<int>(run_s / step_s);
  int before = 255, most = 0, least = 255;
  for (int i = 0; i < steps; ++i) {
    const int power = policy.step(motor);
    run.jumps += i > 0 && std::abs(power - before) > 25 ? 1 : 0;
    before = power;
    if (i >= steps / 2) {
      run.late_power += power / (0.5 * steps);
      most = std::max(most, power), least = std::min(least, power);
    }
    motor.pass(power);
    run.hottest_C = std::fmax(run.hottest_C, motor.body_C);
    if (i % 20 == 0) {
      run.minutes.push_back(i * step_s / 60.0);
      run.body_C.push_back(motor.body_C);
      run.power.push_back(power);
    }
  }
  run.swing = most - least;
  return run;
}

}  // namespace

int main(int argc, char** argv) {
  if (!Derating().is_valid()) return std::fprintf(stderr, "derating: the bounds are refused\n"), 1;
  const Run by_switch = run(Switch()), by_derating = run(Derating());
  std::printf("Full demand for half an hour, limit of the body 60 degC\n  %-24s %10s %8s %22s %26s\n", "",
              "hottest/C", "jumps", "POWER, last 15 min", "its swing in that time");
  for (const auto& [name, one] : {std::pair<const char*, const Run&>("step at the threshold", by_switch),
                                  std::pair<const char*, const Run&>("certified limiter", by_derating)})
    std::printf("  %-24s %10.2f %8d %22.1f %26.0f\n", name, one.hottest_C, one.jumps, one.late_power,
                one.swing);
  if (argc > 1) {
    using namespace figures;
    const auto series = [&](const std::vector<double> Run::*what) {
      return std::vector<Series>{
          {"step at the threshold", Palette::constant, Mark::line, by_switch.minutes, by_switch.*what},
          {"certified limiter", Palette::ours, Mark::line, by_derating.minutes, by_derating.*what}};
    };
    try {
      write_small_multiples(
          argv[1], "Full demand for half an hour",
          {{"body", "time / min", "body / degC", series(&Run::body_C), 20.0, 65.0, limit_C, 0.0, 30.0},
           {"power", "time / min", "POWER", series(&Run::power), 0.0, 260.0, 0.0, 0.0, 30.0}},
          2);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "derating: %s\n", error.what());
      return 1;
    }
  }
  // What the picture is to show: no hunting, and the limit kept.
  return by_derating.jumps == 0 && by_derating.swing <= 1.0 && by_derating.hottest_C < limit_C ? 0 : 1;
}
