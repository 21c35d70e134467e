# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# An Arduino Nano's ATmega328P at 16 MHz. Programs are run by simavr_run, which the build makes with the host's compiler.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR avr)
set(CMAKE_C_COMPILER avr-gcc)
set(CMAKE_CXX_COMPILER avr-g++)
# The plain archiver makes no index of link-time-optimised objects.
find_program(CMAKE_AR avr-gcc-ar REQUIRED)
find_program(CMAKE_RANLIB avr-gcc-ranlib REQUIRED)
set(CMAKE_C_COMPILER_AR ${CMAKE_AR})
set(CMAKE_CXX_COMPILER_AR ${CMAKE_AR})
set(CMAKE_C_COMPILER_RANLIB ${CMAKE_RANLIB})
set(CMAKE_CXX_COMPILER_RANLIB ${CMAKE_RANLIB})

set(CMAKE_C_FLAGS_INIT "-mmcu=atmega328p")
set(CMAKE_CXX_FLAGS_INIT "-mmcu=atmega328p")
set(CMAKE_ASM_FLAGS_INIT "-mmcu=atmega328p")
set(CMAKE_EXECUTABLE_SUFFIX_C .elf)
set(CMAKE_EXECUTABLE_SUFFIX_CXX .elf)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)

set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_CROSSCOMPILING_EMULATOR ${CMAKE_BINARY_DIR}/host/bin/simavr_run)
