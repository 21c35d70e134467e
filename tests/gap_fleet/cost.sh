#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
#
# What a fleet costs beside its diagnoses: logs too short for one, 100 to MOST of them, with one worker and two.
#   cost.sh GENERATE PROGRAM DIR [MOST]

set -eu
generate=$1 program=$2 directory=$3 most=${4:-10000}
echo "| logs | workers | wall, s | the diagnosis alone, ms a log | around it, ms a log | the same again (all done), s |"
echo "| --- | --- | --- | --- | --- | --- |"
count=100
while [ "$count" -le "$most" ]; do
  rm -rf "$directory"
  "$generate" --out "$directory" --units "$count" --tiny
  for workers in 1 2; do
    began=$(date +%s.%N)
    "$program" fleet "$directory/manifest.csv" --out "$directory/out$workers" --workers "$workers" --no-pages >"$directory/told.txt"
    ended=$(date +%s.%N)
    "$program" fleet "$directory/manifest.csv" --out "$directory/out$workers" --workers "$workers" --no-pages >/dev/null
    again=$(date +%s.%N)
    awk -v count="$count" -v workers="$workers" -v began="$began" -v ended="$ended" -v again="$again" '
      /^[0-9]+ diagnoses in / {
        for (i = 1; i <= NF; ++i) if ($i == "with") handed = $(i - 2)
        work = $0; sub(/.*time: /, "", work); sub(/ ms of work.*/, "", work)
      }
      END { printf "| %d | %d | %.1f | %.2f | %.2f | %.2f |\n", count, workers, ended - began, work,
                   (1000 * (ended - began) * workers - work * count) / count, again - ended }' "$directory/told.txt"
  done
  count=$((count * 10))
done
rm -rf "$directory"
