#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Installs what is missing, builds, and runs the main job: the thesis's measurements through the models, the original program on a
# simulated chip, and the diagnosis of a known and of a real sim-to-real gap. Safe to repeat. Results go to build/demo.
set -eu
cd "$(dirname "$0")/.."
. cmake/packages.sh
# shellcheck disable=SC2086
need_packages $program_packages $nano_packages

jobs=${THERMOPOWER_JOBS:-$(nproc)}
export CMAKE_BUILD_PARALLEL_LEVEL="$jobs"
out=build/demo
bin=build/release/bin
motor=examples/thesis_gap/bgm5208

echo "== Building: two programs for the Nano, four for this computer (some two minutes the first time)"
export NINJA_STATUS="[%f of %t, %e s] "
cmake --preset avr-nano --log-level=WARNING --no-warn-unused-cli -DTHERMOPOWER_TESTS=OFF >/dev/null
cmake --build --preset avr-nano
cmake --preset release --log-level=WARNING --no-warn-unused-cli -DTHERMOPOWER_TESTS=OFF >/dev/null
cmake --build --preset release --target thesis_replay nano_demo known_gap thermopower-gap

rm -rf "$out"
mkdir -p "$out/known_gap" "$out/thesis_gap"

echo
echo "== 1. The thesis's measurements, replayed through the models"
"$bin/thesis_replay" --csv "$out/thesis_replay.csv" --svg "$out/thesis_replay.svg"

echo
echo "== 2. The original program on an ATmega328P, cycle by cycle, against an emulated SimpleBGC board"
"$bin/nano_demo" --elf build/avr-nano/bin/nano_gimbal.elf --csv "$out/nano_demo.csv" --svg "$out/nano_demo.svg"

# diagnose <directory> <model> <training> <held out>
diagnose() {
  "$bin/thermopower-gap" diagnose --model "$2" --recording "$3" --heldout "$4" --report "$1/report.json" --html "$1/report.html" \
    --predictions "$1/predictions.csv" --augmented "$1/augmented.json" --header "$1/motor_model.hpp"
}

echo
echo "== 3. Why simulation and motor disagree, where we know it: a copper winding that the simulation takes for constant"
"$bin/known_gap" "$out/known_gap"
diagnose "$out/known_gap" "$out/known_gap/model.json" "$out/known_gap/train.csv" "$out/known_gap/heldout.csv"

echo
echo "== 4. And where we do not: the thesis's BGM5208-200-12 as programmed, fitted on its chapter 4, checked on its chapter 5"
diagnose "$out/thesis_gap" "${motor}_programmed.json" "${motor}_chapter4.csv" "${motor}_chapter5.csv"

echo
echo "Traces:   $out/thesis_replay.csv  $out/nano_demo.csv"
echo "Pictures: $out/thesis_replay.svg  $out/nano_demo.svg"
echo "Reports:  $out/known_gap/report.html  $out/thesis_gap/report.html"
