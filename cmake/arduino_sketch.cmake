# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# thermopower_arduino_sketch(<name> <sketch.ino>): <name>.elf from a sketch and the stock Arduino core, compiled and linked as the
# Arduino IDE does it for a Nano (platform.txt of arduino-core-avr), with the warnings of our own code on top.
set(THERMOPOWER_ARDUINO_HARDWARE /usr/share/arduino/hardware/arduino/avr CACHE PATH "Directory with the Arduino AVR core's platform.txt")

set(arduino_definitions F_CPU=16000000L ARDUINO=10819 ARDUINO_AVR_NANO ARDUINO_ARCH_AVR)
set(arduino_cxx_flags -std=gnu++11 -fpermissive -fno-exceptions -fno-threadsafe-statics -Wno-error=narrowing)
set(arduino_flags -g -Os -ffunction-sections -fdata-sections -flto)

function(thermopower_arduino_core)
  if(TARGET arduino_core)
    return()
  endif()
  set(core ${THERMOPOWER_ARDUINO_HARDWARE}/cores/arduino)
  if(NOT EXISTS ${core}/Arduino.h)
    message(FATAL_ERROR "No Arduino core at ${core}. Install arduino-core-avr, or set THERMOPOWER_ARDUINO_HARDWARE to the directory of "
                        "another one's platform.txt.")
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${core}/*.c ${core}/*.cpp ${core}/*.S)
  add_library(arduino_core STATIC ${sources})
  # Not as system headers: this compiler takes those for C.
  target_include_directories(arduino_core PUBLIC ${core} ${THERMOPOWER_ARDUINO_HARDWARE}/variants/eightanaloginputs)
  target_compile_definitions(arduino_core PUBLIC ${arduino_definitions})
  target_compile_options(arduino_core PRIVATE
    $<$<COMPILE_LANGUAGE:C>:${arduino_flags};-w;-std=gnu11;-fno-fat-lto-objects>
    # The definition mends a name that Debian's avr-libc lacks and the core's Print wants.
    $<$<COMPILE_LANGUAGE:CXX>:${arduino_flags};-w;${arduino_cxx_flags};-DDECIMAL_DIG=__DECIMAL_DIG__>
    $<$<COMPILE_LANGUAGE:ASM>:-flto>)
  set_target_properties(arduino_core PROPERTIES CXX_STANDARD 11)
endfunction()

function(thermopower_arduino_sketch name sketch)
  thermopower_arduino_core()
  # A sketch finds a library by a header in the library's root; its only content is the umbrella header.
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/arduino/thermopower.h CONTENT "#pragma once\n#include <thermopower/thermopower.hpp>\n")
  set_source_files_properties(${sketch} PROPERTIES LANGUAGE CXX COMPILE_OPTIONS "-xc++;-include;Arduino.h")
  add_executable(${name} ${sketch})
  target_link_libraries(${name} PRIVATE thermopower::thermopower arduino_core m)
  target_include_directories(${name} PRIVATE ${PROJECT_BINARY_DIR}/arduino)
  target_compile_options(${name} PRIVATE ${arduino_flags} ${arduino_cxx_flags})
  target_link_options(${name} PRIVATE -w -Os -g -flto -fuse-linker-plugin -Wl,--gc-sections -mmcu=atmega328p)
  set_target_properties(${name} PROPERTIES CXX_STANDARD 11 SUFFIX .elf)
  thermopower_warnings(${name})
endfunction()
