// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Robots with hidden effects, moved by MuJoCo alone: which joints and which effects are named, and how many sound joints are accused.
//   robot_truth_benchmark [robots of each kind] [first seed] [verbose]

#include "hidden_truth.hpp"

#include "mujoco_body.hpp"

#include <thermopower/robot/diagnose.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace robot = thermopower::robot;

namespace {

struct Recorded {
  const char* name;
  bool with_effort;
  test::HiddenTruth::Logged logged;
};

constexpr Recorded recordings[] = {
    {"effort logged after its jump", true, test::HiddenTruth::Logged::after_jump},
    {"effort logged before its jump", true, test::HiddenTruth::Logged::before_jump},
    {"effort averaged", true, test::HiddenTruth::Logged::averaged},
    {"targets only", false, test::HiddenTruth::Logged::after_jump}};

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 50;
  const auto first = static_cast<unsigned>(argc > 2 ? std::atoi(argv[2]) : 1);
  const bool verbose = argc > 3;
  for (const auto kind : {test::HiddenTruth::Kind::arm, test::HiddenTruth::Kind::quadruped})
    for (const Recorded& recorded : recordings) {
      int affected = 0, joint_right = 0, effect_right = 0, alike = 0, sound = 0, accused = 0;
      double seconds = 0.0;
      for (int i = 0; i < count; ++i) {
        test::HiddenTruth truth(kind, first + static_cast<unsigned>(i));
        const robot::Log log = truth.log(recorded.with_effort, 20.0, recorded.logged);
        const robot::MujocoBody body("model", truth.model());
        const auto begin = std::chrono::steady_clock::now();
        const robot::RobotDiagnosis found = robot::diagnose(body, body.robot(), log, {});
        seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        std::set<int> joints;
        std::string said;
        for (const auto& effect : truth.effects()) {
          joints.insert(effect.joint);
          const robot::JointDiagnosis& one = found.joints[static_cast<std::size_t>(effect.joint)];
          ++affected;
          joint_right += one.causes.empty() ? 0 : 1;
          bool right = false, like = false;
          for (const robot::Term& term : one.causes) {
            right = right || robot::to_string(term.family) == effect.id;
            for (const robot::Family other : term.predicts_alike)
              like = like || robot::to_string(other) == effect.id;
          }
          effect_right += right ? 1 : 0;
          alike += right || like ? 1 : 0;
          if (right) continue;
          said += " " + one.name + " has " + effect.id + ", told:";
          for (const robot::Term& term : one.causes) said += std::string(" ") + robot::to_string(term.family);
        }
        for (std::size_t j = 0; j < found.joints.size(); ++j) {
          if (joints.count(static_cast<int>(j)) != 0) continue;
          ++sound;
          if (found.joints[j].causes.empty()) continue;
          ++accused;
          said += " " + found.joints[j].name + " is accused of";
          for (const robot::Term& term : found.joints[j].causes)
            said += std::string(" ") + robot::to_string(term.family);
        }
        for (const auto& one : found.wiring) said += " wiring: " + one.text;
        if (found.stands_on_ground) said += " stands on the ground?";
        if (verbose && !said.empty())
          std::printf("  %u:%s\n", first + static_cast<unsigned>(i), said.c_str());
      }
      const auto percent = [](int part, int all) { return 100.0 * part / std::max(1, all); };
      std::printf(
          "%s, %s: joint right %.1f %% of %d, effect right %.1f %% (or one that predicts alike %.1f %%), sound joints accused %.1f %% of %d, %.1f s each\n",
          kind == test::HiddenTruth::Kind::arm ? "arm" : "quadruped", recorded.name,
          percent(joint_right, affected), affected, percent(effect_right, affected), percent(alike, affected),
          percent(accused, sound), sound, seconds / count);
      std::fflush(stdout);
    }
  return 0;
}
