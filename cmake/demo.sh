#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Installs what is missing, builds, and runs the main job: a known sim-to-real gap is diagnosed first, then the thesis's motor, the original
# program on a simulated chip, and the thesis's measurements through the models. Each step builds only what it runs, by the preset
# demo, which compiles quickly. Safe to repeat. Results go to build/demo, the programs are in build/demo/bin.
set -eu
cd "$(dirname "$0")/.."
. cmake/packages.sh
# shellcheck disable=SC2086
need_packages $program_packages $library_packages $nano_packages

jobs=${THERMOPOWER_JOBS:-$(nproc)}
export CMAKE_BUILD_PARALLEL_LEVEL="$jobs"
out=build/demo
bin=build/demo/bin
motor=examples/thesis_gap/bgm5208
export NINJA_STATUS="[%f of %t, %e s] "

rm -rf "$out/known_gap" "$out/thesis_gap"
mkdir -p "$out/known_gap" "$out/thesis_gap"

# diagnose <directory> <model> <training> <held out>
diagnose() {
  "$bin/thermopower-gap" diagnose --model "$2" --recording "$3" --heldout "$4" --report "$1/report.json" --html "$1/report.html" \
    --predictions "$1/predictions.csv" --augmented "$1/augmented.json" --header "$1/motor_model.hpp"
}

echo "== Building the diagnosis (the longest part, once)"
cmake --preset demo --log-level=WARNING --no-warn-unused-cli >/dev/null
cmake --build --preset demo --target known_gap thermopower-gap

echo
echo "== 1. Why simulation and motor disagree, where we know it: a copper winding that the simulation takes for constant"
"$bin/known_gap" "$out/known_gap"
diagnose "$out/known_gap" "$out/known_gap/model.json" "$out/known_gap/train.csv" "$out/known_gap/heldout.csv"

echo
echo "== 2. And where we do not: the thesis's BGM5208-200-12 as programmed, fitted on its chapter 4, checked on its chapter 5"
diagnose "$out/thesis_gap" "${motor}_programmed.json" "${motor}_chapter4.csv" "${motor}_chapter5.csv"

echo
echo "== 3. The original program on an ATmega328P, cycle by cycle, against an emulated SimpleBGC board"
cmake --preset avr-nano --log-level=WARNING --no-warn-unused-cli >/dev/null
cmake --build --preset avr-nano --target nano_gimbal
cmake --build --preset demo --target nano_demo
"$bin/nano_demo" --elf build/avr-nano/bin/nano_gimbal.elf --csv "$out/nano_demo.csv" --svg "$out/nano_demo.svg"

echo
echo "== 4. The thesis's measurements, replayed through the models"
cmake --build --preset demo --target thesis_replay
"$bin/thesis_replay" --csv "$out/thesis_replay.csv" --svg "$out/thesis_replay.svg" >"$out/thesis_replay.txt"
echo "RMS and largest error over all tables of each motor, as programmed and with the corrected constants; row by row in $out/thesis_replay.txt"
grep -E '^BG|corrected$|RMSE| all ' "$out/thesis_replay.txt"

echo
echo "Traces:   $out/thesis_replay.csv  $out/nano_demo.csv"
echo "Pictures: $out/thesis_replay.svg  $out/nano_demo.svg"
echo "Reports:  $out/known_gap/report.html  $out/thesis_gap/report.html"
echo
echo "From recordings alone the diagnosis explained the first gap. Of the second it said where it is, and that no cause it knows closes it."
echo "next: $bin/thermopower-gap columns YOUR_LOG  (which column is which), and $bin/thermopower-gap init  (a model file of yours)"
