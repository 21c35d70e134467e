// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What the compiler mostly evaluates, at run time: which law is linear, which goes with which, what a motor's constants are.

#include "../catch.hpp"

#include <cmath>
#include <string>

#include <thermopower/thermopower.hpp>

using namespace thermopower;

namespace {

/// Twice the distance from the air gives twice the loss, and only of a linear law.
template <class Cooling>
bool loses_in_proportion(const Cooling& law) {
  const Surroundings<> around = {20.0f, 3.0f};
  const float near = law.rate_K_per_s(40.0f, around, 0.1f), far = law.rate_K_per_s(60.0f, around, 0.1f);
  return std::abs(far - 2.0f * near) < 1e-5f * far;
}
/// A law in watts is divided by the heat capacity, a rate is not.
template <class Cooling>
bool is_divided(const Cooling& law) {
  const Surroundings<> around = {20.0f, 3.0f};
  return law.rate_K_per_s(40.0f, around, 0.2f) > 1.5f * law.rate_K_per_s(40.0f, around, 0.1f);
}
template <class Cooling>
void check_law(const Cooling& law) {
  CHECK(Cooling::is_linear() == loses_in_proportion(law));
  CHECK(Cooling::is_in_watts() == is_divided(law));
}
/// A heat capacity is there at any voltage and any temperature; r of a linear law is one number.
template <class Heating>
void check_heating(const Heating& law) {
  const float r = law.rise_K_per_J(8.0f, 40.0f);
  CHECK(Heating::is_linear() == (std::abs(law.rise_K_per_J(8.0f, 60.0f) - r) < 1e-6f * r));
  CHECK(Heating::is_heat_capacity() == (law.rise_K_per_J(0.0f, 40.0f) > 0.0f));
}

}  // namespace

TEST_CASE(
    "a law says of itself what it is: linear when its loss is in proportion, in watts when a capacity divides it") {
  const NewtonCooling<> newton = {0.05f};
  const NaturalConvection<> convection = {0.05f, 0.25f, 40.0f};
  const RadiationCooling<> radiation = {0.004f, 0.9f};
  const ForcedAirflow<> airflow = {0.05f, 0.8f, 0.6f};
  check_law(newton);
  check_law(RateCooling<>::per_minute(0.11f));
  check_law(convection);
  check_law(radiation);
  check_law(airflow);
  check_law(SumOfCooling<NewtonCooling<>, ForcedAirflow<>>{newton, airflow});
  check_law(SumOfCooling<NewtonCooling<>, NaturalConvection<>>{newton, convection});
  check_law(SumOfCooling<RadiationCooling<>, NewtonCooling<>>{radiation, newton});
  check_heating(HeatCapacityHeating<>{18.0f});
  check_heating(motors::Bgm2606_90t::heating_law());
}

TEST_CASE(
    "the step that is exact asks for linear laws, as it is not for others; the two that are not take any") {
  CHECK(ExactStep::needs_linear_laws());
  CHECK_FALSE(EulerStep::needs_linear_laws());
  CHECK_FALSE(LinearizedStep::needs_linear_laws());
}

TEST_CASE("the source of a current table is the law itself: intercept and slope make the current") {
  typedef ThesisCurrentSource<motors::Bgm2606_90t> Source;
  const ThesisCurrent<double> law = motors::Bgm2606_90t::current_law<double>();
  for (double volt = 2.0; volt <= Source::maximum_V_rms(); volt += 0.5)
    CHECK(Source::intercept_A(volt) + Source::slope_A_per_K(volt) * 40.0 ==
          Approx(law.current_A(volt, 40.0)));
  CHECK(law.current_A(Source::minimum_V_rms(), 40.0) == 0.0);
  typedef detail::CurrentNodes<Source, 65, detail::MakeIndices<65>::Type> Nodes;
  CHECK(Nodes::volt(0) == 0.0);
  CHECK(Nodes::volt(64) == Source::maximum_V_rms());
}

TEST_CASE("eq 4.18 as printed multiplies the voltage, and the program the temperature") {
  typedef motors::Bgm5208_200_12 Motor;
  // In W min/K: 0.2435 V - 0.4952, and 0.2435 T - 0.4952.
  for (const double volt : {6.0, 9.0}) {
    CHECK(Motor::AsPrinted::heating_law<double>().apparent_capacity_J_per_K(volt, 40.0) ==
          Approx(60.0 * (0.2435 * volt - 0.4952)));
    CHECK(Motor::AsProgrammed::heating_law<double>().apparent_capacity_J_per_K(volt, 40.0) ==
          Approx(60.0 * (0.2435 * 40.0 - 0.4952)));
  }
}

TEST_CASE("the standard journal fits an AVR's EEPROM and lasts for years of a change in every interval") {
  CHECK(StandardJournal::start() + 3 * StandardJournal::slots() <= 1024);
  const double years =
      100000.0 * StandardJournal::slots() * StandardJournal::interval_s() / (365.25 * 86400.0);
  CHECK(years > 2.5);
  CHECK(StandardJournal::change_K() >= 1);
}

TEST_CASE("the version of the headers is that of the project") {
  CHECK(std::to_string(Version::major_number()) + "." + std::to_string(Version::minor_number()) + "." +
            std::to_string(Version::patch_number()) ==
        THERMOPOWER_PROJECT_VERSION);
}

TEST_CASE("a magnitude has no sign, also in double precision") {
  CHECK(detail::magnitude(-2.5) == 2.5);
  CHECK(detail::magnitude(2.5) == 2.5);
  CHECK(std::isnan(detail::magnitude(std::nan(""))));
}
