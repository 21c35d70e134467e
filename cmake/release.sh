#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# sh cmake/release.sh [directory]        the release archive of the last commit, its check sum and the notes of its version from CHANGELOG.md,
#                                        in build/release-archive or there
# sh cmake/release.sh --try [directory]  the same, made twice and compared, unpacked, installed, and used by a program
# sh cmake/release.sh --all [directory]  the same as without, and from the archive: the Debian package, the Arduino library as a zip
#                                        file, and the documentation; each is opened and tried. THERMOPOWER_RELEASE_OPTIONS are further
#                                        options of the package
# sh cmake/release.sh --version 0.2.0 [directory]  the whole release: sets version.hpp, dates the changelog's section, commits both,
#                                        tags the commit, and does what --all does. Nothing is pushed
# The same commit gives the same bytes: names, order, times and owners are the commit's, and gzip stores no time.
set -eu
cd "$(dirname "$0")/.."
what=''
wanted=''
case ${1-} in
--try | --all)
  what=$1
  shift
  ;;
--version)
  what=--all
  wanted=${2-}
  echo "$wanted" | grep -Eqx '[0-9]+\.[0-9]+\.[0-9]+' || { echo "release.sh: --version '$wanted': expected three numbers, such as 0.2.0" >&2; exit 2; }
  shift 2
  ;;
-*)
  echo "release.sh: there is no option $1; expected --try, --all or --version" >&2
  exit 2
  ;;
esac
directory=${1-build/release-archive}

if [ -n "$(git status --porcelain --untracked-files=no)" ]; then
  echo "release.sh: there are changes that are not committed; an archive is of a commit" >&2
  exit 1
fi
number() { sed -n "s/.*int $1_number() { return \([0-9]*\); }.*/\1/p" include/thermopower/version.hpp; }

if [ -n "$wanted" ]; then
  if git rev-parse -q --verify "refs/tags/v$wanted" >/dev/null; then
    echo "release.sh: the tag v$wanted is there already" >&2
    exit 1
  fi
  grep -q '^## \[Unreleased\]' CHANGELOG.md || { echo "release.sh: CHANGELOG.md has no section [Unreleased]" >&2; exit 1; }
  sed -i "s/^## \[Unreleased\].*/## [$wanted] - $(date -u +%Y-%m-%d)/" CHANGELOG.md
  for place in major:1 minor:2 patch:3; do
    value=$(echo "$wanted" | cut -d. -f"${place#*:}")
    sed -i "s/\(int ${place%:*}_number() { return \)[0-9]*/\1$value/" include/thermopower/version.hpp
  done
  git commit -q -m "Version $wanted" -- CHANGELOG.md include/thermopower/version.hpp
  git tag -a "v$wanted" -m "thermopower $wanted"
fi
version=$(number major).$(number minor).$(number patch)
name=thermopower-$version
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH

archive() {  # archive <file>
  git -c core.autocrlf=false -c tar.umask=0022 archive --format=tar --prefix="$name/" -o "$1.tar" HEAD
  gzip -n -9 <"$1.tar" >"$1"
  rm "$1.tar"
}
mkdir -p "$directory"
directory=$(cd "$directory" && pwd)
archive "$directory/$name.tar.gz"
(cd "$directory" && sha256sum "$name.tar.gz" | tee "$name.tar.gz.sha256")
# The notes: this version's section of the changelog, with its upgrade notes where it has some, or that which becomes it.
section=Unreleased
grep -qF "## [$version]" CHANGELOG.md && section=$version
awk -v title="[$section]" '/^## \[/ { if (seen) exit; seen = index($0, title); next } seen' CHANGELOG.md >"$directory/$name-notes.md"
[ -s "$directory/$name-notes.md" ] || { echo "release.sh: CHANGELOG.md has no section of this version" >&2; exit 1; }
[ -n "$what" ] || exit 0

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
write_program() {
  cat >"$scratch/program.cpp" <<'PROGRAM'
#include <thermopower/thermopower.hpp>
int main() {
  thermopower::SafetyLimiter<> limiter;
  return limiter.step({255, thermopower::GuardedCelsius::unchecked(90.0f), 0.0f}, 0.03f).power == 1 ? 0 : 1;
}
PROGRAM
}
if [ "$what" = --all ]; then
  tar -xzf "$directory/$name.tar.gz" -C "$scratch"
  date=$(TZ=UTC git log -1 --date='format-local:%Y-%m-%d %H:%M:%S UTC' --format=%cd)
  cmake -DOUT="$scratch/arduino" -P "$scratch/$name/cmake/arduino_package.cmake"
  (cd "$scratch/arduino" && cmake -E tar cf "$directory/$name-arduino.zip" --format=zip --mtime="$date" thermopower)
  cmake -S "$scratch/$name" -B "$scratch/docs" -G Ninja --log-level=WARNING -DTHERMOPOWER_TESTS=OFF -DTHERMOPOWER_TOOLS=OFF \
    -DTHERMOPOWER_EXAMPLES=OFF -DTHERMOPOWER_DOCS=ON >/dev/null
  cmake --build "$scratch/docs" --target docs >/dev/null
  tar --sort=name --mtime="$date" --owner=0 --group=0 --numeric-owner -C "$scratch/docs/docs" --transform "s,^html,$name-docs," \
    -cf - html | gzip -n -9 >"$directory/$name-docs.tar.gz"
  # shellcheck disable=SC2086
  cmake -S "$scratch/$name" -B "$scratch/package" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release -DTHERMOPOWER_TESTS=OFF \
    -DTHERMOPOWER_EXAMPLES=OFF ${THERMOPOWER_RELEASE_OPTIONS-} >/dev/null
  cmake --build "$scratch/package" >/dev/null
  (cd "$scratch/package" && cpack -G DEB >/dev/null)
  cp "$scratch/package"/*.deb "$directory"
  # Each is opened as its user would.
  cmake -E make_directory "$scratch/zip" "$scratch/root"
  (cd "$scratch/zip" && cmake -E tar xf "$directory/$name-arduino.zip")
  grep -qx "version=$version" "$scratch/zip/thermopower/library.properties"
  tar -tzf "$directory/$name-docs.tar.gz" "$name-docs/index.html" >/dev/null
  dpkg-deb -x "$directory/thermopower_${version}_$(dpkg --print-architecture).deb" "$scratch/root"
  write_program
  for include in "$scratch/root/usr/include" "$scratch/zip/thermopower/src"; do
    "${CXX:-c++}" -std=c++11 -I "$include" "$scratch/program.cpp" -o "$scratch/program"
    "$scratch/program"
  done
  "$scratch/root/usr/bin/thermopower-gap" --version | grep -qx "$version"
  (cd "$directory" && sha256sum "$name"*.tar.gz "$name"*.zip thermopower_"$version"_*.deb >"$name.sha256")
  ls "$directory"
  echo "release.sh: version $version; the package, the Arduino library and the documentation open, and a program compiles with both"
  exit 0
fi
TZ=Asia/Tokyo LC_ALL=C archive "$scratch/again.tar.gz"
cmp "$directory/$name.tar.gz" "$scratch/again.tar.gz"
tar -xzf "$directory/$name.tar.gz" -C "$scratch"
cmake -S "$scratch/$name" -B "$scratch/build" --log-level=WARNING -DTHERMOPOWER_TOOLS=OFF -DTHERMOPOWER_EXAMPLES=OFF \
  -DCMAKE_INSTALL_PREFIX="$scratch/installed" >/dev/null
cmake --install "$scratch/build" >/dev/null
write_program
"${CXX:-c++}" -std=c++11 -I "$scratch/installed/include" "$scratch/program.cpp" -o "$scratch/program"
"$scratch/program"
echo "release.sh: the archive is the same twice, installs, and its headers compile and decide"
