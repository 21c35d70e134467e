// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "robot_files.hpp"

#include <thermopower/robot/table.hpp>

#include <nlohmann/json.hpp>

#include <cmath>

namespace thermopower::robot {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no number for what is not known.
Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_of(const Gap& gap, const char* unit) {
  return {{"unit", unit},
          {"before", json_number(gap.before)},
          {"recalibrated", json_number(gap.recalibrated)},
          {"after", json_number(gap.after)}};
}

Json json_of(const Change& change) {
  return {{"name", change.name},
          {"unit", change.unit},
          {"from", json_number(change.from)},
          {"to", json_number(change.to)},
          {"standard_error", json_number(change.error)}};
}

Json json_of(const Term& term) {
  Json numbers = Json::array(), alike = Json::array();
  for (const Coefficient& one : term.numbers)
    numbers.push_back({{"name", one.name},
                       {"unit", one.unit},
                       {"value", json_number(one.value)},
                       {"standard_error", json_number(one.error)}});
  for (const Family one : term.predicts_alike) alike.push_back(to_string(one));
  return {{"effect", to_string(term.family)},
          {"effort_left_share", json_number(term.kept)},
          {"numbers", numbers},
          {"predicts_alike", alike}};
}

const char* quantity_word(Role role) {
  switch (role) {
    case Role::position:
      return "position";
    case Role::velocity:
      return "velocity";
    case Role::effort:
      return "effort";
    case Role::target:
      return "target";
    default:
      return "all";
  }
}

Json json_of(const std::vector<WiringFinding>& findings, const Robot& robot) {
  Json out = Json::array();
  for (const WiringFinding& one : findings) {
    Json joints = Json::array();
    for (const int j : one.joints) joints.push_back(robot.joints[static_cast<std::size_t>(j)].name);
    out.push_back({{"kind", to_string(one.fault)},
                   {"quantity", quantity_word(one.quantity)},
                   {"joints", joints},
                   {"number", json_number(one.number)},
                   {"action", one.mended ? "mended" : "none"},
                   {"text", one.text}});
  }
  return out;
}

}  // namespace

std::string robot_json(const RobotDiagnosis& robot) {
  Json out{{"format", "thermopower-robot-report/1"},
           {"robot", robot.robot.name},
           {"log", robot.log},
           {"rows", robot.rows},
           {"held_out_rows", robot.held_out_rows},
           {"step_s", json_number(robot.step_s)},
           {"filter_Hz", json_number(robot.cutoff_Hz)},
           {"effort", robot.effort_is_measured ? "measured" : "from_targets"},
           {"delay_s", json_number(robot.delay_s)},
           {"on_ground", robot.stands_on_ground},
           {"wiring", json_of(robot.wiring, robot.robot)},
           {"notes", robot.notes},
           {"tracking", json_of(robot.tracking, "rad")}};
  Json joints = Json::array();
  for (const JointDiagnosis& joint : robot.joints) {
    Json one{{"joint", joint.name}, {"verdict", to_string(joint.verdict)}};
    if (joint.verdict == JointVerdict::not_judged) {
      one["reason"] = joint.reason;
      joints.push_back(one);
      continue;
    }
    Json causes = Json::array(), changes = Json::array();
    for (const Term& term : joint.causes) causes.push_back(json_of(term));
    for (const Change& change : joint.changes) changes.push_back(json_of(change));
    one["cause"] = causes;
    one["changes"] = changes;
    one["effort_rms"] = json_number(joint.effort_rms);
    one["effort"] = json_of(joint.effort, "N m");
    one["tracking"] = json_of(joint.tracking, "rad");
    one["taken"] = joint.causes.empty() ? Json(nullptr) : json_number(share_taken(joint));
    if (joint.differs) one["differs"] = joint.difference;
    joints.push_back(one);
  }
  out["joints"] = joints;
  Json groups = Json::array();
  for (const GroupDiagnosis& group : robot.groups) {
    if (group.members.size() < 2) continue;
    Json members = Json::array(), different = Json::array(), causes = Json::array(), pooled = Json::array();
    for (const int one : group.members) members.push_back(robot.joints[static_cast<std::size_t>(one)].name);
    for (const int one : group.different)
      different.push_back(robot.joints[static_cast<std::size_t>(one)].name);
    for (const Family one : group.causes) causes.push_back(to_string(one));
    for (const Change& one : group.pooled)
      pooled.push_back({{"name", one.name},
                        {"unit", one.unit},
                        {"from", json_number(one.from)},
                        {"mean", json_number(one.to)},
                        {"spread", json_number(one.error)}});
    groups.push_back({{"name", group.name},
                      {"joints", members},
                      {"cause", causes},
                      {"numbers", pooled},
                      {"different", different}});
  }
  out["groups"] = groups;
  return out.dump(2) + "\n";
}

std::string impact_json(const RobotDiagnosis& robot, const Impact& impact) {
  Json causes = Json::array();
  for (const ImpactRow& row : impact.rows)
    causes.push_back({{"joint", row.joint < 0 ? Json(nullptr)
                                              : Json(robot.joints[static_cast<std::size_t>(row.joint)].name)},
                      {"cause", row.cause},
                      {"told", row.told},
                      {"share", json_number(row.share)},
                      {"with_it_alone", json_number(row.put_in)},
                      {"without_it_alone", json_number(row.taken_out)}});
  const Json out{{"format", "thermopower-robot-impact/1"},
                 {"robot", robot.robot.name},
                 {"log", robot.log},
                 {"of", impact.of.empty() ? Json(nullptr) : Json(impact.of)},
                 {"unit", impact.unit},
                 {"configured", json_number(impact.configured)},
                 {"with_all_causes", json_number(impact.found)},
                 {"replayed_s", json_number(impact.replayed_s)},
                 {"causes", causes}};
  return out.dump(1) + "\n";
}

}  // namespace thermopower::robot
