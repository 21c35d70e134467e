# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Formulas in pages, from the form that GitHub shows to the one that Doxygen knows.
s/\$`\([^`]*\)`\$/\\f$\1\\f$/g
/^ *```math$/,/^ *```$/{
  s/^\( *\)```math$/\1\\f[/
  s/^\( *\)```$/\1\\f]/
}
