#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Doxygen reads the desk's headers through this: every comment on something at the outermost level gets the group of its folder, at its
# end, so that line numbers stay.
case $1 in
  */gap/effects/*) group=gap_effects ;;
  */gap/catalogue.hpp | */gap/data_gate.hpp | */gap/diagnose.hpp | */gap/diagnosis.hpp | */gap/effect.hpp | */gap/inputs.hpp | \
    */gap/localisation.hpp | */gap/model.hpp | */gap/options.hpp | */gap/recording.hpp | */gap/simulate.hpp | \
    */gap/standard_catalogue.hpp | */gap/terms.hpp) group=gap ;;
  */gap/*) group=gap_engine ;;
  */simulation/*) group=simulation ;;
esac
awk -v group="$group" '
  NR > 1 { print last (last ~ /^\/\/\/ / && last !~ /ingroup/ && $0 !~ /^\/\/\/|^$/ ? " @ingroup " group : "") }
  { last = $0 }
  END { print last }' "$1"
