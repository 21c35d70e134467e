// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Printers whose log has target and temperature, and not the power that the loop set. Loop and body are stepped apart from the
// library (../plant/printer_loops.hpp), with noise in the reading that the loop and the log take.
#include "../catch.hpp"
#include "../plant/printer_loops.hpp"
#include "plants.hpp"

#include <thermopower/gap/diagnose.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace thermopower::gap;

namespace {

Recording record(const printer::Body& body, const printer::Settings& set,
                 const std::vector<double>& targets_C, unsigned seed) {
  const printer::Log log = printer::heated(body, set, targets_C, 2.0 * body.J_per_K, 0.05, seed);
  const auto vector_of = [](const std::vector<double>& values) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  Recording r;
  r.name = "printer";
  r.t_s = vector_of(log.t_s);
  r.set("target_C", vector_of(log.target_C));
  r.set("motor_C", vector_of(log.shown_C).unaryExpr([](double x) { return std::round(10.0 * x) / 10.0; }));
  r.set("ambient_C", Eigen::VectorXd::Constant(r.rows(), body.air_C));
  return r;
}

/// The body that bed() describes but for a per cent: a small one, or as heavy as one that a log by the second follows when it goes on and off.
printer::Body bed_of(const printer::Settings& set) {
  printer::Body body;
  if (set.loop != printer::Loop::bang_bang) return body;
  body.J_per_K = 600.0;
  body.W_per_K = 1.2;
  return body;
}

Model bed(const printer::Settings& set) {
  Model model;
  model.name = "bed";
  model.supply = SupplyModel{24.0};
  model.current = OhmicCurrentModel{2.88, 0.0, 25.0};
  const printer::Body body = bed_of(set);
  model.thermal = LumpedThermalModel{1.01 * body.J_per_K, 0.99 * body.W_per_K};
  if (set.loop == printer::Loop::klipper) model.heater = KlipperPidHeater{set.p, set.i, set.d};
  else if (set.loop == printer::Loop::marlin)
    model.heater = MarlinPidHeater{set.p, set.i, set.d, 1.0, 10.0, set.every_s};
  else model.heater = BangBangHeater{set.band_K, 1.0, set.every_s};
  return model;
}

Diagnosis diagnosed(const Model& model, const printer::Body& body, const printer::Settings& set,
                    const std::vector<std::string>& without = {}) {
  Options options;
  options.effects_at_once = 1;
  options.without = without;
  return diagnose(model, {record(body, set, {60, 100, 0, 80, 110, 40, 90}, 2)},
                  {record(body, set, {70, 0, 105, 50, 95}, 3)}, options);
}

std::vector<printer::Settings> loops() {
  printer::Settings klipper, marlin, bang;
  marlin.loop = printer::Loop::marlin;
  marlin.every_s = 0.2;
  bang.loop = printer::Loop::bang_bang;
  return {klipper, marlin, bang};
}

TEST_CASE("a bed without a column of its power: what is hidden behind the loop is named") {
  for (const printer::Settings& set : loops()) {
    CAPTURE(static_cast<int>(set.loop));
    printer::Body late = bed_of(set), weak = late, warm = late;
    late.lag_s = set.loop == printer::Loop::bang_bang ? 12.0 : 5.0;
    weak.ohm *= 1.4;
    warm.per_K = 0.004;
    const auto names = [&](const printer::Body& body, const std::string& cause) {
      CAPTURE(cause);
      const Diagnosis found = diagnosed(bed(set), body, set);
      INFO(to_string(found.verdict) << ": " << found.reason);
      REQUIRE(found.cause.size() == 1);
      CHECK(found.cause.front().effect == cause);
      return found.cause.front().parameters.front().value;
    };
    CHECK(names(late, "thermometer_lag") == Approx(late.lag_s).epsilon(0.15));
    const double per_K = names(warm, "winding_tempco");
    const Diagnosis sound = diagnosed(bed(set), bed_of(set), set);
    INFO(to_string(sound.verdict) << ": " << sound.reason);
    if (set.loop == printer::Loop::bang_bang) {
      // Noise switches it, and the log does not have the readings that did: the duty errs by a per cent, and a rest stays.
      CHECK(sound.cause.empty());
      continue;
    }
    CHECK(per_K == Approx(0.004).epsilon(0.1));
    CHECK(test::holds(sound));
    // A weak heater and a thermometer that shows too little: no log of temperature and duty tells these apart. One looks at the
    // thermometer by hand, and leaves it out (docs/how-to/printer-heater.md).
    const Diagnosis tired = diagnosed(bed(set), weak, set, {"thermometer_gain"});
    INFO(to_string(tired.verdict) << ": " << tired.reason);
    const std::vector<std::string> said = test::causes_of(tired);
    CHECK(std::find(said.begin(), said.end(), "calibration.resistance") != said.end());
  }
}

TEST_CASE("a loop may act on the temperature that is recorded, or on the one that is simulated") {
  const printer::Settings set;
  printer::Body late = bed_of(set);
  late.lag_s = 5.0;
  for (const HeaterActsOn on : {HeaterActsOn::recorded, HeaterActsOn::simulated}) {
    CAPTURE(static_cast<int>(on));
    Model model = bed(set);
    model.heater_acts_on = on;
    const Diagnosis found = diagnosed(model, late, set);
    INFO(to_string(found.verdict) << ": " << found.reason);
    REQUIRE(found.cause.size() == 1);
    CHECK(found.cause.front().effect == "thermometer_lag");
    CHECK(found.cause.front().parameters.front().value == Approx(5.0).epsilon(0.1));
  }
}

}  // namespace
