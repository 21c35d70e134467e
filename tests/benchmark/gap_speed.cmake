# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

if(NOT TARGET thermopower_gap_files)
  return()
endif()
add_executable(gap_speed gap_speed.cpp)
target_link_libraries(gap_speed PRIVATE thermopower_gap_files)
thermopower_warnings(gap_speed)

find_package(Ceres QUIET)
if(Ceres_FOUND)
  target_link_libraries(gap_speed PRIVATE Ceres::ceres)
  target_compile_definitions(gap_speed PRIVATE THERMOPOWER_HAS_CERES)
endif()
