// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "bolted_motor.hpp"

#include <thermopower/gap/diagnose.hpp>
#include <thermopower/plant/network_plant.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// A motor bolted to a frame: winding, stator, frame and mount, of which winding and frame have thermometers. What is
// recorded comes from equations of the test's own; the model and two recordings are all that the diagnosis sees.

namespace {

using namespace thermopower;

gap::Diagnosis judged(const plant::ThermalNetwork& model, const test::BoltedMotor& real) {
  gap::Options options;
  options.effects_at_once = 1;
  options.threads = 2;
  return gap::diagnose(plant::network_model(model, "motor on a frame"), {real.recorded(1)},
                       {real.recorded(2)}, options);
}

/// The causes that the diagnosis does not exclude: the one it names, and those it cannot tell from it.
std::vector<std::string> named(const gap::Diagnosis& diagnosis) {
  std::vector<std::string> list;
  for (const gap::Cause& one : diagnosis.cause) list.push_back(one.effect);
  for (const auto& other : diagnosis.alternatives)
    if (other.size() == 1) list.push_back(other.front());
  return list;
}

double parameter_of(const gap::Diagnosis& diagnosis, const std::string& name) {
  for (const gap::Cause& cause : diagnosis.cause)
    for (const gap::ParameterEstimate& one : cause.parameters)
      if (one.name == name) return one.value;
  return std::nan("");
}

}  // namespace

TEST_CASE("a motor on a frame that is as its network says has no gap") {
  const test::BoltedMotor real;
  const gap::Diagnosis diagnosis = judged(test::network_of(real), real);
  INFO(diagnosis.reason);
  CHECK(diagnosis.verdict == gap::Verdict::no_gap);
}

TEST_CASE("what a motor on a frame has and its network lacks is named, with its size") {
  struct Fault {
    const char* effect;
    const char* parameter;
    double value;
    test::BoltedMotor real;
  };
  std::vector<Fault> faults;
  const auto add = [&](const char* effect, const char* parameter, double value) -> test::BoltedMotor& {
    faults.push_back({effect, parameter, value, {}});
    return faults.back().real;
  };
  add("winding_to_frame_link", "W_per_K", 0.25).winding_to_frame_W_per_K = 0.25;
  add("frame_radiation", "emissive_area_m2", 0.09).frame_radiates_m2 = 0.09;
  add("frame_hidden_mass", "J_per_K", 900.0).behind_frame_J_per_K = 900.0;
  faults.back().real.behind_frame_W_per_K = 1.5;
  add("air_drift", "K_per_h", 8.0).air_drift_K_per_h = 8.0;
  add("air_bias", "bias_K", 4.0).air_bias_K = 4.0;
  add("stator_share_of_current_A", "share", 0.3).stator_share = 0.3;
  const std::size_t which = GENERATE(0, 1, 2, 3, 4, 5);
  const Fault& fault = faults[which];
  const gap::Diagnosis diagnosis = judged(test::network_of({}), fault.real);
  std::string text;
  for (const std::string& one : named(diagnosis)) text += one + " ";
  INFO(fault.effect << ": " << to_string(diagnosis.verdict) << ": " << text << diagnosis.reason);
  const std::vector<std::string> list = named(diagnosis);
  CHECK(std::find(list.begin(), list.end(), fault.effect) != list.end());
  CHECK_FALSE(diagnosis.where.empty());
  if (!list.empty() && list.front() == fault.effect)
    CHECK(parameter_of(diagnosis, fault.parameter) == Approx(fault.value).epsilon(0.25));
}
