// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../../catch.hpp"
#include "../limiter_inputs.hpp"

#include <cmath>
#include <random>

#include <thermopower/thermopower.hpp>

// tests/proofs shows it for every declaration; here it is tried on the compiled program, with declarations far from
// any motor: windings of a thousandth of the body's heat, holds of many time constants, limits just above the air.

using namespace thermopower;

namespace {

struct Draw {
  std::mt19937 engine;

  float within(double low, double high) {
    return static_cast<float>(std::uniform_real_distribution<double>(low, high)(engine));
  }
  float decades(double low, double high) {
    return static_cast<float>(std::exp(static_cast<double>(within(std::log(low), std::log(high)))));
  }
  Bounds bounds(double low, double high) { return Bounds::around(decades(low, high), within(0.0, 0.4)); }
};

CertifiedUse use_of(Draw& draw, float hottest_C) {
  CertifiedUse use;
  const float cold_W = draw.decades(0.1, 2000.0);
  use.heat = {24.0f,  draw.within(0.0, 0.05),         draw.within(-30.0, 20.0),
              cold_W, cold_W * draw.within(0.6, 1.0), draw.within(0.1, 20.0)};
  use.highest_air_C = draw.within(static_cast<double>(use.heat.coldest_C), static_cast<double>(hottest_C));
  use.hold_s = draw.decades(0.002, 10.0);
  use.horizon_s = use.hold_s * draw.decades(1.0, 100.0);
  use.every = 1;
  use.phase = 0;
  return use;
}

/// Steps of any length within a hold at any demand, from the very limits. Returns the number of steps after which the
/// bounds were not inside the set that the least power never leaves.
template <class Limiter>
int steps_outside(Draw& draw, const typename Limiter::Config& config, int steps) {
  Limiter limiter(config);
  int outside = limiter.is_certified() ? 0 : 1;
  for (int step = 0; step < steps; ++step) {
    typename Limiter::Inputs inputs;
    inputs.demand = static_cast<std::uint8_t>(draw.within(0.0, 4.0) > 1.0f ? 255 : draw.within(1.0, 255.0));
    inputs.supply_V = draw.within(0.0, 1.0) < 0.5f ? draw.within(12.0, 24.0) : 24.0f;
    inputs.air_C = draw.within(0.0, 1.0) < 0.5f ? config.use.highest_air_C
                                                : draw.within(static_cast<double>(config.use.heat.coldest_C),
                                                              static_cast<double>(config.use.highest_air_C));
    if (draw.within(0.0, 50.0) < 1.0f)
      limiter.tighten(told::degrees(draw.within(20.0, 60.0)), told::degrees(draw.within(20.0, 60.0)));
    if (draw.within(0.0, 50.0) < 1.0f)
      limiter.cut_after(LimitReason::temperature_not_finite, 255, config.use.hold_s);
    limiter.step(inputs, config.use.hold_s * (draw.within(0.0, 1.0) < 0.7f ? 1.0f : draw.within(0.0, 1.0)));
    if (!limiter.is_certified()) ++outside;
  }
  return outside;
}

}  // namespace

TEST_CASE(
    "two nodes: from the very limits, no step of any declaration that is accepted leaves the safe set") {
  Draw draw{std::mt19937(20)};
  int accepted = 0, outside = 0;
  for (int i = 0; i < 40000; ++i) {
    CertifiedLimiter<>::Config config = CertifiedLimiter<>::Config::standard();
    const float winding_C = draw.within(40.0, 250.0);
    config.network = {draw.bounds(0.05, 100.0),
                      draw.bounds(0.5, 1000.0),
                      draw.decades(0.01, 20.0),
                      draw.decades(0.005, 10.0),
                      winding_C,
                      draw.within(30.0, 250.0)};
    config.use = use_of(draw, winding_C - 1.0f);
    config.air_error_K = draw.within(0.0, 5.0);
    if (is_error(config.validate())) continue;
    ++accepted;
    outside += steps_outside<CertifiedLimiter<>>(draw, config, 40) != 0;
  }
  CHECK(accepted > 5000);
  CHECK(outside == 0);
}

TEST_CASE("one node: the same") {
  typedef CertifiedLimiter<CertifiedOneNode> Limiter;
  Draw draw{std::mt19937(21)};
  int accepted = 0, outside = 0;
  for (int i = 0; i < 20000; ++i) {
    Limiter::Config config = Limiter::Config::standard();
    const float maximum_C = draw.within(30.0, 200.0);
    config.network = {draw.bounds(0.1, 1000.0), draw.decades(0.005, 10.0), maximum_C};
    config.use = use_of(draw, maximum_C - 1.0f);
    config.air_error_K = draw.within(0.0, 5.0);
    if (is_error(config.validate())) continue;
    ++accepted;
    outside += steps_outside<Limiter>(draw, config, 40) != 0;
  }
  CHECK(accepted > 5000);
  CHECK(outside == 0);
}

TEST_CASE("a cut whose time is not known, said again and again, does not let the bounds creep") {
  CertifiedLimiter<>::Config config = CertifiedLimiter<>::Config::standard();
  config.network = {Bounds::around(8.0f, 0.1f), Bounds::around(80.0f, 0.1f), 1.0f, 0.2f, 110.0f, 60.0f};
  config.use.heat = {13.0f, 1.0f, 0.0f, 20.0f, 15.0f, 0.0f};
  config.use.highest_air_C = 30.0f;
  CertifiedLimiter<> limiter(config);
  limiter.cut(LimitReason::temperature_not_finite);
  const float winding_C = limiter.winding_upper_C(), body_C = limiter.body_upper_C();
  for (int i = 0; i < 10000; ++i) limiter.cut(LimitReason::temperature_not_finite);
  CHECK(limiter.winding_upper_C() == winding_C);
  CHECK(limiter.body_upper_C() == body_C);
}
