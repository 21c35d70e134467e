// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a step of an axis here against a step of the same hinge in MuJoCo, on one core.
// Model:    J dw/dt = M_motor(t) - m g l sin(angle) - b w - M_friction: a body that hangs on a hinge with damping
//           and dry friction, and a motor whose torque changes in every step. MuJoCo's friction is a
//           constraint that it solves for in every evaluation, ours is a law with a creep, both as hard as they
//           can be at this step. Both approach the dry friction of the textbook, which is integrated here once more.
//           The hinges are driven at three to eight times their friction and rest only in passing. What a law with
//           a creep costs where a hinge sticks is printed for others, driven at little more than their friction.
// Method:   first both have to agree on where the hinges go; then a step is a step: Runge-Kutta against Runge-Kutta,
//           and MuJoCo's Euler (the damping is implicit, the angle follows the new rate) against the same.
#include "speed_timing.hpp"

#include <cstdio>

#if !defined(THERMOPOWER_HAS_MUJOCO)

bool speed::hinge() {
  std::printf("\nNo MuJoCo here (Debian: libmujoco-dev): the hinge is left out.\n");
  return true;
}

#else

#include <thermopower/simulation/gimbal_axis.hpp>
#include <thermopower/simulation/random.hpp>

#include "../mujoco_model.hpp"

#include <memory>
#include <string>

namespace speed {
namespace {

using namespace thermopower::simulation;

constexpr double step_s = 0.0008;  // a cycle of the board

struct Hinge {
  double inertia_kg_m2, weight_Nm, friction_Nm, viscous_Nm_s_per_rad, drive_Nm;
};

// Driven at so many times their friction.
std::vector<Hinge> draw_hinges(std::size_t count, double least, double most) {
  Random random(7);
  std::vector<Hinge> hinges;
  for (std::size_t i = 0; i < count; ++i) {
    Hinge one;
    one.inertia_kg_m2 = random.between(3e-4, 3e-3);
    one.weight_Nm = random.between(0.001, 0.01);
    one.friction_Nm = random.between(0.0005, 0.003);
    one.viscous_Nm_s_per_rad = random.between(2e-4, 1e-3);
    one.drive_Nm = one.friction_Nm * random.between(least, most);
    hinges.push_back(one);
  }
  return hinges;
}

// What the motors do, of their amplitude: read by all, so that nobody is timed computing it.
std::vector<double> draw_drive(std::size_t steps) {
  std::vector<double> drive;
  for (std::size_t i = 0; i < steps; ++i) {
    const double t = static_cast<double>(i) * step_s;
    drive.push_back(0.6 * std::sin(3.1 * t) + 0.4 * std::sin(11.0 * t + 1.0));
  }
  return drive;
}

enum class Rule { runge_kutta, euler };

class Mujoco {
public:
  Mujoco(const Hinge& hinge, Rule rule, const char* solver) {
    const double mass = 0.1, gravity = 9.81, arm = hinge.weight_Nm / (mass * gravity);
    const auto text = [](double x) {
      char digits[32];
      std::snprintf(digits, sizeof digits, "%.17g", x);
      return std::string(digits);
    };
    const std::string inertia = text(hinge.inertia_kg_m2 - mass * arm * arm);
    // Contacts are off and friction as hard as MuJoCo makes it at this step: the hinge needs no more.
    const std::string xml =
        "<mujoco><compiler angle=\"radian\"/><option timestep=\"" + text(step_s) + "\" gravity=\"0 0 -" +
        text(gravity) + "\" integrator=\"" + (rule == Rule::euler ? "Euler" : "RK4") + "\" solver=\"" +
        solver + "\"><flag contact=\"disable\"/></option><worldbody><body><inertial pos=\"0 0 -" + text(arm) +
        "\" mass=\"" + text(mass) + "\" diaginertia=\"" + inertia + " " + inertia + " " + inertia +
        "\"/><joint name=\"hinge\" type=\"hinge\" axis=\"0 1 0\" damping=\"" +
        text(hinge.viscous_Nm_s_per_rad) + "\" frictionloss=\"" + text(hinge.friction_Nm) +
        "\" solreffriction=\"0.0002 1\" solimpfriction=\"0.99 0.999 0.0001 0.5 2\"/></body></worldbody><actuator>"
        "<motor joint=\"hinge\"/></actuator></mujoco>";
    loaded_ = std::make_unique<test::MujocoModel>(xml);
    if (!is_loaded()) std::printf("  MuJoCo refuses the hinge: %s\n", loaded_->error.c_str());
  }

  bool is_loaded() const { return loaded_->data != nullptr; }
  double step(double motor_Nm) {
    loaded_->data->ctrl[0] = motor_Nm;
    mj_step(loaded_->model, loaded_->data);
    return loaded_->data->qpos[0];
  }

private:
  std::unique_ptr<test::MujocoModel> loaded_;
};

template <class Number>
struct Ours {
  using Real = typename thermopower::detail::Numeric<Number>::Real;
  using Axis = GimbalAxis<Number>;
  typename Axis::Config config;
  Number drive_Nm, zero;

  int parts;  // of a step: so much harder may the law of friction be

  // One hinge per lane, from `first` on.
  template <class Set>
  Ours(const std::vector<Hinge>& hinges, std::size_t first, std::size_t lanes, const Set& set,
       int step_parts = 1)
      : parts(step_parts) {
    zero = thermopower::detail::Numeric<Number>::constant(Real(0));
    config.hanging_rad = config.cable_Nm_per_rad = config.cable_rest_rad = config.cogging_Nm = zero;
    config.cogging_per_turn = config.friction.stribeck_rad_per_s = zero + Real(1);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Hinge& hinge = hinges[(first + lane) % hinges.size()];
      set(config.inertia_kg_m2, lane, hinge.inertia_kg_m2);
      set(config.imbalance_Nm, lane, hinge.weight_Nm);
      set(config.friction.coulomb_Nm, lane, hinge.friction_Nm);
      set(config.friction.breakaway_Nm, lane, hinge.friction_Nm);
      set(config.friction.creep_rad_per_s, lane, hinge.friction_Nm * step_s / parts / hinge.inertia_kg_m2);
      set(config.friction.viscous_Nm_s_per_rad, lane, hinge.viscous_Nm_s_per_rad);
      set(drive_Nm, lane, hinge.drive_Nm);
    }
  }

  // Calls `see(step, angle)` after every step.
  template <class See>
  void run(const std::vector<Real>& drive, Rule rule, const See& see) const {
    const Real h = static_cast<Real>(step_s / parts);
    if (rule == Rule::runge_kutta) {
      Axis axis(config, {zero, zero});
      for (std::size_t i = 0; i < drive.size(); ++i) {
        Number angle = zero;
        for (int part = 0; part < parts; ++part)
          angle = axis.step({Number(drive_Nm * drive[i]), zero, {zero, zero, zero}}, h).angle_rad;
        see(i, angle);
      }
      return;
    }
    const Axis axis(config, {zero, zero});
    const Number damped =
        config.inertia_kg_m2 / (config.inertia_kg_m2 + h * config.friction.viscous_Nm_s_per_rad) * h;
    Number angle = zero, rate = zero;
    for (std::size_t i = 0; i < drive.size(); ++i) {
      rate += damped * axis.acceleration(angle, rate, {Number(drive_Nm * drive[i]), zero, {zero, zero, zero}},
                                         Real(0));
      angle += h * rate;
      see(i, angle);
    }
  }
};

// What a step of one hinge is, in floating-point operations.
template <class Real>
Operations operations(const Hinge& hinge, Rule rule) {
  using Number = Counted<Real>;
  const Ours<Number> counted({hinge}, 0, 1,
                             [](Number& to, std::size_t, double from) { to = static_cast<Real>(from); });
  const auto after = [&](std::size_t steps) {
    Number::done = {};
    counted.run(std::vector<Real>(steps, Real(0.5)), rule, [](std::size_t, const Number&) {});
    return Number::done;
  };
  return after(2) - after(1);
}

Ours<double> single(const Hinge& hinge, int parts = 1) {
  return Ours<double>(
      {hinge}, 0, 1, [](double& to, std::size_t, double from) { to = from; }, parts);
}

template <class Real, int lane_count>
Ours<thermopower::Lanes<Real, lane_count> > block(const std::vector<Hinge>& hinges, std::size_t first) {
  using Number = thermopower::Lanes<Real, lane_count>;
  return Ours<Number>(hinges, first, static_cast<std::size_t>(lane_count),
                      [](Number& to, std::size_t lane, double from) {
                        to[static_cast<Eigen::Index>(lane)] = static_cast<Real>(from);
                      });
}

// Dry friction as the textbook has it, in steps of 8 us: what sticks does not move at all.
std::vector<double> textbook(const Hinge& hinge, const std::vector<double>& drive) {
  const int parts = 100;
  const double h = step_s / parts;
  double angle = 0.0, rate = 0.0;
  std::vector<double> angles;
  for (const double now : drive) {
    for (int part = 0; part < parts; ++part) {
      const double other =
          hinge.drive_Nm * now - hinge.weight_Nm * std::sin(angle) - hinge.viscous_Nm_s_per_rad * rate;
      const bool rests = rate == 0.0;
      if (rests && std::fabs(other) <= hinge.friction_Nm) continue;
      const double against = std::copysign(hinge.friction_Nm, rests ? other : rate);
      const double next = rate + h * (other - against) / hinge.inertia_kg_m2;
      rate = rate * next < 0.0 ? 0.0 : next;
      angle += h * rate;
    }
    angles.push_back(angle);
  }
  return angles;
}

double apart(const std::vector<double>& one, const std::vector<double>& other) {
  double largest = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) largest = std::fmax(largest, std::fabs(one[i] - other[i]));
  return largest;
}

std::vector<double> by_mujoco(const Hinge& hinge, const std::vector<double>& drive, Rule rule,
                              const char* solver) {
  Mujoco mujoco(hinge, rule, solver);
  std::vector<double> angles;
  if (mujoco.is_loaded())
    for (const double now : drive) angles.push_back(mujoco.step(hinge.drive_Nm * now));
  return angles;
}

constexpr double allowed = 0.01;          // of the travel
constexpr std::size_t step_count = 6250;  // five seconds

// How far apart the angles are, of the travel. @return whether that is little
bool agree(Rule rule, const char* name, const std::vector<Hinge>& hinges) {
  const std::size_t steps = step_count;
  const std::vector<double> drive = draw_drive(steps);
  const std::vector<float> drive_f(drive.begin(), drive.end());
  double largest = 0.0, ours_off = 0.0, mujoco_off = 0.0, float_off = 0.0, travel = 0.0;
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    const std::vector<double> theirs = by_mujoco(hinges[i], drive, rule, "Newton"),
                              exact = textbook(hinges[i], drive);
    if (theirs.empty()) return false;
    std::vector<double> ours(steps), ours_f(steps);
    block<double, 32>(hinges, i).run(drive, rule,
                                     [&](std::size_t at, const auto& angle) { ours[at] = angle[0]; });
    block<float, 64>(hinges, i).run(drive_f, rule, [&](std::size_t at, const auto& angle) {
      ours_f[at] = static_cast<double>(angle[0]);
    });
    const double way =
        *std::max_element(exact.begin(), exact.end()) - *std::min_element(exact.begin(), exact.end());
    largest = std::fmax(largest, apart(ours, theirs) / way);
    float_off = std::fmax(float_off, apart(ours_f, theirs) / way);
    ours_off = std::fmax(ours_off, apart(ours, exact) / way);
    mujoco_off = std::fmax(mujoco_off, apart(theirs, exact) / way);
    travel += way / static_cast<double>(hinges.size());
  }
  std::printf("  %-22s %10.2f %18.2f %18.2f %18.2f %18.2f\n", name, travel, 100.0 * largest,
              100.0 * float_off, 100.0 * ours_off, 100.0 * mujoco_off);
  return std::fmax(largest, float_off) < allowed;
}

// How far the angles of one axis are from the textbook's, of the travel, in steps cut into parts: the worst of all hinges.
double off_in_parts(int parts, const std::vector<Hinge>& hinges) {
  const std::vector<double> drive = draw_drive(step_count);
  double worst = 0.0;
  for (const Hinge& hinge : hinges) {
    const std::vector<double> exact = textbook(hinge, drive);
    std::vector<double> ours(step_count);
    single(hinge, parts).run(drive, Rule::runge_kutta, [&](std::size_t at, double angle) {
      ours[at] = angle;
    });
    const double way =
        *std::max_element(exact.begin(), exact.end()) - *std::min_element(exact.begin(), exact.end());
    worst = std::fmax(worst, apart(ours, exact) / way);
  }
  return worst;
}

void measure(Rule rule, const char* name, const std::vector<Hinge>& hinges) {
  const std::size_t steps = step_count;
  const std::vector<double> drive = draw_drive(steps);
  const std::vector<float> drive_f(drive.begin(), drive.end());
  const std::size_t blocks = 8;
  volatile double keep = 0.0;
  const auto mujoco = [&](const char* solver) {
    auto model = std::make_shared<Mujoco>(hinges[0], rule, solver);
    return [&, model] {
      double angle = 0.0;
      for (const double now : drive) angle = model->step(hinges[0].drive_Nm * now);
      keep = angle;
    };
  };
  const auto ours_d = block<double, 32>(hinges, 0);
  const auto ours_f = block<float, 64>(hinges, 0);
  const Ours<double> alone = single(hinges[0]);
  // All lanes are wanted: of lanes that nobody reads the compiler computes nothing.
  const auto on_lanes = [&](const auto& some, const auto& torques) {
    return [&] {
      for (std::size_t i = 0; i < blocks; ++i)
        some.run(torques, rule, [&](std::size_t at, const auto& angle) {
          if (at + 1 == steps) keep = static_cast<double>(angle.sum());
        });
    };
  };
  const auto one_axis = [&] {
    alone.run(drive, rule, [&](std::size_t at, double angle) {
      if (at + 1 == steps) keep = angle;
    });
  };
  const auto needed_s = in_turns(
      9, {mujoco("Newton"), mujoco("PGS"), mujoco("CG"), one_axis, on_lanes(ours_d, drive),
          on_lanes(ours_f, drive_f), [] { multiply_adds<double>(); }, [] { multiply_adds<float>(); }});
  std::size_t fastest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (median(needed_s[i]) < median(needed_s[fastest])) fastest = i;
  const char* solvers[] = {"Newton", "PGS", "CG"};
  const double count = static_cast<double>(steps);
  const auto row = [&](const char* who, std::size_t at, double axes) {
    std::printf("  %-12s %-28s %14.3e %12.1fx", name, who, count * axes / median(needed_s[at]),
                median_ratio(needed_s[fastest], needed_s[at]) * axes);
  };
  const auto share = [&](std::size_t at, double axes, std::size_t peak_at, const Operations& each,
                         double peak) {
    std::printf(" %8.0f %% (of %.0f %%)\n",
                100.0 * median_ratio(needed_s[peak_at], needed_s[at]) * each.total() * axes * count / peak,
                100.0 * each.ceiling());
  };
  const std::string theirs = std::string("MuJoCo ") + mj_versionString() + ", " + solvers[fastest];
  const double axes_d = 32.0 * static_cast<double>(blocks), axes_f = 64.0 * static_cast<double>(blocks);
  row(theirs.c_str(), fastest, 1.0), std::printf("\n");
  row("ours, one axis, double", 3, 1.0), std::printf("\n");
  row("ours, 32 lanes, double", 4, axes_d);
  share(4, axes_d, 6, operations<double>(hinges[0], rule), multiply_adds_operations<double>());
  row("ours, 64 lanes, float", 5, axes_f);
  share(5, axes_f, 7, operations<float>(hinges[0], rule), multiply_adds_operations<float>());
}

}  // namespace

bool hinge() {
  const std::vector<Hinge> hinges = draw_hinges(24, 3.0, 8.0), sticking = draw_hinges(24, 1.3, 2.0);
  std::printf("\nA hinge with weight, damping, dry friction and a motor, steps of %g ms, 1 thread\n",
              step_s * 1e3);
  std::printf("  Largest difference of angle over 5 s, %% of the travel, worst of %zu hinges:\n",
              hinges.size());
  std::printf("  %-22s %10s %18s %18s %18s %18s\n", "", "travel/rad", "ours - MuJoCo", "float - MuJoCo",
              "ours - textbook", "MuJoCo - textbook");
  const bool runge_kutta = agree(Rule::runge_kutta, "Runge-Kutta", hinges),
             euler = agree(Rule::euler, "Euler", hinges);
  agree(Rule::runge_kutta, "(Runge-Kutta, sticking)", sticking);
  std::printf("  One axis in finer steps, off the textbook, %% of the travel:");
  for (const int parts : {1, 2, 4, 8})
    std::printf("  %.1f ms %.2f", 1e3 * step_s / parts, 100.0 * off_in_parts(parts, hinges));
  std::printf("\n");
  if (!runge_kutta || !euler) {
    std::printf("  More than %.0f %%: not the same system, and no speed is quoted.\n", 100.0 * allowed);
    return false;
  }
  std::printf("  %-12s %-28s %14s %13s %21s\n", "", "", "steps/s", "of MuJoCo's", "of the peak");
  measure(Rule::runge_kutta, "Runge-Kutta", hinges);
  measure(Rule::euler, "Euler", hinges);
  std::printf(
      "  In brackets: what multiply-add units alone could reach. A core with units for sums beside them can do "
      "more.\n");
  return true;
}

}  // namespace speed

#endif
