// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a robot's joint on a Cortex-M without an operating system. Its power is decided in a control
//           interrupt, at an exact pace; main() has the time in between.
// Model:    a copper winding on one heat capacity, ten levels of error, and the ceiling of eq 4.23, all in
//           whole numbers: the same program on a Cortex-M0, which has no floating-point unit, and on an M4F.
// Notation: a tick is 256 us; error in units of 360/16384 degree; power parameter 0 .. 255.
#include <thermopower/thermopower.hpp>

#include "board.hpp"

namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

namespace {

struct JointMotor {
  static constexpr double supply_V() { return 24.0; }
  static constexpr double resistance_ohm() { return 2.0; }  // at
  static constexpr double reference_C() { return 25.0; }
  static constexpr double tempco_per_K() { return 0.00393; }
  static constexpr double heat_capacity_J_per_K() { return 180.0; }
  static constexpr double conductance_W_per_K() { return 0.9; }
};
struct JointLimit : fixed::ThesisLimit {
  static constexpr double maximum_C() { return 80.0; }
  static constexpr double safety_time_s() { return 10.0; }
};
struct JointLevels : fixed::ThesisLevels {
  static constexpr double full_power_error_deg() { return 5.0; }
};
typedef fixed::ThermalModel<fixed::OhmicMotor<JointMotor> > Thermal;
typedef fixed::AxisController<Thermal, fixed::ProgrammedLevels<JointLevels>,
                              fixed::SafetyLimiter<JointLimit> >
    Axis;

// What main() wants to know. The interrupt writes it, so main() reads it with interrupts held back.
struct Snapshot {
  uint32_t cycles;
  fixed::Temperature motor;
  tp::LimitedPower granted;
  uint32_t longest;  // control interrupt, in clocks of the processor
};

Axis axis;
Snapshot latest;
bool is_started;

Snapshot read_latest() {
  const board::InterruptsHeldBack now;
  return latest;
}

}  // namespace

// The control interrupt, every board::control_ticks. All of it takes the same time, whatever went before.
void control() {
  const uint32_t began = board::clocks();
  const board::Measured measured = board::measure();
  const fixed::CoarseTemperature air = static_cast<fixed::CoarseTemperature>(measured.air_C * 128);
  // As warm as the air at first; a thermometer on the motor would know better.
  if (!is_started) axis.start(static_cast<fixed::Temperature>(air) * 65536);
  is_started = true;

  const fixed::AxisInputs inputs = {
      measured.error_units, air,
      measured.is_valid ? tp::LimitReason::none : tp::LimitReason::air_implausible};
  latest.granted = axis.step(inputs, board::control_ticks);
  board::set_power(latest.granted.power);
  axis.prepare();  // the power is out: this is for the next cycle

  latest.motor = axis.thermal().state().motor;
  ++latest.cycles;
  const uint32_t took = board::clocks_since(began);
  if (took > latest.longest) latest.longest = took;
}

int main() {
  board::start();
  board::print("    s  power  estimate  winding/degC");
  uint32_t limited_s = 0;
  int32_t hottest_C = 0;
  for (uint32_t second = 1; second <= 120; ++second) {
    Snapshot now = read_latest();
    while (now.cycles * board::control_ticks < second * 3906u) {
      board::sleep_until_interrupt();
      now = read_latest();
    }
    const int32_t winding_C = board::true_winding_C();
    if (winding_C > hottest_C) hottest_C = winding_C;
    if (now.granted.reason != tp::LimitReason::none) ++limited_s;
    if (second % 10 == 0) board::print_row(second, now.granted.power, now.motor >> 23, winding_C);
  }
  const Snapshot end = read_latest();
  board::print_value("control interrupts:", end.cycles);
  board::print_value("longest, in clocks:", end.longest);
  board::print_value("seconds limited:", limited_s);
  board::print_value("hottest winding, degC:", static_cast<uint32_t>(hottest_C));
  // The limiter acted, the winding stayed cool, the demand was granted in the end, and control is a twentieth
  // of the time at most.
  const bool is_well = limited_s > 5 && hottest_C <= 80 && end.granted.reason == tp::LimitReason::none &&
                       end.longest < board::clocks_per_control / 20;
  board::stop(is_well ? 0 : 1);
}
