# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Target `docs`: the API and the pages of docs/ as HTML in <build>/docs/html. A warning of Doxygen's is an error.
find_package(Doxygen 1.9.4 REQUIRED OPTIONAL_COMPONENTS dot)
find_path(THERMOPOWER_DOXYGEN_AWESOME doxygen-awesome.css PATHS /usr/share/doxygen-awesome-css)
# Formulas are typeset once, here, with KaTeX (Debian: katex and nodejs). Without it pages show their LaTeX.
find_program(THERMOPOWER_NODE NAMES node nodejs)
# Pages are Markdown that a code host shows; docs/for_doxygen.py makes of them what Doxygen knows.
find_program(THERMOPOWER_PYTHON_PROGRAM NAMES python3 REQUIRED)
find_path(THERMOPOWER_KATEX katex.min.css PATHS /usr/share/javascript/katex)
mark_as_advanced(THERMOPOWER_DOXYGEN_AWESOME THERMOPOWER_NODE THERMOPOWER_KATEX)

set(doxygen_css "${PROJECT_SOURCE_DIR}/docs/pages.css")
if(THERMOPOWER_DOXYGEN_AWESOME)
  set(doxygen_css "${THERMOPOWER_DOXYGEN_AWESOME}/doxygen-awesome.css ${THERMOPOWER_DOXYGEN_AWESOME}/doxygen-awesome-sidebar-only.css ${doxygen_css}")
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
set(into_head "")
set(full_text)
set(link_names)
if(THERMOPOWER_NODE)
  set(link_names COMMAND ${THERMOPOWER_NODE} ${PROJECT_SOURCE_DIR}/cmake/link_names.cjs ${PROJECT_BINARY_DIR}/docs/html)
  file(READ ${PROJECT_SOURCE_DIR}/cmake/search_header.html into_head)
  set(full_text COMMAND ${THERMOPOWER_NODE} ${PROJECT_SOURCE_DIR}/cmake/full_text.cjs ${PROJECT_BINARY_DIR}/docs/html)
endif()
string(REPLACE "$mathjax" "${into_head}" header "${header}")
file(WRITE ${PROJECT_BINARY_DIR}/docs/header.html "${header}")
# What a class is for, and its example, come before the lists of its members.
execute_process(COMMAND ${DOXYGEN_EXECUTABLE} -l layout.xml WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/docs OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(READ ${PROJECT_BINARY_DIR}/docs/layout.xml layout)
string(FIND "${layout}" "<class>" begin)
string(FIND "${layout}" "</class>" end)
math(EXPR length "${end} - ${begin}")
string(SUBSTRING "${layout}" ${begin} ${length} of_a_class)
string(REPLACE "<detaileddescription title=\"\"/>" "" changed "${of_a_class}")
string(REPLACE "<briefdescription visible=\"yes\"/>" "<briefdescription visible=\"no\"/>" changed "${changed}")
string(REPLACE "<memberdecl>" "<detaileddescription title=\"\"/>\n    <memberdecl>" changed "${changed}")
string(REPLACE "${of_a_class}" "${changed}" layout "${layout}")
file(WRITE ${PROJECT_BINARY_DIR}/docs/layout.xml "${layout}")
if(DOXYGEN_DOT_FOUND)
  set(doxygen_dot YES)
else()
  set(doxygen_dot NO)
endif()
# The page "Try it here": its program is optional, the page says so where it is missing.
include(cmake/web.cmake)
set(web_files)
if(thermopower_web_script)
  set(web_files COMMAND ${CMAKE_COMMAND} -E copy ${thermopower_web_script} ${PROJECT_BINARY_DIR}/docs/html)
endif()
configure_file(${PROJECT_SOURCE_DIR}/docs/Doxyfile.in ${PROJECT_BINARY_DIR}/docs/Doxyfile @ONLY)

# Plain English is held here, too: tests/docs/prose.py says which sentence is too long or a riddle.
set(prose COMMAND ${THERMOPOWER_PYTHON_PROGRAM} -B ${PROJECT_SOURCE_DIR}/tests/docs/prose.py check ${PROJECT_SOURCE_DIR})
mark_as_advanced(THERMOPOWER_PYTHON_PROGRAM)

add_custom_target(docs ${prose} COMMAND ${CMAKE_COMMAND} -E rm -rf ${PROJECT_BINARY_DIR}/docs/html
                       COMMAND Doxygen::doxygen ${PROJECT_BINARY_DIR}/docs/Doxyfile ${typeset}
                       COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/tools/web/try_it_here.js
                               ${PROJECT_SOURCE_DIR}/tools/docs-search/find.js ${PROJECT_BINARY_DIR}/docs/html
                       ${link_names} ${full_text}
                       ${web_files}
                       COMMAND ${CMAKE_COMMAND} -DPAGES=${PROJECT_BINARY_DIR}/docs/html -P ${PROJECT_SOURCE_DIR}/cmake/docs_requests.cmake
                       WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Documentation in ${PROJECT_BINARY_DIR}/docs/html" VERBATIM)
if(thermopower_web_script)
  add_dependencies(docs web)
endif()

# cmake --build <build> --target docs_in_browser: the pages on a telephone and on a desk, and "Try it here" tried.
find_program(THERMOPOWER_CHROMIUM NAMES chromium chromium-browser google-chrome)
mark_as_advanced(THERMOPOWER_CHROMIUM)
if(THERMOPOWER_CHROMIUM AND THERMOPOWER_NODE)
  add_custom_target(docs_in_browser COMMAND ${THERMOPOWER_NODE} ${PROJECT_SOURCE_DIR}/tests/docs/in_browser.cjs ${THERMOPOWER_CHROMIUM}
                                            ${PROJECT_BINARY_DIR}/docs/html VERBATIM USES_TERMINAL)
  add_dependencies(docs_in_browser docs)
endif()
