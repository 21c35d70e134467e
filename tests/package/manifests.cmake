# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Every manifest parses as far as can be checked here, and carries the library's version.
include(${ROOT}/cmake/version.cmake)
thermopower_version(${ROOT} version)
file(REMOVE_RECURSE ${OUT})
execute_process(COMMAND ${CMAKE_COMMAND} -DOUT=${OUT} -P ${ROOT}/cmake/manifests.cmake COMMAND_ERROR_IS_FATAL ANY)

foreach(manifest library.json vcpkg.json)
  file(READ ${OUT}/${manifest} text)
  string(JSON found GET "${text}" version)  # stops here on a syntax error
  if(NOT found STREQUAL version)
    message(FATAL_ERROR "${manifest} says version ${found}, the library is ${version}")
  endif()
endforeach()
foreach(manifest idf_component.yml conanfile.py CMakeLists.txt zephyr/module.yml)
  file(READ ${OUT}/${manifest} text)
  string(FIND "${text}" "${version}" position)
  if(position EQUAL -1)
    message(FATAL_ERROR "${manifest} does not carry version ${version}")
  endif()
  if(manifest MATCHES "yml$" AND text MATCHES "\t")
    message(FATAL_ERROR "${manifest} has a tab, which YAML does not allow")
  endif()
endforeach()
if(NOT EXISTS ${OUT}/include/thermopower/thermopower.hpp)
  message(FATAL_ERROR "the headers are missing beside the manifests")
endif()
find_program(python python3)
if(python)
  execute_process(COMMAND ${python} -c "import ast,sys; ast.parse(open(sys.argv[1]).read())" ${OUT}/conanfile.py COMMAND_ERROR_IS_FATAL ANY)
endif()
message("manifests parse and say ${version}")
