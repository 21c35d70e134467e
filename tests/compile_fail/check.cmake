# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# A source that compiles as it stands must fail, for the stated reason, when MISUSE is defined. What runs on a desk only
# says '// standard: 17'.
file(READ ${SOURCE} text)
if(NOT text MATCHES "\n// expect: ([^\n]+)\n")
  message(FATAL_ERROR "${SOURCE} does not say '// expect: ...'")
endif()
set(expected "${CMAKE_MATCH_1}")
if(text MATCHES "\n// standard: ([0-9]+)\n")
  set(STANDARD ${CMAKE_MATCH_1})
  if(EIGEN)
    set(desktop -isystem ${EIGEN})
  endif()
endif()
set(compile ${COMPILER} -std=c++${STANDARD} -fsyntax-only -Wall -Wextra -I${INCLUDE} ${desktop} ${SOURCE})

execute_process(COMMAND ${compile} RESULT_VARIABLE result ERROR_VARIABLE errors)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the right use does not compile:\n${errors}")
endif()
execute_process(COMMAND ${compile} -DMISUSE RESULT_VARIABLE result ERROR_VARIABLE errors)
if(result EQUAL 0)
  message(FATAL_ERROR "the misuse compiles; expected: ${expected}")
endif()
string(FIND "${errors}" "${expected}" found)
if(found EQUAL -1)
  message(FATAL_ERROR "the misuse fails without saying: ${expected}\n${errors}")
endif()
# Readable also means short: the sentence comes before anybody has to scroll.
string(SUBSTRING "${errors}" 0 ${found} before)
string(REGEX MATCHALL "error:" errors_before "${before}")
list(LENGTH errors_before count)
if(count GREATER 2)
  message(FATAL_ERROR "${count} errors come before the sentence: ${expected}\n${errors}")
endif()
