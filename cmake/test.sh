#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# sh cmake/test.sh         builds and tests the library: a compiler, CMake, Eigen and Catch2 are all it needs
# sh cmake/test.sh --all   everything: programs, examples, simulated chips, sanitizers, documentation
# Installs what is missing. Safe to repeat. THERMOPOWER_JOBS sets the number of parallel jobs.
set -eu
cd "$(dirname "$0")/.."
. cmake/packages.sh
case "${1-}" in
  "") packages=$library_packages presets=library workflows= ;;
  --all)
    packages="$program_packages $nano_packages $test_packages"
    # The chips first: the host's tests run the programs built for them.
    presets="avr-nano cortex-m0 cortex-m4f dev" workflows=docs
    ;;
  *)
    echo "usage: sh cmake/test.sh [--all]" >&2
    exit 2
    ;;
esac
# shellcheck disable=SC2086
need_packages $packages

jobs=${THERMOPOWER_JOBS:-$(nproc)}
export CTEST_OUTPUT_ON_FAILURE=1 CMAKE_BUILD_PARALLEL_LEVEL="$jobs" CTEST_PARALLEL_LEVEL="$jobs"

for preset in $presets; do
  echo "== $preset"
  cmake --preset "$preset" --log-level=WARNING --no-warn-unused-cli -DTHERMOPOWER_UNITY=ON
  cmake --build --preset "$preset"
done
failed=
for preset in $presets; do
  echo "== tests: $preset"
  ctest --preset "$preset" || failed="$failed $preset"
done
for preset in $workflows; do
  echo "== $preset"
  cmake --workflow --preset "$preset" || failed="$failed $preset"
done
# The demonstration compiles whole folders as one file: names of two of its files must not meet.
if [ -n "$workflows" ]; then
  echo "== demo"
  sh cmake/demo.sh || failed="$failed demo"
fi
# An archive is of a commit: changes that are not committed have none.
if [ -n "$workflows" ] && git diff --quiet HEAD 2>/dev/null; then
  echo "== release"
  sh cmake/release.sh --try build/release-archive || failed="$failed release"
fi
if [ -n "$failed" ]; then
  echo "thermopower: failed in:$failed" >&2
  exit 1
fi
echo "thermopower: all tests passed"
