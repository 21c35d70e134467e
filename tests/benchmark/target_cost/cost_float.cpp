// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The cost of policies in floating point.
#include "cost.hpp"

using namespace cost;

typedef tp::CurrentModel<tp::TabulatedCurrent<tp::ThesisCurrentSource<Small> > > Tabulated;
typedef tp::CurrentModel<tp::OhmicCurrent<> > Ohmic;
typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NewtonCooling<>, tp::ExactStep> Exact;
typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NaturalConvection<>, tp::LinearizedStep> Convection;

template <class Model>
static void step_thermal(Model& model) {
  const typename Model::Inputs inputs = {given.power_W, 8.0f, {given.air_C, 0.0f}};
  model.step(inputs, given.elapsed_s);
  real_sink = model.hottest_C();
}
template <class Rule>
static void step_law() {
  static tp::StepPowerLaw<Rule> law;
  small_sink = law.step(given.error_deg);
}
template <class Rule>
static void step_limiter() {
  static tp::SafetyLimiter<Rule> limiter;
  const typename tp::SafetyLimiter<Rule>::Inputs inputs = {
      given.level, tp::GuardedCelsius::unchecked(given.warm_C), given.power_W * 0.1f - 0.3f};
  small_sink = limiter.step(inputs, given.elapsed_s).power;
}

extern "C" void thesis_current() {
  static Small::Current model(Small::current());
  real_sink = model.at_power(given.level_real, 13.0f, given.warm_C).winding_power_W;
}
extern "C" void tabulated_current() {
  static Tabulated model{Tabulated::Config()};
  real_sink = model.at_power(given.level_real, 13.0f, given.warm_C).winding_power_W;
}
extern "C" void ohmic_current() {
  static Ohmic model(Ohmic::Config{12.0f, 0.00393f, 20.0f});
  real_sink = model.at_power(given.level_real, 13.0f, given.warm_C).winding_power_W;
}
extern "C" void thermal_euler() {
  static Small::Thermal model(Small::thermal(), 30.0f);
  step_thermal(model);
}
extern "C" void thermal_linearized() {
  static tp::motors::Bgm2606_90t::Thermal model(tp::motors::Bgm2606_90t::thermal(), 30.0f);
  step_thermal(model);
}
extern "C" void thermal_exact() {
  static Exact model(Exact::Config{{18.0f}, {0.05f}}, 30.0f);
  step_thermal(model);
}
extern "C" void thermal_convection() {
  static Convection model(Convection::Config{{18.0f}, {0.05f, 0.25f, 20.0f}}, 30.0f);
  step_thermal(model);
}
extern "C" void thermal_two_node() {
  static tp::TwoNodeThermalModel<> model(tp::TwoNodeThermalModel<>::Config{8.0f, 80.0f, 1.0f, {0.2f}}, 30.0f);
  step_thermal(model);
}
extern "C" void energy() {
  static tp::EnergyMeter<tp::AtWinding> meter;
  meter.step(8.0f, 13.0f, given.power_W, given.elapsed_s);
  real_sink = meter.state().energy_J;
}
extern "C" void levels() { step_law<tp::ProgrammedLevels>(); }
extern "C" void hysteresis() { step_law<tp::HysteresisLevels>(); }
extern "C" void continuous() { step_law<tp::ContinuousPower>(); }
extern "C" void limiter_cycle() { step_limiter<tp::PerCycle>(); }
extern "C" void limiter_second() { step_limiter<tp::PerSecond>(); }
extern "C" void gain_cut() {
  static tp::GainScheduler<tp::TruncatedGain> gains(tp::GainConfig{24.0f, 4.0f});
  small_sink = gains.step(given.level);
}
extern "C" void gain_rounded() {
  static tp::GainScheduler<tp::RoundedGain> gains(tp::GainConfig{24.0f, 4.0f});
  small_sink = gains.step(given.level);
}
extern "C" void air() {
  static tp::AirTemperature temperature;
  real_sink = temperature.step(given.camera_real_C, given.frame_real_C).air_C;
}

extern "C" void measure_all() {
  thermopower_cost(thesis_current);
  thermopower_cost(tabulated_current);
  thermopower_cost(ohmic_current);
  thermopower_cost(thermal_euler);
  thermopower_cost(thermal_linearized);
  thermopower_cost(thermal_exact);
  thermopower_cost(thermal_convection);
  thermopower_cost(thermal_two_node);
  thermopower_cost(energy);
  thermopower_cost(levels);
  thermopower_cost(hysteresis);
  thermopower_cost(continuous);
  thermopower_cost(limiter_cycle);
  thermopower_cost(limiter_second);
  thermopower_cost(gain_cut);
  thermopower_cost(gain_rounded);
  thermopower_cost(air);
}
