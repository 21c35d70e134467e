// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// replay [<recording>]: replays a run that the sketch recorded (`is_recorded`), from a file or the standard input, and says whether
// this machine answers the same. Exit status 0: bit for bit, or the same decisions with a temperature that differs in its last bits,
// which expf() of another library makes; 1: something else; 2: it cannot be replayed.
#include "pwm_motor.h"

#include <cstdio>

int main(int count, char** arguments) {
  std::FILE* const file = count > 1 ? std::fopen(arguments[1], "r") : stdin;
  if (file == nullptr) {
    std::fprintf(stderr, "%s: cannot be opened\n", arguments[1]);
    return 2;
  }
  thermopower::RunReplay<PwmMotor> replay;
  for (int character; (character = std::fgetc(file)) != EOF;) replay.feed(static_cast<char>(character));

  const thermopower::RunReplayed& result = replay.result();
  if (result.is_other_layout || result.steps == 0) {
    std::fprintf(stderr, "%s\n",
                 result.is_other_layout ? "this is a recording of another firmware"
                                        : "no step of a recorded run: is `is_recorded` true in the sketch?");
    return 2;
  }
  std::printf("%lu steps replayed, %lu lines damaged, %lu times lines lost\n",
              static_cast<unsigned long>(result.steps), static_cast<unsigned long>(result.damaged),
              static_cast<unsigned long>(result.lost));
  if (result.different == 0) {
    std::printf("every answer is the same, bit for bit\n");
    return 0;
  }
  std::printf(
      "%lu answers differ, the first in step %lu: %lu decisions; temperatures by %lu units in the last place at most\n",
      static_cast<unsigned long>(result.different), static_cast<unsigned long>(result.first_different),
      static_cast<unsigned long>(result.decisions_other), static_cast<unsigned long>(result.most_units));
  return result.decisions_other == 0 ? 0 : 1;
}
