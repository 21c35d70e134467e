// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"
#include "limiter_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <thermopower/control/adaptive_holding_law.hpp>
#include <thermopower/control/axis_controller.hpp>
#include <thermopower/control/certified/limiter.hpp>
#include <thermopower/control/eased_gain.hpp>
#include <thermopower/control/node_limiter.hpp>
#include <thermopower/control/reserve_law.hpp>
#include <thermopower/control/sag_aware_law.hpp>
#include <thermopower/control/voltage_gain.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/current_model.hpp>
#include <thermopower/actuator/two_node_thermal_model.hpp>

using namespace thermopower;

namespace {

struct Motor {
  typedef CurrentModel<OhmicCurrent<float>> Current;
  typedef TwoNodeThermalModel<float> Thermal;
  static Current::Config current() { return {8.0f, 0.0039f, 20.0f}; }
  static SupplyRange supply() { return {1.0f, 30.0f}; }
  static Thermal::Config thermal() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }
};

AxisFacts at_supply(float supply_V) {
  return {1,    told::degrees(25.0f),   told::degrees(25.0f), 0.0f, 25.0f, supply_V,
          0.0f, detail::not_a_number(), LimitReason::none};
}
AxisFacts at_pose(float pose_deg, LimitReason last_reason = LimitReason::none) {
  AxisFacts facts = at_supply(13.0f);
  facts.pose_deg = pose_deg;
  facts.last_reason = last_reason;
  return facts;
}

/// An axis that must hold a weight: a pose-dependent torque against an authority that grows with the square
/// root of power.
struct Joint {
  double needed(double pose_deg) const {
    return 0.5 * std::abs(std::sin(pose_deg * 3.14159265 / 180.0)) + 0.05;
  }
  double error_deg(double pose_deg, int power) const {
    const double authority = std::sqrt(power / 255.0);
    return 0.08 * needed(pose_deg) / authority +
           (authority < needed(pose_deg) ? 2.0 * (needed(pose_deg) - authority) : 0.0);
  }
};

}  // namespace

TEST_CASE("each node limits at its own temperature, and the state says which") {
  NodeLimiter limiter;
  REQUIRE(limiter.validate() == ConfigError::none);
  CHECK(limiter.step(told::parts(255, 40.0f, 35.0f, 20.0f), 0.0f).reason == LimitReason::none);
  CHECK(limiter.state().node == NodeLimiter::none);
  CHECK(limiter.step(told::parts(255, 70.0f, 56.0f, 20.0f), 0.0f).reason == LimitReason::node_limit);
  CHECK(limiter.state().node == NodeLimiter::bracket);
  CHECK(limiter.step(told::parts(255, 118.0f, 40.0f, 20.0f), 0.0f).reason == LimitReason::node_limit);
  CHECK(limiter.state().node == NodeLimiter::winding);
  NodeLimiter::Config glass = NodeLimiter::Config::standard();
  glass.node[NodeLimiter::bracket] = {150.0f, 0.5f};  // metal, half way to the air
  NodeLimiter magnets(glass);
  CHECK(magnets.step(told::parts(255, 90.0f, 77.0f, 20.0f), 0.0f).reason == LimitReason::node_limit);
  CHECK(magnets.state().node == NodeLimiter::magnets);
  CHECK(magnets.state().node_C[NodeLimiter::bracket] == Approx(48.5f));
}

TEST_CASE(
    "the band of a node limit: all power at its lower end, the least at the limit, a straight line between") {
  NodeLimiter limiter;
  const NodeLimiter::Config config = NodeLimiter::Config::standard();
  const float maximum_C[] = {60.0f, 80.0f, 80.0f, 120.0f}, fraction[] = {1.0f, 1.0f, 0.1f, 1.0f};
  for (int i = 0; i < NodeLimiter::count; ++i) {
    CHECK(config.node[i].maximum_C == maximum_C[i]);
    CHECK(config.node[i].fraction == fraction[i]);
  }
  CHECK(config.derating_K == 8.0f);
  // 254 counts over 8 K: the bracket is as warm as the body.
  const struct {
    float body_C;
    int ceiling;
  } line[] = {{52.0f, 255}, {56.0f, 128}, {59.0f, 32}, {60.0f, 1}, {70.0f, 1}};
  for (const auto& at : line) {
    CAPTURE(at.body_C);
    limiter.step(told::parts(255, at.body_C, at.body_C, 20.0f), 0.0f);
    CHECK(static_cast<int>(limiter.ceiling()) == at.ceiling);
    CHECK(limiter.state().margin_K == 60.0f - at.body_C);
  }
  CHECK(limiter.step(told::parts(255, 52.0f, 52.0f, 20.0f), 0.0f).reason == LimitReason::none);
  CHECK(limiter.state().node == NodeLimiter::none);  // at the band's lower end it is not inside
  CHECK(limiter.step(told::parts(255, 60.0f, 60.0f, 20.0f), 0.0f).reason ==
        LimitReason::node_limit);  // not above the limit yet
  CHECK(limiter.step(told::parts(255, 60.01f, 60.01f, 20.0f), 0.0f).reason == LimitReason::over_temperature);
  CHECK(limiter.step(told::parts(128, 56.0f, 56.0f, 20.0f), 0.0f).reason ==
        LimitReason::none);  // as much as is granted
  CHECK(limiter.step(told::parts(0, 90.0f, 90.0f, 20.0f), 0.0f).power == 0);
}

TEST_CASE("a node limiter before its first step, after a cut, and with what is no temperature") {
  const int numbers[] = {NodeLimiter::bracket, NodeLimiter::body, NodeLimiter::magnets, NodeLimiter::winding,
                         NodeLimiter::count};
  for (int i = 0; i < 5; ++i) CHECK(numbers[i] == i);  // for logs
  CHECK(static_cast<int>(NodeLimiter::none) == 255);
  NodeLimiter limiter;
  CHECK(limiter.ceiling() == least_power());
  CHECK(limiter.state().node == NodeLimiter::none);
  CHECK(std::isnan(limiter.state().margin_K));
  for (int i = 0; i < NodeLimiter::count; ++i) CHECK(std::isnan(limiter.state().node_C[i]));
  CHECK(limiter.step(told::parts(255, 30.0f, 30.0f, 20.0f), 0.0f).power == 255);
  CHECK(limiter.cut(LimitReason::link_silent).power == least_power());
  CHECK(limiter.cut(LimitReason::link_silent).reason == LimitReason::link_silent);
  CHECK(limiter.cut(LimitReason::link_silent, 0).power == 0);
  CHECK(limiter.ceiling() == least_power());
  const float none = detail::not_a_number();
  for (const float bad : {none, -274.0f, -273.15f, 1.0e4f, 1.0e9f}) {
    CAPTURE(bad);
    CHECK(limiter.step(told::parts(255, bad, 30.0f, 20.0f), 0.0f).reason ==
          LimitReason::temperature_not_finite);
    CHECK(limiter.step(told::parts(255, 30.0f, bad, 20.0f), 0.0f).reason ==
          LimitReason::temperature_not_finite);
    // Air that is no temperature counts as as warm as the body.
    CHECK(limiter.step(told::parts(255, 30.0f, 30.0f, bad), 0.0f).power == 255);
    CHECK(limiter.state().node_C[NodeLimiter::bracket] == 30.0f);
  }
  CHECK(limiter.step(told::parts(255, 9999.0f, 30.0f, 20.0f), 0.0f).reason == LimitReason::over_temperature);
  CHECK(limiter.step(told::parts(255, -273.0f, -273.0f, -273.0f), 0.0f).power == 255);
}

TEST_CASE("a node limit out of its range is refused by name and keeps the power at its least") {
  NodeLimiter::Config config = NodeLimiter::Config::standard();
  for (int i = 0; i < NodeLimiter::count; ++i) {
    config = NodeLimiter::Config::standard();
    for (const float good : {0.0f, 250.0f}) {
      config.node[i].maximum_C = good;
      CHECK(config.validate() == ConfigError::none);
    }
    for (const float bad : {-0.001f, 250.01f, detail::not_a_number()}) {
      config.node[i].maximum_C = bad;
      CHECK(config.validate() == ConfigError::maximum_C);
      CHECK(NodeLimiter(config).step(told::parts(255, 30.0f, 30.0f, 20.0f), 0.0f).reason ==
            LimitReason::config_invalid);
    }
    config = NodeLimiter::Config::standard();
    for (const float good : {0.0f, 2.0f}) {
      config.node[i].fraction = good;
      CHECK(config.validate() == ConfigError::none);
    }
    for (const float bad : {-0.001f, 2.001f}) {
      config.node[i].fraction = bad;
      CHECK(NodeLimiter(config).validate() == ConfigError::offset_fraction);
    }
  }
  config = NodeLimiter::Config::standard();
  config.derating_K = 5.0f;
  CHECK(NodeLimiter(config).config().derating_K == 5.0f);
  config.derating_K = 0.0f;
  CHECK(NodeLimiter(config).validate() == ConfigError::derating_K);
}

TEST_CASE("authority falls continuously with temperature: no threshold, no jump, monotone") {
  NodeLimiter limiter;
  int last = 255;
  for (int i = 0; i <= 40000; ++i) {
    const float body_C = 30.0f + 0.001f * static_cast<float>(i);
    const int power = limiter.step(told::parts(255, body_C + 5.0f, body_C, 20.0f), 0.0f).power;
    if (power > last || last - power > 1) FAIL("from " << last << " to " << power << " at " << body_C);
    last = power;
  }
  CHECK(last == 1);
}

TEST_CASE("in slow loops, too, a node limiter settles on one power and passes no limit: it does not hunt") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (const double dt_s : {0.02, 0.1, 0.3, 1.0})
    for (int draw = 0; draw < 20; ++draw) {
      const double winding_J_per_K = 2.0 + 6.0 * any(random), body_J_per_K = 40.0 + 80.0 * any(random),
                   coupling_W_per_K = 0.5 + any(random), air_W_per_K = 0.1 + 0.3 * any(random),
                   full_W = 10.0 + 40.0 * any(random);
      double winding_C = 25.0, body_C = 25.0;
      int power = 1, least = 255, most = 0;
      double over_K = -1e9;
      NodeLimiter limiter;
      const double body_limit_C = static_cast<double>(limiter.config().node[NodeLimiter::bracket].maximum_C),
                   winding_limit_C =
                       static_cast<double>(limiter.config().node[NodeLimiter::winding].maximum_C);
      for (double now_s = 0.0; now_s < 6000.0; now_s += dt_s) {
        const int parts = 1 + static_cast<int>(dt_s / 0.02);
        for (int i = 0; i < parts; ++i) {
          const double across_W = coupling_W_per_K * (winding_C - body_C), part_s = dt_s / parts;
          winding_C += part_s * (full_W * power / 255.0 - across_W) / winding_J_per_K;
          body_C += part_s * (across_W - air_W_per_K * (body_C - 25.0)) / body_J_per_K;
          over_K = std::max({over_K, body_C - body_limit_C, winding_C - winding_limit_C});
        }
        power = limiter
                    .step(told::parts(255, static_cast<float>(winding_C), static_cast<float>(body_C), 25.0f),
                          static_cast<float>(dt_s))
                    .power;
        if (now_s < 5400.0) continue;
        least = std::min(least, power);
        most = std::max(most, power);
      }
      INFO("loop of " << dt_s << " s, draw " << draw);
      CHECK(most - least <= 1);
      CHECK(over_K <= 0.0);
    }
}

TEST_CASE("per-node limits compose with an axis and hold every limit of its model") {
  typedef AxisController<Motor, StepPowerLaw<>, NodeLimiter, NoGain> Axis;
  Axis axis;
  REQUIRE(axis.validate() == ConfigError::none);
  float hottest_body_C = 0.0f;
  int changes = 0, last = 0;
  for (int i = 0; i < 300000; ++i) {
    const Axis::State& state = axis.step({5.0f, 13.0f, 25.0f, LimitReason::none}, 0.01f);
    hottest_body_C = std::max(hottest_body_C, axis.thermal().state().body_C);
    if (i > 290000 && state.power != last) ++changes;
    last = state.power;
  }
  CHECK(hottest_body_C <= 60.0f);
  CHECK(hottest_body_C > 50.0f);
  CHECK(changes <= 1);
}

TEST_CASE("a certified limiter composes with an axis, faults and all") {
  typedef AxisController<Motor, StepPowerLaw<>, CertifiedLimiter<>, NoGain> Axis;
  Axis::Config config = Axis::Config::standard();
  CHECK(is_error(config.validate()));  // no bounds declared
  config.limiter.network = CertifiedTwoNode::Config::around(Motor::thermal(), 0.1f, 110.0f, 60.0f);
  config.limiter.use.heat = HeatBounds::ohmic(13.0f, 0.02f, Bounds::around(8.0f, 0.03f), {0.0038f, 0.004f},
                                              20.0f, 0.0f, 110.0f, 5.0f);
  config.limiter.use.highest_air_C = 35.0f;
  REQUIRE(config.validate() == ConfigError::none);
  Axis axis(config);
  axis.start(25.0f);
  axis.limiter().start(25.0f, 25.0f);
  float hottest_body_C = 0.0f;
  for (int i = 0; i < 200000; ++i) {
    const LimitReason fault = i % 5000 < 200 ? LimitReason::link_silent : LimitReason::none;
    const Axis::State& state = axis.step({5.0f, 13.0f, 25.0f, fault}, 0.02f);
    if (is_fault(fault)) CHECK(state.power == 1);
    hottest_body_C = std::max(hottest_body_C, axis.thermal().state().body_C);
    REQUIRE(axis.thermal().state().body_C <= axis.limiter().body_upper_C());
    REQUIRE(axis.thermal().state().winding_C <= axis.limiter().winding_upper_C());
  }
  CHECK(hottest_body_C < 60.0f);
  CHECK(hottest_body_C > 48.0f);
  CHECK(axis.state().reason == LimitReason::body_limit);
}

TEST_CASE("the holding law learns the lowest power that holds each pose") {
  AdaptiveHoldingLaw<8> law;
  REQUIRE(law.validate() == ConfigError::none);
  const Joint joint;
  double error_sum = 0.0;
  int late = 0;
  for (int i = 0; i < 400000; ++i) {
    const double pose_deg = -78.75 + 22.5 * ((i / 2000) % 8);
    static int power = 10;
    const double error_deg = joint.error_deg(pose_deg, power);
    power = law.step(static_cast<float>(error_deg), at_pose(static_cast<float>(pose_deg)), 0.01f);
    if (i > 300000) {
      ++late;
      error_sum += error_deg > 0.12 ? 1.0 : 0.0;
    }
  }
  CHECK(error_sum / late < 0.02);  // within a fifth above the tolerance, nearly always
  // More at the poses that carry more, and far less than what the hardest pose needs everywhere.
  CHECK(law.learned_power(0) > 1.5f * law.learned_power(3));
  for (uint8_t bin = 0; bin < 8; ++bin) {
    const double pose_deg = -78.75 + 22.5 * bin, needed = joint.needed(pose_deg);
    const double least = 255.0 * needed * needed;
    INFO("pose " << pose_deg << " needs " << least << ", learned " << law.learned_power(bin));
    CHECK(static_cast<double>(law.learned_power(bin)) < 1.5 * least + 25.0);
    CHECK(static_cast<double>(law.learned_power(bin)) > 0.5 * least);
  }
}

TEST_CASE("the holding law: a bump is answered at once and hardly remembered; a limiter teaches nothing") {
  AdaptiveHoldingLaw<4> law;
  CHECK(law.step(1.0f, at_pose(0.0f), 0.01f) == 250);  // the full error gets full power in the same step
  const uint8_t bin = law.state().bin;
  CHECK(law.learned_power(bin) < 12.0f);
  const float before = law.learned_power(bin);
  for (int i = 0; i < 10000; ++i) law.step(0.5f, at_pose(0.0f, LimitReason::body_limit), 0.01f);
  CHECK(law.learned_power(bin) == before);
  CHECK(law.state().is_held);
  law.step(0.5f, at_pose(0.0f), 0.01f);
  CHECK(law.learned_power(bin) > before);
  CHECK(law.step(detail::not_a_number(), at_pose(0.0f), 0.01f) == 10);
  law.step(0.0f, at_pose(detail::not_a_number()), 0.01f);
  CHECK(law.state().bin == bin);
  law.step(0.0f, at_pose(1.0e9f), 0.01f);
  CHECK(law.state().bin == 3);
}

TEST_CASE(
    "an axis tells its law where it stands and what was granted last, however deep the law is wrapped") {
  typedef AxisController<Motor, SagAwareLaw<ReserveLaw<AdaptiveHoldingLaw<4>>>, NodeLimiter, NoGain> Axis;
  static_assert(Axis::takes_pose(), "");
  static_assert(!AxisController<Motor, StepPowerLaw<>, NodeLimiter, NoGain>::takes_pose(), "");
  Axis axis;
  REQUIRE(axis.validate() == ConfigError::none);
  const AdaptiveHoldingLaw<4>& law = axis.power_law().law().law();
  axis.start(25.0f);
  axis.step({0.0f, 13.0f, 25.0f, LimitReason::none}, 80.0f, 0.01f);
  CHECK(law.state().bin == 3);
  CHECK(law.state().is_held);  // nothing was granted before the first step
  axis.step({0.0f, 13.0f, 25.0f, LimitReason::none}, -80.0f, 0.01f);
  CHECK(law.state().bin == 0);
  CHECK_FALSE(law.state().is_held);
  axis.step({0.0f, 13.0f, 25.0f, LimitReason::none}, 0.01f);  // no pose: the range stays
  CHECK(law.state().bin == 0);
  axis.step({0.0f, 13.0f, 25.0f, LimitReason::link_silent}, 0.01f);
  CHECK_FALSE(law.state().is_held);
  axis.step({0.0f, 13.0f, 25.0f, LimitReason::none}, 0.01f);
  CHECK(law.state().is_held);
}

TEST_CASE("learning does not depend on the loop rate") {
  float learned[2];
  const float rates_s[] = {0.002f, 0.02f};
  for (int r = 0; r < 2; ++r) {
    AdaptiveHoldingLaw<1> law;
    for (int i = 0; i < static_cast<int>(3.0f / rates_s[r] + 0.5f); ++i)
      law.step(0.15f, at_supply(13.0f), rates_s[r]);
    learned[r] = law.learned_power(0);
  }
  CHECK(learned[0] == Approx(learned[1]).margin(0.5));
  CHECK(learned[0] > 50.0f);
}

TEST_CASE("the torque stays what the law meant when the supply sags, within bounds") {
  SagAwareLaw<> law;
  REQUIRE(law.validate() == ConfigError::none);
  for (const float supply_V : {16.8f, 14.0f, 13.0f, 11.0f, 9.5f}) {
    const uint8_t power = law.step(0.35f, at_supply(supply_V), 0.01f);
    const double v_rms = static_cast<double>(supply_V) * std::sqrt(power / 255.0);
    CHECK(v_rms == Approx(13.0 * std::sqrt(75.0 / 255.0)).epsilon(0.01));
  }
  CHECK(law.step(0.35f, at_supply(5.0f), 0.01f) == law.step(0.35f, at_supply(9.0f), 0.01f));  // bounded
  CHECK(law.step(10.0f, at_supply(9.0f), 0.01f) == 255);
  CHECK(law.step(0.35f, at_supply(detail::not_a_number()), 0.01f) == 75);
  CHECK(law.step(0.35f, at_supply(0.0f), 0.01f) == 75);
  CHECK(law.step(0.35f, AxisFacts::unknown(), 0.01f) == 75);
}

TEST_CASE("a sag-aware law never gets past the limiter") {
  typedef AxisController<Motor, SagAwareLaw<>, NodeLimiter, NoGain> Axis;
  Axis axis;
  axis.start(59.0f);
  const Axis::State& state = axis.step({5.0f, 9.0f, 25.0f, LimitReason::none}, 0.01f);
  CHECK(state.demand == 255);
  CHECK(state.power <= state.ceiling);
  CHECK(state.power < 60);
}

TEST_CASE("gain times authority stays constant over power, supply and temperature") {
  VoltageGain::Config config = VoltageGain::Config::standard();
  CHECK(config.validate() == ConfigError::gain_low_power);
  config.gain_low_power = 60.0f;
  REQUIRE(config.validate() == ConfigError::none);
  VoltageGain gain(config);
  const auto authority = [](double power, double supply_V, double winding_C, double body_C) {
    return supply_V * std::sqrt(power / 255.0) / (1.0 + 0.00393 * (winding_C - 25.0)) *
           (1.0 - 0.0011 * (body_C - 25.0));
  };
  const double tuned = 60.0 * authority(100.0, 13.0, 25.0, 25.0);
  for (const int power : {25, 50, 100, 250})
    for (const float supply_V : {9.0f, 13.0f, 16.0f})
      for (const float winding_C : {0.0f, 25.0f, 100.0f}) {
        const float body_C = 0.5f * (winding_C + 25.0f);
        AxisFacts facts = at_supply(supply_V);
        facts.motor_C = told::degrees(winding_C), facts.body_C = told::degrees(body_C);
        const int p = gain.step(static_cast<uint8_t>(power), facts);
        const double exact = tuned / authority(power, static_cast<double>(supply_V),
                                               static_cast<double>(winding_C), static_cast<double>(body_C));
        CHECK(std::abs(p - std::min(exact, 255.0)) <= 0.51);
      }
  CHECK(gain.step(100) == 60);
  CHECK(gain.step(100, AxisFacts::unknown()) == 60);
}

TEST_CASE("behind a sine's amplitude the gain is inverse to POWER, and all else as behind a switch") {
  typedef BasicVoltageGain<SineDrive> Gain;
  Gain::Config config = Gain::Config::standard();
  config.gain_low_power = 60.0f;
  Gain gain(config);
  CHECK(gain.step(100) == 60);
  CHECK(gain.step(200) == 30);
  CHECK(gain.step(50) == 120);
  CHECK(gain.step(10) == 255);
  AxisFacts facts = at_supply(6.5f);
  CHECK(gain.step(200, facts) == 60);
  facts.motor_C = facts.body_C = told::degrees(125.0f);
  // 60 (1 + 0.00393 * 100) / (1 - 0.0011 * 100)
  CHECK(gain.step(200, facts) == 94);
}

TEST_CASE("the sine's amplitude is nearer to the measured currents than a switch's V_rms") {
  // Tables 4.1 and 4.2, cold, 13 V: what the supply gave at POWER 50 .. 250, mA. All of it became heat, so the
  // winding's current, and the torque with it, is as its root.
  const double supply_mA[2][5] = {{56, 204, 410, 678, 975}, {34, 127, 273, 460, 689}};
  for (const auto& motor_mA : supply_mA) {
    double sine_off = 0.0, switched_off = 0.0;
    for (int i = 0; i < 5; ++i) {
      const float ratio = static_cast<float>(i + 1) / 2.0f;  // against POWER 100
      const double torque = std::sqrt(motor_mA[i] / motor_mA[1]);
      sine_off =
          std::max(sine_off, std::abs(torque / static_cast<double>(SineDrive::voltage_ratio(ratio)) - 1.0));
      switched_off = std::max(
          switched_off, std::abs(torque / static_cast<double>(SwitchedDrive::voltage_ratio(ratio)) - 1.0));
    }
    CHECK(sine_off < 0.13);
    CHECK(switched_off > 0.35);
  }
}

TEST_CASE("a reserve rises with a disturbance, stays while they last, and an axis at rest pays for none") {
  typedef ReserveLaw<StepPowerLaw<>> Law;
  for (const float dt_s : {0.002f, 0.02f}) {
    INFO("step " << dt_s << " s");
    Law law;
    REQUIRE(law.validate() == ConfigError::none);
    const auto run = [&](float error_deg, float time_s) {
      int power = 0;
      for (int i = 0; i < static_cast<int>(time_s / dt_s + 0.5f); ++i)
        power = law.step(error_deg, at_supply(13.0f), dt_s);
      return power;
    };
    CHECK(run(0.05f, 10.0f) == 25);                   // calm: what the law asks for
    CHECK(run(0.09f, 0.1f) == Approx(25).margin(1));  // 20 counts in a tenth of a second
    CHECK(run(0.09f, 0.2f) == 50);
    CHECK(run(0.0f, 3.9f) == 50);  // kept for four seconds
    CHECK(run(0.0f, 1.1f) < 50);   // and sinks by 2 a second
    CHECK(run(0.0f, 1.0f) > 44);
    CHECK(run(0.0f, 12.0f) == 25);
    CHECK(run(0.9f, 0.5f) == 225);  // never less than the law asks for
  }
}

TEST_CASE("a reserve is not touched by what is not a number, and never gets past a bad time") {
  ReserveLaw<StepPowerLaw<>> law;
  const float nan = detail::not_a_number();
  for (int i = 0; i < 1000; ++i) law.step(0.5f, at_supply(13.0f), nan);
  CHECK(law.state().reserve == 0.0f);
  for (int i = 0; i < 1000; ++i) law.step(0.5f, at_supply(13.0f), -1.0f);
  CHECK(law.state().reserve == 0.0f);
  law.step(0.5f, at_supply(13.0f), 1000.0f);
  CHECK(law.state().reserve == 50.0f);
  for (int i = 0; i < 1000; ++i) CHECK(law.step(nan, at_supply(13.0f), 0.1f) == 50);
}

TEST_CASE("an eased gain: as it is on target, gain times error bounded beyond, and back without a swing") {
  EasedGain<>::Config config = EasedGain<>::Config::standard();
  CHECK(config.validate() == ConfigError::gain_low_power);  // to be set
  config.gain = {40.0f, 40.0f};
  EasedGain<> gain(config);
  REQUIRE(gain.validate() == ConfigError::none);
  AxisFacts facts = at_supply(13.0f);
  for (float error_deg = -180.0f; error_deg <= 180.0f; error_deg += 0.25f) {
    facts.error_deg = error_deg;
    const int given = gain.step(100, facts);
    INFO("error " << error_deg << " deg, gain " << given);
    if (std::abs(error_deg) <= 1.5f) CHECK(given == 40);
    else
      CHECK((given == 3 ||
             std::abs(static_cast<float>(given) * error_deg) <= 60.0f + 0.5f * std::abs(error_deg)));
    CHECK(given >= 3);
  }
  facts.error_deg = detail::not_a_number();
  CHECK(gain.step(100, facts) == 40);
  config.ease_from_deg = 0.0f;
  CHECK(config.validate() == ConfigError::ease_from_deg);

  // A rigid axis that is thrown by 100 degrees: torque of the board's loop, bounded, with its damping fixed.
  double overshoot_deg[2];
  for (int eased = 0; eased < 2; ++eased) {
    double angle_deg = -100.0, rate = 0.0, farthest = -1e9;
    for (int i = 0; i < 40000; ++i) {
      facts.error_deg = static_cast<float>(-angle_deg);
      const double p_gain = eased != 0 ? gain.step(100, facts) : 40;
      const double share = std::fmin(1.0, std::fmax(-1.0, -0.03 * p_gain * angle_deg - 0.035 * rate));
      rate += 3000.0 * share * 0.0005, angle_deg += rate * 0.0005;
      farthest = std::fmax(farthest, angle_deg);
    }
    overshoot_deg[eased] = farthest;
  }
  CHECK(overshoot_deg[0] > 30.0);
  CHECK(overshoot_deg[1] < 1.0);
}

TEST_CASE("laws with a wrong field are refused by name") {
  AdaptiveHoldingConfig holding = AdaptiveHoldingConfig::standard();
  holding.tolerance_deg = 0.0f;
  CHECK(holding.validate() == ConfigError::tolerance_deg);
  holding = AdaptiveHoldingConfig::standard();
  holding.last_pose_deg = holding.first_pose_deg;
  CHECK(holding.validate() == ConfigError::pose_deg);
  SagAwareLaw<>::Config sag = SagAwareLaw<>::Config::standard();
  sag.minimum_supply_V = 20.0f;
  CHECK(sag.validate() == ConfigError::minimum_supply_V);
  ReserveLaw<>::Config reserve = ReserveLaw<>::Config::standard();
  reserve.reserve_power = 0;
  CHECK(reserve.validate() == ConfigError::reserve_power);
  reserve = ReserveLaw<>::Config::standard();
  reserve.moving_error_deg = 0.0f;
  CHECK(reserve.validate() == ConfigError::moving_error_deg);
  reserve = ReserveLaw<>::Config::standard();
  reserve.calm_s = -1.0f;
  CHECK(reserve.validate() == ConfigError::calm_s);
  reserve = ReserveLaw<>::Config::standard();
  reserve.rise_per_s = 0.0f;
  CHECK(reserve.validate() == ConfigError::rise_per_s);
  reserve = ReserveLaw<>::Config::standard();
  reserve.fall_per_s = detail::not_a_number();
  CHECK(reserve.validate() == ConfigError::fall_per_s);
  reserve.law.power_step = 0;
  CHECK(reserve.validate() == ConfigError::power_step);
  NodeLimiter::Config nodes = NodeLimiter::Config::standard();
  nodes.node[1].fraction = 3.0f;
  CHECK(nodes.validate() == ConfigError::offset_fraction);
}
