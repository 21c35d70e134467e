// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <vector>

#include "bench_draw.hpp"
#include "part.hpp"

namespace gap_benchmark {

/// What a body under a temperature controller may have, of what one sample a second can show.
inline const std::vector<std::string>& slow_log_effects() {
  static const std::vector<std::string> list = {"thermometer_lag", "second_thermal_mass", "radiation",
                                                "ambient_bias"};
  return list;
}

/// A controller that sets the power ten times a second and holds a goal that changes now and then; the log has each tenth row.
inline Recording controlled_body(const BenchSetup& setup, double length_s, double ambient_C, double& first_C,
                                 Random random) {
  constexpr double step_s = 0.1;
  constexpr int steps_a_row = 10;
  const BenchContext& c = setup.context;
  const BenchPlant plant(setup.plant);
  BenchInput u;
  u.ambient_C = ambient_C;
  u.supply_V = c.nominal_V;
  BenchState x = plant.start(u, ambient_C);
  first_C = ambient_C;
  Column t{"t_s", 1, {}}, power{"power_param", 0, {}}, air{"ambient_C", 2, {}}, body{"motor_C", 2, {}};
  double goal_C = ambient_C, until_s = -1.0, integral = 0.0;
  const double full_K = c.top_W / setup.plant[conductance], kp = 255.0 / (0.12 * full_K);
  const int rows = static_cast<int>(length_s);
  for (int row = 0; row < rows; ++row)
    for (int step = 0; step < steps_a_row; ++step) {
      const double t_s = row + step * step_s;
      if (t_s >= until_s) {
        goal_C = ambient_C + full_K * random.uniform(0.1, 0.6);
        until_s = t_s + setup.tau_s * random.uniform(0.4, 1.5);
        integral = 0.0;
      }
      const double seen_C = quantise(plant.sensed_temperature(u, x) + setup.noise_motor_C * random.gauss(),
                                     setup.quantum_motor_C);
      integral = std::clamp(integral + (goal_C - seen_C) * step_s * kp / (0.3 * setup.tau_s), 0.0, 255.0);
      u.power_param = std::round(std::clamp(kp * (goal_C - seen_C) + integral, 0.0, 255.0));
      if (step == 0) {
        t.values.push_back(row);
        power.values.push_back(u.power_param);
        air.values.push_back(quantise(ambient_C + setup.noise_ambient_C * random.gauss(), 0.01));
        body.values.push_back(seen_C);
      }
      plant.advance(x, u, step_s);
    }
  Recording log;
  log.columns = {t, power, air, body};
  return log;
}

/// One body, logged once a second. @param number  of the case: its effect; one in five has none
inline DrawnCase draw_slow_log_case(int number, Random& random) {
  const auto& all = slow_log_effects();
  const bool none = number % 5 == 4;
  const std::string effect = all[static_cast<std::size_t>(number - number / 5) % all.size()];
  BenchSetup setup = draw_bench({}, false, random);
  while (setup.context.current_is_input || !setup.context.knows_tempco) setup = draw_bench({}, false, random);
  BenchContext& c = setup.context;
  c.has_airspeed = c.has_neighbour = c.has_rate = c.has_supply = c.has_current = false;
  setup.plant = c.plant;
  if (!none) named(bench_effects(), effect).draw(random, c, setup.plant);
  setup.quantum_motor_C = 0.1;
  const double length_s = std::min(6.0 * setup.tau_s, 3000.0);
  DrawnCase drawn;
  double first_C = 0.0;
  drawn.train = controlled_body(setup, length_s, random.uniform(17.0, 28.0), first_C, Random(random.bits()));
  drawn.heldout =
      controlled_body(setup, 0.7 * length_s, random.uniform(17.0, 28.0), first_C, Random(random.bits()));
  drawn.model = bench_model_json(c);
  PartTruth truth;
  truth.title = (none ? std::string("none") : effect) + " at one row a second";
  if (!none) {
    truth.causes = {effect};
    truth.family = {effect};
    if (effect == "ambient_bias") truth.family.push_back("idle_heat");  // the same for a body with one loss
    if (effect == "radiation") truth.family.push_back("natural_convection");
  }
  drawn.label = truth.label(Part::slow_logs, "bench");
  return drawn;
}

}  // namespace gap_benchmark
