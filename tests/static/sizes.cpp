// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a component costs in RAM: its constants and its state, nothing else. A growth here is a decision, not
// an accident.

#include <thermopower/thermopower.hpp>

namespace tp = thermopower;

namespace {

constexpr unsigned number = sizeof(float);

// Laws are their constants.
static_assert(sizeof(tp::OhmicCurrent<float>) == 3 * number, "resistance, tempco, reference");
static_assert(sizeof(tp::ThesisCurrent<float>) == 6 * number, "three slopes, base, exponent, least voltage");
static_assert(sizeof(tp::HeatCapacityHeating<float>) == number, "C");
static_assert(sizeof(tp::ThesisHeating<float>) == 6 * number,
              "two slopes, two offsets, least voltage, least capacity");
static_assert(sizeof(tp::RateCooling<float>) == number, "k");
static_assert(sizeof(tp::NewtonCooling<float>) == number, "G");
static_assert(sizeof(tp::NaturalConvection<float>) == 3 * number, "G, exponent, reference");
static_assert(sizeof(tp::RadiationCooling<float>) == 2 * number, "area, emissivity");
static_assert(sizeof(tp::ForcedAirflow<float>) == 3 * number, "G, gain, exponent");
static_assert(sizeof(tp::SumOfCooling<tp::NewtonCooling<float>, tp::RadiationCooling<float> >) == 3 * number,
              "both");

// Models add their state: one temperature and three rates; two temperatures, a rate and four precomputed
// factors.
static_assert(sizeof(tp::CurrentModel<tp::OhmicCurrent<float> >) == 3 * number, "no state");
static_assert(sizeof(tp::ThermalModel<>) == (2 + 4) * number, "two constants, four of state");
static_assert(sizeof(tp::TwoNodeThermalModel<float>) == (4 + 3 + 4) * number, "constants, state, factors");
static_assert(sizeof(tp::EnergyMeter<tp::AtWinding, float>) == (2 * 2 + 1) * number + sizeof(uint32_t),
              "two sums, power, count");

// The control: on AVR without padding, elsewhere rounded up to the alignment of a float.
constexpr unsigned padded(unsigned size) {
  return (size + alignof(float) - 1) / alignof(float) * alignof(float);
}
static_assert(sizeof(tp::SafetyLimiter<tp::PerCycle>) == padded(3 * number + 1),
              "three constants and a byte");
static_assert(sizeof(tp::SafetyLimiter<tp::PerSecond>) == 4 * number, "three constants and the ceiling");
static_assert(sizeof(tp::GainScheduler<>) == 2 * number, "two gains");
static_assert(sizeof(tp::NoGain) == 1, "nothing");
static_assert(
    sizeof(tp::AirTemperature) == padded(7 * number + 2) + padded(2),
    "five constants, the air, what is read, its source and whether it is witnessed, and which thermometers are awake");
static_assert(sizeof(tp::LimitedPower) == 2, "power and reason");
static_assert(sizeof(tp::ConfigError) == 1 && sizeof(tp::LimitReason) == 1 && sizeof(tp::AirSource) == 1,
              "bytes in a log");

// A whole axis and a whole gimbal of three; an ATmega328P has 2048 bytes for everything.
typedef tp::AxisController<tp::motors::Bgm2606_90t> Axis;
#if defined(__AVR__)
static_assert(sizeof(Axis) <= 162, "an axis");
static_assert(sizeof(tp::GimbalController<Axis, Axis, Axis>) <= 680,
              "a gimbal: little more than a quarter of the RAM");
#else
static_assert(sizeof(Axis) <= 184, "an axis");
static_assert(sizeof(tp::GimbalController<Axis, Axis, Axis>) <= 720, "a gimbal");
#endif

/// A motor with every balance: the monitor promises 60 bytes of it.
struct Watched {
  static constexpr tp::MonitorConfig monitor() { return {2.0, 1000.0, true}; }
  static constexpr tp::HeatBalanceConfig heat_balance() {
    return tp::HeatBalanceConfig::measured_body(30.0, 8.0, 80.0, 1.0, 0.2, 0.1, 0.1);
  }
  static constexpr tp::WindingBalanceConfig winding_balance() {
    return {24.0, 12.0, 0.05, 0.00393, 25.0, 15.0, 0.2, 0.1};
  }
  static constexpr tp::MotionBalanceConfig motion_balance() {
    return {4.0, 400.0, 2.0, 0.05, 0.05, 1e-5, 0.05, 0.004, 1e-5, 0.3, 0.002, 0.002};
  }
};
static_assert(sizeof(tp::ModelMonitor<Watched>) <= (alignof(uint32_t) == 1 ? 60 : 68), "state only");

}  // namespace
