// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The examples on the pages of the controllers in whole numbers, and what each of them must give.

#include "../../catch.hpp"

#include <thermopower/thermopower.hpp>

#include <cmath>

namespace tp = thermopower;

//! [fixed-point axis]
namespace fp = thermopower::fixed_point;
typedef fp::ThermalModel<fp::ThesisMotor<tp::motors::Bgm2606_90t>> Motor;
typedef fp::AxisController<Motor, fp::ProgrammedLevels<>, fp::SafetyLimiter<>, fp::RoundedGain<24, 4>> Axis;
//! [fixed-point axis]

//! [fixed-point constants]
// Constants are types: a set of one's own has the same functions.
struct Hotter : fp::ThesisLimit {
  static constexpr double maximum_C() { return 75.0; }
};
struct Finer : fp::ThesisLevels {
  static constexpr double full_power_error_deg() { return 0.5; }
};
struct Patient : fp::StandardGimbal {
  static constexpr double timeout_s() { return 1.0; }
};
typedef fp::AxisController<Motor, fp::HysteresisLevels<Finer>, fp::SafetyLimiter<Hotter, fp::PerSecond>>
    Tuned;
//! [fixed-point constants]

TEST_CASE("an axis in whole numbers") {
  //! [fixed-point cycle]
  Axis axis;
  axis.start(25 * 8388608);  // 25 degC, in 2^-23 K
  axis.prepare();            // while the command is on its way: the heating of the power granted
  // Half a degree in 360/16384 degree, air of 25 degC in 2^-7 K, no fault; 30 ms in ticks of 256 us.
  const tp::LimitedPower& granted = axis.step({23, 25 * 128, tp::LimitReason::none}, 117);
  const uint8_t p_gain = axis.p_gain();
  //! [fixed-point cycle]
  //! [fixed-point gains]
  const uint8_t cut = fp::TruncatedGain<24, 4>::gain(125);  // as the original program cuts it
  const uint8_t none = fp::NoGain::gain(125);               // an actuator without a gain
  //! [fixed-point gains]
  CHECK(cut == 14);
  CHECK(none == 0);
  CHECK(granted.power == 125);  // 23 units are 0.505 degrees: five levels of 25
  CHECK(p_gain == std::lround(24.0 - 20.0 * 125.0 / 255.0));

  Tuned tuned;
  tuned.start(25 * 8388608);
  tuned.prepare();
  CHECK(tuned.step({12, 25 * 128, tp::LimitReason::none}, 117).power ==
        125);  // a quarter of a degree of a half
}

TEST_CASE("air in whole numbers that is left out is the warmest, not 0 degC") {
  Axis axis, warmest;
  axis.start(25 * 8388608);
  warmest.start(25 * 8388608);
  //! [fixed-point air left out]
  const Axis::Inputs without_air = {23, {}, tp::LimitReason::none};  // counts as 125 degC
  //! [fixed-point air left out]
  for (int cycle = 0; cycle < 1000; ++cycle) {
    axis.prepare();
    warmest.prepare();
    axis.step(without_air, 117);
    warmest.step({23, 125 * 128, tp::LimitReason::none}, 117);
  }
  CHECK(axis.thermal().state().motor == warmest.thermal().state().motor);
  CHECK(axis.upper() > 25 * 128);
  CHECK(Axis::Inputs().air == 125 * 128);
}

TEST_CASE("parts of an axis in whole numbers, alone") {
  //! [fixed-point parts]
  fp::ProgrammedLevels<fp::ThesisLevels> law;
  const uint8_t demand = law.step(23);  // 0.505 degrees
  fp::SafetyLimiter<fp::ThesisLimit, fp::PerCycle> limiter;
  // 50 degC that rise by 1 K/s: in 30 s they would be above 60.
  const tp::LimitedPower granted =
      limiter.step(255, fp::GuardedTemperature::unchecked(50 * 8388608), 140737488, 117);
  //! [fixed-point parts]
  CHECK(demand == 125);
  CHECK(fp::K_per_s_of(140737488) == Approx(1.0).epsilon(1e-4));
  CHECK(granted.power == 254);
  fp::SafetyLimiter<fp::ThesisLimit, fp::PerSecond> second;
  CHECK(second.step(255, fp::GuardedTemperature::unchecked(50 * 8388608), 140737488, 117).power ==
        254);  // 33.3 counts per second: one in 30 ms
  fp::HysteresisLevels<> held;
  CHECK(held.step(23) == 125);
  CHECK(held.step(22) == 125);  // below the edge by less than the hysteresis
}

TEST_CASE("a gimbal in whole numbers: telemetry in, POWER and P out") {
  //! [fixed-point gimbal]
  typedef fp::BasicGimbalController<fp::StandardGimbal, Axis, Axis>
      Gimbal;  // ProgrammedGimbal: as the thesis
  Gimbal gimbal;
  fp::Clock clock;
  const auto on_telemetry = [&](const tp::sbgc::RealtimeData& telemetry, uint32_t now_us) {
    const Gimbal::Command& command = gimbal.step(telemetry, clock.elapsed(now_us));
    // codec.send(tp::sbgc::PowerAndGain<Gimbal::Command>(command), Serial);
    gimbal.prepare();  // while that is on its way
    return command.power[0];
  };
  //! [fixed-point gimbal]
  tp::sbgc::RealtimeFields fields;
  fields.battery_cV = 1260;
  fields.imu_C = fields.frame_imu_C = 25;
  fields.target_angle[0] = 23;
  tp::SbgcCodec<> board, host;
  uint8_t bytes[160];
  int power = 0;
  for (uint32_t cycle = 1; cycle < 5; ++cycle) {
    const size_t size = board.encode(fields, bytes, sizeof bytes);
    for (size_t i = 0; i < size; ++i)
      if (host.receive(bytes[i], cycle * 30000u) && host.realtime_data() != nullptr)
        power = on_telemetry(*host.realtime_data(), cycle * 30000u);
    // A board that obeys says so.
    for (int k = 0; k < 2; ++k) fields.motor_power[k] = gimbal.command().power[k];
  }
  CHECK(power == 125);
  typedef fp::BasicGimbalController<Patient, Axis, Axis> Slow;
  CHECK(Slow().axis_count() == 2);
  typedef fp::BasicGimbalController<fp::ProgrammedGimbal, Axis> AsProgrammed;
  CHECK(AsProgrammed().axis_count() == 1);
}

TEST_CASE("air in whole numbers") {
  //! [fixed-point air]
  fp::AirTemperature<fp::StandardAir>
      air;                 // ProgrammedAir believes its thermometers, as the thesis's program
  air.step(30, 28, 3906);  // camera and frame, whole degC; a second in ticks of 256 us
  const fp::CoarseTemperature now = air.step(31, 29, 3906).air;  // in 2^-7 K: the declared 45 degC
  fp::AirTemperature<fp::BelievedAir> believed;                  // 30 degC, whoever drifts
  //! [fixed-point air]
  CHECK(now == 45 * 128);
  believed.step(30, 28, 3906);
  CHECK(believed.step(31, 29, 3906).air == 30 * 128);
  fp::AirTemperature<fp::ProgrammedAir> programmed;
  programmed.step(30, 28, 3906);
  programmed.step(31, 29, 3906);
  CHECK(programmed.step(20, 18, 3906).air == 19 * 128);
}
