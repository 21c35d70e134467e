// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The certified limiter on chains of nodes. The actuators are integrated here, by Runge-Kutta in double precision, from
// the balances themselves: true temperatures of nodes, no means, no bounds, nothing of the library's.

#include <thermopower/control/certified/limiter.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

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
bool chance(Random& random, double probability) { return uniform(random, 0.0, 1.0) < probability; }

// An actuator as it is.
struct Chain {
  std::vector<double> node_C, capacity_J, coupling_W,
      leak_W;  // coupling k is to node k + 1, the last to the air
  double full_W_at_0 = 0.0, tempco = 0.0, air_C = 0.0;

  double heat_W(double power, double winding_C) const {
    return power / 255.0 * full_W_at_0 / (1.0 + tempco * winding_C);
  }
  std::vector<double> slopes(const std::vector<double>& at, double power) const {
    std::vector<double> flow(at.size());
    for (std::size_t k = 0; k < at.size(); ++k)
      flow[k] = coupling_W[k] * (at[k] - (k + 1 < at.size() ? at[k + 1] : air_C));
    std::vector<double> slope(at.size());
    for (std::size_t k = 0; k < at.size(); ++k)
      slope[k] = ((k == 0 ? heat_W(power, at[0]) : flow[k - 1]) - flow[k] - leak_W[k] * (at[k] - air_C)) /
                 capacity_J[k];
    return slope;
  }
  // Calls `seen` after every inner step.
  template <class Seen>
  void step(double power, double dt_s, Seen&& seen) {
    double fastest = 1e-9;
    for (std::size_t k = 0; k < node_C.size(); ++k)
      fastest =
          std::max(fastest, (coupling_W[k] + (k > 0 ? coupling_W[k - 1] : 0.0) + leak_W[k]) / capacity_J[k]);
    const int parts = 1 + static_cast<int>(dt_s * fastest * 8.0);
    const double h = dt_s / parts;
    const auto moved = [&](const std::vector<double>& by, double part) {
      std::vector<double> to = node_C;
      for (std::size_t k = 0; k < to.size(); ++k) to[k] += part * by[k];
      return to;
    };
    for (int part = 0; part < parts; ++part) {
      const auto a = slopes(node_C, power), b = slopes(moved(a, h / 2), power),
                 c = slopes(moved(b, h / 2), power), d = slopes(moved(c, h), power);
      for (std::size_t k = 0; k < node_C.size(); ++k)
        node_C[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
      seen();
    }
  }
};

template <std::uint8_t n>
using Limiter = CertifiedLimiter<CertifiedChain<n>>;

// What is declared, and what is not.
template <std::uint8_t n>
struct Declared {
  typename Limiter<n>::Config config;
  double full_W_at_0, tempco, lowest_air_C;
};

template <std::uint8_t n>
Declared<n> draw_bounds(Random& random) {
  for (;;) {
    Declared<n> declared;
    auto& config = declared.config;
    config = Limiter<n>::Config::standard();
    const double hold_s = log_uniform(random, 0.01, 1.0),
                 spread = chance(random, 0.3) ? 0.0 : uniform(random, 0.0, 0.3);
    const double limit_C = uniform(random, 50.0, 100.0), air_C = uniform(random, 10.0, 0.7 * limit_C);
    declared.lowest_air_C = air_C - uniform(random, 0.0, 50.0);
    double tau_s = hold_s * log_uniform(random, 3.0, 200.0), capacity_J = log_uniform(random, 0.5, 100.0),
           last_W = 0.0;
    for (int k = 0; k < n; ++k) {
      last_W = capacity_J / tau_s;
      config.network.nodes[k] = {Bounds::around(static_cast<float>(capacity_J), static_cast<float>(spread)),
                                 static_cast<float>(last_W * (1.0 - spread)),
                                 static_cast<float>(limit_C + uniform(random, -5.0, 30.0) * (n - 1 - k))};
      capacity_J *= log_uniform(random, 0.3, 10.0);
      tau_s *= log_uniform(random, 0.5, 20.0);
    }
    const double full_W = last_W * (limit_C - air_C) * log_uniform(random, 0.7, 20.0);
    declared.tempco = 0.0039;
    declared.full_W_at_0 = full_W;
    const double hottest_C = static_cast<double>(config.network.nodes[0].maximum_C);
    config.use.heat = {12.0f,
                       1.0f,
                       static_cast<float>(declared.lowest_air_C),
                       static_cast<float>(1.0001 * full_W / (1.0 + declared.tempco * declared.lowest_air_C)),
                       static_cast<float>(1.0001 * full_W / (1.0 + declared.tempco * hottest_C)),
                       0.0f};
    config.use.highest_air_C = static_cast<float>(air_C);
    config.use.hold_s = static_cast<float>(hold_s);
    config.use.horizon_s = static_cast<float>(hold_s * log_uniform(random, 1.0, 500.0));
    config.use.every = static_cast<std::uint8_t>(1 + random() % 3);
    config.use.phase = 0;
    config.air_error_K = static_cast<float>(uniform(random, 0.0, 5.0));
    if (!is_error(config.validate())) return declared;
  }
}

// Everything that may change, as bad as it may be or not. @param beyond  1, or by how much the couplings break their
// bounds
template <std::uint8_t n>
void shake(Random& random, const Declared<n>& declared, Chain& chain, double beyond = 1.0) {
  const auto& config = declared.config;
  for (std::size_t k = 0; k < n; ++k) {
    chain.coupling_W[k] = static_cast<double>(config.network.nodes[k].least_coupling_W_per_K) * beyond *
                          (chance(random, 0.7) ? 1.0 : log_uniform(random, 1.0, 20.0));
    chain.leak_W[k] = chance(random, 0.8) ? 0.0 : chain.coupling_W[k] * uniform(random, 0.0, 0.5);
  }
  const double highest_C = static_cast<double>(config.use.highest_air_C);
  chain.air_C = chance(random, 0.7) ? highest_C : uniform(random, declared.lowest_air_C, highest_C);
  chain.full_W_at_0 = declared.full_W_at_0 * (chance(random, 0.7) ? 1.0 : uniform(random, 0.5, 1.0));
}

struct Outcome {
  double over_limit_K = -1e9, over_bound_K = -1e9;
  bool lost_certificate = false;
  int limited = 0;
};

template <std::uint8_t n>
Outcome run(Random& random, const Declared<n>& declared, double beyond, int steps, bool is_hostile) {
  const auto& config = declared.config;
  Limiter<n> limiter(config);
  Chain chain;
  chain.tempco = declared.tempco;
  chain.coupling_W.assign(n, 1.0);
  chain.leak_W.assign(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const Bounds& capacity = config.network.nodes[k].heat_capacity_J_per_K;
    chain.capacity_J.push_back(static_cast<double>(chance(random, 0.4) ? capacity.lowest
                                                   : chance(random, 0.5)
                                                       ? capacity.highest
                                                       : 0.5f * (capacity.lowest + capacity.highest)));
  }
  shake(random, declared, chain, beyond);
  // As warm as it may be, or as cold, and any node the warmest.
  double room_C = 1e9;
  for (std::size_t k = 0; k < n; ++k)
    room_C = std::min(room_C, static_cast<double>(config.network.nodes[k].maximum_C));
  const double warm = chance(random, 0.4) ? 0.9 : uniform(random, 0.0, 0.8);
  double hot_C = -1e9;
  for (std::size_t k = 0; k < n; ++k) {
    const double air_C = static_cast<double>(config.use.highest_air_C);
    chain.node_C.push_back(declared.lowest_air_C + (air_C - declared.lowest_air_C + warm * (room_C - air_C)) *
                                                       uniform(random, 0.0, 1.0));
    hot_C = std::max(hot_C, chain.node_C.back());
  }
  limiter.start(static_cast<float>(hot_C) + 1e-4f, static_cast<float>(chain.node_C.back()) + 1e-4f);

  Outcome outcome;
  const int kind = static_cast<int>(random() % 4), period = 1 + static_cast<int>(random() % 200);
  const double each_s = static_cast<double>(config.use.hold_s) / config.use.every;
  bool was_certified = false;
  double dt_s = 0.0, planned_air_C = static_cast<double>(config.use.highest_air_C);
  for (int i = 0; i < steps; ++i) {
    if (is_hostile && i % (1 + static_cast<int>(random() % 20)) == 0) shake(random, declared, chain, beyond);
    const bool is_asked =
        kind == 0 || (kind == 1 && (i / period) % 2 == 0) || (kind == 2 && i % (8 * period) > 7 * period);
    const std::uint8_t demand = kind == 3 ? static_cast<std::uint8_t>(random() & 0xff)
                                          : static_cast<std::uint8_t>(is_asked ? 255 : 0);
    // The air may be warmer than measured by what was declared; or it is not measured.
    const float air_C = chance(random, 0.5)
                            ? detail::not_a_number()
                            : static_cast<float>(chain.air_C - uniform(random, 0.0, 0.999) *
                                                                   static_cast<double>(config.air_error_K));
    if ((i + 1) % config.use.every == 0) planned_air_C = chain.air_C;
    const LimitedPower granted = limiter.step({demand, 12.0f, air_C}, static_cast<float>(dt_s));
    outcome.limited += granted.reason != LimitReason::none ? 1 : 0;
    const bool is_certified = limiter.is_certified();
    if (was_certified && !is_certified) outcome.lost_certificate = true;
    was_certified = is_certified;
    for (std::size_t k = 0; k < n; ++k)
      outcome.over_bound_K = std::max(
          outcome.over_bound_K,
          (i + 1) % config.use.every == 0
              ? chain.node_C[k] - static_cast<double>(limiter.network().node_C(static_cast<std::uint8_t>(k)))
              : -1e9);
    dt_s = static_cast<double>(
        static_cast<float>(each_s * (chance(random, 0.7) ? 1.0 : uniform(random, 0.1, 1.0)) * 0.9999));
    // Between two plans the air does not pass what the plan was told of.
    chain.air_C = std::min(chain.air_C, planned_air_C);
    const bool counts = is_certified;
    chain.step(granted.power < 1 ? 1.0 : granted.power, dt_s, [&] {
      for (std::size_t k = 0; k < n && counts; ++k)
        outcome.over_limit_K = std::max(
            outcome.over_limit_K, chain.node_C[k] - static_cast<double>(config.network.nodes[k].maximum_C));
    });
  }
  return outcome;
}

template <std::uint8_t n>
void check_random_chains(std::uint64_t seed, int count) {
  Random random(seed);
  double over_limit_K = -1e9, over_bound_K = -1e9;
  long limited = 0;
  int lost = 0;
  for (int i = 0; i < count; ++i) {
    const Declared<n> declared = draw_bounds<n>(random);
    const Outcome outcome = run<n>(random, declared, 1.0, 3000, chance(random, 0.5));
    over_limit_K = std::max(over_limit_K, outcome.over_limit_K);
    over_bound_K = std::max(over_bound_K, outcome.over_bound_K);
    lost += outcome.lost_certificate ? 1 : 0;
    limited += outcome.limited;
  }
  INFO(int(n) << " nodes: highest over a limit " << over_limit_K << " K, over a bound " << over_bound_K
              << " K");
  CHECK(over_limit_K <= 0.0);
  CHECK(over_bound_K <= 1e-4);  // the float that a bound is handed out as
  CHECK(lost == 0);
  CHECK(limited > 20L * count);  // or nothing was tried
  CHECK(over_limit_K > -10.0);   // nor if no limit was ever near
}

}  // namespace

TEST_CASE("no node of a random chain passes its limit or its bound, whatever the adversary does") {
  check_random_chains<2>(1, 400);
  check_random_chains<3>(2, 400);
  check_random_chains<4>(3, 200);
  check_random_chains<6>(4, 100);
}

TEST_CASE("two nodes in a chain are granted nearly what the network of two nodes grants") {
  // The bench motor of docs/explain/certified-limiter.md, known exactly, full demand for 2000 s in still air of 25 degC.
  CertifiedLimiter<>::Config two = CertifiedLimiter<>::Config::standard();
  two.network = {{8.0f, 8.0f}, {80.0f, 80.0f}, 1.0f, 0.2f, 110.0f, 60.0f};
  two.use.heat = HeatBounds::ohmic(12.0f, 1.0f, {2.4f, 2.4f}, {0.0039f, 0.0039f}, 25.0f, 0.0f, 110.0f);
  two.use.highest_air_C = 25.0f;
  Limiter<2>::Config chain = Limiter<2>::Config::standard();
  chain.network.nodes[0] = {{8.0f, 8.0f}, 1.0f, 110.0f};
  chain.network.nodes[1] = {{80.0f, 80.0f}, 0.2f, 60.0f};
  chain.use = two.use;
  CertifiedLimiter<> two_limiter(two);
  Limiter<2> chain_limiter(chain);
  REQUIRE(chain_limiter.validate() == ConfigError::none);
  two_limiter.start(25.0f, 25.0f);
  chain_limiter.start(25.0f, 25.0f);
  const auto granted_J = [](auto& limiter) {
    Chain plant;
    plant.node_C = {25.0, 25.0}, plant.capacity_J = {8.0, 80.0}, plant.coupling_W = {1.0, 0.2},
    plant.leak_W = {0.0, 0.0};
    plant.tempco = 0.0039 / (1.0 - 25.0 * 0.0039);
    plant.full_W_at_0 = 60.0 / (1.0 - 25.0 * 0.0039);
    plant.air_C = 25.0;
    double sum_J = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const LimitedPower granted = limiter.step({255, 12.0f, 25.0f}, i == 0 ? 0.0f : 0.1f);
      sum_J += 0.1 * plant.heat_W(granted.power, plant.node_C[0]);
      plant.step(granted.power, 0.1, [] {});
    }
    CHECK(plant.node_C[1] < 60.0);
    CHECK(plant.node_C[1] > 56.0);
    return sum_J;
  };
  const double by_two_J = granted_J(two_limiter), by_chain_J = granted_J(chain_limiter);
  INFO(by_two_J << " J by two nodes, " << by_chain_J << " J by a chain");
  CHECK(by_chain_J > 0.97 * by_two_J);
}

TEST_CASE("a chain refuses what it cannot keep, by name, and says which node holds the power back") {
  Limiter<3>::Config config = Limiter<3>::Config::standard();
  CHECK(config.validate() == ConfigError::heat_capacity_J_per_K);
  config.network.nodes[0] = {{4.0f, 5.0f}, 0.5f, 120.0f};
  config.network.nodes[1] = {{20.0f, 25.0f}, 0.3f, 90.0f};
  config.network.nodes[2] = {{60.0f, 75.0f}, 0.2f, 60.0f};
  config.use.heat = HeatBounds::ohmic(12.0f, 1.0f, {5.0f, 6.0f}, {0.0039f, 0.0039f}, 25.0f, 0.0f, 120.0f);
  config.use.highest_air_C = 35.0f;
  CHECK(config.validate() == ConfigError::none);
  const auto with = [&](auto change) {
    Limiter<3>::Config other = config;
    change(other);
    return other.validate();
  };
  CHECK(with([](auto& c) { c.network.nodes[1].least_coupling_W_per_K = 0.0f; }) ==
        ConfigError::coupling_W_per_K);
  CHECK(with([](auto& c) { c.network.nodes[2].maximum_C = 300.0f; }) == ConfigError::maximum_C);
  CHECK(with([](auto& c) { c.network.nodes[2].maximum_C = 35.0f; }) == ConfigError::highest_air_C);
  CHECK(with([](auto& c) { c.network.nodes[0].maximum_C = 35.0f; }) == ConfigError::highest_air_C);

  // Each node in turn is given the limit that counts.
  for (std::uint8_t tight = 0; tight < 3; ++tight) {
    Limiter<3>::Config one = config;
    for (std::uint8_t k = 0; k < 3; ++k) one.network.nodes[k].maximum_C = k == tight ? 50.0f : 200.0f;
    Limiter<3> limiter(one);
    limiter.start(30.0f, 30.0f);
    for (int i = 0; i < 30000; ++i) limiter.step({255, 12.0f, 30.0f}, 0.1f);
    INFO("limit at node " << int(tight));
    CHECK(limiter.network().limiting_node() == tight);
    CHECK(limiter.ceiling() < 255);
    CHECK(limiter.state().is_certified);
  }
}

TEST_CASE("a chain whose couplings break their bounds does pass its limits: the test can fail") {
  Random random(5);
  int over = 0;
  for (int i = 0; i < 300; ++i)
    over += run<3>(random, draw_bounds<3>(random), 0.3, 2000, false).over_limit_K > 0.0 ? 1 : 0;
  CHECK(over > 20);
}
