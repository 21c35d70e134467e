# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# cmake -DFORM=<form> -DINCLUDE=<include> -DWORK=<directory> -P headers.cmake -- <compiler> <flags...>: compiles the firmware headers.
file(GLOB_RECURSE headers RELATIVE ${INCLUDE} ${INCLUDE}/thermopower/*.hpp)
list(FILTER headers EXCLUDE REGEX "^thermopower/(simulation/|plant/|gap/|design/|io/|robot/|desktop\\.hpp|gap\\.hpp|io\\.hpp)")
list(LENGTH headers count)
if(count LESS 50)
  message(FATAL_ERROR "only ${count} firmware headers below ${INCLUDE}: is the path right?")
endif()

set(prefix "")
if(FORM STREQUAL "AFTER_ARDUINO")
  # The core's own warnings are not ours; it must not be a system header, which this compiler would take for C.
  set(prefix "#pragma GCC diagnostic push\n")
  foreach(warning conversion shadow unused-parameter double-promotion)
    string(APPEND prefix "#pragma GCC diagnostic ignored \"-W${warning}\"\n")
  endforeach()
  string(APPEND prefix "#include <Arduino.h>\n#pragma GCC diagnostic pop\n")
endif()

set(sources)
if(FORM STREQUAL "EVERY")
  list(JOIN headers ">\n#include <" every)
  file(WRITE ${WORK}/every_header.cpp "#include <${every}>\n")
  list(APPEND sources ${WORK}/every_header.cpp)
else()
  # One source per header, so that each stands alone; included twice, so that each stands being included twice.
  foreach(header ${headers})
    string(MAKE_C_IDENTIFIER ${header} name)
    file(WRITE ${WORK}/${name}.cpp "${prefix}#include <${header}>\n#include <${header}>\n")
    list(APPEND sources ${WORK}/${name}.cpp)
  endforeach()
endif()

set(command)
set(ours OFF)
math(EXPR last "${CMAKE_ARGC} - 1")
foreach(i RANGE ${last})
  if(ours)
    list(APPEND command "${CMAKE_ARGV${i}}")
  elseif("${CMAKE_ARGV${i}}" STREQUAL "--")
    set(ours ON)
  endif()
endforeach()
# All headers in one call of the compiler: starting it fifty times would take longer than compiling.
execute_process(COMMAND ${command} ${sources} RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "a firmware header does not compile: ${command}")
endif()
