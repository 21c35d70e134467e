#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# CSV as pandas writes it: an index without a name, dates, milliamperes.
. "$(dirname "$0")/report.sh"
report pandas.csv joint.json --column t_s=when --column angle_deg=angle_rad:rad --column rate_dps=speed_rad_s:rad/s --column drive_A=command_mA:mA
