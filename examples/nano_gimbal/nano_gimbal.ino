// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a gimbal's motors get as much power as their position errors ask for and their temperatures bear,
//           as the thesis's program does it: the same decisions from the same telemetry, without its faults
//           (README.md lists both).
// Model:    per axis the programmed laws: ten levels of error, current and heating as fitted, Euler, a
//           ceiling that moves by one count per update, a gain cut to a whole count. Supply 13 V. All in
//           whole numbers: tables instead of a float library.
// Notation: axes roll, pitch, yaw; time in microseconds from a clock that may wrap.
#include <avr/eeprom.h>
#include <avr/sleep.h>
#include <avr/wdt.h>
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
typedef fixed::BasicGimbalController<fixed::ProgrammedGimbal, Roll, Pitch, Yaw> Gimbal;

const uint32_t silence_us =
    501000;  // a little above fixed_point::StandardGimbal::timeout_s(), so that the gimbal agrees

// The chip's EEPROM, a byte at a time: a byte takes 3.3 ms, and nobody waits for it.
struct Eeprom {
  static bool is_ready() { return eeprom_is_ready(); }
  static uint8_t read(size_t at) { return eeprom_read_byte(reinterpret_cast<const uint8_t*>(at)); }
  static void write(size_t at, uint8_t value) { eeprom_write_byte(reinterpret_cast<uint8_t*>(at), value); }
};
// What happens to the motors while this chip has no power? Here one switch feeds it and the board. A board with a supply of
// its own keeps its last command: tp::DrivenOn<110>, where 110 degC is what its largest POWER makes of the motors.
typedef tp::OffTogether WhileOff;
typedef tp::HottestJournal<Eeprom, WhileOff> Journal;

// Until the air is read, nothing cools in it.
const fixed::CoarseTemperature warmest_air = 60 * 128;

Gimbal gimbal;
fixed::Clock step_clock;
tp::SbgcCodec<255, sbgc::ProtocolAuto> codec;
sbgc::Poller poller;
Eeprom eeprom;
Journal journal(eeprom);
tp::RetainedHottest retained __attribute__((section(".noinit")));  // a reset leaves it as it was
const uint32_t reset_us = 3000000;  // the watchdog's second, the boot loader's, and one to spare

// After a reset the motors are as warm as they were, and heated on by the POWER that was told for as long as a reset takes.
// After a loss of power they are as warm as the hottest of the newest record may be by now; without a record as warm
// as the air, as the original starts.
void restore() {
  if (retained.recall()) {
    journal.resume(retained.hottest_C());
    gimbal.restore(retained.hottest, warmest_air, retained.power);
    step_clock.start(micros() - (retained.resets < 5 ? retained.resets : 5) * reset_us);
    return;
  }
  int16_t hottest_C;
  if (!journal.load(hottest_C)) return;
  gimbal.restore(static_cast<fixed::CoarseTemperature>(hottest_C * 128), warmest_air);
  // The first step heats at any power for as long as the record leaves open.
  step_clock.start(micros() - Journal::open_us());
}

void setup() {
  wdt_enable(WDTO_1S);  // a loop that hangs is reset, and goes on as after any reset
  Serial.begin(115200);
  restore();
}

// What the next step needs is computed while the command is on its way.
void send_command() {
  codec.send(sbgc::PowerAndGain<Gimbal::Command>(gimbal.command()), Serial);
  gimbal.prepare();
}

void keep(fixed::Ticks ticks) {
  retained.keep(gimbal.hottest(), gimbal.largest_power());
  journal.step(gimbal.hottest_C(), ticks);
}

// Everything that has come is taken at once: an answer is twice as long as the core's buffer.
void receive() {
  while (Serial.available() > 0) {
    const uint32_t now_us = micros();
    for (bool got = codec.receive(static_cast<uint8_t>(Serial.read()), now_us); got; got = codec.next()) {
      const sbgc::RealtimeData* telemetry = codec.realtime_data();
      if (telemetry == nullptr) {
        // Asked of a board that reports no power; whether another obeyed is in the next telemetry.
        sbgc::hear_answer(codec.frame(), gimbal);
        continue;
      }
      const fixed::Ticks ticks = step_clock.elapsed(now_us);
      gimbal.step(*telemetry, ticks);
      send_command();
      poller.answered();
      keep(ticks);
    }
  }
}

// A silent board may still listen, so it is told the least power. Before the first answer nothing is stepped
// but motors that may be driven: the ceiling must not start from the bottom only because the board takes
// longer to start than we do.
void miss_answer(uint32_t now_us) {
  const tp::LimitReason reason = gimbal.command().reason[0];
  const bool is_unheard = reason == tp::LimitReason::no_telemetry_yet;
  if (is_unheard) codec.protocol().try_other();  // does the board speak the other version?
  if (!is_unheard && reason != tp::LimitReason::link_silent && step_clock.waiting_us(now_us) <= silence_us)
    return;
  if (!is_unheard || gimbal.is_restored()) {
    const fixed::Ticks ticks = step_clock.elapsed(now_us);
    gimbal.step_silent(ticks);
    keep(ticks);
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
