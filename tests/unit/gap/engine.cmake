# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

thermopower_add_test(gap_engine_effects LINK thermopower::gap SOURCES engine_effects.cpp engine_shortened.cpp)
set_target_properties(gap_engine_effects PROPERTIES UNITY_BUILD ON)  # both compile all of the engine, which takes a minute
thermopower_add_test(gap_engine_verdicts LINK thermopower::gap TIMEOUT 600 SOURCES engine_verdicts.cpp)
