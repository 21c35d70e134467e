// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a gimbal's motors get as much power as their position errors ask for and their temperatures bear.
//           The rig is that of nano_gimbal; the laws are the corrected ones. Start from this one.
// Model:    per axis the measured current and heating laws, fitted again, stepped without regard to the cycle
//           time; ten levels of error that noise does not toggle; a ceiling that moves at a rate per second;
//           a gain to the nearest count. Supply 13 V.
// Notation: axes roll, pitch, yaw; time in microseconds from a clock that may wrap.
#include <avr/eeprom.h>
#include <avr/sleep.h>
#include <avr/wdt.h>
#include <thermopower.h>

#include "gimbal.h"

namespace tp = thermopower;
namespace sbgc = thermopower::sbgc;

// The chip's EEPROM, a byte at a time: a byte takes 3.3 ms, and nobody waits for it.
struct Eeprom {
  static bool is_ready() { return eeprom_is_ready(); }
  static uint8_t read(size_t at) { return eeprom_read_byte(reinterpret_cast<const uint8_t*>(at)); }
  static void write(size_t at, uint8_t value) { eeprom_write_byte(reinterpret_cast<uint8_t*>(at), value); }
};
typedef tp::HottestJournal<Eeprom, WhileOff> Journal;

Gimbal gimbal = new_gimbal();
tp::SbgcCodec<255, sbgc::ProtocolAuto> codec;
sbgc::Poller poller;
Eeprom eeprom;
Journal journal(eeprom);
tp::fixed_point::Clock journal_clock;
tp::RetainedHottest retained __attribute__((section(".noinit")));  // a reset leaves it as it was
const uint32_t reset_us = 3000000;  // the watchdog's second, the boot loader's, and one to spare

uint32_t stepped_us;
bool has_telemetry;

// After a reset the motors are as warm as they were, and heated on by the POWER that was told for as long as a reset takes.
// After a loss of power they are as warm as the hottest of the newest record may be by now; without a record as hot as
// the limit. What the board did meanwhile nobody knows: the first step heats at any power, for as long as the
// record leaves open.
void restore() {
  if (retained.recall()) {
    journal.resume(retained.hottest_C());
    start(gimbal, static_cast<float>(retained.hottest) / 128.0f);
    gimbal.assume_driven(retained.power);
    stepped_us = micros() - retained.resets * reset_us;
    return;
  }
  int16_t hottest_C = hottest_start_C() > WhileOff::settled_C() ? hottest_start_C() : WhileOff::settled_C();
  journal.load(hottest_C);
  start(gimbal, static_cast<float>(hottest_C));
  gimbal.assume_driven();
  stepped_us = micros() - Journal::open_us();
}

// A wrong constant leaves every axis at its least power for ever; the lamp says so.
void setup() {
  wdt_enable(WDTO_1S);  // a loop that hangs is reset, and goes on as after any reset
  Serial.begin(115200);
  pinMode(LED_BUILTIN, OUTPUT);
  digitalWrite(LED_BUILTIN, tp::is_error(gimbal.validate().field) ? HIGH : LOW);
  restore();
}

float seconds_since_step() {
  const uint32_t now_us = micros();
  const float elapsed_s = static_cast<float>(now_us - stepped_us) * 1e-6f;
  stepped_us = now_us;
  return elapsed_s;
}

void send_command() { codec.send(sbgc::power_and_gain(gimbal.state().command), Serial); }
void keep() {
  retained.keep(hottest(gimbal), largest_power(gimbal));
  journal.step(retained.hottest_C(), journal_clock.elapsed(micros()));
}

// Everything that has come is taken at once: an answer is twice as long as the core's buffer. Whether the
// board obeyed is in the next telemetry; a board that reports no power there is asked for it.
void receive() {
  while (Serial.available() > 0) {
    for (bool got = codec.receive(static_cast<uint8_t>(Serial.read()), micros()); got; got = codec.next()) {
      const sbgc::RealtimeData* telemetry = codec.realtime_data();
      if (telemetry == nullptr) {
        if (!sbgc::hear_power(codec.frame(), gimbal)) sbgc::hear_answer(codec.frame(), gimbal);
        continue;
      }
      const bool is_power_reported = telemetry->motor_power(0) != 0;
      gimbal.step(*telemetry, seconds_since_step());
      send_command();
      if (!is_power_reported) codec.send(sbgc::ask_power(), Serial);
      has_telemetry = true;
      poller.answered();
      keep();
    }
  }
}

// A silent board may still listen: it is told what holds for half a second, and then the least power. Before
// the first answer nothing is stepped: the ceiling must not start from the bottom only because the board
// takes longer to start than we do, and the first step makes up for the time.
void miss_answer() {
  if (has_telemetry) {
    gimbal.step_silent(seconds_since_step());
    keep();
  } else {
    codec.protocol().try_other();  // does the board speak the other version?
  }
  send_command();
}

// Until a byte or the clock's next interrupt, at most 1.024 ms away, there is nothing to do. Interrupts are allowed only by the
// instruction before the sleep: a byte that comes in between wakes the chip, and is not slept over.
void rest() {
  cli();
  if (Serial.available() == 0) {
    sleep_enable();
    sei();
    sleep_cpu();
    sleep_disable();
  }
  sei();
}

void loop() {
  wdt_reset();
  rest();
  journal.work();
  receive();
  switch (poller.turn(micros())) {
    case sbgc::Turn::ask:
      codec.send(sbgc::Request(sbgc::command::realtime_data_4), Serial);
      break;
    case sbgc::Turn::missed:
      miss_answer();
      break;
    case sbgc::Turn::wait:
      break;
  }
}
