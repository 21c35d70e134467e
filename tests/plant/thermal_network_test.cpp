// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Thermal networks against the bench's bodies of one to four nodes, and against equations that are written and stepped
// here.
#include "../catch.hpp"

#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/network_plant.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace thermopower;

namespace {

constexpr double air_C = 21.0, ohm = 1.8, tempco = 0.00393;

/// A body written as plain numbers: C_i dT_i/dt = heat_i + sum G (T_k - T_i), with the air as the place after all nodes.
struct Equations {
  struct Path {
    std::size_t a, b;
    double W_per_K;
  };
  std::vector<double> J_per_K;
  std::vector<Path> paths;
  std::vector<double> share;  // of I^2 R
  std::size_t wound = 0;

  std::vector<double> slope(const std::vector<double>& T, double A) const {
    std::vector<double> W(T.size(), 0.0);
    const double heat = A * A * ohm * (1.0 + tempco * (T[wound] - 25.0));
    for (std::size_t i = 0; i < T.size(); ++i) W[i] = share[i] * heat;
    for (const Path& path : paths) {
      const double flow = path.W_per_K * (T[path.a] - (path.b < T.size() ? T[path.b] : air_C));
      W[path.a] -= flow;
      if (path.b < T.size()) W[path.b] += flow;
    }
    for (std::size_t i = 0; i < T.size(); ++i) W[i] /= J_per_K[i];
    return W;
  }

  /// Every node at every row, by the classical Runge-Kutta rule in `steps` steps between rows.
  std::vector<std::vector<double>> stepped(const Eigen::VectorXd& A, double interval_s, int steps) const {
    std::vector<double> T(J_per_K.size(), air_C);
    std::vector<std::vector<double>> all;
    const double h = interval_s / steps;
    const auto moved = [](const std::vector<double>& x, const std::vector<double>& by, double s) {
      std::vector<double> result = x;
      for (std::size_t i = 0; i < x.size(); ++i) result[i] += s * by[i];
      return result;
    };
    for (const double current : A) {
      all.push_back(T);
      for (int i = 0; i < steps; ++i) {
        const auto k1 = slope(T, current), k2 = slope(moved(T, k1, h / 2.0), current),
                   k3 = slope(moved(T, k2, h / 2.0), current), k4 = slope(moved(T, k3, h), current);
        for (std::size_t n = 0; n < T.size(); ++n)
          T[n] += h / 6.0 * (k1[n] + 2.0 * k2[n] + 2.0 * k3[n] + k4[n]);
      }
    }
    return all;
  }

  /// The same as a network, the winding measured.
  plant::ThermalNetwork network() const {
    plant::ThermalNetwork result;
    const auto name = [&](std::size_t i) { return i < J_per_K.size() ? "n" + std::to_string(i) : "air"; };
    for (std::size_t i = 0; i < J_per_K.size(); ++i)
      result.nodes.push_back({name(i), J_per_K[i], i == wound ? "motor_C" : ""});
    result.given = {{"air", "ambient_C"}};
    for (const Path& path : paths) result.links.push_back({name(path.a), name(path.b), path.W_per_K});
    plant::NetworkHeat heat{"current_A", {}, plant::NetworkWinding{name(wound), ohm, tempco, 25.0}};
    for (std::size_t i = 0; i < share.size(); ++i)
      if (share[i] > 0.0) heat.shares[name(i)] = share[i];
    result.heat = {heat};
    return result;
  }
};

gap::Recording driven(Eigen::Index rows, double interval_s) {
  gap::Recording r;
  r.name = "steps of the current";
  r.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, interval_s * static_cast<double>(rows - 1));
  Eigen::VectorXd current(rows);
  for (Eigen::Index i = 0; i < rows; ++i)
    current[i] = (i / 50) % 3 == 2 ? 0.0 : (i / 50) % 3 == 1 ? -1.6 : 3.1;
  // One reading to begin with, and none that a hidden start could be fitted to.
  Eigen::VectorXd motor = Eigen::VectorXd::Constant(rows, std::nan(""));
  motor[0] = air_C;
  r.set("current_A", current);
  r.set("ambient_C", Eigen::VectorXd::Constant(rows, air_C));
  r.set("motor_C", motor);
  return r;
}

Eigen::VectorXd simulated(const gap::Model& model, const gap::Recording& recording) {
  for (const auto& one : gap::simulate(model, recording))
    if (to_string(one.signal) == "motor_C") return one.values;
  return {};
}

/// What a thermometer of the kind that is logged resolves.
constexpr double resolved_K = 0.02;

/// A body of the bench, and the same as equations.
struct Twin {
  gap::Model bench;
  Equations equations;
};

Twin twin(int nodes, double coupling) {
  constexpr double C = 90.0, G = 0.25, winding = 0.3, mount = 0.4, box = 0.15, box_G = 0.6;
  Twin twin;
  twin.bench.name = "bench";
  twin.bench.current = gap::OhmicCurrentModel{ohm, tempco, 25.0};
  twin.bench.thermal = gap::LumpedThermalModel{C, G};
  if (nodes > 1)
    twin.bench.effects["second_thermal_mass"] = {{"winding_share", winding}, {"coupling", coupling}};
  if (nodes > 2) twin.bench.effects["third_thermal_mass"] = {{"share", mount}, {"coupling", 0.5 * coupling}};
  if (nodes > 3) twin.bench.effects["enclosure"] = {{"share", box}, {"W_per_K", box_G}};
  const double rest = nodes > 2 ? 1.0 - mount : 1.0;
  Equations& e = twin.equations;
  if (nodes == 1) e = {{C}, {{0, 1, G}}, {1.0}};
  if (nodes == 2) e = {{C * winding, C * (1.0 - winding)}, {{0, 1, coupling}, {1, 2, G}}, {1.0, 0.0}};
  if (nodes == 3)
    e = {{C * rest * winding, C * rest * (1.0 - winding), C * mount},
         {{0, 1, coupling}, {1, 2, 0.5 * coupling}, {1, 3, G}},
         {1.0, 0.0, 0.0}};
  if (nodes == 4)
    e = {{C * rest * winding, C * rest * (1.0 - winding), C * mount, C * box},
         {{0, 1, coupling}, {1, 2, 0.5 * coupling}, {1, 3, G}, {3, 4, box_G}},
         {1.0, 0.0, 0.0, 0.0}};
  return twin;
}

}  // namespace

TEST_CASE(
    "a network of one to four nodes warms as the bench's body does, and as its equations in fine steps do") {
  const int nodes = GENERATE(1, 2, 3, 4);
  const double coupling = GENERATE(0.4, 6.0, 300.0);
  const double interval_s = GENERATE(0.5, 4.0);
  CAPTURE(nodes, coupling, interval_s);
  const Twin body = twin(nodes, coupling);
  const gap::Recording r = driven(400, interval_s);
  const auto fine = body.equations.stepped(r.column("current_A"), interval_s, coupling > 100.0 ? 800 : 40);
  const Eigen::VectorXd network = simulated(plant::network_model(body.equations.network(), "network"), r),
                        bench = simulated(body.bench, r);
  REQUIRE(network.size() == r.rows());
  REQUIRE(bench.size() == r.rows());
  double from_fine = 0.0, from_bench = 0.0, warmest = 0.0;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const double truth = fine[static_cast<std::size_t>(i)][0];
    warmest = std::max(warmest, truth);
    from_fine = std::max(from_fine, std::abs(network[i] - truth));
    from_bench = std::max(from_bench, std::abs(network[i] - bench[i]));
  }
  CHECK(warmest > air_C + 10.0);  // there is something to be wrong about
  CHECK(from_fine < resolved_K);
  CHECK(from_bench < 2.0 * resolved_K);  // each is off by its own steps
}

TEST_CASE("a chain of twelve nodes, fast and slow ones, warms as its equations in fine steps do") {
  Equations chain;
  for (std::size_t i = 0; i < 12; ++i) {
    chain.J_per_K.push_back(i % 3 == 0 ? 2.0 : 15.0 + 10.0 * static_cast<double>(i));
    chain.paths.push_back({i, i + 1, i % 4 == 1 ? 40.0 : 1.5});
    chain.share.push_back(i == 2 ? 0.8 : i == 5 ? 0.2 : 0.0);
  }
  chain.wound = 2;
  const gap::Recording r = driven(600, 2.0);
  const auto fine = chain.stepped(r.column("current_A"), 2.0, 400);
  const Eigen::VectorXd network = simulated(plant::network_model(chain.network(), "chain"), r);
  double off = 0.0, warmest = 0.0;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    off = std::max(off, std::abs(network[i] - fine[static_cast<std::size_t>(i)][2]));
    warmest = std::max(warmest, fine[static_cast<std::size_t>(i)][2]);
  }
  CHECK(warmest > air_C + 10.0);
  CHECK(off < resolved_K);
}

TEST_CASE("an insulated network keeps every joule that it is given") {
  plant::ThermalNetwork network;
  network.nodes = {{"winding", 12.0, "winding_C"}, {"stator", 70.0, "stator_C"}, {"frame", 300.0, "frame_C"}};
  network.links = {{"winding", "stator", 2.0}, {"stator", "frame", 900.0}};
  network.heat = {{"heat_W", {{"winding", 0.75}, {"frame", 0.25}}}};
  gap::Recording r;
  r.t_s = Eigen::VectorXd::LinSpaced(200, 0.0, 995.0);
  Eigen::VectorXd heat(200), at_first = Eigen::VectorXd::Constant(200, std::nan(""));
  double joule = 0.0;
  for (Eigen::Index i = 0; i < 200; ++i) {
    heat[i] = i % 60 < 30 ? 14.0 : 3.0;
    if (i + 1 < 200) joule += 5.0 * heat[i];
  }
  at_first[0] = 25.0;
  r.set("heat_W", heat);
  for (const char* column : {"winding_C", "stator_C", "frame_C"}) r.set(column, at_first);
  double kept = 0.0;
  for (const auto& one : gap::simulate(plant::network_model(network, "insulated"), r)) {
    const std::string name = to_string(one.signal);
    const double J_per_K = name == "winding_C" ? 12.0 : name == "stator_C" ? 70.0 : 300.0;
    kept += J_per_K * (one.values[199] - 25.0);
  }
  CHECK(kept == Approx(joule).epsilon(1e-9));
}

TEST_CASE("derivatives of a network are those of what it simulates") {
  plant::ThermalNetwork network;
  network.nodes = {
      {"winding", 12.0, "winding_C"}, {"stator", 70.0}, {"frame", 300.0, "frame_C"}, {"mount", 500.0}};
  network.given = {{"air", "ambient_C"}};
  network.links = {
      {"winding", "stator", 1.1}, {"stator", "frame", 2.0}, {"frame", "mount", 3.0}, {"frame", "air", 0.6}};
  network.heat = {
      {"current_A", {{"winding", 0.9}, {"stator", 0.1}}, plant::NetworkWinding{"winding", ohm, tempco}}};
  const gap::Model model = plant::network_model(network, "network");
  const plant::Plant& plant = *model.own->equations;
  const gap::Catalogue& effects = *plant.effects();

  // Short intervals, that are stepped in one: where steps are cut, values jump by what they are off, and differences of
  // them tell nothing.
  const gap::Recording r = driven(400, 0.4);
  plant::Inputs inputs;
  inputs.own = true;
  inputs.t_s = r.t_s;
  inputs.runs = {{0, r.rows(), ""}};
  inputs.own_inputs = {r.column("ambient_C"), r.column("current_A")};
  inputs.measured[0] = Eigen::VectorXd::Constant(r.rows(), 24.0);
  inputs.measured[1] = Eigen::VectorXd::Constant(r.rows(), 22.0);
  const plant::Segment whole{&inputs, inputs.runs[0], 0, r.rows(), false, false, false};

  plant::ParameterPoint point;
  point.factors.assign(model.calibrated().size(), 1.03);
  for (const gap::EffectInfo& effect : effects.list()) {
    point.effects = {effects.find(effect.id)};
    point.parameters.clear();
    for (const gap::Parameter& parameter : effect.parameters)
      point.parameters.push_back(parameter.starts.front() != 0.0 ? parameter.starts.front()
                                                                 : 0.01 * parameter.upper);
    const int size = point.size() + plant.start_size(whole);
    INFO(effect.id);
    const auto values = [&](int index, double by) {
      plant::ParameterPoint moved = point;
      plant::Start start = plant::Start::Zero(plant.start_size(whole));
      const int factors = static_cast<int>(point.factors.size());
      if (index < factors) moved.factors[static_cast<std::size_t>(index)] += by;
      else if (index < point.size()) moved.parameters[static_cast<std::size_t>(index - factors)] += by;
      else start[index - point.size()] += by;
      plant::Readings readings;
      plant.rollout(model, effects, moved, {}, plant::SimulationMode::free_running)
          ->roll(whole, start, readings);
      return readings;
    };
    for (int first = 0; first < size; first += plant.directions_at_once()) {
      plant::Directions directions{first, std::min(plant.directions_at_once(), size - first)};
      plant::Readings exact;
      plant.rollout(model, effects, point, directions, plant::SimulationMode::free_running)
          ->roll(whole, plant::Start::Zero(plant.start_size(whole)), exact);
      for (int d = 0; d < directions.count; ++d) {
        const int index = first + d;
        const double scale =
            index >= point.size() ? 1.0
            : index < static_cast<int>(point.factors.size())
                ? 1.0
                : std::abs(point.parameters[static_cast<std::size_t>(index) - point.factors.size()]);
        const double h = 1e-3 * scale;
        const plant::Readings above = values(index, h), below = values(index, -h);
        double relative[2] = {0.0, 0.0};
        for (int k = 0; k < 2; ++k) {
          double largest = 0.0, off = 0.0;
          for (Eigen::Index row = 0; row < r.rows(); ++row) {
            const double slope = (above.value(row, k) - below.value(row, k)) / (2.0 * h);
            largest = std::max(largest, std::abs(slope) * scale);
            off = std::max(off, std::abs(slope - exact.slope(row, k, d)) * scale);
          }
          relative[k] = off / (largest + 1e-2);
        }
        CAPTURE(index);
        CHECK(relative[0] <= 1e-3);
        CHECK(relative[1] <= 1e-3);
      }
    }
  }
}

TEST_CASE("hidden nodes start where their neighbours leave them, or where the network says") {
  plant::ThermalNetwork network;
  network.nodes = {
      {"winding", 12.0, "winding_C"}, {"stator", 70.0}, {"frame", 300.0, "frame_C"}, {"mount", 500.0}};
  network.given = {{"air", "ambient_C"}};
  network.links = {
      {"winding", "stator", 1.0}, {"stator", "frame", 3.0}, {"frame", "mount", 2.0}, {"mount", "air", 6.0}};
  gap::Recording r;
  r.t_s = Eigen::VectorXd::LinSpaced(3, 0.0, 0.002);
  Eigen::VectorXd winding(3), frame(3);
  winding << 90.0, std::nan(""), std::nan("");
  frame << 40.0, std::nan(""), std::nan("");
  r.set("winding_C", winding);
  r.set("frame_C", frame);
  r.set("ambient_C", Eigen::VectorXd::Constant(3, 20.0));
  const auto slopes = [&](const plant::ThermalNetwork& body) {
    std::vector<double> K_per_s;
    for (const auto& one : gap::simulate(plant::network_model(body, "network"), r))
      K_per_s.push_back((one.values[2] - one.values[0]) / 0.002);
    return K_per_s;
  };
  // (90 + 3 * 40) / 4 = 52.5 for the stator, (2 * 40 + 6 * 20) / 8 = 25 for the mount.
  const auto left = slopes(network);
  CHECK(left[0] == Approx((52.5 - 90.0) / 12.0).epsilon(1e-3));
  CHECK(left[1] == Approx((3.0 * (52.5 - 40.0) + 2.0 * (25.0 - 40.0)) / 300.0).epsilon(1e-3));
  network.nodes[1].initial_C = 62.0;
  const auto said = slopes(network);
  CHECK(said[0] == Approx((62.0 - 90.0) / 12.0).epsilon(1e-3));
  CHECK(said[1] == Approx((3.0 * (62.0 - 40.0) + 2.0 * (25.0 - 40.0)) / 300.0).epsilon(1e-3));
}

TEST_CASE("a segment that is rolled again gives what it gave before, hidden nodes carried into it") {
  plant::ThermalNetwork network;
  network.nodes = {{"winding", 12.0, "winding_C"}, {"frame", 300.0}};
  network.given = {{"air", "ambient_C"}};
  network.links = {{"winding", "frame", 1.0}, {"frame", "air", 0.3}};
  network.heat = {{"heat_W", {{"winding", 1.0}}}};
  const gap::Model model = plant::network_model(network, "network");
  plant::Inputs inputs;
  inputs.own = true;
  inputs.t_s = Eigen::VectorXd::LinSpaced(40, 0.0, 390.0);
  inputs.runs = {{0, 40, ""}};
  inputs.own_inputs = {Eigen::VectorXd::Constant(40, 20.0), Eigen::VectorXd::Constant(40, 9.0)};
  inputs.measured[0] = Eigen::VectorXd::Constant(40, 50.0);
  const plant::Segment first{&inputs, inputs.runs[0], 0, 20, true, false, false},
      second{&inputs, inputs.runs[0], 20, 40, true, true, false};
  const plant::Plant& plant = *model.own->equations;
  const auto rollout = plant.rollout(model, *plant.effects(), {}, {}, plant::SimulationMode::free_running);
  const plant::Start start = plant::Start::Zero(plant.start_size(first));
  plant::Readings once, again;
  rollout->roll(first, start, once);
  rollout->roll(second, start, once);
  rollout->roll(second, start, again);
  for (Eigen::Index row = 20; row < 40; ++row) CHECK(again.value(row, 0) == once.value(row, 0));
}

TEST_CASE("what is no network is refused in a sentence that says where") {
  plant::ThermalNetwork good;
  good.nodes = {{"winding", 12.0, "winding_C"}, {"stator", 70.0}, {"frame", 300.0, "frame_C"}};
  good.given = {{"air", "ambient_C"}};
  good.links = {{"winding", "stator", 1.0}, {"stator", "frame", 3.0}, {"frame", "air", 0.5}};
  good.heat = {{"current_A", {{"winding", 1.0}}, plant::NetworkWinding{"winding"}}};
  REQUIRE_FALSE(good.validate());
  struct Wrong {
    const char* where;
    const char* says;
    void (*make)(plant::ThermalNetwork&);
  };
  using Network = plant::ThermalNetwork;
  const std::vector<Wrong> all = {
      {"nodes", "1 to 16", [](Network& n) { n.nodes.clear(); }},
      {"nodes", "expected 1 to 8", [](Network& n) { n.nodes[0].column = n.nodes[2].column = ""; }},
      {"nodes/stator/heat_capacity_J_per_K", "is -70; expected a number above 0",
       [](Network& n) { n.nodes[1].heat_capacity_J_per_K = -70.0; }},
      {"nodes/stator/heat_capacity_J_per_K", "expected a number above 0",
       [](Network& n) { n.nodes[1].heat_capacity_J_per_K = std::nan(""); }},
      {"nodes/2nd", "no name", [](Network& n) { n.nodes[1].name = "2nd"; }},
      {"nodes/winding", "twice", [](Network& n) { n.nodes[1].name = "winding"; }},
      {"nodes/frame/column", "twice", [](Network& n) { n.nodes[2].column = "winding_C"; }},
      {"nodes/frame/initial_C", "finite", [](Network& n) { n.nodes[2].initial_C = INFINITY; }},
      {"nodes/mount", "has no link",
       [](Network& n) {
         n.nodes.push_back({"mount", 9.0, "mount_C"});
       }},
      {"nodes/mount", "no way to a node that is measured",
       [](Network& n) {
         n.nodes.push_back({"mount", 9.0});
         n.links.push_back({"mount", "air", 1.0});
       }},
      {"given/air/column", "is empty", [](Network& n) { n.given[0].column = ""; }},
      {"given/stator", "twice", [](Network& n) { n.given[0].name = "stator"; }},
      {"links/1/from", "'gear' is no node; expected one of winding, stator, frame",
       [](Network& n) { n.links[1].from = "gear"; }},
      {"links/2/from", "'air' is no node", [](Network& n) { std::swap(n.links[2].from, n.links[2].to); }},
      {"links/1/to", "neither a node nor a given temperature", [](Network& n) { n.links[1].to = "gear"; }},
      {"links/1/to", "expected another node", [](Network& n) { n.links[1].to = "stator"; }},
      {"links/3", "linked already",
       [](Network& n) {
         n.links.push_back({"stator", "winding", 1.0});
       }},
      {"links/0/conductance_W_per_K", "is 0; expected a number above 0",
       [](Network& n) { n.links[0].conductance_W_per_K = 0.0; }},
      {"heat/0/shares", "are 0.9 together; expected 1",
       [](Network& n) { n.heat[0].shares["winding"] = 0.9; }},
      {"heat/0/shares/rotor", "is no node",
       [](Network& n) {
         n.heat[0].shares = {{"rotor", 1.0}};
       }},
      {"heat/0/shares/stator", "is -0.5; expected 0 to 1",
       [](Network& n) {
         n.heat[0].shares = {{"stator", -0.5}, {"winding", 1.5}};
       }},
      {"heat/0/node", "is no node", [](Network& n) { n.heat[0].winding->node = "air"; }},
      {"heat/0/resistance_ohm", "above 0", [](Network& n) { n.heat[0].winding->resistance_ohm = 0.0; }},
      {"heat/1", "second winding",
       [](Network& n) {
         n.heat.push_back(n.heat[0]);
         n.heat[1].column = "other_A";
       }},
      {"heat/0/column", "twice", [](Network& n) { n.heat[0].column = "ambient_C"; }},
  };
  for (const Wrong& wrong : all) {
    plant::ThermalNetwork network = good;
    wrong.make(network);
    const auto problem = network.validate();
    INFO(wrong.where << ": " << wrong.says);
    REQUIRE(problem);
    CHECK(problem->where == wrong.where);
    CHECK(problem->what.find(wrong.says) != std::string::npos);
    CHECK_THROWS_AS(plant::network_model(network, "wrong"), plant::InvalidInput);
  }
}
