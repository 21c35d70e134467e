// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/actuator/current_model.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/two_node_thermal_model.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>
#include <thermopower/motors/bgm5208_200_12.hpp>

#include "near.hpp"
#include "samples.hpp"

#include <limits>
#include <vector>

namespace tp = thermopower;
using tp::ConfigError;

namespace {
const float nan_ = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

/// A field is refused by its name for every bad value, and the same configuration passes with every good one.
template <class Config, class Field>
void field_is_named(Config good, Field Config::*field, ConfigError name, std::vector<Field> bad,
                    std::vector<Field> allowed) {
  REQUIRE(good.validate() == ConfigError::none);
  bad.insert(bad.end(), {Field(nan_), Field(infinite), Field(-infinite)});
  for (const Field value : bad) {
    Config config = good;
    config.*field = value;
    CAPTURE(static_cast<int>(name), value);
    CHECK(config.validate() == name);
  }
  for (const Field value : allowed) {
    Config config = good;
    config.*field = value;
    CAPTURE(static_cast<int>(name), value);
    CHECK(config.validate() == ConfigError::none);
  }
}
}  // namespace

TEMPLATE_TEST_CASE("a wrong constant of a current law is refused by name", "", float, double) {
  using Ohmic = tp::OhmicCurrent<TestType>;
  const Ohmic ohmic = {TestType(12), TestType(0.00393), TestType(20)};
  field_is_named<Ohmic, TestType>(ohmic, &Ohmic::resistance_ohm, ConfigError::resistance_ohm, {0, -1},
                                  {TestType(1e-3), 1000});
  field_is_named<Ohmic, TestType>(ohmic, &Ohmic::tempco_per_K, ConfigError::tempco_per_K,
                                  {TestType(-0.001), TestType(0.021)}, {0, TestType(0.02)});
  field_is_named<Ohmic, TestType>(ohmic, &Ohmic::reference_C, ConfigError::reference_C, {-51, 201},
                                  {-50, 200});

  using Thesis = tp::ThesisCurrent<TestType>;
  const Thesis thesis = tp::motors::Bgm2606_90t::current_law<TestType>();
  field_is_named<Thesis, TestType>(thesis, &Thesis::slope_V2_A_per_K, ConfigError::slope_A_per_K, {},
                                   {0, 1, -1});
  field_is_named<Thesis, TestType>(thesis, &Thesis::slope_V1_A_per_K, ConfigError::slope_A_per_K, {},
                                   {0, 1, -1});
  field_is_named<Thesis, TestType>(thesis, &Thesis::slope_V0_A_per_K, ConfigError::slope_A_per_K, {},
                                   {0, 1, -1});
  field_is_named<Thesis, TestType>(thesis, &Thesis::base_A, ConfigError::base_A, {0, -1}, {1});
  field_is_named<Thesis, TestType>(thesis, &Thesis::exponent, ConfigError::exponent,
                                   {TestType(0.9), TestType(6.1)}, {1, 6});
  field_is_named<Thesis, TestType>(thesis, &Thesis::minimum_V_rms, ConfigError::minimum_V_rms, {-1}, {0, 2});
  CHECK(tp::CurrentModel<Thesis>(thesis).validate() == ConfigError::none);
}

TEMPLATE_TEST_CASE("a wrong constant of a heating law is refused by name", "", float, double) {
  using Capacity = tp::HeatCapacityHeating<TestType>;
  field_is_named<Capacity, TestType>({18}, &Capacity::heat_capacity_J_per_K,
                                     ConfigError::heat_capacity_J_per_K, {0, -1}, {1});
  using Thesis = tp::ThesisHeating<TestType>;
  const Thesis thesis = tp::motors::Bgm2606_90t::heating_law<TestType>();
  for (const auto field : {&Thesis::slope_V1_J_per_K2, &Thesis::slope_V0_J_per_K2, &Thesis::offset_V1_J_per_K,
                           &Thesis::offset_V0_J_per_K})
    field_is_named<Thesis, TestType>(thesis, field, ConfigError::heating_J_per_K, {}, {0, 1, -1});
  field_is_named<Thesis, TestType>(thesis, &Thesis::minimum_V_rms, ConfigError::minimum_V_rms, {-1}, {0});
}

TEMPLATE_TEST_CASE("a wrong constant of a cooling law is refused by name", "", float, double) {
  using Rate = tp::RateCooling<TestType>;
  field_is_named<Rate, TestType>({TestType(0.002)}, &Rate::cooling_per_s, ConfigError::cooling_per_s, {0, -1},
                                 {1});
  using Newton = tp::NewtonCooling<TestType>;
  field_is_named<Newton, TestType>({TestType(0.05)}, &Newton::conductance_W_per_K,
                                   ConfigError::conductance_W_per_K, {0, -1}, {1});

  using Convection = tp::NaturalConvection<TestType>;
  const auto convection = samples::Sample<Convection>::law();
  field_is_named<Convection, TestType>(convection, &Convection::conductance_W_per_K,
                                       ConfigError::conductance_W_per_K, {0}, {1});
  field_is_named<Convection, TestType>(convection, &Convection::exponent, ConfigError::exponent,
                                       {TestType(-0.1), TestType(1.1)}, {0, 1});
  field_is_named<Convection, TestType>(convection, &Convection::reference_K, ConfigError::reference_K,
                                       {0, -1}, {1});

  using Radiation = tp::RadiationCooling<TestType>;
  const auto radiation = samples::Sample<Radiation>::law();
  field_is_named<Radiation, TestType>(radiation, &Radiation::radiating_area_m2,
                                      ConfigError::radiating_area_m2, {0, -1}, {1});
  field_is_named<Radiation, TestType>(radiation, &Radiation::emissivity, ConfigError::emissivity,
                                      {TestType(-0.1), TestType(1.1)}, {0, 1});

  using Airflow = tp::ForcedAirflow<TestType>;
  const auto airflow = samples::Sample<Airflow>::law();
  field_is_named<Airflow, TestType>(airflow, &Airflow::conductance_W_per_K, ConfigError::conductance_W_per_K,
                                    {0, -1}, {1});
  field_is_named<Airflow, TestType>(airflow, &Airflow::airflow_gain, ConfigError::airflow_gain, {-1}, {0, 5});
  field_is_named<Airflow, TestType>(airflow, &Airflow::exponent, ConfigError::exponent,
                                    {TestType(0.1), TestType(1.1)}, {1});
}

TEST_CASE("of a sum and of a model the first wrong part is named") {
  auto sum = samples::Sample<samples::Sum>::law();
  sum.second.emissivity = 2.0;
  CHECK(sum.validate() == ConfigError::emissivity);
  sum.first.exponent = 2.0;
  CHECK(sum.validate() == ConfigError::exponent);

  using Model = tp::ThermalModel<tp::HeatCapacityHeating<double>, samples::Sum, tp::LinearizedStep>;
  Model::Config config = {{18.0}, sum};
  CHECK(Model(config, 25.0).validate() == ConfigError::exponent);
  config.heating.heat_capacity_J_per_K = 0.0;
  CHECK(Model(config, 25.0).validate() == ConfigError::heat_capacity_J_per_K);
}

TEST_CASE("a wrong constant of the two-node model is refused by name") {
  using Config = tp::TwoNodeThermalModel<float>::Config;
  const Config good = {2.0f, 16.0f, 0.4f, {0.06f}};
  field_is_named<Config, float>(good, &Config::winding_heat_capacity_J_per_K,
                                ConfigError::winding_heat_capacity_J_per_K, {0, -1}, {1});
  field_is_named<Config, float>(good, &Config::body_heat_capacity_J_per_K,
                                ConfigError::body_heat_capacity_J_per_K, {0, -1}, {1});
  field_is_named<Config, float>(good, &Config::coupling_W_per_K, ConfigError::coupling_W_per_K, {0, -1}, {1});
  Config config = good;
  config.cooling.conductance_W_per_K = 0.0f;
  CHECK(config.validate() == ConfigError::conductance_W_per_K);
  CHECK(tp::TwoNodeThermalModel<float>(config, 25.0f).validate() == ConfigError::conductance_W_per_K);
}

TEMPLATE_TEST_CASE("every motor's constants are in their ranges", "", tp::motors::Bgm2606_90t,
                   tp::motors::Bgm2606_90t::AsProgrammed, tp::motors::Bgm2606_90t::AsPrinted,
                   tp::motors::Bgm5208_200_12, tp::motors::Bgm5208_200_12::AsProgrammed,
                   tp::motors::Bgm5208_200_12::AsPrinted) {
  CHECK(TestType::current().validate() == ConfigError::none);
  CHECK(TestType::thermal().validate() == ConfigError::none);
}

TEST_CASE("the first of two errors is the one reported") {
  CHECK(tp::first_error(ConfigError::base_A, ConfigError::exponent) == ConfigError::base_A);
  CHECK(tp::first_error(ConfigError::none, ConfigError::exponent) == ConfigError::exponent);
  CHECK_FALSE(tp::is_error(tp::first_error(ConfigError::none, ConfigError::none)));
}
