# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# thermopower_warnings(<target>): the warnings our own code is held to. Never forced upon users of the headers.
function(thermopower_warnings target)
  if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion)
    # In C++, -Wconversion of GCC says nothing of signs: indices of Eigen are signed, those of the standard library are not.
    if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
      target_compile_options(${target} PRIVATE -Wno-sign-conversion)
    endif()
    if(THERMOPOWER_STRICT)
      target_compile_options(${target} PRIVATE -Werror)
    endif()
  endif()
endfunction()
