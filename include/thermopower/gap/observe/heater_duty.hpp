// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/data/splitting.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/heater_loop.hpp>
#include <thermopower/plant/samples.hpp>
#include <thermopower/plant/servo_loop.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thermopower::gap {

namespace engine {

/// When a reading turned that is highest or lowest at a row: where the lines through the rows before and after it meet, at most a row
/// away.
inline double turning_s(const Eigen::VectorXd& t_s, const Eigen::VectorXd& shown_C, const RunSpan& run,
                        Eigen::Index row) {
  constexpr Eigen::Index reach = 4;
  if (row - reach < run.begin || row + reach >= run.end) return t_s[row];
  const auto slope = [&](Eigen::Index from, Eigen::Index to) {
    return (shown_C[to] - shown_C[from]) / (t_s[to] - t_s[from]);
  };
  const double before = slope(row - reach, row - 1), after = slope(row + 1, row + reach);
  const double at_s =
      (shown_C[row + 1] - after * t_s[row + 1] - shown_C[row - 1] + before * t_s[row - 1]) / (before - after);
  return std::isfinite(at_s) ? std::clamp(at_s, t_s[row - 1], t_s[row + 1]) : t_s[row];
}

/// @brief Share of the time until the next row in which a two-point loop was on, row by row, as the readings of a log tell it.
///
/// It switched at a reading that its noise carried over an end of the band, and the log may not have that one. So a reading that turns
/// within the noise of an end is a switch, too.
inline Eigen::VectorXd two_point_duty(const plant::BangBangHeater& law, const Eigen::VectorXd& t_s,
                                      const Eigen::VectorXd& shown_C, const Eigen::VectorXd& target_C,
                                      const std::vector<RunSpan>& runs) {
  constexpr double noises = 4.0;  // by which the highest of some hundred samples errs
  const double noise_K = noises * plant::sample_noise(shown_C, runs);
  Eigen::VectorXd duty = Eigen::VectorXd::Zero(shown_C.size());
  for (const RunSpan& run : runs) {
    bool heats = shown_C[run.begin] < target_C[run.begin];
    std::vector<double> switches_s;
    Eigen::Index turn = run.begin;
    const bool heats_first = heats;
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      const auto beyond_K = [&](Eigen::Index at) {
        return (heats ? shown_C[at] - target_C[row] : target_C[row] - shown_C[at]) - law.max_delta_K;
      };
      if (beyond_K(row) > beyond_K(turn)) turn = row;
      const bool turned = beyond_K(turn) > -noise_K && beyond_K(row) < beyond_K(turn) - 2.0 * noise_K;
      if (beyond_K(row) < 0.0 && !turned) continue;
      double at_s = turned ? turning_s(t_s, shown_C, run, turn) : t_s[row];
      if (!turned && row > run.begin && beyond_K(row - 1) < 0.0) {
        const double part = beyond_K(row - 1) / (beyond_K(row - 1) - beyond_K(row));
        at_s = t_s[row - 1] + part * (t_s[row] - t_s[row - 1]) +
               0.5 * law.period_s;  // its next sample, on average
      }
      switches_s.push_back(switches_s.empty() ? at_s : std::max(at_s, switches_s.back()));
      heats = !heats;
      turn = row;
    }
    std::size_t next = 0;
    heats = heats_first;
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      const double to_s = row + 1 < run.end ? t_s[row + 1] : t_s[row] + law.period_s;
      double now_s = t_s[row], on_s = 0.0;
      for (; next < switches_s.size() && switches_s[next] < to_s; ++next) {
        const double at_s = std::max(now_s, switches_s[next]);
        on_s += heats ? at_s - now_s : 0.0;
        now_s = at_s;
        heats = !heats;
      }
      on_s += heats ? to_s - now_s : 0.0;
      if (target_C[row] > 0.0) duty[row] = law.max_power * on_s / (to_s - t_s[row]);
    }
  }
  return duty;
}

}  // namespace engine

/// @brief Gives a recording the duty that the model's heater loop makes of its `target_C` and its `motor_C`, as `heater_power`.
///
/// A controller acts on what its thermometer shows, and that is what was recorded: its duty then follows, whatever is wrong with the
/// body. The balances of a diagnosis take it, and the simulation where the model says so (Model::simulates_heater_loop()). Each row
/// gets the mean of the duties until the next row. Nothing changes where the duty is recorded, or the target or the temperature is not.
inline Recording with_heater_duty(const Model& model, Recording recording) {
  if (!model.has_heater() || recording.has("power_param") || recording.has(engine::heater_power_column) ||
      !recording.has("target_C") || !recording.has("motor_C") || recording.validate())
    return recording;
  const std::vector<RunSpan> runs = recording.spans();
  const auto filled = [&](const char* column, double otherwise) {
    if (!recording.has(column))
      return Eigen::VectorXd(Eigen::VectorXd::Constant(recording.rows(), otherwise));
    return plant::without_holes(recording.column(column), runs, otherwise);
  };
  const Eigen::VectorXd air_C = filled("ambient_C", missing), target_C = filled("target_C", 0.0),
                        supply_V = filled("supply_V", model.supply ? model.supply->nominal_V : missing);
  const Eigen::VectorXd shown_C = filled("motor_C", 0.0);
  if (const auto* two_point = std::get_if<plant::BangBangHeater>(&model.heater)) {
    recording.set(engine::heater_power_column,
                  plant::full_heater_power *
                      engine::two_point_duty(*two_point, recording.t_s, shown_C, target_C, runs));
    return recording;
  }
  Eigen::VectorXd power = Eigen::VectorXd::Constant(recording.rows(), missing);
  plant::HeaterLoop<double> loop(model.heater);
  for (const RunSpan& run : runs) {
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      if (row == run.begin)
        loop.start(shown_C[row], target_C[row],
                   plant::holding_duty(model, supply_V[row], shown_C[row], air_C[row]));
      const Eigen::Index next = std::min(row + 1, run.end - 1);
      const double from_s = recording.t_s[row] - recording.t_s[run.begin],
                   to_s =
                       next > row ? recording.t_s[next] - recording.t_s[run.begin] : from_s + loop.period_s();
      double duty_s = 0.0;
      const auto take_sample = [&](double at_s) {
        const double part = (at_s - from_s) / (to_s - from_s);
        loop.sample(shown_C[row] + part * (shown_C[next] - shown_C[row]), target_C[row]);
      };
      loop.interval(from_s, to_s, take_sample,
                    [&](double, double length_s) { duty_s += loop.duty() * length_s; });
      power[row] = plant::full_heater_power * duty_s / (to_s - from_s);
    }
  }
  recording.set(engine::heater_power_column, std::move(power));
  return recording;
}

/// Takes the last part of a recording away as held-out data, with the duty of the model's heater loop, whose memory goes on there.
inline std::pair<Recording, Recording> split(const Model& model, Recording recording,
                                             double held_out_fraction) {
  return split(with_heater_duty(model, std::move(recording)), held_out_fraction);
}

}  // namespace thermopower::gap
