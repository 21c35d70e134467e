// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"

#include <thermopower/design/diagnosed.hpp>
#include <thermopower/design/experiment.hpp>
#include <thermopower/design/prediction.hpp>
#include <thermopower/design/separation.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

using namespace thermopower::gap;
using namespace thermopower::design;

namespace {

Limits axis_limits() {
  Limits limits;
  limits.duration_s = 10.0;
  limits.row_s = 0.01;
  limits.vary = {{"drive_A", -0.5, 1.0}};
  return limits;
}

Prediction prediction(Random& random, Eigen::Index rows, Eigen::Index directions) {
  Prediction one{Eigen::VectorXd(rows), Eigen::MatrixXd(rows, directions)};
  for (double& value : one.middle) value = 3.0 * random.gauss();
  for (double& value : one.open.reshaped()) value = random.gauss();
  return one;
}

}  // namespace

TEST_CASE("Every shape stays within -1 and 1") {
  Random random(1);
  for (int shape = 0; shape < 4; ++shape)
    for (int i = 0; i < 50; ++i) {
      Piece piece;
      piece.shape = static_cast<Shape>(shape);
      piece.duration_s = random.log_uniform(0.1, 100.0);
      piece.level = random.uniform(-1.0, 1.0);
      piece.size = random.share();
      piece.period_s = random.log_uniform(0.01, 100.0);
      piece.last_period_s = random.log_uniform(0.01, 100.0);
      for (int k = 0; k <= 20; ++k) {
        const double value = piece.at(piece.duration_s * k / 20.0);
        CHECK(value >= -1.0);
        CHECK(value <= 1.0);
      }
    }
}

TEST_CASE("Repeated shapes repeat, and go as far up as down") {
  for (const Shape shape : {Shape::square, Shape::triangle, Shape::sine}) {
    const Piece piece{shape, 10.0, 0.1, 0.6, 0.8, 0.8};
    double sum = 0.0;
    for (int k = 0; k < 1000; ++k) {
      const double t_s = 0.8 * (k + 0.5) / 1000.0;
      CHECK(piece.at(t_s) == Approx(piece.at(t_s + 0.8)).margin(1e-9));
      sum += piece.at(t_s) / 1000.0;
    }
    CHECK(sum == Approx(piece.level).margin(1e-9));
  }
}

TEST_CASE("A chirp crosses its middle at first as its first period says, at last as its last one") {
  const Piece chirp{Shape::sine, 10.0, 0.0, 0.5, 2.0, 0.2};
  std::vector<double> crossings;
  for (double t_s = 0.001; t_s < 10.0; t_s += 0.001)
    if ((chirp.at(t_s) >= 0.0) != (chirp.at(t_s - 0.001) >= 0.0)) crossings.push_back(t_s);
  REQUIRE(crossings.size() > 4);
  CHECK(crossings[0] < 1.0);  // half of the first period, and it becomes faster
  CHECK(crossings[0] > 0.8);
  CHECK(crossings.back() - crossings[crossings.size() - 2] == Approx(0.1).epsilon(0.05));
}

TEST_CASE("A schedule keeps ranges, slopes and length, whatever is drawn") {
  Limits limits = axis_limits();
  limits.vary.front().slope_per_s = 2.0;
  limits.vary.push_back({"motor_C", 20.0, 60.0});
  limits.vary.back().once = true;
  limits.hold = {{"supply_V", 12.0}};
  const Library library(limits);
  Random random(2);
  Experiment experiment = library.draw(random);
  for (int i = 0; i < 200; ++i) {
    experiment = i % 3 == 0 ? library.draw(random) : library.changed(experiment, random);
    const Recording schedule = schedule_of(experiment, limits);
    REQUIRE(!schedule.validate());
    CHECK(schedule.t_s[schedule.rows() - 1] <= limits.duration_s);
    const Eigen::VectorXd &drive = schedule.column("drive_A"), &motor = schedule.column("motor_C");
    CHECK(drive.minCoeff() >= -0.5);
    CHECK(drive.maxCoeff() <= 1.0);
    for (Eigen::Index row = 1; row < drive.size(); ++row)
      CHECK(std::abs(drive[row] - drive[row - 1]) <= 0.02 + 1e-12);
    CHECK(motor.minCoeff() == motor.maxCoeff());
    CHECK(motor[0] >= 20.0);
    CHECK(motor[0] <= 60.0);
    CHECK(schedule.column("supply_V")[0] == 12.0);
  }
}

TEST_CASE("The separation is that of the matrix formula, and other parameters never add to it") {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Prediction one = prediction(random, 12, 3), other = prediction(random, 12, 2);
    const Eigen::VectorXd d = one.middle - other.middle;
    const Eigen::MatrixXd whole = Eigen::MatrixXd::Identity(12, 12) + one.open * one.open.transpose() +
                                  other.open * other.open.transpose();
    CHECK(separation(one, other) == Approx(std::sqrt(d.dot(whole.inverse() * d))));
    CHECK(separation(one, other) == Approx(separation(other, one)));
    CHECK(separation(one, other) <= d.norm());
  }
}

TEST_CASE("A difference that a parameter makes up for hardly counts") {
  Prediction one{Eigen::VectorXd::Zero(8), Eigen::MatrixXd::Zero(8, 1)},
      other{Eigen::VectorXd::Constant(8, 5.0), Eigen::MatrixXd::Constant(8, 1, 100.0)};
  CHECK(separation(one, other) < 0.06);
  other.open.setZero();
  CHECK(separation(one, other) == Approx(5.0 * std::sqrt(8.0)));
}

TEST_CASE(
    "Explanations that are alike are confused in half of the cases, those barely told apart in one of four") {
  CHECK(confusion(0.0) == Approx(0.5));
  CHECK(confusion(told_apart) == Approx(0.25).margin(1e-3));
  CHECK(confusion(20.0) < 1e-20);
}

TEST_CASE("Explanations that nothing tells apart are one class, through others as well") {
  Separations best(4, 4);
  best << 0, 9, 1, 9,  //
      9, 0, 9, 9,      //
      1, 9, 0, 1,      //
      9, 9, 1, 0;
  const std::vector<double> weights(4, 0.25);
  CHECK(Classes(weights, best).label == std::vector<std::size_t>{0, 1, 0, 0});
  CHECK(Classes(weights, best).count == 2);
  best.setConstant(9.0);
  CHECK(Classes(weights, best).label == std::vector<std::size_t>{0, 1, 2, 3});
  best.setZero();
  CHECK(Classes(weights, best).label == std::vector<std::size_t>{0, 0, 0, 0});
}

TEST_CASE("Without separation the likeliest is right as often as it is likely; far apart always") {
  const Classes apart({0.6, 0.4}, Separations::Constant(2, 2, 9.0)), one({0.6, 0.4}, Separations::Zero(2, 2));
  CHECK(apart.expected_right(Separations::Zero(2, 2)) == Approx(0.6));
  CHECK(apart.expected_right(Separations::Constant(2, 2, 30.0)) == Approx(1.0));
  CHECK(one.expected_right(Separations::Zero(2, 2)) == 1.0);
  double before = 0.0;
  for (double distance = 0.0; distance < 8.0; distance += 0.5) {
    const double right = apart.expected_right(Separations::Constant(2, 2, distance));
    CHECK(right >= before);
    before = right;
  }
}

TEST_CASE("A limit is used up at the limit, on either side and from wherever the motion starts") {
  Limits limits = axis_limits();
  limits.angle_deg = {-20.0, 50.0};
  Motion motion;
  auto& angle = motion[static_cast<std::size_t>(Signal::angle_deg)];
  angle = Eigen::Vector3d(10.0, 50.0, 20.0);
  CHECK(use_of(motion, limits).share == Approx(1.0));
  CHECK(use_of(motion, limits).limit == "angle_deg");
  angle = Eigen::Vector3d(10.0, -20.0, 20.0);
  CHECK(use_of(motion, limits).share == Approx(1.0));
  angle = Eigen::Vector3d(10.0, 30.0, 20.0);
  CHECK(use_of(motion, limits).share == Approx(0.5));
  angle[2] = missing;
  CHECK(use_of(motion, limits).share > 1e6);
}

TEST_CASE("Limits that are wrong are named by their field") {
  const auto problem = [](const std::function<void(Limits&)>& spoil) {
    Limits limits = axis_limits();
    spoil(limits);
    return limits.validate().value_or("");
  };
  CHECK(problem([](Limits&) {}).empty());
  CHECK(problem([](Limits& one) { one.duration_s = -1.0; }).rfind("duration_s is -1; expected", 0) == 0);
  CHECK(problem([](Limits& one) { one.row_s = 5.0; }).rfind("row_s is 5; expected", 0) == 0);
  CHECK(problem([](Limits& one) { one.vary.clear(); }).rfind("vary is empty; expected", 0) == 0);
  CHECK(problem([](Limits& one) {
          one.vary.front().column = "speed";
        }).rfind("vary.speed is not an input", 0) == 0);
  CHECK(problem([](Limits& one) { one.vary.front().to = -2.0; }).rfind("vary.drive_A.from is", 0) == 0);
  CHECK(problem([](Limits& one) {
          one.hold = {{"drive_A", 1.0}};
        }).rfind("hold.drive_A is in vary, too", 0) == 0);
  CHECK(problem([](Limits& one) {
          one.start = {{"torque", 1.0}};
        }).rfind("start.torque is not known", 0) == 0);
  CHECK(problem([](Limits& one) { one.rate_dps = {3.0, -3.0}; }).rfind("rate_dps is from 3", 0) == 0);
  CHECK(problem([](Limits& one) { one.vary.front().once = true; }).rfind("vary holds nothing", 0) == 0);
}

TEST_CASE("What a model needs and the limits lack is named by its field") {
  DiagnosedGap gap;
  gap.model.axis = RigidAxisModel{};
  gap.watched = {{Signal::rate_dps, 0.1}};
  Limits limits = axis_limits();
  CHECK(!lacking_for(gap, limits));
  limits.vary = {{"power_param", 0.0, 255.0}};
  CHECK(lacking_for(gap, limits).value_or("").rfind("vary.drive_A is missing", 0) == 0);
  gap.model.axis.reset();
  gap.model.thermal = LumpedThermalModel{};
  gap.watched = {{Signal::motor_C, 0.1}};
  CHECK(lacking_for(gap, limits).value_or("").rfind("hold.ambient_C is missing", 0) == 0);
  limits.hold = {{"ambient_C", 22.0}};
  CHECK(!lacking_for(gap, limits));
}

TEST_CASE("A limit is raised alone, the smallest raise first") {
  Limits limits = axis_limits();
  limits.rate_dps = {-100.0, 100.0};
  const auto raised = raised_limits(limits);
  REQUIRE(!raised.empty());
  CHECK(raised.front().field == "duration_s");
  CHECK(raised.front().to == Approx(15.0));
  for (const RaisedLimit& one : raised) {
    CHECK(!one.limits.validate());
    const int changed = (one.limits.duration_s != limits.duration_s) +
                        (one.limits.vary.front().to != limits.vary.front().to) +
                        (one.limits.rate_dps.high != limits.rate_dps.high);
    CHECK(changed == 1);
  }
}
