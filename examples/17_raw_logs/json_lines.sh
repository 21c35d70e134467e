#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# JSON lines of a robot: the drive's own torque, radians.
. "$(dirname "$0")/report.sh"
report robot.jsonl joint.json --column t_s=stamp --column 'angle_deg=joint.q[0]:rad' --column 'rate_dps=joint.dq[0]:rad/s' --column 'drive_A=joint.tau[0]:Nm'
