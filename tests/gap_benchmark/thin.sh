#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
#
# Makes a benchmark directory of another one: the recordings of axes in rows of at most LONGEST seconds, as a logger has them that
# keeps each Nth row. What was commanded in between is lost. Jobs with a cause taken out of the catalogue are left out.
#   thin.sh FROM TO N LONGEST

set -eu

if [ $# -ne 4 ]; then
  echo "usage: thin.sh FROM TO N LONGEST" >&2
  exit 2
fi
from=$1 to=$2 kept=$3 longest=$4
[ -r "$from/jobs.txt" ] || { echo "thin.sh: $from/jobs.txt is missing" >&2; exit 2; }
[ ! -e "$to" ] || { echo "thin.sh: $to is there already" >&2; exit 2; }
mkdir -p "$to/cases"
cp -r "$from/sealed" "$to/sealed"
awk 'NF == 2' "$from/jobs.txt" | while read -r job case; do
  # The median of the first intervals: stamps may jitter, and pause.
  is_fast=$(awk -F, -v longest="$longest" '
    NR == 1 { drive = index("," $0 ",", ",drive_A,") > 0; next }
    NR > 2 && NR < 60 && $1 > last { step[++count] = $1 - last }
    { last = $1 }
    NR == 60 { exit }
    END {
      for (i = 1; i <= count; ++i) {
        below = 0
        for (k = 1; k <= count; ++k) below += step[k] <= step[i]
        if (2 * below >= count && (!median || step[i] < median)) median = step[i]
      }
      print (drive && median <= longest) ? 1 : 0
    }' "$from/cases/$case/train.csv")
  [ "$is_fast" = 1 ] || continue
  mkdir -p "$to/cases/$case"
  cp "$from/cases/$case/model.json" "$to/cases/$case/"
  for part in train heldout; do
    awk -v kept="$kept" 'NR == 1 || (NR - 2) % kept == 0' "$from/cases/$case/$part.csv" >"$to/cases/$case/$part.csv"
  done
  echo "$job $case" >>"$to/jobs.txt"
done
