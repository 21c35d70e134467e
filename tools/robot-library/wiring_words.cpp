// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "unit_factors.hpp"
#include "wiring_words.hpp"

#include <thermopower/robot/table.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

namespace thermopower::robot {
namespace {

const char* plural(Role role) {
  switch (role) {
    case Role::position:
      return "positions";
    case Role::velocity:
      return "velocities";
    case Role::effort:
      return "efforts";
    case Role::target:
      return "targets";
    default:
      return "columns";
  }
}

const char* unit_word(Role role, double factor) {
  const double size = std::fabs(factor);
  const auto is = [&](double one) { return std::fabs(size / one - 1.0) < 0.01; };
  if (is(plant::deg_per_rad)) return role == Role::velocity ? "degrees per second" : "degrees";
  if (is(turns_per_rad)) return role == Role::velocity ? "turns per second" : "turns";
  if (is(rpm)) return "revolutions per minute";
  if (is(1000.0)) return "mN m";
  if (is(100.0)) return "N cm";
  return "another unit";
}

class Words {
public:
  Words(const Robot& robot, const Wiring& wiring) : robot_(robot), wiring_(wiring) {}

  std::vector<WiringFinding> all(const std::vector<std::size_t>& lost) {
    const std::array<std::pair<Role, const Wires*>, 4> quantities{{{Role::position, &wiring_.position},
                                                                   {Role::velocity, &wiring_.velocity},
                                                                   {Role::target, &wiring_.target},
                                                                   {Role::effort, &wiring_.effort}}};
    for (const auto& one : quantities)
      if (!one.second->source.empty()) logged_.push_back(one.second);
    whole_exchanges();
    for (const auto& [role, wires] : quantities) exchanges(role, wires->source);
    gains();
    whole_signs();
    for (const auto& [role, wires] : quantities) signs(role, *wires);
    for (const auto& [role, wires] : quantities) units(role, *wires);
    for (const auto& [role, wires] : quantities)
      if (role == Role::position || role == Role::target) offsets(role, *wires);
    for (const std::size_t j : lost) {
      WiringFinding one;
      one.fault = WiringFault::out_of_range;
      one.quantity = Role::position;
      one.joints = {static_cast<int>(j)};
      one.text = "the positions of " + robot_.joints[j].name +
                 " lie outside its range, for no single sign, unit or zero: look at its column";
      out_.push_back(one);
    }
    return std::move(out_);
  }

private:
  std::string names(const std::vector<int>& joints) const {
    if (joints.size() == robot_.joints.size() && joints.size() > 2) return "all joints";
    constexpr std::size_t most = 6;
    std::string text;
    for (std::size_t i = 0; i < joints.size() && i < most; ++i) {
      const bool last = i + 1 == joints.size();
      text += (i == 0 ? "" : last ? " and " : ", ") + robot_.joints[static_cast<std::size_t>(joints[i])].name;
    }
    if (joints.size() > most) text += " and " + std::to_string(joints.size() - most) + " more";
    return text;
  }

  void add(WiringFault fault, Role quantity, std::vector<int> joints, double value, std::string text) {
    WiringFinding one;
    one.fault = fault;
    one.quantity = quantity;
    one.joints = std::move(joints);
    one.number = value;
    one.mended = true;
    one.text = std::move(text);
    out_.push_back(one);
  }

  static std::vector<std::vector<int>> cycles(const std::vector<int>& source) {
    std::vector<std::vector<int>> out;
    std::vector<char> seen(source.size(), 0);
    for (std::size_t first = 0; first < source.size(); ++first) {
      std::vector<int> cycle;
      for (auto i = first; seen[i] == 0; i = static_cast<std::size_t>(source[i])) {
        seen[i] = 1;
        cycle.push_back(static_cast<int>(i));
      }
      if (cycle.size() > 1) out.push_back(cycle);
    }
    return out;
  }

  std::string exchange_text(const std::string& what, std::vector<int>& cycle,
                            const std::vector<int>& source) {
    const bool pair = cycle.size() == 2;
    std::string text = what + (pair ? " of " : " stand in another order: ");
    if (pair) {
      std::sort(cycle.begin(), cycle.end());
      return text + names(cycle) + " are exchanged";
    }
    for (std::size_t i = 0; i < cycle.size() && i < 6; ++i)
      text += (i == 0 ? "" : ", ") + std::string("those of ") + joint_name(cycle[i]) +
              " are in the place of " + joint_name(source[static_cast<std::size_t>(cycle[i])]);
    if (cycle.size() > 6) text += " and so on, " + std::to_string(cycle.size()) + " joints";
    std::sort(cycle.begin(), cycle.end());
    return text;
  }

  std::string joint_name(int j) const { return robot_.joints[static_cast<std::size_t>(j)].name; }

  // Exchanged in all quantities alike.
  void whole_exchanges() {
    common_ = wiring_.position.source;
    for (const Wires* one : logged_)
      for (std::size_t j = 0; j < common_.size(); ++j)
        if (one->source[j] != common_[j]) common_[j] = static_cast<int>(j);
    for (std::vector<int> cycle : cycles(common_)) {
      const std::string text = exchange_text("all columns", cycle, common_);
      add(WiringFault::exchanged, Role::none, cycle, 0.0, text);
    }
  }

  void exchanges(Role role, const std::vector<int>& source) {
    for (std::vector<int> cycle : cycles(source)) {
      if (common_[static_cast<std::size_t>(cycle[0])] == source[static_cast<std::size_t>(cycle[0])]) continue;
      const std::string text = exchange_text(std::string("the ") + plural(role), cycle, source);
      add(WiringFault::exchanged, role, cycle, 0.0, text);
    }
  }

  void gains() {
    for (std::vector<int> cycle : cycles(wiring_.gains)) {
      const std::string text = exchange_text("the gains", cycle, wiring_.gains);
      add(WiringFault::gain_order, Role::none, cycle, 0.0, text);
    }
    if (wiring_.gain_factor == 1.0) return;
    const bool small = wiring_.gain_factor < 1.0;
    add(WiringFault::unit, Role::none, {}, wiring_.gain_factor,
        small ? "the gains are per degree: times 57.3 they are per rad"
              : "the gains are 57.3 times those of the log: they count per rad what the log has per degree");
  }

  void whole_signs() {
    turned_.assign(robot_.joints.size(), 1);
    std::vector<int> joints;
    for (std::size_t j = 0; j < turned_.size(); ++j) {
      for (const Wires* one : logged_) turned_[j] = turned_[j] != 0 && one->factor[j] < 0.0;
      if (turned_[j] != 0) joints.push_back(static_cast<int>(j));
    }
    if (!joints.empty())
      add(WiringFault::sign, Role::none, joints, -1.0,
          "all columns of " + names(joints) + " count the other way round than the model");
  }

  void signs(Role role, const Wires& wires) {
    std::vector<int> joints;
    for (std::size_t j = 0; j < wires.factor.size(); ++j)
      if (wires.factor[j] < 0.0 && turned_[j] == 0) joints.push_back(static_cast<int>(j));
    if (joints.empty()) return;
    add(WiringFault::sign, role, joints, -1.0,
        std::string("the ") + plural(role) + " of " + names(joints) + " count the other way round");
  }

  void units(Role role, const Wires& wires) {
    std::map<double, std::vector<int>> by_factor;
    for (std::size_t j = 0; j < wires.factor.size(); ++j)
      if (std::fabs(std::fabs(wires.factor[j]) - 1.0) > 0.01)
        by_factor[std::fabs(wires.factor[j])].push_back(static_cast<int>(j));
    for (const auto& [factor, joints] : by_factor)
      add(WiringFault::unit, role, joints, factor,
          std::string("the ") + plural(role) + " of " + names(joints) + " are in " + unit_word(role, factor));
  }

  void offsets(Role role, const Wires& wires) {
    for (std::size_t j = 0; j < wires.offset.size(); ++j) {
      if (wires.offset[j] == 0.0) continue;
      if (role == Role::target && std::fabs(wires.offset[j] - wiring_.position.offset[j]) < 1e-9) continue;
      const std::string text = role == Role::target
                                   ? "the targets of " + robot_.joints[j].name + " lie " +
                                         detail::number_text(wires.offset[j]) +
                                         " rad above its positions for good: one of the two has another zero"
                                   : "the positions of " + robot_.joints[j].name +
                                         " count from another zero: " + detail::number_text(wires.offset[j]) +
                                         " rad are taken off";
      add(WiringFault::offset, role, {static_cast<int>(j)}, wires.offset[j], text);
    }
  }

  const Robot& robot_;
  const Wiring& wiring_;
  std::vector<const Wires*> logged_;
  std::vector<int> common_;
  std::vector<char> turned_;
  std::vector<WiringFinding> out_;
};

}  // namespace

std::vector<WiringFinding> wiring_words(const Robot& robot, const Wiring& wiring,
                                        const std::vector<std::size_t>& lost) {
  return Words(robot, wiring).all(lost);
}

}  // namespace thermopower::robot
