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

struct Described {
  plant::JointDescription joint;
  const char* control = "A";  // unit of the drive
  std::vector<std::string> left_out;
};

/// Makes a joint of a model: what its effects say of themselves, and what none of them can.
class Reader {
public:
  Reader(const Model& model, const Catalogue& catalogue) : model_(model), catalogue_(catalogue) {
    if (!model.axis)
      throw InvalidInput("model '" + model.name +
                         "' has no axis: simulators of bodies have nothing to take from it");
    plant::JointDescription& joint = described_.joint;
    joint.inertia_kgm2 = model.axis->inertia_kgm2;
    joint.damping_Nms_per_rad = model.axis->viscous_Nms_per_rad;
    joint.Nm_per_drive = model.axis->torque_constant_Nm_per_A;
    if (model.axis->voltage_driven()) {
      // Kt (u - Kt w) / R: a gain on the voltage, and a force against the rate.
      joint.back_emf_Nms_per_rad = joint.Nm_per_drive * joint.Nm_per_drive / model.axis->resistance_ohm;
      joint.Nm_per_drive /= model.axis->resistance_ohm;
      joint.drive_per_A = model.axis->resistance_ohm;
      described_.control = "V";
    }
  }

  Described read() {
    for (const auto& [id, parameters] : model_.effects) take(id, parameters);
    if (model_.has_servo()) {
      std::string text = "servo:";
      for (const NamedConstant& one : model_.constants())
        if (one.block == "servo")
          text += (text.back() == ':' ? " " : ", ") + one.name + " " + number(one.value);
      described_.left_out.push_back(text +
                                    "; it is sampled, and belongs to the program that sets the control");
    }
    if (model_.has_current() || model_.has_thermal())
      described_.left_out.push_back(
          "the motor's current and temperature: the drive has neither a winding nor a body that warms");
    return std::move(described_);
  }

private:
  void take(const std::string& id, const EffectParameters& given) {
    const CatalogueEntry* entry = catalogue_.find(id);
    if (entry == nullptr || entry->info.in_a_joint == nullptr) {
      std::string text = id + ":";
      for (const auto& [name, value] : given)
        text += (text.back() == ':' ? " " : ", ") + name + " " + number(value);
      described_.left_out.push_back(std::move(text));
      return;
    }
    const std::vector<Parameter>& parameters = entry->info.parameters;
    std::vector<double> values;
    for (const Parameter& one : parameters) {
      const auto found = given.find(one.name);
      values.push_back(found != given.end() ? found->second : one.standard.value_or(0.0));
    }
    entry->info.in_a_joint(values.data(), described_.joint);
    for (const plant::JointRemark& remark : described_.joint.remarks) {
      std::string text = id + ":";
      for (const int place : remark.parameters) {
        const auto i = static_cast<std::size_t>(place);
        text += (text.back() == ':' ? " " : ", ") + parameters[i].name + " " + number(values[i]);
      }
      described_.left_out.push_back(text + "; " + remark.text);
    }
    described_.joint.remarks.clear();
  }

  const Model& model_;
  const Catalogue& catalogue_;
  Described described_;
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

SimulatorFile mjcf(const Model& model, const std::string& origin, const Catalogue& catalogue) {
  const Described described = Reader(model, catalogue).read();
  const plant::JointDescription& joint = described.joint;
  const double far = joint.far_side ? joint.inertia_kgm2 * joint.far_side->share : 0.0,
               near = joint.inertia_kgm2 - far;
  double mass = near, x = 0.0, y = 0.0, about_centre = near;
  if (joint.imbalance) {
    // Gravity along -y pulls a mass at the angle a with -m g l cos(theta + a): a = phase less a quarter turn.
    const double size = std::fabs(joint.imbalance->Nm), turned = joint.imbalance->Nm < 0.0 ? 2.0 : 0.0;
    const double radius = share_of_inertia * near * gravity_m_per_s2 / size;
    const double angle = joint.imbalance->phase_rad - quarter_turn_rad + turned * quarter_turn_rad;
    mass = size / (gravity_m_per_s2 * radius);
    x = radius * std::cos(angle);
    y = radius * std::sin(angle);
    about_centre = near - mass * radius * radius;
  }
  SimulatorFile file{{}, described.left_out};
  std::string& out = file.text;
  out = comment(origin, described.control, described.left_out) + "<mujoco model=\"" +
        attribute_text(model.name) + "\">\n";
  out += "  <compiler angle=\"radian\" inertiafromgeom=\"false\" boundmass=\"0\" boundinertia=\"0\"/>\n";
  out += "  <option timestep=\"0.0001\" gravity=\"0 " + number(joint.imbalance ? -gravity_m_per_s2 : 0.0) +
         " 0\"/>\n";
  out +=
      "  <worldbody>\n    <body name=\"driven\">\n      <joint name=\"axis\" type=\"hinge\" axis=\"0 0 1\" damping=\"" +
      number(joint.damping_Nms_per_rad) + "\" frictionloss=\"" + number(joint.friction_Nm) + "\"";
  // MuJoCo's own softness would turn dry friction into a viscous one up to several degrees a second. Two steps of
  // the simulation are the hardest that it takes, and it makes them of anything harder.
  if (joint.friction_Nm > 0.0)
    out += " solreffriction=\"0.0002 1\" solimpfriction=\"0.99 0.999 0.0001 0.5 2\"";
  if (joint.spring)
    out += " stiffness=\"" + number(joint.spring->Nm_per_rad) + "\" springref=\"" +
           number(joint.spring->centre_rad) + "\"";
  out +=
      "/>\n      <!-- In a model whose bodies already have an inertia about this axis, give the joint what is missing of it to " +
      number(near) + " kg m^2 as armature. -->\n      " + inertial(about_centre, mass, x, y) + "\n";
  if (joint.far_side) {
    const double reduced = near * far / (near + far), w = joint.far_side->rad_per_s;
    out +=
        "      <body name=\"far\">\n        <joint name=\"compliance\" type=\"hinge\" axis=\"0 0 1\" stiffness=\"" +
        number(reduced * w * w) + "\" damping=\"" + number(2.0 * joint.far_side->damping * w * reduced) +
        "\"/>\n        " + inertial(far, far, 0.0, 0.0) + "\n      </body>\n";
  }
  out +=
      "    </body>\n  </worldbody>\n  <actuator>\n    <general name=\"drive\" joint=\"axis\" gear=\"1\" gaintype=\"fixed\" gainprm=\"" +
      number(joint.Nm_per_drive) + "\"";
  if (joint.offset_Nm != 0.0 || joint.back_emf_Nms_per_rad > 0.0)
    out += " biastype=\"affine\" biasprm=\"" + number(joint.offset_Nm) + " 0 " +
           number(-joint.back_emf_Nms_per_rad) + "\"";
  if (joint.lag_s) out += " dyntype=\"filter\" dynprm=\"" + number(*joint.lag_s) + "\"";
  if (joint.largest_drive)
    out += " ctrllimited=\"true\" ctrlrange=\"" + number(-*joint.largest_drive) + " " +
           number(*joint.largest_drive) + "\"";
  out += "/>\n  </actuator>\n</mujoco>\n";
  return file;
}

SimulatorFile urdf(const Model& model, const std::string& origin, const Catalogue& catalogue) {
  const Described described = Reader(model, catalogue).read();
  const plant::JointDescription& joint = described.joint;
  SimulatorFile file{{}, described.left_out};
  file.left_out.insert(file.left_out.begin(), std::string(described.control) +
                                                  " to N m: " + number(joint.Nm_per_drive) +
                                                  "; a joint is driven by its torque");
  if (joint.back_emf_Nms_per_rad > 0.0)
    file.left_out.push_back(
        "a motor at a voltage: what its counter-voltage takes is part of the damping here");
  if (joint.spring)
    file.left_out.push_back("a spring: Nm_per_rad " + number(joint.spring->Nm_per_rad) + ", centre_rad " +
                            number(joint.spring->centre_rad));
  if (joint.offset_Nm != 0.0) file.left_out.push_back("a constant torque: Nm " + number(joint.offset_Nm));
  if (joint.lag_s) file.left_out.push_back("a drive that lags: lag_s " + number(*joint.lag_s));
  if (joint.imbalance)
    file.left_out.push_back("an imbalance: Nm " + number(joint.imbalance->Nm) + ", phase_rad " +
                            number(joint.imbalance->phase_rad) + "; move the link's centre of mass");
  if (joint.far_side)
    file.left_out.push_back("a compliance: far_share " + number(joint.far_side->share) + ", " +
                            number(joint.far_side->rad_per_s) + " rad/s, damping " +
                            number(joint.far_side->damping));
  const std::string one = number(joint.inertia_kgm2);
  std::string& out = file.text;
  out =
      "<?xml version=\"1.0\"?>\n" + comment(origin, described.control, file.left_out) + "<robot name=\"" +
      attribute_text(model.name) +
      "\">\n  <link name=\"base\"/>\n  <link name=\"driven\">\n    <inertial>\n      <mass value=\"" + one +
      "\"/>\n      <inertia ixx=\"" + one + "\" ixy=\"0\" ixz=\"0\" iyy=\"" + one + "\" iyz=\"0\" izz=\"" +
      one +
      "\"/>\n    </inertial>\n  </link>\n  <joint name=\"axis\" type=\"continuous\">\n    <parent link=\"base\"/>\n"
      "    <child link=\"driven\"/>\n    <axis xyz=\"0 0 1\"/>\n    <dynamics damping=\"" +
      number(joint.damping_Nms_per_rad + joint.back_emf_Nms_per_rad) + "\" friction=\"" +
      number(joint.friction_Nm) + "\"/>\n";
  if (joint.largest_drive)
    out += "    <limit effort=\"" + number(std::fabs(*joint.largest_drive * joint.Nm_per_drive)) +
           "\" velocity=\"1e9\"/>\n";
  out += "  </joint>\n</robot>\n";
  return file;
}

}  // namespace thermopower::io
