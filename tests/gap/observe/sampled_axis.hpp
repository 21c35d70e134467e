// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace test {

/// An axis with equations of its own under a loop of 1 kHz, in steps of 0.1 ms.
class SampledAxis {
public:
  /// What the simulation does not know.
  enum class Effect { none, friction, cogging };

  /// @param set_each         steps of the loop after which the command is set anew
  /// @param angle_noise_deg  standard deviation of the angle's noise
  SampledAxis(Effect effect, double length_s, std::uint64_t seed, int set_each = 1,
              double angle_noise_deg = 0.03) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::normal_distribution<double> normal;
    struct Tone {
      double radps, phase, size_A;
    };
    std::array<Tone, 10> tones{};
    for (Tone& tone : tones)  // 0.05 to 2 Hz
      tone = {6.2832 * 0.05 * std::pow(40.0, uniform(random)), 6.2832 * uniform(random),
              0.1 * (0.5 + uniform(random))};
    constexpr double loop_s = 1e-3;
    constexpr int inner = 10;
    double rad = 0.0, radps = 0.0, command_A = 0.0;
    for (int step = 0; step * loop_s < length_s; ++step) {
      if (step % set_each == 0) {
        command_A = 0.0;
        for (const Tone& tone : tones)
          command_A += tone.size_A * std::sin(tone.radps * step * loop_s + tone.phase);
      }
      t_s_.push_back(step * loop_s);
      drive_A_.push_back(command_A);
      angle_deg_.push_back(57.29578 * rad + angle_noise_deg * normal(random));
      rate_dps_.push_back(57.29578 * radps + 0.2 * normal(random));
      for (int i = 0; i < inner; ++i) {
        double torque_Nm = 0.09 * command_A - 0.002 * radps;
        if (effect == Effect::friction) torque_Nm -= 0.006 * std::tanh(radps / 0.002);
        if (effect == Effect::cogging) torque_Nm -= 0.01 * std::sin(14.0 * rad + 0.3);
        radps += torque_Nm / 0.002 * loop_s / inner;
        rad += radps * loop_s / inner;
      }
    }
  }

  /// The simulation of it, without the effect.
  static thermopower::gap::Model model() {
    thermopower::gap::Model model;
    model.name = "axis under a fast loop";
    model.axis = thermopower::gap::RigidAxisModel{0.002, 0.002, 0.09};
    return model;
  }

  /// What a log keeps of it. @param steps  of the loop, of which one is logged
  thermopower::gap::Recording logged_each(int steps) const {
    thermopower::gap::Recording recording;
    recording.name = "logged each " + std::to_string(steps);
    const auto kept = [&](const std::vector<double>& values) {
      const auto each = static_cast<std::size_t>(steps);
      Eigen::VectorXd result(static_cast<Eigen::Index>((values.size() + each - 1) / each));
      for (std::size_t i = 0; i < values.size(); i += each)
        result[static_cast<Eigen::Index>(i / each)] = values[i];
      return result;
    };
    recording.t_s = kept(t_s_);
    recording.set("drive_A", kept(drive_A_));
    recording.set("angle_deg", kept(angle_deg_));
    recording.set("rate_dps", kept(rate_dps_));
    return recording;
  }

private:
  std::vector<double> t_s_, drive_A_, angle_deg_, rate_dps_;
};

/// With white noise added to one of its columns.
inline thermopower::gap::Recording with_noise(thermopower::gap::Recording recording, const char* column,
                                              double sd, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, sd);
  Eigen::VectorXd values = recording.column(column);
  for (double& value : values) value += normal(random);
  recording.set(column, values);
  return recording;
}

/// With one of its columns behind a filter of the first order.
inline thermopower::gap::Recording filtered(thermopower::gap::Recording recording, const char* column,
                                            double time_constant_s) {
  Eigen::VectorXd values = recording.column(column);
  for (Eigen::Index i = 1; i < values.size(); ++i)
    values[i] =
        values[i - 1] + (1.0 - std::exp(-(recording.t_s[i] - recording.t_s[i - 1]) / time_constant_s)) *
                            (values[i] - values[i - 1]);
  recording.set(column, values);
  return recording;
}

}  // namespace test
