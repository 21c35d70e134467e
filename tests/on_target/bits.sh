#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# bits.sh: prints the table of docs/how-to/record-a-run.md: which laws answer the same bits on three chips as on the PC. Run it from the
# repository's root with what the presets avr-nano, cortex-m0 and cortex-m4f need. Takes about two minutes.
set -e
build=${TMPDIR:-/tmp}/thermopower-bits
mkdir -p "$build"

# measure <column> <preset> [<option of cmake>...]: one file of "section, values, different, millionths"
measure() {
  column=$1 preset=$2
  shift 2
  cmake --preset "$preset" -B "$build/$column" --log-level=ERROR "$@" > "$build/$column.log"
  cmake --build "$build/$column" --target vectors_parts vectors_whole vectors_fixed vectors_wire >> "$build/$column.log"
  case $preset in
    avr-nano) set -- "$build/$column/host/bin/simavr_run" ;;
    cortex-m0) set -- qemu-system-arm -M microbit ;;
    *) set -- qemu-system-arm -M mps2-an386 ;;
  esac
  [ "$preset" = avr-nano ] ||
    set -- "$@" -nographic -monitor none -serial none -semihosting-config enable=on,target=native -kernel
  for part in parts fixed whole wire; do
    "$build/$column/host/bin/compare_vectors" --bits "$build/$column/host/bin/vectors_${part}_pc" "$@" "$build/$column/bin/vectors_$part.elf"
  done > "$build/$column.tsv"
}
measure 1-avr avr-nano
measure 2-m0 cortex-m0
measure 3-m4f cortex-m4f -DCMAKE_CXX_FLAGS_MINSIZEREL="-Os -DNDEBUG -ffp-contract=off"
measure 4-m4f-fused cortex-m4f

awk -F '\t' '
  FNR == 1 { ++column }
  !($1 in values) { order[++sections] = $1 }
  column == 1 { values[$1] += $2 }
  { different[$1, column] += $3; if ($4 > most[$1, column]) most[$1, column] = $4; if ($3 > 0) is_other[$1] = 1 }
  END {
    print "| law | values | ATmega328P | Cortex-M0 | Cortex-M4F, `-ffp-contract=off` | Cortex-M4F, default flags |"
    print "|---|---|---|---|---|---|"
    for (i = 1; i <= sections; ++i) {
      if (!(order[i] in is_other)) {
        alike = alike (alike == "" ? "" : ", ") order[i]
        all += values[order[i]]
        continue
      }
      line = "| " order[i] " | " values[order[i]] " |"
      for (j = 1; j <= column; ++j)
        line = line (different[order[i], j] == 0 ? " same |" : sprintf(" %d differ, by %.1g ppm |", different[order[i], j], most[order[i], j]))
      print line
    }
    print "| " alike " | " all " | same | same | same | same |"
  }' "$build"/*.tsv
