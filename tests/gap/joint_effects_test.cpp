// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "observe/late_axis.hpp"
#include "observe/sampled_axis.hpp"
#include "plants.hpp"

#include <thermopower/gap/diagnose.hpp>
#include <thermopower/gap/simulate.hpp>

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

// Bristles, the rise of friction near standstill, gears with play and slow drives, stepped here apart from the library's equations: each is found, and
// none is taken for its neighbour.

using namespace thermopower::gap;

namespace {

/// What is wrong with the joint; everything off by default.
struct Joint {
  double bristle_Nm = 0.0, bend_rad = 0.0;
  double coulomb_Nm = 0.0, rise_Nm = 0.0, knee_rad_per_s = 1.0, exponent = 2.0;
  double far_share = 0.0, gap_rad = 0.0;  ///< of the inertia, behind a gap between teeth
  double lag_s = 0.0;                     ///< of the torque behind its command, from no torque on
  double weight_Nm = 0.0;                 ///< of a load off the axis
  double cogs_Nm = 0.0;                   ///< 14 times a turn
};

constexpr double inertia = 1e-3, viscous = 1e-3, torque_constant = 0.2;

Recording record(const Joint& joint, int rows, std::uint64_t seed) {
  test::Noise noise(seed);
  Recording r;
  r.name = "joint";
  r.t_s.resize(rows);
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  double theta = 0.0, omega = 0.0, bent = 0.0, far_theta = 0.0, far_omega = 0.0, late_Nm = 0.0;
  const double near = inertia * (1.0 - joint.far_share), far = inertia * joint.far_share;
  for (int i = 0; i < rows; ++i) {
    const double t = 0.01 * i, phase = static_cast<double>(seed);
    r.t_s[i] = t;
    drive[i] = 0.10 * std::sin(2.1 * t + phase) + 0.08 * std::sin(5.3 * t + 1.0 + phase) +
               0.05 * std::sin(11.0 * t) + 0.03 * std::sin(0.7 * t + 2.0 * phase);
    angle[i] = theta * 57.29577951308232 + 0.02 * noise();
    rate[i] = omega * 57.29577951308232 + 0.15 * noise();
    constexpr int steps = 500;
    for (int k = 0; k < steps; ++k) {
      const double h = 0.01 / steps;
      const double asked_Nm = torque_constant * drive[i];
      late_Nm += joint.lag_s > 0.0 ? h / joint.lag_s * (asked_Nm - late_Nm) : asked_Nm - late_Nm;
      double push = late_Nm - viscous * omega - joint.weight_Nm * std::sin(theta + 0.4) -
                    joint.cogs_Nm * std::sin(14.0 * theta);
      if (joint.bristle_Nm > 0.0) {
        bent += h * (omega - std::fabs(omega) * bent / joint.bend_rad);
        push -= joint.bristle_Nm * bent / joint.bend_rad;
      }
      if (far > 0.0) {
        // Teeth of steel on a soft shaft: they push and never pull.
        const double lead = theta - far_theta, way = lead < 0.0 ? -1.0 : 1.0;
        const double pressed = std::fabs(lead) - 0.5 * joint.gap_rad;
        const double tooth =
            pressed > 0.0 ? way * std::fmax(0.0, 4.0 * pressed + 0.004 * way * (omega - far_omega)) : 0.0;
        push -= tooth;
        far_omega += h * tooth / far;
        far_theta += h * far_omega;
      }
      const double rise =
          joint.rise_Nm * std::exp(-std::pow(std::fabs(omega) / joint.knee_rad_per_s, joint.exponent));
      const double next = omega + h * push / near, brake = h * (joint.coulomb_Nm + rise) / near;
      omega = next > brake ? next - brake : next < -brake ? next + brake : 0.0;
      theta += h * omega;
    }
  }
  r.set("drive_A", drive);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  return r;
}

Diagnosis diagnosed(const Joint& joint, int effects_at_once = 1) {
  Model model;
  model.name = "joint";
  model.axis = RigidAxisModel{inertia, viscous, torque_constant};
  Options options;
  options.effects_at_once = effects_at_once;
  return diagnose(model, {record(joint, 2000, 3)}, {record(joint, 1200, 8)}, options);
}

/// Sound recordings have no gap, and recordings with friction are explained by it. Returns both diagnoses, the sound one first.
/// @param recorded  (effect, 0 for training and 1 for held-out data) -> recording
template <class Recorded>
std::pair<Diagnosis, Diagnosis> check_sound_and_rough(Recorded&& recorded) {
  using Effect = test::SampledAxis::Effect;
  const auto of = [&](Effect effect) {
    return diagnose(test::SampledAxis::model(), {recorded(effect, 0)}, {recorded(effect, 1)});
  };
  const Diagnosis sound = of(Effect::none), rough = of(Effect::friction);
  CHECK(test::holds(sound));
  CHECK(rough.verdict == Verdict::explained);
  REQUIRE(rough.cause.size() == 1);
  CHECK(rough.cause.front().effect == "coulomb_friction");
  return {sound, rough};
}

/// How many findings of a kind there are.
std::ptrdiff_t count_of(const Diagnosis& diagnosis, FindingKind kind) {
  return std::count_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                       [&](const Finding& finding) { return finding.kind == kind; });
}

TEST_CASE("a loop of 1 kHz gets the same answer logged at 1 kHz, at 200 Hz, at 50 Hz and at 20 Hz") {
  using Effect = test::SampledAxis::Effect;
  const test::SampledAxis train(Effect::none, 30.0, 15), held_out(Effect::none, 20.0, 16),
      rough_train(Effect::friction, 30.0, 17), rough_held_out(Effect::friction, 20.0, 18);
  for (const int kept : {1, 5, 20, 50}) {
    CAPTURE(kept);
    const auto both = check_sound_and_rough([&](Effect effect, int part) {
      const bool is_rough = effect == Effect::friction;
      return (part == 0  ? is_rough ? rough_train : train
              : is_rough ? rough_held_out
                         : held_out)
          .logged_each(kept);
    });
    CHECK(count_of(both.second, FindingKind::sampled_command) == (kept > 1 ? 2 : 0));  // of either recording
  }
}

namespace {

/// A motor whose current does nothing inside a band, driven by a loop of 1 kHz that answers to its noisy sensors: its command
/// is another one in each row.
Recording dithered(double band_A, double length_s, std::uint64_t seed) {
  constexpr double period_s = 1e-3;
  const auto rows = static_cast<Eigen::Index>(length_s / period_s);
  test::Noise noise(seed);
  Recording r;
  r.name = "dithered";
  r.t_s.resize(rows);
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  double theta = 0.0, omega = 0.0;
  const double kept = std::exp(-viscous / inertia * period_s);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t = period_s * static_cast<double>(i), phase = static_cast<double>(seed);
    r.t_s[i] = t;
    drive[i] = 0.08 * std::sin(2.1 * t + phase) + 0.06 * std::sin(5.3 * t + 1.0) + 0.03 * noise();
    angle[i] = theta * 57.29577951308232 + 0.02 * noise();
    rate[i] = omega * 57.29577951308232 + 0.15 * noise();
    const double arrives_A = std::copysign(std::fmax(0.0, std::fabs(drive[i]) - band_A), drive[i]);
    const double final_rate = torque_constant * arrives_A / viscous;  // of a rate that nears it exponentially
    theta += final_rate * period_s + (omega - final_rate) * (1.0 - kept) * inertia / viscous;
    omega = final_rate + (omega - final_rate) * kept;
  }
  r.set("drive_A", drive);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  return r;
}

}  // namespace

TEST_CASE("a band is measured on the rows as they are, where their mean would smear it") {
  constexpr double band_A = 0.03;
  Model model;
  model.name = "joint";
  model.axis = RigidAxisModel{inertia, viscous, torque_constant};
  const Diagnosis diagnosis = diagnose(model, {dithered(band_A, 20.0, 3)}, {dithered(band_A, 12.0, 8)});
  CHECK(diagnosis.verdict == Verdict::explained);
  REQUIRE(diagnosis.cause.size() == 1);
  REQUIRE(diagnosis.cause.front().effect == "drive_deadband");
  CHECK(diagnosis.cause.front().probability > 0.95);
  const ParameterEstimate& band = diagnosis.cause.front().parameters.front();
  CHECK(band.value == Approx(band_A).epsilon(0.005));
  CHECK(band.ci95.low < band_A);
  CHECK(band.ci95.high > band_A);
  CHECK(diagnosis.ranking.front().parameters.front().value == band.value);  // the ranking says the same
}

TEST_CASE("a measured current in the place of the command makes no gap of its noise, and hides no cause") {
  using Effect = test::SampledAxis::Effect;
  const auto [sound, rough] = check_sound_and_rough([](Effect effect, int part) {
    const std::uint64_t seed = (effect == Effect::none ? 41u : 43u) + static_cast<std::uint64_t>(part);
    return test::with_noise(test::SampledAxis(effect, part == 0 ? 60.0 : 40.0, seed).logged_each(10),
                            "drive_A", 0.03, seed + 100);
  });
  CHECK(count_of(sound, FindingKind::noisy_command) == 2);  // of either recording
  CHECK(test::parameter_of(rough, "Nm") == Approx(0.006).epsilon(0.05));
}

TEST_CASE("slow sensors, rows of their own for each, and stamps that count from 1970 change no answer") {
  using Effect = test::SampledAxis::Effect;
  const auto updated_each_third = [](Recording r) {
    for (const char* column : {"angle_deg", "rate_dps"}) {
      Eigen::VectorXd values = r.column(column);
      for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = values[i - i % 3];
      r.set(column, values);
    }
    return r;
  };
  const auto in_turn = [](Recording r) {
    Eigen::VectorXd angle = r.column("angle_deg"), rate = r.column("rate_dps");
    for (Eigen::Index i = 0; i < angle.size(); ++i) (i % 2 == 0 ? angle : rate)[i] = std::nan("");
    r.set("angle_deg", angle);
    r.set("rate_dps", rate);
    return r;
  };
  const auto since_1970 = [](Recording r) {
    r.t_s.array() += 1.7637e9;
    return r;
  };
  int number = 0;
  for (const std::function<Recording(Recording)>& logged :
       {std::function<Recording(Recording)>(updated_each_third), std::function<Recording(Recording)>(in_turn),
        std::function<Recording(Recording)>(since_1970)}) {
    CAPTURE(number++);
    const auto [sound, rough] = check_sound_and_rough([&](Effect effect, int part) {
      const std::uint64_t seed = (effect == Effect::none ? 51u : 53u) + static_cast<std::uint64_t>(part);
      return logged(test::SampledAxis(effect, part == 0 ? 40.0 : 30.0, seed, 10).logged_each(10));
    });
    CHECK(sound.gap.size() == 2);  // both signals are judged
    CHECK(test::parameter_of(rough, "Nm") == Approx(0.006).epsilon(0.03));
  }
}

TEST_CASE("where no window can start there is no verdict") {
  const auto never_together = [](std::uint64_t seed) {
    Recording r = test::SampledAxis(test::SampledAxis::Effect::none, 20.0, seed, 10).logged_each(10);
    Eigen::VectorXd angle = r.column("angle_deg"), rate = r.column("rate_dps");
    angle.head(angle.size() / 2).setConstant(std::nan(""));
    rate.tail(rate.size() / 2).setConstant(std::nan(""));
    r.set("angle_deg", angle);
    r.set("rate_dps", rate);
    return r;
  };
  const Diagnosis diagnosis =
      diagnose(test::SampledAxis::model(), {never_together(55)}, {never_together(56)});
  CHECK(diagnosis.verdict == Verdict::insufficient);
  CHECK(diagnosis.reason.find("no row has a reading of each signal") != std::string::npos);
}

TEST_CASE("an encoder without a gyroscope is enough, and a rate that comes late does not spoil it") {
  using Effect = test::SampledAxis::Effect;
  const test::SampledAxis train(Effect::none, 40.0, 21, 10), held_out(Effect::none, 30.0, 22, 10),
      rough_train(Effect::friction, 40.0, 23, 10), rough_held_out(Effect::friction, 30.0, 24, 10);
  const auto angle_alone = [](Recording r) {
    r.remove("rate_dps");
    return r;
  };
  const auto late_rate = [](const Recording& r) { return test::filtered(r, "rate_dps", 0.03); };
  for (const std::function<Recording(const Recording&)>& seen :
       {std::function<Recording(const Recording&)>(angle_alone),
        std::function<Recording(const Recording&)>(late_rate)}) {
    const auto both = check_sound_and_rough([&](Effect effect, int part) {
      const bool is_rough = effect == Effect::friction;
      return seen((part == 0  ? is_rough ? rough_train : train
                   : is_rough ? rough_held_out
                              : held_out)
                      .logged_each(10));
    });
    CHECK(both.second.not_judged.size() == 1);
  }
}

TEST_CASE("an axis that a coarse encoder shows at rest, or at the same step in each row, is no gap") {
  // Seven rows of the same angle, or with the same step between them, tell the rate to a step of the encoder over them, and
  // not to nothing: 3.7 deg/s here.
  using Effect = test::SampledAxis::Effect;
  constexpr double step_deg = 360.0 / 8192.0;
  const auto read = [&](double length_s, std::uint64_t seed) {
    Recording r = test::SampledAxis(Effect::friction, length_s, seed, 2, 0.0).logged_each(2);
    Eigen::VectorXd angle = r.column("angle_deg");
    for (double& value : angle) value = step_deg * std::round(value / step_deg);
    r.set("angle_deg", angle);
    r.remove("rate_dps");
    return r;
  };
  Model model = test::SampledAxis::model();
  model.effects["coulomb_friction"] = {{"Nm", 0.006}, {"transition_rad_per_s", 0.002}};
  const Diagnosis sound = diagnose(model, {read(20.0, 31)}, {read(14.0, 32)});
  CHECK(test::holds(sound));
}

TEST_CASE("an encoder off its centre is found whatever the phase of its error") {
  for (const double phase_rad : {0.0, 0.9}) {
    CAPTURE(phase_rad);
    const auto eccentric = [&](std::uint64_t seed) {
      Recording r = test::SampledAxis(test::SampledAxis::Effect::none, 40.0, seed, 10).logged_each(10);
      const Eigen::ArrayXd angle_rad = r.column("angle_deg").array() * 0.017453292519943295;
      r.set("angle_deg",
            Eigen::VectorXd(r.column("angle_deg").array() + 0.8 * (4.0 * angle_rad + phase_rad).sin()));
      return r;
    };
    const Diagnosis diagnosis = diagnose(test::SampledAxis::model(), {eccentric(25)}, {eccentric(26)});
    INFO(diagnosis.reason);
    CHECK(diagnosis.verdict == Verdict::explained);
    REQUIRE(diagnosis.cause.size() == 1);
    CHECK(diagnosis.cause.front().effect == "encoder_eccentricity");
  }
}

}  // namespace

TEST_CASE("friction that bends before it slides is told from friction that does not") {
  Joint bristles;
  bristles.bristle_Nm = 0.006;
  bristles.bend_rad = 0.05;
  const Diagnosis bent = diagnosed(bristles);
  INFO(bent.reason);
  REQUIRE(bent.cause.size() == 1);
  CHECK(bent.cause.front().effect == "presliding_friction");
  CHECK(test::parameter_of(bent, "Nm") == Approx(0.006).epsilon(0.03));
  CHECK(test::parameter_of(bent, "bend_rad") == Approx(0.05).epsilon(0.05));

  Joint stiff;  // as a direct drive's on a good encoder: a tenth of a degree
  stiff.bristle_Nm = 0.006;
  stiff.bend_rad = 0.002;
  const Diagnosis crept = diagnosed(stiff);
  INFO(crept.reason);
  REQUIRE(crept.cause.size() == 1);
  CHECK(crept.cause.front().effect == "presliding_friction");
  CHECK(test::parameter_of(crept, "bend_rad") == Approx(0.002).epsilon(0.1));

  Joint dry;
  dry.coulomb_Nm = 0.006;
  const Diagnosis rubbed = diagnosed(dry);
  INFO(rubbed.reason);
  REQUIRE(rubbed.cause.size() == 1);
  CHECK(rubbed.cause.front().effect == "coulomb_friction");
}

TEST_CASE(
    "weight, friction and cogs of one joint are all named, and a third cause is none where there are two") {
  Joint joint;
  joint.weight_Nm = 0.012;
  joint.coulomb_Nm = 0.005;
  const int as_a_user_gets_it = Options().effects_at_once;
  CHECK(test::causes_of(diagnosed(joint, as_a_user_gets_it)) ==
        std::vector<std::string>{"coulomb_friction", "imbalance"});
  joint.cogs_Nm = 0.006;
  const Diagnosis all = diagnosed(joint, as_a_user_gets_it);
  INFO(all.reason);
  CHECK(test::causes_of(all) == std::vector<std::string>{"cogging", "coulomb_friction", "imbalance"});
  CHECK(all.verdict == Verdict::explained);
  CHECK(all.gap.front().after < 1.5 * all.gap.front().noise_floor);
}

TEST_CASE("the rise of friction near standstill is found with its exponent") {
  for (const double exponent : {1.0, 2.0}) {
    Joint joint;
    joint.coulomb_Nm = 0.003;
    joint.rise_Nm = 0.005;
    joint.knee_rad_per_s = 1.0;
    joint.exponent = exponent;
    const Diagnosis diagnosis = diagnosed(joint);
    INFO(exponent << ": " << diagnosis.reason);
    REQUIRE(diagnosis.cause.size() == 1);
    CHECK(diagnosis.cause.front().effect == "stribeck_friction");
    CHECK(test::parameter_of(diagnosis, "exponent") == Approx(exponent).epsilon(0.15));
  }
}

TEST_CASE("play between motor and load is told from a spring between them") {
  Joint joint;
  joint.far_share = 0.6;
  joint.gap_rad = 0.03;
  const Diagnosis diagnosis = diagnosed(joint);
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "backlash");
  CHECK(test::parameter_of(diagnosis, "gap_rad") == Approx(0.03).epsilon(0.01));
  CHECK(test::parameter_of(diagnosis, "far_share") == Approx(0.6).epsilon(0.01));
}

TEST_CASE("play that strikes hard is told as well, though each blow moves all later ones") {
  Joint joint;
  std::tie(joint.far_share, joint.gap_rad) =
      GENERATE(std::make_pair(0.6, 0.1), std::make_pair(0.77, 0.1), std::make_pair(0.77, 0.2));
  const Diagnosis diagnosis = diagnosed(joint);
  INFO(joint.far_share << " behind " << joint.gap_rad << " rad: " << diagnosis.reason);
  CHECK(diagnosis.verdict == Verdict::explained);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "backlash");
  CHECK(test::parameter_of(diagnosis, "gap_rad") == Approx(joint.gap_rad).epsilon(0.01));
  CHECK(test::parameter_of(diagnosis, "far_share") == Approx(joint.far_share).epsilon(0.01));
  for (const GapScore& one : diagnosis.gap) CHECK(one.after < 0.1 * one.before);
}

TEST_CASE("blows that nothing explains are no noise") {
  Joint joint;
  std::tie(joint.far_share, joint.gap_rad) = GENERATE(std::make_pair(0.6, 0.1), std::make_pair(0.77, 0.2));
  Model model;
  model.name = "joint";
  model.axis = RigidAxisModel{inertia, viscous, torque_constant};
  Options options;
  options.effects_at_once = 1;
  options.without = {"backlash"};
  const Diagnosis diagnosis = diagnose(model, {record(joint, 2000, 3)}, {record(joint, 1200, 8)}, options);
  CHECK(diagnosis.verdict != Verdict::no_gap);
  CHECK(diagnosis.verdict != Verdict::explained);
  // Noise of 0.02 deg and 0.15 deg/s, and that of the starts; when within two rows a blow was nobody knows.
  REQUIRE(diagnosis.gap.size() == 2);
  CHECK(to_string(diagnosis.gap[0].signal) == "angle_deg");
  CHECK(diagnosis.gap[0].noise_floor < 0.2);
  CHECK(diagnosis.gap[1].noise_floor < 0.9);
}

TEST_CASE("play that is simulated as it is leaves no more than noise, however many blows there were") {
  Joint joint;
  joint.far_share = 0.6;
  joint.gap_rad = 0.04;
  const double reduced = inertia * joint.far_share * (1.0 - joint.far_share);
  const double contact_rad_per_s = std::sqrt(4.0 / reduced);  // of the teeth in record()
  Model model;
  model.name = "joint";
  model.axis = RigidAxisModel{inertia, viscous, torque_constant};
  model.effects["backlash"] = {{"gap_rad", joint.gap_rad},
                               {"far_share", joint.far_share},
                               {"contact_Hz", contact_rad_per_s / 6.283185307179586},
                               {"damping", 0.004 / (2.0 * reduced * contact_rad_per_s)}};
  const Recording recording = record(joint, 4000, 3);
  for (const SimulatedSignal& one : simulate(model, recording)) {
    const bool is_angle = to_string(one.signal) == "angle_deg";
    const Eigen::VectorXd& measured = *recording.find(is_angle ? "angle_deg" : "rate_dps");
    const double rms =
        std::sqrt((one.values - measured).squaredNorm() / static_cast<double>(measured.size()));
    INFO(to_string(one.signal) << ": " << rms);
    // The noise of a start, carried through half a second: 0.02 deg and 0.15 deg/s.
    CHECK(rms < (is_angle ? 0.1 : 0.6));
  }
}

TEST_CASE("a spring between motor and load is not taken for play") {
  Joint joint;
  joint.far_share = 0.6;
  const Diagnosis sprung = diagnosed(joint);
  INFO(sprung.reason);
  REQUIRE(sprung.cause.size() == 1);
  CHECK(sprung.cause.front().effect == "compliance");
}

TEST_CASE(
    "a slow drive is found where a run's first readings are missing: it lags since the run began, and no longer") {
  const auto without_first = [](Recording r) {
    Eigen::VectorXd rate = r.column("rate_dps");
    rate.head(2).setConstant(std::nan(""));
    r.set("rate_dps", rate);
    return r;
  };
  Joint joint;
  joint.lag_s = 0.04;
  Model model;
  model.axis = RigidAxisModel{inertia, viscous, torque_constant};
  Options options;
  options.effects_at_once = 1;
  // Three runs of one second held out: the start is a good part of each.
  std::vector<Recording> held_out;
  for (const std::uint64_t seed : {3u, 5u, 8u}) held_out.push_back(without_first(record(joint, 101, seed)));
  const Diagnosis diagnosis = diagnose(model, {record(joint, 2000, 4)}, held_out, options);
  INFO(diagnosis.reason);
  CHECK(diagnosis.verdict == Verdict::explained);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "drive_lag");
  CHECK(test::parameter_of(diagnosis, "lag_s") == Approx(0.04).epsilon(0.03));
  for (const GapScore& gap : diagnosis.gap) CHECK(gap.after < 1.3 * gap.noise_floor);
}

TEST_CASE("a log of an axis with its motor's temperature in it is judged in both") {
  const auto recording_of = [](std::uint64_t seed) {
    test::AxisFault fault;
    fault.coulomb_Nm = 0.006;
    Recording one = test::axis_recording(fault, 4000, seed);
    test::Noise noise(seed + 100);
    Eigen::VectorXd motor_C(one.rows());
    double body_C = 25.0;
    for (Eigen::Index i = 0; i < one.rows(); ++i) {
      motor_C[i] = body_C + 0.05 * noise();
      const double amps = one.column("drive_A")[i], ohms = 200.0 * (1.0 + 0.00393 * (body_C - 25.0));
      body_C += 0.01 * (amps * amps * ohms - 0.15 * (body_C - 25.0)) / 3.0;
    }
    one.set("motor_C", motor_C);
    one.set("ambient_C", Eigen::VectorXd::Constant(one.rows(), 25.0));
    return one;
  };
  Model model = test::axis_model();
  model.supply = SupplyModel{24.0};
  model.current = OhmicCurrentModel{200.0, 0.00393, 25.0};
  model.thermal = LumpedThermalModel{3.0, 0.15};
  const Diagnosis diagnosis = diagnose(model, {recording_of(3)}, {recording_of(4)});
  CHECK(diagnosis.verdict == Verdict::explained);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "coulomb_friction");
  CHECK(diagnosis.gap.size() == 3);  // angle, rate and the motor's temperature
}

TEST_CASE("a delay is found in a log that begins under a command that was there before") {
  constexpr int late = 3;  // rows
  const auto recording_of = [](std::uint64_t seed, int cut) {
    test::Noise noise(seed), dice(seed + 50);
    const int rows = 3000 + cut;
    Eigen::VectorXd drive(rows), angle(rows), rate(rows);
    double level = 0.3, theta = 0.0, omega = 0.0;
    for (int i = 0; i < rows; ++i) {
      if (i > 0 && i % 25 == 0) level = 0.3 * dice();
      drive[i] = level;
      angle[i] = theta * 57.29577951308232 + 0.02 * noise();
      rate[i] = omega * 57.29577951308232 + 0.15 * noise();
      const double torque = i >= late ? 0.2 * drive[i - late] : 0.0;
      for (int k = 0; k < 100; ++k) {
        omega += 1e-4 * (torque - 1e-3 * omega) / 1e-3;
        theta += 1e-4 * omega;
      }
    }
    Recording one;
    one.name = "cut";
    one.t_s = Eigen::VectorXd::LinSpaced(rows - cut, 0.0, 0.01 * (rows - cut - 1));
    one.set("drive_A", drive.tail(rows - cut));
    one.set("angle_deg", angle.tail(rows - cut));
    one.set("rate_dps", rate.tail(rows - cut));
    return one;
  };
  // What is left of the first rows decides whether the axis rests there: idle, under a command at rest, under way.
  for (const int cut : {0, late, 40}) {
    INFO(cut << " rows cut off");
    const Diagnosis diagnosis = diagnose(test::axis_model(), {recording_of(5, cut)}, {recording_of(6, cut)});
    CHECK(diagnosis.verdict == Verdict::explained);
    REQUIRE(diagnosis.cause.size() == 1);
    CHECK(diagnosis.cause.front().effect == "actuation_delay");
    CHECK(test::parameter_of(diagnosis, "s") == Approx(0.03).margin(0.0005));
  }
}

TEST_CASE("a delay is found where the command changes at each row and was there before the first") {
  for (const double row_s : {0.01, 0.02, 0.04})
    for (const double rows_late : {0.25, 1.0, 2.5})
      for (const bool commanded_before : {true, false}) {
        CAPTURE(row_s, rows_late, commanded_before);
        test::LateAxis axis;
        axis.row_s = row_s;
        axis.delay_s = rows_late * row_s;
        axis.commanded_before = commanded_before;
        const Diagnosis diagnosis =
            diagnose(test::LateAxis::model(), {axis.recording(1)}, {axis.recording(2)});
        INFO(diagnosis.reason);
        CHECK(diagnosis.verdict == Verdict::explained);
        REQUIRE(diagnosis.cause.size() == 1);
        CHECK(diagnosis.cause.front().effect == "actuation_delay");
        CHECK(test::parameter_of(diagnosis, "s") == Approx(axis.delay_s).epsilon(0.02));
      }
}

TEST_CASE("a simulation that runs away is near no noise") {
  test::AxisFault none;
  Recording train = test::axis_recording(none, 600, 3), held_out = test::axis_recording(none, 400, 4);
  Model model = test::axis_model();
  model.axis->torque_constant_Nm_per_A = 1e300;
  const Diagnosis diagnosis = diagnose(model, {train}, {held_out});
  CHECK(diagnosis.verdict == Verdict::insufficient);
  CHECK_FALSE(diagnosis.next_experiment.empty());
}
