// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// protection_comparison [<motors>]: the same motors, whose constants are within 20 % of the nominal ones, under the same hour of
// demands, behind what people use against heat: eight lines of a model, a thermistor with linear derating, I2t, and the
// limiters of the library. Prints how many pass 110 degC in the winding, and how much heat each protection leaves unused.

#include "../benchmark/target_cost/rivals.hpp"

#include <thermopower/thermopower.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace {

namespace tp = thermopower;

constexpr double limit_C = 110.0, volt = 24.0, ohm = 8.0, tempco = 0.0039, dt_s = 0.05, run_s = 3600.0,
                 air_C = 25.0;
constexpr float fraction = 0.2f;

tp::TwoNodeThermalModel<float>::Config nominal() { return {2.0f, 12.0f, 1.0f, {0.3f}}; }

/// A motor as it is, and what its housing's thermistor reads.
struct Motor {
  double winding_J_per_K, body_J_per_K, coupling_W_per_K, loss_W_per_K, cold_ohm, winding_C, body_C;
  double pass(int power) {
    const double heat_W = volt * volt * power / 255.0 / (cold_ohm * (1.0 + tempco * (winding_C - 20.0)));
    const double across_W = coupling_W_per_K * (winding_C - body_C);
    winding_C += dt_s * (heat_W - across_W) / winding_J_per_K;
    body_C += dt_s * (across_W - loss_W_per_K * (body_C - air_C)) / body_J_per_K;
    return heat_W;
  }
};

/// What a protection is told; each reads what it has.
struct Known {
  int demand;
  double heat_nominal_W;  ///< Of the last power, by the nominal resistance at the modelled temperature.
  double current_A;
  double thermistor_C;
};

struct Protection {
  virtual ~Protection() = default;
  virtual int grant(const Known& known, int last_power) = 0;
};

struct NoProtection : Protection {
  int grant(const Known& known, int) override { return known.demand; }
};
/// The best there can be: it knows the winding.
struct Oracle : Protection {
  explicit Oracle(const Motor& motor) : motor_(motor) {}
  int grant(const Known& known, int) override { return motor_.winding_C < limit_C - 1.5 ? known.demand : 1; }
  const Motor& motor_;
};
struct EightLines : Protection {
  int grant(const Known& known, int) override {
    return model_.step(static_cast<float>(known.heat_nominal_W), static_cast<std::uint8_t>(known.demand),
                       static_cast<float>(dt_s));
  }
  rivals::EightLineModel model_{14.0f, 1.0f / (1.0f / 1.0f + 1.0f / 0.3f), 110.0f, 25.0f};
};
/// Off at a housing of `off_C`, all at 20 K below. At 90 degC a nominal winding is at 110 for ever.
struct Derating : Protection {
  explicit Derating(float off_C) : derating_(off_C - 20.0f, off_C) {}
  int grant(const Known& known, int) override {
    return derating_.step(static_cast<float>(known.thermistor_C), static_cast<std::uint8_t>(known.demand));
  }
  rivals::LinearDerating derating_;
};
/// Continuous: what holds a nominal winding at 110 degC; twice the square for as long as its housing takes.
struct SquareOverTime : Protection {
  int grant(const Known& known, int) override {
    return square_.step(static_cast<float>(known.current_A), static_cast<std::uint8_t>(known.demand),
                        static_cast<float>(dt_s));
  }
  rivals::CurrentSquareOverTime square_{static_cast<float>((limit_C - 25.0) / (1.0 / 1.0 + 1.0 / 0.3) /
                                                           (ohm * (1.0 + tempco * (limit_C - 20.0)))),
                                        30.0f};
};
/// The library's, by a model with nominal constants.
struct Safety : Protection {
  int grant(const Known& known, int) override {
    thermal_.step({static_cast<float>(known.heat_nominal_W), 0.0f, {static_cast<float>(air_C), 0.0f}},
                  static_cast<float>(dt_s));
    return limiter_
        .step({static_cast<std::uint8_t>(known.demand), tp::GuardedCelsius::hottest_of(thermal_),
               thermal_.hottest_rate_K_per_s()},
              static_cast<float>(dt_s))
        .power;
  }
  tp::TwoNodeThermalModel<float> thermal_{nominal(), 25.0f};
  tp::SafetyLimiter<> limiter_{{110.0f, 2.0f, 255.0f}};
};
struct Certified : Protection {
  typedef tp::CertifiedLimiter<tp::CertifiedTwoNode, tp::LinearHeat> Limiter;
  Certified() : limiter_(config()) { limiter_.start(25.0f, 25.0f); }
  static Limiter::Config config() {
    Limiter::Config config = Limiter::Config::standard();
    config.network = tp::CertifiedTwoNodeConfig::around(nominal(), fraction, 110.0f, 200.0f);
    config.use.heat =
        tp::HeatBounds::ohmic(24.0f, 1.0f, {7.6f, 8.4f}, {0.0039f, 0.00395f}, 20.0f, 0.0f, 110.0f);
    config.use.highest_air_C = 26.0f;
    config.air_error_K = 0.5f;
    return config;
  }
  int grant(const Known& known, int) override {
    return limiter_.step({static_cast<std::uint8_t>(known.demand), 24.0f, 25.0f}, static_cast<float>(dt_s))
        .power;
  }
  Limiter limiter_;
};

Motor drawn_motor(std::uint32_t seed) {
  std::mt19937 random(seed);
  const bool is_corner = random() % 2 == 0;
  const auto within = [&](double value, double error) {
    const double at = static_cast<double>(random() >> 5) / 134217728.0;
    return value * (1.0 + error * (is_corner ? (at < 0.5 ? -1.0 : 1.0) : 2.0 * at - 1.0));
  };
  return {within(2.0, 0.2),
          within(12.0, 0.2),
          within(1.0, 0.2),
          within(0.3, 0.2),
          within(ohm, 0.05),
          air_C,
          air_C};
}

struct Outcome {
  double over_K = -1e9, heat_J = 0.0;
};

Outcome run(Motor& motor, Protection& protection, std::uint32_t seed) {
  std::mt19937 random(seed);
  Outcome outcome;
  Known known = {255, 0.0, 0.0, motor.body_C};
  double until_s = 0.0, model_C = air_C;
  int power = 1;
  for (double now_s = 0.0; now_s < run_s; now_s += dt_s) {
    if (now_s >= until_s) {
      known.demand = random() % 3 == 0 ? 1 : 120 + static_cast<int>(random() % 136);
      until_s = now_s + 5.0 + static_cast<double>(random() % 90);
    }
    power = protection.grant(known, power);
    const double heat_W = motor.pass(power);
    outcome.heat_J += heat_W * dt_s;
    outcome.over_K = std::max(outcome.over_K, motor.winding_C - limit_C);
    known.current_A = std::sqrt(heat_W / (motor.cold_ohm * (1.0 + tempco * (motor.winding_C - 20.0))));
    model_C = motor.body_C + known.current_A * known.current_A * ohm;  // a winding above its housing, roughly
    known.heat_nominal_W =
        volt * volt * power / 255.0 / (ohm * (1.0 + tempco * (std::min(model_C, 110.0) - 20.0)));
    known.thermistor_C = motor.body_C;
  }
  return outcome;
}

}  // namespace

int main(int argument_count, char** arguments) {
  const long motors = argument_count > 1 ? std::strtol(arguments[1], nullptr, 10) : 60;
  if (motors < 1) {
    std::fprintf(stderr, "usage: protection_comparison [<motors>]\n");
    return 2;
  }
  const char* const titles[] = {"none",
                                "the winding's true temperature",
                                "a model of eight lines",
                                "thermistor on the housing, linear derating",
                                "the same, set for the worst of these motors",
                                "I2t",
                                "SafetyLimiter, nominal constants",
                                "CertifiedLimiter, two nodes, 20 %"};
  std::printf(
      "| protection, %ld motors, an hour each | over 110 degC | worst, K | heat used of what is bearable |\n|---|---:|---:|---:|\n",
      motors);
  std::vector<double> bearable_J(static_cast<std::size_t>(motors));
  // What derating would have to be set to so that all stay inside: known only to whoever has tried all of them.
  float safe_off_C = 90.0f;
  for (bool is_safe = false; !is_safe && safe_off_C > 40.0f; safe_off_C -= is_safe ? 0.0f : 1.0f) {
    is_safe = true;
    for (long at = 0; at < motors && is_safe; ++at) {
      Motor motor = drawn_motor(static_cast<std::uint32_t>(at + 1));
      Derating derating(safe_off_C);
      is_safe = run(motor, derating, static_cast<std::uint32_t>(at + 1001)).over_K <= 0.0;
    }
  }
  bool is_kept = true;
  for (const int which : {1, 0, 2, 3, 4, 5, 6, 7}) {
    long over = 0;
    double worst_K = -1e9, share = 0.0;
    for (long at = 0; at < motors; ++at) {
      const std::uint32_t seed = static_cast<std::uint32_t>(at + 1);
      Motor motor = drawn_motor(seed);
      NoProtection none;
      Oracle oracle(motor);
      EightLines eight;
      Derating derating(90.0f), safe_derating(safe_off_C);
      SquareOverTime square;
      Safety safety;
      Certified certified;
      Protection* const all[] = {&none,          &oracle, &eight,  &derating,
                                 &safe_derating, &square, &safety, &certified};
      const Outcome outcome = run(motor, *all[which], seed + 1000u);
      double& bearable = bearable_J[static_cast<std::size_t>(at)];
      if (which == 1) bearable = outcome.heat_J;
      over += outcome.over_K > 0.5 ? 1 : 0;
      worst_K = std::max(worst_K, outcome.over_K);
      share += outcome.heat_J / bearable / static_cast<double>(motors);
      is_kept = is_kept && (which != 7 || outcome.over_K <= 0.0);
    }
    std::printf("| %s | %ld | %.0f | %.0f %% |\n", titles[which], over, worst_K, 100.0 * share);
  }
  std::printf("\nThe derating that is set for the worst is off at %.0f degC.\n",
              static_cast<double>(safe_off_C));
  return is_kept ? 0 : 1;
}
