// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a printer's hotend and bed, of which thermistor, heater, fan or room fail; who notices, when, and what it says.
// Model:    element, block and a second mass, a lagging thermometer, a fan, a supply that sags (printer_plant.hpp).
// Notation: times from the fault on, s; "-" where a check never fails.
#include "heater.hpp"
#include "printer_plant.hpp"

#include <stdio.h>

namespace tp = thermopower;

namespace {

/// What each check said of a run, and when.
struct Outcome {
  double watch_s = -1.0, runaway_s = -1.0, kelvin_sum_s = -1.0, rate_s = -1.0;
  uint8_t suspects = 0;
  bool is_early = false;  // before the fault
};

constexpr double hold_s = 1200.0;  // from the fault on

/// Prints `-` for never.
void print_time(double time_s) {
  if (time_s < 0.0) printf(" %7s", "-");
  else printf(" %7.0f", time_s);
}

/// Heats, holds, fails at `fault_s`, holds on, cools and heats again: all checks beside each other.
/// @param is_cutting  the monitor cuts the power, and names the cause while the heater cools
template <class Constants>
Outcome run(const printer::Plant& plant, const heater::Pid::Config& gains, heater::RunawayCheck runaway,
            heater::KelvinSumCheck kelvin_sum, heater::RateCheck rate, float target_C, printer::Fault fault,
            bool is_cutting) {
  const double air_C = 22.0, dt_s = 0.1, fault_s = 900.0, off_s = fault_s + hold_s, on_s = 3300.0,
               end_s = 4200.0;
  printer::Heater real(plant, air_C, 7);
  heater::Pid pid(gains);
  heater::Watch<Constants> watch;
  Outcome outcome;
  float duty = 0.0f;
  bool has_failed = false;
  for (double now_s = 0.0; now_s < end_s; now_s += dt_s) {
    const double supply_V = plant.supply_V * (1.0 - 0.02 * static_cast<double>(duty));  // sags under load
    const bool is_fan_on = now_s > 400.0;
    if (now_s >= fault_s && !has_failed) {
      has_failed = true;
      real.fail(fault);
    }
    real.pass(static_cast<double>(duty), is_fan_on ? 1.0 : 0.0, air_C, supply_V, dt_s);
    const float measured_C = static_cast<float>(real.reading_C()), step_s = static_cast<float>(dt_s);
    const float goal_C = now_s < off_s || now_s > on_s ? target_C : 0.0f;
    const double after_s = now_s - fault_s;
    const auto note = [&](double& time_s, bool is_alarm) {
      if (!is_alarm || time_s >= 0.0) return;
      time_s = after_s > 0.0 ? after_s : 0.0;
      outcome.is_early = outcome.is_early || after_s < 0.0;
    };
    const float heat_W =
        duty > 0.0f ? heater::heat_W<Constants>(duty, static_cast<float>(supply_V), watch.reading()) : 0.0f;
    const bool is_found = watch.step(heat_W, measured_C, static_cast<float>(air_C), is_fan_on ? 255 : 0,
                                     step_s) != tp::LimitReason::none;
    if (is_found && outcome.watch_s < 0.0) outcome.suspects = watch.suspects();
    note(outcome.watch_s, is_found);
    note(outcome.runaway_s, !runaway.step(goal_C, measured_C, step_s));
    note(outcome.kelvin_sum_s, !kelvin_sum.step(goal_C, measured_C, step_s));
    note(outcome.rate_s, !rate.step(goal_C, measured_C, step_s));
    const bool is_cut = is_cutting && is_found;
    duty = goal_C > 0.0f && !is_cut ? pid.step(goal_C, measured_C, step_s) : 0.0f;
  }
  if (watch.likeliest() != 0) outcome.suspects = watch.likeliest();
  return outcome;
}

uint8_t truth(printer::Fault fault) {
  switch (fault) {
    case printer::Fault::thermistor_loose:
    case printer::Fault::thermistor_stuck:
      return static_cast<uint8_t>(tp::Suspect::thermometer);
    case printer::Fault::heater_weak:
    case printer::Fault::heater_stays_on:
      return static_cast<uint8_t>(tp::Suspect::heater);
    case printer::Fault::fan_lost:
      return static_cast<uint8_t>(tp::Suspect::fan);
    case printer::Fault::room_warmer:
      return static_cast<uint8_t>(tp::Suspect::air);
    case printer::Fault::none:
      break;
  }
  return 0;
}

/// A fault of the heat, or of the loss; a thermometer that reads a share looks like the first.
bool is_of_one_side(uint8_t suspects) {
  const uint8_t of_heat =
      static_cast<uint8_t>(tp::Suspect::heater) | static_cast<uint8_t>(tp::Suspect::thermometer);
  return (suspects & of_heat) == 0 || (suspects & static_cast<uint8_t>(~of_heat)) == 0;
}

/// @return whether every fault is among the likeliest suspects, before any other check has failed and in the hold, and health in none
bool compare(const char* title, bool is_bed) {
  using heater::KelvinSumCheck;
  using heater::RateCheck;
  using heater::RunawayCheck;
  bool is_right = true;
  printf("%s\n%-20s %7s %7s %7s %7s  likeliest suspects\n", title, "fault", "watch", "runaway", "K sum",
         "rate");
  for (int i = 0; i <= static_cast<int>(printer::Fault::heater_stays_on); ++i) {
    const printer::Fault fault = static_cast<printer::Fault>(i);
    const auto run_it = [&](bool is_cutting) {
      return is_bed ? run<heater::Bed>(printer::bed(), heater::Pid::Config::bed(),
                                       RunawayCheck(RunawayCheck::Config::bed()),
                                       KelvinSumCheck(KelvinSumCheck::Config::bed()),
                                       RateCheck(RateCheck::Config::bed()), 60.0f, fault, is_cutting)
                    : run<heater::Hotend>(printer::hotend(), heater::Pid::Config::hotend(),
                                          RunawayCheck(RunawayCheck::Config::hotend()),
                                          KelvinSumCheck(KelvinSumCheck::Config::hotend()),
                                          RateCheck(RateCheck::Config::hotend()), 210.0f, fault, is_cutting);
    };
    Outcome outcome = run_it(false);
    outcome.suspects = run_it(true).suspects;
    printf("%-20s", printer::name(fault));
    print_time(outcome.watch_s);
    print_time(outcome.runaway_s);
    print_time(outcome.kelvin_sum_s);
    print_time(outcome.rate_s);
    printf("  %s%s%s%s%s\n", tp::is_suspect(outcome.suspects, tp::Suspect::heater) ? "heater " : "",
           tp::is_suspect(outcome.suspects, tp::Suspect::loss) ? "loss " : "",
           tp::is_suspect(outcome.suspects, tp::Suspect::fan) ? "fan " : "",
           tp::is_suspect(outcome.suspects, tp::Suspect::air) ? "air " : "",
           tp::is_suspect(outcome.suspects, tp::Suspect::thermometer) ? "thermometer" : "");
    const auto is_first = [&](double other_s) { return other_s < 0.0 || outcome.watch_s < other_s; };
    // A thermistor that stands where it should, and a room that is warmer than told, show in a hold at most slowly.
    const bool is_for_later =
        fault == printer::Fault::thermistor_stuck || (fault == printer::Fault::room_warmer && !is_bed);
    const bool is_found = outcome.watch_s >= 0.0 && (outcome.watch_s < hold_s || is_for_later) &&
                          (outcome.suspects & truth(fault)) != 0 && is_of_one_side(outcome.suspects) &&
                          is_first(outcome.runaway_s) && is_first(outcome.kelvin_sum_s) &&
                          is_first(outcome.rate_s);
    if (outcome.is_early || (fault == printer::Fault::none ? outcome.watch_s >= 0.0 : !is_found)) {
      printf("  ^ not as promised\n");
      is_right = false;
    }
  }
  printf("\n");
  return is_right;
}

/// The whole heater: how hot the block gets after its thermistor has failed.
template <class Check>
double hottest_after(printer::Fault fault, const typename Check::Config& check, const char* title) {
  printer::Heater real(printer::hotend(), 22.0, 7);
  heater::Heater<heater::Hotend, Check> firmware(heater::Pid::Config::hotend(), check);
  double duty = 0.0, hottest_C = 0.0;
  bool has_failed = false;
  for (double now_s = 0.0; now_s < 2400.0; now_s += 0.1) {
    if (now_s >= 900.0 && !has_failed) {
      has_failed = true;
      real.fail(fault);
    }
    real.pass(duty, 0.0, 22.0, 24.0, 0.1);
    duty = static_cast<double>(
        firmware.step(210.0f, static_cast<float>(real.reading_C()), 22.0f, 24.0f, 0, 0.1f));
    if (real.block_C() > hottest_C) hottest_C = real.block_C();
  }
  printf("the hotend at 210 degC, %s, %s: reason %d, at most %.0f degC\n", printer::name(fault), title,
         static_cast<int>(firmware.reason()), hottest_C);
  return hottest_C;
}

}  // namespace

int main() {
  const bool is_hotend_right = compare("hotend at 210 degC", false),
             is_bed_right = compare("bed at 60 degC", true);
  const double loose_C = hottest_after<heater::RunawayCheck>(printer::Fault::thermistor_loose,
                                                             heater::RunawayCheck::Config::hotend(),
                                                             "cut by the watch"),
               stuck_C = hottest_after<heater::KelvinSumCheck>(printer::Fault::thermistor_stuck,
                                                               heater::KelvinSumCheck::Config::hotend(),
                                                               "cut by the watch");
  return is_hotend_right && is_bed_right && loose_C < 240.0 && stuck_C < 240.0 ? 0 : 1;
}
