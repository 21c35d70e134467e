# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# cmake -DSOURCE=<repo> -DBUILD=<directory> -P nano_build.cmake: the programs for the Nano, for the host's tests to run.
foreach(step "configure;-S;${SOURCE};-B;${BUILD};-G;Ninja;-DCMAKE_BUILD_TYPE=MinSizeRel;-DTHERMOPOWER_TESTS=ON;-DCMAKE_TOOLCHAIN_FILE=${SOURCE}/cmake/toolchains/avr-nano.cmake"
             "build;--build;${BUILD};--target;nano_gimbal;gimbal_controller;pwm_motor;pwm_motor_recorded;bare_metal_avr;nano_original_chip")
  list(POP_FRONT step name)
  execute_process(COMMAND ${CMAKE_COMMAND} ${step} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "The programs for the Nano cannot be built (${name}):\n${output}")
  endif()
endforeach()
