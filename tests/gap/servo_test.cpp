// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "plants.hpp"

#include <thermopower/gap/check_data.hpp>
#include <thermopower/gap/diagnose.hpp>

#include <algorithm>
#include <deque>

// Recordings that hold a servo's target and not its current. Joint and servo are stepped here, apart from the library's
// equations: the servo at its own period, its commands late by a delay, the joint fifty times in between.

using namespace thermopower::gap;

namespace {

struct Gains {
  double kp = 0.04, kd = 0.002, ki = 0.0, limit = 2.0, delay_s = 0.0;
  bool velocity = false;
};

struct Joint {
  double inertia = 1e-3, viscous = 1e-3, torque_constant = 0.2, coulomb_Nm = 0.0, gravity_Nm = 0.0;
};

constexpr double period_s = 0.005;

/// @param with_drive  the current is recorded, too
/// @param moving      the target is set anew for each sample of the servo, of which there are two in a row
Recording record(const Joint& joint, const Gains& servo, int rows, std::uint64_t seed,
                 bool with_drive = false, bool moving = false) {
  test::Noise noise(seed), faces(seed + 100);
  Recording r;
  r.name = "servo";
  r.t_s.resize(rows);
  Eigen::VectorXd target(rows), drive(rows), angle(rows), rate(rows);
  double theta = 0.0, omega = 0.0, sum = 0.0, command = 0.0, level = 0.0, acting = 0.0;
  std::deque<std::pair<double, double>> late;
  const double deg = 57.29577951308232;
  constexpr int samples = 2, steps = 50;  // of the servo in a row, of the joint in a sample
  for (int i = 0; i < rows; ++i) {
    r.t_s[i] = 0.01 * i;
    const double t = r.t_s[i];
    if (i % 60 == 0 && !moving) level = 8.0 * faces();
    const auto target_at = [&](double now_s) {
      return servo.velocity ? 10.0 * level * std::sin(0.9 * now_s) + 40.0 * std::sin(5.0 * now_s)
                            : level + 12.0 * std::sin(2.7 * now_s) + 5.0 * std::sin(7.1 * now_s + 1.0) +
                                  (moving ? 2.0 * std::sin(19.0 * now_s) + std::sin(31.0 * now_s) : 0.0);
    };
    target[i] = target_at(t);
    angle[i] = theta * deg + 0.02 * noise();
    rate[i] = omega * deg + 0.15 * noise();
    for (int k = 0; k < samples; ++k) {
      const double error =
          (moving ? target_at(t + k * period_s) : target[i]) - (servo.velocity ? omega : theta) * deg;
      sum += error * period_s;
      command = servo.kp * error + servo.ki * sum - (servo.velocity ? 0.0 : servo.kd * omega * deg);
      command = std::clamp(command, -servo.limit, servo.limit);
      late.emplace_back(t + k * period_s + servo.delay_s, command);
      if (k == 0) drive[i] = command;
      for (int n = 0; n < steps; ++n) {
        const double h = period_s / steps, now = t + k * period_s + n * h;
        while (!late.empty() && late.front().first <= now + 1e-9)
          acting = late.front().second, late.pop_front();
        const double push =
            joint.torque_constant * acting - joint.viscous * omega - joint.gravity_Nm * std::sin(theta + 0.5);
        const double next = omega + h * push / joint.inertia, brake = h * joint.coulomb_Nm / joint.inertia;
        omega = next > brake ? next - brake : next < -brake ? next + brake : 0.0;
        theta += h * omega;
      }
    }
  }
  r.set(servo.velocity ? "target_dps" : "target_deg", target);
  if (with_drive) r.set("drive_A", drive);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  return r;
}

Model model_with(const Gains& servo) {
  Model model;
  model.name = "servo";
  model.axis = RigidAxisModel{1e-3, 1e-3, 0.2};
  if (servo.velocity) model.servo = VelocityPiServo{servo.kp, servo.ki, servo.limit, period_s, servo.delay_s};
  else model.servo = PositionPidServo{servo.kp, servo.kd, servo.ki, servo.limit, period_s, servo.delay_s};
  return model;
}

Diagnosis diagnosed(const Model& model, const Joint& joint, const Gains& servo, bool with_drive = false) {
  Options options;
  options.effects_at_once = 1;
  return diagnose(model, {record(joint, servo, 1000, 3, with_drive)},
                  {record(joint, servo, 600, 8, with_drive)}, options);
}

const Cause* named(const Diagnosis& diagnosis, const std::string& id) {
  for (const Cause& one : diagnosis.cause)
    if (one.effect == id) return &one;
  return nullptr;
}

bool named_or_listed(const Diagnosis& diagnosis, const std::string& id) {
  for (const auto& alternative : diagnosis.alternatives)
    if (std::find(alternative.begin(), alternative.end(), id) != alternative.end()) return true;
  return named(diagnosis, id) != nullptr;
}

/// A gain of the augmented model as a stiffness or damping of the axis: what closed loops determine of it.
double per_inertia(const Diagnosis& diagnosis, const std::string& gain) {
  const Model& model = diagnosis.augmented;
  return model.get(gain) * model.get("torque_constant_Nm_per_A") / model.get("inertia_kgm2");
}

const std::vector<Gains>& five_gain_sets() {
  static const std::vector<Gains> sets{{0.04, 0.002, 0.0},
                                       {0.01, 0.0008, 0.0},
                                       {0.12, 0.004, 0.0},
                                       {0.05, 0.0025, 0.2},
                                       {0.03, 0.003, 0.05, 2.0, 0.006}};
  return sets;
}

}  // namespace

TEST_CASE("a servo that is as its file says has no gap, at any gains") {
  std::vector<Gains> sets = five_gain_sets();
  sets.push_back({0.004, 0.0, 0.02, 2.0, 0.0, true});
  for (const Gains& servo : sets) {
    const Diagnosis diagnosis = diagnosed(model_with(servo), {}, servo);
    INFO("kp " << servo.kp << ": " << diagnosis.reason);
    CHECK(test::holds(diagnosis));
    REQUIRE(diagnosis.gap.size() == 2);
    for (const GapScore& gap : diagnosis.gap) CHECK(gap.before < 1.15 * gap.noise_floor);
  }
}

TEST_CASE("a target that moves between the rows is read from the motion, and makes no gap of its own") {
  Joint rubbing;
  rubbing.coulomb_Nm = 0.012;
  for (const Gains& servo : {Gains{0.02, 0.001, 0.0}, Gains{0.04, 0.002, 0.0}, Gains{0.05, 0.0025, 0.2}}) {
    CAPTURE(servo.kp);
    const auto diagnosed_moving = [&](const Joint& joint) {
      Options options;
      options.effects_at_once = 1;
      return diagnose(model_with(servo), {record(joint, servo, 4000, 5, false, true)},
                      {record(joint, servo, 2000, 6, false, true)}, options);
    };
    const Diagnosis sound = diagnosed_moving({});
    INFO(sound.reason);
    CHECK(test::holds(sound));
    CHECK(sound.cause.empty());
    CHECK(std::count_if(sound.findings.begin(), sound.findings.end(), [](const Finding& finding) {
            return finding.kind == FindingKind::sampled_command;
          }) == 2);  // of either recording
    const Diagnosis rough = diagnosed_moving(rubbing);
    REQUIRE(rough.cause.size() == 1);
    CHECK(rough.cause.front().effect == "coulomb_friction");
  }
}

TEST_CASE("what is identified does not depend on the gains") {
  Joint rubbing;
  rubbing.coulomb_Nm = 0.012;
  Joint heavy;
  heavy.inertia = 1.5e-3;
  std::vector<Gains> sets = five_gain_sets();
#ifdef __SANITIZE_ADDRESS__
  sets.resize(
      2);  // each diagnosis takes half a minute there; what the others find they find without sanitizers
#endif
  for (const Gains& servo : sets) {
    INFO("kp " << servo.kp << ", ki " << servo.ki << ", delay " << servo.delay_s);
    const Diagnosis friction = diagnosed(model_with(servo), rubbing, servo);
    INFO(friction.reason);
    const Cause* coulomb = named(friction, "coulomb_friction");
    REQUIRE(coulomb != nullptr);
    CHECK(coulomb->parameters.front().value == Approx(0.012).epsilon(0.05));
    const Diagnosis inertia = diagnosed(model_with(servo), heavy, servo);
    INFO(inertia.reason);
    // A heavier axis and a weaker drive differ in the bearing's drag alone: what is determined is their ratio.
    CHECK((named_or_listed(inertia, "calibration.inertia") ||
           named_or_listed(inertia, "calibration.torque_constant")));
    CHECK(inertia.augmented.get("inertia_kgm2") / inertia.augmented.get("torque_constant_Nm_per_A") ==
          Approx(1.5e-3 / 0.2).epsilon(0.03));
  }
}

TEST_CASE("gains that are not those of the file, a delay and a limit are causes") {
  const Gains file;
  Gains stiff = file;
  stiff.kp *= 1.4;
  const Diagnosis kp = diagnosed(model_with(file), {}, stiff);
  INFO(kp.reason);
  REQUIRE(named(kp, "calibration.kp") != nullptr);
  CHECK(per_inertia(kp, "kp_A_per_deg") == Approx(stiff.kp * 0.2 / 1e-3).epsilon(0.02));

  Gains damped = file;
  damped.kd *= 0.6;
  const Diagnosis kd = diagnosed(model_with(file), {}, damped);
  INFO(kd.reason);
  REQUIRE(named(kd, "calibration.kd") != nullptr);
  CHECK(per_inertia(kd, "kd_A_s_per_deg") == Approx(damped.kd * 0.2 / 1e-3).epsilon(0.02));

  Gains slow = file;
  slow.delay_s = 0.013;
  const Diagnosis delay = diagnosed(model_with(file), {}, slow);
  INFO(delay.reason);
  const Cause* late = named(delay, "servo_delay");
  REQUIRE(late != nullptr);
  CHECK(late->parameters.front().value == Approx(0.013).margin(0.0005));
  REQUIRE_FALSE(delay.where.empty());
  CHECK(delay.where.front().submodel == Submodel::mechanical_drive);

  Gains weak = file;
  weak.limit = 0.15;
  const Diagnosis limit = diagnosed(model_with(file), {}, weak);
  INFO(limit.reason);
  const Cause* saturated = named(limit, "torque_saturation");
  REQUIRE(saturated != nullptr);
  CHECK(saturated->parameters.front().value == Approx(0.15).epsilon(0.05));
}

TEST_CASE("a joint too weak to follow its target is not said to be in radians") {
  Gains file;
  file.kp = 0.07;
  file.kd = 0.009;
  file.limit = 0.46;
  Joint heavy;
  heavy.inertia = 3.8e-3;
  heavy.viscous = 5.9e-3;
  Model model = model_with(file);
  model.axis = RigidAxisModel{heavy.inertia, heavy.viscous, heavy.torque_constant};
  for (const double limit_A : {0.01, 0.02, 0.03, 0.04, 0.05, 0.07}) {
    Gains weak = file;
    weak.limit = limit_A;
    INFO(limit_A << " A");
    const DataReport report =
        check_data(model, {record(heavy, weak, 1000, 3)}, {record(heavy, weak, 600, 8)});
    CHECK(deciding(report.findings) == nullptr);
  }
}

TEST_CASE("where the current is recorded it is the input, whatever the gains are") {
  Gains file, true_gains;
  file.kp *= 2.0;
  Gains each_row = true_gains;
  Recording train = record({}, each_row, 1500, 3, true), held_out = record({}, each_row, 900, 8, true);
  const Diagnosis diagnosis = diagnose(model_with(file), {train}, {held_out});
  for (const Cause& cause : diagnosis.cause) CHECK(cause.effect.find("kp") == std::string::npos);
  // The same without a servo in the file.
  Model bare = model_with(file);
  bare.servo = std::monostate();
  const Diagnosis open = diagnose(bare, {train}, {held_out});
  CHECK(open.verdict == diagnosis.verdict);
  REQUIRE(open.gap.size() == diagnosis.gap.size());
  for (std::size_t i = 0; i < open.gap.size(); ++i) CHECK(open.gap[i].before == diagnosis.gap[i].before);
}

namespace {

/// The same with the current measured, and not commanded: an output.
Recording measured(Recording recording, std::uint64_t seed) {
  test::Noise noise(seed);
  Eigen::VectorXd current = recording.column("drive_A");
  for (double& one : current) one += 0.004 * noise();
  recording.remove("drive_A");
  recording.set("current_A", current);
  return recording;
}

/// A joint whose bearing damps it under a servo without damping: its motion tells the product of gain and torque constant.
const Gains& proportional() {
  static const Gains gains{0.03, 0.0, 0.0};
  return gains;
}
Joint damped() {
  Joint joint;
  joint.viscous = 0.015;
  return joint;
}

Diagnosis diagnosed_by_effort(const Joint& joint, const Gains& servo, bool has_effort) {
  Model model = model_with(proportional());
  model.axis->viscous_Nms_per_rad = 0.015;
  model.uncertainty["axis.inertia_kgm2"] = 0.01;  // weighed: else motion tells the ratio of the two alone
  Options options;
  options.effects_at_once = 1;
  const auto recorded = [&](int rows, std::uint64_t seed) {
    Recording one = has_effort ? measured(record(joint, servo, rows, seed, true), seed + 7)
                               : record(joint, servo, rows, seed);
    one.t_s.array() +=
        10.5;  // where hundredths are no binary numbers: a sample is due at its row all the same
    return one;
  };
  return diagnose(model, {recorded(1500, 3)}, {recorded(800, 8)}, options);
}

}  // namespace

TEST_CASE("a measured effort is an output of a joint under a servo") {
  const Diagnosis sound = diagnosed_by_effort(damped(), proportional(), true);
  INFO(sound.reason);
  CHECK(test::holds(sound));
  CHECK(sound.cause.empty());
  REQUIRE(sound.gap.size() == 3);
  CHECK(std::count_if(sound.gap.begin(), sound.gap.end(), [](const GapScore& one) {
          return to_string(one.signal) == "current_A" && one.unit == "A";
        }) == 1);
  for (const GapScore& gap : sound.gap) CHECK(gap.before < 1.15 * gap.noise_floor);
}

TEST_CASE("a wrong gain and a wrong torque constant move a joint alike, and its effort tells them apart") {
  Joint strong = damped();
  strong.torque_constant *= 1.2;
  Gains stiff = proportional();
  stiff.kp *= 1.2;
  // The same motion from two truths: whichever constant it is laid to, one of the two is wrong.
  const Diagnosis of_strong = diagnosed_by_effort(strong, proportional(), false),
                  of_stiff = diagnosed_by_effort(damped(), stiff, false);
  for (const char* constant : {"torque_constant_Nm_per_A", "kp_A_per_deg"})
    CHECK(of_strong.augmented.get(constant) == Approx(of_stiff.augmented.get(constant)).epsilon(0.01));
  for (const bool of_drive : {true, false}) {
    CAPTURE(of_drive);
    const std::string cause = of_drive ? "calibration.torque_constant" : "calibration.kp",
                      other = of_drive ? "calibration.kp" : "calibration.torque_constant";
    const Joint joint = of_drive ? strong : damped();
    const Gains servo = of_drive ? proportional() : stiff;
    const Diagnosis both = diagnosed_by_effort(joint, servo, true);
    INFO("with the effort: " << both.reason);
    CHECK(named(both, cause) != nullptr);
    CHECK_FALSE(named_or_listed(both, other));
    CHECK(both.augmented.get(of_drive ? "torque_constant_Nm_per_A" : "kp_A_per_deg") ==
          Approx(1.2 * (of_drive ? 0.2 : 0.03)).epsilon(0.04));
    if (of_drive) continue;
    REQUIRE_FALSE(both.where.empty());
    CHECK(both.where.front().signal == Signal::current_A);
    CHECK(both.where.front().submodel == Submodel::mechanical_drive);
  }
}

TEST_CASE("friction is named and placed by the effort beside the motion") {
  Joint rubbing = damped();
  rubbing.coulomb_Nm = 0.03;
  const Diagnosis found = diagnosed_by_effort(rubbing, proportional(), true);
  INFO(found.reason);
  const Cause* coulomb = named(found, "coulomb_friction");
  REQUIRE(coulomb != nullptr);
  CHECK(coulomb->parameters.front().value == Approx(0.03).epsilon(0.05));
  REQUIRE_FALSE(found.where.empty());
  CHECK(found.where.front().submodel == Submodel::mechanical_friction);
}
