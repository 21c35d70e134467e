# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

if(NOT TARGET thermopower::desktop)
  return()
endif()
add_executable(simulation_speed simulation_speed.cpp)
target_link_libraries(simulation_speed PRIVATE thermopower::desktop)
# For this machine, whatever the build type: a figure for another machine would be of no use.
target_compile_options(simulation_speed PRIVATE -O3 -march=native)
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(-mprefer-vector-width=512 THERMOPOWER_HAS_VECTOR_WIDTH)
if(THERMOPOWER_HAS_VECTOR_WIDTH)
  target_compile_options(simulation_speed PRIVATE -mprefer-vector-width=512)
endif()
thermopower_warnings(simulation_speed)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Lanes stay in registers only when the whole run is one function. The warnings are false, from the compiler's own vector headers.
  target_compile_options(simulation_speed PRIVATE -finline-limit=20000 --param=inline-unit-growth=2000 --param=large-function-growth=20000
                         --param=large-stack-frame-growth=10000 -Wno-uninitialized -Wno-maybe-uninitialized)
endif()

find_package(Boost 1.70 QUIET)
if(Boost_FOUND)
  target_include_directories(simulation_speed SYSTEM PRIVATE ${Boost_INCLUDE_DIRS})
  target_compile_definitions(simulation_speed PRIVATE THERMOPOWER_HAS_ODEINT)
endif()
find_package(SUNDIALS 6 QUIET COMPONENTS cvode nvecserial)
if(SUNDIALS_FOUND)
  target_link_libraries(simulation_speed PRIVATE SUNDIALS::cvode SUNDIALS::nvecserial)
  target_compile_definitions(simulation_speed PRIVATE THERMOPOWER_HAS_CVODE)
endif()
