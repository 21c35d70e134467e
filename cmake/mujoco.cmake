# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# thermopower_has_mujoco says whether MuJoCo is at hand (Debian: libmujoco-dev); thermopower_link_mujoco(<target>) links it.
find_path(THERMOPOWER_MUJOCO_INCLUDE mujoco/mujoco.h)
find_library(THERMOPOWER_MUJOCO_LIBRARY mujoco)
mark_as_advanced(THERMOPOWER_MUJOCO_INCLUDE THERMOPOWER_MUJOCO_LIBRARY)
if(THERMOPOWER_MUJOCO_INCLUDE AND THERMOPOWER_MUJOCO_LIBRARY)
  set(thermopower_has_mujoco ON)
else()
  set(thermopower_has_mujoco OFF)
endif()

function(thermopower_link_mujoco target)
  target_include_directories(${target} SYSTEM PRIVATE ${THERMOPOWER_MUJOCO_INCLUDE})
  target_link_libraries(${target} PRIVATE ${THERMOPOWER_MUJOCO_LIBRARY})
endfunction()
