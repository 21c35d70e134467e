// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/joint.hpp>

#include <array>
#include <cctype>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::robot {

/// @brief Joints that are built alike, such as left and right or the same joint of four legs.
struct JointGroup {
  std::string name;          ///< what their names have in common, as in `*_hip_joint`
  std::vector<int> members;  ///< of the robot; at least one
};

/// @brief Name of a joint without what says left or right, front or rear: equal joints get the same.
///
/// Known are left, right, l, r, front, rear, back, hind, fl, fr, rl, rr, lf, rf, lh, rh, hl, hr and bl, br, as words between separators.
inline std::string side_free_name(const std::string& name) {
  static constexpr std::array<const char*, 23> sides{
      "left", "right", "l",  "r",  "front", "rear", "back", "hind", "fl", "fr", "rl", "rr",
      "lf",   "rf",    "lh", "rh", "hl",    "hr",   "bl",   "br",   "lr", "lb", "rb"};
  std::string out, word;
  const auto close = [&] {
    bool is_side = false;
    std::string lower;
    for (const char c : word) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const char* side : sides) is_side = is_side || lower == side;
    out += is_side ? "*" : word;
    word.clear();
  };
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      word += c;
      continue;
    }
    close();
    out += c;
  }
  close();
  return out;
}

/// @brief Groups the joints of a robot by their names; joints with other constants in the model are not equal.
inline std::vector<JointGroup> groups_of(const Robot& robot) {
  std::vector<JointGroup> groups;
  std::map<std::string, std::size_t> known;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const Joint& joint = robot.joints[j];
    const std::string name = side_free_name(joint.name);
    const std::string key = name + "/" + std::to_string(joint.armature) + "/" +
                            std::to_string(joint.damping) + "/" + std::to_string(joint.friction);
    const auto [at, is_new] = known.emplace(key, groups.size());
    if (is_new) groups.push_back({name, {}});
    groups[at->second].members.push_back(static_cast<int>(j));
  }
  return groups;
}

}  // namespace thermopower::robot
