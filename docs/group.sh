#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Doxygen reads the desk's headers through this: every comment on something at the outermost level gets the group of its folder, at its
# end, so that line numbers stay.
case $1 in
  */plant/effects/*) group=gap_effects ;;
  */plant/catalogue.hpp | */plant/effect.hpp | */plant/standard_catalogue.hpp | */plant/terms.hpp | \
    */gap/data/inputs.hpp | */gap/localise/localisation.hpp) group=gap ;;
  */plant/* | */gap/*/*) group=gap_engine ;;
  */gap/*) group=gap ;;
  */simulation/*) group=simulation ;;
esac
awk -v group="$group" '
  NR > 1 { print last (last ~ /^\/\/\/ / && last !~ /ingroup/ && $0 !~ /^\/\/\/|^$/ ? " @ingroup " group : "") }
  { last = $0 }
  END { print last }' "$1"
