// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Clocks that jump, loops that hang, starts in the middle of a run, and a supply below the highest: what every certified network
// promises through them. The actuator is integrated here from the balances of its nodes.

#include <thermopower/control/certified/limiter.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include "../../catch.hpp"

namespace {

using namespace thermopower;

typedef std::mt19937_64 Random;
double uniform(Random& random, double from, double to) {
  return from + (to - from) * (static_cast<double>(random() >> 11) / 9007199254740992.0);
}
double log_uniform(Random& random, double from, double to) {
  return from * std::pow(to / from, uniform(random, 0.0, 1.0));
}

constexpr int most_nodes = 4;

/// A row of nodes as it is, and what is declared of it.
struct Row {
  int nodes;
  double capacity_J[most_nodes], coupling_W[most_nodes], limit_C[most_nodes], node_C[most_nodes];
  double ohm, highest_V, air_C, highest_air_C, spread, hold_s, horizon_s;

  void slopes(const double* at_C, double full_W, double* per_s) const {
    double into = full_W / (1.0 + 0.0039 * (at_C[0] - 20.0));
    for (int k = 0; k < nodes; ++k) {
      const double onwards = coupling_W[k] * (at_C[k] - (k + 1 < nodes ? at_C[k + 1] : air_C));
      per_s[k] = (into - onwards) / capacity_J[k];
      into = onwards;
    }
  }
  // The midpoint rule, in parts of a twenty-fifth of the shortest time constant.
  void pass(double power, double volt, double seconds, double* hottest_over_K) {
    double fastest = 0.0;
    for (int k = 0; k < nodes; ++k)
      fastest = std::max(fastest, (coupling_W[k] + (k > 0 ? coupling_W[k - 1] : 0.0)) / capacity_J[k]);
    const int parts = 1 + static_cast<int>(seconds * fastest * 25.0);
    const double h = seconds / parts, full_W = volt * volt * power / 255.0 / ohm;
    for (int part = 0; part < parts; ++part) {
      double per_s[most_nodes], middle_C[most_nodes];
      slopes(node_C, full_W, per_s);
      for (int k = 0; k < nodes; ++k) middle_C[k] = node_C[k] + 0.5 * h * per_s[k];
      slopes(middle_C, full_W, per_s);
      for (int k = 0; k < nodes; ++k) {
        node_C[k] += h * per_s[k];
        *hottest_over_K = std::max(*hottest_over_K, node_C[k] - limit_C[k]);
      }
    }
  }
  double hottest_C() const { return *std::max_element(node_C, node_C + nodes); }
};

void declare(const Row& row, CertifiedOneNode::Config& config) {
  config = {Bounds::around(static_cast<float>(row.capacity_J[0]), static_cast<float>(row.spread)),
            static_cast<float>(row.coupling_W[0]), static_cast<float>(row.limit_C[0])};
}
void declare(const Row& row, CertifiedTwoNodeConfig& config) {
  config = {Bounds::around(static_cast<float>(row.capacity_J[0]), static_cast<float>(row.spread)),
            Bounds::around(static_cast<float>(row.capacity_J[1]), static_cast<float>(row.spread)),
            static_cast<float>(row.coupling_W[0]),
            static_cast<float>(row.coupling_W[1]),
            static_cast<float>(row.limit_C[0]),
            static_cast<float>(row.limit_C[1])};
}
void declare(const Row& row, CertifiedCoupledTwoNodeConfig& config) {
  declare(row, config.two_node);
  config.highest_coupling_W_per_K = static_cast<float>(1.2 * row.coupling_W[0]);
}
template <class Config>
auto declare(const Row& row, Config& config) -> decltype(config.nodes[0], void()) {
  for (int k = 0; k < row.nodes; ++k)
    config.nodes[k] = {Bounds::around(static_cast<float>(row.capacity_J[k]), static_cast<float>(row.spread)),
                       static_cast<float>(row.coupling_W[k]), static_cast<float>(row.limit_C[k])};
}

template <class Network>
typename CertifiedLimiter<Network>::Config draw(Random& random, int nodes, Row& row) {
  for (;;) {
    typename CertifiedLimiter<Network>::Config config = CertifiedLimiter<Network>::Config::standard();
    row.nodes = nodes;
    row.hold_s = log_uniform(random, 0.02, 5.0);
    row.horizon_s = row.hold_s * log_uniform(random, 1.0, 300.0);
    row.spread = random() % 3 == 0 ? 0.0 : uniform(random, 0.0, 0.2);
    row.highest_V = 24.0;
    row.highest_air_C = uniform(random, 20.0, 40.0);
    row.air_C = row.highest_air_C;
    double tau_s = row.hold_s * log_uniform(random, 2.0, 200.0), capacity_J = log_uniform(random, 1.0, 50.0);
    for (int k = 0; k < nodes; ++k) {
      row.capacity_J[k] = capacity_J;
      row.coupling_W[k] = capacity_J / tau_s;
      row.limit_C[k] = 60.0 + uniform(random, 0.0, 30.0) * (nodes - 1 - k);
      row.node_C[k] = row.air_C;
      capacity_J *= log_uniform(random, 1.0, 10.0);
      tau_s *= log_uniform(random, 1.0, 20.0);
    }
    const double full_W =
        row.coupling_W[nodes - 1] * (60.0 - row.highest_air_C) * log_uniform(random, 1.0, 20.0);
    row.ohm = 24.0 * 24.0 / full_W;
    declare(row, config.network);
    config.use.heat =
        HeatBounds::ohmic(24.0f, 0.001f, {static_cast<float>(0.9999 * row.ohm), static_cast<float>(row.ohm)},
                          {0.0039f, 0.0039f}, 20.0f, 0.0f, static_cast<float>(row.limit_C[0]));
    config.use.highest_air_C = static_cast<float>(row.highest_air_C);
    config.use.hold_s = static_cast<float>(row.hold_s);
    config.use.horizon_s = static_cast<float>(row.horizon_s);
    config.use.every = static_cast<uint8_t>(1 + random() % 3);
    config.air_error_K = 1.0f;
    if (!is_error(config.validate())) return config;
  }
}

struct Outcome {
  double over_limit_K = -1e9, over_bound_K = -1e9;
  int unpromised = 0, limited = 0, outside = 0;
};

/// @param hangs  loops hang and starts come as well: outside of the contract
template <class Network>
Outcome run(Random& random, int nodes, bool hangs) {
  Row row;
  const auto config = draw<Network>(random, nodes, row);
  CertifiedLimiter<Network> limiter(config);
  limiter.start(static_cast<float>(row.hottest_C()) + 1e-3f,
                static_cast<float>(row.node_C[nodes - 1]) + 1e-3f);
  Outcome outcome;
  const double unknown = uniform(random, 0.0, 0.7), lowest_V = uniform(random, 4.0, 24.0);
  double volt = 24.0, passed_s = 0.0;
  int power = 1, turn = 0;
  bool is_plan_due = false;
  bool is_covered = true;  // no hang and no hot start since the bounds were inside
  for (int i = 0; i < 1500; ++i) {
    double dt_s =
        0.9999 * row.hold_s / config.use.every * (random() % 2 == 0 ? 1.0 : uniform(random, 0.0, 1.0));
    const bool is_hang = hangs && random() % 200 == 0;
    if (is_hang) dt_s = row.hold_s * uniform(random, 2.0, 60.0);
    double over_K = -1e9;
    row.pass(power, volt, dt_s, &over_K);
    if (is_hang) is_covered = false;
    if (is_covered) outcome.over_limit_K = std::max(outcome.over_limit_K, over_K);
    passed_s += dt_s;
    if (hangs && random() % 300 == 0) {  // a start in the middle of a run, with the truth
      limiter.start(static_cast<float>(row.hottest_C()) + 1e-3f,
                    static_cast<float>(row.node_C[nodes - 1]) + 1e-3f);
      passed_s = random() % 2 == 0 ? 0.0 : passed_s;  // the step may be told the time before it, or not
      is_plan_due = limiter.ceiling() > 1;
      is_covered = false;
    }
    const bool is_unknown = !is_hang && uniform(random, 0.0, 1.0) < unknown;
    LimitedPower granted;
    bool is_planned = true;
    if (is_unknown) {
      granted = limiter.cut(LimitReason::time_invalid);
      turn = config.use.every - 1;  // the next step plans
      is_plan_due = false;
    } else {
      // What is measured at a plan acts until the next.
      is_planned = is_plan_due || passed_s > row.hold_s;
      if (++turn >= config.use.every) {
        turn = 0;
        is_planned = true;
      }
      if (is_planned) volt = uniform(random, lowest_V, 24.0);
      is_plan_due = false;
      const typename CertifiedLimiter<Network>::Inputs inputs = {
          static_cast<uint8_t>(random() % 4 == 0 ? random() % 256 : 255), static_cast<float>(volt),
          static_cast<float>(row.air_C)};
      granted = limiter.step(inputs, static_cast<float>(passed_s) * 1.000001f);
    }
    passed_s = 0.0;
    power = std::max<int>(1, granted.power);
    const bool is_certified = limiter.is_certified();
    outcome.limited += granted.reason != LimitReason::none ? 1 : 0;
    outcome.outside += is_certified ? 0 : 1;
    if (is_certified && is_planned) is_covered = true;
    // What is promised outside of the safe set.
    if (!limiter.network().is_certified() && power > 1) ++outcome.unpromised;
    if (is_planned)  // bounds are carried when a plan is made
      outcome.over_bound_K =
          std::max({outcome.over_bound_K, row.node_C[0] - static_cast<double>(limiter.winding_upper_C()),
                    row.node_C[nodes - 1] - static_cast<double>(limiter.body_upper_C())});
  }
  return outcome;
}

template <class Network>
void check(const char* name, int nodes, bool hangs) {
  Random random(static_cast<unsigned>(nodes) + (hangs ? 100u : 0u));
  Outcome all;
  for (int i = 0; i < 150; ++i) {
    const Outcome one = run<Network>(random, nodes, hangs);
    all.over_limit_K = std::max(all.over_limit_K, one.over_limit_K);
    all.over_bound_K = std::max(all.over_bound_K, one.over_bound_K);
    all.unpromised += one.unpromised;
    all.limited += one.limited;
    all.outside += one.outside;
  }
  INFO(name << (hangs ? " with hangs and starts" : "") << ": over a limit " << all.over_limit_K
            << " K, over a bound " << all.over_bound_K << " K, limited " << all.limited << ", outside "
            << all.outside);
  CHECK(all.over_limit_K <= 0.0);
  CHECK(all.over_bound_K <= 2e-3);  // the start was told to a thousandth of a kelvin, in floats
  CHECK(all.unpromised == 0);
  CHECK(all.limited > 1000);
  CHECK((all.outside > 0) == hangs);
}

}  // namespace

TEST_CASE("unknown times within a hold, with a supply below the highest, bring no network over a limit") {
  check<CertifiedOneNode>("one node", 1, false);
  check<CertifiedTwoNode>("two nodes", 2, false);
  check<CertifiedCoupledTwoNode>("two nodes, both ends", 2, false);
  check<CertifiedChain<2>>("a chain of two", 2, false);
  check<CertifiedChain<3>>("a chain of three", 3, false);
  check<CertifiedChain<4>>("a chain of four", 4, false);
}

TEST_CASE("after a hang or a hot start every network grants the least power until its bounds are inside") {
  check<CertifiedOneNode>("one node", 1, true);
  check<CertifiedTwoNode>("two nodes", 2, true);
  check<CertifiedCoupledTwoNode>("two nodes, both ends", 2, true);
  check<CertifiedChain<2>>("a chain of two", 2, true);
  check<CertifiedChain<3>>("a chain of three", 3, true);
  check<CertifiedChain<4>>("a chain of four", 4, true);
}
