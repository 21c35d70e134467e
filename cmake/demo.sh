#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Installs what is missing, builds, and runs the main job: the thesis's measurements through the models, the original program on a
# simulated chip, and the diagnosis of one motor's sim-to-real gap. Safe to repeat. Results go to build/demo.
set -eu
cd "$(dirname "$0")/.."
. cmake/packages.sh
# shellcheck disable=SC2086
need_packages $program_packages $nano_packages

jobs=${THERMOPOWER_JOBS:-$(nproc)}
export CMAKE_BUILD_PARALLEL_LEVEL="$jobs"
out=build/demo
bin=build/release/bin
mkdir -p "$out/thesis_gap"
motor=examples/thesis_gap/bgm5208

echo "== building (nano program, desktop programs)"
cmake --preset avr-nano --log-level=WARNING -DTHERMOPOWER_TESTS=OFF
cmake --build --preset avr-nano
cmake --preset release --log-level=WARNING -DTHERMOPOWER_TESTS=OFF
cmake --build --preset release --target thesis_replay nano_demo thermopower-gap

echo
echo "== 1. The thesis's measurements, replayed through the models"
"$bin/thesis_replay" --csv "$out/thesis_replay.csv" --svg "$out/thesis_replay.svg"

echo
echo "== 2. The original program on an ATmega328P, cycle by cycle, against an emulated SimpleBGC board"
"$bin/nano_demo" --elf build/avr-nano/bin/nano_gimbal.elf --csv "$out/nano_demo.csv" --svg "$out/nano_demo.svg"

echo
echo "== 3. Why model and motor disagree: the BGM5208-200-12 as programmed, fitted on chapter 4, checked on chapter 5"
"$bin/thermopower-gap" diagnose --model "${motor}_programmed.json" \
  --recording "${motor}_chapter4.csv" --heldout "${motor}_chapter5.csv" \
  --report "$out/thesis_gap/report.json" --html "$out/thesis_gap/report.html" \
  --predictions "$out/thesis_gap/predictions.csv" --augmented "$out/thesis_gap/augmented.json" --header "$out/thesis_gap/motor_model.hpp"

echo
echo "Traces:   $out/thesis_replay.csv  $out/nano_demo.csv"
echo "Pictures: $out/thesis_replay.svg  $out/nano_demo.svg"
echo "Report:   $out/thesis_gap/report.html"
