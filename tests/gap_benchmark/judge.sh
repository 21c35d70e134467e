#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
#
# Runs the diagnosis on every job of a benchmark directory, through files only. It knows the cases and nothing of sealed/.
#   judge.sh PROGRAM DIR [JOBS_AT_ONCE]
# Each job leaves DIR/reports/JOB/{report.json,predictions.csv,summary.txt,errors.txt,status}; status holds the exit
# status, the seconds it took by the clock, and the seconds of processor time.

set -eu

if [ "$1" = --one ]; then
  program=$2 directory=$3 job=$4 case=$5
  shift 5
  case=${GAP_BENCHMARK_CASES:-$directory/cases}/$case
  out=$directory/${GAP_BENCHMARK_REPORTS:-reports}/$job
  mkdir -p "$out"
  rm -f "$out"/*
  options=""
  for id; do
    options="$options --without $id"
  done
  logs=""
  for log in "$case"/train*.csv; do
    logs="$logs --recording $log"
  done
  for log in "$case"/heldout*.csv; do
    [ -r "$log" ] && logs="$logs --heldout $log"
  done
  began=$(date +%s.%N)
  status=0
  # shellcheck disable=SC2086  # neither ids nor paths hold blanks
  timeout 300 "$program" diagnose --model "$case/model.json" $logs \
    --report "$out/report.json" --predictions "$out/predictions.csv" $options >"$out/summary.txt" 2>"$out/errors.txt" || status=$?
  ended=$(date +%s.%N)
  # The second line of `times` is what the children took, user and system, as 0m1.23s.
  times >"$out/times"
  {
    echo "$status"
    echo "$ended $began" | awk '{ printf "%.2f\n", $1 - $2 }'
    awk 'NR == 2 { sum = 0; for (i = 1; i <= 2; ++i) { split($i, part, "m"); sum += 60 * part[1] + part[2] }; printf "%.2f\n", sum }' "$out/times"
  } >"$out/status"
  rm -f "$out/times"
  exit 0
fi

if [ $# -lt 2 ]; then
  echo "usage: judge.sh PROGRAM DIR [JOBS_AT_ONCE]" >&2
  exit 2
fi
program=$1 directory=$2 at_once=${3:-2}
[ -x "$program" ] || { echo "judge.sh: $program is no program" >&2; exit 2; }
jobs=$directory/${GAP_BENCHMARK_JOBS:-jobs.txt}
[ -r "$jobs" ] || { echo "judge.sh: $jobs is missing" >&2; exit 2; }
mkdir -p "$directory/${GAP_BENCHMARK_REPORTS:-reports}"
# One line of it is one run; a line's words become arguments.
xargs -P "$at_once" -r -L 1 sh "$0" --one "$program" "$directory" <"$jobs"
