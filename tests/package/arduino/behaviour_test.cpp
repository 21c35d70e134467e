// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A sketch built by the Arduino IDE's builder does what the same sketch does when CMake builds it.
#include <algorithm>
#include <cmath>
#include <string>

#include <rig.hpp>

#include "../../catch.hpp"

namespace {

nano::Rig::Truth gusts(double time_s, nano::Rig::Board&) {
  nano::Rig::Truth truth;
  for (int axis = 0; axis < 3; ++axis) truth.angle_deg[axis] = 1.2 * std::sin((1.3 + axis) * time_s);
  truth.camera_air_C = truth.frame_air_C = 45;
  return truth;
}

}  // namespace

TEST_CASE("the IDE's build of a sketch decides as the preset's") {
  const std::string sketch = GENERATE("nano_gimbal", "gimbal_controller");
  nano::Rig by_preset(NANO_PROGRAMS "/" + sketch + ".elf", {}, gusts);
  nano::Rig by_ide(ARDUINO_SKETCHES "/" + sketch + "/" + sketch + ".ino.elf", {}, gusts);
  by_preset.run_until(6);
  by_ide.run_until(6);
  const std::size_t count = std::min(by_preset.updates().size(), by_ide.updates().size());
  REQUIRE(count > 200);
  for (std::size_t index = 0; index < count; ++index) {
    const nano::Update& left = by_preset.updates()[index];
    const nano::Update& right = by_ide.updates()[index];
    // The same telemetry, so the same command. (A cycle more or less may move an answer into the board's next period.)
    if (!std::equal(left.telemetry.imu_angle, left.telemetry.imu_angle + 3, right.telemetry.imu_angle))
      continue;
    CHECK(std::equal(left.power, left.power + 3, right.power));
    CHECK(std::equal(left.p_gain, left.p_gain + 3, right.p_gain));
  }
  CHECK(by_ide.stray_bytes() == 0);
  CHECK(by_ide.chip().elf().static_ram_bytes == by_preset.chip().elf().static_ram_bytes);
}
