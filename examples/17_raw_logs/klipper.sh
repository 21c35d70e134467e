#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# A printer's klippy.log: the hotend.
. "$(dirname "$0")/report.sh"
report klippy.log hotend.json --column motor_C=extruder.temp --column power_param=extruder.pwm:1 --ambient 24
