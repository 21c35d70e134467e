// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Prints the rules that the ablation can take away, a line each.
#include <thermopower/gap/rule.hpp>

#include <cstdio>

int main() {
  using thermopower::gap::engine::Rule;
  for (int i = 0; i < count_of(Rule{}); ++i) std::printf("%s\n", to_string(static_cast<Rule>(i)));
  return 0;
}
