// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The sketch for a motor on PWM, on a simulated chip: a winding of its declaration, integrated here, stays below the limit.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>

#include <simulated_chip.hpp>

#include "../../examples/pwm_motor/pwm_motor.h"
#include "../catch.hpp"

namespace {

constexpr double limit_C = 80.0, air_C = 40.0;

/// A Nano with the sketch, a potentiometer, a supply, and a winding that heats at what the pin says.
class Bench {
public:
  Bench() : chip_(NANO_PROGRAMS "/pwm_motor.elf") {
    chip_.on_transmit = [this](std::uint64_t, std::uint8_t byte) {
      if (byte == '\n') last_line_ = std::exchange(line_, {});
      else if (byte != '\r') line_ += static_cast<char>(byte);
    };
  }

  /// Runs on. @param supply_V  that heats  @param read_V  that pin A1 is told
  void run(double seconds, double demand_share, double supply_V, double read_V) {
    chip_.set_analog(0, static_cast<std::uint32_t>(5000.0 * demand_share));
    chip_.set_analog(1, static_cast<std::uint32_t>(1000.0 * read_V / 3.0));
    constexpr double h = 0.01;
    for (const double end_s = time_s_ + seconds; time_s_ < end_s; time_s_ += h) {
      chip_.run_until(static_cast<std::uint64_t>((time_s_ + h) * 16e6));
      const double resistance = 6.0 * (1.0 + 0.00393 * (winding_C_ - 20.0));
      const double heat_W = duty() * supply_V * supply_V / resistance;
      winding_C_ += h * (heat_W - 0.12 * (winding_C_ - air_C)) / 9.0;
      hottest_C_ = std::fmax(hottest_C_, winding_C_);
    }
  }

  /// What pin 9 (OC1A, port B bit 1) drives: a compare value while the timer owns the pin, else its level.
  double duty() const {
    const bool by_timer = (chip_.data(0x80) & 0x80) != 0;  // COM1A1 of TCCR1A
    if (by_timer) return chip_.data(0x88) / 255.0;         // OCR1AL
    return (chip_.data(0x25) & 0x02) != 0 ? 1.0 : 0.0;     // PORTB
  }
  /// What a field of the last line said.
  double told(const std::string& field) const {
    const std::size_t at = last_line_.find(field + ":");
    return at == std::string::npos ? std::nan("") : std::atof(last_line_.c_str() + at + field.size() + 1);
  }
  double hottest_C() const { return hottest_C_; }
  double winding_C() const { return winding_C_; }

private:
  nano::SimulatedChip chip_;
  std::string line_, last_line_;
  double time_s_ = 0.0, winding_C_ = limit_C, hottest_C_ = limit_C;
};

}  // namespace

TEST_CASE("a run that the sketch records on the chip replays here") {
  nano::SimulatedChip chip(NANO_PROGRAMS "/pwm_motor_recorded.elf");
  thermopower::RunReplay<PwmMotor> replay;
  chip.on_transmit = [&](std::uint64_t, std::uint8_t byte) { replay.feed(static_cast<char>(byte)); };
  // The potentiometer is turned, and the supply's wire comes off.
  for (int second = 1; second <= 8; ++second) {
    chip.set_analog(0, second % 3 == 0 ? 900u : 5000u);
    chip.set_analog(1, second == 5 ? 0u : 4000u);
    chip.run_until(static_cast<std::uint64_t>(second) * 16000000u);
  }
  CHECK(replay.result().steps > 350);
  CHECK(replay.result().damaged == 0);
  CHECK(replay.result().lost == 0);
  CHECK(replay.result().decisions_other == 0);
  CHECK(replay.result().most_units <= 16);  // expf() is the library's of each machine
}

TEST_CASE("a motor on PWM that starts as warm as it may be stays below its limit at full demand") {
  Bench bench;
  bench.run(12.0, 1.0, 12.0, 12.0);
  CHECK(bench.hottest_C() < limit_C + 0.6);  // of the rise between two cycles at full power
  CHECK(bench.told("demand") == 255);
  CHECK(bench.told("motor_C") == Approx(bench.winding_C()).margin(0.3));
  // 4.8 W leave a winding at the limit: power is far from full and far from none.
  CHECK(bench.duty() > 0.02);
  CHECK(bench.duty() < 0.5);
}

TEST_CASE(
    "a demand of nothing switches the motor off, and a small one is granted once the winding has cooled") {
  Bench bench;
  bench.run(1.0, 0.0, 12.0, 12.0);
  CHECK(bench.duty() == 0.0);
  bench.run(6.0, 0.1, 12.0, 12.0);
  CHECK(bench.told("power") == bench.told("demand"));
  CHECK(bench.duty() == Approx(0.1).margin(0.01));
}

TEST_CASE(
    "a supply that cannot be read gives no power, and what flows meanwhile counts as the most that can") {
  Bench bench;
  bench.run(2.0, 0.1, 12.0, 12.0);
  REQUIRE(bench.duty() > 0.05);
  const double wire_off_V = GENERATE(0.0, 15.0);
  bench.run(0.5, 0.1, 12.0, wire_off_V);
  CHECK(bench.duty() == 0.0);
  CHECK(bench.told("motor_C") >= bench.winding_C() - 0.3);
}
