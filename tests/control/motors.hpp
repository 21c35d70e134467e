// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/current_model.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/thermal_model.hpp>
#include <thermopower/actuator/two_node_thermal_model.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>
#include <thermopower/motors/bgm5208_200_12.hpp>

// Motors of one's own, as a user would describe them.
namespace motors_under_test {

namespace tp = thermopower;

struct Servo {
  typedef tp::CurrentModel<tp::OhmicCurrent<float> > Current;
  typedef tp::ThermalModel<tp::HeatCapacityHeating<float>, tp::NewtonCooling<float>, tp::ExactStep> Thermal;
  static Current::Config current() { return {12.0f, 0.00393f, 20.0f}; }
  static tp::SupplyRange supply() { return {1.0f, 30.0f}; }
  static Thermal::Config thermal() { return {{18.0f}, {0.05f}}; }
};

struct ServoWithWinding {
  typedef tp::CurrentModel<tp::OhmicCurrent<float> > Current;
  typedef tp::TwoNodeThermalModel<float> Thermal;
  static Current::Config current() { return {12.0f, 0.00393f, 20.0f}; }
  static tp::SupplyRange supply() { return {1.0f, 30.0f}; }
  static Thermal::Config thermal() { return {2.0f, 16.0f, 0.4f, {0.05f}}; }
};

}  // namespace motors_under_test
