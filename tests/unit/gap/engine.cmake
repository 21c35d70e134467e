# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

thermopower_add_test(gap_engine_effects LINK thermopower::desktop SOURCES engine_effects.cpp)
thermopower_add_test(gap_engine_shortened LINK thermopower::desktop SOURCES engine_shortened.cpp)
thermopower_add_test(gap_engine_verdicts LINK thermopower::desktop SOURCES engine_verdicts.cpp)
