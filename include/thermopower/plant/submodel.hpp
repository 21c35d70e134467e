// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/open_name.hpp>

namespace thermopower::plant {

/// The parts of a plant that can be at fault, as reports name them.
enum class Submodel {
  electrical,            ///< supply, bridge, wires, winding, back-EMF
  thermal_heating,       ///< what heats the body
  thermal_storage,       ///< where in the body heat is kept, and how much of it
  thermal_loss,          ///< what the body gives away
  mechanical_drive,      ///< from command to torque
  mechanical_friction,   ///< torques against the motion
  mechanical_load,       ///< torques of position and time
  mechanical_structure,  ///< inertias and what couples them
  sensing_current,       ///< the ammeter
  sensing_temperature,   ///< the thermometer
  sensing_angle,         ///< the encoder, or an attitude estimate
  sensing_rate,          ///< the gyroscope
};

/// Number of submodels in the closed set.
inline constexpr int count_of(Submodel) { return 12; }

/// `electrical`, `thermal.loss`, `sensing.angle`, ...: as reports spell it.
inline const char* to_string(Submodel submodel) {
  switch (submodel) {
    case Submodel::electrical:
      return "electrical";
    case Submodel::thermal_heating:
      return "thermal.heating";
    case Submodel::thermal_storage:
      return "thermal.storage";
    case Submodel::thermal_loss:
      return "thermal.loss";
    case Submodel::mechanical_drive:
      return "mechanical.drive";
    case Submodel::mechanical_friction:
      return "mechanical.friction";
    case Submodel::mechanical_load:
      return "mechanical.load";
    case Submodel::mechanical_structure:
      return "mechanical.structure";
    case Submodel::sensing_current:
      return "sensing.current";
    case Submodel::sensing_temperature:
      return "sensing.temperature";
    case Submodel::sensing_angle:
      return "sensing.angle";
    case Submodel::sensing_rate:
      return "sensing.rate";
  }
  return "";
}

/// A submodel of our plants, or one of a user's own plant.
using SubmodelName = OpenName<Submodel>;

}  // namespace thermopower::plant
