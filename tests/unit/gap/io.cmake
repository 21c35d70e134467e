# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Files, program, data gate and localisation of the gap diagnosis. The program's library comes with the examples.
if(NOT TARGET thermopower_gap_files)
  return()
endif()

find_package(nlohmann_json 3.9 REQUIRED)
thermopower_add_test(gap_io_csv LINK thermopower_gap_files LABELS gap SOURCES io_csv.cpp)
thermopower_add_test(gap_io_model LINK thermopower_gap_files LABELS gap SOURCES io_model.cpp)
thermopower_add_test(gap_io_report LINK thermopower_gap_files nlohmann_json::nlohmann_json LABELS gap SOURCES io_report.cpp)
thermopower_add_test(gap_io_gate LINK thermopower::gap LABELS gap SOURCES io_gate.cpp)
thermopower_add_test(gap_io_localise LINK thermopower::gap LABELS gap SOURCES io_localise.cpp)
thermopower_add_test(gap_plant_names LINK thermopower::gap LABELS gap SOURCES plant_names.cpp)
thermopower_add_test(gap_io_program LINK thermopower_gap_files nlohmann_json::nlohmann_json LABELS gap TIMEOUT 600 SOURCES io_program.cpp)
target_compile_definitions(gap_io_program PRIVATE THERMOPOWER_GAP_PROGRAM="$<TARGET_FILE:thermopower-gap>"
                                                  THERMOPOWER_INCLUDE="${PROJECT_SOURCE_DIR}/include")
add_dependencies(gap_io_program thermopower-gap)

# Fuzzing: in every build for some seconds on mutated inputs; with libFuzzer as tests/fuzz/CMakeLists.txt says.
foreach(format csv json)
  set(fuzz_sources ${PROJECT_SOURCE_DIR}/tests/fuzz/gap_${format}_fuzz.cpp)
  if(NOT THERMOPOWER_LIBFUZZER)
    list(APPEND fuzz_sources ${PROJECT_SOURCE_DIR}/tests/fuzz/gap_fuzz_driver.cpp)
  endif()
  add_executable(gap_${format}_fuzz ${fuzz_sources})
  target_link_libraries(gap_${format}_fuzz PRIVATE thermopower_gap_files)
  thermopower_warnings(gap_${format}_fuzz)
  if(THERMOPOWER_LIBFUZZER)
    target_compile_options(gap_${format}_fuzz PRIVATE -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all)
    target_link_options(gap_${format}_fuzz PRIVATE -fsanitize=fuzzer,address,undefined)
    add_test(NAME gap_${format}_fuzz COMMAND gap_${format}_fuzz -max_total_time=10 -seed=1)
  else()
    add_test(NAME gap_${format}_fuzz COMMAND gap_${format}_fuzz 4)
  endif()
  set_tests_properties(gap_${format}_fuzz PROPERTIES TIMEOUT 120 LABELS "gap")
endforeach()
