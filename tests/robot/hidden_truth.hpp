// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/log.hpp>

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace test {

/// @brief Robots whose truth is known, moved by MuJoCo alone: its actuators, its friction, its springs, its integrator at a fifth of
/// a millisecond. Nothing of it comes from the library but the type of a log.
class HiddenTruth {
public:
  /// Constants of one joint as MuJoCo has them, and torques that are added to it.
  struct Constants {
    double armature = 0.01, damping = 0.2, friction = 0.2, stiffness = 0.0, kp = 30.0, kd = 1.5;
    double constant = 0.0, drag = 0.0, stribeck = 0.0, ripple = 0.0;
  };

  /// What differs from the model, in which joint.
  struct Effect {
    int joint = 0;
    std::string id;  ///< as reports have it
  };

  enum class Kind { arm, quadruped };

  /// Which effort a log holds in a row. The drives hold a target to the next row, so the effort jumps in each row.
  enum class Logged {
    after_jump,   ///< that of the row's own target, as a simulator writes it
    before_jump,  ///< that of the last target, as a drive's message has it that came before the new command
    averaged      ///< its mean since the last row, as from a filtered current
  };

  /// @param kind    which robot
  /// @param seed    of effects, sizes, targets and noise
  HiddenTruth(Kind kind, unsigned seed) : kind_(kind), random_(seed) {
    const int joints = kind == Kind::arm ? 6 : 12;
    for (int j = 0; j < joints; ++j) model_.push_back(usual(j));
    truth_ = model_;
    draw_effects();
  }

  /// The model that a user has: MJCF.
  std::string model() const { return mjcf(model_, true); }
  const std::vector<Effect>& effects() const { return effects_; }

  /// A log of the truth: targets and positions, and efforts where `with_effort`.
  ///
  /// The effort is what a drive believes: current times the torque constant of the model.
  thermopower::robot::Log log(bool with_effort, double duration_s = 20.0,
                              Logged logged = Logged::after_jump) {
    constexpr double row_s = 0.005;
    constexpr int parts = 25;
    const auto joints = static_cast<Eigen::Index>(truth_.size());
    const auto rows = static_cast<Eigen::Index>(duration_s / row_s);
    const std::unique_ptr<mjModel, void (*)(mjModel*)> model(load(mjcf(truth_, false)), mj_deleteModel);
    const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model.get()), mj_deleteData);
    mjModel& m = *model;
    mjData& d = *data;
    m.opt.timestep = row_s / parts;
    m.opt.integrator = mjINT_IMPLICIT;
    thermopower::robot::Log out;
    out.file = "hidden truth";
    out.begin = {0};
    out.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, row_s * static_cast<double>(rows - 1));
    out.position.resize(rows, joints);
    out.target.resize(rows, joints);
    if (with_effort) out.effort.resize(rows, joints);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (Eigen::Index j = 0; j < joints; ++j) {
      double amplitude[4], frequency[4], phase[4];
      for (int k = 0; k < 4; ++k) {
        amplitude[k] = 0.12 + 0.1 * uniform(random_);
        frequency[k] = 0.15 * std::pow(14.0, (k + uniform(random_)) / 4.0);
        phase[k] = 6.283 * uniform(random_);
      }
      for (Eigen::Index row = 0; row < rows; ++row) {
        double wave = middle(j);
        for (int k = 0; k < 4; ++k)
          wave += amplitude[k] * std::sin(6.283 * frequency[k] * out.t_s[row] + phase[k]);
        out.target(row, j) = wave;
      }
      d.qpos[j] = out.target(0, j);
    }
    mj_forward(&m, &d);
    std::vector<double> mean(truth_.size(), 0.0), last(truth_.size(), 0.0);
    for (Eigen::Index row = 0; row < rows; ++row) {
      for (Eigen::Index j = 0; j < joints; ++j) {
        d.ctrl[j] = out.target(row, j);
        out.position(row, j) = d.qpos[j] + 1e-4 * normal(random_);
      }
      for (int part = 0; part < parts; ++part) {
        for (Eigen::Index j = 0; j < joints; ++j) {
          const Constants& c = truth_[static_cast<std::size_t>(j)];
          const double w = d.qvel[j], q = d.qpos[j];
          d.qfrc_applied[j] = -c.constant - c.drag * w * std::fabs(w) -
                              c.stribeck * std::tanh(w / 0.01) * std::exp(-std::fabs(w) / 0.15) -
                              c.ripple * std::sin(24.0 * q);
        }
        mj_step(&m, &d);
        for (Eigen::Index j = 0; with_effort && j < joints; ++j) {
          const auto k = static_cast<std::size_t>(j);
          const double believed = d.actuator_force[j] * model_[k].kp / truth_[k].kp;
          if (part == 0) {
            const bool is_first = row == 0 || logged == Logged::after_jump;
            out.effort(row, j) = (is_first                        ? believed
                                  : logged == Logged::before_jump ? last[k]
                                                                  : mean[k] / parts) +
                                 0.01 * normal(random_);
            mean[k] = 0.0;
          }
          mean[k] += believed;
          last[k] = believed;
        }
      }
    }
    return out;
  }

private:
  static Constants usual(int) { return {}; }

  double middle(Eigen::Index j) const {
    if (kind_ == Kind::arm) return j == 1 ? 0.5 : j == 2 ? -0.8 : 0.1;
    return j % 3 == 0 ? 0.0 : j % 3 == 1 ? 0.7 : -1.5;
  }

  void draw_effects() {
    static const char* const ids[] = {"calibration.armature", "calibration.damping", "coulomb_friction",
                                      "cable_spring",         "calibration.effort",  "constant_torque",
                                      "stribeck_friction",    "quadratic_drag",      "cogging"};
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const int count = 1 + static_cast<int>(3.0 * uniform(random_));
    std::vector<int> joints;
    while (static_cast<int>(joints.size()) < count) {
      const int j = static_cast<int>(uniform(random_) * static_cast<double>(truth_.size()));
      if (std::find(joints.begin(), joints.end(), j) == joints.end()) joints.push_back(j);
    }
    for (const int j : joints) {
      const std::string id = ids[static_cast<int>(9.0 * uniform(random_))];
      Constants& c = truth_[static_cast<std::size_t>(j)];
      const double size = 1.0 + uniform(random_);
      if (id == "calibration.armature") c.armature += 0.03 * size;
      if (id == "calibration.damping") c.damping += 0.5 * size;
      if (id == "coulomb_friction") c.friction += 0.5 * size;
      if (id == "cable_spring") c.stiffness = 2.5 * size;
      if (id == "calibration.effort") c.kp *= 0.5 + 0.1 * size, c.kd *= 0.5 + 0.1 * size;
      if (id == "constant_torque") c.constant = 0.7 * size;
      if (id == "stribeck_friction") c.stribeck = 0.6 * size;
      if (id == "quadratic_drag") c.drag = 0.35 * size;
      if (id == "cogging") c.ripple = 0.5 * size;
      effects_.push_back({j, id});
    }
  }

  static mjModel* load(const std::string& text) {
    auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    char said[1000] = "";
    mjModel* model = nullptr;
    if (mj_makeEmptyFileVFS(files.get(), "truth.xml", static_cast<int>(text.size())) >= 0) {
      std::memcpy(files->filedata[0], text.data(), text.size());
      model = mj_loadXML("truth.xml", files.get(), said, sizeof said);
    }
    mj_deleteVFS(files.get());
    if (model == nullptr) throw std::runtime_error(said);
    return model;
  }

  // The user's model has a base that is free; the truth's hangs on a stand.
  std::string mjcf(const std::vector<Constants>& constants, bool is_model) const {
    std::ostringstream out, actuators;
    out << "<mujoco model=\"" << (kind_ == Kind::arm ? "arm" : "quadruped")
        << "\"><compiler angle=\"radian\" inertiafromgeom=\"true\"/><option gravity=\"0 0 -9.81\"/><default><geom "
           "contype=\"0\" conaffinity=\"0\"/></default><worldbody>\n";
    const auto joint = [&](const std::string& name, std::size_t j, const char* axis) {
      const Constants& c = constants[j];
      out << "<joint name=\"" << name << "\" axis=\"" << axis << "\" armature=\"" << c.armature
          << "\" damping=\"" << c.damping << "\" frictionloss=\"" << c.friction << "\" stiffness=\""
          << c.stiffness << "\" springref=\"0\"/>";
      actuators << "<general name=\"" << name << "\" joint=\"" << name << "\" gainprm=\"" << c.kp
                << "\" biastype=\"affine\" biasprm=\"0 " << -c.kp << ' ' << -c.kd << "\"/>\n";
    };
    const auto link = [&](double x, double y, double z, double mass) {
      out << "<geom type=\"capsule\" size=\"0.03\" fromto=\"0 0 0 " << x << ' ' << y << ' ' << z
          << "\" mass=\"" << mass << "\"/>\n";
    };
    if (kind_ == Kind::arm) {
      static const char* const axes[6] = {"0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"};
      static const double length[6] = {0.1, 0.3, 0.25, 0.1, 0.1, 0.08},
                          mass[6] = {2.0, 2.0, 1.2, 0.6, 0.5, 0.4};
      for (std::size_t j = 0; j < 6; ++j) {
        out << "<body name=\"link" << j + 1 << "\" pos=\"0 0 " << (j == 0 ? 0.0 : length[j - 1]) << "\">";
        joint("joint" + std::to_string(j + 1), j, axes[j]);
        link(j == 5 ? 0.05 : 0.0, 0, length[j], mass[j]);
      }
      for (int j = 0; j < 6; ++j) out << "</body>";
    } else {
      out << "<body name=\"trunk\" pos=\"0 0 1\">" << (is_model ? "<freejoint/>" : "")
          << "<geom type=\"box\" size=\"0.2 0.1 0.05\" mass=\"8\"/>\n";
      std::size_t j = 0;
      for (const char* leg : {"FL", "FR", "RL", "RR"}) {
        const std::string name = leg;
        const double x = name[0] == 'F' ? 0.2 : -0.2, y = name[1] == 'L' ? 0.1 : -0.1;
        out << "<body name=\"" << name << "_hip\" pos=\"" << x << ' ' << y << " 0\">";
        joint(name + "_hip_joint", j++, "1 0 0");
        link(0, y * 0.8, 0, 0.7);
        out << "<body name=\"" << name << "_thigh\" pos=\"0 " << y * 0.8 << " 0\">";
        joint(name + "_thigh_joint", j++, "0 1 0");
        link(0, 0, -0.21, 1.1);
        out << "<body name=\"" << name << "_calf\" pos=\"0 0 -0.21\">";
        joint(name + "_calf_joint", j++, "0 1 0");
        link(0, 0, -0.21, 0.4);
        out << "<site name=\"" << name << "_foot\" pos=\"0 0 -0.21\"/></body></body></body>";
      }
      out << "</body>";
    }
    out << "\n</worldbody><actuator>\n" << actuators.str() << "</actuator></mujoco>\n";
    return out.str();
  }

  Kind kind_;
  std::mt19937 random_;
  std::vector<Constants> model_, truth_;
  std::vector<Effect> effects_;
};

}  // namespace test
