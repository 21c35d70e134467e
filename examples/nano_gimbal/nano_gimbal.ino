// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a gimbal's motors get as much power as their position errors ask for and their temperatures bear,
//           as the thesis's program does it: the same decisions from the same telemetry, without its faults
//           (README.md lists both).
// Model:    per axis the programmed laws: ten levels of error, current and heating as fitted, Euler, a
//           ceiling that moves by one count per update, a gain cut to a whole count. Supply 13 V. All in
//           whole numbers: tables instead of a float library.
// Notation: axes roll, pitch, yaw; time in microseconds from a clock that may wrap.
#include <thermopower.h>

namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;
namespace sbgc = thermopower::sbgc;

typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t::AsProgrammed> > Small;
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm5208_200_12::AsProgrammed> > Large;
typedef fixed::SafetyLimiter<fixed::ThesisLimit, fixed::PerCycle> Limiter;
typedef fixed::AxisController<Small, fixed::ProgrammedLevels<>, Limiter, fixed::TruncatedGain<24, 4> > Roll;
typedef fixed::AxisController<Small, fixed::ProgrammedLevels<>, Limiter, fixed::TruncatedGain<180, 105> >
    Pitch;
typedef fixed::AxisController<Large, fixed::ProgrammedLevels<>, Limiter, fixed::TruncatedGain<40, 2> > Yaw;
typedef fixed::GimbalController<Roll, Pitch, Yaw> Gimbal;

const uint32_t silence_us =
    501000;  // a little above fixed_point::StandardGimbal::timeout_s(), so that the gimbal agrees

Gimbal gimbal;
fixed::Clock step_clock;
tp::SbgcCodec<> codec;
sbgc::Poller poller;

void setup() { Serial.begin(115200); }

// What the next step needs is computed while the command is on its way.
void send_command() {
  codec.send(sbgc::PowerAndGain<Gimbal::Command>(gimbal.command()), Serial);
  gimbal.prepare();
}

// Everything that has come is taken at once: an answer is twice as long as the core's buffer.
void receive() {
  while (Serial.available() > 0) {
    const uint32_t now_us = micros();
    for (bool got = codec.receive(static_cast<uint8_t>(Serial.read()), now_us); got; got = codec.next()) {
      const sbgc::RealtimeData* telemetry = codec.realtime_data();
      if (telemetry == nullptr) continue;  // a CONFIRM
      gimbal.step(*telemetry, step_clock.elapsed(now_us));
      send_command();
      poller.answered();
    }
  }
}

// A silent board may still listen, so it is told the least power. Before the first answer nothing is stepped:
// the ceiling must not start from the bottom only because the board takes longer to start than we do.
void miss_answer(uint32_t now_us) {
  const tp::LimitReason reason = gimbal.command().reason[0];
  if (reason != tp::LimitReason::no_telemetry_yet) {
    if (reason != tp::LimitReason::link_silent && step_clock.waiting_us(now_us) <= silence_us) return;
    gimbal.step_silent(step_clock.elapsed(now_us));
  }
  send_command();
}

void loop() {
  receive();
  const uint32_t now_us = micros();
  switch (poller.turn(now_us)) {
    case sbgc::Turn::ask:
      codec.send(sbgc::Request(sbgc::command::realtime_data_4), Serial);
      break;
    case sbgc::Turn::missed:
      miss_answer(now_us);
      break;
    case sbgc::Turn::wait:
      break;
  }
}
