// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include <cstdio>
#include <cstdlib>

#include "report.hpp"

namespace platform {
void start() {}
void put(char character) { std::putchar(character); }
void stop(int status) { std::exit(status); }
}  // namespace platform
