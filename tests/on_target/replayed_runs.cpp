// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Replays a run of tests/data/runs/, which the build puts into this program, and fails unless this machine answers as the one that
// recorded it. `allowed_units` is how far its floats may be apart, in units in the last place; decisions never may.
#include <thermopower/detail/flash.hpp>

#include "recorded_firmware.hpp"
#include "recording.hpp"
#include "report.hpp"

int main() {
  platform::start();
  static thermopower::RunReplay<on_target::recorded_firmware> replay;
  for (uint16_t at = 0; at + 1u < sizeof recording; ++at)
    replay.feed(
        static_cast<char>(thermopower::detail::read_flash(reinterpret_cast<const uint8_t*>(recording) + at)));
  const thermopower::RunReplayed& result = replay.result();
  on_target::Report report;
  report.section("steps, different, other decisions, units, first different, its field, damaged, lost");
  report.integer(static_cast<int32_t>(result.steps));
  report.integer(static_cast<int32_t>(result.different));
  report.integer(static_cast<int32_t>(result.decisions_other));
  report.integer(static_cast<int32_t>(result.most_units));
  report.integer(static_cast<int32_t>(result.first.step));
  report.integer(static_cast<int32_t>(result.first.field));
  report.integer(static_cast<int32_t>(result.damaged));
  report.integer(static_cast<int32_t>(result.lost));
  const bool is_whole =
      result.steps == 200 && result.damaged == 0 && result.lost == 0 && !result.is_other_layout;
  platform::stop(is_whole && result.decisions_other == 0 && result.most_units <= allowed_units ? 0 : 1);
}
