# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# thermopower_simavr: libsimavr with libelf, where both are installed.
if(TARGET thermopower_simavr)
  return()
endif()
find_path(SIMAVR_INCLUDE_DIR sim_avr.h PATH_SUFFIXES simavr)
find_library(SIMAVR_LIBRARY simavr)
find_path(LIBELF_INCLUDE_DIR gelf.h)
find_library(LIBELF_LIBRARY elf)
mark_as_advanced(SIMAVR_INCLUDE_DIR SIMAVR_LIBRARY LIBELF_INCLUDE_DIR LIBELF_LIBRARY)
if(SIMAVR_INCLUDE_DIR AND SIMAVR_LIBRARY AND LIBELF_INCLUDE_DIR AND LIBELF_LIBRARY)
  add_library(thermopower_simavr INTERFACE)
  target_include_directories(thermopower_simavr SYSTEM INTERFACE ${SIMAVR_INCLUDE_DIR} ${LIBELF_INCLUDE_DIR})
  target_link_libraries(thermopower_simavr INTERFACE ${SIMAVR_LIBRARY} ${LIBELF_LIBRARY})
endif()
