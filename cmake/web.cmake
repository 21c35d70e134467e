# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# The diagnosis as a program for the page "Try it here" (docs/learn/try-it-here.md): target `web`, WebAssembly by Emscripten
# from the same headers, into ${thermopower_web_script}. Left out, with a message, where Emscripten is missing.
set(thermopower_web_script "")
if(NOT THERMOPOWER_WEB)
  return()
endif()
find_program(THERMOPOWER_EMXX em++)
find_program(THERMOPOWER_NODE NAMES node nodejs)
find_package(Eigen3 3.4 QUIET NO_MODULE)
find_package(nlohmann_json 3.9 QUIET)
mark_as_advanced(THERMOPOWER_EMXX THERMOPOWER_NODE)
foreach(needed IN ITEMS THERMOPOWER_EMXX THERMOPOWER_NODE Eigen3_FOUND nlohmann_json_FOUND)
  if(NOT ${needed})
    message(STATUS "thermopower: no ${needed}: the page \"Try it here\" is built without its program (Debian: emscripten nodejs libeigen3-dev nlohmann-json3-dev)")
    return()
  endif()
endforeach()

set(web ${PROJECT_BINARY_DIR}/web)
# Headers of this machine's own libraries must not be found beside those of Emscripten: only the two folders that are meant.
get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
get_target_property(json nlohmann_json::nlohmann_json INTERFACE_INCLUDE_DIRECTORIES)
file(MAKE_DIRECTORY ${web}/include)
list(GET json 0 json)
file(CREATE_LINK ${json}/nlohmann ${web}/include/nlohmann SYMBOLIC)

# All of the two libraries, so that none of their files is forgotten here.
file(GLOB libraries CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/gap-library/*.cpp ${PROJECT_SOURCE_DIR}/tools/io-library/*.cpp)
list(TRANSFORM libraries REPLACE "\\.cpp$" "")
set(here ${PROJECT_SOURCE_DIR}/tools/web)
# Exceptions are those of WebAssembly: the older way, through JavaScript, costs a third of the speed.
set(flags -O2 -fwasm-exceptions -msimd128)
set(objects)
foreach(source IN LISTS libraries ITEMS ${here}/csv/csv ${here}/web_program)
  get_filename_component(name ${source} NAME)
  get_filename_component(folder ${source} DIRECTORY)
  get_filename_component(folder ${folder} NAME)
  set(object ${web}/${folder}_${name}.o)
  add_custom_command(OUTPUT ${object} DEPENDS ${source}.cpp ${here}/charconv_of_double.hpp DEPFILE ${object}.d VERBATIM
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs ${THERMOPOWER_EMXX} -std=c++17 -DNDEBUG ${flags} -DTHERMOPOWER_GAP_LIBRARY
            -include ${here}/charconv_of_double.hpp -I${PROJECT_SOURCE_DIR}/include -I${here}/csv -isystem ${eigen} -isystem ${web}/include
            -MD -MF ${object}.d -c ${source}.cpp -o ${object}
    COMMENT "WebAssembly: ${name}")
  list(APPEND objects ${object})
endforeach()
# One file, because a page that is opened from a disk may load scripts and nothing else.
set(program ${web}/program.js)
set(thermopower_web_script ${web}/thermopower_gap.js)
add_custom_command(OUTPUT ${program} DEPENDS ${objects} VERBATIM
  COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs ${THERMOPOWER_EMXX} ${flags} ${objects} -o ${program} -s SINGLE_FILE=1
          -s ALLOW_MEMORY_GROWTH=1 -s INITIAL_MEMORY=64MB -s TOTAL_STACK=4MB -s ENVIRONMENT=worker,node -s FORCE_FILESYSTEM=1
          -s EXPORTED_FUNCTIONS=_thermopower_diagnose,_thermopower_example,_thermopower_columns -s EXPORTED_RUNTIME_METHODS=FS,ccall
  COMMENT "WebAssembly: program")
add_custom_command(OUTPUT ${thermopower_web_script} DEPENDS ${program} ${here}/as_text.cjs VERBATIM
  COMMAND ${THERMOPOWER_NODE} ${here}/as_text.cjs ${program} ${thermopower_web_script})
add_custom_target(web DEPENDS ${thermopower_web_script})
