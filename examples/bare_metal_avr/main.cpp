// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a gimbal controller on an ATmega328P at 16 MHz without Arduino: no core, no interrupt, no buffer
//           but the codec's own.
// Model:    the corrected laws in whole numbers. The UART and a timer are polled, which the chip's two-byte
//           buffer allows: a byte takes 1389 cycles on the wire, and nothing here takes two of them while the
//           board talks.
// Notation: axes roll, pitch, yaw; time in microseconds, from timer 1 at 2 MHz.
#include <avr/io.h>

#include <thermopower/thermopower.hpp>

namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;
namespace sbgc = thermopower::sbgc;

namespace {

typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t> > Small;
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm5208_200_12> > Large;
typedef fixed::HysteresisLevels<> PowerLaw;
typedef fixed::SafetyLimiter<> Limiter;
typedef fixed::GimbalController<
    fixed::AxisController<Small, PowerLaw, Limiter, fixed::RoundedGain<24, 4> >,
    fixed::AxisController<Small, PowerLaw, Limiter, fixed::RoundedGain<180, 105> >,
    fixed::AxisController<Large, PowerLaw, Limiter, fixed::RoundedGain<40, 2> > >
    Gimbal;

// 115200 baud, 8N1, at double speed: 16 MHz / 8 / 17 is 2.1 % fast, which the data sheet allows.
struct Uart {
  static void start() {
    UBRR0 = 16;
    UCSR0A = 1 << U2X0;
    UCSR0B = (1 << RXEN0) | (1 << TXEN0);
    UCSR0C = (1 << UCSZ01) | (1 << UCSZ00);
  }
  static bool has_byte() { return (UCSR0A & (1 << RXC0)) != 0; }
  static uint8_t read() { return UDR0; }
  static size_t write(const uint8_t* bytes, size_t size) {
    for (size_t sent = 0; sent < size; ++sent) {
      while ((UCSR0A & (1 << UDRE0)) == 0) {
      }
      UDR0 = bytes[sent];
    }
    return size;
  }
};

// Timer 1 counts half microseconds in 16 bits; asked at least every 32 ms it gives a time that does not wrap
// for 71 minutes, and differences stay right beyond that.
class Clock {
public:
  static void start() { TCCR1B = 1 << CS11; }
  uint32_t now_us() {
    const uint16_t count = TCNT1;
    const uint16_t half_us = static_cast<uint16_t>(count - last_);
    last_ = static_cast<uint16_t>(count & ~1u);
    us_ += half_us >> 1;
    return us_;
  }

private:
  uint16_t last_ = 0;
  uint32_t us_ = 0;
};

Gimbal gimbal;
tp::SbgcCodec<> codec;
sbgc::Poller poller;
fixed::Clock step_clock;
Uart uart;
Clock clock;

// What the next step needs is computed when the command has gone.
void send_command() {
  codec.send(sbgc::PowerAndGain<Gimbal::Command>(gimbal.command()), uart);
  gimbal.prepare();
}

// Before the first answer nothing is stepped: the ceiling must not start from the bottom because the board
// starts slowly.
void miss_answer(uint32_t now_us) {
  if (gimbal.command().reason[0] != tp::LimitReason::no_telemetry_yet)
    gimbal.step_silent(step_clock.elapsed(now_us));
  send_command();
}

}  // namespace

int main() {
  Uart::start();
  Clock::start();
  for (;;) {
    const uint32_t now_us = clock.now_us();
    switch (poller.turn(now_us)) {
      case sbgc::Turn::ask:
        codec.send(sbgc::Request(sbgc::command::realtime_data_4), uart);
        break;
      case sbgc::Turn::missed:
        miss_answer(now_us);
        break;
      case sbgc::Turn::wait:
        break;
    }
    if (!uart.has_byte()) continue;
    for (bool got = codec.receive(uart.read(), now_us); got; got = codec.next()) {
      const sbgc::RealtimeData* telemetry = codec.realtime_data();
      if (telemetry == nullptr) continue;  // a CONFIRM
      gimbal.step(*telemetry, step_clock.elapsed(now_us));
      send_command();
      poller.answered();
    }
  }
}
