// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <vector>

#include "axis_effects.hpp"
#include "bench_effects.hpp"
#include "case.hpp"

namespace gap_benchmark {

using Pair = std::pair<const char*, const char*>;

/// Two causes at once: in different submodels, in the same one, and such as hide each other.
inline const std::vector<Pair>& bench_pairs() {
  static const std::vector<Pair> pairs = {
      {"second_thermal_mass", "current_sensor_offset"},
      {"second_thermal_mass", "ambient_bias"},
      {"second_thermal_mass", "forced_airflow"},
      {"second_thermal_mass", "motion_heating"},
      {"radiation", "series_resistance"},
      {"natural_convection", "supply_sag"},
      {"natural_convection", "dead_time"},
      {"thermometer_lag", "supply_sag"},
      {"thermometer_lag", "dead_time"},
      {"thermometer_lag", "neighbour_heating"},
      {"forced_airflow", "neighbour_heating"},
      {"forced_airflow", "current_sensor_gain"},
      {"forced_airflow", "calibration.conductance"},
      {"ambient_bias", "winding_tempco"},
      {"ambient_bias", "series_resistance"},
      {"ambient_bias", "neighbour_heating"},
      {"back_emf", "motion_heating"},
      {"back_emf", "current_sensor_offset"},
      {"dead_time", "current_sensor_offset"},
      {"series_resistance", "calibration.heat_capacity"},
      {"thermometer_gain", "calibration.resistance"},
      {"neighbour_heating", "motion_heating"},
  };
  return pairs;
}

inline const std::vector<Pair>& axis_pairs() {
  static const std::vector<Pair> pairs = {
      {"coulomb_friction", "imbalance"},
      {"coulomb_friction", "actuation_delay"},
      {"coulomb_friction", "cable_spring"},
      {"coulomb_friction", "drive_deadband"},
      {"coulomb_friction", "compliance"},
      {"coulomb_friction", "torque_fade"},
      {"coulomb_friction", "rate_bias"},
      {"coulomb_friction", "calibration.inertia"},
      {"coulomb_friction", "angle_scale"},
      {"coulomb_friction", "cogging"},
      {"coulomb_friction", "torque_saturation"},
      {"imbalance", "cogging"},
      {"imbalance", "cable_spring"},
      {"imbalance", "load_friction"},
      {"imbalance", "angle_bias_drift"},
      {"imbalance", "actuation_delay"},
      {"stribeck_friction", "cogging"},
      {"asymmetric_friction", "cogging"},
      {"cable_spring", "actuation_delay"},
      {"actuation_delay", "calibration.viscous"},
      {"warm_friction", "coulomb_friction"},
      {"constant_torque", "cogging"},
      {"asymmetric_viscous", "imbalance"},
      {"drive_lag", "coulomb_friction"},
      {"torque_ripple", "cable_spring"},
  };
  return pairs;
}

inline std::vector<std::string> all_ids(bool axis) {
  std::vector<std::string> ids;
  if (axis)
    for (const auto& effect : axis_effects()) ids.push_back(effect.id);
  else
    for (const auto& effect : bench_effects()) ids.push_back(effect.id);
  return ids;
}

/// Effects whose absence a fit of the constants can hide in part: what people fit with the wrong structure.
inline const std::vector<const char*>& refitted_effects(bool axis) {
  static const std::vector<const char*> bench = {"second_thermal_mass", "natural_convection",
                                                 "thermometer_lag",     "ambient_bias",
                                                 "dead_time",           "forced_airflow",
                                                 "neighbour_heating",   "current_sensor_offset"},
                                        axes = {"coulomb_friction", "asymmetric_friction",
                                                "load_friction",    "imbalance",
                                                "actuation_delay",  "cable_spring",
                                                "drive_deadband",   "cogging",
                                                "compliance",       "torque_saturation"};
  return axis ? axes : bench;
}

inline std::string title(const CaseOrder& order) {
  if (order.form != OtherForm::none) return name(order.form);
  if (order.unknown)
    return order.axis ? axis_unknowns()[static_cast<std::size_t>(order.unknown) - 1].second
                      : bench_unknowns()[static_cast<std::size_t>(order.unknown) - 1].second;
  if (order.effects.empty())
    return order.axis ? "none (axis)" : order.thesis ? "none (thesis)" : "none (bench)";
  return order.effects.size() == 1 ? order.effects[0] : order.effects[0] + " + " + order.effects[1];
}

/// The list of what to draw, in an order that says nothing about the causes.
/// @param only comma-separated effect ids, `none`, `pairs`, `unknown`, `dirty`, `dirty_none` and `dirty_unknown` (of the dirty half
/// those without a gap, or with a cause outside the catalogue), `servo` or `misspecified`; everything when empty
/// With 5 recordings per effect: 250 single effects, 60 none, 48 pairs, 45 outside the catalogue; 116 dirty; 54 with
/// the servo's target; 56 misspecified.
inline std::vector<CaseOrder> plan(unsigned long long seed, int count, const std::string& only,
                                   bool thorough) {
  Random random(seed ^ 0x5eedull);
  std::vector<CaseOrder> orders;
  const auto wanted = [&](const std::string& kind) {
    return only.empty() || ("," + only + ",").find("," + kind + ",") != std::string::npos;
  };
  const auto scaled = [&](int at_five) { return only.empty() ? std::max(1, at_five * count / 5) : count; };
  for (const bool axis : {false, true})
    for (const auto& id : all_ids(axis)) {
      if (!wanted(id)) continue;
      const bool servo = needs_servo(id);
      for (int i = 0; i < count; ++i) {
        CaseOrder order;
        order.axis = axis;
        if (servo) order.half = Half::servo;
        order.effects = {id};
        order.thesis = id == "supply_power_heating";
        order.clear =
            i % 10 < 7;  // most are told apart by somebody who looks; the others test the honest class
        orders.push_back(order);
      }
    }
  if (wanted("none"))
    for (int i = 0; i < scaled(60); ++i) {
      CaseOrder order;
      order.axis = i % 5 >= 3;
      order.thesis = i % 10 == 2;
      orders.push_back(order);
    }
  if (wanted("pairs"))
    for (const bool axis : {false, true}) {
      auto pairs = axis ? axis_pairs() : bench_pairs();
      random.shuffle(pairs);
      for (int i = 0; i < scaled(24); ++i) {
        CaseOrder order;
        order.axis = axis;
        const Pair& pair = pairs[static_cast<std::size_t>(i) % pairs.size()];
        order.effects = {pair.first, pair.second};
        order.clear = true;
        order.gate = 2.5;
        orders.push_back(order);
      }
    }
  if (wanted("unknown"))
    for (const bool axis : {false, true}) {
      const int kinds = static_cast<int>(axis ? axis_unknowns().size() : bench_unknowns().size());
      for (int i = 0; i < scaled(axis ? 21 : 24); ++i) {
        CaseOrder order;
        order.axis = axis;
        order.unknown = 1 + i % kinds;
        orders.push_back(order);
      }
    }
  // The dirty half: every effect under a kind of dirt in turn, one in four under two kinds; no gap and causes
  // outside the catalogue under each kind.
  const auto& kinds = all_dirt();
  std::size_t turn = seed % kinds.size();
  const auto dirty = [&] {
    std::vector<Dirt> list = {kinds[turn++ % kinds.size()]};
    if (random.chance(0.25)) list.push_back(kinds[(turn + 3) % kinds.size()]);
    return list;
  };
  const bool all_dirty = wanted("dirty");
  const bool dirty_none = all_dirty || wanted("dirty_none"),
             dirty_unknown = all_dirty || wanted("dirty_unknown");
  if (dirty_none || dirty_unknown)
    for (const bool axis : {false, true}) {
      for (const auto& id : all_dirty ? all_ids(axis) : std::vector<std::string>())
        for (int i = 0; !needs_servo(id) && i < std::max(1, count / 3); ++i) {
          CaseOrder order;
          order.half = Half::dirty;
          order.axis = axis;
          order.effects = {id};
          order.thesis = id == "supply_power_heating";
          order.clear = true;
          order.dirt = dirty();
          orders.push_back(order);
        }
      for (int i = 0; dirty_none && i < scaled(25); ++i) {
        CaseOrder order;
        order.half = Half::dirty;
        order.axis = axis;
        order.dirt = dirty();
        orders.push_back(order);
      }
      const int unknowns = static_cast<int>(axis ? axis_unknowns().size() : bench_unknowns().size());
      for (int i = 0; dirty_unknown && i < scaled(8); ++i) {
        CaseOrder order;
        order.half = Half::dirty;
        order.axis = axis;
        order.unknown = 1 + i % unknowns;
        order.dirt = dirty();
        orders.push_back(order);
      }
    }
  // Position-target twins of the single effects of an axis.
  if (wanted("servo"))
    for (const auto& id : all_ids(true))
      for (int i = 0; i < std::max(1, 2 * count / 5); ++i) {
        CaseOrder order;
        order.half = Half::servo;
        order.axis = true;
        order.effects = {id};
        order.clear = true;
        orders.push_back(order);
      }
  // The misspecified half: constants that were fitted without the effect, and effects of another form.
  if (wanted("misspecified"))
    for (const bool axis : {false, true}) {
      for (const char* id : refitted_effects(axis))
        for (int i = 0; i < std::max(1, 2 * count / 5); ++i) {
          CaseOrder order;
          order.half = Half::misspecified;
          order.axis = axis;
          order.effects = {id};
          order.refitted = true;
          orders.push_back(order);
        }
      for (const OtherForm form :
           axis ? std::vector<OtherForm>{OtherForm::stribeck_exponent, OtherForm::cogging_harmonic}
                : std::vector<OtherForm>{OtherForm::third_node, OtherForm::curved_sensor})
        for (int i = 0; i < count; ++i) {
          CaseOrder order;
          order.half = Half::misspecified;
          order.axis = axis;
          order.effects = {nearest(form)};
          order.form = form;
          orders.push_back(order);
        }
    }
  for (auto& order : orders) order.thorough = thorough;
  random.shuffle(orders);
  return orders;
}

}  // namespace gap_benchmark
