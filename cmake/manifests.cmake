# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# cmake -DOUT=<directory> -P cmake/manifests.cmake: the manifests of cmake/packaging/ with the version filled in, beside the headers.
if(NOT OUT)
  message(FATAL_ERROR "Say where to: cmake -DOUT=<directory> -P cmake/manifests.cmake")
endif()
get_filename_component(root ${CMAKE_CURRENT_LIST_DIR} DIRECTORY)
include(${CMAKE_CURRENT_LIST_DIR}/version.cmake)
thermopower_version(${root} version)

file(COPY ${root}/include ${root}/LICENSE DESTINATION ${OUT})
foreach(manifest library.json idf_component.yml conanfile.py vcpkg.json portfile.cmake package.xml)
  configure_file(${root}/cmake/packaging/${manifest}.in ${OUT}/${manifest} @ONLY)
endforeach()
configure_file(${root}/cmake/packaging/CMakeLists.idf.txt.in ${OUT}/CMakeLists.txt @ONLY)
configure_file(${root}/cmake/packaging/module.yml.in ${OUT}/zephyr/module.yml @ONLY)
