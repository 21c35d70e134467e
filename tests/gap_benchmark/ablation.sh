#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
#
# Judges the recordings of a benchmark directory with all rules, and those that asked for a rule again without it. A recording that did
# not ask for a rule has the same answer without it.
#   ablation.sh PROGRAM RULES TABLE DIR OUT [REAL]
# PROGRAM is the build of the program that leaves out the rule named in THERMOPOWER_WITHOUT_RULE, RULES prints the rules, TABLE writes
# the page OUT. REAL is a folder of real recordings: <case>/{model.json,train*.csv,heldout*.csv}, and truths.json.

set -eu
if [ $# -lt 5 ]; then
  echo "usage: ablation.sh PROGRAM RULES TABLE DIR OUT [REAL]" >&2
  exit 2
fi
program=$1 rules=$("$2") table=$3 directory=$4 out=$5 real=${6:-}
here=$(dirname "$0")
if [ -n "$real" ]; then
  [ -r "$real/truths.json" ] || { echo "ablation.sh: $real/truths.json is missing" >&2; exit 2; }
  mkdir -p "$directory/real"
  for model in "$real"/*/model.json; do
    name=$(basename "$(dirname "$model")")
    echo "$name $name"
  done >"$directory/real/jobs.txt"
fi
judge() {  # REPORTS JOBS
  GAP_BENCHMARK_REPORTS=$1 GAP_BENCHMARK_JOBS=$2 sh "$here/judge.sh" "$program" "$directory" 2
  [ -z "$real" ] ||
    GAP_BENCHMARK_REPORTS=$1 GAP_BENCHMARK_JOBS=$2 GAP_BENCHMARK_CASES=$real sh "$here/judge.sh" "$program" "$directory/real" 2
}
asked() {  # RULE DIR: the jobs that asked for it
  while read -r job rest; do
    ! grep -q "^asked.* $1\( \|\$\)" "$2/reports/$job/summary.txt" || echo "$job $rest"
  done <"$2/jobs.txt"
}
unset THERMOPOWER_WITHOUT_RULE || true
judge reports jobs.txt
for rule in $rules; do
  THERMOPOWER_WITHOUT_RULE=$rule
  export THERMOPOWER_WITHOUT_RULE
  asked "$rule" "$directory" >"$directory/asked.txt"
  [ -z "$real" ] || asked "$rule" "$directory/real" >"$directory/real/asked.txt"
  echo "without $rule: $(wc -l <"$directory/asked.txt") recordings" >&2
  judge "reports_without_$rule" asked.txt
done
unset THERMOPOWER_WITHOUT_RULE
# shellcheck disable=SC2086  # names without blanks
if [ -n "$real" ]; then "$table" --dir "$directory" --out "$out" --real "$real" $rules
else "$table" --dir "$directory" --out "$out" $rules
fi
