// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// The loop of a heater inside the plant, against loops and a body that are stepped apart from the library (printer_loops.hpp).

#include "../catch.hpp"
#include "printer_loops.hpp"

#include <thermopower/gap/observe/heater_duty.hpp>
#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/actuator_plant.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace thermopower::gap;
namespace plant = thermopower::plant;

namespace {

plant::HeaterLaw law_of(const printer::Settings& set) {
  if (set.loop == printer::Loop::klipper)
    return plant::KlipperPidHeater{set.p, set.i, set.d, set.most, set.smooth_s, set.every_s};
  if (set.loop == printer::Loop::marlin)
    return plant::MarlinPidHeater{set.p, set.i, set.d, set.most, set.range_K, set.every_s};
  return plant::BangBangHeater{set.band_K, set.most, set.every_s};
}

Model model_of(const printer::Body& body, const printer::Settings& set) {
  Model model;
  model.name = "bed";
  model.supply = SupplyModel{body.supply_V};
  model.current = OhmicCurrentModel{body.ohm, body.per_K, 25.0};
  model.thermal = LumpedThermalModel{body.J_per_K, body.W_per_K};
  model.heater = law_of(set);
  if (body.lag_s > 0.0) model.effects["thermometer_lag"] = {{"lag_s", body.lag_s}};
  if (body.fan_gain > 0.0) model.effects["forced_airflow"] = {{"gain", body.fan_gain}, {"exponent", 1.0}};
  return model;
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// @param measured  the whole temperature is recorded; else its first row alone
Recording recording_of(const printer::Log& log, const printer::Body& body, bool measured) {
  Recording r;
  r.name = "printer";
  r.t_s = vector_of(log.t_s);
  r.set("target_C", vector_of(log.target_C));
  r.set("ambient_C", Eigen::VectorXd::Constant(r.rows(), body.air_C));
  r.set("airspeed_mps", vector_of(log.airspeed_mps));
  Eigen::VectorXd shown = vector_of(log.shown_C);
  if (!measured) shown.tail(r.rows() - 1).setConstant(plant::missing);
  r.set("motor_C", shown);
  return r;
}

const Eigen::VectorXd& signal(const std::vector<SimulatedSignal>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const SimulatedSignal& one) { return to_string(one.signal) == name; });
  REQUIRE(found != all.end());
  return found->values;
}

const std::vector<double> targets_C = {60.0, 100.0, 0.0, 80.0};

std::vector<printer::Settings> loops() {
  printer::Settings klipper, smooth, marlin, bang;
  smooth.smooth_s = 3.0;
  smooth.most = 0.7;
  marlin.loop = printer::Loop::marlin;
  marlin.every_s = 0.2;
  bang.loop = printer::Loop::bang_bang;
  return {klipper, smooth, marlin, bang};
}

}  // namespace

TEST_CASE("target in, temperature and duty out: as a loop and a body that are stepped apart") {
  std::vector<printer::Body> bodies(4);
  bodies[1].lag_s = 6.0;
  bodies[2].per_K = 0.004;
  bodies[3].fan_gain = 0.2;
  for (const printer::Settings& set : loops())
    for (const printer::Body& body : bodies) {
      CAPTURE(static_cast<int>(set.loop), set.smooth_s, body.lag_s, body.per_K, body.fan_gain);
      const printer::Log log = printer::heated(body, set, targets_C, 200.0, 0.0, 1, body.fan_gain > 0.0);
      const std::vector<SimulatedSignal> found =
          simulate(model_of(body, set), recording_of(log, body, false));
      // The truth's lag and PTC are Euler steps of a millisecond; where two points switch, one sample sooner or later is 0.7 K.
      const bool is_exact = set.loop != printer::Loop::bang_bang || (body.lag_s == 0.0 && body.per_K == 0.0);
      const double most_K = (signal(found, "motor_C") - vector_of(log.shown_C)).cwiseAbs().maxCoeff();
      CHECK(most_K < (is_exact ? 0.05 : 1.0));
      if (set.loop == printer::Loop::bang_bang) continue;
      // The simulated duty is that at the row, the log's the mean until the next one: they agree where it is steady.
      const double at_end = signal(found, "power_param")[log.t_s.size() / 4 - 2] / 255.0;
      CHECK(at_end == Approx(log.duty[log.duty.size() / 4 - 2]).margin(0.01));
    }
}

TEST_CASE("a loop's duty follows from target and recorded temperature, whatever is wrong with the body") {
  for (const printer::Settings& set : loops()) {
    CAPTURE(static_cast<int>(set.loop), set.smooth_s);
    printer::Body body;
    body.lag_s = 6.0;
    body.ohm = 4.0;
    const printer::Log log = printer::heated(body, set, targets_C, 200.0);
    const Model model = model_of(printer::Body(), set);  // of another body
    const Recording with_duty = with_heater_duty(model, recording_of(log, body, true));
    const Eigen::VectorXd off = with_duty.column("heater_power") / 255.0 - vector_of(log.duty);
    // Rows of a second tell when a loop switched to half its period of 0.3 s: twice in each swing of 15 s or more.
    CHECK(off.head(off.size() - 1).cwiseAbs().mean() < 0.03);
    CHECK(std::abs(off.head(off.size() - 1).mean()) < 0.02);
  }
  const printer::Log log = printer::heated({}, {}, targets_C, 200.0);
  Recording recorded = recording_of(log, {}, true);
  recorded.set("power_param", Eigen::VectorXd::Constant(recorded.rows(), 7.0));
  CHECK_FALSE(with_heater_duty(model_of({}, {}), recorded).has("heater_power"));
  Recording untold = recording_of(log, {}, true);
  untold.remove("target_C");
  CHECK_FALSE(with_heater_duty(model_of({}, {}), untold).has("heater_power"));
}

TEST_CASE("a two-point loop that noise switches is followed by where its readings turn") {
  printer::Settings set;
  set.loop = printer::Loop::bang_bang;
  printer::Body body;
  body.J_per_K = 600.0;
  body.W_per_K = 1.2;
  for (const unsigned seed : {1u, 2u, 3u}) {
    CAPTURE(seed);
    const printer::Log log = printer::heated(body, set, targets_C, 900.0, 0.05, seed);
    const Eigen::VectorXd off =
        with_heater_duty(model_of(body, set), recording_of(log, body, true)).column("heater_power") / 255.0 -
        vector_of(log.duty);
    // A missed switch would leave the duty wrong for a whole phase, a tenth of the rows and more.
    CHECK(off.head(off.size() - 1).cwiseAbs().mean() < 0.03);
  }
}

TEST_CASE("derivatives go through a loop that switches") {
  printer::Settings set;
  set.loop = printer::Loop::bang_bang;
  set.every_s = 1e-4;  // so short that a difference does not see the samples
  const printer::Body body;
  Recording recording;
  recording.name = "printer";
  recording.t_s = Eigen::VectorXd::LinSpaced(60, 0.0, 59.0);
  recording.set("target_C", Eigen::VectorXd::Constant(60, 60.0));
  recording.set("ambient_C", Eigen::VectorXd::Constant(60, 24.0));
  Eigen::VectorXd first = Eigen::VectorXd::Constant(60, plant::missing);
  first[0] = 24.0;
  recording.set("motor_C", first);
  const auto with_capacity = [&](double factor) {
    printer::Body other = body;
    other.J_per_K *= factor;
    return signal(simulate(model_of(other, set), recording), "motor_C");
  };
  constexpr double step = 2e-4;  // moves a jump by a hundredth of a second
  const Eigen::VectorXd differences = (with_capacity(1.0 + step) - with_capacity(1.0 - step)) / (2.0 * step);
  const Model model = model_of(body, set);
  const std::vector<Inputs> inputs{engine::prepare(model, recording)};
  const Plant& plant = plant_of(model);
  std::vector<Segment> segments;
  plant.cut(inputs[0], 0.0, segments);
  REQUIRE(segments.size() == 1);
  plant::ParameterPoint point;
  for (const CalibratedConstant& one : model.calibrated()) point.factors.push_back(one.unmoved());
  const auto rollout =
      plant.rollout(model, standard_catalogue(), point, {0, point.size()}, SimulationMode::free_running);
  plant::Readings readings;
  rollout->roll(segments[0], Start::Zero(plant.start_size(segments[0])), readings);
  const std::vector<CalibratedConstant> all = model.calibrated();
  int capacity = 0;
  while (all[static_cast<std::size_t>(capacity)].id != "heat_capacity") ++capacity;
  // Derivatives are single precision, and 600 000 samples add up in them. Differences are wrong in a row that a jump moves over.
  int right = 0, looked_at = 0;
  for (Eigen::Index row = 10; row < 60; ++row, ++looked_at)
    if (std::abs(readings.slope(row, 1, capacity) - differences[row]) < 0.15 * std::abs(differences[row]))
      ++right;
  CHECK(right >= looked_at - 2);
}

TEST_CASE("a heater's loop is refused where it cannot be one") {
  Model model = model_of({}, {});
  CHECK_FALSE(model.validate());
  model.set("heater.max_power", 1.5);
  CHECK(model.validate());
  model = model_of({}, {});
  model.set("heater.period_s", 0.0);
  CHECK(model.validate());
  model = model_of({}, {});
  model.current = {};
  CHECK(model.validate());
}
