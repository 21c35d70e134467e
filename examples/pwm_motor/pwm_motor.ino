// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A brushed motor on PWM, its winding kept below 80 degC without a thermometer; no other board is needed.
//
//   pin 9   gate of the motor's driver: a MOSFET with a flyback diode, or the PWM input of a bridge
//   A0      demand: a potentiometer between 5 V and ground
//   A1      supply through 20 k and 10 k, so that 15 V read as 5 V
//
// The Serial Plotter (115200 baud) draws demand and power in counts of 255, and the winding in degC.
#include <thermopower.h>

namespace tp = thermopower;

namespace {

// Measure them on your motor: docs/how-to/custom-motor.md. At a standstill a winding takes V / R, the most that it can.
typedef tp::CurrentModel<tp::OhmicCurrent<> > Current;
typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NewtonCooling<>, tp::ExactStep> Motor;
const Current current({6.0f, 0.00393f, 20.0f});  // 6 ohm at 20 degC, copper
const float limit_C = 80.0f, warmest_air_C = 40.0f;
// 9 J/K, 0.12 W/K. After a reset nobody knows how warm the winding is: as warm as it may be.
Motor motor({{9.0f}, {0.12f}}, limit_C);
tp::SafetyLimiter<> limiter({limit_C, 5.0f, 50.0f});

const uint8_t motor_pin = 9, demand_pin = A0, supply_pin = A1;
const float lowest_V = 5.0f, highest_V = 15.0f;  // of the supply; outside of it the divider is broken
uint8_t power = 0;                               // in force
unsigned long last_ms = 0, last_line_ms = 0;

void print_line(uint8_t demand) {
  Serial.print(F("demand:"));
  Serial.print(demand);
  Serial.print(F(",power:"));
  Serial.print(power);
  Serial.print(F(",motor_C:"));
  Serial.println(static_cast<double>(motor.hottest_C()));
}

}  // namespace

void setup() {
  pinMode(motor_pin, OUTPUT);
  digitalWrite(motor_pin, LOW);
  Serial.begin(115200);
  const bool is_wrong =
      tp::is_error(current.validate()) || tp::is_error(motor.validate()) || tp::is_error(limiter.validate());
  while (is_wrong) {  // the motor stays off
    Serial.println(F("a constant of this sketch is out of its range"));
    delay(1000);
  }
  last_ms = millis();
}

void loop() {
  const unsigned long now_ms = millis();
  if (now_ms - last_ms < 20) return;
  const float dt_s = 0.001f * static_cast<float>(now_ms - last_ms);
  last_ms = now_ms;

  const float read_V = static_cast<float>(analogRead(supply_pin)) * (15.0f / 1023.0f);
  const bool is_supply_known = read_V > lowest_V && read_V < highest_V;
  // What was in force since the last cycle heated the winding; at an unknown supply as much as it can.
  const auto drawn =
      current.at_power(static_cast<float>(power), is_supply_known ? read_V : highest_V, motor.hottest_C());
  motor.step({drawn.winding_power_W, drawn.v_rms_V, {warmest_air_C, 0.0f}}, dt_s);

  const uint8_t demand = static_cast<uint8_t>(is_supply_known ? analogRead(demand_pin) / 4 : 0);
  power = limiter.step({demand, tp::GuardedCelsius::hottest_of(motor), motor.hottest_rate_K_per_s()}, dt_s).power;
  analogWrite(motor_pin, power);

  if (now_ms - last_line_ms < 200) return;
  last_line_ms = now_ms;
  print_line(demand);
}
