// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "mujoco_body.hpp"

#include <thermopower/io/input_error.hpp>

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <sstream>
#include <utility>

namespace thermopower::robot {
namespace {

constexpr double held_base_inertia = 1e8;  // kg and kg m2: it moves by nanometres
constexpr double longest_step_s = 1e-3;    // of the simulation; stiff gains need it

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPointer = std::unique_ptr<mjModel, DeleteModel>;
using DataPointer = std::unique_ptr<mjData, DeleteData>;

std::string read_whole(const std::string& path) {
  std::error_code status;
  if (std::filesystem::is_directory(path, status))
    throw io::InputError(path + ": is a directory; expected a robot as MJCF or URDF");
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw io::InputError(path + ": cannot be read: " + std::strerror(errno) +
                         "; expected a robot as MJCF or URDF");
  std::ostringstream text;
  text << file.rdbuf();
  if (text.str().empty())
    throw io::InputError(path + ": the file is empty; expected a robot as MJCF or URDF");
  return text.str();
}

bool has_root(const std::string& text, const char* root) {
  return std::regex_search(text, std::regex(std::string("<") + root + "[\\s>]"));
}

ModelPointer load_text(const std::string& text, std::string& error) {
  auto files = std::make_unique<mjVFS>();  // half a megabyte
  mj_defaultVFS(files.get());
  ModelPointer model;
  char said[1000] = "";
  if (mj_makeEmptyFileVFS(files.get(), "robot.xml", static_cast<int>(text.size())) >= 0) {
    std::memcpy(files->filedata[0], text.data(), text.size());
    model.reset(mj_loadXML("robot.xml", files.get(), said, sizeof said));
  }
  mj_deleteVFS(files.get());
  error = said;
  return model;
}

// The shapes of a file whose meshes are not at hand. The inertia stays where the file states it.
std::string without_meshes(std::string text) {
  for (const char* pattern :
       {"<mesh\\b[^>]*/>", "<texture\\b[^>]*/>", "<material\\b[^>]*/>", "<hfield\\b[^>]*/>",
        "<skin\\b[^>]*/>", "<geom\\b[^>]*\\bmesh\\s*=[^>]*/>", "\\smaterial\\s*=\\s*\"[^\"]*\""})
    text = std::regex_replace(text, std::regex(pattern), "");
  return text;
}

// A robot of URDF needs no shapes here.
std::string without_shapes(std::string text) {
  for (const char* name : {"visual", "collision", "transmission", "gazebo"}) {
    const std::string open = std::string("<") + name, close = std::string("</") + name + ">";
    for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at)) {
      const std::size_t end = text.find('>', at);
      if (end == std::string::npos) break;
      if (text[end - 1] == '/') {
        text.erase(at, end + 1 - at);
        continue;
      }
      const std::size_t last = text.find(close, at);
      if (last == std::string::npos) break;
      text.erase(at, last + close.size() - at);
    }
  }
  return text;
}

std::string name_of(const mjModel& model, int kind, int id) {
  const char* name = mj_id2name(&model, kind, id);
  return name == nullptr ? std::string() : std::string(name);
}

bool has_varying_friction(const JointDynamics& joint) {
  return joint.stribeck != 0.0 || joint.load_friction != 0.0 || joint.friction_slope != 0.0;
}

}  // namespace

struct MujocoBody::Parts {
  std::string file;
  bool urdf = false;
  ModelPointer model;
  Robot robot;
  std::vector<int> joint_id, qpos, dof;
  bool floating = false;
  std::vector<std::string> notes;

  void read(const std::string& name, const std::string& text, const char* path) {
    file = name;
    urdf = has_root(text, "robot");
    if (!urdf && !has_root(text, "mujoco"))
      throw io::InputError(name +
                           ": is not a robot; expected an MJCF file (<mujoco>) or a URDF file (<robot>)");
    std::string error;
    if (urdf) {
      model = load_text(without_shapes(text), error);
    } else {
      if (path != nullptr) {
        char said[1000] = "";
        model.reset(mj_loadXML(path, nullptr, said, sizeof said));
        error = said;
      } else {
        model = load_text(text, error);
      }
      if (!model) {
        std::string second;
        model = load_text(without_meshes(text), second);
        if (model)
          notes.push_back("meshes are left out, because MuJoCo says: " + error.substr(0, error.find('\n')));
      }
    }
    if (!model)
      throw io::InputError(name + ": MuJoCo " + std::string(mj_versionString()) + " says: " + error);
    describe(text);
  }

  void describe(const std::string& text) {
    const mjModel& m = *model;
    robot.name = m.names;  // the model's own stands first
    robot.mass_kg = 0.0;
    for (int b = 1; b < m.nbody; ++b) robot.mass_kg += m.body_mass[b];
    for (int j = 0; j < m.njnt; ++j) {
      if (m.jnt_type[j] == mjJNT_FREE) {
        if (m.jnt_qposadr[j] != 0) throw io::InputError(file + ": a second free body; expected one robot");
        floating = robot.floating_base = true;
        continue;
      }
      const std::string name = name_of(m, mjOBJ_JOINT, j);
      if (m.jnt_type[j] == mjJNT_BALL)
        throw io::InputError(file + ": joint " + io::excerpt(name) +
                             " is a ball joint; expected hinges and slides");
      Joint joint;
      joint.name = name.empty() ? "joint" + std::to_string(j) : name;
      joint.slides = m.jnt_type[j] == mjJNT_SLIDE;
      const int v = m.jnt_dofadr[j];
      joint.armature = m.dof_armature[v];
      joint.damping = m.dof_damping[v];
      joint.friction = m.dof_frictionloss[v];
      joint.stiffness = m.jnt_stiffness[j];
      joint.spring_rest = m.qpos_spring[m.jnt_qposadr[j]];
      if (m.jnt_limited[j] != 0) {
        joint.lower = m.jnt_range[2 * j];
        joint.upper = m.jnt_range[2 * j + 1];
      }
      for (int a = 0; a < m.nu; ++a) take_actuator(joint, a, j);
      joint_id.push_back(j);
      qpos.push_back(m.jnt_qposadr[j]);
      dof.push_back(v);
      robot.joints.push_back(joint);
    }
    if (robot.joints.empty()) throw io::InputError(file + ": has no joint; expected hinges or slides");
    if (urdf) read_efforts(text);
  }

  void take_actuator(Joint& joint, int a, int j) const {
    const mjModel& m = *model;
    if (m.actuator_trntype[a] != mjTRN_JOINT || m.actuator_trnid[2 * a] != j) return;
    joint.actuators.push_back(name_of(m, mjOBJ_ACTUATOR, a));
    const double gear = m.actuator_gear[6 * a], gain = m.actuator_gainprm[mjNGAIN * a];
    const double* bias = m.actuator_biasprm + mjNBIAS * a;
    const bool follows = m.actuator_biastype[a] == mjBIAS_AFFINE;
    if (follows && bias[1] != 0.0) joint.kp = -bias[1] * gear * gear;
    if (follows && bias[2] != 0.0) joint.kd = -bias[2] * gear * gear;
    if (follows && bias[1] != 0.0 && !(joint.kd == joint.kd)) joint.kd = 0.0;
    if (m.actuator_forcelimited[a] != 0)
      joint.effort_limit = std::fabs(gear) * m.actuator_forcerange[2 * a + 1];
    else if (!follows && m.actuator_ctrllimited[a] != 0)
      joint.effort_limit = std::fabs(gear * gain) * m.actuator_ctrlrange[2 * a + 1];
  }

  // MuJoCo leaves the efforts of <limit> out.
  void read_efforts(const std::string& text) {
    static const std::regex block("<joint\\b[^>]*\\bname\\s*=\\s*\"([^\"]*)\"[\\s\\S]*?</joint>"),
        effort("<limit\\b[^>]*\\beffort\\s*=\\s*\"([^\"]*)\"");
    for (std::sregex_iterator i(text.begin(), text.end(), block), end; i != end; ++i) {
      const std::string all = i->str(), name = (*i)[1];
      std::smatch found;
      if (!std::regex_search(all, found, effort)) continue;
      for (Joint& joint : robot.joints)
        if (joint.name == name) joint.effort_limit = std::strtod(found[1].str().c_str(), nullptr);
    }
  }

  void place_base(mjData& data, const Motion& motion, Eigen::Index row) const {
    if (!floating || motion.base_pose.rows() == 0) return;
    for (int k = 0; k < 7; ++k) data.qpos[k] = motion.base_pose(row, k);
    for (int k = 0; k < 6; ++k) {
      data.qvel[k] = motion.base_velocity.rows() > 0 ? motion.base_velocity(row, k) : 0.0;
      data.qacc[k] = motion.base_acceleration.rows() > 0 ? motion.base_acceleration(row, k) : 0.0;
    }
  }

  DataPointer fresh() const {
    DataPointer data(mj_makeData(model.get()));
    mj_resetData(model.get(), data.get());
    return data;
  }
};

MujocoBody::MujocoBody(const std::string& path) : parts_(std::make_unique<Parts>()) {
  parts_->read(path, read_whole(path), path.c_str());
}
MujocoBody::MujocoBody(const std::string& name, const std::string& text) : parts_(std::make_unique<Parts>()) {
  parts_->read(name, text, nullptr);
}
MujocoBody::~MujocoBody() = default;

const Robot& MujocoBody::robot() const { return parts_->robot; }
bool MujocoBody::is_urdf() const { return parts_->urdf; }
const std::vector<std::string>& MujocoBody::notes() const { return parts_->notes; }

BodyRows MujocoBody::ask(const Motion& motion) const {
  const mjModel& m = *parts_->model;
  const Eigen::Index rows = motion.position.rows(), joints = static_cast<Eigen::Index>(parts_->dof.size());
  BodyRows out;
  for (Eigen::MatrixXd* one : {&out.inertia, &out.torque, &out.gravity, &out.moment_a, &out.moment_b})
    one->resize(rows, joints);
  const DataPointer data = parts_->fresh();
  mjData& d = *data;
  std::vector<double> torque(static_cast<std::size_t>(m.nv));
  const double* g = m.opt.gravity;
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index j = 0; j < joints; ++j) {
      const std::size_t k = static_cast<std::size_t>(j);
      d.qpos[parts_->qpos[k]] = motion.position(row, j);
      d.qvel[parts_->dof[k]] = motion.velocity(row, j);
      d.qacc[parts_->dof[k]] = motion.acceleration(row, j);
    }
    parts_->place_base(d, motion, row);
    mj_kinematics(&m, &d);
    mj_comPos(&m, &d);
    mj_comVel(&m, &d);
    mj_crb(&m, &d);
    mj_rne(&m, &d, 1, torque.data());
    for (Eigen::Index j = 0; j < joints; ++j) {
      const std::size_t k = static_cast<std::size_t>(j);
      const int v = parts_->dof[k], id = parts_->joint_id[k], body = m.jnt_bodyid[id];
      out.inertia(row, j) = d.qM[m.dof_Madr[v]] - m.dof_armature[v];
      out.torque(row, j) = torque[static_cast<std::size_t>(v)];
      const double* axis = d.xaxis + 3 * id;
      const double mass = m.body_subtreemass[body];
      if (m.jnt_type[id] == mjJNT_SLIDE) {
        const double down = axis[0] * g[0] + axis[1] * g[1] + axis[2] * g[2];
        out.gravity(row, j) = -mass * down;
        out.moment_a(row, j) = -down;
        out.moment_b(row, j) = 0.0;
        continue;
      }
      double arm[3], cross[3];
      for (int c = 0; c < 3; ++c) arm[c] = d.subtree_com[3 * body + c] - d.xanchor[3 * id + c];
      mju_cross(cross, arm, g);
      out.gravity(row, j) = -mass * mju_dot3(axis, cross);
      // Two directions of the link, across the axis.
      double local[3] = {0.0, 0.0, 0.0}, first[3], second[3];
      const double* own = m.jnt_axis + 3 * id;
      local[std::fabs(own[0]) < 0.7 ? 0 : 1] = 1.0;
      mju_cross(first, own, local);
      mju_normalize3(first);
      mju_cross(second, own, first);
      for (int direction = 0; direction < 2; ++direction) {
        double world[3];
        mju_rotVecMat(world, direction == 0 ? first : second, d.xmat + 9 * body);
        // mju_rotVecMat multiplies by the matrix that takes the body's frame to the world's.
        mju_cross(cross, world, g);
        (direction == 0 ? out.moment_a : out.moment_b)(row, j) = -mju_dot3(axis, cross);
      }
    }
  }
  return out;
}

Eigen::MatrixXd MujocoBody::simulate(const Eigen::VectorXd& t_s, const Eigen::MatrixXd& target,
                                     const Eigen::MatrixXd& start, const std::vector<JointDynamics>& joints,
                                     const Motion& base) const {
  const ModelPointer copy(mj_copyModel(nullptr, parts_->model.get()));
  mjModel& m = *copy;
  const DataPointer data(mj_makeData(&m));
  mjData& d = *data;
  const Eigen::Index rows = t_s.size(), count = static_cast<Eigen::Index>(joints.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Constant(rows, count, std::numeric_limits<double>::quiet_NaN());
  if (rows == 0) return out;
  mj_resetData(&m, &d);
  m.opt.disableflags |= mjDSBL_CONTACT | mjDSBL_ACTUATION;
  m.opt.integrator = mjINT_EULER;
  std::vector<double> rigid(joints.size(), 0.0);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const int v = parts_->dof[k], id = parts_->joint_id[k];
    m.dof_armature[v] = joints[k].armature;
    m.dof_frictionloss[v] = joints[k].friction;
    // A friction of zero would be left out of the solver's constraints for good.
    if (has_varying_friction(joints[k])) m.dof_frictionloss[v] += 1e-9;
    m.jnt_stiffness[id] = 0.0;
    d.qpos[parts_->qpos[k]] = start(0, static_cast<Eigen::Index>(k));
    d.qvel[v] = start(1, static_cast<Eigen::Index>(k));
  }
  const bool moves = parts_->floating && base.base_pose.rows() == rows;
  if (parts_->floating)
    for (int v = 0; v < 6; ++v) m.dof_armature[v] = held_base_inertia;
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (moves) parts_->place_base(d, base, row);
    for (Eigen::Index j = 0; j < count; ++j) {
      const double q = d.qpos[parts_->qpos[static_cast<std::size_t>(j)]];
      if (!(std::fabs(q) < 1e3)) return out;
      out(row, j) = q;
    }
    if (row + 1 == rows) break;
    const double step = t_s[row + 1] - t_s[row];
    const int parts = std::max(1, static_cast<int>(std::ceil(step / longest_step_s - 1e-6)));
    m.opt.timestep = step / parts;
    // The position gain acts at the middle of the step: at its beginning, a stiff gain would look like less damping.
    for (std::size_t k = 0; k < joints.size(); ++k)
      m.dof_damping[parts_->dof[k]] =
          joints[k].damping + joints[k].effort_scale * (joints[k].kd + 0.5 * m.opt.timestep * joints[k].kp);
    for (int part = 0; part < parts; ++part) {
      const double now = t_s[row] + part * m.opt.timestep;
      for (std::size_t k = 0; k < joints.size(); ++k) {
        const JointDynamics& joint = joints[k];
        const Eigen::Index j = static_cast<Eigen::Index>(k);
        const int v = parts_->dof[k];
        const double q = d.qpos[parts_->qpos[k]], w = d.qvel[v];
        // The command that holds at a time `delay_s` ago.
        Eigen::Index at = row;
        const double sent = now - joint.delay_s + 1e-9;
        while (at > 0 && t_s[at] > sent) --at;
        const double command = joint.kp * (target(at, j) - q) - joint.kd * w;
        const double limited = std::clamp(command, -joint.limit, joint.limit);
        double effort = joint.effort_scale * (limited + joint.kd * w);  // the damping acts implicitly
        effort -= joint.bias + joint.stiffness * q + joint.drag * w * std::fabs(w);
        for (std::size_t i = 0; i + 2 < joint.ripple.size(); i += 3)
          effort -= joint.ripple[i + 1] * std::sin(joint.ripple[i] * q) +
                    joint.ripple[i + 2] * std::cos(joint.ripple[i] * q);
        if (has_varying_friction(joint))
          m.dof_frictionloss[v] =
              std::max(1e-9, joint.friction + joint.friction_slope * (q - joint.friction_middle) +
                                 joint.stribeck * std::exp(-std::fabs(w) / joint.stribeck_rate) +
                                 joint.load_friction * std::fabs(rigid[k]));
        d.qfrc_applied[v] = effort;
      }
      mj_step1(&m, &d);
      for (std::size_t k = 0; k < joints.size(); ++k) {
        const JointDynamics& joint = joints[k];
        if (joint.gravity_error == 0.0 && joint.moment_a == 0.0 && joint.moment_b == 0.0) continue;
        const int id = parts_->joint_id[k], body = m.jnt_bodyid[id];
        if (m.jnt_type[id] == mjJNT_SLIDE) continue;
        const double* axis = d.xaxis + 3 * id;
        double arm[3], cross[3];
        for (int c = 0; c < 3; ++c) arm[c] = d.subtree_com[3 * body + c] - d.xanchor[3 * id + c];
        mju_cross(cross, arm, m.opt.gravity);
        double more = -joint.gravity_error * m.body_subtreemass[body] * mju_dot3(axis, cross);
        double local[3] = {0.0, 0.0, 0.0}, first[3], second[3];
        const double* own = m.jnt_axis + 3 * id;
        local[std::fabs(own[0]) < 0.7 ? 0 : 1] = 1.0;
        mju_cross(first, own, local);
        mju_normalize3(first);
        mju_cross(second, own, first);
        for (int direction = 0; direction < 2; ++direction) {
          double world[3];
          mju_rotVecMat(world, direction == 0 ? first : second, d.xmat + 9 * body);
          mju_cross(cross, world, m.opt.gravity);
          more -= (direction == 0 ? joint.moment_a : joint.moment_b) * mju_dot3(axis, cross);
        }
        d.qfrc_applied[parts_->dof[k]] -= more;
      }
      mj_step2(&m, &d);
      for (std::size_t k = 0; k < joints.size(); ++k) {
        const int v = parts_->dof[k];
        rigid[k] =
            d.qfrc_applied[v] + d.qfrc_passive[v] + d.qfrc_constraint[v] - m.dof_armature[v] * d.qacc[v];
      }
    }
  }
  return out;
}

Eigen::MatrixXd MujocoBody::place_of(const std::string& wanted, const std::string& name,
                                     const Eigen::MatrixXd& position, const Motion& base) const {
  const mjModel& m = *parts_->model;
  int kind = mjOBJ_SITE, id = -1;
  for (const auto& [one, word] :
       {std::pair<int, const char*>{mjOBJ_SITE, "site"}, {mjOBJ_GEOM, "geom"}, {mjOBJ_BODY, "body"}}) {
    if (!wanted.empty() && wanted != word) continue;
    id = mj_name2id(&m, one, name.c_str());
    kind = one;
    if (id >= 0) break;
  }
  if (id < 0) return {};
  const DataPointer data = parts_->fresh();
  Eigen::MatrixXd out(position.rows(), 3);
  for (Eigen::Index row = 0; row < position.rows(); ++row) {
    for (std::size_t k = 0; k < parts_->qpos.size(); ++k)
      data->qpos[parts_->qpos[k]] = position(row, static_cast<Eigen::Index>(k));
    parts_->place_base(*data, base, base.base_pose.rows() == position.rows() ? row : 0);
    mj_kinematics(&m, data.get());
    const double* at = (kind == mjOBJ_SITE   ? data->site_xpos
                        : kind == mjOBJ_GEOM ? data->geom_xpos
                                             : data->xpos) +
                       3 * id;
    out.row(row) << at[0], at[1], at[2];
  }
  return out;
}

LimbForces MujocoBody::upward_force(const Motion& motion) const {
  LimbForces forces;
  std::vector<int>& limb_of_joint = forces.limb_of_joint;
  Eigen::MatrixXd& out = forces.effort;
  const mjModel& m = *parts_->model;
  const std::size_t joints = parts_->dof.size();
  // A limb begins at a joint whose body hangs on the base or on the world.
  std::vector<int> limb_of_body(static_cast<std::size_t>(m.nbody), -1), root_joint;
  limb_of_joint.assign(joints, -1);
  for (int b = 1; b < m.nbody; ++b) {
    const int parent = m.body_parentid[b];
    int limb = limb_of_body[static_cast<std::size_t>(parent)];
    const bool hinged = m.body_jntnum[b] > 0 && m.jnt_type[m.body_jntadr[b]] != mjJNT_FREE;
    if (limb < 0 && hinged) {
      limb = static_cast<int>(root_joint.size());
      root_joint.push_back(m.body_jntadr[b]);
    }
    limb_of_body[static_cast<std::size_t>(b)] = limb;
  }
  for (std::size_t k = 0; k < joints; ++k)
    limb_of_joint[k] = limb_of_body[static_cast<std::size_t>(m.jnt_bodyid[parts_->joint_id[k]])];
  const DataPointer data = parts_->fresh();
  mj_kinematics(&m, data.get());
  std::vector<int> end(root_joint.size(), -1);
  std::vector<double> farthest(root_joint.size(), 0.0);
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const int limb = limb_of_body[static_cast<std::size_t>(m.geom_bodyid[geom])];
    if (limb < 0) continue;
    const std::size_t l = static_cast<std::size_t>(limb);
    const double away = mju_dist3(data->geom_xpos + 3 * geom, data->xanchor + 3 * root_joint[l]);
    if (away > farthest[l]) farthest[l] = away, end[l] = geom;
  }
  out = Eigen::MatrixXd::Zero(motion.position.rows(), static_cast<Eigen::Index>(joints));
  for (Eigen::Index row = 0; row < motion.position.rows(); ++row) {
    for (std::size_t k = 0; k < joints; ++k)
      data->qpos[parts_->qpos[k]] = motion.position(row, static_cast<Eigen::Index>(k));
    parts_->place_base(*data, motion, row);
    mj_kinematics(&m, data.get());
    for (std::size_t k = 0; k < joints; ++k) {
      const int limb = limb_of_joint[k], id = parts_->joint_id[k];
      if (limb < 0 || end[static_cast<std::size_t>(limb)] < 0 || m.jnt_type[id] != mjJNT_HINGE) continue;
      // Only what hangs on this joint moves with it.
      const int geom = end[static_cast<std::size_t>(limb)];
      int body = m.geom_bodyid[geom];
      while (body > 0 && body != m.jnt_bodyid[id]) body = m.body_parentid[body];
      if (body == 0) continue;
      double arm[3], cross[3];
      const double up[3] = {0.0, 0.0, 1.0};
      mju_sub3(arm, data->geom_xpos + 3 * geom, data->xanchor + 3 * id);
      mju_cross(cross, arm, up);
      out(row, static_cast<Eigen::Index>(k)) = -mju_dot3(data->xaxis + 3 * id, cross);
    }
  }
  return forces;
}

}  // namespace thermopower::robot
