# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# thermopower_warnings(<target>): the warnings our own code is held to. Never forced upon users of the headers.
function(thermopower_warnings target)
  if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion)
    if(THERMOPOWER_STRICT)
      target_compile_options(${target} PRIVATE -Werror)
    endif()
  endif()
endfunction()
