// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/inline.hpp>
#include <thermopower/plant/model.hpp>
#include <thermopower/plant/plant.hpp>
#include <thermopower/plant/plant_info.hpp>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace thermopower::plant {

/// The library's own plant: a circuit, a thermal body and its thermometer on the bench; a drive, a joint and its
/// instruments. Which of them there are is the model's to say.
///
/// The bench runs freely over whole runs, from the first measured temperature on; the axis in windows, each from
/// the measured angle and rate.
///
/// @snippet plant_examples.cpp rollout
/// How to: @ref gap_method.
class ActuatorPlant : public Plant {
public:
  const std::vector<Signal>& signals(const Segment& segment) const override {
    static const std::vector<Signal> bench{Signal::current_A, Signal::motor_C, Signal::power_param},
        axis{Signal::angle_deg, Signal::rate_dps, Signal::current_A};
    return segment.axis ? axis : bench;
  }

  void cut(const Inputs& inputs, double horizon_s, std::vector<Segment>& segments) const override;

  int start_size(const Segment&) const override { return 2; }

  int directions_at_once() const override { return wide_dual_width; }
  Start start_weight(const Segment& segment, const std::array<double, signal_count>& sigma) const override;

  std::unique_ptr<Rollout> rollout(const Model& model, const Catalogue& catalogue,
                                   const ParameterPoint& point, const Directions& directions,
                                   SimulationMode mode) const override;
};

/// The plant that a model is of.
inline const Plant& plant_of(const Model& model) {
  static const ActuatorPlant actuator;
  return model.own ? *model.own->equations : static_cast<const Plant&>(actuator);
}

/// The effects that may act in a model: those of its plant where it has its own, else those `given`.
inline const Catalogue& catalogue_of(const Model& model, const Catalogue& given) {
  const Catalogue* own = model.own ? model.own->equations->effects() : nullptr;
  return own != nullptr ? *own : given;
}

/// The name of a signal of a model's plant.
inline SignalName signal_name(const Model& model, Signal signal) {
  const PlantInfo* own = plant_of(model).info();
  if (own == nullptr) return signal;
  return SignalName(own->signals[static_cast<std::size_t>(signal)].name);
}

/// Unit of a signal of a model's plant, as reports spell it.
inline std::string signal_unit(const Model& model, Signal signal) {
  const PlantInfo* own = plant_of(model).info();
  return own == nullptr ? std::string(unit_of(signal)) : own->signals[static_cast<std::size_t>(signal)].unit;
}

}  // namespace thermopower::plant

#ifndef THERMOPOWER_GAP_LIBRARY
#include <thermopower/plant/detail/actuator_plant.hpp>
#endif
