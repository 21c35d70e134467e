// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Laws and gains at the ends of what they are made for: constants that are refused, inputs that are none.

#include "../catch.hpp"
#include "limiter_inputs.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <thermopower/thermopower.hpp>

#include "motors.hpp"

using namespace thermopower;

namespace {

const float nan_ = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

/// A field with each of some values, all others as they were.
template <class Config, class Field>
void refused(const Config& good, Field Config::*field, const std::vector<Field>& bad, ConfigError name) {
  REQUIRE(good.validate() == ConfigError::none);
  for (const Field value : bad) {
    Config config = good;
    config.*field = value;
    CAPTURE(value);
    CHECK(config.validate() == name);
  }
}

AxisFacts facts_at(float supply_V, float motor_C = 25.0f, float body_C = 25.0f) {
  AxisFacts facts = AxisFacts::unknown();
  facts.supply_V = supply_V;
  facts.motor_C = told::degrees(motor_C);
  facts.body_C = told::degrees(body_C);
  return facts;
}
VoltageGain::Config voltage_gain() {
  VoltageGain::Config config = VoltageGain::Config::standard();
  config.gain_low_power = 60.0f;
  return config;
}

/// A field of each width.
struct Wide {
  uint8_t small;
  uint16_t start;
  uint32_t endurance;
  float rate;
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.small, self.start, self.endurance, self.rate);
  }
  ConfigError validate() const { return ConfigError::none; }
};
/// As many bytes of other kinds.
struct Swapped : Wide {
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.endurance, self.start, self.small, self.rate);
  }
};

}  // namespace

TEST_CASE("a wrong constant of the holding law is refused by name") {
  typedef AdaptiveHoldingConfig Config;
  const Config good = Config::standard();
  refused<Config, float>(good, &Config::full_power_error_deg, {0.1f, 0.0f, nan_, infinite},
                         ConfigError::full_power_error_deg);
  refused<Config, float>(good, &Config::learning_per_s, {0.0f, -1.0f, nan_}, ConfigError::learning_per_s);
  refused<Config, float>(good, &Config::forgetting_per_s, {-1.0f, 40.1f, nan_},
                         ConfigError::forgetting_per_s);
  refused<Config, uint8_t>(good, &Config::least_power, {0}, ConfigError::least_power);
  refused<Config, uint8_t>(good, &Config::highest_power, {9, 0}, ConfigError::highest_power);
  refused<Config, float>(good, &Config::first_pose_deg, {90.0f, nan_, -infinite}, ConfigError::pose_deg);
  refused<Config, float>(good, &Config::last_pose_deg, {-90.0f, nan_, infinite}, ConfigError::pose_deg);
}

TEST_CASE(
    "the holding law learns up to its highest power, in no time nothing, and beyond its poses in the last range") {
  AdaptiveHoldingConfig config = AdaptiveHoldingConfig::standard();
  config.highest_power = 60;
  AdaptiveHoldingLaw<4> law(config);
  AxisFacts facts = AxisFacts::unknown();
  facts.last_reason = LimitReason::none;
  facts.pose_deg = -500.0f;  // before the first: the first range's
  for (const float dt_s : {0.0f, -1.0f, nan_}) law.step(0.5f, facts, dt_s);
  CHECK(law.learned_power(0) == 10.0f);
  for (int i = 0; i < 1000; ++i)
    law.step(0.5f, facts, 0.1f);  // 100 s of an error: 40 counts a second and more
  CHECK(law.learned_power(0) == 60.0f);
  CHECK(law.step(0.5f, facts, 0.1f) == 60);
  CHECK(law.learned_power(1) == 10.0f);
  facts.pose_deg = 500.0f;
  for (int i = 0; i < 1000; ++i) law.step(0.5f, facts, 0.1f);
  CHECK(law.learned_power(3) == 60.0f);
  CHECK(law.learned_power(200) == law.learned_power(3));  // there are four
}

TEST_CASE("a wrong constant of the sag-aware law is refused by name, the law's own first") {
  typedef SagAwareLaw<>::Config Config;
  const Config good = Config::standard();
  refused<Config, float>(good, &Config::nominal_supply_V, {0.0f, -13.0f, nan_, infinite},
                         ConfigError::nominal_supply_V);
  refused<Config, float>(good, &Config::minimum_supply_V, {0.0f, -1.0f, 13.1f, nan_, infinite},
                         ConfigError::minimum_supply_V);
  Config config = good;
  config.law.power_step = 0;
  config.nominal_supply_V = 0.0f;
  CHECK(config.validate() == ConfigError::power_step);
}

TEST_CASE("a supply far above the nominal asks for less, and never for less than the least power") {
  SagAwareLaw<> law(SagAwareLaw<>::Config::standard());
  CHECK(law.step(0.5f, facts_at(26.0f), 0.03f) == std::lround(125.0 * 0.25));  // twice the voltage, a quarter
  CHECK(law.step(0.0f, facts_at(1.0e4f), 0.03f) == least_power());
}

TEST_CASE("a wrong constant of the voltage gain is refused by name") {
  typedef VoltageGain::Config Config;
  refused<Config, uint8_t>(voltage_gain(), &Config::tuned_power, {0}, ConfigError::least_power);
  refused<Config, float>(voltage_gain(), &Config::nominal_supply_V, {0.0f, -1.0f, nan_},
                         ConfigError::nominal_supply_V);
  refused<Config, float>(voltage_gain(), &Config::reference_C, {-51.0f, 201.0f, nan_},
                         ConfigError::reference_C);
  refused<Config, float>(voltage_gain(), &Config::tempco_per_K, {-0.001f, 0.021f, nan_},
                         ConfigError::tempco_per_K);
  refused<Config, float>(voltage_gain(), &Config::magnet_tempco_per_K, {-0.001f, 0.011f, nan_},
                         ConfigError::magnet_tempco_per_K);
}

TEST_CASE("the voltage gain asks anew when the body has warmed, and not for less than half a kelvin") {
  VoltageGain gain(voltage_gain());
  const int cold = gain.step(100, facts_at(13.0f));
  CHECK(cold == 60);
  CHECK(gain.step(100, facts_at(13.0f, 25.3f, 25.3f)) == cold);  // near both: the answer of before
  // 500 K warmer magnets have lost 55 %: one over what is left. Beyond what there can be, the body counts as at its tuning.
  CHECK(gain.step(100, facts_at(13.0f, 25.0f, 399.0f)) ==
        std::lround(60.0 / (1.0 - 0.0011 * (399.0 - 25.0))));
  CHECK(gain.step(100, facts_at(13.0f, 25.0f, 400.0f)) == cold);
}

TEST_CASE("a voltage gain without a supply takes the nominal one, and below the least power the least") {
  VoltageGain gain(voltage_gain());
  for (const float none_V : {0.0f, -5.0f, nan_}) CHECK(gain.step(100, facts_at(none_V)) == 60);
  CHECK(gain.step(0) == gain.step(1));
  VoltageGain::Config config = voltage_gain();
  config.gain_low_power = nan_;  // not set: no gain at all
  CHECK(VoltageGain(config).step(100) == 0);
}

TEST_CASE("a gain that is below the far gain already is not eased, and an error without end is none") {
  EasedGain<>::Config config = EasedGain<>::Config::standard();
  config.gain = {2.0f, 2.0f};  // below the far gain, 3
  EasedGain<> small(config);
  AxisFacts facts = facts_at(13.0f);
  facts.error_deg = 90.0f;
  CHECK(small.step(100, facts) == 2);
  config.gain = {40.0f, 40.0f};
  EasedGain<> eased(config);
  CHECK(eased.step(100, facts) == 3);  // 40 * 1.5 / 90 is less than that
  facts.error_deg = infinite;
  CHECK(eased.step(100, facts) == 40);
}

TEST_CASE("air that is to fall at no rate is refused") {
  AirTemperature::Config config = AirTemperature::Config::standard();
  for (const float bad : {0.0f, -1.0f, nan_}) {
    config.fall_per_s = bad;
    CHECK(config.validate() == ConfigError::fall_per_s);
  }
  config.fall_per_s = infinite;  // at once
  CHECK(config.validate() == ConfigError::none);
  for (const float bad : {86.0f, infinite, nan_})
    CHECK(AirTemperature::Config::declared(bad).validate() == ConfigError::declared_C);
  CHECK(AirTemperature::Config::believing().validate() == ConfigError::none);
}

TEST_CASE("what was set can be read back, and an axis knows whether its law wants the pose") {
  Utilisation::Config config = Utilisation::Config::standard();
  config.maximum_winding_C = 110.0f;
  config.maximum_body_C = 60.0f;
  CHECK(Utilisation(config).config().maximum_body_C == 60.0f);
  typedef AxisController<motors::Bgm2606_90t, AdaptiveHoldingLaw<4>> Holding;
  typedef AxisController<motors::Bgm2606_90t> Plain;
  CHECK(Holding::takes_pose());
  CHECK_FALSE(Plain::takes_pose());
}

TEST_CASE("a record of a field of each width comes back as it was") {
  const Wide written = {0xA5, 0xBEEF, 0xDEADBEEFul, -0.5f};
  uint8_t bytes[64];
  REQUIRE(config_record_size(written) == 8 + 1 + 2 + 4 + 4 + 2);
  REQUIRE(write_config(written, 3, bytes, sizeof bytes) == 21);
  CHECK(bytes[9] == 0xEF);  // the least byte first
  CHECK(bytes[11] == 0xEF);
  CHECK(bytes[14] == 0xDE);
  Wide read = {0, 0, 0, 0.0f};
  REQUIRE(read_config(read, 3, bytes, 21).error == ConfigRecordError::none);
  CHECK(read.small == 0xA5);
  CHECK(read.start == 0xBEEF);
  CHECK(read.endurance == 0xDEADBEEFul);
  CHECK(read.rate == -0.5f);
  Swapped swapped;
  CHECK(read_config(swapped, 3, bytes, 21).error == ConfigRecordError::other_layout);
}

TEST_CASE("air that is left out of what an axis or a gimbal is told is not 0 degC") {
  // Said to be nothing among facts in braces: warnings as errors refuse a list that ends before it.
  const AxisFacts facts = {255,  told::degrees(60.0f), told::degrees(50.0f), 0.0f, {}, 13.0f, 0.0f,
                           0.0f, LimitReason::none};
  CHECK(std::isnan(static_cast<float>(facts.air_C)));
  // Glass between body and air: at 0 degC it would be taken for colder than it may be.
  NodeLimiter::Config glass = NodeLimiter::Config::standard();
  glass.node[NodeLimiter::bracket] = {55.0f, 0.5f};
  NodeLimiter told(glass), left_out(glass);
  told.step(told::parts(255, 60.0f, 50.0f, 0.0f), 0.0f);
  left_out.step(NodeLimiter::read(facts), 0.0f);
  CHECK(told.state().node_C[NodeLimiter::bracket] == 25.0f);
  CHECK(left_out.state().node_C[NodeLimiter::bracket] == 50.0f);  // as warm as the body
  CHECK(left_out.step(NodeLimiter::read(facts), 0.0f).power <
        told.step(told::parts(255, 60.0f, 50.0f, 0.0f), 0.0f).power);
  // Thermometers that never said anything but 0 are none that were read.
  typedef AxisController<motors::Bgm2606_90t> Axis;
  typedef GimbalController<Axis> Gimbal;
  Gimbal gimbal(GimbalConfig::standard(), Axis::Config::with_gain({24.0f, 4.0f}));
  Gimbal::Inputs inputs = {};
  inputs.error_deg[0] = 0.5f;
  inputs.supply_V = 12.6f;
  const auto& command = gimbal.step(inputs, 0.03f);
  CHECK(std::isnan(gimbal.state().air_C));
  CHECK(command.power[0] == least_power());
  CHECK(command.reason[0] == LimitReason::air_implausible);
}
