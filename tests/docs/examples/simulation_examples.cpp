// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The examples on the pages of the simulation's classes, and what each of them must give.

#include "../../catch.hpp"

#include <thermopower/simulation/rig_ours.hpp>
#include <thermopower/simulation/rig_policies.hpp>
#include <thermopower/simulation/rig_world.hpp>
#include <thermopower/simulation/scenarios.hpp>
#include <thermopower/simulation/vector_math.hpp>

#include <array>
#include <cmath>

using namespace thermopower;
using namespace thermopower::simulation;

TEST_CASE("parts of an axis: supply, motor, heat, the board's loop, mechanics") {
  const AxisPlant<double>::Config roll = thesis_roll<double>();
  //! [parts of an axis]
  Battery<double> battery({12.6, 9.6, 1800.0, 0.5}, 1.0);  // full and empty V, coulomb, ohm; charged
  GimbalDrive<double> drive = roll.drive;                  // the motor behind a sine's amplitude
  const auto driven =
      drive.at(100.0, battery.state().supply_V, 40.0, 35.0);  // POWER, V, winding, body: heat, torque
  battery.step(driven.load_S, 0.08);                          // what it draws

  MotorBody<double> body(roll.body, {25.0, 25.0});  // winding and body
  body.step(driven.heat_W, {25.0, 0.0}, 0.08);      // air, airspeed; s

  BoardPid<double> loop({0.03, 0.0, 0.02});  // shares per degree, degree second and degree per second
  const double share = loop.step(0.5, 0.0, 10.0, 0.0008);  // error, rate, P
  GimbalAxis<double> axis(roll.mechanics, {0.0, 0.0});     // angle and rate; its bearing is a JointFriction
  axis.step({share * driven.available_Nm, 0.0, {0.0, 0.0, 0.0}},
            0.0008);  // motor and other torque, base at rest
  //! [parts of an axis]
  CHECK(driven.heat_W == Approx(12.6 * 12.6 * driven.load_S).epsilon(0.05));
  CHECK(body.state().winding_C > body.state().body_C);
  CHECK(share == Approx(0.5 * 0.03 * 10.0));
  GimbalAxis<double> undriven(roll.mechanics, {0.0, 0.0});
  undriven.step({0.0, 0.0, {0.0, 0.0, 0.0}}, 0.0008);
  CHECK(axis.state().rate_rad_per_s > undriven.state().rate_rad_per_s);

  //! [joint friction]
  const JointFriction<double> bearing = {0.004, 0.006, 0.1, 0.01,
                                         0.001};     // N m: Coulomb, static; rad/s; N m s/rad
  const double against_Nm = bearing.torque_Nm(2.0);  // at 2 rad/s
  //! [joint friction]
  CHECK(against_Nm > 0.004);
  CHECK(bearing.torque_Nm(-2.0) == Approx(-against_Nm));
}

TEST_CASE("an axis with everything on it") {
  //! [axis plant]
  AxisPlant<double> axis(thesis_roll<double>(), {2.0, 25.0, 25.0});  // starts 2 degrees off, at 25 degC
  for (int slow = 0; slow < 50; ++slow) {
    axis.power(100.0, 12.0);                // POWER and supply, every 80 ms
    axis.warm({25.0, 0.0}, 0.08);           // air, airspeed
    for (int fast = 0; fast < 100; ++fast)  // the board's cycle
      axis.move(axis.ask(-axis.angle_deg(), 40.0, 0.0008), 0.0, {0.0, 0.0, 0.0}, 0.0008);
  }
  // axis.angle_deg(), axis.temperatures()
  //! [axis plant]
  CHECK(std::fabs(axis.angle_deg()) < 1.0);
  CHECK(axis.temperatures().winding_C > 25.0);
}

TEST_CASE("a scenario: what happens to the axes") {
  //! [scenario]
  Scenario scenario = rest(20.0);  // or motion(), gusts(), impacts(), hot_start(), weak_battery()
  AxisScenario& roll = scenario.axes[0];
  roll.base.push_back(Wave{5.0, 0.5, 0.0, 6.0, 16.0});  // sways by 5 degrees at 0.5 Hz, from 6 to 16 s
  roll.pushes.push_back(Push{10.0, 0.1, 0.02});         // at 10 s, for 0.1 s, 0.02 N m
  //! [scenario]
  CHECK(roll.base_deg(1.0) == 0.0);
  CHECK(roll.torque_Nm(10.05) == Approx(0.02));
}

TEST_CASE("a rig: a gimbal of three axes, and what a controller makes of it") {
  //! [rig]
  const RigConfig config = RigConfig::thesis();
  AdaptiveGimbal ours;                                     // or any GimbalController, or constant power:
  ConstantPower constant({100, 100, 100}, {30, 150, 30});  // POWER and P, roll, pitch, yaw
  const RigMetrics figures = run_rig(config, gusts(20.0), ours);
  const RigMetrics plain = run_rig(config, gusts(20.0), constant);
  // figures.energy_J, error_rms_deg(), peak_body_C(), limiting_s()
  //! [rig]
  CHECK(figures.error_rms_deg() > 0.0);
  CHECK(plain.peak_body_C() > 26.0);

  //! [rig by hand]
  Rig rig(config, rest(1.0));
  RigMeter meter;  // adds up the figures
  rig.command(std::array<std::uint8_t, 3>{100, 100, 100}, std::array<std::uint8_t, 3>{30, 150, 30});
  while (rig.time_s() < 1.0) {
    rig.cycle();
    meter.cycle(rig);
  }
  const RigTelemetry seen = rig.telemetry();  // as a board would send it
  //! [rig by hand]
  CHECK(seen.motor_power(0) == 100);
  CHECK(std::fabs(static_cast<double>(seen.error_deg(0))) < 5.0);
}

TEST_CASE("a board in bytes") {
  //! [emulated board]
  // A controller as firmware has it, against the rig, through a board that speaks the protocol byte by byte. The rig
  // is a RigWorld of the board; board.faults breaks the line.
  EmulatedBoard board;
  AdaptiveGimbal controller;
  ConstantPower constant({100, 100, 100}, {30, 150, 30});
  long updates = 0;
  run_rig_bytes(RigConfig::thesis(), rest(2.0), board, constant,
                [&](double, const sbgc::RealtimeData&, const GimbalCommand<3>&) { ++updates; });
  //! [emulated board]
  CHECK(updates > 40);
  CHECK(board.power(0) == 100);

  //! [board line]
  BoardLine line(10.0 * 1e6 / 115200.0, 7);  // microseconds for a byte; the seed of its damage
  const std::uint8_t bytes[3] = {1, 2, 3};
  line.send(bytes, 3, 0.0, false, BoardFaults());
  LineByte byte;
  int arrived = 0;
  while (line.take(1000.0, byte)) ++arrived;  // what is complete after a millisecond
  //! [board line]
  CHECK(arrived == 3);
}

TEST_CASE("a camera, a generator of numbers, roots of lanes") {
  //! [optics]
  const Optics camera = Optics::line_scan();
  const double sharp_mps = camera.sharp_mps();  // slower than this is sharp: less than half a pixel of blur
  //! [optics]
  CHECK(camera.blur_px(sharp_mps) == Approx(0.5));

  //! [random]
  Random random(42);  // the same numbers everywhere
  const double first = random.between(-1.0, 1.0);
  //! [random]
  CHECK(first == Random(42).between(-1.0, 1.0));
  CHECK(std::fabs(first) <= 1.0);

  //! [vector math]
  const double root = VectorMath<double>::inverse_root(16.0);  // the same of Lanes, one number per lane
  //! [vector math]
  CHECK(root == Approx(0.25));
}
