// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "robot_file.hpp"

#include "file_source.hpp"

#include <thermopower/io/input_error.hpp>

#ifdef THERMOPOWER_HAS_TINYXML2

#include <tinyxml2.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <sstream>

namespace {

using Element = tinyxml2::XMLElement;
using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;
using Pose = Eigen::Isometry3d;

constexpr double gravity_mps2 = 9.81, pi = 3.14159265358979323846;

/// Mass with its inertia about its own centre, in the frame of whoever holds it.
struct Mass {
  double kg = 0.0;
  Vector centre = Vector::Zero();
  Matrix inertia = Matrix::Zero();
};

/// What a joint carries, seen from its axis.
struct Carried {
  double inertia = 0.0;
  Vector moment = Vector::Zero();  // kg m
  Vector axis = Vector::UnitZ();
  Vector point = Vector::Zero();

  void add(const Mass& mass, const Pose& at) {
    const Vector centre = at * mass.centre - point;
    const Vector across = centre - axis * axis.dot(centre);
    const Matrix turned = at.rotation() * mass.inertia * at.rotation().transpose();
    inertia += axis.dot(turned * axis) + mass.kg * across.squaredNorm();
    moment += mass.kg * across;
  }

  // Gravity turns with the joint: -Nm sin(angle + phase).
  void write_gravity(RobotJoint& joint) const {
    const Vector down(0.0, 0.0, -gravity_mps2);
    const double of_cos = axis.dot(moment.cross(down)), of_sin = axis.dot(axis.cross(moment).cross(down));
    joint.gravity_Nm = std::hypot(of_cos, of_sin);
    joint.gravity_phase_rad = std::atan2(0.0 - of_cos, 0.0 - of_sin);
  }
};

class File {
public:
  explicit File(const std::string& path) : path_(path) {
    thermopower::io::open_input(path, "a robot (MJCF or URDF)");
    if (document_.LoadFile(path.c_str()) != tinyxml2::XML_SUCCESS)
      throw thermopower::io::InputError(
          path + ":" + std::to_string(document_.ErrorLineNum()) +
          ": cannot be read as XML; expected MJCF (<mujoco>) or URDF (<robot>)");
  }
  const Element& root() const { return *document_.RootElement(); }
  bool has_root() const { return document_.RootElement() != nullptr; }
  [[noreturn]] void fail(const std::string& what) const {
    throw thermopower::io::InputError(path_ + ": " + what);
  }
  [[noreturn]] void fail(const Element& at, const std::string& what) const {
    throw thermopower::io::InputError(path_ + ":" + std::to_string(at.GetLineNum()) + ": <" + at.Name() +
                                      ">: " + what);
  }

  std::vector<double> numbers(const Element& element, const char* name, const char* text) const {
    std::vector<double> list;
    std::istringstream in(text);
    for (std::string word; in >> word;) {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (end == word.c_str() || *end != '\0' || !std::isfinite(value))
        fail(element, std::string(name) + " is '" + text + "'; expected finite numbers");
      list.push_back(value);
    }
    return list;
  }

private:
  std::string path_;
  tinyxml2::XMLDocument document_;
};

Vector vector_of(const std::vector<double>& values) { return {values[0], values[1], values[2]}; }

Matrix symmetric(double xx, double yy, double zz, double xy, double xz, double yz) {
  Matrix matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return matrix;
}

Matrix turned_by(const std::vector<double>& roll_pitch_yaw) {
  return (Eigen::AngleAxisd(roll_pitch_yaw[2], Vector::UnitZ()) *
          Eigen::AngleAxisd(roll_pitch_yaw[1], Vector::UnitY()) *
          Eigen::AngleAxisd(roll_pitch_yaw[0], Vector::UnitX()))
      .toRotationMatrix();
}

std::string named(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "none" : list;
}

class Urdf {
public:
  explicit Urdf(const File& file) : file_(file) {}

  RobotJoint read(const std::string& wanted) {
    std::vector<std::string> turning;
    const Element* found = nullptr;
    for (const Element* one = file_.root().FirstChildElement("joint"); one != nullptr;
         one = one->NextSiblingElement("joint")) {
      const std::string type = text(*one, "type");
      joints_[child(*one, "parent", "link")].push_back(one);
      of_child_[child(*one, "child", "link")] = one;
      if (type != "revolute" && type != "continuous") continue;
      turning.push_back(text(*one, "name"));
      if (wanted.empty() || turning.back() == wanted)
        found = found == nullptr || !wanted.empty() ? one : found;
    }
    if (found == nullptr)
      file_.fail(wanted.empty() ? std::string("no joint in it turns; expected a hinge")
                                : "there is no joint '" + wanted + "' that turns; found " + named(turning));
    if (wanted.empty() && turning.size() > 1)
      file_.fail("several joints turn; --joint says which one is meant: " + named(turning));
    RobotJoint joint;
    joint.name = text(*found, "name");
    Carried carried;
    const Pose at = world_of(*found);
    const Element* const axis = found->FirstChildElement("axis");
    carried.axis =
        at.rotation() *
        (axis != nullptr ? vector_of(three(*axis, "xyz", {1, 0, 0})) : Vector::UnitX()).normalized();
    carried.point = at.translation();
    add(child(*found, "child", "link"), at, carried, joint);
    joint.inertia_kgm2 = carried.inertia;
    carried.write_gravity(joint);
    if (const Element* const dynamics = found->FirstChildElement("dynamics")) {
      joint.viscous_Nms_per_rad = one_of(*dynamics, "damping", 0.0);
      joint.coulomb_Nm = one_of(*dynamics, "friction", 0.0);
    }
    if (const Element* const limit = found->FirstChildElement("limit"))
      if (const double effort = one_of(*limit, "effort", 0.0); effort > 0.0) joint.limit_Nm = effort;
    joint.remarks.push_back(
        "URDF says nothing of rotors: an armature, gear ratio squared times the rotor's inertia, comes on top of the inertia");
    return joint;
  }

private:
  static std::string text(const Element& element, const char* name) {
    const char* const value = element.Attribute(name);
    return value == nullptr ? std::string() : value;
  }
  static std::string child(const Element& element, const char* name, const char* attribute) {
    const Element* const found = element.FirstChildElement(name);
    return found == nullptr ? std::string() : text(*found, attribute);
  }
  std::vector<double> three(const Element& element, const char* name, std::vector<double> otherwise) const {
    const char* const value = element.Attribute(name);
    if (value == nullptr) return otherwise;
    std::vector<double> list = file_.numbers(element, name, value);
    if (list.size() != 3)
      file_.fail(element, std::string(name) + " has " + std::to_string(list.size()) + " numbers; expected 3");
    return list;
  }
  double one_of(const Element& element, const char* name, double otherwise) const {
    const char* const value = element.Attribute(name);
    if (value == nullptr) return otherwise;
    const std::vector<double> list = file_.numbers(element, name, value);
    if (list.size() != 1) file_.fail(element, std::string(name) + ": expected one number");
    return list[0];
  }
  Pose origin_of(const Element& element) const {
    Pose pose = Pose::Identity();
    if (const Element* const origin = element.FirstChildElement("origin")) {
      pose.translation() = vector_of(three(*origin, "xyz", {0, 0, 0}));
      pose.linear() = turned_by(three(*origin, "rpy", {0, 0, 0}));
    }
    return pose;
  }
  Pose world_of(const Element& joint, int depth = 0) const {
    if (depth > 256) file_.fail(joint, "its parents go round in a circle");
    const auto above = of_child_.find(child(joint, "parent", "link"));
    return above == of_child_.end() ? origin_of(joint)
                                    : world_of(*above->second, depth + 1) * origin_of(joint);
  }
  void add(const std::string& link, const Pose& at, Carried& carried, RobotJoint& joint) const {
    const Element* found = nullptr;
    for (const Element* one = file_.root().FirstChildElement("link"); one != nullptr;
         one = one->NextSiblingElement("link"))
      if (text(*one, "name") == link) found = one;
    if (found == nullptr) file_.fail("there is no link '" + link + "'");
    if (const Element* const inertial = found->FirstChildElement("inertial")) {
      Mass mass;
      const Pose own = origin_of(*inertial);
      if (const Element* const one = inertial->FirstChildElement("mass"))
        mass.kg = one_of(*one, "value", 0.0);
      if (const Element* const one = inertial->FirstChildElement("inertia")) {
        const auto of = [&](const char* name) { return one_of(*one, name, 0.0); };
        mass.inertia = own.rotation() *
                       symmetric(of("ixx"), of("iyy"), of("izz"), of("ixy"), of("ixz"), of("iyz")) *
                       own.rotation().transpose();
      }
      mass.centre = own.translation();
      carried.add(mass, at);
    } else {
      joint.remarks.push_back("link " + link + " has no <inertial>: it counts for nothing");
    }
    if (const auto below = joints_.find(link); below != joints_.end())
      for (const Element* const one : below->second)
        add(child(*one, "child", "link"), at * origin_of(*one), carried, joint);
  }

  const File& file_;
  std::map<std::string, std::vector<const Element*>> joints_;  // by parent
  std::map<std::string, const Element*> of_child_;
};

class Mjcf {
public:
  explicit Mjcf(const File& file) : file_(file) {
    for (const Element* one = file_.root().FirstChildElement("compiler"); one != nullptr;
         one = one->NextSiblingElement("compiler")) {
      if (const char* const angle = one->Attribute("angle")) degrees_ = std::strcmp(angle, "radian") != 0;
      if (one->Attribute("eulerseq") != nullptr && std::strcmp(one->Attribute("eulerseq"), "xyz") != 0)
        file_.fail(
            *one,
            "eulerseq other than xyz is not read; expected quaternions, or the file as MuJoCo saves it");
    }
    for (const Element* one = file_.root().FirstChildElement("option"); one != nullptr;
         one = one->NextSiblingElement("option"))
      if (one->Attribute("timestep") != nullptr)
        step_s_ = file_.numbers(*one, "timestep", one->Attribute("timestep"))[0];
    if (const Element* const top = file_.root().FirstChildElement("default")) read_defaults(*top, "");
  }

  RobotJoint read(const std::string& wanted) {
    const Element* const world = file_.root().FirstChildElement("worldbody");
    if (world == nullptr)
      file_.fail("no <worldbody>; an <include> is not followed: expected one file, as MuJoCo saves it");
    visit(*world, Pose::Identity(), "", wanted);
    if (found_ == nullptr)
      file_.fail(wanted.empty() ? std::string("no joint in it turns; expected a hinge")
                                : "there is no joint '" + wanted + "' that turns; found " + named(turning_));
    if (wanted.empty() && turning_.size() > 1)
      file_.fail("several joints turn; --joint says which one is meant: " + named(turning_));
    RobotJoint joint;
    joint.name = name_of(*found_);
    joint.step_s = step_s_;
    Carried carried;
    carried.axis = found_at_.rotation() *
                   vector_of(list(*found_, "joint", found_class_, "axis", {0, 0, 1})).normalized();
    carried.point = found_at_ * vector_of(list(*found_, "joint", found_class_, "pos", {0, 0, 0}));
    add(*found_body_, found_at_, found_class_, carried, joint);
    joint.inertia_kgm2 = carried.inertia + list(*found_, "joint", found_class_, "armature", {0})[0];
    joint.viscous_Nms_per_rad = list(*found_, "joint", found_class_, "damping", {0})[0];
    joint.coulomb_Nm = list(*found_, "joint", found_class_, "frictionloss", {0})[0];
    carried.write_gravity(joint);
    read_actuator(joint);
    return joint;
  }

private:
  using Attributes = std::map<std::string, std::string>;

  void read_defaults(const Element& element, const std::string& parent) {
    const char* const given = element.Attribute("class");
    const std::string name = given != nullptr ? given : "main";
    if (!parent.empty()) defaults_[name] = defaults_[parent];
    for (const Element* one = element.FirstChildElement(); one != nullptr; one = one->NextSiblingElement()) {
      if (std::strcmp(one->Name(), "default") == 0) continue;
      for (const tinyxml2::XMLAttribute* a = one->FirstAttribute(); a != nullptr; a = a->Next())
        defaults_[name][one->Name()][a->Name()] = a->Value();
    }
    for (const Element* one = element.FirstChildElement("default"); one != nullptr;
         one = one->NextSiblingElement("default"))
      read_defaults(*one, name);
  }

  // An attribute, or what the class of the element says of it.
  std::string text(const Element& element, const char* kind, const std::string& of_body,
                   const char* name) const {
    if (const char* const value = element.Attribute(name)) return value;
    const char* const own = element.Attribute("class");
    const auto found = defaults_.find(own != nullptr ? own : of_body.empty() ? "main" : of_body);
    if (found == defaults_.end()) return {};
    const auto of_kind = found->second.find(kind);
    if (of_kind == found->second.end()) return {};
    const auto value = of_kind->second.find(name);
    return value == of_kind->second.end() ? std::string() : value->second;
  }

  std::vector<double> list(const Element& element, const char* kind, const std::string& of_body,
                           const char* name, std::vector<double> otherwise) const {
    const std::string value = text(element, kind, of_body, name);
    if (value.empty()) return otherwise;
    std::vector<double> numbers = file_.numbers(element, name, value.c_str());
    if (numbers.size() < otherwise.size())
      file_.fail(element, std::string(name) + " has " + std::to_string(numbers.size()) +
                              " numbers; expected " + std::to_string(otherwise.size()));
    return numbers;
  }

  static std::string name_of(const Element& element) {
    const char* const name = element.Attribute("name");
    return name == nullptr ? "(line " + std::to_string(element.GetLineNum()) + ")" : name;
  }

  Pose pose_of(const Element& element, const char* kind, const std::string& of_body) const {
    Pose pose = Pose::Identity();
    pose.translation() = vector_of(list(element, kind, of_body, "pos", {0, 0, 0}));
    const double unit = degrees_ ? pi / 180.0 : 1.0;
    if (const std::string quat = text(element, kind, of_body, "quat"); !quat.empty()) {
      const std::vector<double> q = list(element, kind, of_body, "quat", {1, 0, 0, 0});
      pose.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    } else if (!text(element, kind, of_body, "euler").empty()) {
      const std::vector<double> e = list(element, kind, of_body, "euler", {0, 0, 0});
      pose.linear() =
          (Eigen::AngleAxisd(e[0] * unit, Vector::UnitX()) * Eigen::AngleAxisd(e[1] * unit, Vector::UnitY()) *
           Eigen::AngleAxisd(e[2] * unit, Vector::UnitZ()))
              .toRotationMatrix();
    } else if (!text(element, kind, of_body, "axisangle").empty()) {
      const std::vector<double> a = list(element, kind, of_body, "axisangle", {0, 0, 1, 0});
      pose.linear() = Eigen::AngleAxisd(a[3] * unit, vector_of(a).normalized()).toRotationMatrix();
    } else if (!text(element, kind, of_body, "zaxis").empty()) {
      pose.linear() = Eigen::Quaterniond::FromTwoVectors(
                          Vector::UnitZ(), vector_of(list(element, kind, of_body, "zaxis", {0, 0, 1})))
                          .toRotationMatrix();
    }
    return pose;
  }

  void visit(const Element& body, const Pose& at, const std::string& of_parent, const std::string& wanted) {
    for (const Element* one = body.FirstChildElement("body"); one != nullptr;
         one = one->NextSiblingElement("body")) {
      const char* const given = one->Attribute("childclass");
      const std::string of_body = given != nullptr ? given : of_parent;
      const Pose here = at * pose_of(*one, "body", "");
      for (const Element* joint = one->FirstChildElement("joint"); joint != nullptr;
           joint = joint->NextSiblingElement("joint")) {
        const std::string type = text(*joint, "joint", of_body, "type");
        if (!type.empty() && type != "hinge") continue;
        turning_.push_back(name_of(*joint));
        if (found_ != nullptr || (!wanted.empty() && turning_.back() != wanted)) continue;
        found_ = joint;
        found_body_ = one;
        found_at_ = here;
        found_class_ = of_body;
      }
      visit(*one, here, of_body, wanted);
    }
  }

  void add(const Element& body, const Pose& at, const std::string& of_body, Carried& carried,
           RobotJoint& joint) const {
    if (const Element* const inertial = body.FirstChildElement("inertial")) {
      Mass mass;
      const Pose own = pose_of(*inertial, "inertial", of_body);
      mass.kg = list(*inertial, "inertial", of_body, "mass", {0})[0];
      mass.centre = own.translation();
      Matrix inertia = Matrix::Zero();
      if (inertial->Attribute("fullinertia") != nullptr) {
        const std::vector<double> f = list(*inertial, "inertial", of_body, "fullinertia", {0, 0, 0, 0, 0, 0});
        inertia = symmetric(f[0], f[1], f[2], f[3], f[4], f[5]);
      } else {
        inertia = vector_of(list(*inertial, "inertial", of_body, "diaginertia", {0, 0, 0})).asDiagonal();
      }
      mass.inertia = own.rotation() * inertia * own.rotation().transpose();
      carried.add(mass, at);
    } else {
      for (const Element* geom = body.FirstChildElement("geom"); geom != nullptr;
           geom = geom->NextSiblingElement("geom"))
        add_geom(*geom, at, of_body, carried, joint);
    }
    for (const Element* one = body.FirstChildElement("body"); one != nullptr;
         one = one->NextSiblingElement("body")) {
      const char* const given = one->Attribute("childclass");
      add(*one, at * pose_of(*one, "body", ""), given != nullptr ? given : of_body, carried, joint);
    }
  }

  // A body without <inertial> weighs what its geometry weighs.
  void add_geom(const Element& geom, const Pose& at, const std::string& of_body, Carried& carried,
                RobotJoint& joint) const {
    const std::string type =
        text(geom, "geom", of_body, "type").empty() ? "sphere" : text(geom, "geom", of_body, "type");
    const std::vector<double> size = list(geom, "geom", of_body, "size", {0});
    Pose own = pose_of(geom, "geom", of_body);
    double half = size.size() > 1 ? size[1] : 0.0;
    if (!text(geom, "geom", of_body, "fromto").empty()) {
      const std::vector<double> ends = list(geom, "geom", of_body, "fromto", {0, 0, 0, 0, 0, 0});
      const Vector from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
      half = 0.5 * (to - from).norm();
      own.translation() = 0.5 * (from + to);
      own.linear() =
          Eigen::Quaterniond::FromTwoVectors(Vector::UnitZ(), (to - from).normalized()).toRotationMatrix();
    }
    const double r = size[0];
    double volume = 0.0;
    Vector unit = Vector::Zero();  // inertia of a unit of mass
    if (type == "sphere") {
      volume = 4.0 / 3.0 * pi * r * r * r;
      unit.setConstant(0.4 * r * r);
    } else if (type == "box" && size.size() >= 3) {
      volume = 8.0 * size[0] * size[1] * size[2];
      const double x = size[0] * size[0], y = size[1] * size[1], z = size[2] * size[2];
      unit = Vector(y + z, x + z, x + y) / 3.0;
    } else if (type == "cylinder") {
      volume = 2.0 * pi * r * r * half;
      const double across = r * r / 4.0 + half * half / 3.0;
      unit = Vector(across, across, 0.5 * r * r);
    } else if (type == "capsule") {
      const double tube = 2.0 * pi * r * r * half, ball = 4.0 / 3.0 * pi * r * r * r;
      volume = tube + ball;
      const double across =
          tube * (r * r / 4.0 + half * half / 3.0) + ball * (0.4 * r * r + half * half + 0.75 * half * r);
      unit = Vector(across, across, tube * 0.5 * r * r + ball * 0.4 * r * r) / volume;
    } else {
      joint.remarks.push_back(
          "the geometry '" + type + "' in line " + std::to_string(geom.GetLineNum()) +
          " is not weighed; give its body an <inertial>, or open the file in MuJoCo and save it");
      return;
    }
    const std::string given = text(geom, "geom", of_body, "mass");
    Mass mass;
    mass.kg = given.empty() ? volume * list(geom, "geom", of_body, "density", {1000.0})[0]
                            : list(geom, "geom", of_body, "mass", {0})[0];
    mass.centre = own.translation();
    mass.inertia = own.rotation() * Matrix(Vector(mass.kg * unit).asDiagonal()) * own.rotation().transpose();
    carried.add(mass, at);
  }

  void read_actuator(RobotJoint& joint) const {
    const Element* const actuators = file_.root().FirstChildElement("actuator");
    for (const Element* one = actuators == nullptr ? nullptr : actuators->FirstChildElement(); one != nullptr;
         one = one->NextSiblingElement()) {
      const char* const of = one->Attribute("joint");
      if (of == nullptr || joint.name != of) continue;
      const std::string kind = one->Name();
      const double gear = list(*one, kind.c_str(), "", "gear", {1})[0];
      const std::string limit = text(*one, kind.c_str(), "", "forcerange");
      if (!limit.empty()) joint.limit_Nm = list(*one, kind.c_str(), "", "forcerange", {0, 0})[1] * gear;
      if (kind == "motor") {
        joint.Nm_per_command = gear;
        const std::string control = text(*one, kind.c_str(), "", "ctrlrange");
        if (!joint.limit_Nm && !control.empty())
          joint.limit_Nm = list(*one, kind.c_str(), "", "ctrlrange", {0, 0})[1] * gear;
      } else if (kind == "position") {
        joint.kp_Nm_per_rad = list(*one, kind.c_str(), "", "kp", {1})[0];
        joint.kd_Nms_per_rad = list(*one, kind.c_str(), "", "kv", {0})[0];
      } else {
        joint.remarks.push_back("the actuator <" + kind + "> is not read; expected <motor> or <position>");
      }
    }
  }

  const File& file_;
  bool degrees_ = true;
  double step_s_ = 0.002;
  std::map<std::string, std::map<std::string, Attributes>> defaults_;
  std::vector<std::string> turning_;
  const Element *found_ = nullptr, *found_body_ = nullptr;
  Pose found_at_ = Pose::Identity();
  std::string found_class_;
};

}  // namespace

RobotJoint read_robot_joint(const std::string& path, const std::string& joint) {
  const File file(path);
  if (!file.has_root()) file.fail("holds no element; expected MJCF (<mujoco>) or URDF (<robot>)");
  const std::string root = file.root().Name();
  RobotJoint found;
  if (root == "mujoco") found = Mjcf(file).read(joint);
  else if (root == "robot") found = Urdf(file).read(joint);
  else file.fail("is XML that begins with <" + root + ">; expected MJCF (<mujoco>) or URDF (<robot>)");
  if (!(found.inertia_kgm2 > 0.0))
    file.fail("joint " + found.name +
              " carries no inertia; expected <inertial> in the bodies behind it, or --inertia");
  return found;
}

#else

RobotJoint read_robot_joint(const std::string& path, const std::string&) {
  throw thermopower::io::InputError(
      path +
      ": this program was built without TinyXML-2 (Debian: libtinyxml2-dev), which reads MJCF and URDF; --inertia and the other options describe a joint without it");
}

#endif
