// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/simulator_export.hpp>

#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

namespace thermopower::io {
namespace {

constexpr double gravity_m_per_s2 = 9.81, quarter_turn_rad = 1.5707963267948966,
                 degrees_per_rad = 57.29577951308232;
// A mass off the axis adds to the inertia: it is put so near that this is a hundredth of it, and taken off again.
constexpr double share_of_inertia = 0.01;

std::string joint_number(double value) {
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

/// A servo as a simulator of bodies runs it, at every step.
struct DescribedServo {
  bool position = true;      // else it holds a rate
  double Nm_per_rad = 0.0;   // of a position servo
  double Nms_per_rad = 0.0;  // against the rate
  double largest_Nm = 0.0;
  std::vector<std::string> left_out;
};

struct Described {
  plant::JointDescription joint;
  const char* control = "A";  // unit of the drive
  std::optional<DescribedServo> servo;
  std::vector<std::string> left_out;
};

/// Makes a joint of a model: what its effects say of themselves, and what none of them can.
class JointReader {
public:
  JointReader(const Model& model, const Catalogue& catalogue) : model_(model), catalogue_(catalogue) {
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
    read_servo();
    if (model_.has_current() || model_.has_thermal())
      described_.left_out.push_back(
          "the motor's current and temperature: the drive has neither a winding nor a body that warms");
    return std::move(described_);
  }

private:
  void read_servo() {
    const double Nm_per_A = model_.axis->torque_constant_Nm_per_A;
    DescribedServo servo;
    const auto common = [&](const auto& one, double integral, const char* integral_name) {
      servo.largest_Nm = one.limit_A * std::fabs(Nm_per_A);
      const plant::JointDescription& joint = described_.joint;
      if (joint.largest_drive)
        servo.largest_Nm = std::fmin(servo.largest_Nm, *joint.largest_drive * std::fabs(joint.Nm_per_drive));
      if (integral != 0.0)
        servo.left_out.push_back("servo: " + std::string(integral_name) + " " + joint_number(integral) +
                                 "; MuJoCo's servo has no integral");
      servo.left_out.push_back("servo: period_s " + joint_number(one.period_s) + ", delay_s " +
                               joint_number(one.delay_s) + "; MuJoCo's servo acts at every step and at once");
      if (one.slew_A_per_s > 0.0)
        servo.left_out.push_back("servo: slew_A_per_s " + joint_number(one.slew_A_per_s) +
                                 "; MuJoCo's servo changes its torque at once");
      if (joint.lag_s)
        servo.left_out.push_back("drive_lag: lag_s " + joint_number(*joint.lag_s) +
                                 "; the torque of MuJoCo's servo follows at once");
    };
    if (const auto* position = std::get_if<plant::PositionPidServo>(&model_.servo)) {
      servo.Nm_per_rad = position->kp_A_per_deg * degrees_per_rad * Nm_per_A;
      servo.Nms_per_rad = position->kd_A_s_per_deg * degrees_per_rad * Nm_per_A;
      common(*position, position->ki_A_per_deg_s, "ki_A_per_deg_s");
      if (position->dead_zone_deg > 0.0)
        servo.left_out.push_back("servo: dead_zone_deg " + joint_number(position->dead_zone_deg) +
                                 "; MuJoCo's servo acts on every error");
      if (position->profile_dps > 0.0)
        servo.left_out.push_back("servo: profile_dps " + joint_number(position->profile_dps) +
                                 ", profile_dps2 " + joint_number(position->profile_dps2) +
                                 "; move the control along it");
    } else if (const auto* velocity = std::get_if<plant::VelocityPiServo>(&model_.servo)) {
      servo.position = false;
      servo.Nms_per_rad = velocity->kp_A_s_per_deg * degrees_per_rad * Nm_per_A;
      common(*velocity, velocity->ki_A_per_deg, "ki_A_per_deg");
    } else {
      return;
    }
    described_.servo = std::move(servo);
  }

  void take(const std::string& id, const EffectParameters& given) {
    const CatalogueEntry* entry = catalogue_.find(id);
    if (entry == nullptr || entry->info.in_a_joint == nullptr) {
      std::string text = id + ":";
      for (const auto& [name, value] : given)
        text += (text.back() == ':' ? " " : ", ") + name + " " + joint_number(value);
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
        text += (text.back() == ':' ? " " : ", ") + parameters[i].name + " " + joint_number(values[i]);
      }
      described_.left_out.push_back(text + "; " + remark.text);
    }
    described_.joint.remarks.clear();
  }

  const Model& model_;
  const Catalogue& catalogue_;
  Described described_;
};

std::string comment(const std::string& origin, const std::string& control,
                    const std::vector<std::string>& left_out) {
  std::string text =
      "<!-- " + comment_text(origin) + "\n     Units: SI, radians; the control is " + control + ".";
  for (const std::string& one : left_out) text += "\n     Left out: " + comment_text(one);
  return text + " -->\n";
}

std::string inertial(double inertia, double mass, double x, double y) {
  const std::string one = joint_number(inertia);
  return "<inertial pos=\"" + joint_number(x) + " " + joint_number(y) + " 0\" mass=\"" + joint_number(mass) +
         "\" diaginertia=\"" + one + " " + one + " " + one + "\"/>";
}

// Geometry that one can see, without mass or contact.
const std::string seen = "contype=\"0\" conaffinity=\"0\" rgba=\"0.3 0.5 0.7 1\"";

std::string drive_actuator(const Model& model, const plant::JointDescription& joint,
                           const std::string& name) {
  std::string out;
  if (model.axis->voltage_driven()) {
    const std::string constant = joint_number(model.axis->torque_constant_Nm_per_A);
    out += "    <!-- Where MuJoCo has it, the same motor is <dcmotor name=\"drive\" joint=\"" +
           comment_text(name) + "\" motorconst=\"" + constant + " " + constant + "\" resistance=\"" +
           joint_number(model.axis->resistance_ohm) + "\"/> -->\n";
  }
  out += "    <general name=\"drive\" joint=\"" + name + "\" gear=\"1\" gaintype=\"fixed\" gainprm=\"" +
         joint_number(joint.Nm_per_drive) + "\"";
  if (joint.offset_Nm != 0.0 || joint.back_emf_Nms_per_rad > 0.0)
    out += " biastype=\"affine\" biasprm=\"" + joint_number(joint.offset_Nm) + " 0 " +
           joint_number(-joint.back_emf_Nms_per_rad) + "\"";
  if (joint.lag_s) out += " dyntype=\"filter\" dynprm=\"" + joint_number(*joint.lag_s) + "\"";
  if (joint.largest_drive)
    out += " ctrllimited=\"true\" ctrlrange=\"" + joint_number(-*joint.largest_drive) + " " +
           joint_number(*joint.largest_drive) + "\"";
  return out + "/>\n";
}

std::string servo_actuator(const DescribedServo& servo, const plant::JointDescription& joint,
                           const std::string& name) {
  const std::string limit = joint_number(servo.largest_Nm);
  std::string out = std::string("    <") + (servo.position ? "position" : "velocity") +
                    " name=\"servo\" joint=\"" + name + "\"";
  if (servo.position) out += " kp=\"" + joint_number(servo.Nm_per_rad) + "\"";
  out += " kv=\"" + joint_number(servo.Nms_per_rad) + "\" forcelimited=\"true\" forcerange=\"-" + limit +
         " " + limit + "\"/>\n";
  if (joint.offset_Nm != 0.0)
    out += "    <general name=\"constant_torque\" joint=\"" + name +
           "\" gaintype=\"fixed\" gainprm=\"0\" biastype=\"affine\" biasprm=\"" +
           joint_number(joint.offset_Nm) + " 0 0\"/>\n";
  return out;
}

}  // namespace

SimulatorFile mjcf(const Model& model, const std::string& origin, const Catalogue& catalogue) {
  const Described described = JointReader(model, catalogue).read();
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
  if (described.servo)
    file.left_out.insert(file.left_out.end(), described.servo->left_out.begin(),
                         described.servo->left_out.end());
  const std::string control = !described.servo            ? "the drive in " + std::string(described.control)
                              : described.servo->position ? "the servo's target in rad"
                                                          : "the servo's target in rad/s";
  const std::string name = attribute_text(model.name);
  std::string& out = file.text;
  out = comment(origin, control, file.left_out) + "<mujoco model=\"" + name + "\">\n";
  out += "  <compiler angle=\"radian\" inertiafromgeom=\"false\" boundmass=\"0\" boundinertia=\"0\"/>\n";
  out += "  <option timestep=\"0.0001\" gravity=\"0 " +
         joint_number(joint.imbalance ? -gravity_m_per_s2 : 0.0) + " 0\"/>\n";
  // Against the limit of a servo, what a motor at a voltage loses by its rate is outside: it is a damping of the joint.
  const double damping = joint.damping_Nms_per_rad + (described.servo ? joint.back_emf_Nms_per_rad : 0.0);
  out +=
      "  <worldbody>\n    <light pos=\"0 0 2\"/>\n    <geom type=\"cylinder\" size=\"0.03 0.02\" pos=\"0 0 -0.03\" " +
      seen + "/>\n    <body name=\"driven\">\n      <joint name=\"" + name +
      "\" type=\"hinge\" axis=\"0 0 1\" damping=\"" + joint_number(damping) + "\" frictionloss=\"" +
      joint_number(joint.friction_Nm) + "\"";
  // MuJoCo's own softness would turn dry friction into a viscous one up to several degrees a second. Two steps of
  // the simulation are the hardest that it takes, and it makes them of anything harder.
  if (joint.friction_Nm > 0.0)
    out += " solreffriction=\"0.0002 1\" solimpfriction=\"0.99 0.999 0.0001 0.5 2\"";
  if (joint.spring)
    out += " stiffness=\"" + joint_number(joint.spring->Nm_per_rad) + "\" springref=\"" +
           joint_number(joint.spring->centre_rad) + "\"";
  out +=
      "/>\n      <!-- In a model whose bodies already have an inertia about this axis, give the joint what is missing of it to " +
      joint_number(near) + " kg m^2 as armature. -->\n      " + inertial(about_centre, mass, x, y) +
      "\n      <geom type=\"capsule\" fromto=\"0 0 0 0.15 0 0\" size=\"0.012\" " + seen + "/>\n";
  if (joint.far_side) {
    const double reduced = near * far / (near + far), w = joint.far_side->rad_per_s;
    out +=
        "      <body name=\"far\">\n        <joint name=\"compliance\" type=\"hinge\" axis=\"0 0 1\" stiffness=\"" +
        joint_number(reduced * w * w) + "\" damping=\"" +
        joint_number(2.0 * joint.far_side->damping * w * reduced) + "\"/>\n        " +
        inertial(far, far, 0.0, 0.0) +
        "\n        <geom type=\"box\" size=\"0.02 0.02 0.02\" pos=\"0.17 0 0\" " + seen +
        "/>\n      </body>\n";
  }
  out +=
      "    </body>\n  </worldbody>\n  <actuator>\n" +
      (described.servo ? servo_actuator(*described.servo, joint, name) : drive_actuator(model, joint, name)) +
      "  </actuator>\n</mujoco>\n";
  return file;
}

SimulatorFile urdf(const Model& model, const std::string& origin, const Catalogue& catalogue) {
  const Described described = JointReader(model, catalogue).read();
  const plant::JointDescription& joint = described.joint;
  SimulatorFile file{{}, described.left_out};
  if (model.has_servo()) {
    std::string text = "servo:";
    for (const NamedConstant& one : model.constants())
      if (one.block == "servo")
        text += (text.back() == ':' ? " " : ", ") + one.name + " " + joint_number(one.value);
    file.left_out.push_back(text + "; URDF has no servo");
  }
  const std::string name = attribute_text(model.name);
  file.left_out.insert(file.left_out.begin(), std::string(described.control) +
                                                  " to N m: " + joint_number(joint.Nm_per_drive) +
                                                  "; a joint is driven by its torque");
  if (joint.back_emf_Nms_per_rad > 0.0)
    file.left_out.push_back(
        "a motor at a voltage: what its counter-voltage takes is part of the damping here");
  if (joint.spring)
    file.left_out.push_back("a spring: Nm_per_rad " + joint_number(joint.spring->Nm_per_rad) +
                            ", centre_rad " + joint_number(joint.spring->centre_rad));
  if (joint.offset_Nm != 0.0)
    file.left_out.push_back("a constant torque: Nm " + joint_number(joint.offset_Nm));
  if (joint.lag_s) file.left_out.push_back("a drive that lags: lag_s " + joint_number(*joint.lag_s));
  if (joint.imbalance)
    file.left_out.push_back("an imbalance: Nm " + joint_number(joint.imbalance->Nm) + ", phase_rad " +
                            joint_number(joint.imbalance->phase_rad) + "; move the link's centre of mass");
  if (joint.far_side)
    file.left_out.push_back("a compliance: far_share " + joint_number(joint.far_side->share) + ", " +
                            joint_number(joint.far_side->rad_per_s) + " rad/s, damping " +
                            joint_number(joint.far_side->damping));
  const std::string one = joint_number(joint.inertia_kgm2);
  std::string& out = file.text;
  out =
      "<?xml version=\"1.0\"?>\n" +
      comment(origin, "the drive in " + std::string(described.control), file.left_out) + "<robot name=\"" +
      name +
      "\">\n  <link name=\"base\">\n    <visual><geometry><cylinder length=\"0.04\" radius=\"0.03\"/></geometry></visual>\n  </link>\n"
      "  <link name=\"driven\">\n    <visual><origin xyz=\"0.075 0 0\"/><geometry><box size=\"0.15 0.02 0.02\"/></geometry></visual>\n    <inertial>\n      <mass value=\"" +
      one + "\"/>\n      <inertia ixx=\"" + one + "\" ixy=\"0\" ixz=\"0\" iyy=\"" + one +
      "\" iyz=\"0\" izz=\"" + one + "\"/>\n    </inertial>\n  </link>\n  <joint name=\"" + name +
      "\" type=\"continuous\">\n    <parent link=\"base\"/>\n"
      "    <child link=\"driven\"/>\n    <axis xyz=\"0 0 1\"/>\n    <dynamics damping=\"" +
      joint_number(joint.damping_Nms_per_rad + joint.back_emf_Nms_per_rad) + "\" friction=\"" +
      joint_number(joint.friction_Nm) + "\"/>\n";
  if (joint.largest_drive)
    out += "    <limit effort=\"" + joint_number(std::fabs(*joint.largest_drive * joint.Nm_per_drive)) +
           "\" velocity=\"1e9\"/>\n";
  out += "  </joint>\n</robot>\n";
  return file;
}

}  // namespace thermopower::io
