// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/joint.hpp>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::robot {

/// What a column of a log holds.
enum class Role {
  none,       ///< belongs to no joint
  position,   ///< measured position
  velocity,   ///< measured velocity
  effort,     ///< measured torque or force
  target,     ///< target of the position controller
  feed,       ///< commanded torque or force
  base_pose,  ///< position or orientation of the base
};

/// What a column's name says.
struct ColumnMeaning {
  Role role = Role::none;    ///< of the column
  int joint = -1;            ///< of the model; for Role::base_pose the column of Motion::base_pose
  double factor = 1.0;       ///< to rad, rad/s or N m
  bool states_unit = false;  ///< the name states the unit
  bool by_number = false;    ///< the joint is known by its number alone
};

/// @brief Says for the columns of a log which joint and which quantity each one holds, from their names alone.
///
/// A joint is found by its name in the model, whatever stands before and behind: `FL_hip_joint/position_rad`,
/// `/joint_states.position[FL_hip_joint]`, `pos_FL_hip`. The word "joint" may be left out. Where no column has the name of a
/// joint, a number counts: `q_0`, `tau[11]`, in the order of the model. The quantity is told by words such as position, velocity,
/// effort and target, and the unit by a suffix such as `_deg`; without one it is rad, rad/s, N m.
///
/// How to: @ref diagnose_a_robot.
class NameMatcher {
public:
  /// @param robot  whose joints are looked for
  explicit NameMatcher(const Robot& robot) {
    for (const Joint& joint : robot.joints) joints_.push_back(name_words(joint.name));
  }

  /// @brief The meaning of each column.
  /// @param columns  names as in the log
  /// @param renamed  pairs of a joint's name in the log and in the model
  std::vector<ColumnMeaning> match(
      const std::vector<std::string>& columns,
      const std::vector<std::pair<std::string, std::string>>& renamed = {}) const {
    std::vector<ColumnMeaning> out;
    bool any_by_name = false;
    for (const std::string& column : columns) {
      std::string name = column;
      for (const auto& [theirs, ours] : renamed)
        if (const std::size_t at = name.find(theirs); at != std::string::npos)
          name = name.substr(0, at) + ours + name.substr(at + theirs.size());
      out.push_back(meaning_of(name));
      any_by_name = any_by_name ||
                    (out.back().joint >= 0 && !out.back().by_number && out.back().role != Role::base_pose);
    }
    number_from_zero(out);
    // A number counts only where nobody wrote names.
    for (ColumnMeaning& one : out)
      if (any_by_name && one.by_number) one = {};
    return out;
  }

private:
  using Words = std::vector<std::string>;

  static Words words_of(const std::string& text) {
    Words words;
    std::string word;
    for (std::size_t i = 0; i <= text.size(); ++i) {
      const char c = i < text.size() ? text[i] : '/';
      if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
        word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      } else if (!word.empty()) {
        words.push_back(word);
        word.clear();
      }
    }
    return words;
  }

  static Words name_words(const std::string& name) {
    Words words = words_of(name), kept;
    for (const std::string& word : words)
      if (word != "joint") kept.push_back(word);
    return kept.empty() ? words : kept;
  }

  static bool is_one_of(const std::string& word, const std::set<std::string>& set) {
    return set.count(word) != 0;
  }

  // Words that say what is meant, and those that say the unit.
  static Role role_of(const Words& words) {
    static const std::set<std::string> target{"target", "cmd",     "command", "commands",  "commanded",
                                              "des",    "desired", "ref",     "reference", "setpoint",
                                              "goal",   "action",  "actions", "targets"},
        effort{"effort", "efforts", "torque", "torques", "tau", "trq", "force", "forces", "tauest", "nm"},
        velocity{"velocity", "velocities", "vel",  "dq",    "qd",   "qdot", "rate",
                 "speed",    "dps",        "qvel", "omega", "rads", "radps"},
        position{"position", "positions", "pos", "q", "qpos", "angle", "angles", "theta", "rad", "deg"},
        other{"acceleration", "acc",     "ddq",     "qdd",  "temperature",
              "temp",         "current", "voltage", "mode", "lost"};
    bool is_target = false, is_effort = false, is_velocity = false, is_position = false, is_other = false;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::string& word = words[i];
      is_target = is_target || is_one_of(word, target);
      is_effort = is_effort || is_one_of(word, effort);
      is_velocity = is_velocity || is_one_of(word, velocity);
      is_position = is_position || is_one_of(word, position);
      is_other = is_other || is_one_of(word, other);
      if ((word == "rad" || word == "deg") && i + 1 < words.size() && words[i + 1] == "s") is_velocity = true;
    }
    if (is_other) return Role::none;
    if (is_target) return is_effort ? Role::feed : is_velocity ? Role::none : Role::target;
    if (is_effort) return Role::effort;
    if (is_velocity) return Role::velocity;
    return is_position ? Role::position : Role::none;
  }

  static void take_unit(const Words& words, ColumnMeaning& meaning) {
    constexpr double degree = 3.14159265358979323846 / 180.0;
    for (const std::string& word : words) {
      const bool is_degrees = word == "deg" || word == "dps" || word == "degrees";
      if (is_degrees) meaning.factor = degree;
      if (is_degrees || word == "rad" || word == "nm" || word == "rads" || word == "radps")
        meaning.states_unit = true;
    }
  }

  ColumnMeaning meaning_of(const std::string& column) const {
    const Words all = words_of(column);
    Words plain;
    for (const std::string& word : all)
      if (word != "joint") plain.push_back(word);
    // The longest name that stands in the column.
    int best = -1;
    std::size_t longest = 0, best_at = 0;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const Words& name = joints_[j];
      std::size_t size = 0;
      for (const std::string& word : name) size += word.size();
      if (size <= longest) continue;
      const auto at = std::search(plain.begin(), plain.end(), name.begin(), name.end());
      if (at == plain.end()) continue;
      longest = size;
      best = static_cast<int>(j);
      best_at = static_cast<std::size_t>(at - plain.begin());
    }
    ColumnMeaning out;
    Words rest = plain;
    if (best >= 0) {
      const auto from = rest.begin() + static_cast<std::ptrdiff_t>(best_at);
      rest.erase(from, from + static_cast<std::ptrdiff_t>(joints_[static_cast<std::size_t>(best)].size()));
    } else if (base_column(plain, out)) {
      return out;
    }
    out.role = role_of(rest);
    out.joint = best;
    take_unit(rest, out);
    if (best < 0 && out.role != Role::none) {
      // `q_3`, `tau[11]`, `q3`: the last number.
      for (auto word = rest.rbegin(); word != rest.rend() && out.joint < 0; ++word)
        if (word->find_first_not_of("0123456789") == std::string::npos) {
          out.joint = std::atoi(word->c_str());
          out.by_number = true;
        }
    }
    if (out.joint < 0) out.role = Role::none;
    return out;
  }

  static bool base_column(const Words& words, ColumnMeaning& out) {
    static const std::set<std::string> base{"base", "trunk", "torso", "pelvis", "root", "floating"},
        turn{"quat", "quaternion", "orientation", "q"}, place{"position", "pos"};
    bool is_base = false, is_turn = false, is_place = false;
    for (const std::string& word : words) {
      is_base = is_base || is_one_of(word, base);
      is_turn = is_turn || is_one_of(word, turn);
      is_place = is_place || is_one_of(word, place);
    }
    if (!is_base || words.empty() || (!is_turn && !is_place)) return false;
    std::string last = words.back();
    if (last == "m" && words.size() > 1) last = words[words.size() - 2];
    const std::string axes = is_turn ? "wxyz" : "xyz";
    if (last.size() != 1 || axes.find(last) == std::string::npos) return false;
    out.role = Role::base_pose;
    out.joint = static_cast<int>(axes.find(last)) + (is_turn ? 3 : 0);
    return true;
  }

  // Numbers may begin at 0 or at 1.
  void number_from_zero(std::vector<ColumnMeaning>& all) const {
    int least = 1 << 20;
    for (const ColumnMeaning& one : all)
      if (one.by_number) least = std::min(least, one.joint);
    for (ColumnMeaning& one : all) {
      if (!one.by_number) continue;
      if (least == 1) --one.joint;
      if (one.joint >= static_cast<int>(joints_.size())) one = {};
    }
  }

  std::vector<Words> joints_;
};

}  // namespace thermopower::robot
