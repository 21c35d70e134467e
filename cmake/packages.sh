# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Sourced by demo.sh and test.sh. need_packages <name>...: installs those Debian packages that are missing, and only then asks for root.
need_packages() {
  if ! command -v dpkg-query >/dev/null 2>&1; then
    echo "thermopower: no Debian package manager here; please see to it that these are installed: $*" >&2
    return 0
  fi
  missing=
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
  done
  [ -n "$missing" ] || return 0
  echo "thermopower: installing$missing"
  as_root=
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
      echo "thermopower: these packages are missing, and neither root nor sudo is at hand:$missing" >&2
      return 1
    fi
    as_root=sudo
  fi
  $as_root apt-get update -qq
  # shellcheck disable=SC2086  # one word per package is meant
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing </dev/null >/dev/null
}

# What the library's own tests need ...
library_packages="g++ cmake ninja-build libeigen3-dev catch2"
# ... the compilers and libraries behind the programs ...
program_packages="g++ cmake ninja-build libeigen3-dev libcli11-dev nlohmann-json3-dev libcsv-dev libzstd-dev liblz4-dev libsqlite3-dev zlib1g-dev libtinyxml2-dev"
# ... the Nano and its simulator ...
nano_packages="gcc-avr binutils-avr avr-libc arduino-core-avr libsimavr-dev libelf-dev"
# ... and what only the tests need.
test_packages="catch2 clang clang-format-14 libclang-rt-14-dev arduino-builder gcc-arm-none-eabi libnewlib-arm-none-eabi
  libstdc++-arm-none-eabi-newlib qemu-system-arm doxygen doxygen-awesome-css katex nodejs pkg-config chromium python3-z3 gappa sqlite3 openmpi-bin libmujoco-dev"
