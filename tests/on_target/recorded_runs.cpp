// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Prints recorded runs as tests/data/runs/ holds them: a gimbal at work with every fault on the way, and a motor on PWM. Those were
// recorded by this program on the ATmega328P: `simavr_run recorded_runs_gimbal.elf > tests/data/runs/gimbal.txt`.
#include "recorded_firmware.hpp"
#include "report.hpp"

namespace {

struct Wire {
  size_t write(const uint8_t* bytes, size_t count) {
    for (size_t i = 0; i < count; ++i) platform::put(static_cast<char>(bytes[i]));
    return count;
  }
};

uint16_t noise() {
  static uint32_t state = 20260101;
  state = state * 1664525u + 1013904223u;
  return static_cast<uint16_t>(state >> 16);
}

uint8_t in_force[3] = {1, 1, 1};

template <class Told>
void tell(Told& told, uint16_t step) {
  told.passed_ms = static_cast<uint16_t>(step % 50 == 49 ? 700 : 20 + (noise() & 3));
  told.supply_counts = static_cast<uint16_t>(step % 90 > 85 ? noise() & 1023 : 810 + (noise() & 15));
  told.demand_counts = static_cast<uint16_t>(step % 100 < 70 ? 1000 + (noise() & 15) : noise() & 511);
}
template <>
inline void tell(on_target::RecordedGimbal::Told& told, uint16_t step) {
  told.is_silent = step % 40 > 36 ? 1 : 0;
  for (uint8_t axis = 0; axis < 3; ++axis) {
    told.imu_angle[axis] = static_cast<uint16_t>(noise() & 63);
    told.target_angle[axis] = static_cast<uint16_t>(told.imu_angle[axis] + (step < 90 ? 400 : noise() & 127));
    told.motor_power[axis] = step % 70 > 60 ? static_cast<uint8_t>(noise()) : in_force[axis];
  }
  told.camera_C = static_cast<uint8_t>(step < 120 ? 24 : (step < 140 ? 90 : 31));
  told.frame_C = static_cast<uint8_t>(step % 50 == 7 ? 0 : 25);
  told.battery_cV = static_cast<uint16_t>(step % 60 == 59 ? 100 : (step > 150 && step < 160 ? 1680 : 1230));
  told.ticks = static_cast<uint16_t>(step % 33 == 32 ? 30000 : 110 + (noise() & 15));
}
template <class Answered>
void act(const Answered&) {}
template <>
inline void act(const on_target::RecordedGimbal::Answered& answered) {
  for (uint8_t axis = 0; axis < 3; ++axis) in_force[axis] = answered.power[axis];
}

template <class Firmware>
void record(Wire& wire, uint16_t steps) {
  Firmware firmware;
  thermopower::RunWriter<Wire> writer(wire);
  writer.begin(typename Firmware::Told(), typename Firmware::Answered());
  for (uint16_t step = 0; step < steps; ++step) {
    typename Firmware::Told told = typename Firmware::Told();
    tell(told, step);
    const typename Firmware::Answered answered = firmware.step(told);
    act(answered);
    writer.step(told, answered);
  }
}

}  // namespace

int main() {
  platform::start();
  Wire wire;
  record<on_target::recorded_firmware>(wire, 200);
  platform::stop(0);
}
