// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/robot/impact.hpp>

#include <thermopower/plant/radians.hpp>
#include <thermopower/robot/table.hpp>

#include "replay.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <vector>

namespace thermopower::robot {
namespace {

// Takes one cause's numbers over from another set of constants.
void take(JointDynamics& to, const JointDynamics& from, Family family) {
  switch (family) {
    case Family::armature:
      to.armature = from.armature;
      break;
    case Family::damping:
      to.damping = from.damping;
      break;
    case Family::friction:
      to.friction = from.friction;
      break;
    case Family::constant:
      to.bias = from.bias;
      break;
    case Family::spring:
      to.stiffness = from.stiffness;
      to.bias = from.bias;
      break;
    case Family::gravity:
      to.gravity_error = from.gravity_error;
      break;
    case Family::imbalance:
      to.moment_a = from.moment_a;
      to.moment_b = from.moment_b;
      break;
    case Family::stribeck:
      to.stribeck = from.stribeck;
      to.stribeck_rate = from.stribeck_rate;
      break;
    case Family::load_friction:
      to.load_friction = from.load_friction;
      break;
    case Family::position_friction:
      to.friction_slope = from.friction_slope;
      to.friction_middle = from.friction_middle;
      break;
    case Family::drag:
      to.drag = from.drag;
      break;
    case Family::effort_scale:
      to.effort_scale = from.effort_scale;
      break;
    case Family::ripple:
      to.ripple = from.ripple;
      break;
  }
}

bool differ(const JointDynamics& a, const JointDynamics& b, Family family) {
  JointDynamics c = a;
  take(c, b, family);
  return c.armature != a.armature || c.damping != a.damping || c.friction != a.friction || c.bias != a.bias ||
         c.stiffness != a.stiffness || c.gravity_error != a.gravity_error || c.moment_a != a.moment_a ||
         c.moment_b != a.moment_b || c.stribeck != a.stribeck || c.load_friction != a.load_friction ||
         c.friction_slope != a.friction_slope || c.drag != a.drag || c.effort_scale != a.effort_scale ||
         c.ripple != a.ripple;
}

/// Error of simulated positions in what the user names.
class Measure {
public:
  Measure(const Body& body, const RobotDiagnosis& diagnosis, const Replay& replay, const std::string& of)
      : body_(body), diagnosis_(diagnosis), replay_(replay) {
    const std::size_t colon = of.find(':');
    kind_ = colon == std::string::npos ? "" : of.substr(0, colon);
    name_ = colon == std::string::npos ? of : of.substr(colon + 1);
    const std::string expected = "expected joint:NAME, body:NAME, site:NAME or geom:NAME";
    if (of.empty()) return;
    if (kind_ == "joint") {
      std::string names;
      for (std::size_t j = 0; j < diagnosis.robot.joints.size(); ++j) {
        names += (j == 0 ? "" : ", ") + diagnosis.robot.joints[j].name;
        if (diagnosis.robot.joints[j].name == name_) joint_ = static_cast<int>(j);
      }
      if (joint_ < 0) throw std::invalid_argument("the robot has no joint '" + name_ + "'; it has " + names);
      return;
    }
    if (kind_ != "body" && kind_ != "site" && kind_ != "geom")
      throw std::invalid_argument("'" + of + "' names nothing to measure; " + expected);
    measured_ = places(diagnosis.replayed.measured);
    if (measured_.rows() == 0) throw std::invalid_argument("the robot has no " + kind_ + " '" + name_ + "'");
  }

  const char* unit() const {
    const bool slides = joint_ >= 0 && diagnosis_.robot.joints[static_cast<std::size_t>(joint_)].slides;
    return measured_.rows() > 0 || slides ? "m" : "rad";
  }

  double error(const std::vector<JointDynamics>& joints) const {
    const Eigen::MatrixXd simulated = replay_.positions(joints);
    if (measured_.rows() > 0)
      return std::sqrt((places(simulated) - measured_).rowwise().squaredNorm().mean());
    const Eigen::MatrixXd error = simulated - diagnosis_.replayed.measured;
    return std::sqrt(joint_ >= 0 ? error.col(joint_).squaredNorm() / static_cast<double>(error.rows())
                                 : error.squaredNorm() / static_cast<double>(error.size()));
  }

private:
  Eigen::MatrixXd places(const Eigen::MatrixXd& position) const {
    Eigen::MatrixXd out(position.rows(), 3);
    for (const Stretch& one : diagnosis_.replayed.stretches) {
      const Eigen::MatrixXd part =
          body_.place_of(kind_, name_, position.middleRows(one.begin, one.rows()), replay_.base(one));
      if (part.rows() == 0) return {};
      out.middleRows(one.begin, one.rows()) = part;
    }
    return out;
  }

  const Body& body_;
  const RobotDiagnosis& diagnosis_;
  const Replay& replay_;
  std::string kind_, name_;
  int joint_ = -1;
  Eigen::MatrixXd measured_;
};

}  // namespace

Impact impact(const Body& body, const RobotDiagnosis& diagnosis, const std::string& of) {
  const std::size_t count = diagnosis.joints.size();
  std::vector<char> driven;
  bool any = false;
  for (const JointDiagnosis& joint : diagnosis.joints) {
    driven.push_back(std::isfinite(joint.tracking.before) ? 1 : 0);
    any = any || driven.back() != 0;
  }
  if (!any)
    throw std::invalid_argument(
        "nothing can be replayed: the log needs targets, and the joints need gains (--kp, --kd)");
  const Replay replay(body, diagnosis.replayed, driven);
  const Measure measure(body, diagnosis, replay, of);
  std::vector<JointDynamics> configured, found;
  for (const JointDiagnosis& joint : diagnosis.joints) {
    configured.push_back(joint.configured);
    found.push_back(joint.found);
  }
  Impact out;
  out.of = of;
  out.unit = measure.unit();
  out.configured = measure.error(configured);
  out.found = measure.error(found);
  for (const Stretch& one : diagnosis.replayed.stretches)
    out.replayed_s += diagnosis.replayed.step_s * static_cast<double>(one.rows());
  const double taken = out.configured - out.found;
  const auto add = [&](int joint, const std::string& cause, bool told, const std::vector<JointDynamics>& in,
                       const std::vector<JointDynamics>& without) {
    ImpactRow row;
    row.joint = joint;
    row.cause = cause;
    row.told = told;
    row.put_in = measure.error(in);
    row.taken_out = measure.error(without);
    row.share = 0.5 * (out.configured - row.put_in + row.taken_out - out.found) / taken;
    out.rows.push_back(row);
  };
  for (std::size_t j = 0; j < count; ++j) {
    if (driven[j] == 0) continue;
    const bool has_spring =
        differ(configured[j], found[j], Family::spring) && configured[j].stiffness != found[j].stiffness;
    for (std::size_t i = 0; i < family_count; ++i) {
      const auto family = static_cast<Family>(i);
      if (family == Family::constant && has_spring) continue;  // the spring's rest
      if (family == Family::spring && !has_spring) continue;
      if (!differ(configured[j], found[j], family)) continue;
      std::vector<JointDynamics> in = configured, without = found;
      take(in[j], found[j], family);
      take(without[j], configured[j], family);
      const auto& causes = diagnosis.joints[j].causes;
      const bool told =
          std::any_of(causes.begin(), causes.end(), [&](const Term& one) { return one.family == family; });
      add(static_cast<int>(j), to_string(family), told, in, without);
    }
  }
  std::vector<JointDynamics> in = configured, without = found;
  bool is_late = false;
  for (std::size_t j = 0; j < count; ++j) {
    is_late = is_late || configured[j].delay_s != found[j].delay_s;
    std::swap(in[j].delay_s, without[j].delay_s);
  }
  if (is_late) add(-1, "delay", true, in, without);
  std::sort(out.rows.begin(), out.rows.end(),
            [](const ImpactRow& a, const ImpactRow& b) { return a.share > b.share; });
  return out;
}

std::string impact_text(const RobotDiagnosis& diagnosis, const Impact& impact) {
  constexpr std::size_t most_rows = 20;
  const bool is_angle = impact.unit == "rad";
  const double factor = is_angle ? plant::deg_per_rad : 1000.0;
  const std::string unit = is_angle ? "deg" : "mm";
  const auto text = [&](double value) { return detail::number_text(factor * value); };
  std::string out = "What matters for " + (impact.of.empty() ? std::string("all joints") : impact.of) + ": " +
                    text(impact.configured) + " " + unit + " of error as configured, " + text(impact.found) +
                    " " + unit + " with all causes (" + detail::number_text(impact.replayed_s) +
                    " s of held-out targets replayed).\n\n";
  std::vector<std::vector<std::string>> rows{
      {"joint", "cause", "share", "error/" + unit + " with it alone", "without it alone"}};
  for (std::size_t i = 0; i < impact.rows.size() && i < most_rows; ++i) {
    const ImpactRow& row = impact.rows[i];
    rows.push_back({row.joint < 0 ? "all" : diagnosis.joints[static_cast<std::size_t>(row.joint)].name,
                    row.cause + (row.told ? "" : " (not told)"), detail::percent_text(row.share),
                    text(row.put_in), text(row.taken_out)});
  }
  out += detail::aligned(rows);
  if (impact.rows.size() > most_rows)
    out += std::to_string(impact.rows.size() - most_rows) + " more causes matter less.\n";
  return out +
         "\nShare: of the error that all causes take, the mean of what one takes first and what it takes last.\n";
}

}  // namespace thermopower::robot
