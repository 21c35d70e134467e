// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A brushed motor on PWM, its winding kept below 80 degC without a thermometer; no other board is needed.
//
//   pin 9   gate of the motor's driver: a MOSFET with a flyback diode, or the PWM input of a bridge
//   A0      demand: a potentiometer between 5 V and ground
//   A1      supply through 20 k and 10 k, so that 15 V read as 5 V
//
// The Serial Plotter (115200 baud) draws demand and power in counts of 255, and the winding in degC. With `is_recorded` true the port
// carries a recorded run instead, which replay.cpp replays on a PC.
#include <thermopower.h>

#include "pwm_motor.h"

#ifndef pwm_motor_is_recorded
#define pwm_motor_is_recorded false
#endif

namespace {

const bool is_recorded = pwm_motor_is_recorded;

PwmMotor motor;
const uint8_t motor_pin = 9, demand_pin = A0, supply_pin = A1;
thermopower::RunWriter<decltype(Serial)> recorder(Serial);
unsigned long last_ms = 0, last_line_ms = 0;

void print_line(const PwmMotor::Answered& answered) {
  Serial.print(F("demand:"));
  Serial.print(answered.demand);
  Serial.print(F(",power:"));
  Serial.print(answered.power);
  Serial.print(F(",motor_C:"));
  Serial.println(static_cast<double>(answered.motor_C));
}

}  // namespace

void setup() {
  pinMode(motor_pin, OUTPUT);
  digitalWrite(motor_pin, LOW);
  Serial.begin(115200);
  while (motor.is_wrong()) {  // the motor stays off
    Serial.println(F("a constant of this sketch is out of its range"));
    delay(1000);
  }
  if (is_recorded) recorder.begin(PwmMotor::Told(), PwmMotor::Answered());
  last_ms = millis();
}

void loop() {
  const unsigned long now_ms = millis();
  const unsigned long passed_ms = now_ms - last_ms;
  if (passed_ms < 20) return;
  last_ms = now_ms;

  const PwmMotor::Told told = {static_cast<uint16_t>(passed_ms < 65535 ? passed_ms : 65535),
                               static_cast<uint16_t>(analogRead(supply_pin)),
                               static_cast<uint16_t>(analogRead(demand_pin))};
  const PwmMotor::Answered answered = motor.step(told);
  analogWrite(motor_pin, answered.power);

  if (is_recorded) recorder.step(told, answered);
  if (is_recorded || now_ms - last_line_ms < 200) return;
  last_line_ms = now_ms;
  print_line(answered);
}
