# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Controllers on the simulated rig. Included by this directory's CMakeLists.txt, anywhere.
thermopower_add_test(rig_bytes LINK thermopower::desktop SOURCES rig_bytes_test.cpp)

# On the chip too, where its programs can be built: known only at the end of the directory.
function(thermopower_add_rig_chip_test)
  if(COMMAND thermopower_add_nano_test AND TARGET nano_rig)
    thermopower_add_nano_test(rig_chip)
  endif()
endfunction()
cmake_language(DEFER CALL thermopower_add_rig_chip_test)
