// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/limits.hpp>
#include <thermopower/design/remaining.hpp>

#include <cassert>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::design {

/// Which input the limits lack for a model, in a sentence that names the field; nothing where all are there.
inline std::optional<std::string> lacking_for(const DiagnosedGap& gap, const Limits& limits) {
  const Model& model = gap.model;
  if (model.own)
    return std::string("the model is a plant of its own; expected an axis, or a motor that warms up");
  const auto given = [&](const char* column) {
    if (limits.varied(column) != nullptr) return true;
    for (const auto& one : limits.hold)
      if (one.first == column) return true;
    return false;
  };
  if (gap.watched.empty()) return std::string("the report judged no signal; expected one to record");
  bool axis = false, bench = false;
  for (const Watched& one : gap.watched) {
    const bool moves = one.signal == Signal::angle_deg || one.signal == Signal::rate_dps;
    (moves ? axis : bench) = true;
  }
  if (axis) {
    const bool drive = given("drive_A"), voltage = given("voltage_V"),
               target = given("target_deg") || given("target_dps");
    const char* const wanted = model.axis && model.axis->voltage_driven() ? "voltage_V" : "drive_A";
    if (model.has_servo() ? !drive && !voltage && !target : !given(wanted))
      return std::string("vary.") + (model.has_servo() ? "target_deg" : wanted) +
             " is missing; the axis of the model is driven by it";
  }
  if (bench) {
    if (model.has_thermal() && !given("ambient_C"))
      return std::string("hold.ambient_C is missing; the model's body loses heat to the air");
    if (!given("power_param") && !given("current_A") && !given("heat_W") && !given("drive_A"))
      return std::string(
          "vary.power_param is missing; the model's body is heated by it (or by current_A or heat_W)");
    if (model.has_thermal() && given("motor_C"))
      return std::string("motor_C is an input here, and the model simulates it; expected it in start");
  }
  return std::nullopt;
}

/// Limits of which one is raised.
struct RaisedLimit {
  Limits limits;      ///< with the one that is raised
  std::string field;  ///< of the limits
  double to = 0.0;    ///< its new value
};

/// Each limit raised by one and a half, two and four, the smallest raise first. An input that never comes to rest may come nearer to it.
inline std::vector<RaisedLimit> raised_limits(const Limits& limits) {
  std::vector<RaisedLimit> all;
  for (const double factor : {1.5, 2.0, 4.0}) {
    RaisedLimit longer{limits, "duration_s", factor * limits.duration_s};
    longer.limits.duration_s = longer.to;
    if (!longer.limits.validate()) all.push_back(longer);
    for (std::size_t i = 0; i < limits.vary.size(); ++i) {
      const VariedInput& input = limits.vary[i];
      if (input.column == "power_param" && input.to >= 255.0) continue;
      RaisedLimit wider{limits, "vary." + input.column + ".to", factor * input.to};
      if (input.column == "power_param") wider.to = std::min(wider.to, 255.0);
      VariedInput& raised = wider.limits.vary[i];
      raised.to = wider.to;
      if (input.from < 0.0) raised.from = factor * input.from;
      if (!wider.limits.validate() && wider.to > input.to) all.push_back(wider);
      if (input.from > 0.0) {
        RaisedLimit lower{limits, "vary." + input.column + ".from",
                          std::max(0.0, input.to - factor * (input.to - input.from))};
        lower.limits.vary[i].from = lower.to;
        all.push_back(lower);
      }
    }
    const auto raise = [&](const char* field, Bounds Limits::*bounds, double from) {
      const Bounds& old = limits.*bounds;
      if (!old.any()) return;
      RaisedLimit wider{limits, field, from + factor * (old.high - from)};
      (wider.limits.*bounds).high = wider.to;
      if (std::isfinite(old.low)) (wider.limits.*bounds).low = from - factor * (from - old.low);
      if (!std::isfinite(wider.to)) wider.to = (wider.limits.*bounds).low;
      assert(!((wider.limits.*bounds).low > (wider.limits.*bounds).high));
      all.push_back(wider);
    };
    raise("angle_deg", &Limits::angle_deg, Limits::value_or(limits.start, "angle_deg", 0.0));
    raise("rate_dps", &Limits::rate_dps, 0.0);
    raise("current_A", &Limits::current_A, 0.0);
    raise("temperature_C", &Limits::temperature_C,
          Limits::value_or(limits.start, "motor_C", Limits::value_or(limits.hold, "ambient_C", 25.0)));
  }
  return all;
}

}  // namespace thermopower::design
