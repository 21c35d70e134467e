// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/body.hpp>
#include <thermopower/robot/joint.hpp>
#include <thermopower/robot/log.hpp>
#include <thermopower/robot/names.hpp>

#include <string>
#include <vector>

namespace thermopower::robot {

/// What may be wrong between a robot and its log, before any physics.
enum class WiringFault {
  exchanged,     ///< columns of joints stand in each other's place
  sign,          ///< a column counts the other way round
  unit,          ///< a column is in another unit
  offset,        ///< a column has another zero
  gain_order,    ///< the gains stand in another order than the joints
  out_of_range,  ///< positions lie outside the joint's range, and no line of the table brings them back
  delay,         ///< targets reach the joints late
};

/// The word of a fault, as reports have it.
inline const char* to_string(WiringFault fault) {
  switch (fault) {
    case WiringFault::exchanged:
      return "exchanged";
    case WiringFault::sign:
      return "sign";
    case WiringFault::unit:
      return "unit";
    case WiringFault::offset:
      return "offset";
    case WiringFault::gain_order:
      return "gain_order";
    case WiringFault::out_of_range:
      return "out_of_range";
    case WiringFault::delay:
      return "delay";
  }
  return "";
}

/// @brief One thing that is wrong in a log's wiring.
struct WiringFinding {
  WiringFault fault = WiringFault::exchanged;  ///< what is wrong
  Role quantity = Role::none;  ///< of which quantity; Role::none: of all quantities of the joint
  std::vector<int> joints;     ///< of the model, in ascending order; empty: the whole bus
  double number = 0.0;         ///< the unit's factor, the offset in rad or the delay in s
  bool mended = false;         ///< mend() puts it right
  std::string text;            ///< one sentence for the user, without a full stop
};

/// @brief How one quantity of a log belongs to the joints of the model; empty where the log lacks it.
struct Wires {
  std::vector<int> source;     ///< for each joint the joint whose column holds its numbers
  std::vector<double> factor;  ///< logged number per true number, with its sign
  std::vector<double> offset;  ///< in true units: logged = factor * (true + offset)
};

/// @brief What was found out about the wiring of a log.
///
/// How to: @ref diagnose_a_robot.
struct Wiring {
  std::vector<WiringFinding> findings;  ///< most fundamental first; empty: as it should be
  Wires position;                       ///< of the positions, as they are; identity where nothing is wrong
  Wires velocity;                       ///< of the velocities
  Wires effort;                         ///< of the efforts
  Wires target;                         ///< of the targets
  std::vector<int> gains;               ///< for each joint the joint whose gains are its own
  double gain_factor = 1.0;             ///< stated gain per true gain
  double target_delay_s = 0.0;          ///< of the targets against the measured efforts; 0: none, or not told
};

/// @brief When a line of the table of hypotheses is believed.
struct WiringOptions {
  Eigen::Index most_rows = 4000;  ///< that are looked at; of a longer log, means of several rows
  double least_nats = 12.0;   ///< log likelihood by which a hypothesis must win, per joint that it changes
  double most_left = 0.6;     ///< share of the misfit that it may leave
  double fault_nats = 6.0;    ///< price of each column that is not as named
  double offset_rad = 0.15;   ///< a usual difference of target and position that nobody calls an offset
  double floor_share = 0.04;  ///< misfit below this share of the signal counts as none
  double range_share = 0.1;   ///< of its range by which a joint may lie outside
  double latest_s = 0.25;     ///< longest lag of the position behind its target
};

/// @brief Finds exchanged joints, signs, units, offsets and the order of the gains. Nothing of the joints' physics is fitted that
/// is reported.
///
/// There is one table of hypotheses: for each column, another joint, the other sign, another unit, another zero. There is one
/// test. A hypothesis wins when the joints' columns agree much better with each other. The agreements are these: a velocity is the
/// slope of its position; a target leads its position through the controller and the rigid body; an effort is what the controller
/// commands; a position lies in its joint's range; an effort moves the rigid body.
/// @par Shapes
/// `log` has one column for each joint of `robot`.
Wiring check_wiring(const Body& body, const Robot& robot, const Log& log, const WiringOptions& options = {});

/// @brief Puts the columns of a log in their place, with their sign, unit and zero.
void mend(const Wiring& wiring, Log& log);

/// @brief Gives each joint its own gains.
void mend(const Wiring& wiring, Robot& robot);

}  // namespace thermopower::robot
