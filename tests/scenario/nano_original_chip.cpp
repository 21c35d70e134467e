// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The original's arithmetic on the original's chip: telemetry in by the serial port, decisions out.
// nano_original_chip.hpp is the other end.
#include <avr/io.h>
#include <string.h>

#include "nano_original.hpp"

namespace {

uint8_t get() {
  while ((UCSR0A & (1 << RXC0)) == 0) {
  }
  return UDR0;
}

void put(uint8_t byte) {
  while ((UCSR0A & (1 << UDRE0)) == 0) {
  }
  UDR0 = byte;
}

uint16_t get_u16() {
  const uint8_t low = get();
  return static_cast<uint16_t>(low | static_cast<uint16_t>(get()) << 8);
}

}  // namespace

int main() {
  UBRR0 = 16;
  UCSR0A = 1 << U2X0;
  UCSR0B = (1 << RXEN0) | (1 << TXEN0);
  original::Program<float> program;
  static thermopower::sbgc::RealtimeFields telemetry;
  for (;;) {
    for (uint8_t axis = 0; axis < 3; ++axis) telemetry.imu_angle[axis] = static_cast<int16_t>(get_u16());
    for (uint8_t axis = 0; axis < 3; ++axis) telemetry.target_angle[axis] = static_cast<int16_t>(get_u16());
    telemetry.battery_cV = get_u16();
    telemetry.imu_C = static_cast<int8_t>(get());
    telemetry.frame_imu_C = static_cast<int8_t>(get());
    uint32_t micros = get_u16();
    micros |= static_cast<uint32_t>(get_u16()) << 16;
    const original::Decision decision = program.update(telemetry, micros);
    put(decision.is_sent ? 1 : 0);
    for (uint8_t axis = 0; axis < 3; ++axis) {
      const float motor_C = program.motor_C(axis);
      uint8_t bytes[sizeof motor_C];
      memcpy(bytes, &motor_C, sizeof motor_C);
      put(decision.power[axis]);
      put(decision.p_gain[axis]);
      for (uint8_t byte : bytes) put(byte);
    }
  }
}
