# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Installs anew and forgets earlier consumers: what they cached would hide a change of the package.
file(GLOB old LIST_DIRECTORIES true ${WORK}/prefix ${WORK}/find_package* ${WORK}/add_subdirectory ${WORK}/plain_include ${WORK}/pkg_config)
if(old)
  file(REMOVE_RECURSE ${old})
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
