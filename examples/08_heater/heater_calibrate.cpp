// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  which constants and bounds does the monitor need for a heater of which one has a log?
// Model:    the balance of heat that the monitor judges (HeatBalanceConfig), fitted to the log by least squares of the reading; bounds as
//           wide as the log's own blocks need.
// Usage:    heater_calibrate <log.csv> <full_W> <highest_C> [<air_error_K>] > constants.hpp
#include "recording.hpp"

namespace {

constexpr double longest_step_s = 8.0;  // a longer one is a gap: the monitor starts anew after it
constexpr double lowest_C = 2.0;        // as in guard_of(): a printer's room

/// The integrals of one block.
struct Block {
  double heat_J = 0.0, later_J = 0.0;  // as it arrives, and as it would a lag later
  double change_K = 0.0, second_K = 0.0, second_later_K = 0.0, rise_Ks = 0.0, fan_Ks = 0.0, length_s = 0.0;
  bool is_judged = true;
};

/// What is fitted.
struct Constants {
  double capacity, second, second_s, lag_s, loss, fan;  // J/K, J/K, s, s, W/K, W/K
};

std::vector<Block> blocks_of(const recorded::Recording& log, double full_W, double block_s,
                             double air_error_K, const Constants& body) {
  const double lag_s = body.lag_s, second_s = body.second > 0.0 ? body.second_s : 0.0;
  std::vector<Block> blocks;
  Block block;
  double late_W = 0.0, later_W = 0.0, second_C = std::nan(""), second_later_K = 0.0, settled_s = 0.0,
         start_C = 0.0, second_start_C = 0.0, later_start_K = 0.0, last_C = std::nan("");
  bool is_begun = false;
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    const recorded::Row &before = log.rows[i - 1], &row = log.rows[i];
    const double dt_s = row.t_s - before.t_s;
    if (dt_s > longest_step_s || !(row.measured_C > lowest_C)) {
      is_begun = false;
      continue;
    }
    if (!is_begun) {
      is_begun = true;
      second_C = start_C = second_start_C = row.measured_C;
      second_later_K = later_start_K = late_W = later_W = 0.0;
      const bool is_cold = std::fabs(row.measured_C - row.air_C) < 5.0;
      // As the monitor waits: until a wrong start is off by no more than a quarter of what wrong air does.
      const double tolerable_W = std::max(0.25 * body.loss * air_error_K, 0.01 * full_W);
      const auto settles_s = [&](double seconds, double error_W) {
        return seconds * std::max(0.0, std::log(error_W / tolerable_W));
      };
      settled_s = row.t_s + settles_s(lag_s, full_W);
      if (!is_cold && second_s > 0.0)
        settled_s =
            std::max(settled_s, row.t_s + settles_s(second_s, body.second / second_s * 2.0 *
                                                                  std::fabs(row.measured_C - row.air_C)));
      block = Block();
      last_C = row.measured_C;
      continue;
    }
    const double share = dt_s / (lag_s + dt_s),
                 second_share = second_s > 0.0 ? dt_s / (second_s + dt_s) : 0.0;
    late_W += share * (before.duty * full_W - late_W);
    later_W += share * (late_W - later_W);
    const double middle_C = 0.5 * (last_C + row.measured_C), into_K = second_share * (middle_C - second_C);
    second_C += into_K;
    second_later_K += second_share * (second_C - second_start_C - second_later_K);
    block.heat_J += dt_s * late_W;
    block.later_J += dt_s * later_W;
    block.rise_Ks += dt_s * (middle_C - row.air_C);
    block.fan_Ks += dt_s * (middle_C - row.air_C) * before.fan;
    block.length_s += dt_s;
    last_C = row.measured_C;
    if (block.length_s < block_s) continue;
    block.change_K = row.measured_C - start_C;
    block.second_K = second_C - second_start_C;
    block.second_later_K = second_later_K - later_start_K;
    block.is_judged = row.t_s > settled_s;
    blocks.push_back(block);
    block = Block();
    start_C = row.measured_C;
    second_start_C = second_C;
    later_start_K = second_later_K;
  }
  return blocks;
}

/// Mean square, K^2, by which a body with these constants misses the log when it is told the power alone.
double missed_K2(const recorded::Recording& log, double full_W, const Constants& body) {
  double sum = 0.0, late_W = 0.0, body_C = std::nan(""), second_C = body_C;
  long rows = 0;
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    const recorded::Row &before = log.rows[i - 1], &row = log.rows[i];
    const double dt_s = row.t_s - before.t_s;
    if (!(row.measured_C > lowest_C)) continue;
    if (!(body_C > lowest_C) || dt_s > longest_step_s) {
      body_C = second_C = row.measured_C;
      late_W = 0.0;
      continue;
    }
    late_W += dt_s / (body.lag_s + dt_s) * (before.duty * full_W - late_W);
    const double warmer_K = dt_s / (body.second_s + dt_s) * (body_C - second_C);
    second_C += warmer_K;
    const double lost_W = (body.loss + body.fan * before.fan) * (body_C - row.air_C);
    body_C += (dt_s * (late_W - lost_W) - body.second * warmer_K) / (body.capacity + 0.5 * body.loss * dt_s);
    sum += (body_C - row.measured_C) * (body_C - row.measured_C);
    ++rows;
  }
  return sum / static_cast<double>(rows);
}

/// Goes along each constant in turn, by a factor that shrinks, while that helps.
/// @param slowest_s  of the second mass: the monitor waits for it after a warm start
Constants fitted(const recorded::Recording& log, double full_W, double slowest_s, Constants body) {
  double Constants::*const all[] = {&Constants::capacity, &Constants::loss,     &Constants::lag_s,
                                    &Constants::second,   &Constants::second_s, &Constants::fan};
  double least_K2 = missed_K2(log, full_W, body);
  for (double step = 0.5; step > 0.002;) {
    bool is_better = false;
    for (double Constants::*const constant : all)
      for (const double factor : {1.0 + step, 1.0 / (1.0 + step)}) {
        Constants tried = body;
        tried.*constant *= factor;
        const double tried_K2 = missed_K2(log, full_W, tried);
        if (!(tried_K2 < least_K2) || tried.second_s > slowest_s) continue;
        least_K2 = tried_K2;
        body = tried;
        is_better = true;
      }
    if (!is_better) step *= 0.5;
  }
  return body;
}

/// Bounds that are usual, before they are widened: fractions.
struct Bounds {
  double heat = 0.04, capacity = 0.05, second = 0.10, lag = 0.10, loss = 0.05, fan = 0.10;
};

/// What the constants leave of a block, J.
double residual_J(const Block& block, const Constants& body) {
  return block.heat_J - body.capacity * block.change_K - body.second * block.second_K -
         body.loss * block.rise_Ks - body.fan * block.fan_Ks;
}

/// Noise of the heat of one second, J: a log says less of the power than the firmware knows, so that the residuals of blocks jump by
/// more than readings with this noise explain.
double heat_noise_J(const std::vector<Block>& blocks, const Constants& body, double noise_K, double block_s) {
  std::vector<double> jumps_J;
  for (std::size_t i = 1; i < blocks.size(); ++i)
    if (blocks[i].is_judged && blocks[i - 1].is_judged && blocks[i].heat_J > 0.0)
      jumps_J.push_back(std::fabs(residual_J(blocks[i], body) - residual_J(blocks[i - 1], body)));
  if (jumps_J.empty()) return 0.0;
  // 0.6745 of a normal deviation is the median. In the difference of two residuals the reading between them counts twice.
  const double jump_J = recorded::median(jumps_J) / 0.6745, read_J = body.capacity * noise_K;
  return std::sqrt(std::max(0.0, 0.5 * (jump_J * jump_J - 6.0 * read_J * read_J)) / block_s);
}

/// The noise of a heater's log.
struct Noise {
  double reading_K, heat_J;  ///< Standard deviations: of a reading, and of the heat of one second.
};

/// The highest of both sums of the monitor's test, in nats, with all bounds times a factor.
double evidence(const std::vector<Block>& blocks, const Constants& body, double factor, double air_error_K,
                const Noise& noise, double block_s, double limit_nat) {
  const Bounds usual;
  double more = 0.0, less = 0.0, highest = 0.0;
  const double reading_J = std::sqrt(2.0) * body.capacity * noise.reading_K,
               heat_J = noise.heat_J * std::sqrt(block_s),
               nat_per_J = 0.5 / (reading_J / std::sqrt(limit_nat) + heat_J);
  for (const Block& block : blocks) {
    if (!block.is_judged) continue;
    const double second = body.second * block.second_K, second_later = body.second * block.second_later_K;
    const double allowed_J =
        factor * (usual.heat * std::fabs(block.heat_J) + usual.lag * std::fabs(block.heat_J - block.later_J) +
                  usual.capacity * std::fabs(body.capacity * block.change_K) +
                  usual.second * (std::fabs(second) + std::fabs(second - second_later)) +
                  usual.loss * std::fabs(body.loss * block.rise_Ks) +
                  usual.fan * std::fabs(body.fan * block.fan_Ks)) +
        (body.loss + (block.fan_Ks > 0.0 ? body.fan : 0.0)) * air_error_K * block.length_s + 0.25 * heat_J;
    const auto add = [&](double& sum, double beyond_J) {
      const double step = std::max(-0.5 * limit_nat, std::min(0.5 * limit_nat, beyond_J * nat_per_J));
      sum = std::max(0.0, sum + step);
      highest = std::max(highest, sum);
    };
    add(more, residual_J(block, body) - allowed_J);
    add(less, -residual_J(block, body) - allowed_J);
  }
  return highest;
}

int calibrate(const std::string& file, double full_W, double highest_C, double air_error_K) {
  const recorded::Recording log = recorded::read(file);
  std::vector<double> steps_s, changes_K, bends_K;
  for (std::size_t i = 2; i < log.rows.size(); ++i) {
    const recorded::Row &a = log.rows[i - 2], &b = log.rows[i - 1], &c = log.rows[i];
    if (!(a.measured_C > lowest_C && b.measured_C > lowest_C && c.measured_C > lowest_C)) continue;
    steps_s.push_back(c.t_s - b.t_s);
    if (c.measured_C != b.measured_C) changes_K.push_back(std::fabs(c.measured_C - b.measured_C));
    bends_K.push_back(std::fabs(c.measured_C - 2.0 * b.measured_C + a.measured_C));
  }
  if (changes_K.empty())
    throw std::runtime_error(file + ": motor_C never moves: expected a heater's reading");
  std::sort(changes_K.begin(), changes_K.end());
  const double row_s = recorded::median(steps_s), resolution_K = changes_K[changes_K.size() / 10];
  // 0.6745 of a normal deviation is the median; a second difference has the square root of 6.
  Noise noise = {std::max(recorded::median(bends_K) / (0.6745 * std::sqrt(6.0)), 0.5 * resolution_K), 0.0};
  // A guess: it forgets a change within some minutes, and a hold needs a share of the power.
  double hottest_K = 1.0, mean_duty = 0.0;
  for (const recorded::Row& row : log.rows) {
    if (row.measured_C > lowest_C) hottest_K = std::max(hottest_K, row.measured_C - row.air_C);
    mean_duty += row.duty / static_cast<double>(log.rows.size());
  }
  if (!(mean_duty > 0.0))
    throw std::runtime_error(file + ": power_param is 0 throughout: expected a heater's power");
  const double loss = mean_duty * full_W / hottest_K, fan = log.has_fan ? 0.2 * loss : 0.0;
  const double slowest_s = 250.0 * row_s;
  const Constants alone =
      fitted(log, full_W, slowest_s, {200.0 * loss, 0.0, slowest_s, 3.0 * row_s, loss, fan});
  Constants body = fitted(log, full_W, slowest_s,
                          {0.7 * alone.capacity, 0.3 * alone.capacity, 0.2 * slowest_s, 0.5 * alone.lag_s,
                           alone.loss, alone.fan});
  // A second mass has to be worth it.
  if (missed_K2(log, full_W, body) > 0.8 * missed_K2(log, full_W, alone)) body = alone;
  if (body.lag_s < 0.2 * row_s) body.lag_s = 0.2 * row_s;
  // Ten rows or seconds, half of the lag; a second mass must settle within the monitor's 255 blocks.
  const double block_s = std::min(40.0, std::max({std::min(10.0 * row_s, 10.0), 5.0 * row_s, 0.5 * body.lag_s,
                                                  body.second > 0.0 ? body.second_s / 50.0 : 0.0, 1.0}));
  const std::vector<Block> blocks = blocks_of(log, full_W, block_s, air_error_K, body);
  noise.heat_J = heat_noise_J(blocks, body, noise.reading_K, block_s);
  const double limit_nat = std::log(1000.0 * 3600.0 * 2.0 / block_s);
  double factor = 1.0;
  // Half of the evidence that alarms is left for what this log does not show.
  while (evidence(blocks, body, factor, air_error_K, noise, block_s, limit_nat) > 0.5 * limit_nat &&
         factor < 5.0)
    factor *= 1.1;
  const Bounds usual;
  const auto bound = [&](double fraction) { return std::min(0.5, factor * fraction); };
  std::printf(
      "// Fitted to %s by heater_calibrate: %zu blocks of %.0f s; by the power alone it is missed by %.1f K; bounds %.1f times the usual ones.\n#pragma once\n",
      file.c_str(), blocks.size(), block_s, std::sqrt(missed_K2(log, full_W, body)), factor);
  std::printf(
      "struct Calibrated {\n"
      "  static constexpr thermopower::MonitorConfig monitor() { return {%.1f, 1000.0, true}; }\n"
      "  static constexpr thermopower::HeatBalanceConfig heat_balance() {\n"
      "    return {%.6g, %.3f,        // W at full duty\n"
      "            %.6g, %.3f,        // J/K that follow the thermistor\n"
      "            %.6g, %.1f, %.3f,  // J/K that follow later, s\n"
      "            %.2f, %.3f,        // s until heat shows\n"
      "            %.6g, %.3f,        // W/K to the air\n"
      "            %.6g, %.3f,        // W/K of the full fan\n"
      "            %.2f,              // K that the air may be off\n"
      "            %.4f, %.4f,        // K of noise and resolution\n"
      "            %.4f};             // J of noise of a second's heat\n"
      "  }\n"
      "  static constexpr float highest_C() { return %.1ff; }\n"
      "};\n",
      block_s, full_W, bound(usual.heat), body.capacity, bound(usual.capacity), body.second, body.second_s,
      bound(usual.second), body.lag_s, bound(usual.lag), body.loss, bound(usual.loss), body.fan,
      bound(usual.fan), air_error_K, noise.reading_K, resolution_K, noise.heat_J, highest_C);
  return 0;
}

}  // namespace

int main(int argument_count, char** arguments) {
  const double full_W = argument_count > 2 ? std::strtod(arguments[2], nullptr) : 0.0;
  const double highest_C = argument_count > 3 ? std::strtod(arguments[3], nullptr) : 0.0;
  const double air_error_K = argument_count > 4 ? std::strtod(arguments[4], nullptr) : 3.0;
  if (!(full_W > 0.0 && highest_C > lowest_C && air_error_K >= 0.0)) {
    std::fprintf(
        stderr,
        "usage: heater_calibrate <log.csv> <W at full duty> <highest degC> [<K that the air may be off>]\n");
    return 2;
  }
  try {
    return calibrate(arguments[1], full_W, highest_C, air_error_K);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heater_calibrate: %s\n", error.what());
    return 3;
  }
}
