// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a gimbal's motors get as much power as their position errors ask for and their temperatures bear.
//           The rig is that of nano_gimbal; the laws are the corrected ones. Start from this one.
// Model:    per axis the measured current and heating laws, fitted again, stepped without regard to the cycle
//           time; ten levels of error that noise does not toggle; a ceiling that moves at a rate per second;
//           a gain to the nearest count. Supply 13 V.
// Notation: axes roll, pitch, yaw; time in microseconds from a clock that may wrap.
#include <thermopower.h>

#include "gimbal.h"

namespace tp = thermopower;
namespace sbgc = thermopower::sbgc;

const uint32_t request_interval_us = 10000;
const uint32_t answer_timeout_us = 50000;  // a board answers within 24 ms, its 8 ms between looks included

Gimbal gimbal = new_gimbal();
tp::SbgcCodec<> codec;

uint32_t requested_us, stepped_us;
bool is_waiting, has_telemetry;

// A wrong constant leaves every axis at its least power for ever; the lamp says so.
void setup() {
  Serial.begin(115200);
  pinMode(LED_BUILTIN, OUTPUT);
  digitalWrite(LED_BUILTIN, tp::is_error(gimbal.validate().field) ? HIGH : LOW);
}

float seconds_since_step() {
  const uint32_t now_us = micros();
  const float elapsed_s = static_cast<float>(now_us - stepped_us) * 1e-6f;
  stepped_us = now_us;
  return elapsed_s;
}

// Everything that has come is taken at once: an answer is twice as long as the core's buffer.
void receive() {
  while (Serial.available() > 0) {
    for (bool got = codec.receive(static_cast<uint8_t>(Serial.read()), micros()); got; got = codec.next()) {
      const sbgc::RealtimeData* telemetry = codec.realtime_data();
      if (telemetry == nullptr) continue;  // a CONFIRM
      codec.send(sbgc::power_and_gain(gimbal.step(*telemetry, seconds_since_step())), Serial);
      has_telemetry = true;
      is_waiting = false;
    }
  }
}

// A silent board may still listen: it is told what holds for half a second, and then the least power. Before
// the first answer nothing is stepped: the ceiling must not start from the bottom only because the board
// takes longer to start than we do.
void miss_answer() {
  is_waiting = false;
  if (has_telemetry)
    codec.send(sbgc::power_and_gain(gimbal.step_silent(seconds_since_step())), Serial);
  else
    codec.send(sbgc::power_and_gain(gimbal.state().command), Serial);
}

void loop() {
  receive();
  const uint32_t waited_us = micros() - requested_us;
  if (is_waiting && waited_us > answer_timeout_us) miss_answer();
  if (!is_waiting && waited_us > request_interval_us) {
    codec.send(sbgc::Request(sbgc::command::realtime_data_4), Serial);
    requested_us = micros();
    is_waiting = true;
  }
}
