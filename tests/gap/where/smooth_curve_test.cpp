// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/where/localisation.hpp>
#include <thermopower/gap/where/smooth_curve.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

// There and back, five times in a recording, and three times as long in the lower half as in the upper one.
Eigen::VectorXd swept(Eigen::Index count) {
  Eigen::VectorXd x(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double turn = 5.0 * static_cast<double>(i) / static_cast<double>(count),
                 saw = 1.0 - std::abs(2.0 * (turn - std::floor(turn)) - 1.0);
    x[i] = saw < 0.75 ? saw / 1.5 : 0.5 + 2.0 * (saw - 0.75);
  }
  return x;
}

double farthest(const SmoothCurve& curve, double (*truth)(double)) {
  double most = 0.0;
  for (Eigen::Index i = 0; i < curve.x.size(); ++i)
    most = std::max(most, std::abs(curve.value[i] - truth(curve.x[i])));
  return most;
}

// The largest change of slope from one piece of the drawn line to the next, where the whole height over the whole width is 1.
double sharpest_corner(const SmoothCurve& curve) {
  const double height = curve.value.maxCoeff() - curve.value.minCoeff();
  double most = 0.0;
  for (Eigen::Index i = 1; i + 1 < curve.x.size(); ++i)
    most = std::max(most, std::abs(curve.value[i - 1] - 2.0 * curve.value[i] + curve.value[i + 1]) / height *
                              static_cast<double>(curve.x.size() - 1));
  return most;
}

}  // namespace

TEST_CASE("through samples of a straight line goes that line, and it has two degrees of freedom") {
  const Eigen::VectorXd x = swept(2000);
  const SmoothCurve curve = smooth_curve(x, (3.0 - 7.0 * x.array()).matrix(), 0.1, 0.9);
  REQUIRE(curve.x.size() > 100);
  CHECK(curve.x[0] == Approx(0.1));
  CHECK(curve.x[curve.x.size() - 1] == Approx(0.9));
  CHECK(farthest(curve, [](double at) { return 3.0 - 7.0 * at; }) < 1e-4);
  CHECK(curve.freedom == Approx(2.0).margin(0.3));
}

TEST_CASE(
    "a function of the variable keeps its bends and its steep places, and noise hides them no more than it must") {
  const auto bent = [](double at) { return std::sin(9.0 * at); };
  const auto steep = [](double at) { return std::tanh(15.0 * (at - 0.5)); };
  test::Noise noise(3);
  const Eigen::VectorXd x = swept(4000);
  for (const double level : {0.0, 0.1}) {
    Eigen::VectorXd sine(x.size()), jump(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      sine[i] = bent(x[i]) + level * noise();
      jump[i] = steep(x[i]) + level * noise();
    }
    CAPTURE(level);
    CHECK(farthest(smooth_curve(x, sine, 0.05, 0.95), bent) < 0.07);
    CHECK(farthest(smooth_curve(x, jump, 0.05, 0.95), steep) < 0.12);
  }
}

TEST_CASE("what the variable does not order is drawn nearly level") {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    test::Noise noise(seed);
    const Eigen::VectorXd x = swept(2000);
    Eigen::VectorXd y(x.size());
    for (double& one : y) one = 5.0 + noise();
    const SmoothCurve curve = smooth_curve(x, y, 0.0, 1.0);
    CAPTURE(seed, curve.freedom);
    CHECK(curve.freedom < 5.0);
    CHECK(farthest(curve, [](double) { return 5.0; }) < 0.3);
  }
}

TEST_CASE("a variable that stands at six levels gives a curve without stairs") {
  Eigen::VectorXd x(1200), y(1200);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    x[i] = static_cast<double>(i / 25 % 6);
    y[i] = x[i] * x[i];
  }
  const SmoothCurve curve = smooth_curve(x, y, 0.0, 5.0);
  for (Eigen::Index i = 1; i < curve.value.size(); ++i) CHECK(curve.value[i] >= curve.value[i - 1] - 0.02);
  // Straight pieces from level to level would make corners of 2 in a rise of 25 over 5: 0.4.
  CHECK(sharpest_corner(curve) < 0.1);
  CHECK(farthest(curve, [](double at) { return at * at; }) < 0.5);
}

TEST_CASE("a variable that only rises is followed as well as one that comes back") {
  const auto bent = [](double at) { return std::sin(9.0 * at); };
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(2000, 0.0, 1.0);
  CHECK(farthest(smooth_curve(x, (9.0 * x.array()).sin().matrix(), 0.05, 0.95), bent) < 0.05);
}

TEST_CASE("loops of a variable that orders half of it are one calm curve") {
  // What is supplied runs behind the variable, a different way on each passage, as an imbalance's torque does on an axis that is pushed about.
  Eigen::VectorXd x(4000), y(4000);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double turn = 2.0 * 3.141592653589793 * 9.0 * static_cast<double>(i) / 4000.0;
    x[i] = std::sin(turn) * (0.6 + 0.4 * std::sin(turn / 9.0));
    y[i] = x[i] + 0.3 * std::cos(turn) * std::sin(turn / 3.0);
  }
  const SmoothCurve curve = smooth_curve(x, y, -0.9, 0.9);
  CHECK(curve.freedom < 12.0);
  CHECK(farthest(curve, [](double at) { return at; }) < 0.25);
}

TEST_CASE("samples that are no numbers do not count, and of too few there is no curve") {
  constexpr double none = std::numeric_limits<double>::quiet_NaN(),
                   infinite = std::numeric_limits<double>::infinity();
  Eigen::VectorXd x = swept(400), y = 2.0 * x;
  const SmoothCurve clean = smooth_curve(x, y, 0.0, 1.0);
  for (Eigen::Index i = 0; i < 400; i += 20) y[i] = i % 40 == 0 ? none : infinite;
  for (Eigen::Index i = 10; i < 400; i += 20) x[i] = i % 40 == 10 ? none : -infinite;
  const SmoothCurve holed = smooth_curve(x, y, 0.0, 1.0);
  CHECK((clean.value - holed.value).cwiseAbs().maxCoeff() < 1e-3);
  CHECK(smooth_curve(x.head(3), y.head(3), 0.0, 1.0).x.size() == 0);
  CHECK(smooth_curve(x, y, 1.0, 1.0).x.size() == 0);
  CHECK(smooth_curve(x, y, 0.0, infinite).x.size() == 0);
  CHECK(smooth_curve(x, y, none, 1.0).x.size() == 0);
  CHECK(smooth_curve({}, {}, 0.0, 1.0).x.size() == 0);
  // All at one place: level, and a number everywhere.
  const SmoothCurve level =
      smooth_curve(Eigen::VectorXd::Constant(50, 0.5), Eigen::VectorXd::Constant(50, 4.0), 0.0, 1.0);
  CHECK((level.value.array() - 4.0).abs().maxCoeff() < 0.01);
}

TEST_CASE("the curve of an effect is what was put in, over the range of what is measured, and no stairs") {
  test::AxisFault fault;
  fault.spring_Nm_per_rad = 0.01;
  const std::vector<Recording> faulty{test::axis_recording(fault, 4000, 3)};
  const Model model = test::axis_model();
  Localisation found = localise(model, faulty, standard_catalogue());
  REQUIRE_FALSE(found.quantities.empty());
  MissingQuantity& q = found.quantities.front();
  REQUIRE(q.variable == "angle_deg");
  CHECK(q.effect.size() == 0);  // until there is a cause
  // A simulation with the spring would give what the recording of one gives.
  draw_effect(model, faulty, standard_catalogue(), found.quantities);
  REQUIRE(q.effect.size() == q.effect_x.size());
  REQUIRE(q.effect.size() > 100);
  CHECK(q.effect_x[0] == Approx(q.x[0]));
  CHECK(q.effect_x[q.effect_x.size() - 1] == Approx(q.x[q.x.size() - 1]));
  const double width = q.effect_x[q.effect_x.size() - 1] - q.effect_x[0], spring = -0.01 / 57.29577951;
  for (Eigen::Index i = 0; i < q.effect.size(); ++i)
    CHECK(q.effect[i] == Approx(spring * q.effect_x[i]).margin(0.05 * std::abs(spring) * width));
  CHECK(sharpest_corner({q.effect_x, q.effect, q.effect_freedom}) < 0.1);
}
