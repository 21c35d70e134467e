# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# cmake -DPROGRAM=<thermopower-gap> -DDATA=<recordings> -DHERE=<folder> -P mcap_program.cmake: the program says the same, byte
# by byte, of an MCAP file with a mapping file and of the CSV table of the same numbers.
file(REMOVE_RECURSE ${HERE})
file(MAKE_DIRECTORY ${HERE})
file(WRITE ${HERE}/model.json [[{"format": "thermopower-model/1", "name": "elbow",
 "axis": {"law": "rigid", "inertia_kgm2": 1e-3, "viscous_Nms_per_rad": 1e-3, "torque_constant_Nm_per_A": 0.2}}]])
set(units "angle_deg=ANGLE:rad\nrate_dps=RATE:-rad/s\ndrive_A=AMPS:mA\n supply_V = VOLTS\ngyro=GYRO\nmotor_C=TEMP\n")
string(REPLACE ANGLE "/joint_states.position[elbow]" mcap "${units}")
string(REPLACE RATE "/joint_states.velocity[wrist]" mcap "${mcap}")
string(REPLACE AMPS "/elbow/command.data" mcap "${mcap}")
string(REPLACE VOLTS "/battery.voltage" mcap "${mcap}")
string(REPLACE GYRO "/imu.angular_velocity.z" mcap "${mcap}")
string(REPLACE TEMP "/motor/temperature.temperature" mcap "${mcap}")
file(WRITE ${HERE}/mcap.txt "# of the arm\n${mcap}")
string(REPLACE GYRO gyro csv "t_s=t\n${units}")
string(REPLACE ANGLE angle csv "${csv}")
string(REPLACE RATE rate csv "${csv}")
string(REPLACE AMPS amps csv "${csv}")
string(REPLACE VOLTS volts csv "${csv}")
string(REPLACE TEMP temp csv "${csv}")
file(WRITE ${HERE}/csv.txt "${csv}")

function(run status)
  execute_process(COMMAND ${PROGRAM} ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(NOT result EQUAL status)
    message(FATAL_ERROR "${ARGN}: exit status ${result}, expected ${status}\n${output}${error}")
  endif()
  set(error "${error}" PARENT_SCOPE)
endfunction()
run(0 predict --model ${HERE}/model.json --recording ${DATA}/cdr_lz4.mcap --map ${HERE}/mcap.txt --predictions ${HERE}/mcap.csv)
run(0 predict --model ${HERE}/model.json --recording ${DATA}/arm.csv --map ${HERE}/csv.txt --predictions ${HERE}/csv.csv)
file(READ ${HERE}/mcap.csv one)
file(READ ${HERE}/csv.csv other)
string(LENGTH "${one}" length)
if(NOT one STREQUAL other OR length LESS 5000)
  message(FATAL_ERROR "${HERE}/mcap.csv and ${HERE}/csv.csv differ, or are empty")
endif()
# A proposal is written as a mapping file that is taken as it is; the command line goes before it.
run(0 columns ${DATA}/cdr_lz4.mcap --proposal ${HERE}/proposed.txt)
run(0 predict --model ${HERE}/model.json --recording ${DATA}/cdr_lz4.mcap --map ${HERE}/proposed.txt --column drive_A=/elbow/command.data
      --predictions ${HERE}/proposed.csv)
run(3 predict --model ${HERE}/model.json --recording ${DATA}/cdr_lz4.mcap --predictions ${HERE}/none.csv)
if(NOT error MATCHES "no field is asked for")
  message(FATAL_ERROR "${error}")
endif()
