// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// ATmega328P in simavr_run: text on the serial port, the exit status in GPIOR0, then asleep for ever.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "report.hpp"

namespace platform {
void start() {
  UBRR0 = 16;
  UCSR0A = 1 << U2X0;
  UCSR0B = 1 << TXEN0;
}
void put(char character) {
  while ((UCSR0A & (1 << UDRE0)) == 0) {
  }
  UDR0 = static_cast<uint8_t>(character);
}
void stop(int status) {
  GPIOR0 = static_cast<uint8_t>(status);
  cli();
  for (;;) sleep_mode();
}
}  // namespace platform
