// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Bodies of three and four nodes that exchange heat slowly, fast, and faster than anybody samples, against the same
// bodies stepped here in milliseconds.
#include "../catch.hpp"

#include <thermopower/gap/simulate.hpp>

#include <algorithm>
#include <cmath>

using namespace thermopower::gap;

namespace {

/// Shares of 90 J/K, and conductances in W/K; 0: there is no such node.
struct Body {
  double winding_share = 0.0, coupling = 0.0;
  double mount_share = 0.0, to_mount = 0.0;
  double box_share = 0.0, box_to_room = 0.0;
  double sink_share = 0.0, to_sink = 0.0, sink_to_room = 0.0;  ///< on top of the 90 J/K
};

constexpr double capacity = 90.0, to_air = 0.2, air_C = 21.0, interval_s = 2.0;

Recording powered(int rows) {
  Recording r;
  r.name = "body";
  r.t_s.resize(rows);
  Eigen::VectorXd power(rows), ambient(rows), motor(rows);
  for (int i = 0; i < rows; ++i) {
    r.t_s[i] = interval_s * i;
    power[i] = (i / 40) % 3 == 2 ? 0.0 : (i / 40) % 3 == 1 ? 90.0 : 220.0;
    ambient[i] = air_C;
    motor[i] =
        i == 0 ? air_C : std::nan("");  // where the simulation starts, and nothing to fit hidden nodes to
  }
  r.set("power_param", power);
  r.set("ambient_C", ambient);
  r.set("motor_C", motor);
  return r;
}

Model model_of(const Body& body) {
  Model model;
  model.name = "body";
  model.supply = SupplyModel{12.0};
  model.current = OhmicCurrentModel{8.0, 0.00393, 25.0};
  model.thermal = LumpedThermalModel{capacity, to_air};
  if (body.winding_share > 0.0)
    model.effects["second_thermal_mass"] = {{"winding_share", body.winding_share},
                                            {"coupling", body.coupling}};
  if (body.mount_share > 0.0)
    model.effects["third_thermal_mass"] = {{"share", body.mount_share}, {"coupling", body.to_mount}};
  if (body.box_share > 0.0)
    model.effects["enclosure"] = {{"share", body.box_share}, {"W_per_K", body.box_to_room}};
  if (body.sink_share > 0.0)
    model.effects["contact_resistance"] = {{"J_per_K", capacity * body.sink_share},
                                           {"K_per_W", 1.0 / body.to_sink},
                                           {"W_per_K", body.sink_to_room}};
  return model;
}

/// Temperature of the winding at every row, in steps of the midpoint rule that are short against everything.
Eigen::VectorXd stepped(const Body& body, const Recording& r, double h_s) {
  const double rest = 1.0 - body.mount_share;
  const double winding_J = capacity * rest * body.winding_share,
               surface_J = capacity * rest * (1.0 - body.winding_share),
               mount_J = capacity * body.mount_share, box_J = capacity * body.box_share,
               sink_J = capacity * body.sink_share;
  struct Nodes {
    double winding = air_C, surface = air_C, mount = air_C, box = air_C, sink = air_C;
  };
  const auto slope = [&](const Nodes& x, double volt) {
    const double hot = body.winding_share > 0.0 ? x.winding : x.surface;
    const double heat_W = volt * volt / (8.0 * (1.0 + 0.00393 * (hot - 25.0)));
    const double lost_W = to_air * (x.surface - (body.box_share > 0.0 ? x.box : air_C)),
                 soaked_W = body.to_mount * (x.surface - x.mount) + body.to_sink * (x.surface - x.sink),
                 through_W = body.winding_share > 0.0 ? body.coupling * (x.winding - x.surface) : heat_W;
    Nodes rate{0.0, (through_W - lost_W - soaked_W) / surface_J, 0.0, 0.0, 0.0};
    if (winding_J > 0.0) rate.winding = (heat_W - through_W) / winding_J;
    if (mount_J > 0.0) rate.mount = soaked_W / mount_J;
    if (sink_J > 0.0)
      rate.sink = (body.to_sink * (x.surface - x.sink) - body.sink_to_room * (x.sink - air_C)) / sink_J;
    if (box_J > 0.0) rate.box = (lost_W - body.box_to_room * (x.box - air_C)) / box_J;
    return rate;
  };
  const auto moved = [](const Nodes& x, const Nodes& rate, double by_s) {
    return Nodes{x.winding + by_s * rate.winding, x.surface + by_s * rate.surface,
                 x.mount + by_s * rate.mount, x.box + by_s * rate.box, x.sink + by_s * rate.sink};
  };
  Nodes x;
  Eigen::VectorXd result(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    result[i] = body.winding_share > 0.0 ? x.winding : x.surface;
    const double volt = 12.0 * std::sqrt(r.column("power_param")[i] / 255.0);
    const int steps = static_cast<int>(std::ceil(interval_s / h_s));
    for (int k = 0; k < steps; ++k) {
      const double by_s = interval_s / steps;
      x = moved(x, slope(moved(x, slope(x, volt), 0.5 * by_s), volt), by_s);
    }
  }
  return result;
}

}  // namespace

TEST_CASE(
    "a body of three or four nodes warms as it does in steps of a millisecond, however fast they exchange") {
  const double coupling = GENERATE(0.5, 5.0, 60.0, 900.0);
  const Body body = GENERATE_COPY(
      Body{0.0, 0.0, 0.3, coupling, 0.0, 0.0}, Body{0.2, coupling, 0.3, 0.7, 0.0, 0.0},
      Body{0.2, coupling, 0.3, coupling, 0.0, 0.0}, Body{0.0, 0.0, 0.0, 0.0, 0.02, coupling},
      Body{0.3, coupling, 0.25, 2.0, 0.1, 0.3}, Body{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.5, coupling, 0.4},
      Body{0.3, coupling, 0.0, 0.0, 0.1, 0.3, 0.4, coupling, 0.2});
  CAPTURE(coupling, body.winding_share, body.mount_share, body.box_share, body.sink_share);
  const Recording r = powered(360);
  const Eigen::VectorXd reference = stepped(body, r, coupling > 100.0 ? 0.0005 : 0.004);
  Eigen::VectorXd simulated;
  for (const SimulatedSignal& one : simulate(model_of(body), r))
    if (one.signal == Signal::motor_C) simulated = one.values;
  REQUIRE(simulated.size() == r.rows());
  CHECK(reference.maxCoeff() - reference.minCoeff() > 10.0);
  CHECK((simulated - reference).cwiseAbs().maxCoeff() < 0.02);
}
