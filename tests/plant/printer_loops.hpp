// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>
#include <random>
#include <utility>
#include <vector>

/// @file printer_loops.hpp
/// A heated body under the loops that printers have, stepped apart from the library: the loops at their period, the body in small
/// steps in between. The equations are those that the documentation of Klipper ("Configuration reference", `control`) and of
/// Marlin ("Temperature", PID) describe.

namespace printer {

enum class Loop { klipper, marlin, bang_bang };

struct Settings {
  Loop loop = Loop::klipper;
  double p = 20.0, i = 0.4, d = 60.0;   // of 255 parts
  double most = 1.0, smooth_s = 1.0;    // largest duty, and Klipper's smoothing
  double range_K = 10.0, band_K = 1.0;  // Marlin's range, half the band of bang-bang
  double every_s = 0.3;
};

/// A controller as firmware runs it: `duty(reading, target)` each period.
class Controller {
public:
  Controller(const Settings& set, double first_C) : set_(set), last_C_(first_C) {}

  double duty(double reading_C, double target_C) {
    const double e = target_C - reading_C, fall = last_C_ - reading_C;
    last_C_ = reading_C;
    double out = 0.0;
    switch (set_.loop) {
      case Loop::bang_bang:
        if (e > 0.0 ? e >= set_.band_K : -e >= set_.band_K) on_ = e > 0.0;
        out = on_ ? set_.most : 0.0;
        break;
      case Loop::klipper: {
        speed_ = set_.every_s >= set_.smooth_s ? -fall / set_.every_s
                                               : speed_ + (-fall - speed_ * set_.every_s) / set_.smooth_s;
        const double full = set_.i > 0.0 ? 255.0 * set_.most / set_.i : 0.0;
        const double tried = std::fmin(std::fmax(sum_ + e * set_.every_s, 0.0), full);
        const double co = (set_.p * e + set_.i * tried - set_.d * speed_) / 255.0;
        out = std::fmin(std::fmax(co, 0.0), set_.most);
        if (co == out) sum_ = tried;
        break;
      }
      case Loop::marlin:
        if (std::fabs(e) > set_.range_K) {
          sum_ = work_d_ = 0.0;
          out = e > 0.0 ? set_.most : 0.0;
        } else {
          sum_ = std::fmin(std::fmax(sum_ + e, 0.0), 255.0 * set_.most / (set_.i * set_.every_s));
          work_d_ = 0.95 * work_d_ + 0.05 * set_.d / set_.every_s * fall;
          out = std::fmin(std::fmax(set_.p * e + set_.i * set_.every_s * sum_ + work_d_, 0.0) / 255.0,
                          set_.most);
        }
        break;
    }
    return target_C > 0.0 ? out : 0.0;
  }

private:
  Settings set_;
  double last_C_, speed_ = 0.0, sum_ = 0.0, work_d_ = 0.0;
  bool on_ = true;
};

struct Body {
  double J_per_K = 90.0, W_per_K = 0.9, ohm = 2.88,
         per_K = 0.0;     // per_K: of the heater's resistance, from 25 degC on
  double lag_s = 0.0;     // of its thermometer
  double fan_gain = 0.0;  // of the conductance, times the speed of the air
  double supply_V = 24.0, air_C = 24.0;
};

/// What a log has, a row a second.
struct Log {
  std::vector<double> t_s, target_C, shown_C, duty, airspeed_mps;  // duty: mean until the next row
};

/// Targets of `hold_s` seconds each; the air moves at 3 m/s in every second of them where `fan` says so.
inline Log heated(const Body& body, const Settings& set, const std::vector<double>& targets_C, double hold_s,
                  double noise_K = 0.0, unsigned seed = 1, bool fan = false) {
  constexpr int steps = 300;  // of a controller's period
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  Log log;
  double node_C = body.air_C, read_C = body.air_C, duty = 0.0;
  Controller controller(set, body.air_C);
  const double end_s = hold_s * static_cast<double>(targets_C.size()), h = set.every_s / steps;
  double next_row_s = 0.0, duty_s = 0.0, since_s = 0.0;
  for (long k = 0;; ++k) {
    const double at_s = static_cast<double>(k) * set.every_s;
    if (at_s >= end_s) break;
    for (int n = 0; n < steps; ++n) {
      const double now_s = at_s + n * h;
      const auto hold = std::min(static_cast<std::size_t>(now_s / hold_s + 1e-9), targets_C.size() - 1);
      const double air_mps = fan && hold % 2 == 1 ? 3.0 : 0.0;
      if (now_s >= next_row_s - 1e-9) {
        if (!log.duty.empty()) log.duty.back() = duty_s / since_s;
        log.t_s.push_back(next_row_s);
        log.target_C.push_back(targets_C[hold]);
        log.shown_C.push_back(read_C + noise_K * normal(random));
        log.airspeed_mps.push_back(air_mps);
        log.duty.push_back(duty);
        next_row_s += 1.0;
        duty_s = since_s = 0.0;
      }
      if (n == 0) duty = controller.duty(read_C + noise_K * normal(random), targets_C[hold]);
      duty_s += duty * h;
      since_s += h;
      const double watts =
          duty * body.supply_V * body.supply_V / (body.ohm * (1.0 + body.per_K * (node_C - 25.0)));
      const double loses = body.W_per_K * (1.0 + body.fan_gain * air_mps);
      // One step of the linear body, exact for a heat that stays.
      const double settles_C = body.air_C + watts / loses, keeps = std::exp(-loses * h / body.J_per_K);
      const double before_C = node_C;
      node_C = settles_C + (node_C - settles_C) * keeps;
      read_C = body.lag_s > 0.0 ? read_C + (0.5 * (before_C + node_C) - read_C) * h / body.lag_s : node_C;
    }
  }
  return log;
}

}  // namespace printer
