// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// replay [<recording>]: replays a run that the sketch recorded (`is_recorded`), from a file or the standard input, and says whether
// this machine answers the same. For a firmware of your own, change the next three lines. Exit status 0: bit for bit, or the same
// decisions with a temperature that differs in its last bits, which expf() of another library makes; 1: something else; 2: it cannot
// be replayed.
#include "pwm_motor.h"
typedef PwmMotor Firmware;
static const char* const answer_names[] = {"demand", "power",
                                           "motor_C"};  // in the order of Firmware::Answered

#include <cstdio>
#include <cstring>

static void print_value(const char* name, uint32_t bits, bool is_float) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  const unsigned long whole = bits;
  if (is_float) std::printf("%s %.9g (bits %08lx)", name, static_cast<double>(value), whole);
  else std::printf("%s %lu", name, whole);
}

int main(int count, char** arguments) {
  std::FILE* const file = count > 1 ? std::fopen(arguments[1], "r") : stdin;
  if (file == nullptr) {
    std::fprintf(stderr, "%s: cannot be opened\n", arguments[1]);
    return 2;
  }
  thermopower::RunReplay<Firmware> replay;
  for (int character; (character = std::fgetc(file)) != EOF;) replay.feed(static_cast<char>(character));

  const thermopower::RunReplayed& result = replay.result();
  if (result.is_other_layout || result.steps == 0) {
    std::fprintf(stderr, "%s\n",
                 result.is_other_layout ? "this is a recording of another firmware"
                                        : "no step of a recorded run: is `is_recorded` true in the sketch?");
    return 2;
  }
  if (result.damaged != 0 || result.lost != 0)
    std::printf("%lu lines damaged, %lu times lines lost\n", static_cast<unsigned long>(result.damaged),
                static_cast<unsigned long>(result.lost));
  if (result.different == 0) {
    std::printf("bit for bit the same over %lu steps\n", static_cast<unsigned long>(result.steps));
    return 0;
  }
  const thermopower::RunDifference& first = result.first;
  std::printf("step %lu is the first that differs, in %s: ", static_cast<unsigned long>(first.step),
              answer_names[first.field - 1]);
  print_value("recorded", first.recorded, first.is_float);
  print_value(", replayed", first.replayed, first.is_float);
  std::printf("\n%lu of %lu answers differ: %lu decisions; floats by %lu units in the last place at most\n",
              static_cast<unsigned long>(result.different), static_cast<unsigned long>(result.steps),
              static_cast<unsigned long>(result.decisions_other),
              static_cast<unsigned long>(result.most_units));
  return result.decisions_other == 0 ? 0 : 1;
}
