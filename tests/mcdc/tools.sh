# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Sourced by mcdc.sh and lines.sh: skips where clang 19 or what goes with it is missing, or does not link with $flags, and makes
# the directory $build.
for tool in clang++-19 llvm-profdata-19 llvm-cov-19 python3 ninja; do
  command -v $tool > /dev/null || { echo "SKIPPED: no $tool (Debian: clang-19 llvm-19 libclang-rt-19-dev python3 ninja-build)"; exit 0; }
done
mkdir -p "$build"
build=$(cd "$build" && pwd)
echo "int main() { return 0; }" > "$build/probe.cpp"
# shellcheck disable=SC2086
clang++-19 $flags "$build/probe.cpp" -o "$build/probe" 2> /dev/null ||
  { echo "SKIPPED: clang++-19 does not link for coverage (Debian: libclang-rt-19-dev)"; exit 0; }
