#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# The serial log of a printer with Marlin, without stamps: the bed.
. "$(dirname "$0")/report.sh"
report serial.log bed.json --rate 1 --column motor_C=B --column power_param=B@:127 --ambient 24
