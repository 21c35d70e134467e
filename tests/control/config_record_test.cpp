// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The configuration of every component through a record of bytes and back; every bit of a record that is wrong.

#include "../catch.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include <thermopower/thermopower.hpp>

using namespace thermopower;

namespace {

struct Motor {
  typedef CachedCurrent<OhmicCurrent<float>> Current;
  typedef ObservedThermal Thermal;
  static Current::Config current() { return {8.0f, 0.0039f, 20.0f}; }
  static SupplyRange supply() { return {1.0f, 30.0f}; }
  static Thermal::Config thermal() {
    return {TemperatureObserverConfig::standard({8.0f, 80.0f, 1.0f, {0.2f}}), 110.0f, 1, 0};
  }
};

CertifiedUse use() {
  return {HeatBounds::ohmic(13.0f, 0.02f, {7.6f, 8.4f}, {0.0038f, 0.0040f}, 20.0f, 0.0f, 110.0f, 9.0f),
          35.0f,
          0.1f,
          30.0f,
          3,
          2};
}

CertifiedLimiter<>::Config certified() {
  return {CertifiedTwoNode::Config::around(TwoNodeThermalModel<float>::Config{8.0f, 80.0f, 1.0f, {0.2f}},
                                           0.1f, 110.0f, 60.0f),
          use(), 5.0f};
}

template <class Config>
std::vector<std::uint8_t> record_of(const Config& config, std::uint8_t version = 7) {
  std::vector<std::uint8_t> bytes(config_record_size(config));
  REQUIRE(write_config(config, version, bytes.data(), bytes.size()) == bytes.size());
  return bytes;
}

/// Bytes of two objects, padding included: copies of one object agree there, too.
template <class Config>
bool is_same_object(const Config& left, const Config& right) {
  return std::memcmp(&left, &right, sizeof left) == 0;
}

/// Everything that is claimed of a record, for one component. @param fields_size  by hand, from the declaration
template <class Config>
void check_component(const char* name, const Config& config, std::size_t fields_size) {
  CAPTURE(name);
  REQUIRE(config.validate() == ConfigError::none);
  const std::vector<std::uint8_t> bytes = record_of(config);
  CHECK(bytes.size() == 10 + fields_size);

  // There and back: what is read writes the same bytes, and every field arrives.
  Config read = config;
  std::vector<std::uint8_t> zeros(sizeof(Config), 0);
  std::memcpy(static_cast<void*>(&read), zeros.data(), sizeof read);
  REQUIRE(read_config(read, 7, bytes.data(), bytes.size()).error == ConfigRecordError::none);
  CHECK(record_of(read) == bytes);
  CHECK(read.validate() == ConfigError::none);

  // No field is left out: four adjacent bytes of the object without any effect on the record would be more than
  // padding.
  int idle = 0, longest_idle = 0;
  for (std::size_t i = 0; i < sizeof(Config); ++i) {
    Config changed = config;
    reinterpret_cast<unsigned char*>(&changed)[i] ^= 0x11u;
    idle = record_of(changed) == bytes ? idle + 1 : 0;
    longest_idle = std::max(longest_idle, idle);
  }
  CHECK(longest_idle < 4);

  // Any single bit that is wrong is noticed, and changes nothing.
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::vector<std::uint8_t> flipped = bytes;
    flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1u << (bit % 8)));
    Config untouched = config;
    const ConfigRead result = read_config(untouched, 7, flipped.data(), flipped.size());
    if (result.error == ConfigRecordError::none) FAIL("bit " << bit << " is not noticed");
    if (!is_same_object(untouched, config)) FAIL("bit " << bit << " changed the configuration");
  }

  // So is every length that is too short; what follows a record does not matter.
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Config untouched = config;
    CHECK(read_config(untouched, 7, bytes.data(), size).error == ConfigRecordError::too_short);
    std::vector<std::uint8_t> room(size, 0xab);
    CHECK(write_config(config, 7, room.data(), size) == 0);
    CHECK(room == std::vector<std::uint8_t>(size, 0xab));
  }
  std::vector<std::uint8_t> longer = bytes;
  longer.insert(longer.end(), 50, 0xff);
  CHECK(read_config(read, 7, longer.data(), longer.size()).error == ConfigRecordError::none);
  CHECK(read_config(read, 8, bytes.data(), bytes.size()).error == ConfigRecordError::other_version);
}

}  // namespace

TEST_CASE("the configuration of every actuator model goes through a record") {
  check_component("OhmicCurrent", OhmicCurrent<float>{8.0f, 0.0039f, 20.0f}, 12);
  check_component("ThesisCurrent", motors::Bgm2606_90t::current(), 24);
  check_component("HeatCapacityHeating", HeatCapacityHeating<float>{30.0f}, 4);
  check_component("ThermalModel, thesis", motors::Bgm2606_90t::thermal(), 28);
  check_component("NewtonCooling", NewtonCooling<float>{0.2f}, 4);
  check_component("NaturalConvection", NaturalConvection<float>{0.2f, 0.25f, 30.0f}, 12);
  check_component("ForcedAirflow", ForcedAirflow<float>{0.2f, 1.0f, 0.5f}, 12);
  check_component("SumOfCooling",
                  SumOfCooling<NewtonCooling<float>, RadiationCooling<float>>{{0.1f}, {0.01f, 0.9f}}, 12);
  check_component("TwoNodeThermalModel", TwoNodeThermalModel<float>::Config{8.0f, 80.0f, 1.0f, {0.2f}}, 16);
  check_component("TemperatureObserver", TemperatureObserverConfig::standard({8.0f, 80.0f, 1.0f, {0.2f}}),
                  config_record_size(TemperatureObserverConfig::standard({})) - 10);
  check_component("ObservedThermal", Motor::thermal(),
                  config_record_size(TemperatureObserverConfig::standard({})) - 10 + 6);
  WindingResistance::Config copper = WindingResistance::Config::standard();
  copper.resistance_ohm = 8.0f;
  check_component("WindingResistance", copper, 32);
}

TEST_CASE("the configuration of every policy goes through a record") {
  check_component("StepPowerLaw", StepPowerLaw<>::Config::standard(), 9);
  check_component("AdaptiveHoldingLaw", AdaptiveHoldingConfig::standard(), 26);
  check_component("ReserveLaw", ReserveLaw<>::Config::standard(), 9 + 17);
  check_component("SagAwareLaw", SagAwareLaw<ReserveLaw<AdaptiveHoldingLaw<>>>::Config::standard(),
                  26 + 17 + 8);
  check_component("SafetyLimiter", SafetyLimiter<>::Config::standard(), 12);
  check_component("NodeLimiter", NodeLimiter::Config::standard(), 40);
  check_component("CertifiedLimiter, two nodes", certified(), 32 + 38 + 4);
  check_component("CertifiedLimiter, two nodes, both ends of their coupling",
                  CertifiedLimiter<CertifiedCoupledTwoNode>::Config{{certified().network, 1.1f}, use(), 5.0f},
                  36 + 38 + 4);
  check_component("CertifiedLimiter, one node",
                  CertifiedLimiter<CertifiedOneNode>::Config{{{70.0f, 90.0f}, 0.18f, 60.0f}, use(), 5.0f},
                  16 + 38 + 4);
  check_component(
      "LimiterChain",
      LimiterChain<NodeLimiter, CertifiedLimiter<>>::Config{NodeLimiter::Config::standard(), {certified()}},
      40 + 74);
  check_component("GainScheduler", GainConfig{24.0f, 4.0f}, 8);
  VoltageGain::Config gain = VoltageGain::Config::standard();
  gain.gain_low_power = 60.0f;
  check_component("VoltageGain", gain, 22);
  check_component("EasedGain", EasedGain<VoltageGain>::Config{gain, 1.5f, 3}, 27);
  UtilisationConfig utilisation = UtilisationConfig::standard();
  utilisation.maximum_winding_C = 110.0f, utilisation.maximum_body_C = 60.0f;
  check_component("SensorLimiter", SensorLimiter::Config::standard(), 5);
  check_component("Utilisation", utilisation, 20);
  check_component("AirTemperature", AirTemperature::Config::standard(), 20);
  check_component("AirWitness", AirWitness::Config::standard(), 12);
  check_component("GimbalController", GimbalConfig::standard(), 36);
}

TEST_CASE("a whole axis goes through one record") {
  typedef AxisController<Motor, SagAwareLaw<>, LimiterChain<SafetyLimiter<>, NodeLimiter>, EasedGain<>> Axis;
  Axis::Config config = Axis::Config::standard();
  config.gain.gain = {24.0f, 4.0f};
  check_component("AxisController", config,
                  12 + config_record_size(Motor::thermal()) - 10 + 17 + 12 + 40 + 13 + 8);
}

TEST_CASE("a record is the bytes that the page says, on any machine") {
  const std::vector<std::uint8_t> bytes = record_of(StepPowerConfig{1.0f, 25, -2.5f}, 0x42);
  std::vector<std::uint8_t> expected = {'T',  'P',  1,    0x42, 0,    0,    9,    0,   0x00,
                                        0x00, 0x80, 0x3f, 25,   0x00, 0x00, 0x20, 0xc0};
  // CRC-16/CCITT-FALSE bit by bit through a register of its own; its check value is 0x29B1.
  const auto crc = [](const std::vector<std::uint8_t>& of) {
    unsigned long rest = 0xffff;
    for (const std::uint8_t byte : of)
      for (int bit = 7; bit >= 0; --bit) {
        const bool is_out = ((rest >> 15) & 1u) != ((byte >> bit) & 1u);
        rest = (rest << 1) & 0xffffu;
        if (is_out) rest ^= 0x1021u;
      }
    return rest;
  };
  REQUIRE(crc({'1', '2', '3', '4', '5', '6', '7', '8', '9'}) == 0x29b1);
  const unsigned long kinds = crc({'f', 'b', 'f'});
  expected[4] = static_cast<std::uint8_t>(kinds), expected[5] = static_cast<std::uint8_t>(kinds >> 8);
  const unsigned long sum = crc(expected);
  expected.push_back(static_cast<std::uint8_t>(sum)), expected.push_back(static_cast<std::uint8_t>(sum >> 8));
  CHECK(bytes == expected);
}

TEST_CASE("each way in which a record is no record has its name") {
  SafetyLimiterConfig config = SafetyLimiterConfig::standard();
  std::vector<std::uint8_t> bytes = record_of(config);
  std::vector<std::uint8_t> empty(bytes.size(), 0xff), zero(bytes.size(), 0);
  CHECK(read_config(config, 7, empty.data(), empty.size()).error == ConfigRecordError::not_a_record);
  CHECK(read_config(config, 7, zero.data(), zero.size()).error == ConfigRecordError::not_a_record);
  bytes[9] ^= 1u;
  CHECK(read_config(config, 7, bytes.data(), bytes.size()).error == ConfigRecordError::damaged);
  const std::vector<std::uint8_t> other = record_of(GainConfig{24.0f, 4.0f});
  CHECK(read_config(config, 7, other.data(), other.size()).error == ConfigRecordError::other_layout);
  // Whole, but what it says is no configuration.
  SafetyLimiterConfig wrong = config;
  wrong.safety_time_s = -1.0f;
  const std::vector<std::uint8_t> refused = record_of(wrong);
  const ConfigRead result = read_config(config, 7, refused.data(), refused.size());
  CHECK(result.error == ConfigRecordError::config_refused);
  CHECK(result.field == ConfigError::safety_time_s);
  CHECK(config.safety_time_s == 30.0f);
  SafetyLimiterConfig unset = config;
  unset.maximum_C = detail::not_a_number();
  const std::vector<std::uint8_t> nan = record_of(unset);
  CHECK(read_config(config, 7, nan.data(), nan.size()).field == ConfigError::maximum_C);
}
