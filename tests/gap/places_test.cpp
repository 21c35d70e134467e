// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "plants.hpp"

#include <thermopower/gap/check_data.hpp>
#include <thermopower/gap/diagnose.hpp>
#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/plant/axis_at_rows.hpp>

// Pendulums whose model file has the angle at which they hang: a place, known to some degrees, whatever its value. They are
// stepped here, in steps of a two hundredth of a row, and rest where friction holds them.

using namespace thermopower::gap;
namespace plant = thermopower::plant;

namespace {

constexpr double inertia_kgm2 = 0.012, viscous = 0.02, torque_constant = 0.3, weight_Nm = 0.45;

struct Pendulum {
  double hangs_rad = 0.0;   ///< at minus this
  double coulomb_Nm = 0.0;  ///< dry friction
};

Recording record(const Pendulum& pendulum, int rows, std::uint64_t seed) {
  test::Noise noise(seed);
  Recording r;
  r.name = "pendulum";
  r.t_s.resize(rows);
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  double theta = 0.0, omega = 0.0;
  constexpr double deg = 57.29577951308232;
  for (int i = 0; i < rows; ++i) {
    const double t = 0.01 * i + 3.0 * static_cast<double>(seed);
    r.t_s[i] = 0.01 * i;
    drive[i] = 0.8 * std::sin(1.9 * t) + 0.6 * std::sin(4.3 * t + 1.0) + 0.4 * std::sin(8.7 * t);
    angle[i] = theta * deg + 0.03 * noise();
    rate[i] = omega * deg + 0.3 * noise();
    for (int k = 0; k < 200; ++k) {
      constexpr double h = 5e-5;
      const double push =
          torque_constant * drive[i] - viscous * omega - weight_Nm * std::sin(theta + pendulum.hangs_rad);
      const double next = omega + h * push / inertia_kgm2, brake = h * pendulum.coulomb_Nm / inertia_kgm2;
      omega = next > brake ? next - brake : next < -brake ? next + brake : 0.0;
      theta += h * omega;
    }
  }
  r.set("drive_A", drive);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  return r;
}

/// Its simulation. @param off  factor on inertia and torque constant, within what is known of them
Model simulation(double hangs_rad, double off = 1.03) {
  Model model;
  model.name = "pendulum";
  model.axis = RigidAxisModel{inertia_kgm2 * off, viscous * 0.96, torque_constant / off};
  model.effects["imbalance"] = {{"Nm", weight_Nm}, {"phase_rad", hangs_rad}};
  return model;
}

Diagnosis diagnosis_of(const Pendulum& pendulum, const Model& model) {
  return diagnose(model, {record(pendulum, 3000, 1)}, {record(pendulum, 2000, 2)});
}

}  // namespace

TEST_CASE("an angle that is off by less than is known of angles is no gap, whatever the file has for it") {
  // A share of 0.003 rad is nothing that anybody knows, and no factor leads from it through 0, or from 0 away.
  CHECK(test::holds(diagnosis_of({}, simulation(0.003))));
  CHECK(test::holds(diagnosis_of({-0.03}, simulation(0.003))));
  CHECK(test::holds(diagnosis_of({0.03}, simulation(0.0))));
}

TEST_CASE("a cause is named beside an angle that is off, and not hidden by it") {
  for (const double hangs_rad : {0.0, -0.04}) {
    const Diagnosis diagnosis = diagnosis_of({hangs_rad, 0.03}, simulation(0.003));
    REQUIRE(diagnosis.verdict == Verdict::explained);
    REQUIRE(diagnosis.cause.size() == 1);
    CHECK(diagnosis.cause.front().effect == "coulomb_friction");
    CHECK(std::abs(test::parameter_of(diagnosis, "Nm") - 0.03) < 0.002);  // some standard errors of such data
  }
}

TEST_CASE("an angle that is far off is a cause, with the difference that it is off by") {
  const Diagnosis diagnosis = diagnosis_of({0.35}, simulation(0.0));
  REQUIRE(diagnosis.verdict == Verdict::explained);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "calibration.imbalance.phase_rad");
  REQUIRE(diagnosis.cause.front().parameters.size() == 1);
  CHECK(diagnosis.cause.front().parameters.front().unit == "rad");
  CHECK(std::abs(test::parameter_of(diagnosis, "shift") - 0.35) < 0.01);
  REQUIRE(test::moved(diagnosis).size() == 1);
  CHECK(test::moved(diagnosis).front().is_place);
  CHECK(test::moved(diagnosis).front().configured == 0.0);
  CHECK(std::abs(test::moved(diagnosis).front().fitted - 0.35) < 0.01);
}

TEST_CASE("what data tell of an angle is told in radians, and does not go with its value") {
  const std::vector<Recording> data = {record({}, 3000, 1)};
  const auto known = [&](double hangs_rad) {
    for (const ConstantReport& one : check_data(simulation(hangs_rad, 1.0), data, {}).constants)
      if (one.constant == "imbalance.phase_rad") {
        CHECK(one.is_place);
        return one.alone;
      }
    return 0.0;
  };
  const double at_zero = known(0.0), beside = known(0.003);
  CHECK(at_zero > 0.0);
  CHECK(std::abs(beside / at_zero - 1.0) < 0.1);
}

TEST_CASE("a balance moves a place by a difference: a load is felt as its torque turns with the angle") {
  constexpr double hangs_rad = 0.3;
  const Model model = simulation(hangs_rad);
  const plant::Inputs inputs = engine::prepare(model, record({hangs_rad, 0.0}, 400, 2));
  const plant::AxisAtRows axis(model, plant::standard_catalogue(), inputs, plant::ReadingOffsets());
  const std::vector<CalibratedConstant> constants = model.calibrated();
  int places = 0;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (!constants[k].is_place) continue;
    ++places;
    const plant::AxisAtRows::Values by = axis.slopes(k);
    for (Eigen::Index i = 0; i < inputs.rows(); ++i)
      CHECK(by.motion_Nm[i] == Approx(-weight_Nm * std::cos(axis.angle[i] + hangs_rad)).margin(1e-6));
  }
  CHECK(places == 1);
  // A balance of the bench's kind asks Model::moved(), too: the others stay where they are.
  const std::size_t weight = 3;
  REQUIRE(constants[weight].id == "imbalance.Nm");
  const std::vector<double> moved = model.moved(weight, std::log(1.1));
  REQUIRE(moved.size() == constants.size());
  for (std::size_t k = 0; k < moved.size(); ++k)
    CHECK(moved[k] == Approx(k == weight ? 1.1 : constants[k].is_place ? 0.0 : 1.0));
}
