#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# A printer has stopped with "Heater extruder not heating at expected rate": from its klippy.log to what is wrong with the heater.
. "$(dirname "$0")/report.sh"
"$bin/thermopower-gap" columns "$out/failed.log"
"$bin/thermopower-gap" init --name hotend --supply 24 --heater-power 40 --heat-capacity 12.2 --conductance 0.118 \
  --out "$out/printer.json"
read_it="--column motor_C=extruder.temp --column power_param=extruder.pwm:1 --ambient 24"
report failed.log printer.json $read_it
# The thermistor is checked by hand: it shows the room's temperature in the morning, and its type is that of the configuration.
report failed.log printer.json $read_it --without thermometer_gain
