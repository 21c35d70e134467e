# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Installs anew and forgets earlier consumers: what they cached would hide a change of the package.
file(GLOB old LIST_DIRECTORIES true ${WORK}/prefix ${WORK}/headers_prefix ${WORK}/unbuilt ${WORK}/asks_in_vain ${WORK}/find_package* ${WORK}/add_subdirectory ${WORK}/plain_include ${WORK}/pkg_config)
if(old)
  file(REMOVE_RECURSE ${old})
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)

# The headers, from a build directory in which nothing has been built, programs and libraries asked for or not.
set(asked -DTHERMOPOWER_TOOLS=OFF)
if(TOOLS)
  set(asked -DTHERMOPOWER_TOOLS=ON)
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/unbuilt -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
                        -DTHERMOPOWER_TESTS=OFF ${asked}
                COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${WORK}/unbuilt --prefix ${WORK}/headers_prefix
                COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)

# What was not built is asked for in vain, and the package says why.
file(WRITE ${WORK}/asks_in_vain/CMakeLists.txt "cmake_minimum_required(VERSION 3.22)
project(asks_in_vain CXX)
find_package(thermopower 0.1 REQUIRED COMPONENTS io)
")
execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK}/asks_in_vain -B ${WORK}/asks_in_vain/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
                        -DCMAKE_PREFIX_PATH=${WORK}/headers_prefix
                RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE said)
if(status EQUAL 0 OR NOT said MATCHES "installed without its component gap")
  message(FATAL_ERROR "a library that was not built must be missed in a sentence: status ${status}\n${said}")
endif()
