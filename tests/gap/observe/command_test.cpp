// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a command did between the rows, found from the motion of axes whose loop is known: one that sets its command 1000
// times a second and logs some of them, and one that logs each.
#include "../../catch.hpp"

#include "sampled_axis.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/observe/command_between_rows.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <random>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

/// How much of the command's next step the motion shows.
std::optional<double> share_of(const Recording& r) {
  const Inputs inputs = prepare(test::SampledAxis::model(), r);
  MotionRegression motion;
  motion.add(inputs, inputs.drive_A);
  const CommandBetweenRows between(motion);
  const auto share = between.share();
  return share ? std::optional<double>(share->value) : std::nullopt;
}

/// Whether the command went on between the rows.
bool went_on(const Recording& r) {
  const Inputs inputs = prepare(test::SampledAxis::model(), r);
  MotionRegression motion;
  motion.add(inputs, inputs.drive_A);
  const CommandBetweenRows between(motion);
  return between.steady().has_value();
}

/// Standard deviation of what is noise in the command.
double noise_of(const Recording& r) {
  const Inputs inputs = prepare(test::SampledAxis::model(), r);
  MotionRegression motion;
  motion.add(inputs, inputs.drive_A);
  const CommandBetweenRows between(motion);
  return between.noise();
}

/// A geared joint under a position loop of 1 kHz, in steps of 0.05 ms: it balances nearly all of its drive by viscous friction
/// and gravity, and moves slowly against its rows. A row for each step of the loop, or for some.
/// @param quantum_deg  of the encoder
/// @param each         steps of the loop for a row
Recording geared(double quantum_deg, int each, double length_s) {
  constexpr double loop_s = 1e-3, h = 5e-5;
  std::vector<double> t_s, drive_A, angle_deg;
  double rad = 0.0, radps = 0.0;
  for (int step = 0; step * loop_s < length_s; ++step) {
    const double now_s = step * loop_s;
    double target_deg = 0.0;
    for (const double hz : {0.13, 0.31, 0.62, 1.1, 1.9})
      target_deg += 9.0 * std::sin(6.2832 * hz * now_s) * std::min(1.0, now_s);
    const double command_A = 0.4 * (target_deg - 57.29578 * rad) - 0.03 * 57.29578 * radps;
    if (step % each == 0) {
      t_s.push_back(now_s);
      drive_A.push_back(command_A);
      angle_deg.push_back(quantum_deg * std::floor(57.29578 * rad / quantum_deg + 0.5));
    }
    for (int i = 0; i < 20; ++i) {
      radps += h * (9.5 * command_A - 4.0 * radps - 8.0 * std::sin(rad)) / 0.35;
      rad += h * radps;
    }
  }
  Recording r;
  r.name = "geared";
  r.t_s = Eigen::Map<Eigen::VectorXd>(t_s.data(), static_cast<Eigen::Index>(t_s.size()));
  r.set("drive_A", Eigen::Map<Eigen::VectorXd>(drive_A.data(), r.t_s.size()));
  r.set("angle_deg", Eigen::Map<Eigen::VectorXd>(angle_deg.data(), r.t_s.size()));
  return r;
}

/// A minute of an axis, a hundred rows a second.
struct Log {
  static constexpr Eigen::Index rows = 6000;
  static constexpr double step_s = 0.01;
  Eigen::VectorXd t_s{rows}, drive_A{rows}, angle_deg{rows}, rate_dps{rows};

  Log() {
    for (Eigen::Index k = 0; k < rows; ++k) t_s[k] = step_s * static_cast<double>(k);
  }

  Recording recording(const char* name) const {
    Recording r;
    r.name = name;
    r.t_s = t_s;
    r.set("drive_A", drive_A);
    r.set("angle_deg", angle_deg);
    r.set("rate_dps", rate_dps);
    return r;
  }
};

/// An axis that follows a command which is rough from row to row through a drive with a time constant, in steps of 0.1 ms.
/// @param white_A       what of the command no row remembers
/// @param remembered_A  what the next row remembers four fifths of
Recording driven_slowly(double time_constant_s, double smooth_A, std::uint64_t seed, double white_A = 0.1,
                        double remembered_A = 0.0) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  constexpr int inner = 100;
  constexpr double step_s = Log::step_s;
  Log log;
  double rad = 0.0, radps = 0.0, torque_Nm = 0.0, remembered = 0.0;
  for (Eigen::Index k = 0; k < Log::rows; ++k) {
    log.drive_A[k] = smooth_A * std::sin(3.0 * log.t_s[k]) + white_A * normal(random);
    if (remembered_A > 0.0) remembered = 0.8 * remembered + 0.6 * normal(random);
    log.drive_A[k] += remembered_A * remembered;
    log.angle_deg[k] = 57.29578 * rad + 0.03 * normal(random);
    log.rate_dps[k] = 57.29578 * radps + 0.2 * normal(random);
    for (int i = 0; i < inner; ++i) {
      torque_Nm += (0.09 * log.drive_A[k] - torque_Nm) * (1.0 - std::exp(-step_s / inner / time_constant_s));
      radps += (torque_Nm - 0.002 * radps) / 0.002 * step_s / inner;
      rad += radps * step_s / inner;
    }
  }
  return log.recording("slow drive");
}

/// An axis in a loop that is closed anew at each row and follows steps, through a drive that gives nothing for small commands and
/// no more than so much for large ones, and gears that rub a share of it; in steps of 0.1 ms.
Recording in_a_loop(double dead_A, double most_A, double rubbed, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  constexpr int inner = 100;
  constexpr double step_s = Log::step_s;
  Log log;
  double rad = 0.0, radps = 0.0, target_rad = 0.0;
  for (Eigen::Index k = 0; k < Log::rows; ++k) {
    if (k % 40 == 0) target_rad = 0.2 * normal(random);
    log.angle_deg[k] = 57.29578 * rad + 0.01 * normal(random);
    log.rate_dps[k] = 57.29578 * radps + 0.1 * normal(random);
    log.drive_A[k] = 1.5 * (target_rad - log.angle_deg[k] / 57.29578) - 0.2 * log.rate_dps[k] / 57.29578;
    const double beyond_A = std::max(0.0, std::min(std::abs(log.drive_A[k]), most_A) - dead_A);
    for (int i = 0; i < inner; ++i) {
      const double geared_A =
          std::copysign(beyond_A, log.drive_A[k]) - rubbed * beyond_A * std::tanh(radps / 0.01);
      radps += (0.09 * geared_A - 0.002 * radps) / 0.002 * step_s / inner;
      rad += radps * step_s / inner;
    }
  }
  return log.recording("in a loop");
}

/// Without one of its columns.
Recording without(Recording r, const char* column) {
  r.remove(column);
  return r;
}

TEST_CASE("what is felt of a command's next step is counted in the loop's own steps") {
  // A command that is held for 1 of N steps and set anew N times a row has its mean (N - 1) / 2N of the way to the next row.
  for (const int kept : {2, 5, 20}) {
    CAPTURE(kept);
    const double expected = (kept - 1.0) / (2.0 * kept);
    for (const auto effect : {test::SampledAxis::Effect::none, test::SampledAxis::Effect::friction,
                              test::SampledAxis::Effect::cogging}) {
      const Recording r = test::SampledAxis(effect, 30.0, 11).logged_each(kept);
      REQUIRE(share_of(r));
      CHECK(*share_of(r) == Approx(expected).margin(0.05));
    }
  }
  const Recording r = test::SampledAxis(test::SampledAxis::Effect::friction, 30.0, 12).logged_each(20);
  CHECK(*share_of(without(r, "angle_deg")) == Approx(0.475).margin(0.05));
  CHECK(*share_of(without(r, "rate_dps")) == Approx(0.475).margin(0.05));
}

TEST_CASE("a command that holds from row to row is left as it is, and one that comes late, too") {
  for (const auto effect : {test::SampledAxis::Effect::none, test::SampledAxis::Effect::friction,
                            test::SampledAxis::Effect::cogging}) {
    const Recording r = test::SampledAxis(effect, 60.0, 13, 20).logged_each(20);
    REQUIRE(share_of(r));
    CHECK(std::abs(*share_of(r)) < 0.1);
  }
  Recording late = test::SampledAxis(test::SampledAxis::Effect::none, 60.0, 14, 20).logged_each(20);
  Eigen::VectorXd early = late.column("drive_A");
  for (Eigen::Index i = 0; i + 2 < early.size(); ++i) early[i] = early[i + 2];
  late.set("drive_A", early);  // logged two rows before it acts
  CHECK(*share_of(late) < -1.0);
  const CheckedRecordings checked =
      check(test::SampledAxis::model(), {late}, {}, {}, thermopower::plant::standard_catalogue());
  CHECK(checked.train.front().recording().column("drive_A") == early);
}

TEST_CASE("between rows a command goes straight, and the last row of a run holds") {
  Eigen::VectorXd command(8);
  for (Eigen::Index i = 0; i < command.size(); ++i) command[i] = static_cast<double>(i * i);
  const Eigen::VectorXd mean = mean_command(command, {{0, 8, ""}}, 0.4);
  for (Eigen::Index row = 0; row < 7; ++row)
    CHECK(mean[row] == Approx(command[row] + 0.4 * (command[row + 1] - command[row])));
  CHECK(mean[7] == command[7]);
}

TEST_CASE("noise in a command is told by what no motion follows") {
  using Effect = test::SampledAxis::Effect;
  for (const auto effect : {Effect::none, Effect::friction, Effect::cogging}) {
    for (const int set_each : {1, 10}) {  // between the rows, and held from row to row
      CAPTURE(set_each);
      const Recording clean = test::SampledAxis(effect, 60.0, 31, set_each).logged_each(10);
      CHECK(noise_of(clean) == 0.0);
      for (const double sd : {0.01, 0.03, 0.1})
        CHECK(noise_of(test::with_noise(clean, "drive_A", sd, 32)) == Approx(sd).epsilon(0.1));
      const Recording noisy = test::with_noise(clean, "drive_A", 0.03, 33);
      REQUIRE(share_of(noisy));
      CHECK(*share_of(noisy) == Approx(set_each == 1 ? 0.45 : 0.0).margin(0.1));
    }
  }
  const Recording noisy =
      test::with_noise(test::SampledAxis(Effect::none, 60.0, 34).logged_each(10), "drive_A", 0.03, 35);
  CHECK(noise_of(without(noisy, "angle_deg")) == Approx(0.03).epsilon(0.1));
}

TEST_CASE(
    "noise in a measured current is told where gear and gravity balance it, and positions are rough from row to row") {
  const Recording clean =
      geared(360.0 / 524288.0, 1, 30.0);  // an encoder of 19 bits, a thousand rows a second
  CHECK(noise_of(clean) == 0.0);
  for (const double sd : {0.02, 0.05})
    CHECK(noise_of(test::with_noise(clean, "drive_A", sd, 41)) == Approx(sd).epsilon(0.1));
}

TEST_CASE("a command that went on is told by means of rows, where single ones are too rough") {
  // Every fourth step of the loop: a row's command holds a quarter of the interval, and the motion shows 3/8 of its next step.
  const std::optional<double> share = share_of(geared(360.0 / 32768.0, 4, 15.0));
  REQUIRE(share);
  CHECK(*share == Approx(0.375).epsilon(0.2));
}

TEST_CASE("a rough command that the motion follows late or slowly is no noise") {
  for (const double smooth_A : {0.0, 0.5})
    for (const double time_constant_s : {0.001, 0.005, 0.02, 0.05, 0.2}) {
      CAPTURE(smooth_A, time_constant_s);
      const Recording r = driven_slowly(time_constant_s, smooth_A, 36);
      CHECK(noise_of(r) == 0.0);
      Recording late = r;
      Eigen::VectorXd early = r.column("drive_A");
      for (Eigen::Index i = 0; i + 5 < early.size(); ++i) early[i] = early[i + 5];
      late.set("drive_A", early);
      CHECK(noise_of(late) == 0.0);
    }
}

TEST_CASE("a command that holds in a loop did not go on for what a dead band, a limit or gears take of it") {
  constexpr double no_limit_A = 1e3;
  for (const std::uint64_t seed : {45, 46, 47}) {
    CAPTURE(seed);
    for (const double dead_A : {0.0, 0.01, 0.02, 0.03})
      CHECK_FALSE(went_on(in_a_loop(dead_A, no_limit_A, 0.0, seed)));
    CHECK_FALSE(went_on(in_a_loop(0.0, 0.25, 0.0, seed)));
    CHECK_FALSE(went_on(in_a_loop(0.0, no_limit_A, 0.3, seed)));
  }
}

TEST_CASE("what a slow drive follows less the faster it is leaves no room for noise among the fastest") {
  for (const std::uint64_t seed : {42, 43, 44})
    for (const double time_constant_s : {0.03, 0.05, 0.08}) {
      CAPTURE(seed, time_constant_s);
      CHECK(noise_of(driven_slowly(time_constant_s, 0.5, seed, 0.03, 0.15)) == 0.0);
    }
}

TEST_CASE("a command that the motion does not follow at all is no noise, but a wrong column") {
  const Recording r = test::SampledAxis(test::SampledAxis::Effect::none, 60.0, 37).logged_each(10);
  Recording other = r;
  other.set("drive_A", Eigen::VectorXd::Zero(r.rows()));
  CHECK(noise_of(test::with_noise(other, "drive_A", 0.1, 38)) == 0.0);
}

}  // namespace
