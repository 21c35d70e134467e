// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Plays the schedule of an experiment on a motor with PWM, and logs what thermopower-gap diagnose reads.
//
//     thermopower-gap design --report report.json --limits limits.json --out schedule.csv --c-array schedule.h
//
// writes schedule.h; put it in the place of the one beside this sketch, which holds a short example. Open a serial line
// (115200 baud), send an s, and store what comes back: examples/desktop_player/player.py does both.
//
//   pin 9   PWM of the driver; pin 8 its direction, high for values below 0
//   A0, A1  thermistors of motor and air: 10 k at 25 degC, beta 3950, to ground, each with 10 k to 5 V
//   A2      current sensor: 2.5 V at no current, 0.185 V per A (ACS712)
#include "schedule.h"

namespace {

// Counts of PWM for a value of the schedule: 1 for power_param; of drive_A or voltage_V what your driver makes of them.
const float counts_per_unit = 1.0f;
const float hottest_C = 80.0f;  // above it the experiment ends; the same as temperature_C of the limits

const uint8_t pwm_pin = 9, direction_pin = 8, motor_pin = A0, air_pin = A1, current_pin = A2;

float thermistor_C(uint8_t pin) {
  const float share = static_cast<float>(analogRead(pin)) / 1023.0f;
  if (!(share > 0.01f) || !(share < 0.99f)) return NAN;  // torn off, or a short circuit
  const float logarithm = static_cast<float>(log(static_cast<double>(share / (1.0f - share))));
  return 1.0f / (1.0f / 298.15f + logarithm / 3950.0f) - 273.15f;
}

float current_A() { return (static_cast<float>(analogRead(current_pin)) * (5.0f / 1023.0f) - 2.5f) / 0.185f; }

float scheduled(uint16_t row, uint8_t input) {
  return schedule_unit[input] *
         static_cast<float>(static_cast<int16_t>(pgm_read_word(&schedule_values[row][input])));
}

void drive(float value) {
  const float counts = (value < 0.0f ? -value : value) * counts_per_unit;
  digitalWrite(direction_pin, value < 0.0f ? HIGH : LOW);
  analogWrite(pwm_pin, counts < 255.0f ? static_cast<int>(counts + 0.5f) : 255);
}

void print_number(float value, uint8_t digits) {
  Serial.print(',');
  if (value == value) Serial.print(static_cast<double>(value), digits);  // an empty cell is a missing sample
}

void play() {
  Serial.print(F("t_s,"));
  Serial.print(schedule_names[0]);
  Serial.println(F(",current_A,motor_C,ambient_C"));
  const uint32_t row_us = static_cast<uint32_t>(schedule_row_s * 1e6f + 0.5f);
  uint32_t due_us = micros();
  uint8_t wrong_rows = 0;  // in a row without a temperature
  for (uint16_t row = 0; row < schedule_rows; ++row) {
    while (static_cast<int32_t>(micros() - due_us) < 0) {
    }
    due_us += row_us;
    const float motor_C = thermistor_C(motor_pin), value = scheduled(row, 0);
    const float current = current_A();
    wrong_rows = motor_C == motor_C ? 0 : static_cast<uint8_t>(wrong_rows + 1);
    if (motor_C > hottest_C || wrong_rows > 3) {
      drive(0.0f);
      Serial.println(F("# stopped: the motor is too hot, or its thermistor is off"));
      return;
    }
    drive(value);
    Serial.print(static_cast<double>(static_cast<float>(row) * schedule_row_s), 3);
    print_number(value, 4);
    print_number(current, 3);
    print_number(motor_C, 2);
    print_number(thermistor_C(air_pin), 2);
    Serial.println();
  }
  drive(0.0f);
  Serial.println(F("# end"));
}

}  // namespace

void setup() {
  pinMode(pwm_pin, OUTPUT);
  pinMode(direction_pin, OUTPUT);
  drive(0.0f);
  Serial.begin(115200);
}

void loop() {
  if (Serial.read() == 's') play();
}
