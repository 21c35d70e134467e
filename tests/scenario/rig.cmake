# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Controllers on the simulated rig. Included by this directory's CMakeLists.txt.
thermopower_add_test(rig_bytes LINK thermopower::desktop SOURCES rig_bytes_test.cpp)
if(COMMAND thermopower_add_nano_test)
  thermopower_add_nano_test(rig_chip)
endif()
