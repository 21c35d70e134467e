#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
#
# Draws cases, judges them on two cores, and prints one screen.
#   quick.sh BIN DIR [OPTIONS OF gap_benchmark_generate]
# BIN holds thermopower-gap, gap_benchmark_generate and gap_benchmark_score. A directory that is there already is judged
# anew and not drawn.
#   quick.sh build/release/bin /tmp/loops --part closed_loops --count 40 --seed 3

set -eu
if [ $# -lt 2 ]; then
  echo "usage: quick.sh BIN DIR [OPTIONS OF gap_benchmark_generate]" >&2
  exit 2
fi
bin=$1 directory=$2
shift 2
[ -r "$directory/jobs.txt" ] || "$bin/gap_benchmark_generate" --out "$directory" "$@" >"$directory.drawn" 2>&1 || {
  tail -n 5 "$directory.drawn" >&2
  [ -r "$directory/jobs.txt" ] || exit 1
}
rm -f "$directory.drawn"
sh "$(dirname "$0")/judge.sh" "$bin/thermopower-gap" "$directory" 2
"$bin/gap_benchmark_score" --dir "$directory" --brief yes
