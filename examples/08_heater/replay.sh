#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# From logs of one heater to what the watch would have made of them, in one command: constants with bounds from the first log, the
# replay built with them, false alarms in all logs, and faults put into their holds.
if [ $# -lt 5 ]; then
  echo "usage: sh replay.sh <W at full duty> <highest degC> <K that the air may be off> <folder to write> <log.csv>..." >&2
  exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
bin=${THERMOPOWER_BIN:-$here/../../build/release/bin}
folder=$4
"$bin/heater_calibrate" "$5" "$1" "$2" "$3" > "$folder/constants.hpp" || exit
head -n 1 "$folder/constants.hpp"
${CXX:-c++} -std=c++17 -O2 -I "$here/../../include" -I "$here" -I "$folder" -DHEATER_CONSTANTS='"constants.hpp"' \
  "$here/heater_replay.cpp" -o "$folder/heater_replay" || exit
shift 4
exec "$folder/heater_replay" "$@"
