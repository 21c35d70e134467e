#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# A temperature graph without the heater's power: the loop of the model makes the power of target and temperature.
. "$(dirname "$0")/report.sh"
"$bin/thermopower-gap" columns "$out/graph.csv"
read_it="--column t_s=time --column motor_C=bed_temp --column target_C=bed_target --ambient 24"
report graph.csv bed_loop.json $read_it
# The loop as simulated, from the targets alone: temperature and power.
"$bin/thermopower-gap" predict --model "$out/bed_loop.json" --recording "$out/graph.csv" --column t_s=time --column target_C=bed_target \
  --ambient 24 --predictions "$out/loop.csv"
head -n 3 "$out/loop.csv"
