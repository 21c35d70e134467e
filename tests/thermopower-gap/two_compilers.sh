#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Builds the program with GCC and with Clang, diagnoses the same recordings with both, and compares the reports: the same words, and
# numbers equal to a millionth. Takes two builds of the program.
#   sh two_compilers.sh SOURCE FOLDER
set -eu
source=$(cd "$1" && pwd)
mkdir -p "$2"
folder=$(cd "$2" && pwd)
for compiler in ${GCC:-g++} ${CLANG:-clang++}; do
  name=$(basename "$compiler")
  cmake -S "$source" -B "$folder/$name" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
    -DTHERMOPOWER_TESTS=OFF >/dev/null
  cmake --build "$folder/$name" --target thermopower-gap known_gap raw_logs
  bin=$folder/$name/bin
  # The recordings are those of the first program: a random number of another library would be another recording.
  [ -d "$folder/data" ] || { mkdir "$folder/data" && "$bin/known_gap" "$folder/data" && "$bin/raw_logs" "$folder/data"; }
  mkdir -p "$folder/$name/reports"
  (
    cd "$folder/data"
    diagnose() { "$bin/thermopower-gap" diagnose --report "$folder/$name/reports/$1.json" --model "$2" --recording "$3" $4 >/dev/null; }
    diagnose known_gap model.json train.csv "--heldout heldout.csv"
    diagnose hotend hotend.json klippy.log "--column motor_C=extruder.temp --column power_param=extruder.pwm:1 --ambient 24"
    diagnose bed bed.json serial.log "--rate 1 --column motor_C=B --column power_param=B@:127 --ambient 24"
    diagnose joint joint.json moteus.csv \
      "--column t_s=timestamp --column angle_deg=position:rev --column rate_dps=velocity:rev/s --column drive_A=q_current:A"
  )
done
failed=0
for report in "$folder/$(basename "${GCC:-g++}")"/reports/*.json; do
  echo "== $(basename "$report")"
  python3 -B "$source/tests/thermopower-gap/compare_numbers.py" "$report" "$folder/$(basename "${CLANG:-clang++}")/reports/$(basename "$report")" || failed=1
done
exit $failed
