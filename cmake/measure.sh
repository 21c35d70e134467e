#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
#
# Prints how large the diagnosis is and what it costs to compile: one line for each room, then the whole.
#   sh cmake/measure.sh [OTHER_CHECKOUT]     with a second checkout, its figures stand beside
# Lines are all lines of the headers. A threshold is a number with a value in a struct, or a constant in a function that
# holds a number. A decision is an if, or a condition that picks one of two values. The compile cost is that of one file
# that includes gap.hpp and calls diagnose(), at -O2, by the compiler in CXX (c++ if there is none).

set -eu

here=$(cd "$(dirname "$0")/.." && pwd)

count() {  # pattern, folder: how often it stands in the headers of that folder alone
  cat "$2"/*.hpp 2>/dev/null | sed 's|//.*||' | { grep -oE "$1" || true; } | wc -l
}

rooms() {  # checkout
  gap=$1/include/thermopower/gap
  printf '%-10s %8s %8s %11s %10s %8s\n' room headers lines thresholds decisions asserts
  for folder in "$gap" "$gap"/*/; do
    folder=${folder%/}
    name=${folder##*/}
    printf '%-10s %8d %8d %11d %10d %8d\n' "$name" "$(cat "$folder"/*.hpp | grep -c '^#pragma once')" \
      "$(cat "$folder"/*.hpp | wc -l)" \
      "$(($(count '^ +(double|int|std::size_t|Eigen::Index) +[a-z_A-Z]+ *=$|^ +(double|int|std::size_t|Eigen::Index) +[a-z_A-Z]+ *= *-?[0-9][0-9.e-]*;' "$folder") + \
        $(count 'constexpr +(double|int|std::size_t|Eigen::Index) +[a-z_A-Z]+ *= *-?[0-9]' "$folder")))" \
      "$(count '(^|[^a-z_])if +(constexpr +)?\(| \? ' "$folder")" \
      "$(count '(^|[^a-z_])assert\(' "$folder")"
  done | awk '{ print; headers += $2; lines += $3; thresholds += $4; decisions += $5; asserts += $6 }
    END { printf "%-10s %8d %8d %11d %10d %8d\n", "all", headers, lines, thresholds, decisions, asserts }'
}

compile() {  # checkout
  scratch=$(mktemp -d)
  cat >"$scratch/one.cpp" <<'SOURCE'
#include <thermopower/gap.hpp>
int main() {
  const thermopower::gap::Model model;
  return static_cast<int>(thermopower::gap::diagnose(model, {}, {}).verdict);
}
SOURCE
  eigen=$(pkg-config --cflags eigen3 2>/dev/null || echo -I/usr/include/eigen3)
  # shellcheck disable=SC2086  # the flags of Eigen are words
  if /usr/bin/time -f '%U %M' -o "$scratch/cost" ${CXX:-c++} -std=c++17 -O2 $eigen -I"$1/include" -c "$scratch/one.cpp" \
    -o "$scratch/one.o"; then
    awk '{ printf "one file that calls diagnose(): %.0f s of processor time, %.0f MB\n", $1, $2 / 1024 }' "$scratch/cost"
  fi
  rm -rf "$scratch"
}

for checkout in "$@"; do
  [ -d "$checkout/include/thermopower/gap" ] || {
    echo "measure.sh: $checkout is no checkout: it has no folder include/thermopower/gap" >&2
    exit 2
  }
done
for checkout in "$here" "$@"; do
  [ $# -eq 0 ] || echo "$checkout"
  rooms "$checkout"
  compile "$checkout"
done
