// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "axis_draw.hpp"
#include "bench_draw.hpp"
#include "part.hpp"

namespace gap_benchmark {

/// What somebody does wrong who describes a motor for the first time.
enum class Beginner { one_constant, two_constants, beside_friction, not_attached, common_factor };

inline Beginner beginner_kind(int number) {
  static const Beginner kinds[] = {Beginner::one_constant, Beginner::two_constants,
                                   Beginner::one_constant, Beginner::beside_friction,
                                   Beginner::not_attached, Beginner::common_factor};
  return kinds[number % 6];
}

/// A constant of a model by its place, its id as a cause, and its place in model.json.
struct NamedPlace {
  int index;
  const char *cause, *block, *field;
};

/// Two recordings of one axis, as careful people make them.
struct AxisPair {
  AxisSetup setup;
  AxisRecording train, heldout;
};

inline AxisPair record_axis_pair(const std::vector<std::string>& effects, Random& random) {
  for (int attempt = 0; attempt < 60; ++attempt) {
    AxisPair pair;
    pair.setup = draw_axis(effects, random);
    AxisContext& c = pair.setup.context;
    AxisSession train{any_motion(random), random.pick({25.0, 30.0, 40.0}), 0.0, 1, random.bits()};
    while (train.length_s / c.dt_s > 15000.0) train.length_s *= 0.7;
    AxisSession heldout = train;
    heldout.length_s *= 0.62;
    heldout.seed = random.bits();
    measure_session(pair.setup, train, Random(random.bits()));
    pair.setup.plant = c.plant;
    for (const auto& id : effects) named(axis_effects(), id).draw(random, c, pair.setup.plant);
    pair.train = record(pair.setup, train, Random(random.bits()));
    pair.heldout = record(pair.setup, heldout, Random(random.bits()));
    double fastest = 0.0;
    for (const double rate : pair.train.truth.rate_dps) fastest = std::max(fastest, std::fabs(rate));
    if (fastest < 900.0) return pair;
  }
  throw std::runtime_error("no axis stayed in its room");
}

/// Two recordings of one motor on the bench, with its current.
struct BenchPair {
  BenchSetup setup;
  BenchRecording train, heldout;
};

inline BenchPair record_bench_pair(Random& random, bool supply_logged = true) {
  for (;;) {
    BenchPair pair;
    pair.setup = draw_bench({"calibration.resistance"}, false, random);
    BenchContext& c = pair.setup.context;
    if (c.current_is_input || !c.has_current) continue;
    if (!supply_logged) c.has_supply = false;
    const BenchSession train{
        PowerProfile::any(random), c.length_s, random.uniform(16.0, 30.0), 0.0, 0.0, 1, random.bits()};
    BenchSession heldout = train;
    heldout.kind = PowerProfile::any(random);
    heldout.length_s *= 0.6;
    heldout.seed = random.bits();
    pair.train = record(pair.setup, train, Random(random.bits()));
    pair.heldout = record(pair.setup, heldout, Random(random.bits()));
    return pair;
  }
}

/// A column that somebody forgot to connect: a level with the sensor's noise.
inline void disconnect(Recording& log, const std::string& column, double level, double noise,
                       Random& random) {
  for (auto& one : log.columns)
    if (one.name == column)
      for (double& value : one.values)
        if (!std::isnan(value)) value = level + noise * random.gauss();
}

/// One case of a beginner's gaps. @param number  of the case: which kind it is of, and of what
inline DrawnCase draw_beginner_case(int number, Random& random) {
  static const std::vector<NamedPlace> of_axis = {
      {inertia, "calibration.inertia", "axis", "inertia_kgm2"},
      {viscous, "calibration.viscous", "axis", "viscous_Nms_per_rad"},
      {torque_constant, "calibration.torque_constant", "axis", "torque_constant_Nm_per_A"}};
  static const std::vector<NamedPlace> of_bench = {
      {resistance_ohm, "calibration.resistance", "current", "resistance_ohm"},
      {heat_capacity, "calibration.heat_capacity", "thermal", "heat_capacity_J_per_K"},
      {conductance, "calibration.conductance", "thermal", "conductance_W_per_K"}};
  const Beginner kind = beginner_kind(number);
  const bool axis = kind == Beginner::beside_friction || (number / 6) % 2 == 0;
  const std::vector<NamedPlace>& places = axis ? of_axis : of_bench;
  const auto any_place = [&] { return static_cast<std::size_t>(random.integer(0, 2)); };
  DrawnCase drawn;
  PartTruth truth;
  const auto take = [&](const auto& pair, nlohmann::ordered_json model) {
    drawn.model = std::move(model);
    drawn.train = pair.train.log;
    drawn.heldout = pair.heldout.log;
  };
  const auto spoil = [&](const NamedPlace& place, double factor) {
    auto& value = drawn.model[place.block][place.field];
    value = five_digits(value.template get<double>() * factor);
    char words[80];
    std::snprintf(words, sizeof words, "%s%s x %.3g", truth.title.empty() ? "" : ", ", place.field, factor);
    truth.title += words;
    truth.causes.push_back(place.cause);
  };
  if (kind == Beginner::beside_friction) {
    const AxisPair pair = record_axis_pair({"coulomb_friction"}, random);
    take(pair, axis_model_json(pair.setup));
    truth.title = "coulomb_friction";
    truth.causes = {"coulomb_friction"};
    spoil(places[any_place()], wrong_by(random));
    truth.accept = {truth.causes};
  } else if (axis) {
    const AxisPair pair = record_axis_pair({}, random);
    take(pair, axis_model_json(pair.setup));
    if (kind == Beginner::not_attached) {
      for (Recording* log : {&drawn.train, &drawn.heldout}) {
        disconnect(*log, "angle_deg", 12.3, pair.setup.noise_angle_deg, random);
        disconnect(*log, "rate_dps", 0.0, pair.setup.noise_rate_dps, random);
      }
      truth.title = "angle and rate: sensors that are not attached";
      truth.refuse = true;
    } else if (kind == Beginner::common_factor) {
      // The clock counts in another unit: every constant with a second in it is off by a power of one factor.
      const double factor = random.pick({0.5, 2.0, 10.0, 0.1});
      for (Recording* log : {&drawn.train, &drawn.heldout})
        for (auto& column : log->columns)
          if (column.name == "t_s")
            for (double& value : column.values) value *= factor;
      truth.title = "time by a factor";
      truth.common_factor = true;
    }
  } else {
    const bool of_supply = kind == Beginner::common_factor;
    const BenchPair pair = record_bench_pair(random, !of_supply);
    take(pair, bench_model_json(pair.setup.context));
    if (kind == Beginner::not_attached) {
      for (Recording* log : {&drawn.train, &drawn.heldout})
        disconnect(*log, "motor_C", 21.5, pair.setup.noise_motor_C, random);
      truth.title = "motor_C: a thermometer that is not attached";
      truth.refuse = true;
    } else if (of_supply) {
      auto& volts = drawn.model["supply"]["nominal_V"];
      volts = volts.template get<double>() * random.pick({0.5, 2.0});
      truth.title = "another supply";
      truth.common_factor = true;
    }
  }
  if (kind == Beginner::one_constant) {
    spoil(places[any_place()], wrong_by(random));
    truth.accept = {truth.causes};
  } else if (kind == Beginner::two_constants) {
    const std::size_t one = any_place(),
                      other = (one + 1 + static_cast<std::size_t>(random.integer(0, 1))) % 3;
    const double factor = wrong_by(random);
    double second = wrong_by(random);
    while (second / factor > 0.67 && second / factor < 1.5) second = wrong_by(random);
    spoil(places[one], factor);
    spoil(places[other], second);
    truth.accept = {truth.causes};
    // Of an axis, motion tells ratios alone: two of its three constants are as good as two others.
    if (axis)
      truth.accept = {{places[0].cause, places[1].cause},
                      {places[0].cause, places[2].cause},
                      {places[1].cause, places[2].cause}};
  }
  drawn.label = truth.label(Part::beginner, axis ? "axis" : "bench");
  return drawn;
}

}  // namespace gap_benchmark
