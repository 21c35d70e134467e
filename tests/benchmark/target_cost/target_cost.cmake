# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# What policies and controllers cost on the target at hand, as a table and as a contract: a cost above its limit fails the test.
# Cross builds only: included by tests/on_target, whose function and tools it uses.
#
#   ctest --preset avr-nano -R target_cost -V      the table, also in build/avr-nano/target_cost.md

set(target_cost_run ${CMAKE_CROSSCOMPILING_EMULATOR})
if(NOT CMAKE_SYSTEM_PROCESSOR STREQUAL "avr")
  # An instruction is a nanosecond of the simulated clock, whatever the host does meanwhile.
  list(INSERT target_cost_run 1 -icount shift=0)
endif()

# The programs that measure time and stack.
set(target_cost_parts fixed fixed_axes sbgc float float_axes float_gimbal monitor)
set(target_cost_programs)
# What all have in common: a program for its flags, whose objects the others take.
thermopower_add_target_program(cost_nothing ${CMAKE_CURRENT_LIST_DIR}/cost.cpp ${CMAKE_CURRENT_LIST_DIR}/cost_main.cpp)
target_link_options(cost_nothing PRIVATE -Wl,--defsym=measure_all=cost_nothing)
set(target_cost_common $<FILTER:$<TARGET_OBJECTS:cost_nothing>,EXCLUDE,/platform_>)
foreach(part IN LISTS target_cost_parts)
  thermopower_add_target_program(cost_${part} ${CMAKE_CURRENT_LIST_DIR}/cost_${part}.cpp ${target_cost_common})
  list(APPEND target_cost_programs $<TARGET_FILE:cost_${part}>)
endforeach()

# Flash and RAM: the objects of the same operations, linked once per operation with a main() that calls it.
thermopower_add_target_program(cost_size ${CMAKE_CURRENT_LIST_DIR}/size_main.cpp
                                         $<FILTER:$<TARGET_OBJECTS:cost_nothing>,INCLUDE,/cost.cpp>)
target_link_options(cost_size PRIVATE -Wl,--defsym=operation=cost_nothing)
find_program(target_size NAMES ${CMAKE_SYSTEM_PROCESSOR}-size arm-none-eabi-size REQUIRED)
find_program(target_nm NAMES ${CMAKE_SYSTEM_PROCESSOR}-nm arm-none-eabi-nm REQUIRED)
separate_arguments(target_cost_flags UNIX_COMMAND "${CMAKE_CXX_FLAGS}")
get_target_property(target_cost_link cost_size LINK_OPTIONS)
list(FILTER target_cost_link EXCLUDE REGEX defsym)
set(target_cost_objects)
foreach(part IN LISTS target_cost_parts)
  list(APPEND target_cost_objects $<FILTER:$<TARGET_OBJECTS:cost_${part}>,INCLUDE,/cost_${part}.cpp>)
endforeach()

set(target_cost_settings ${CMAKE_CURRENT_BINARY_DIR}/target_cost_settings.cmake)
file(GENERATE OUTPUT ${target_cost_settings} CONTENT "
set(run [[${target_cost_run}]])
set(programs [[${target_cost_programs}]])
set(size [[${target_size}]])
set(nm [[${target_nm}]])
set(link [[${CMAKE_CXX_COMPILER};${target_cost_flags};${target_cost_link}]])
set(size_objects [[$<TARGET_OBJECTS:cost_size>;$<FILTER:$<TARGET_OBJECTS:cost_nothing>,INCLUDE,/cost.cpp>]])
set(objects [[${target_cost_objects}]])
set(chip [[${CMAKE_SYSTEM_PROCESSOR}]])
set(directory [[${PROJECT_BINARY_DIR}]])
set(page [[${PROJECT_SOURCE_DIR}/docs/reference/target-cost.md]])
")
add_test(NAME target_cost COMMAND ${CMAKE_COMMAND} -DSETTINGS=${target_cost_settings} -P ${CMAKE_CURRENT_LIST_DIR}/contract.cmake)
set_tests_properties(target_cost PROPERTIES TIMEOUT 900)
