// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "plants.hpp"
#include "../plant/gimbal_of_masses.hpp"

#include <thermopower/gap/diagnose.hpp>

#include <limits>
#include <string>
#include <vector>

// Three coupled joints, recorded from point masses that share no equation with the library, diagnosed by joint and effect.

namespace {

using namespace thermopower;

/// @param known  the model knows of the coupling, and that the masses are balanced
/// @param rows   of the recording that is learned from, at 100 Hz
/// @param judged  rows of the one that is held out
gap::Diagnosis diagnosed(const PointMassGimbal& drawn, const PointMassGimbal& real, bool known,
                         Eigen::Index rows, Eigen::Index judged) {
  gap::Model model = test::model_of(drawn);
  const plant::EffectParameters coupling = model.effects.at("coupling");
  model.effects.clear();
  if (known) model.effects["coupling"] = coupling;
  gap::Options options;
  options.effects_at_once = 1;
  return gap::diagnose(model, {real.recorded(rows, 3)}, {real.recorded(judged, 8)}, options);
}

double parameter_of(const gap::Diagnosis& diagnosis, const std::string& name) {
  for (const gap::Cause& cause : diagnosis.cause)
    for (const gap::ParameterEstimate& one : cause.parameters)
      if (one.name == name) return one.value;
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

TEST_CASE("joints simulated apart lack their coupling, and it is named with its inertias") {
  const PointMassGimbal gimbal;
  const gap::Diagnosis diagnosis = diagnosed(gimbal, gimbal, false, 1500, 900);
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.verdict == gap::Verdict::explained);
  CHECK(diagnosis.cause.front().effect == "coupling");
  const plant::EffectParameters truth = test::model_of(gimbal).effects.at("coupling");
  for (const auto& [name, value] : truth) {
    INFO(name);
    CHECK(parameter_of(diagnosis, name) == Approx(value).epsilon(0.1));
  }
}

TEST_CASE("joints that are coupled as the model says have no gap") {
  const PointMassGimbal gimbal;
  CHECK(test::holds(diagnosed(gimbal, gimbal, true, 1500, 900)));
}

TEST_CASE("what is wrong with a coupled gimbal is named by its joint and effect") {
  struct Fault {
    const char* effect;
    const char* parameter;
    double value;
    PointMassGimbal real;
  };
  std::vector<Fault> faults;
  faults.push_back({"roll_coulomb_friction", "Nm", 0.012, {}});
  faults.back().real.friction_Nm[1] = 0.012;
  faults.push_back({"camera_imbalance", "ahead_kgm", 0.0016, {}});
  faults.back().real.masses.push_back({2, 0.04, {0.04, 0.0, 0.0}});
  faults.push_back({"arm_imbalance", "right_kgm", 0.0012, {}});
  faults.back().real.masses.push_back({1, 0.03, {0.0, 0.04, 0.0}});
  for (const Fault& fault : faults) {
    const gap::Diagnosis diagnosis = diagnosed({}, fault.real, true, 400, 300);
    INFO(fault.effect << ": " << diagnosis.reason);
    REQUIRE(diagnosis.cause.size() == 1);
    CHECK(diagnosis.cause.front().effect == fault.effect);
    CHECK(parameter_of(diagnosis, fault.parameter) == Approx(fault.value).epsilon(0.1));
  }
}
