// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/plant/standard_catalogue.hpp>
#include <thermopower/io/names.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// A model for another simulator.
struct SimulatorFile {
  std::string text;                   ///< the file
  std::vector<std::string> left_out;  ///< one sentence each: what the format cannot express, with its numbers
};

/// @brief The axis of a model, with its effects, as a model of MuJoCo (MJCF): one hinge and one actuator whose control
/// is the drive in A, or in V where a voltage drives the motor. The hinge has the model's name. It loads as it stands, in MuJoCo 2.2
/// and later; joint and actuator can be copied from it.
///
/// A model with a servo becomes `<position kp kv>` or `<velocity kv>`, whose control is the target in rad or rad/s (MuJoCo 3.1 and later).
///
/// Exact: inertia, damping, torque constant, spring, constant torque, saturation, lag of the drive, imbalance (as a
/// mass off the axis), compliance (as a second hinge). Nearly: dry friction as `frictionloss`, which has no transition.
/// The parts that MJCF cannot express stand in a comment of the file and in `left_out`, with its numbers.
/// @param origin     one line that says where it comes from
/// @param catalogue  knows the model's effects: each of them says what it is in a joint (EffectInfo::in_a_joint)
/// @throws InvalidInput where the model has no axis
SimulatorFile mjcf(const Model& model, const std::string& origin,
                   const Catalogue& catalogue = standard_catalogue());

/// @brief The same as URDF: a joint with `<dynamics>` and `<limit>`, which is all that the format has.
/// @throws InvalidInput where the model has no axis
SimulatorFile urdf(const Model& model, const std::string& origin,
                   const Catalogue& catalogue = standard_catalogue());

}  // namespace thermopower::io
