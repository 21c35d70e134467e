# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# cmake -DSOURCE=<repo> -DWORK=<directory> -P build.cmake: stages the Arduino library and builds its sketches for a Nano as the IDE does.
set(libraries ${WORK}/libraries)
execute_process(COMMAND ${CMAKE_COMMAND} -DOUT=${libraries} -P ${SOURCE}/cmake/arduino_package.cmake RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "The Arduino library cannot be staged")
endif()
file(STRINGS ${libraries}/thermopower/library.properties version REGEX "^version=[0-9]+\\.[0-9]+\\.[0-9]+$")
if(NOT version)
  message(FATAL_ERROR "${libraries}/thermopower/library.properties: no version=<major>.<minor>.<patch>")
endif()

foreach(sketch nano_gimbal gimbal_controller pwm_motor)
  set(build ${WORK}/${sketch})
  file(MAKE_DIRECTORY ${build})
  # The define mends a name that Debian's avr-libc lacks and the core's Print wants; an IDE with its own tools needs none.
  execute_process(
    COMMAND arduino-builder -compile -hardware /usr/share/arduino-builder -hardware /usr/share/arduino/hardware -tools /usr/share/arduino-builder
            -libraries ${libraries} -fqbn arduino:avr:nano:cpu=atmega328 -prefs runtime.tools.avr-gcc.path=/usr
            -prefs "compiler.cpp.extra_flags=-DDECIMAL_DIG=__DECIMAL_DIG__" -build-path ${build}
            ${libraries}/thermopower/examples/${sketch}/${sketch}.ino
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0 OR NOT EXISTS ${build}/${sketch}.ino.elf)
    message(FATAL_ERROR "arduino-builder cannot build ${sketch}:\n${output}")
  endif()
endforeach()
