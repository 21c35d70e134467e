# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# cmake -DROOT=<repo> -DCLANG_FORMAT=<program> -P formatting.cmake: every source is as .clang-format has it.
# Mend: git ls-files '*.cpp' '*.hpp' | xargs clang-format -i
set(sources)
foreach(folder include tools tests examples)
  file(GLOB_RECURSE found RELATIVE ${ROOT} ${ROOT}/${folder}/*.hpp ${ROOT}/${folder}/*.cpp)
  list(APPEND sources ${found})
endforeach()
list(LENGTH sources count)
if(count LESS 300)
  message(FATAL_ERROR "only ${count} sources below ${ROOT}: is the path right?")
endif()
execute_process(COMMAND ${CLANG_FORMAT} --dry-run --Werror --ferror-limit=1 ${sources} WORKING_DIRECTORY ${ROOT} RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "not as .clang-format has it: the files above")
endif()
