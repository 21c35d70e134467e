#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
#
# Draws a fleet, has it judged while workers and the program itself are killed at random, compares with a run that nobody
# disturbed, byte by byte, and holds the result against the sealed labels.
#   run.sh GENERATE PROGRAM SCORE DIR UNITS SEED [--require WHAT=LEAST]...
# Where Open MPI's mpirun is at hand (MPIRUN names it), the same once more under it, a rank and a worker of another killed.

set -eu
generate=$1 program=$2 score=$3 directory=$4 units=$5 seed=$6
shift 6
rm -rf "$directory"
"$generate" --out "$directory" --seed "$seed" --units "$units"
manifest=$directory/manifest.csv
# Some logs are broken, and a fleet with such logs ends with 3.
fleet() { status=0; "$program" fleet "$manifest" "$@" || status=$?; [ "$status" = 0 ] || [ "$status" = 3 ]; }

echo "--- undisturbed"
began=$(date +%s)
fleet --out "$directory/whole" --workers 2 >"$directory/whole.txt" 2>"$directory/whole.err"
took=$(($(date +%s) - began))
head -2 "$directory/whole.txt"

# Moments that differ from run to run; what is compared must not depend on them. From one part of the undisturbed time to two.
drawn=0
pause() {
  drawn=$((drawn + 1))
  sleep "$(awk -v seed="$$$drawn" -v part="$1" -v took="$took" 'BEGIN { srand(seed); printf "%.2f\n", 0.3 + (1 + rand()) * took / part }')"
}
killed=0
# A log whose worker is killed twice by one run of the program is given up, as it should be: none is hit twice here, however
# long it takes. What a worker has in hand is the log whose lock it holds.
hit=""
kill_one_child() {
  for child in $(ps -o pid= --ppid "$1" 2>/dev/null | shuf); do
    lock=$(find "/proc/$child/fd" -lname '*.lock' -printf '%l' -quit 2>/dev/null || true)
    case " $hit " in *" $lock "*) continue ;; esac
    if [ -n "$lock" ] && kill -9 "$child" 2>/dev/null; then
      hit="$hit $lock" killed=$((killed + 1))
      return
    fi
  done
}

echo "--- workers killed, and the program with them"
round=0 ended=0
while [ "$round" -lt 4 ]; do
  round=$((round + 1))
  "$program" fleet "$manifest" --out "$directory/killed" --workers 2 >"$directory/killed.txt" 2>&1 &
  pid=$! hit=""
  pause 16
  kill_one_child "$pid"
  pause 16
  if [ "$round" -lt 4 ]; then
    if kill -9 "$pid" 2>/dev/null; then ended=$((ended + 1)); fi
  else
    for _ in 1 2 3; do
      kill_one_child "$pid"
      pause 16
    done
  fi
  wait "$pid" 2>/dev/null || true
done
echo "$killed workers and the program $ended times"
[ "$killed" -gt 0 ] && [ "$ended" -gt 0 ]
diff -r "$directory/whole" "$directory/killed"

if [ -n "${MPIRUN:-}" ] && "$MPIRUN" --version 2>/dev/null | grep -q "Open MPI"; then
  echo "--- three ranks under mpirun, one of them killed, and a worker of another"
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  "$MPIRUN" --oversubscribe --enable-recovery -n 3 "$program" fleet "$manifest" --out "$directory/ranks" --workers 1 \
    >"$directory/ranks.txt" 2>&1 &
  pid=$! ranks="" patience=0 killed=0 hit=""
  while [ "$(echo $ranks | wc -w)" -lt 3 ] && [ "$patience" -lt 100 ]; do
    sleep 0.1
    patience=$((patience + 1))
    ranks=$(ps -o pid= --ppid "$pid" 2>/dev/null || true)
  done
  pause 8
  set -- $(echo $ranks | tr ' ' '\n' | shuf) "$@"
  kill -9 "$1"
  pause 8
  # Between two logs a worker holds no lock: another moment, then.
  while [ "$killed" = 0 ] && kill -0 "$2" 2>/dev/null; do
    kill_one_child "$2"
    [ "$killed" -gt 0 ] || sleep 0.05
  done
  shift 3
  wait "$pid" || true
  echo "1 rank and $killed workers"
  [ "$killed" -gt 0 ]
  diff -r "$directory/whole" "$directory/ranks"
fi

echo "--- judged"
sed -n '3,$p' "$directory/whole.txt" | grep -v '^  \(odd\|drift\):' || true
"$score" --labels "$directory/sealed/labels.json" --fleet "$directory/whole/fleet.json" "$@"
