// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// A plant that is none of the library's: a tank whose level rises by a pump and falls through a valve. The stages
// of the localisation know nothing of it but its balance.

#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/where/localise_balances.hpp>
#include <thermopower/plant/piecewise_linear.hpp>

#include <cmath>
#include <memory>
#include <string>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
namespace plant = thermopower::plant;

namespace {

constexpr double area_m2 = 0.5, valve_m25_per_s = 2e-3, interval_s = 2.0;

/// What is wrong with the tank.
struct TankFault {
  double leak_m2_per_s = 0.0;  ///< through a wall that lets water through below the level
  double pump_share = 1.0;     ///< of what the pump is said to give, at its full speed; less of that below
  double gauge_offset_m = 0.0;
};

struct Tank {
  Eigen::VectorXd level_m, pump_m3_per_s;
  std::shared_ptr<plant::BalanceRows> rows = std::make_shared<plant::BalanceRows>();
};

Tank recorded(const TankFault& fault) {
  constexpr Eigen::Index count = 3000;
  test::Noise noise(7);
  Tank tank;
  tank.rows->t_s = Eigen::VectorXd::LinSpaced(count, 0.0, interval_s * (count - 1));
  tank.rows->runs = {{0, count, ""}};
  tank.rows->interval_s = interval_s;
  tank.level_m.resize(count);
  tank.pump_m3_per_s.resize(count);
  double level = 0.4, pump = 1e-3;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (i % 60 == 0) pump = 1e-3 * (1.0 + std::floor(1.5 + 1.5 * std::sin(0.37 * static_cast<double>(i))));
    tank.pump_m3_per_s[i] = pump;
    tank.level_m[i] = level + fault.gauge_offset_m + 5e-4 * noise();
    const double given = pump * (1.0 - (1.0 - fault.pump_share) * pump / 4e-3);
    for (int k = 0; k < 40; ++k) {
      const double out = valve_m25_per_s * std::sqrt(std::max(level, 0.0)) + fault.leak_m2_per_s * level;
      level += interval_s / 40.0 * (given - out) / area_m2;
    }
  }
  return tank;
}

/// The balance of the tank, as a user writes it: area dh/dt = pump - valve sqrt(h).
/// @param when_asked  what may be otherwise is made when it is asked for, and not before
plant::Balance level_balance(const Tank& tank, plant::BalanceForm form, double valve,
                             bool when_asked = false) {
  plant::Balance b;
  b.quantity = plant::QuantityName("missing inflow");
  b.unit = "m3/s";
  b.signal = plant::SignalName("level_m");
  b.instrument = plant::SubmodelName("tank.gauge");
  b.otherwise = plant::SubmodelName("tank.wall");
  b.given = "Given the pump and the level";
  b.form = form;
  b.rows = tank.rows;
  b.measured = b.state = tank.level_m;
  b.capacity = Eigen::VectorXd::Constant(tank.level_m.size(), area_m2);
  const Eigen::VectorXd level = tank.level_m, pump = tank.pump_m3_per_s;
  const Eigen::VectorXd out = valve * level.cwiseMax(1e-6).cwiseSqrt();
  b.flow_sampled = -out;
  b.flow_held = pump;
  b.relaxation_per_s = (0.5 / area_m2) * out.cwiseQuotient(level.cwiseMax(1e-6));
  b.half_widths = {8, 40};
  b.picture_half_width = 40;
  b.constants = {{"valve", plant::flow_sampled(-out)}, {"area", plant::further_store(level)}};
  if (when_asked)
    b.constants = {{"valve", [out] { return plant::flow_sampled(-out); }},
                   {"no constant of this balance", [] { return plant::Direction(); }},
                   {"area", [level] { return plant::further_store(level); }}};
  b.freedoms.push_back({plant::SubmodelName("tank.wall"), "level_m", "a leak that grows with the level",
                        [level, when_asked](double) {
                          if (when_asked)
                            return plant::made_directions(plant::BalancePart::Kind::flow_sampled, 1,
                                                          [level](Eigen::Index) { return level; });
                          return std::vector<plant::Direction>{plant::flow_sampled(level)};
                        }});
  b.freedoms.push_back(
      {plant::SubmodelName("tank.pump"), "pump_m3_per_s", "a pump that gives another flow", [pump](double) {
         return plant::directions_of(plant::scaled(plant::hats(pump, 4), pump), plant::flow_held);
       }});
  b.freedoms.push_back({plant::SubmodelName("tank.wall"), "t_s", "a constant inflow", [level](double) {
                          return std::vector<plant::Direction>{
                              plant::flow_sampled(Eigen::VectorXd::Ones(level.size()))};
                        }});
  b.variables = {{"level_m", "m", level},
                 {"pump_m3_per_s", "m3/s", pump, plant::OrderingVariable::Kind::held}};
  return b;
}

Localisation tank(const TankFault& fault, plant::BalanceForm form, double valve = valve_m25_per_s,
                  bool when_asked = false) {
  const Tank water = recorded(fault);
  const std::vector<plant::BalanceSource> sources{
      {plant::QuantityName("missing inflow"),
       plant::SignalName("level_m"),
       {},
       [&](const plant::ReadingOffsets&) { return level_balance(water, form, valve, when_asked); }}};
  return localise_balances(sources);
}

}  // namespace

TEST_CASE("what may be otherwise in a balance may be made when it is asked for: the places are the same") {
  for (const plant::BalanceForm form : {plant::BalanceForm::weak, plant::BalanceForm::filtered}) {
    TankFault leak;
    leak.leak_m2_per_s = 6e-4;
    const Localisation at_hand = tank(leak, form), made = tank(leak, form, valve_m25_per_s, true);
    REQUIRE(made.where.size() == at_hand.where.size());
    for (std::size_t i = 0; i < made.where.size(); ++i) {
      CHECK(made.where[i].submodel == at_hand.where[i].submodel);
      CHECK(made.where[i].share == at_hand.where[i].share);
      CHECK(made.where[i].evidence == at_hand.where[i].evidence);
    }
    CHECK(tank({}, form, 1.02 * valve_m25_per_s, true).where.empty());
  }
}

TEST_CASE("a plant of one's own, in either form of its balance, is localised by the same stages") {
  for (const plant::BalanceForm form : {plant::BalanceForm::weak, plant::BalanceForm::filtered}) {
    INFO((form == plant::BalanceForm::weak ? "weak" : "filtered"));
    CHECK(tank({}, form).where.empty());
    CHECK(tank({}, form, 1.02 * valve_m25_per_s).where.empty());  // a constant within its slack

    TankFault leak;
    leak.leak_m2_per_s = 6e-4;
    const Localisation leaking = tank(leak, form);
    REQUIRE_FALSE(leaking.where.empty());
    CHECK(to_string(leaking.where.front().signal) == "level_m");
    CHECK(to_string(leaking.where.front().submodel) == "tank.wall");
    CHECK(leaking.where.front().share > 0.8);
    REQUIRE_FALSE(leaking.quantities.empty());
    const MissingQuantity& q = leaking.quantities.front();
    CHECK(to_string(q.quantity) == "missing inflow");
    REQUIRE(q.variable == "level_m");
    const Eigen::Index last = q.x.size() - 1;
    CHECK((q.value[last] - q.value[0]) / (q.x[last] - q.x[0]) == Approx(-6e-4).epsilon(0.15));

    TankFault weak_pump;
    weak_pump.pump_share = 0.6;
    const Localisation pumping = tank(weak_pump, form);
    REQUIRE_FALSE(pumping.where.empty());
    CHECK(to_string(pumping.where.front().submodel) == "tank.pump");
  }
}

TEST_CASE(
    "an instrument of one's own is at fault where another balance holds once its reading is corrected") {
  // A second gauge hangs 3 cm too high; the balance of the water, which reads the first, says which is wrong.
  for (const bool first_wrong : {true, false}) {
    TankFault fault;
    fault.gauge_offset_m = first_wrong ? 0.1 : 0.0;
    const Tank water = recorded(fault);
    test::Noise noise(11);
    Eigen::VectorXd second = water.level_m.array() - fault.gauge_offset_m + (first_wrong ? 0.0 : 0.1);
    for (Eigen::Index i = 0; i < second.size(); ++i) second[i] += 5e-4 * noise();
    const plant::Signal first = static_cast<plant::Signal>(0);
    const std::vector<plant::BalanceSource> sources{
        {plant::QuantityName("difference of the gauges"),
         plant::SignalName("second_m"),
         {plant::SignalName("level_m")},
         [&](const plant::ReadingOffsets& offsets) {
           plant::Balance b;
           b.quantity = plant::QuantityName("difference of the gauges");
           b.unit = "m";
           b.signal = plant::SignalName("second_m");
           b.instrument = b.otherwise = plant::SubmodelName("tank.second_gauge");
           b.given = "With the gauges held against each other";
           b.rows = water.rows;
           b.measured = b.state = second;
           b.flow_sampled = water.level_m.array() - offsets[first];
           b.noise_from = b.measured - b.flow_sampled;
           b.reads = {plant::SignalName("level_m")};
           plant::Freedom offset{plant::SubmodelName("tank.second_gauge"), "",
                                 "the same difference at every level", [&](double) {
                                   return std::vector<plant::Direction>{
                                       plant::further_reading(Eigen::VectorXd::Ones(second.size()))};
                                 }};
           offset.or_instrument = plant::SubmodelName("tank.gauge");
           offset.correction = plant::Correction{first, -1.0};
           b.freedoms.push_back(offset);
           b.variables = {{"level_m", "m", water.level_m}};
           return b;
         }},
        {plant::QuantityName("missing inflow"),
         plant::SignalName("level_m"),
         {},
         [&](const plant::ReadingOffsets& offsets) {
           Tank corrected = water;
           corrected.level_m.array() -= offsets[first];
           return level_balance(corrected, plant::BalanceForm::filtered, valve_m25_per_s);
         }}};
    const Localisation found = localise_balances(sources);
    REQUIRE_FALSE(found.where.empty());
    CHECK(to_string(found.where.front().submodel) == (first_wrong ? "tank.gauge" : "tank.second_gauge"));
  }
}
