#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Installs what is missing, builds, and runs all the tests. Safe to repeat. THERMOPOWER_JOBS sets the number of parallel jobs.
set -eu
cd "$(dirname "$0")/.."
. cmake/packages.sh
# shellcheck disable=SC2086
need_packages $program_packages $nano_packages $test_packages

jobs=${THERMOPOWER_JOBS:-$(nproc)}
export CTEST_OUTPUT_ON_FAILURE=1 CMAKE_BUILD_PARALLEL_LEVEL="$jobs" CTEST_PARALLEL_LEVEL="$jobs"

# The chips first: the host's tests run the programs built for them.
for preset in avr-nano cortex-m0 cortex-m4f dev; do
  echo "== $preset"
  cmake --preset "$preset" --log-level=WARNING
  cmake --build --preset "$preset"
done
failed=
for preset in avr-nano cortex-m0 cortex-m4f dev; do
  echo "== tests: $preset"
  ctest --preset "$preset" || failed="$failed $preset"
done
if [ -n "$failed" ]; then
  echo "thermopower: tests failed in:$failed" >&2
  exit 1
fi
echo "thermopower: all tests passed"
