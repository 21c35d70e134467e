// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/simulator_export.hpp>

#include <charconv>
#include <cmath>
#include <optional>

namespace thermopower::io {
namespace {

constexpr double gravity_m_per_s2 = 9.81, quarter_turn_rad = 1.5707963267948966;
// A mass off the axis adds to the inertia: it is put so near that this is a hundredth of it, and taken off again.
constexpr double share_of_inertia = 0.01;

std::string number(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value == 0.0 ? 0.0 : value).ptr);
}

// A comment of XML must not hold two hyphens in a row, nor end in one; a name is one line.
std::string comment_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool hyphen = c == '-' && !out.empty() && out.back() == '-';
    if (hyphen) out += ' ';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

std::string attribute_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '"') out += "&quot;";
    else out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out.empty() ? "axis" : out;
}

/// What a joint and its drive are, as both formats may use it.
struct Joint {
  double inertia = 0.0, damping = 0.0, torque_constant = 0.0;
  double friction_Nm = 0.0;
  double back_emf_Nms_per_rad = 0.0;        // of a motor at a voltage
  const char* control = "A";                // unit of the drive
  std::optional<double> spring, spring_at;  // N m/rad, rad
  std::optional<double> constant_Nm, limit_A, lag_s;
  std::optional<double> imbalance_Nm, imbalance_rad;
  std::optional<double> far_share, spring_rad_per_s, spring_damping;
  std::vector<std::string> left_out;
};

class Reader {
public:
  explicit Reader(const Model& model) : model_(model) {
    if (!model.axis)
      throw InvalidInput("model '" + model.name +
                         "' has no axis: simulators of bodies have nothing to take from it");
    joint_.inertia = model.axis->inertia_kgm2;
    joint_.damping = model.axis->viscous_Nms_per_rad;
    joint_.torque_constant = model.axis->torque_constant_Nm_per_A;
    if (model.axis->voltage_driven()) {
      // Kt (u - Kt w) / R: a gain on the voltage, and a force against the rate.
      joint_.back_emf_Nms_per_rad =
          joint_.torque_constant * joint_.torque_constant / model.axis->resistance_ohm;
      joint_.torque_constant /= model.axis->resistance_ohm;
      joint_.control = "V";
    }
  }

  Joint read() {
    for (const auto& [id, parameters] : model_.effects) take(id, parameters);
    if (model_.has_servo()) {
      std::string text = "servo:";
      for (const NamedConstant& one : model_.constants())
        if (one.block == "servo")
          text += (text.back() == ':' ? " " : ", ") + one.name + " " + number(one.value);
      joint_.left_out.push_back(text + "; it is sampled, and belongs to the program that sets the control");
    }
    if (model_.has_current() || model_.has_thermal())
      joint_.left_out.push_back(
          "the motor's current and temperature: the drive has neither a winding nor a body that warms");
    return std::move(joint_);
  }

private:
  static double of(const EffectParameters& parameters, const char* name) {
    const auto found = parameters.find(name);
    return found == parameters.end() ? 0.0 : found->second;
  }

  void leave_out(const std::string& id, const EffectParameters& parameters, const std::string& why = {}) {
    std::string text = id + ":";
    for (const auto& [name, value] : parameters)
      text += (text.back() == ':' ? " " : ", ") + name + " " + number(value);
    joint_.left_out.push_back(text + (why.empty() ? "" : "; " + why));
  }

  void dry_friction(const std::string& id, const EffectParameters& p, double moving_Nm,
                    const std::string& more) {
    joint_.friction_Nm += moving_Nm;
    const double transition = of(p, "transition_rad_per_s");
    if (transition > 0.0)
      joint_.left_out.push_back(id + ": it turns over within transition_rad_per_s " + number(transition) +
                                "; here at rest at once");
    if (!more.empty()) joint_.left_out.push_back(id + ": " + more);
  }

  void take(const std::string& id, const EffectParameters& p) {
    if (id == "coulomb_friction") dry_friction(id, p, of(p, "Nm"), "");
    else if (id == "asymmetric_friction")
      dry_friction(id, p, 0.5 * (of(p, "forward_Nm") + of(p, "backward_Nm")),
                   "forward_Nm " + number(of(p, "forward_Nm")) + ", backward_Nm " +
                       number(of(p, "backward_Nm")) + "; here the mean of both in both directions");
    else if (id == "stribeck_friction")
      dry_friction(id, p, of(p, "Nm"),
                   "the rise near standstill: rise_Nm " + number(of(p, "rise_Nm")) + ", knee_rad_per_s " +
                       number(of(p, "knee_rad_per_s")));
    else if (id == "cable_spring") {
      joint_.spring = of(p, "Nm_per_rad");
      joint_.spring_at = of(p, "centre_rad");
    } else if (id == "constant_torque") joint_.constant_Nm = of(p, "Nm");
    else if (id == "torque_saturation")
      joint_.limit_A = of(p, "A") * (model_.axis->voltage_driven() ? model_.axis->resistance_ohm : 1.0);
    else if (id == "drive_lag") joint_.lag_s = of(p, "lag_s");
    else if (id == "imbalance" && of(p, "Nm") != 0.0) {
      joint_.imbalance_Nm = of(p, "Nm");
      joint_.imbalance_rad = of(p, "phase_rad");
    } else if (id == "compliance") {
      joint_.far_share = of(p, "far_share");
      joint_.spring_rad_per_s = 4.0 * quarter_turn_rad * of(p, "frequency_Hz");
      joint_.spring_damping = of(p, "damping");
    } else if (id == "actuation_delay")
      leave_out(id, p, "hold the control back by this time, in whole steps of the simulation");
    else leave_out(id, p);
  }

  const Model& model_;
  Joint joint_;
};

std::string comment(const std::string& origin, const std::string& unit,
                    const std::vector<std::string>& left_out) {
  std::string text =
      "<!-- " + comment_text(origin) + "\n     Units: SI, radians; the control is the drive in " + unit + ".";
  for (const std::string& one : left_out) text += "\n     Left out: " + comment_text(one);
  return text + " -->\n";
}

std::string inertial(double inertia, double mass, double x, double y) {
  const std::string one = number(inertia);
  return "<inertial pos=\"" + number(x) + " " + number(y) + " 0\" mass=\"" + number(mass) +
         "\" diaginertia=\"" + one + " " + one + " " + one + "\"/>";
}

}  // namespace

SimulatorFile mjcf(const Model& model, const std::string& origin) {
  const Joint joint = Reader(model).read();
  const double near = joint.inertia * (1.0 - joint.far_share.value_or(0.0)), far = joint.inertia - near;
  double mass = near, x = 0.0, y = 0.0, about_centre = near;
  if (joint.imbalance_Nm) {
    // Gravity along -y pulls a mass at the angle a with -m g l cos(theta + a): a = phase less a quarter turn.
    const double size = std::fabs(*joint.imbalance_Nm), turned = *joint.imbalance_Nm < 0.0 ? 2.0 : 0.0;
    const double radius = share_of_inertia * near * gravity_m_per_s2 / size;
    const double angle = *joint.imbalance_rad - quarter_turn_rad + turned * quarter_turn_rad;
    mass = size / (gravity_m_per_s2 * radius);
    x = radius * std::cos(angle);
    y = radius * std::sin(angle);
    about_centre = near - mass * radius * radius;
  }
  SimulatorFile file{{}, joint.left_out};
  std::string& out = file.text;
  out = comment(origin, joint.control, joint.left_out) + "<mujoco model=\"" + attribute_text(model.name) +
        "\">\n";
  out += "  <compiler angle=\"radian\" inertiafromgeom=\"false\" boundmass=\"0\" boundinertia=\"0\"/>\n";
  out += "  <option timestep=\"0.0001\" gravity=\"0 " + number(joint.imbalance_Nm ? -gravity_m_per_s2 : 0.0) +
         " 0\"/>\n";
  out +=
      "  <worldbody>\n    <body name=\"driven\">\n      <joint name=\"axis\" type=\"hinge\" axis=\"0 0 1\" damping=\"" +
      number(joint.damping) + "\" frictionloss=\"" + number(joint.friction_Nm) + "\"";
  // MuJoCo's own softness would turn dry friction into a viscous one up to several degrees a second. Two steps of
  // the simulation are the hardest that it takes, and it makes them of anything harder.
  if (joint.friction_Nm > 0.0)
    out += " solreffriction=\"0.0002 1\" solimpfriction=\"0.99 0.999 0.0001 0.5 2\"";
  if (joint.spring)
    out += " stiffness=\"" + number(*joint.spring) + "\" springref=\"" + number(*joint.spring_at) + "\"";
  out +=
      "/>\n      <!-- In a model whose bodies already have an inertia about this axis, give the joint what is missing of it to " +
      number(near) + " kg m^2 as armature. -->\n      " + inertial(about_centre, mass, x, y) + "\n";
  if (joint.far_share) {
    const double reduced = near * far / (near + far), w = *joint.spring_rad_per_s;
    out +=
        "      <body name=\"far\">\n        <joint name=\"compliance\" type=\"hinge\" axis=\"0 0 1\" stiffness=\"" +
        number(reduced * w * w) + "\" damping=\"" + number(2.0 * *joint.spring_damping * w * reduced) +
        "\"/>\n        " + inertial(far, far, 0.0, 0.0) + "\n      </body>\n";
  }
  out +=
      "    </body>\n  </worldbody>\n  <actuator>\n    <general name=\"drive\" joint=\"axis\" gear=\"1\" gaintype=\"fixed\" gainprm=\"" +
      number(joint.torque_constant) + "\"";
  if (joint.constant_Nm || joint.back_emf_Nms_per_rad > 0.0)
    out += " biastype=\"affine\" biasprm=\"" + number(joint.constant_Nm.value_or(0.0)) + " 0 " +
           number(-joint.back_emf_Nms_per_rad) + "\"";
  if (joint.lag_s) out += " dyntype=\"filter\" dynprm=\"" + number(*joint.lag_s) + "\"";
  if (joint.limit_A)
    out +=
        " ctrllimited=\"true\" ctrlrange=\"" + number(-*joint.limit_A) + " " + number(*joint.limit_A) + "\"";
  out += "/>\n  </actuator>\n</mujoco>\n";
  return file;
}

SimulatorFile urdf(const Model& model, const std::string& origin) {
  const Joint joint = Reader(model).read();
  SimulatorFile file{{}, joint.left_out};
  file.left_out.insert(file.left_out.begin(), std::string(joint.control) +
                                                  " to N m: " + number(joint.torque_constant) +
                                                  "; a joint is driven by its torque");
  if (joint.back_emf_Nms_per_rad > 0.0)
    file.left_out.push_back(
        "a motor at a voltage: what its counter-voltage takes is part of the damping here");
  if (joint.spring)
    file.left_out.push_back("cable_spring: Nm_per_rad " + number(*joint.spring) + ", centre_rad " +
                            number(*joint.spring_at));
  if (joint.constant_Nm) file.left_out.push_back("constant_torque: Nm " + number(*joint.constant_Nm));
  if (joint.lag_s) file.left_out.push_back("drive_lag: lag_s " + number(*joint.lag_s));
  if (joint.imbalance_Nm)
    file.left_out.push_back("imbalance: Nm " + number(*joint.imbalance_Nm) + ", phase_rad " +
                            number(*joint.imbalance_rad) + "; move the link's centre of mass");
  if (joint.far_share)
    file.left_out.push_back("compliance: far_share " + number(*joint.far_share) + ", " +
                            number(*joint.spring_rad_per_s) + " rad/s, damping " +
                            number(*joint.spring_damping));
  const std::string one = number(joint.inertia);
  std::string& out = file.text;
  out =
      "<?xml version=\"1.0\"?>\n" + comment(origin, joint.control, file.left_out) + "<robot name=\"" +
      attribute_text(model.name) +
      "\">\n  <link name=\"base\"/>\n  <link name=\"driven\">\n    <inertial>\n      <mass value=\"" + one +
      "\"/>\n      <inertia ixx=\"" + one + "\" ixy=\"0\" ixz=\"0\" iyy=\"" + one + "\" iyz=\"0\" izz=\"" +
      one +
      "\"/>\n    </inertial>\n  </link>\n  <joint name=\"axis\" type=\"continuous\">\n    <parent link=\"base\"/>\n"
      "    <child link=\"driven\"/>\n    <axis xyz=\"0 0 1\"/>\n    <dynamics damping=\"" +
      number(joint.damping + joint.back_emf_Nms_per_rad) + "\" friction=\"" + number(joint.friction_Nm) +
      "\"/>\n";
  if (joint.limit_A)
    out += "    <limit effort=\"" + number(std::fabs(*joint.limit_A * joint.torque_constant)) +
           "\" velocity=\"1e9\"/>\n";
  out += "  </joint>\n</robot>\n";
  return file;
}

}  // namespace thermopower::io
