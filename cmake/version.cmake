# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# thermopower_version(<root> <variable>): reads major.minor.patch from version.hpp, the one place that holds it.
function(thermopower_version root variable)
  file(READ ${root}/include/thermopower/version.hpp header)
  set(parts)
  foreach(part major minor patch)
    string(REGEX MATCH "${part}_number\\(\\) { return ([0-9]+)" found "${header}")
    if(NOT found)
      message(FATAL_ERROR "version.hpp does not say its ${part}_number")
    endif()
    list(APPEND parts ${CMAKE_MATCH_1})
  endforeach()
  list(JOIN parts "." version)
  set(${variable} ${version} PARENT_SCOPE)
endfunction()
