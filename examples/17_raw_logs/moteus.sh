#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# CSV of a moteus controller: revolutions.
. "$(dirname "$0")/report.sh"
report moteus.csv joint.json --column t_s=timestamp --column angle_deg=position:rev --column rate_dps=velocity:rev/s --column drive_A=q_current:A
