// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <cstdio>
#include <cstdlib>

#include "two_node_plant.hpp"

/// A million actuators inside their bounds, fixed and shaken, against every adversary: none may exceed a
/// limit. Usage: certified_million [actuators [seed]]
int main(int argument_count, char** arguments) {
  using namespace certified_test;
  const long actuators = argument_count > 1 ? std::atol(arguments[1]) : 1000000;
  Random random(argument_count > 2 ? static_cast<std::uint64_t>(std::atoll(arguments[2])) : 1);
  double winding_K = -1e9, body_K = -1e9, over_bound_K = -1e9;
  long exceeded = 0, within_1_K = 0, limited = 0, total = 0;
  for (long i = 0; i < actuators; ++i) {
    const Declared declared = draw_bounds(random);
    const double dangers[] = {0.3, 0.9, 1.0, 1.0};
    const double danger = dangers[random() % 4];
    const int steps = static_cast<int>(log_uniform(random, 20.0, 1000.0));
    const Excess excess =
        run(random, declared, draw_truth(random, declared, danger), i % 2 ? danger : -1.0, steps);
    if (excess.winding_K > 0.0 || excess.body_K > 0.0 || excess.over_bound_K > 0.0 || excess.lost_certificate)
      ++exceeded;
    if (excess.winding_K > -1.0 || excess.body_K > -1.0) ++within_1_K;
    winding_K = std::max(winding_K, excess.winding_K);
    body_K = std::max(body_K, excess.body_K);
    over_bound_K = std::max(over_bound_K, excess.over_bound_K);
    limited += excess.limited;
    total += steps;
  }
  std::printf("actuators inside their bounds   %ld\n", actuators);
  std::printf("steps simulated                 %ld, %.1f %% of them limited\n", total,
              100.0 * static_cast<double>(limited) / static_cast<double>(total));
  std::printf("came within 1 K of a limit      %ld\n", within_1_K);
  std::printf("exceeded a limit or a bound,\nor left the safe set            %ld\n", exceeded);
  std::printf("closest to its limit, K         winding %.6f, body %.6f\n", -winding_K, -body_K);
  std::printf("closest to its upper bound, K   %.6f\n", -over_bound_K);
  return exceeded == 0 ? 0 : 1;
}
