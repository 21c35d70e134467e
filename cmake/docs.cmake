# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Target `docs`: the API and the pages of docs/ as HTML in <build>/docs/html. A warning of Doxygen's is an error.
find_package(Doxygen 1.9.4 REQUIRED OPTIONAL_COMPONENTS dot)
find_path(THERMOPOWER_DOXYGEN_AWESOME doxygen-awesome.css PATHS /usr/share/doxygen-awesome-css)
# Formulas are typeset once, here, with KaTeX (Debian: katex and nodejs). Without it pages show their LaTeX.
find_program(THERMOPOWER_NODE NAMES node nodejs)
find_path(THERMOPOWER_KATEX katex.min.css PATHS /usr/share/javascript/katex)
mark_as_advanced(THERMOPOWER_DOXYGEN_AWESOME THERMOPOWER_NODE THERMOPOWER_KATEX)

set(doxygen_css)
if(THERMOPOWER_DOXYGEN_AWESOME)
  set(doxygen_css "${THERMOPOWER_DOXYGEN_AWESOME}/doxygen-awesome.css ${THERMOPOWER_DOXYGEN_AWESOME}/doxygen-awesome-sidebar-only.css")
endif()
set(typeset)
if(THERMOPOWER_NODE AND THERMOPOWER_KATEX)
  set(typeset COMMAND ${THERMOPOWER_NODE} ${PROJECT_SOURCE_DIR}/cmake/typeset.cjs ${PROJECT_BINARY_DIR}/docs/html ${THERMOPOWER_KATEX})
else()
  message(STATUS "thermopower: no KaTeX here (Debian: katex, nodejs): the documentation shows formulas as LaTeX")
endif()
# Doxygen's own header loads MathJax into every page, which blocks each for seconds. This one is the same without.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/docs)
execute_process(COMMAND ${DOXYGEN_EXECUTABLE} -w html header.html footer.html style.css WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/docs
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(READ ${PROJECT_BINARY_DIR}/docs/header.html header)
string(REPLACE "$mathjax" "" header "${header}")
file(WRITE ${PROJECT_BINARY_DIR}/docs/header.html "${header}")
if(DOXYGEN_DOT_FOUND)
  set(doxygen_dot YES)
else()
  set(doxygen_dot NO)
endif()
configure_file(${PROJECT_SOURCE_DIR}/docs/Doxyfile.in ${PROJECT_BINARY_DIR}/docs/Doxyfile @ONLY)

add_custom_target(docs COMMAND ${CMAKE_COMMAND} -E rm -rf ${PROJECT_BINARY_DIR}/docs/html
                       COMMAND Doxygen::doxygen ${PROJECT_BINARY_DIR}/docs/Doxyfile ${typeset}
                       COMMAND ${CMAKE_COMMAND} -DPAGES=${PROJECT_BINARY_DIR}/docs/html -P ${PROJECT_SOURCE_DIR}/cmake/docs_requests.cmake
                       WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Documentation in ${PROJECT_BINARY_DIR}/docs/html" VERBATIM)
