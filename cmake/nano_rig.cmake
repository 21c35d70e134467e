# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# nano_rig: a simulated chip and the emulated board on one line, where libsimavr is installed. For the demo and for the tests.
if(TARGET nano_rig)
  return()
endif()
include(${CMAKE_CURRENT_LIST_DIR}/simavr.cmake)
if(NOT TARGET thermopower_simavr)
  return()
endif()
set(nano_rig_sources ${PROJECT_SOURCE_DIR}/examples/nano_demo)
add_library(nano_rig STATIC ${nano_rig_sources}/elf_facts.cpp ${nano_rig_sources}/simulated_chip.cpp ${nano_rig_sources}/rig.cpp)
target_include_directories(nano_rig PUBLIC ${nano_rig_sources})
target_link_libraries(nano_rig PUBLIC thermopower::desktop PRIVATE thermopower_simavr)
thermopower_warnings(nano_rig)
