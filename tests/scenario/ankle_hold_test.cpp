// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The ankle of a legged robot that stands still under load: no motion, no airflow, all current is heat in one
// winding. What protects it decides how long it carries the load, how much torque is lost after that, and whether the
// torque steps. The motor is written out here; its drive holds a current, so that its heat rises with the winding.

#include "../catch.hpp"

#include <cmath>
#include <cstdio>
#include <thermopower/thermopower.hpp>

namespace {

namespace tp = thermopower;

constexpr double winding_J_per_K = 30.0, body_J_per_K = 400.0, coupling_W_per_K = 2.5, air_W_per_K = 0.9;
constexpr double winding_limit_C = 120.0, body_limit_C = 80.0, air_C = 25.0, hottest_air_C = 40.0;
constexpr double full_W_at_20_C = 160.0, per_K = 0.0039, step_s = 0.05, hold_s = 1200.0;

struct Motor {
  double winding_C, body_C;
  double heat_W(int power) const {
    return full_W_at_20_C * power / 255.0 * (1.0 + per_K * (winding_C - 20.0));
  }
  void pass(int power) {
    const double across_W = coupling_W_per_K * (winding_C - body_C);
    winding_C += step_s * (heat_W(power) - across_W) / winding_J_per_K;
    body_C += step_s * (across_W - air_W_per_K * (body_C - air_C)) / body_J_per_K;
  }
};

tp::TwoNodeThermalModel<float>::Config model() {
  return {static_cast<float>(winding_J_per_K),
          static_cast<float>(body_J_per_K),
          static_cast<float>(coupling_W_per_K),
          {static_cast<float>(air_W_per_K)}};
}

// The power whose heat a body bears for ever in the hottest air: what is written on a data sheet.
int continuous_power() {
  const double bearable_W = air_W_per_K * (body_limit_C - hottest_air_C);
  const double winding_C = body_limit_C + bearable_W / coupling_W_per_K;
  return static_cast<int>(255.0 * bearable_W / (full_W_at_20_C * (1.0 + per_K * (winding_C - 20.0))));
}

/// Never more than the data sheet's continuous current.
struct FixedDerating {
  int step(int demand, const Motor&) { return std::min(demand, continuous_power()); }
};
/// The usual I2t: a first-order lag of the squared current, with the motor's time constant; it starts at zero.
struct I2t {
  double filled = 0.0;
  bool is_limiting = false;
  int step(int demand, const Motor&) {
    const double lag_s = (winding_J_per_K + body_J_per_K) / air_W_per_K;
    const int power = is_limiting ? std::min(demand, continuous_power()) : demand;
    filled += step_s / lag_s * (power / static_cast<double>(continuous_power()) - filled);
    is_limiting = filled >= (is_limiting ? 0.95 : 1.0);
    return power;
  }
};
/// Full torque below a threshold, the continuous current above it, two kelvin of hysteresis.
struct StepAtThreshold {
  bool is_limiting = false;
  int step(int demand, const Motor& motor) {
    const double above_K = std::max(motor.winding_C - winding_limit_C, motor.body_C - body_limit_C);
    is_limiting = above_K > (is_limiting ? -4.0 : -2.0);
    return is_limiting ? std::min(demand, continuous_power() / 2) : demand;
  }
};
/// Less and less within a band below each limit.
struct ContinuousDerating {
  tp::NodeLimiter limiter{config()};
  static tp::NodeLimiter::Config config() {
    tp::NodeLimiter::Config config = tp::NodeLimiter::Config::standard();
    for (auto& node : config.node) node.maximum_C = 250.0f;
    config.node[tp::NodeLimiter::winding].maximum_C = static_cast<float>(winding_limit_C);
    config.node[tp::NodeLimiter::body].maximum_C = static_cast<float>(body_limit_C);
    config.derating_K = 8.0f;
    return config;
  }
  int step(int demand, const Motor& motor) {
    return limiter
        .step({static_cast<std::uint8_t>(demand),
               tp::GuardedCelsius::unchecked(static_cast<float>(motor.winding_C)),
               tp::GuardedCelsius::unchecked(static_cast<float>(motor.body_C)), static_cast<float>(air_C)},
              static_cast<float>(step_s))
        .power;
  }
};
/// By proof, with every constant known to 10 %, told how warm it is at the start and the air to 2 K.
struct Certified {
  tp::CertifiedLimiter<> limiter{config()};
  bool is_first = true;
  static tp::CertifiedLimiter<>::Config config() {
    tp::CertifiedLimiter<>::Config config = tp::CertifiedLimiter<>::Config::standard();
    config.network = tp::CertifiedTwoNodeConfig::around(model(), 0.1f, static_cast<float>(winding_limit_C),
                                                        static_cast<float>(body_limit_C));
    const auto most_W = static_cast<float>(full_W_at_20_C * (1.0 + per_K * (winding_limit_C - 20.0)));
    config.use = {
        {48.0f, 1.0f, 0.0f, most_W, most_W, 0.0f}, static_cast<float>(hottest_air_C), 0.1f, 10.0f, 1, 0};
    config.air_error_K = 2.0f;
    return config;
  }
  int step(int demand, const Motor& motor) {
    if (is_first) limiter.start(static_cast<float>(motor.winding_C), static_cast<float>(motor.body_C));
    const int power =
        limiter
            .step({static_cast<std::uint8_t>(demand), tp::detail::not_a_number(), static_cast<float>(air_C)},
                  is_first ? 0.0f : static_cast<float>(step_s))
            .power;
    is_first = false;
    return power;
  }
};
/// The same, told the winding and the body with an error of 3 K once a second.
struct CertifiedAndMeasured {
  Certified inner;
  int count = 0;
  int step(int demand, const Motor& motor) {
    if (++count % 20 == 0)
      inner.limiter.tighten(tp::GuardedCelsius::unchecked(static_cast<float>(motor.winding_C + 3.0)),
                            tp::GuardedCelsius::unchecked(static_cast<float>(motor.body_C + 3.0)));
    return inner.step(demand, motor);
  }
};

struct Held {
  double full_s = hold_s;     ///< Until torque was lost for the first time.
  double lost = 0.0;          ///< Mean share of the torque that was missing.
  double over_K = -1e9;       ///< Most above a limit.
  double largest_step = 0.0;  ///< Largest step of the torque, share of the demand.
  int reversals = 0;          ///< Changes between falling and rising torque by more than 2 %.
};

template <class Policy>
Held hold(int demand, double start_C) {
  Motor motor = {start_C, start_C};
  Policy policy;
  Held held;
  double before = 1.0, extreme = 1.0;
  int direction = 0;
  for (double now_s = 0.0; now_s < hold_s; now_s += step_s) {
    const int power = policy.step(demand, motor);
    motor.pass(power);
    const double torque = std::sqrt(static_cast<double>(power) / demand);
    if (torque < 1.0 && held.full_s == hold_s) held.full_s = now_s;
    held.lost += (1.0 - torque) * step_s / hold_s;
    held.over_K =
        std::max(held.over_K, std::max(motor.winding_C - winding_limit_C, motor.body_C - body_limit_C));
    held.largest_step = std::max(held.largest_step, std::fabs(torque - before));
    before = torque;
    if (direction >= 0 && torque < extreme - 0.02)
      held.reversals += direction > 0 ? 1 : 0, direction = -1, extreme = torque;
    else if (direction <= 0 && torque > extreme + 0.02)
      held.reversals += direction < 0 ? 1 : 0, direction = 1, extreme = torque;
    else if (direction != 0) extreme = direction > 0 ? std::max(extreme, torque) : std::min(extreme, torque);
  }
  return held;
}

void print(const char* name, const Held& held) {
  std::printf("| %s | %.0f s | %.1f %% | %+.1f K | %.0f %% | %d |\n", name, held.full_s, 100.0 * held.lost,
              held.over_K, 100.0 * held.largest_step, held.reversals);
}

}  // namespace

TEST_CASE("an ankle that stands: how long, at what loss of torque, how smoothly") {
  const int demand = 150;  // 94 W cold: more than twice what is bearable for ever in the hottest air
  for (const double start_C : {25.0, 70.0}) {
    std::printf(
        "\nStart at %.0f degC, 20 minutes:\n| protection | full torque for | torque lost | above a limit | "
        "largest step | reversals |\n|---|---|---|---|---|---|\n",
        start_C);
    const Held fixed = hold<FixedDerating>(demand, start_C), i2t = hold<I2t>(demand, start_C);
    const Held step = hold<StepAtThreshold>(demand, start_C);
    const Held derated = hold<ContinuousDerating>(demand, start_C);
    const Held certified = hold<Certified>(demand, start_C);
    const Held measured = hold<CertifiedAndMeasured>(demand, start_C);
    print("fixed derating", fixed);
    print("I2t from zero", i2t);
    print("step at the threshold", step);
    print("continuous derating (NodeLimiter, 8 K)", derated);
    print("certified, constants to 10 %", certified);
    print("certified, told both nodes to 3 K", measured);

    INFO("from " << start_C << " degC");
    for (const Held* ours : {&derated, &certified, &measured}) {
      CHECK(ours->over_K <= 0.0);
      CHECK(ours->full_s > fixed.full_s);
      CHECK(ours->lost < fixed.lost);
      CHECK(ours->reversals <= 1);
    }
    CHECK(derated.largest_step < 0.02);  // one count of power
    CHECK(step.reversals > 10);
    CHECK(step.largest_step > 0.3);
    // What starts from zero knows nothing of a body that is warm already.
    if (start_C > 60.0) CHECK(i2t.over_K > 0.0);
  }
}

TEST_CASE("the time to the limit, told at the start of the hold, is not too long and hardly too short") {
  for (const double start_C : {25.0, 50.0}) {
    Motor motor = {start_C, start_C};
    const int demand = 150;
    double last_s = 0.0;
    const tp::TwoNodeForecast::Limits limits = {static_cast<float>(winding_limit_C),
                                                static_cast<float>(body_limit_C)};
    // A forecast has one heat, and this one rises with the winding: that at the limit is never too little.
    const double most_W = full_W_at_20_C * demand / 255.0 * (1.0 + per_K * (winding_limit_C - 20.0));
    const float told_s =
        tp::TwoNodeForecast(
            model(), {static_cast<float>(start_C), static_cast<float>(start_C), static_cast<float>(air_C)},
            static_cast<float>(most_W))
            .seconds_to(limits);
    while (motor.winding_C < winding_limit_C && motor.body_C < body_limit_C && last_s < 5000.0) {
      motor.pass(demand);
      last_s += step_s;
    }
    std::printf("from %.0f degC: %.0f s to the limit, told %.0f s\n", start_C, last_s,
                static_cast<double>(told_s));
    CHECK(static_cast<double>(told_s) <= last_s);
    CHECK(static_cast<double>(told_s) >= 0.8 * last_s);
  }
}
