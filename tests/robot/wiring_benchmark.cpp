// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// How many faults of the wiring are found in logs of a humanoid of 29 joints, and how many are invented in sound logs.
//   robot_wiring_benchmark [sound logs] [faulty logs of each kind] [first seed] [verbose]

#include "humanoid.hpp"

#include <thermopower/robot/wiring.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>

namespace robot = thermopower::robot;

namespace {

using robot::Role;
using robot::WiringFault;

struct Case {
  const char* name;
  WiringFault fault;
  /// Spoils a log or the gains; returns the joints and the quantities that may be named.
  std::function<std::pair<std::set<int>, std::set<Role>>(robot::Log&, robot::Robot&, std::mt19937&)> spoil;
  bool needs_effort = false, needs_velocity = false;
};

int any(std::mt19937& random, int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); }

std::pair<int, int> two(std::mt19937& random, int count) {
  const int a = any(random, count);
  int b = a;
  while (b == a) b = any(random, count);
  return {a, b};
}

std::vector<Case> cases() {
  const auto exchange = [](Eigen::MatrixXd robot::Log::*quantity, Role role) {
    return [=](robot::Log& log, robot::Robot&, std::mt19937& random) {
      Eigen::MatrixXd& of = log.*quantity;
      const auto [a, b] = two(random, static_cast<int>(of.cols()));
      of.col(a).swap(of.col(b));
      return std::make_pair(std::set<int>{a, b}, std::set<Role>{role});
    };
  };
  const auto scale = [](Eigen::MatrixXd robot::Log::*quantity, Role role, double factor) {
    return [=](robot::Log& log, robot::Robot&, std::mt19937& random) {
      Eigen::MatrixXd& of = log.*quantity;
      const int j = any(random, static_cast<int>(of.cols()));
      of.col(j) *= factor;
      return std::make_pair(std::set<int>{j}, std::set<Role>{role});
    };
  };
  const auto scale_all = [](Eigen::MatrixXd robot::Log::*quantity, Role role, double factor) {
    return [=](robot::Log& log, robot::Robot&, std::mt19937&) {
      log.*quantity *= factor;
      std::set<int> joints;
      for (int j = 0; j < (log.*quantity).cols(); ++j) joints.insert(j);
      return std::make_pair(joints, std::set<Role>{role});
    };
  };
  using Log = robot::Log;
  return {
      {"targets exchanged", WiringFault::exchanged, exchange(&Log::target, Role::target)},
      {"positions exchanged", WiringFault::exchanged, exchange(&Log::position, Role::position)},
      {"velocities exchanged", WiringFault::exchanged, exchange(&Log::velocity, Role::velocity), false, true},
      {"efforts exchanged", WiringFault::exchanged, exchange(&Log::effort, Role::effort), true},
      {"targets in another order", WiringFault::exchanged,
       [](Log& log, robot::Robot&, std::mt19937&) {
         const Eigen::MatrixXd from = log.target;
         // Joint by joint of each limb instead of limb by limb: breadth first.
         std::vector<int> order;
         for (int depth = 0; depth < 7; ++depth)
           for (const auto& [begin, size] : {std::pair<int, int>{0, 6}, {6, 6}, {12, 3}, {15, 7}, {22, 7}})
             if (depth < size) order.push_back(begin + depth);
         std::set<int> joints;
         for (int j = 0; j < 29; ++j) {
           log.target.col(j) = from.col(order[static_cast<std::size_t>(j)]);
           if (order[static_cast<std::size_t>(j)] != j) joints.insert(j);
         }
         return std::make_pair(joints, std::set<Role>{Role::target});
       }},
      {"target turned", WiringFault::sign, scale(&Log::target, Role::target, -1.0)},
      {"position turned", WiringFault::sign, scale(&Log::position, Role::position, -1.0)},
      {"velocity turned", WiringFault::sign, scale(&Log::velocity, Role::velocity, -1.0), false, true},
      {"effort turned", WiringFault::sign, scale(&Log::effort, Role::effort, -1.0), true},
      {"targets in degrees", WiringFault::unit, scale_all(&Log::target, Role::target, 57.29577951308232)},
      {"positions in degrees", WiringFault::unit,
       scale_all(&Log::position, Role::position, 57.29577951308232)},
      {"velocities in degrees/s", WiringFault::unit,
       scale_all(&Log::velocity, Role::velocity, 57.29577951308232), false, true},
      {"velocities in rpm", WiringFault::unit, scale_all(&Log::velocity, Role::velocity, 9.549296585513721),
       false, true},
      {"efforts in mN m", WiringFault::unit, scale_all(&Log::effort, Role::effort, 1000.0), true},
      {"one target in degrees", WiringFault::unit, scale(&Log::target, Role::target, 57.29577951308232)},
      {"gains exchanged, effort logged", WiringFault::gain_order,
       [](Log& log, robot::Robot& body, std::mt19937& random) {
         int a = 0, b = 0;
         while (std::fabs(std::log(body.joints[static_cast<std::size_t>(a)].kp /
                                   body.joints[static_cast<std::size_t>(b)].kp)) < std::log(1.3))
           std::tie(a, b) = two(random, static_cast<int>(log.position.cols()));
         auto &one = body.joints[static_cast<std::size_t>(a)],
              &other = body.joints[static_cast<std::size_t>(b)];
         std::swap(one.kp, other.kp);
         std::swap(one.kd, other.kd);
         return std::make_pair(std::set<int>{a, b}, std::set<Role>{Role::none});
       },
       true},
      {"target's zero off by 0.5 rad", WiringFault::offset,
       [](Log& log, robot::Robot&, std::mt19937& random) {
         const int j = any(random, static_cast<int>(log.target.cols()));
         log.target.col(j).array() += any(random, 2) == 0 ? 0.5 : -0.5;
         return std::make_pair(std::set<int>{j}, std::set<Role>{Role::target});
       }},
      {"position's zero off by 1.57 rad", WiringFault::offset,
       [](Log& log, robot::Robot&, std::mt19937& random) {
         const int j = any(random, static_cast<int>(log.position.cols()));
         log.position.col(j).array() += 1.5707963;
         return std::make_pair(std::set<int>{j}, std::set<Role>{Role::position, Role::target});
       }},
      {"bus late by 15 ms, effort logged", WiringFault::delay,
       [](Log& log, robot::Robot&, std::mt19937&) {
         // Targets are logged when they are sent.
         const auto late = static_cast<Eigen::Index>(std::lround(0.015 / (log.t_s[1] - log.t_s[0])));
         const Eigen::MatrixXd from = log.target;
         const Eigen::Index rows = from.rows();
         log.target.topRows(rows - late) = from.bottomRows(rows - late);
         return std::make_pair(std::set<int>{}, std::set<Role>{Role::target});
       },
       true},
  };
}

std::string said(const robot::Wiring& wiring) {
  std::string out;
  for (const auto& one : wiring.findings) out += (out.empty() ? "" : "; ") + one.text;
  return out.empty() ? "nothing" : out;
}

// A delay that is there is no invention.
bool is_sound(const robot::Wiring& wiring) {
  for (const auto& one : wiring.findings)
    if (one.fault != WiringFault::delay) return false;
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const int sound = argc > 1 ? std::atoi(argv[1]) : 1000, faulty = argc > 2 ? std::atoi(argv[2]) : 50;
  const auto first = static_cast<unsigned>(argc > 3 ? std::atoi(argv[3]) : 1);
  const bool verbose = argc > 4;
  const robot::MujocoBody body("humanoid", test::Humanoid::mjcf());
  double seconds = 0.0;
  const auto check = [&](const robot::Robot& joints, const robot::Log& log) {
    const auto begin = std::chrono::steady_clock::now();
    const robot::Wiring wiring = robot::check_wiring(body, joints, log);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return wiring;
  };
  int invented = 0, drawn = 0;
  const auto fresh = [&](unsigned seed, const test::Humanoid::Draw& draw) {
    for (;; seed += 100000) {
      robot::Log log = test::Humanoid::log(body, draw, seed);
      if (log.position.allFinite()) return log;
    }
  };
  for (int i = 0; i < sound; ++i) {
    const unsigned seed = first + static_cast<unsigned>(i);
    const robot::Log log = fresh(seed, test::Humanoid::draw(seed));
    const robot::Wiring wiring = check(body.robot(), log);
    ++drawn;
    if (is_sound(wiring)) continue;
    ++invented;
    std::printf("sound log %u: %s\n", seed, said(wiring).c_str());
  }
  std::printf("%-36s %5d of %5d\n", "invented in sound logs", invented, sound);
  int found_all = 0, all = 0;
  for (const Case& one : cases()) {
    int found = 0, alone = 0;
    for (int i = 0; i < faulty; ++i) {
      const unsigned seed = first + 500000u + static_cast<unsigned>(i);
      test::Humanoid::Draw draw = test::Humanoid::draw(seed);
      draw.with_effort = draw.with_effort || one.needs_effort;
      draw.with_velocity = draw.with_velocity || one.needs_velocity;
      if (one.fault == WiringFault::delay) draw.late_s = 0.0;
      robot::Log log = fresh(seed, draw);
      robot::Robot joints = body.robot();
      std::mt19937 random(seed);
      const auto [who, quantities] = one.spoil(log, joints, random);
      const robot::Wiring wiring = check(joints, log);
      ++drawn;
      std::set<int> named;
      bool right = false;
      int others = 0;
      for (const auto& finding : wiring.findings) {
        if (finding.fault == one.fault && quantities.count(finding.quantity) != 0) {
          right = true;
          named.insert(finding.joints.begin(), finding.joints.end());
        } else if (finding.fault != WiringFault::delay) {
          ++others;
        }
      }
      right = right && named == who;
      found += right ? 1 : 0;
      alone += right && others == 0 ? 1 : 0;
      if (verbose && (!right || others > 0)) {
        std::printf("  %u (%s%s%s%s%s)", seed, draw.with_velocity ? "velocity " : "",
                    draw.with_effort ? "effort " : "", draw.one_at_a_time ? "one at a time" : "",
                    draw.mirrored ? "mirrored" : "", draw.steps ? "steps" : "");
        for (const int j : who)
          std::printf(" %s",
                      who.size() > 4 ? "." : body.robot().joints[static_cast<std::size_t>(j)].name.c_str());
        std::printf(": %s\n", said(wiring).c_str());
      }
    }
    found_all += found;
    all += faulty;
    std::printf("%-36s %5d of %5d found, %5d with nothing besides\n", one.name, found, faulty, alone);
    std::fflush(stdout);
  }
  if (all > 0)
    std::printf("%-36s %5d of %5d, %.1f %%\n", "found in all", found_all, all, 100.0 * found_all / all);
  std::printf("%.0f ms for each check\n", 1e3 * seconds / std::max(1, drawn));
  return 0;
}
