#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
#
# Draws a fleet, has it judged while workers and the program itself are killed at random, compares with a run that nobody
# disturbed, byte by byte, and holds the result against the sealed labels.
#   run.sh GENERATE PROGRAM SCORE DIR UNITS SEED [--require WHAT=LEAST]...
# Where Open MPI's mpirun is at hand (MPIRUN names it), the same once more under it, one of its ranks killed.

set -eu
generate=$1 program=$2 score=$3 directory=$4 units=$5 seed=$6
shift 6
rm -rf "$directory"
"$generate" --out "$directory" --seed "$seed" --units "$units"
manifest=$directory/manifest.csv
# Some logs are broken, and a fleet with such logs ends with 3.
fleet() { status=0; "$program" fleet "$manifest" "$@" || status=$?; [ "$status" = 0 ] || [ "$status" = 3 ]; }

echo "--- undisturbed"
fleet --out "$directory/whole" --workers 2 >"$directory/whole.txt" 2>"$directory/whole.err"
head -2 "$directory/whole.txt"

echo "--- killed"
# Moments that differ from run to run; what is compared must not depend on them.
moment() { awk -v seed="$$$1" 'BEGIN { srand(seed); printf "%.2f\n", 0.3 + 1.5 * rand() }'; }
round=0
while [ "$round" -lt 4 ]; do
  round=$((round + 1))
  "$program" fleet "$manifest" --out "$directory/killed" --workers 2 >"$directory/killed.txt" 2>&1 &
  pid=$!
  sleep "$(moment "$round")"
  worker=$(ps -o pid= --ppid "$pid" 2>/dev/null | head -1 || true)
  if [ -n "$worker" ]; then kill -9 $worker 2>/dev/null || true; fi
  sleep "$(moment "1$round")"
  if [ "$round" -lt 4 ]; then
    kill -9 "$pid" 2>/dev/null || true
  fi
  wait "$pid" 2>/dev/null || true
done
diff -r "$directory/whole" "$directory/killed"

if [ -n "${MPIRUN:-}" ] && "$MPIRUN" --version 2>/dev/null | grep -q "Open MPI"; then
  echo "--- three ranks under mpirun, one of them killed"
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  "$MPIRUN" --oversubscribe --enable-recovery -n 3 "$program" fleet "$manifest" --out "$directory/ranks" --workers 1 \
    >"$directory/ranks.txt" 2>&1 &
  pid=$!
  rank="" patience=0
  while [ -z "$rank" ] && [ "$patience" -lt 100 ]; do
    sleep 0.1
    patience=$((patience + 1))
    rank=$(ps -o pid= --ppid "$pid" 2>/dev/null | head -1 || true)
  done
  sleep "$(moment 20)"
  kill -9 $rank
  wait "$pid" || true
  diff -r "$directory/whole" "$directory/ranks"
fi

echo "--- judged"
sed -n '3,$p' "$directory/whole.txt" | grep -v '^  \(odd\|drift\):' || true
"$score" --labels "$directory/sealed/labels.json" --fleet "$directory/whole/fleet.json" "$@"
