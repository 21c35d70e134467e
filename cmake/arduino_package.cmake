# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# cmake -DOUT=<directory> -P cmake/arduino_package.cmake: the Arduino library <directory>/thermopower, ready to be copied into a
# sketchbook's libraries directory. It holds the firmware headers and the sketches for the Nano, and nothing for the desktop.
if(NOT OUT)
  message(FATAL_ERROR "Say where to: cmake -DOUT=<directory> -P cmake/arduino_package.cmake")
endif()
get_filename_component(root ${CMAKE_CURRENT_LIST_DIR} DIRECTORY)
include(${CMAKE_CURRENT_LIST_DIR}/version.cmake)
thermopower_version(${root} version)

set(package ${OUT}/thermopower)
file(REMOVE_RECURSE ${package})
file(COPY ${root}/include/thermopower/air_celsius.hpp ${root}/include/thermopower/measured_temperature.hpp ${root}/include/thermopower/step_time.hpp ${root}/include/thermopower/supply_range.hpp ${root}/include/thermopower/config_error.hpp ${root}/include/thermopower/config_record.hpp ${root}/include/thermopower/run_record.hpp ${root}/include/thermopower/thermopower.hpp
          ${root}/include/thermopower/version.hpp
     DESTINATION ${package}/src/thermopower)
foreach(part actuator control detail fixed_point monitor motors sbgc)
  file(COPY ${root}/include/thermopower/${part} DESTINATION ${package}/src/thermopower)
endforeach()
# The Arduino builder finds a library by a header in the root of its sources.
file(WRITE ${package}/src/thermopower.h "#pragma once\n#include \"thermopower/thermopower.hpp\"\n")
foreach(sketch nano_gimbal gimbal_controller nano_player pwm_motor)
  file(GLOB parts ${root}/examples/${sketch}/*.ino ${root}/examples/${sketch}/*.h)
  file(COPY ${parts} DESTINATION ${package}/examples/${sketch})
endforeach()
file(COPY ${root}/cmake/packaging/keywords.txt ${root}/LICENSE DESTINATION ${package})
configure_file(${root}/cmake/packaging/library.properties.in ${package}/library.properties @ONLY)
