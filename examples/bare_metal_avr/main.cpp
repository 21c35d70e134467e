// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  the gimbal controller on an ATmega328P at 16 MHz without Arduino: no core, no interrupt, no buffer but the codec's own.
// Model:    as examples/gimbal_controller; the UART and a timer are polled, which the two-byte hardware FIFO allows because a byte
//           takes 1389 cycles on the wire and a received byte costs a tenth of that.
// Notation: time in microseconds, from timer 1 at 2 MHz.
#include <avr/io.h>
#include <thermopower/thermopower.hpp>

namespace tp = thermopower;
namespace sbgc = thermopower::sbgc;

namespace {

typedef tp::StepPowerLaw<tp::HysteresisLevels> PowerLaw;
typedef tp::AxisController<tp::motors::Bgm2606_90t, PowerLaw> Small;
typedef tp::AxisController<tp::motors::Bgm5208_200_12, PowerLaw> Large;

// 115200 baud, 8N1, at double speed: 16 MHz / 8 / 17 is 2.1 % fast, which the data sheet allows.
struct Uart {
  Uart() {
    UBRR0 = 16;
    UCSR0A = 1 << U2X0;
    UCSR0B = (1 << RXEN0) | (1 << TXEN0);
    UCSR0C = (1 << UCSZ01) | (1 << UCSZ00);
  }
  bool has_byte() const { return (UCSR0A & (1 << RXC0)) != 0; }
  uint8_t read() const { return UDR0; }
  size_t write(const uint8_t* bytes, size_t size) const {
    for (size_t sent = 0; sent < size; ++sent) {
      while ((UCSR0A & (1 << UDRE0)) == 0) {
      }
      UDR0 = bytes[sent];
    }
    return size;
  }
};

// Timer 1 counts half microseconds in 16 bits; asked at least every 32 ms it gives a time that does not wrap for 71 minutes, and
// differences stay right beyond that.
class Clock {
 public:
  Clock() : last_(0), half_us_(0), us_(0) { TCCR1B = 1 << CS11; }
  uint32_t now_us() {
    const uint16_t count = TCNT1;
    half_us_ += static_cast<uint16_t>(count - last_);
    last_ = count;
    us_ += half_us_ >> 1;
    half_us_ &= 1;
    return us_;
  }

 private:
  uint16_t last_;
  uint32_t half_us_, us_;
};

}  // namespace

int main() {
  const uint32_t request_interval_us = 10000, answer_timeout_us = 30000;
  static tp::GimbalController<Small, Small, Large> gimbal(
      tp::GimbalConfig::standard(), Small::Config::with_gain({24.0f, 4.0f}), Small::Config::with_gain({180.0f, 105.0f}),
      Large::Config::with_gain({40.0f, 2.0f}));
  static tp::SbgcCodec<> codec;
  Uart uart;
  Clock clock;

  uint32_t requested_us = clock.now_us() - request_interval_us, stepped_us = clock.now_us();
  bool is_waiting = false;
  for (;;) {
    const uint32_t now_us = clock.now_us();
    if (is_waiting && now_us - requested_us > answer_timeout_us) {
      codec.send(sbgc::power_and_gain(gimbal.step_silent(static_cast<float>(now_us - stepped_us) * 1e-6f)), uart);
      stepped_us = now_us;
      is_waiting = false;
    }
    if (!is_waiting && now_us - requested_us >= request_interval_us) {
      codec.send(sbgc::Request(sbgc::command::realtime_data_4), uart);
      requested_us = now_us;
      is_waiting = true;
    }
    if (!uart.has_byte()) continue;
    for (bool got = codec.receive(uart.read(), now_us); got; got = codec.next()) {
      const sbgc::RealtimeData* telemetry = codec.realtime_data();
      if (telemetry == nullptr) continue;
      codec.send(sbgc::power_and_gain(gimbal.step(*telemetry, static_cast<float>(now_us - stepped_us) * 1e-6f)), uart);
      stepped_us = now_us;
      is_waiting = false;
    }
  }
}
