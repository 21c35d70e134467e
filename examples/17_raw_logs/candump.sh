#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# candump -l of a motor on a CAN bus: bytes of its replies, an angle that wraps at 65536 counts.
. "$(dirname "$0")/report.sh"
report candump.log joint.json --column 'drive_A=141#A1.i16@2:A*0.01' --column 'rate_dps=141#A1.i16@4:deg/s' --column 'angle_deg=141#A1.u16@6:65536'
