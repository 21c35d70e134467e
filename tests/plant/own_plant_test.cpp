// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/function_plant.hpp>
#include <thermopower/plant/state_plant.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

/// A plant that the library has never heard of, with physics that stands here alone: what is diagnosed on it,
/// no stage can have stated.

namespace {

using namespace thermopower;

/// A mass on a spring with a damper, pushed by a force; its position is measured, its speed is not.
struct Carriage {
  static plant::PlantInfo info() {
    plant::PlantInfo info;
    info.type = "carriage";
    info.constants = {{"carriage", "mass_kg", "kg", 2.0},
                      {"spring", "stiffness_N_per_m", "N/m", 8.0},
                      {"damper", "damping_Ns_per_m", "N s/m", 1.0}};
    info.inputs = {{"force_N", "N"}};
    info.states = {{"position", "m", 0, 0.0, 0.5}, {"speed", "m/s", -1, 0.0, 0.5}};
    info.signals = {{"position_m", "m", "spring.force"}};
    return info;
  }
  template <class Scalar>
  struct Terms {
    Scalar position_m, speed_mps;
    Scalar force_N;
  };
  template <class Scalar, class Effects>
  static void flow(const Scalar* constants, const Scalar* states, const Scalar* inputs,
                   const Effects& effects, Scalar* rates) {
    Terms<Scalar> terms{states[0], states[1], inputs[0]};
    terms.force_N -= constants[1] * states[0] + constants[2] * states[1];
    effects(terms);
    rates[0] = states[1];
    rates[1] = terms.force_N / constants[0];
  }
  template <class Scalar, class Effects>
  static void read(const Scalar*, const Scalar* states, const Scalar*, const Effects&, Scalar* signals) {
    signals[0] = states[0];
  }
};

plant::EffectInfo effect(const char* id, const char* submodel, const char* name, double upper,
                         std::initializer_list<double> starts) {
  return {id,
          plant::SubmodelName(submodel),
          "see the test",
          "See the test.",
          {plant::parameter(0, name).within(0.0, upper).starts(starts)},
          {},
          "push it far"};
}

/// The spring hardens with its length.
struct Hardening {
  static plant::EffectInfo info() {
    return effect("hardening", "spring.force", "N_per_m3", 1e4, {1.0, 30.0});
  }
  template <class Scalar>
  static void act(const Scalar* p, Carriage::Terms<Scalar>& terms) {
    terms.force_N -= p[0] * terms.position_m * terms.position_m * terms.position_m;
  }
};

/// Air drag.
struct Drag {
  static plant::EffectInfo info() { return effect("drag", "damper.force", "Ns2_per_m2", 1e3, {0.1, 3.0}); }
  template <class Scalar>
  static void act(const Scalar* p, Carriage::Terms<Scalar>& terms) {
    terms.force_N -= p[0] * terms.speed_mps * plant::magnitude(terms.speed_mps);
  }
};

/// The same as a simulator of somebody else: semi-implicit Euler in steps of a millisecond.
/// @param grain  its answers are rounded to this, as those of a program that prints them are
plant::SimulatorAnswer carriage(const plant::SimulatorCall& call, double grain) {
  plant::SimulatorAnswer answer;
  answer.signals.resize(call.t_s.size(), 1);
  double x = call.start[0], v = call.start[1];
  for (Eigen::Index row = 0; row < call.t_s.size(); ++row) {
    answer.signals(row, 0) = grain > 0.0 ? grain * std::round(x / grain) : x;
    if (row + 1 == call.t_s.size()) break;
    const double lasts_s = call.t_s[row + 1] - call.t_s[row];
    const int steps = static_cast<int>(std::ceil(lasts_s / 1e-3));
    for (int i = 0; i < steps; ++i) {
      const double force_N = call.inputs(row, 0) - call.constants[1] * x - call.constants[2] * v -
                             call.effect(0, 0, 0.0) * x * x * x - call.effect(1, 0, 0.0) * v * std::abs(v);
      v += lasts_s / steps * force_N / call.constants[0];
      x += lasts_s / steps * v;
    }
  }
  answer.end = {x, v};
  return answer;
}

gap::Model carriage_model() { return plant::adapt<Carriage, Hardening, Drag>("carriage"); }

gap::Model black_box(double grain) {
  return plant::adapt_function("carriage", Carriage::info(), {Hardening::info(), Drag::info()},
                               [grain](const plant::SimulatorCall& call) { return carriage(call, grain); });
}

double noise(std::uint64_t& state) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    sum += static_cast<double>(state >> 11) / 9007199254740992.0;
  }
  return sum;
}

/// Forty seconds of pushes of changing size; what happens is told by `carriage`, not by the plant under test.
gap::Recording recorded(double hardening, double drag, std::uint64_t seed) {
  const Eigen::Index rows = 800;
  gap::Recording recording;
  recording.name = "carriage";
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 0.05 * static_cast<double>(rows - 1));
  Eigen::VectorXd force(rows);
  double push = 0.0;
  std::uint64_t dice = seed;
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (row % 37 == 0) push = 3.0 * noise(dice);
    force[row] = push;
  }
  recording.set("force_N", force);
  plant::SimulatorCall call;
  call.constants = {2.0, 8.0, 1.0};
  call.start = {0.0, 0.0};
  call.t_s = recording.t_s;
  call.inputs = force;
  call.effects = {{hardening}, {drag}};
  Eigen::VectorXd position = carriage(call, 0.0).signals.col(0);
  for (double& value : position) value += 0.002 * noise(seed);
  recording.set("position_m", position);
  return recording;
}

/// Position of the undriven carriage without effects, released at rest from 0.3 m: damped oscillation.
double released(double stiffness, double t_s) {
  const double decay = 1.0 / (2.0 * 2.0), natural = std::sqrt(stiffness / 2.0);
  const double turning = std::sqrt(natural * natural - decay * decay);
  return 0.3 * std::exp(-decay * t_s) * (std::cos(turning * t_s) + decay / turning * std::sin(turning * t_s));
}

/// Readings of the released carriage over five seconds, with the derivative by the stiffness' factor.
plant::Readings rolled(const gap::Model& model, plant::Inputs& inputs) {
  const Eigen::Index rows = 101;
  inputs.own = true;
  inputs.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 5.0);
  inputs.runs = {{0, rows, ""}};
  inputs.own_inputs = {Eigen::VectorXd::Zero(rows)};
  inputs.measured[0] = Eigen::VectorXd::Constant(rows, 0.3);
  plant::ParameterPoint point;
  point.factors = {1.0, 1.0, 1.0};
  const plant::Plant& plant = plant::plant_of(model);
  const auto rollout =
      plant.rollout(model, *plant.effects(), point, {1, 1}, plant::SimulationMode::free_running);
  plant::Readings readings;
  rollout->roll({&inputs, inputs.runs[0], 0, rows, false, false, false}, plant::Start::Zero(2), readings);
  return readings;
}

/// A segment that carries on rolls as it did, whatever was rolled of it in between.
void check_rolled_again(const gap::Model& model) {
  plant::Inputs inputs;
  rolled(model, inputs);
  const plant::Plant& plant = plant::plant_of(model);
  const auto rollout = plant.rollout(model, *plant.effects(), {}, {}, plant::SimulationMode::free_running);
  const plant::Segment first{&inputs, inputs.runs[0], 0, 50, true, false, false},
      second{&inputs, inputs.runs[0], 50, 101, true, true, false};
  plant::Start pushed = plant::Start::Zero(2);
  pushed[1] = 0.1;
  plant::Readings once, moved, again;
  rollout->roll(first, plant::Start::Zero(2), once);
  rollout->roll(second, plant::Start::Zero(2), once);
  rollout->roll(second, pushed, moved);
  rollout->roll(second, plant::Start::Zero(2), again);
  CHECK(once.value(100, 0) == again.value(100, 0));
  CHECK(once.value(100, 0) != moved.value(100, 0));
}

void check_named(const gap::Model& model) {
  const gap::Diagnosis diagnosis = gap::diagnose(model, {recorded(12.0, 0.0, 1)}, {recorded(12.0, 0.0, 7)});
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.verdict == gap::Verdict::explained);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause[0].effect == "hardening");
  REQUIRE(diagnosis.cause[0].parameters.size() == 1);
  CHECK(diagnosis.cause[0].parameters[0].value == Approx(12.0).epsilon(0.05));
  REQUIRE(!diagnosis.where.empty());
  CHECK(to_string(diagnosis.where[0].submodel) == "spring.force");
  CHECK(to_string(diagnosis.where[0].signal) == "position_m");
  REQUIRE(!diagnosis.missing_quantities.empty());
  const gap::MissingQuantity& picture = diagnosis.missing_quantities[0];
  CHECK(picture.unit == "m/s");
  // What hardening supplies is drawn, and is what lacks: on the mean over the places nearest to each measured point.
  REQUIRE(picture.effect.size() == picture.effect_x.size());
  REQUIRE(picture.effect.size() > 100);
  Eigen::VectorXd supplied = Eigen::VectorXd::Zero(picture.x.size()), places = supplied;
  for (Eigen::Index i = 0; i < picture.effect_x.size(); ++i) {
    Eigen::Index nearest = 0;
    (picture.x.array() - picture.effect_x[i]).abs().minCoeff(&nearest);
    supplied[nearest] += picture.effect[i];
    places[nearest] += 1.0;
  }
  REQUIRE(places.minCoeff() > 0.0);
  CHECK((supplied.cwiseQuotient(places) - picture.value).norm() < 0.5 * picture.value.norm());
  REQUIRE(diagnosis.gap.size() == 1);
  CHECK(diagnosis.gap[0].unit == "m");
  CHECK(diagnosis.gap[0].after < 1.2 * diagnosis.gap[0].noise_floor);
  CHECK(diagnosis.gap[0].before > 3.0 * diagnosis.gap[0].after);
  CHECK(diagnosis.augmented.effects.count("hardening") == 1);
  CHECK(gap::simulate(diagnosis.augmented, recorded(0.0, 0.0, 1)).size() == 1);
}

}  // namespace

TEST_CASE("a plant of one's own rolls as its equations solve, with the derivative that they have") {
  plant::Inputs inputs;
  const plant::Readings readings = rolled(carriage_model(), inputs);
  for (Eigen::Index row = 0; row < inputs.rows(); ++row) {
    CHECK(readings.value(row, 0) == Approx(released(8.0, inputs.t_s[row])).margin(1e-4));
    const double slope = (released(8.008, inputs.t_s[row]) - released(7.992, inputs.t_s[row])) / 0.002;
    CHECK(readings.slope(row, 0, 0) == Approx(slope).margin(2e-3));
  }
}

TEST_CASE("a simulator behind a function call gets its derivatives by sound differences, rounded or not") {
  for (const double grain : {0.0, 1e-7, 1e-5}) {
    plant::Inputs inputs;
    const plant::Readings readings = rolled(black_box(grain), inputs);
    double off = 0.0, size = 0.0;
    for (Eigen::Index row = 0; row < inputs.rows(); ++row) {
      const double slope = (released(8.008, inputs.t_s[row]) - released(7.992, inputs.t_s[row])) / 0.002;
      off += std::pow(readings.slope(row, 0, 0) - slope, 2);
      size += slope * slope;
    }
    INFO("rounded to " << grain);
    CHECK(std::sqrt(off / size) < 0.02);
  }
}

TEST_CASE("a segment that is rolled again starts with what was carried into it the first time") {
  check_rolled_again(carriage_model());
  check_rolled_again(black_box(0.0));
}

TEST_CASE("a plant of one's own is diagnosed with an effect of its own") { check_named(carriage_model()); }

TEST_CASE("a simulator behind a function call is diagnosed with an effect of its own") {
  check_named(black_box(1e-7));
}

TEST_CASE("a plant of one's own that holds has no gap") {
  for (const gap::Model& model : {carriage_model(), black_box(0.0)}) {
    const gap::Diagnosis diagnosis = gap::diagnose(model, {recorded(0.0, 0.0, 1)}, {recorded(0.0, 0.0, 7)});
    CHECK(diagnosis.verdict == gap::Verdict::no_gap);
    CHECK(diagnosis.where.empty());
  }
}

TEST_CASE("what a plant of one's own lacks is said by name") {
  gap::Recording blind = recorded(0.0, 0.0, 1);
  blind.remove("force_N");
  const gap::Diagnosis diagnosis = gap::diagnose(carriage_model(), {blind});
  CHECK(diagnosis.verdict == gap::Verdict::insufficient);
  REQUIRE(!diagnosis.not_judged.empty());
  CHECK(diagnosis.not_judged[0] == "nothing is judged: the recording has no column force_N");

  gap::Model haunted = carriage_model();
  haunted.effects["ghost"] = {};
  CHECK_THROWS_WITH(gap::simulate(haunted, recorded(0.0, 0.0, 1)),
                    ContainsSubstring("plant 'carriage' has no effect 'ghost'"));
  gap::Model weightless = carriage_model();
  weightless.set("mass_kg", 0.0);
  CHECK_THROWS_WITH(gap::diagnose(weightless, {recorded(0.0, 0.0, 1)}),
                    ContainsSubstring("carriage.mass_kg"));

  plant::PlantInfo nameless = Carriage::info();
  nameless.signals.clear();
  CHECK_THROWS_WITH(
      plant::adapt_function("x", nameless, {},
                            [](const plant::SimulatorCall&) { return plant::SimulatorAnswer(); }),
      ContainsSubstring("has 0 signals, expected 1 to"));
  CHECK_THROWS_WITH(plant::adapt_function("x", Carriage::info(), {}, nullptr),
                    ContainsSubstring("expected a function"));
  const gap::Model silent = plant::adapt_function(
      "x", Carriage::info(), {}, [](const plant::SimulatorCall&) { return plant::SimulatorAnswer(); });
  CHECK_THROWS_WITH(gap::simulate(silent, recorded(0.0, 0.0, 1)),
                    ContainsSubstring("its simulator answered 0 rows"));
}
