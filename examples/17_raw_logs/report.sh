# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# What the scripts beside this file share: report LOG MODEL [options of diagnose ...] writes the raw logs and makes a page of one of them.
#   sh klipper.sh [FOLDER]     THERMOPOWER_BIN says where the programs are, else build/release/bin
set -eu
bin=${THERMOPOWER_BIN:-build/release/bin}
out=${1:-build/raw_logs}
mkdir -p "$out"
"$bin/raw_logs" "$out" >/dev/null

report() {
  log=$1 model=$2
  shift 2
  page=$out/$(basename "$0" .sh).html
  "$bin/thermopower-gap" diagnose --model "$out/$model" --recording "$out/$log" "$@" --html "$page"
  grep -q '<svg' "$page"
  echo "figure: $page"
}
