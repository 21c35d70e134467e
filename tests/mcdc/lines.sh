#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# sh tests/mcdc/lines.sh [DIR]   builds all tests of what runs in firmware for coverage in DIR (build/lines), runs them, and prints how
#                                many lines and branches of the firmware headers they have run. cmake --build <build> --target lines
#                                does the same. What the compiler evaluates (tables, constants of motors) counts as not run.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build/lines}
flags="-fprofile-instr-generate -fcoverage-mapping"
. "$root/tests/mcdc/tools.sh"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++-19 -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 \
  "-DCMAKE_CXX_FLAGS=$flags" -DTHERMOPOWER_TESTS=ON -DTHERMOPOWER_STRICT=OFF -DTHERMOPOWER_DESKTOP=OFF \
  -DTHERMOPOWER_TOOLS=OFF -DTHERMOPOWER_EXAMPLES=OFF > "$build/configure.log"
cmake --build "$build" > "$build/build.log" 2>&1 || { tail -40 "$build/build.log"; exit 1; }
rm -rf "$build/profiles" "$build/exports"
mkdir "$build/exports"
for test in "$build"/bin/actuator_* "$build"/bin/certified_* "$build"/bin/control_* "$build"/bin/fixed_point* "$build"/bin/sbgc_test "$build"/bin/sbgc_examples; do
  name=$(basename "$test")
  LLVM_PROFILE_FILE="$build/profiles/$name.profraw" "$test" > "$build/$name.log" 2>&1 || { tail -40 "$build/$name.log"; exit 1; }
  llvm-profdata-19 merge -sparse -o "$build/one.profdata" "$build/profiles/$name.profraw"
  llvm-cov-19 export "$test" -instr-profile "$build/one.profdata" > "$build/exports/$name.json" 2> "$build/export.log"
done
python3 -B "$root/tests/mcdc/lines.py" "$build/exports"
