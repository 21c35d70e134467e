#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
#
# Draws a handful of cases, judges and scores them: the chain of the benchmark in under a minute.
#   smoke.sh GENERATE PROGRAM SCORE DIR
# The thresholds are far below the targets of the full run: with this few cases they only catch what is broken.

set -eu
generate=$1 program=$2 score=$3 directory=$4
rm -rf "$directory"
"$generate" --out "$directory" --seed 7 --count 1 --quick --no-leave-one-out \
  --only second_thermal_mass,forced_airflow,thermometer_lag,dead_time,current_sensor_offset,coulomb_friction,imbalance,actuation_delay,none
sh "$(dirname "$0")/judge.sh" "$program" "$directory" 2
"$score" --dir "$directory" --require class=0.75 --require false_gap=0 --require where=0.6 --require after=0.6 --require honest=0.9
