// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The cost of policies in whole numbers.
#include "cost.hpp"

using namespace cost;

typedef fixed::ThermalModel<fixed::ThesisMotor<Small> > Thermal;
typedef fixed::SafetyLimiter<fixed::ThesisLimit, fixed::PerCycle> Limiter;

static Thermal& thermal() {
  static Thermal model;
  return model;
}

extern "C" void fixed_thermal_set() { thermal().start(static_cast<fixed::Temperature>(given.warm) * 65536); }
extern "C" void fixed_heating() {
  sink = static_cast<uint32_t>(fixed::Heating<fixed::ThesisMotor<Small> >::rate(given.level, given.warm));
}
// Every level at every temperature, to a quarter of a kelvin: near the pole of a law a division takes
// longest.
static void search_heating(uint16_t round) {
  const uint32_t at = static_cast<uint32_t>(round) * (235520u / counter::searches + 1u);
  given.level = static_cast<uint8_t>(at);
  given.warm = static_cast<fixed::CoarseTemperature>(-6400 + static_cast<int16_t>(at % 920u) * 32);
}
extern "C" void fixed_thermal() { sink = static_cast<uint32_t>(thermal().step(given.air, given.ticks)); }
extern "C" void fixed_levels() {
  static fixed::ProgrammedLevels<> law;
  small_sink = law.step(given.error_units);
}
extern "C" void fixed_hysteresis() {
  static fixed::HysteresisLevels<> law;
  small_sink = law.step(given.error_units);
}
extern "C" void fixed_limiter_cycle() {
  static Limiter limiter;
  small_sink =
      limiter
          .step(given.level,
                fixed::GuardedTemperature::unchecked(static_cast<fixed::Temperature>(given.warm) * 65536),
                given.rate, given.ticks)
          .power;
}
extern "C" void fixed_limiter_second() {
  static fixed::SafetyLimiter<> limiter;
  small_sink =
      limiter
          .step(given.level,
                fixed::GuardedTemperature::unchecked(static_cast<fixed::Temperature>(given.warm) * 65536),
                given.rate, given.ticks)
          .power;
}
extern "C" void fixed_gain_cut() { small_sink = fixed::TruncatedGain<24, 4>::gain(given.level); }
extern "C" void fixed_gain() { small_sink = fixed::RoundedGain<24, 4>::gain(given.level); }
extern "C" void fixed_air() {
  static fixed::AirTemperature<> air;
  sink = static_cast<uint32_t>(air.step(given.camera_C, given.frame_C).air);
}

extern "C" void measure_all() {
  thermopower_cost_searched(fixed_heating, cost_nothing, search_heating, counter::searches);
  thermopower_cost_after(fixed_thermal, fixed_thermal_set);
  thermopower_cost(fixed_levels);
  thermopower_cost(fixed_hysteresis);
  thermopower_cost(fixed_limiter_cycle);
  thermopower_cost(fixed_limiter_second);
  thermopower_cost(fixed_gain_cut);
  thermopower_cost(fixed_gain);
  thermopower_cost(fixed_air);
}
