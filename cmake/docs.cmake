# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Target `docs`: the API and the pages of docs/ as HTML in <build>/docs/html. A warning of Doxygen's is an error.
find_package(Doxygen 1.9.4 REQUIRED OPTIONAL_COMPONENTS dot)
find_path(THERMOPOWER_DOXYGEN_AWESOME doxygen-awesome.css PATHS /usr/share/doxygen-awesome-css)
find_path(THERMOPOWER_MATHJAX MathJax.js PATHS /usr/share/javascript/mathjax)

set(doxygen_css)
if(THERMOPOWER_DOXYGEN_AWESOME)
  set(doxygen_css "${THERMOPOWER_DOXYGEN_AWESOME}/doxygen-awesome.css ${THERMOPOWER_DOXYGEN_AWESOME}/doxygen-awesome-sidebar-only.css")
endif()
if(THERMOPOWER_MATHJAX)
  set(doxygen_mathjax YES)
  set(link_mathjax COMMAND ${CMAKE_COMMAND} -E create_symlink ${THERMOPOWER_MATHJAX} ${PROJECT_BINARY_DIR}/docs/html/mathjax)
else()
  set(doxygen_mathjax NO)
endif()
if(DOXYGEN_DOT_FOUND)
  set(doxygen_dot YES)
else()
  set(doxygen_dot NO)
endif()
configure_file(${PROJECT_SOURCE_DIR}/docs/Doxyfile.in ${PROJECT_BINARY_DIR}/docs/Doxyfile @ONLY)

add_custom_target(docs COMMAND ${CMAKE_COMMAND} -E rm -rf ${PROJECT_BINARY_DIR}/docs/html
                       COMMAND Doxygen::doxygen ${PROJECT_BINARY_DIR}/docs/Doxyfile ${link_mathjax}
                       WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Documentation in ${PROJECT_BINARY_DIR}/docs/html" VERBATIM)
