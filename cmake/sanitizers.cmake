# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# THERMOPOWER_SANITIZE: OFF, ALL, or PROGRAMS: everything but the directories of numerical work, which take three times as
# long to compile and ten times as long to run under the sanitizers. What reads foreign bytes, files and options, and what
# runs in firmware, is under them either way.
set(THERMOPOWER_SANITIZE OFF CACHE STRING "Address and undefined-behaviour sanitizers: OFF, PROGRAMS or ALL")
set_property(CACHE THERMOPOWER_SANITIZE PROPERTY STRINGS OFF PROGRAMS ALL)
if(NOT THERMOPOWER_SANITIZE MATCHES "^(OFF|PROGRAMS|ALL)$")
  message(FATAL_ERROR "thermopower: THERMOPOWER_SANITIZE is \"${THERMOPOWER_SANITIZE}\"; it must be OFF, PROGRAMS or ALL")
endif()

set(thermopower_sanitizers -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer -Wno-maybe-uninitialized)
if(THERMOPOWER_SANITIZE STREQUAL "PROGRAMS")
  # A third of the time to compile is for the temporaries of the tests' own assertions, a tenth for pointers that are null or
  # point behind their object, at which the address sanitizer stops as well; with ALL they are watched, too.
  list(APPEND thermopower_sanitizers -fno-sanitize-address-use-after-scope -fno-sanitize=null,object-size,vptr)
endif()

# Eigen allocates by hand under the address sanitizer and by malloc without it. Where both kinds of code meet in one program
# they must agree: on malloc, whose blocks are aligned to 16 bytes either way.
if(THERMOPOWER_SANITIZE STREQUAL "PROGRAMS" AND TARGET thermopower_desktop)
  target_compile_definitions(thermopower_desktop INTERFACE
    $<BUILD_INTERFACE:$<$<IN_LIST:-fno-sanitize-recover=all,$<TARGET_PROPERTY:COMPILE_OPTIONS>>:EIGEN_MALLOC_ALREADY_ALIGNED=1>>)
endif()

# thermopower_sanitize(): this directory and those added below it from here on.
macro(thermopower_sanitize)
  if(THERMOPOWER_SANITIZE)
    add_compile_options(${thermopower_sanitizers})
    add_link_options(-fsanitize=address,undefined)
  endif()
endmacro()

# thermopower_numerical_directory(): this directory is under the sanitizers only if everything is. Its programs are not linked
# with them either: their allocator alone takes a quarter of the time. One that links what is under them says so.
macro(thermopower_numerical_directory)
  if(THERMOPOWER_SANITIZE STREQUAL "PROGRAMS")
    get_directory_property(thermopower_options COMPILE_OPTIONS)
    list(REMOVE_ITEM thermopower_options ${thermopower_sanitizers})
    set_directory_properties(PROPERTIES COMPILE_OPTIONS "${thermopower_options}" LINK_OPTIONS "")
  endif()
endmacro()

# thermopower_numerical_programs(<targets>...): the same for single programs of a directory.
function(thermopower_numerical_programs)
  if(THERMOPOWER_SANITIZE STREQUAL "PROGRAMS")
    foreach(target IN LISTS ARGN)
      get_target_property(thermopower_options ${target} COMPILE_OPTIONS)
      list(REMOVE_ITEM thermopower_options ${thermopower_sanitizers})
      set_target_properties(${target} PROPERTIES COMPILE_OPTIONS "${thermopower_options}" LINK_OPTIONS "")
    endforeach()
  endif()
endfunction()

# thermopower_desktop_directory(): what is compiled here runs on processors alone that read from any address; another fifth of
# the time to compile is for where it reads from.
macro(thermopower_desktop_directory)
  if(THERMOPOWER_SANITIZE STREQUAL "PROGRAMS")
    add_compile_options(-fno-sanitize=alignment)
  endif()
endmacro()

# What a project outside must be configured with to link what was built here.
set(thermopower_user_options "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}")
if(THERMOPOWER_SANITIZE STREQUAL "PROGRAMS")
  list(APPEND thermopower_user_options -DCMAKE_EXE_LINKER_FLAGS=-fsanitize=address,undefined)
elseif(THERMOPOWER_SANITIZE STREQUAL "ALL")
  set(thermopower_user_options "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS} -fsanitize=address,undefined")
endif()
