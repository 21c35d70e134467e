// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  the board is not a SimpleBGC: let the same axis controller limit a SimpleFOC motor, a VESC and an ODrive.
// Model:    one axis under full demand, heated past its limit and back; small stand-ins have just the members the adapters use.
// Notation: temperatures in degC, limits in volt and ampere.
#include "adapters.hpp"

#include <math.h>
#include <string.h>

namespace tp = thermopower;
typedef tp::AxisController<tp::motors::Bgm2606_90t> Axis;

// Stand-in for SimpleFOC's FOCMotor: public members, in volt, ampere and ohm.
struct FocMotor {
  float voltage_limit, current_limit, phase_resistance;
};

// Stand-in for the VESC's override.
static float vesc_motor_C = 0.0f;
static void mc_interface_override_temp_motor(float temp) { vesc_motor_C = temp; }

static bool expect(bool condition, const char* claim) {
  if (!condition) printf("FAILED: %s\n", claim);
  return condition;
}

int main() {
  const tp::GainConfig gain = {24.0f, 4.0f};
  const tp::OhmicCurrent<> winding = {11.4f, 0.00393f, 25.0f};
  Axis axis(Axis::Config::with_gain(gain));
  FocMotor foc = {0.0f, 0.0f, 0.0f};
  char line[64];
  bool ok = true;
  printf("  time  motor   power  SimpleFOC V / A / ohm    VESC C  ODrive\n");
  for (int second = 0; second <= 240; ++second) {
    const Axis::Inputs push = {second < 180 ? 2.0f : 0.0f, 13.0f, 26.0f, tp::LimitReason::none};
    const Axis::State& state = axis.step(push, second == 0 ? 0.0f : 1.0f);
    adapters::drive_simple_foc(foc, state, winding, 13.0f);
    adapters::drive_vesc(mc_interface_override_temp_motor, state);
    const size_t length = adapters::command_odrive(line, sizeof line, 0, state, 5.0f);
    ok &= expect(length == strlen(line), "the ODrive line is complete");
    ok &= expect(fabsf(foc.voltage_limit * foc.voltage_limit -
                       169.0f * static_cast<float>(state.power) / 255.0f) < 1e-3f,
                 "SimpleFOC's voltage is eq 3.11");
    ok &= expect(vesc_motor_C == state.motor_C, "the VESC sees the estimate");
    if (second % 30 == 0) {
      printf("%4d s %5.1f C %6d %8.2f %6.2f %6.2f %9.1f  %s", second, static_cast<double>(state.motor_C),
             state.power, static_cast<double>(foc.voltage_limit), static_cast<double>(foc.current_limit),
             static_cast<double>(foc.phase_resistance), static_cast<double>(vesc_motor_C), line);
    }
  }

  const Axis::Inputs lost = {2.0f, NAN, NAN, tp::LimitReason::none};
  Axis fresh(Axis::Config::with_gain(gain));
  const Axis::State& unknown = fresh.step(lost, 1.0f);
  adapters::drive_vesc(mc_interface_override_temp_motor, unknown);
  adapters::drive_simple_foc(foc, unknown, winding, 13.0f);
  ok &= expect(vesc_motor_C > 200.0f, "an unknown temperature is very hot to the VESC");
  ok &= expect(foc.voltage_limit < 1.0f && foc.phase_resistance > 11.0f,
               "an unknown temperature is the least voltage to SimpleFOC");
  char small[8] = "before";
  // Not known when it compiles: a truncation that is meant is nothing to warn of.
  volatile size_t capacity = sizeof small;
  ok &= expect(adapters::command_odrive(small, capacity, 0, unknown, 5.0f) == 0,
               "a line that does not fit is refused");
  return ok ? 0 : 1;
}
