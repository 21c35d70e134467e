# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Installs anew and forgets earlier consumers: what they cached would hide a change of the package.
file(GLOB old LIST_DIRECTORIES true ${WORK}/prefix ${WORK}/headers_prefix ${WORK}/unbuilt ${WORK}/find_package* ${WORK}/add_subdirectory ${WORK}/plain_include ${WORK}/pkg_config)
if(old)
  file(REMOVE_RECURSE ${old})
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)

# The headers alone, from a build directory in which nothing has been built.
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/unbuilt -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
                        -DTHERMOPOWER_TESTS=OFF -DTHERMOPOWER_EXAMPLES=OFF -DTHERMOPOWER_TOOLS=OFF
                COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${WORK}/unbuilt --prefix ${WORK}/headers_prefix --component headers
                COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
