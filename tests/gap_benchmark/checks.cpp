// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// What the benchmark itself has to be right about, before it may judge anything: the physics of its plants,
// the step of its integrators, its random numbers, its statistics, and that it tells the judge nothing.

#include "../catch.hpp"

#include <filesystem>
#include <map>

#include "axis_draw.hpp"
#include "beginner_draw.hpp"
#include "bench_draw.hpp"
#include "closed_loop_draw.hpp"
#include "plan.hpp"
#include "slow_log_draw.hpp"
#include "tally.hpp"

using namespace gap_benchmark;

namespace {

/// Equal to a relative tolerance.
bool agree(double value, double expected, double tolerance = 1e-5) {
  return std::fabs(value - expected) <= tolerance * std::max(std::fabs(value), std::fabs(expected));
}

double furthest(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::fabs(a[i] - b[i]));
  return worst;
}

BenchParameters small_motor() {
  BenchParameters p = bench_defaults();
  p[resistance_ohm] = 8.0;
  p[heat_capacity] = 60.0;
  p[conductance] = 0.2;
  return p;
}

AxisParameters small_axis() {
  AxisParameters p = axis_defaults();
  p[inertia] = 1e-3;
  p[viscous] = 1e-3;
  p[torque_constant] = 0.15;
  return p;
}

}  // namespace

TEST_CASE("without a temperature coefficient the motor follows the exponential of the textbook") {
  BenchParameters p = small_motor();
  p[tempco_per_K] = 0.0;
  const BenchPlant plant(p);
  BenchInput u;
  u.power_param = 128.0;
  u.supply_V = 12.0;
  u.ambient_C = 22.0;
  BenchState x;
  x.winding_C = 30.0;
  plant.advance(x, u, 400.0);
  const double watts = 144.0 * (128.0 / 255.0) / 8.0, end_C = 22.0 + watts / 0.2;
  CHECK(agree(x.winding_C, end_C + (30.0 - end_C) * std::exp(-400.0 * 0.2 / 60.0), 1e-9));
}

TEST_CASE("heat in is heat out plus heat stored, with two nodes and every kind of loss") {
  BenchParameters p = small_motor();
  p[winding_share] = 0.2;
  p[coupling_W_per_K] = 1.0;
  p[radiation_W_per_K4] = 5e-10;
  p[convection_exponent] = 0.25;
  p[convection_reference_K] = 20.0;
  p[neighbour_W_per_K] = 0.03;
  const BenchPlant plant(p);
  BenchInput u;
  u.power_param = 200.0;
  u.neighbour_C = 55.0;
  BenchState x;
  double balance_J = 0.0;
  const double h = 0.01;
  for (int i = 0; i < 60000; ++i) {  // Simpson's rule over each little step
    const BenchState a = x;
    BenchState b = a;
    plant.advance(b, u, 0.5 * h);
    x = b;
    plant.advance(x, u, 0.5 * h);
    const auto net = [&](const BenchState& s) {
      return plant.heating(u, s) - plant.loss(u, s.housing_C, false, p[conductance], plant.air_around(u, s));
    };
    balance_J += h / 6.0 * (net(a) + 4.0 * net(b) + net(x));
  }
  const double stored_J = 60.0 * (0.2 * (x.winding_C - 20.0) + 0.8 * (x.housing_C - 20.0));
  CHECK(x.winding_C > 60.0);
  CHECK(agree(balance_J, stored_J, 1e-8));
}

TEST_CASE("an undamped spring keeps its energy") {
  AxisParameters p = small_axis();
  p[viscous] = 0.0;
  p[far_share] = 0.6;
  p[spring_Hz] = 15.0;
  p[spring_damping] = 0.0;
  const AxisPlant plant(p);
  AxisState x;
  x.angle = 0.02;
  x.far_rate = 1.0;
  const double before = plant.energy(x);
  for (int i = 0; i < 5000; ++i) plant.advance(x, AxisInput{}, 0.001);
  CHECK(agree(plant.energy(x), before, 1e-5));
}

TEST_CASE("a rigid axis follows the exponential of the textbook, and dry friction stops it when it should") {
  AxisParameters p = small_axis();
  AxisInput u;
  u.drive_A = 0.02;
  AxisState x;
  AxisPlant(p).advance(x, u, 0.8);
  CHECK(agree(x.rate, 3.0 * (1.0 - std::exp(-0.8)), 1e-9));

  p[viscous] = 0.0;
  p[coulomb_Nm] = 2e-3;
  x = AxisState{};
  x.rate = 1.0;
  AxisPlant(p).advance(x, AxisInput{}, 3.0);
  CHECK(x.rate == 0.0);                          // at rest, and not chattering around it
  CHECK(agree(x.angle, 0.5 * 1.0 / 2.0, 1e-6));  // v^2 / (2 F / J)
  u.drive_A = 0.9 * 2e-3 / 0.15;                 // not enough to break away
  AxisPlant(p).advance(x, u, 1.0);
  CHECK(x.rate == 0.0);
  p[film_dps] = 1.0;  // creeps at the rate at which the film carries that much
  AxisPlant(p).advance(x, u, 1.0);
  CHECK(agree(x.rate * degrees_per_radian, 0.9, 1e-9));
}

TEST_CASE(
    "a weight on a pulley, a slow drive, a drag of two sides, warm grease and a ripple follow their textbook") {
  AxisParameters p = small_axis();
  p[viscous] = 0.0;
  AxisInput u;
  p[weight_Nm] = -2e-3;  // T / J t
  AxisState x;
  AxisPlant(p).advance(x, u, 0.5);
  CHECK(agree(x.rate, -1.0, 1e-9));
  p[weight_Nm] = 0.0;

  p[lag_s] = 0.03;  // Kt i / J (t - lag (1 - exp(-t / lag)))
  u.drive_A = 0.1;
  x = AxisState{};
  AxisPlant(p).advance(x, u, 0.05);
  CHECK(agree(x.rate, 15.0 * (0.05 - 0.03 * (1.0 - std::exp(-0.05 / 0.03))), 1e-7));
  p[lag_s] = 0.0;

  p[viscous] = 1e-3;  // exp(-(b + c) t / J)
  p[forward_Nms] = 2e-3;
  p[backward_Nms] = -0.5e-3;
  u.drive_A = 0.0;
  for (const double way : {1.0, -1.0}) {
    x = AxisState{};
    x.rate = way;
    AxisPlant(p).advance(x, u, 0.4);
    CHECK(agree(x.rate, way * std::exp(way > 0.0 ? -3.0 * 0.4 : -0.5 * 0.4), 1e-9));
  }
  p[forward_Nms] = p[backward_Nms] = 0.0;

  p[thinning_per_K] = 0.02;  // b exp(-k (T - 25)), and dry friction alike
  u.motor_C = 60.0;
  x = AxisState{};
  x.rate = 1.0;
  AxisPlant(p).advance(x, u, 0.8);
  CHECK(agree(x.rate, std::exp(-0.8 * std::exp(-0.7)), 1e-9));
  p[viscous] = 0.0;
  p[coulomb_Nm] = 2e-3;
  x = AxisState{};
  x.rate = 1.0;
  AxisPlant(p).advance(x, u, 0.3);
  CHECK(agree(x.rate, 1.0 - 2.0 * std::exp(-0.7) * 0.3, 1e-9));
  p[thinning_per_K] = p[coulomb_Nm] = 0.0;

  p[ripple_sin] = 0.3;  // J w^2 / 2 is the work, Kt i (theta + s (1 - cos(n theta)) / n + c sin(n theta) / n)
  p[ripple_cos] = -0.2;
  p[ripple_count] = 6.0;
  u.drive_A = 0.1;
  x = AxisState{};
  AxisPlant(p).advance(x, u, 0.6);
  CHECK(agree(
      0.5e-3 * x.rate * x.rate,
      0.015 * (x.angle + 0.3 * (1.0 - std::cos(6.0 * x.angle)) / 6.0 - 0.2 * std::sin(6.0 * x.angle) / 6.0),
      1e-8));
}

TEST_CASE("friction of two sides is friction and a torque that is always there, at rest and in motion") {
  REQUIRE(axis_same_physics().size() == 1);
  AxisParameters one = small_axis(), other = small_axis();
  one[coulomb_Nm] = other[coulomb_Nm] = 2e-3;
  one[asymmetry] = 0.4;
  other[weight_Nm] = -0.4 * 2e-3;
  AxisState a, b;
  for (int i = 0; i < 400; ++i) {  // through both directions, and standstill in between
    AxisInput u;
    u.drive_A = 0.03 * std::sin(0.05 * i) + 0.008 * std::sin(0.31 * i);
    AxisPlant(one).advance(a, u, 0.01);
    AxisPlant(other).advance(b, u, 0.01);
    REQUIRE(std::fabs(a.rate - b.rate) < 1e-6);
  }
  CHECK(std::fabs(a.angle) > 0.01);
}

TEST_CASE("a delayed command switches at its own instant") {
  AxisParameters p = small_axis();
  p[viscous] = 0.0;
  p[delay_s] = 0.0137;
  AxisDrive drive;
  drive.t_s = {0.0, 0.01, 0.02, 0.03, 0.04};
  drive.input.resize(5);
  drive.input[0].drive_A = 0.1;
  drive.run_start = {0};
  const AxisOutput nothing{std::vector<double>(5, 0.0), std::vector<double>(5, 0.0)};
  const AxisOutput y = replay(p, drive, nothing, 10.0);
  CHECK(y.rate_dps[1] == 0.0);
  CHECK(agree(y.rate_dps[2], 15.0 * (0.02 - 0.0137) * degrees_per_radian));
  CHECK(agree(y.rate_dps[4], 15.0 * 0.01 * degrees_per_radian));
}

TEST_CASE("halving the step of the plants changes a recording by less than a hundredth of its noise") {
  Random random(11);
  for (const auto& effect : bench_effects()) {
    CAPTURE(effect.id);
    BenchSetup setup = draw_bench({effect.id}, effect.id == "supply_power_heating", random);
    if (!effect.possible(setup.context)) continue;
    effect.draw(random, setup.context, setup.plant);
    const BenchRecording made = record(setup, BenchSession{}, Random(3));
    BenchDrive drive = made.drive;
    const BenchOutput coarse = replay(made.exact, drive, 1.0), fine = replay(made.exact, drive, 0.5);
    CHECK(furthest(coarse.motor_C, fine.motor_C) < 0.01 * setup.noise_motor_C);
    CHECK(furthest(coarse.current_A, fine.current_A) < 0.01 * setup.noise_current_A);
  }
  for (const BenchUnknown unknown :
       {BenchUnknown::melting, BenchUnknown::hidden_fan, BenchUnknown::shorted_turns}) {
    BenchSetup setup = draw_bench({}, false, random);
    draw_unknown(setup, unknown, random);
    const BenchRecording made = record(setup, BenchSession{}, Random(4));
    const BenchOutput coarse = replay(made.exact, made.drive, 1.0),
                      fine = replay(made.exact, made.drive, 0.5);
    CHECK(furthest(coarse.motor_C, fine.motor_C) < 0.01 * setup.noise_motor_C);
  }
  for (const auto& effect : axis_effects()) {
    CAPTURE(effect.id);
    AxisSetup setup = draw_axis({effect.id}, random);
    AxisSession session;
    session.length_s = 8.0;
    measure_session(setup, session, Random(5));
    setup.plant = setup.context.plant;
    if (!effect.possible(setup.context)) continue;
    effect.draw(random, setup.context, setup.plant);
    const AxisRecording made = record(setup, session, Random(6));
    const AxisOutput coarse = replay(setup.plant, made.drive, made.truth, axis_horizon_s, 1.0),
                     fine = replay(setup.plant, made.drive, made.truth, axis_horizon_s, 0.5);
    const double gain = std::max(1.0, setup.plant[angle_gain]);
    CHECK(furthest(coarse.angle_deg, fine.angle_deg) < 0.01 * gain * setup.noise_angle_deg);
    CHECK(furthest(coarse.rate_dps, fine.rate_dps) < 0.01 * setup.noise_rate_dps);
  }
}

TEST_CASE("the true model replays its own recording to the noise of its sensors") {
  Random random(21);
  BenchSetup bench = draw_bench({}, false, random);
  bench.context.has_current = true;
  bench.context.current_is_input = bench.missing_cells = false;
  const BenchRecording made = record(bench, BenchSession{}, Random(7));
  SquaredErrors errors;
  add_errors(replay(made.exact, drive_from_log(bench, made)), made, errors);
  CHECK(errors["motor_C"].rms() <
        1.5 * std::hypot(bench.noise_motor_C, bench.quantum_motor_C / std::sqrt(12.0)) + 0.03);
  CHECK(errors["motor_C"].rms() > 0.9 * bench.noise_motor_C);

  AxisSetup axis = draw_axis({}, random);
  AxisSession session;
  session.length_s = 10.0;
  const AxisRecording moved = record(axis, session, Random(8));
  SquaredErrors motion;
  add_errors(axis.plant, drive_from_log(axis, moved), moved, false, motion);
  CHECK(motion["rate_dps"].rms() < 2.0 * std::hypot(axis.noise_rate_dps, axis.quantum_rate_dps));
  CHECK(motion["rate_dps"].rms() > 0.9 * axis.noise_rate_dps);
}

TEST_CASE("the same seed draws the same case, and the gate holds in both recordings") {
  for (const bool axis : {false, true}) {
    CaseOrder order;
    order.axis = axis;
    order.effects = {axis ? "coulomb_friction" : "series_resistance"};
    order.thorough = false;
    order.replicates = 1;
    Random first(42), second(42);
    const DrawnCase a = axis ? draw_axis_case(order, first) : draw_bench_case(order, first);
    const DrawnCase b = axis ? draw_axis_case(order, second) : draw_bench_case(order, second);
    CHECK(a.label.dump() == b.label.dump());
    CHECK(a.model.dump() == b.model.dump());
    CHECK(a.train.columns.back().values == b.train.columns.back().values);
    CHECK(a.assessment.visible_train >= order.gate);
    CHECK(a.assessment.visible_heldout >= order.gate);
  }
}

TEST_CASE("a cause is recognised by its own fit and a stranger is not") {
  CaseOrder order;
  order.effects = {"dead_time"};
  order.replicates = 0;
  order.clear = true;
  Random random(5);
  const DrawnCase drawn = draw_bench_case(order, random);
  CHECK(drawn.assessment.confusability() < 0.9);
  CHECK(drawn.assessment.suspects.size() > 8);
}

TEST_CASE("what the judge sees does not name the cause") {
  CaseOrder order;
  order.effects = {"series_resistance"};
  order.thorough = false;
  order.replicates = 0;
  Random random(9);
  const DrawnCase drawn = draw_bench_case(order, random);
  CHECK(drawn.model.dump().find("series") == std::string::npos);
  CHECK_FALSE(drawn.model.contains("effects"));
  for (const auto& column : drawn.train.columns) CHECK(column.name.find("ohm") == std::string::npos);
}

TEST_CASE("the plan holds every effect, and its order says nothing") {
  const auto orders = plan(1, 5, "", true);
  CHECK(orders.size() >= 300);
  for (const bool axis : {false, true})
    for (const auto& id : all_ids(axis))
      CHECK(std::count_if(orders.begin(), orders.end(), [&](const CaseOrder& o) {
              return o.half == (needs_servo(id) ? Half::servo : Half::clean) && o.axis == axis &&
                     o.effects == std::vector<std::string>{id};
            }) >= 5);
  for (const bool axis : {false, true})
    for (const auto& id : all_ids(axis))
      CHECK(std::count_if(orders.begin(), orders.end(), [&](const CaseOrder& o) {
              return o.half == Half::dirty && o.axis == axis && o.effects == std::vector<std::string>{id};
            }) == (needs_servo(id) ? 0 : 1));
  for (const Dirt dirt : all_dirt()) {
    CAPTURE(name(dirt));
    CHECK(std::count_if(orders.begin(), orders.end(), [&](const CaseOrder& o) {
            return o.effects.empty() && o.unknown == 0 && has(o.dirt, dirt);
          }) >= 3);
  }
  // Of N cases in an order that says nothing, n of a kind stand side by side n (n - 1) / N times on average.
  std::map<std::vector<std::string>, double> alike;
  int neighbours = 0;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    alike[orders[i].effects] += 1.0;
    neighbours += i > 0 && orders[i].effects == orders[i - 1].effects;
  }
  double expected = 0.0;
  for (const auto& kind : alike)
    expected += kind.second * (kind.second - 1.0) / static_cast<double>(orders.size());
  CHECK(neighbours < expected + 4.0 * std::sqrt(expected));
}

TEST_CASE("coloured and heavy-tailed noise have the deviation, the memory and the tails they are named for") {
  for (const NoiseKind kind : {NoiseKind::mild, NoiseKind::coloured, NoiseKind::heavy_tailed}) {
    Random random(31);
    SensorNoise noise(0.2, 0.0, 4.0, kind);
    double square = 0.0, product = 0.0, before = 0.0;
    int far = 0;
    const int n = 400000;
    for (int i = 0; i < n; ++i) {
      const double x = noise.next(random);
      square += x * x;
      product += x * before;
      far += std::fabs(x) > 0.8;
      before = x;
    }
    CAPTURE(static_cast<int>(kind));
    CHECK(std::fabs(std::sqrt(square / n) - 0.2) < 0.012);
    CHECK(std::fabs(product / square - (kind == NoiseKind::coloured ? 0.95 : 0.0)) < 0.01);
    // Beyond four deviations lie 6e-5 of a normal sample, and 6.2e-3 of Student's t with three degrees of freedom.
    if (kind == NoiseKind::heavy_tailed) CHECK(std::fabs(static_cast<double>(far) / n - 6.2e-3) < 1e-3);
    else CHECK(far < n / 5000);
  }
}

TEST_CASE("every kind of dirt changes its share of the log, and the true motion of nothing") {
  for (const Dirt dirt : all_dirt()) {
    CAPTURE(name(dirt));
    CaseOrder order;
    order.half = Half::dirty;
    order.effects = {"series_resistance"};
    order.thorough = false;
    order.replicates = 0;
    Random first(77), second(77);
    const DrawnCase clean = draw_bench_case(order, first);
    order.dirt = {dirt};
    const DrawnCase dirty = draw_bench_case(order, second);
    CHECK(dirty.model.dump() == clean.model.dump());
    const auto &before = clean.train["motor_C"], &after = dirty.train["motor_C"];
    if (dirt == Dirt::pauses) {
      CHECK(after.size() < before.size());
      CHECK(static_cast<double>(after.size()) > 0.9 * static_cast<double>(before.size()));
      continue;
    }
    REQUIRE(after.size() == before.size());
    std::size_t changed = 0, all = 0;
    for (const char* column : {"t_s", "motor_C", "current_A"})
      for (std::size_t k = 0; k < before.size(); ++k) {
        const double a = clean.train[column][k], b = dirty.train[column][k];
        changed += !(a == b || (std::isnan(a) && std::isnan(b)));
        ++all;
      }
    CHECK(changed > 0);
    const bool noise = dirt == Dirt::coloured || dirt == Dirt::heavy_tailed || dirt == Dirt::coarse;
    const bool rows = dirt == Dirt::jitter || dirt == Dirt::clipped;
    if (!noise && !rows) CHECK(static_cast<double>(changed) < 0.1 * static_cast<double>(all));
  }
}

TEST_CASE(
    "constants that were fitted without the effect come nearer to the recording than those of the motor") {
  CaseOrder order;
  order.half = Half::misspecified;
  order.effects = {"second_thermal_mass"};
  order.thorough = false;
  order.replicates = 0;
  Random first(12), second(12);
  const DrawnCase known = draw_bench_case(order, first);
  order.refitted = true;
  const DrawnCase fitted = draw_bench_case(order, second);
  CHECK(fitted.model["thermal"].dump() != known.model["thermal"].dump());
  CHECK(fitted.label["gap"]["motor_C"]["before"].get<double>() <
        known.label["gap"]["motor_C"]["before"].get<double>());
}

TEST_CASE("Wilson's interval is that of the tables") {
  CHECK(wilson(0, 10).first < 1e-12);
  CHECK(std::fabs(wilson(0, 10).second - 0.2775) < 1e-4);
  CHECK(std::fabs(wilson(81, 263).first - 0.2553) < 1e-4);
  CHECK(std::fabs(wilson(81, 263).second - 0.3662) < 1e-4);
}

TEST_CASE("a propeller turns at the rate at which its drag holds the motor") {
  AxisParameters p = small_axis();
  p[viscous] = 0.0;
  p[drag_Nm_per_dps2] = 2e-8;
  const AxisPlant plant(p);
  AxisState x;
  AxisInput u;
  u.drive_A = 0.4;
  plant.advance(x, u, 60.0);
  CHECK(agree(x.rate * degrees_per_radian, std::sqrt(0.15 * 0.4 / 2e-8), 1e-4));
}

TEST_CASE("a late target is the last one that was logged so long ago") {
  const std::vector<double> t_s = {0.0, 0.01, 0.02, 0.03, 0.04};
  CHECK(row_of_target(t_s, 0, 4, 0.0) == 4);
  CHECK(row_of_target(t_s, 0, 4, 0.015) == 2);
  CHECK(row_of_target(t_s, 0, 4, 0.02) == 2);
  CHECK(row_of_target(t_s, 0, 4, 1.0) == 0);
  CHECK(row_of_target(t_s, 3, 4, 1.0) == 3);
}

TEST_CASE(
    "the parts draw the same from the same seed, wrong what they say is wrong, and tell the judge nothing") {
  for (int number = 0; number < 12; ++number) {
    CAPTURE(number);
    Random one(41), other(41);
    const DrawnCase first = draw_beginner_case(number, one), second = draw_beginner_case(number, other);
    CHECK(first.model == second.model);
    CHECK(first.train["t_s"] == second.train["t_s"]);
    const auto& label = first.label;
    const int answers = static_cast<int>(!label["accept"].empty()) +
                        static_cast<int>(label["refuse"].get<bool>()) +
                        static_cast<int>(label["common_factor"].get<bool>());
    CHECK(answers == 1);
    CHECK(first.model.dump().find("calibration") == std::string::npos);
  }
}

TEST_CASE("a joint of the closed loops follows its target, and its effort has the noise that it is given") {
  Random random(7);
  AxisSetup setup = draw_axis({}, random);
  setup.noise_angle_deg = setup.noise_rate_dps = 0.0;
  setup.context.dt_s = 0.005;
  const AxisParameters& p = setup.context.plant;
  LoopGains gains;
  const double omega = 6.283185307179586 * 4.0;
  gains.kp_A_per_rad = p[inertia] * omega * omega / p[torque_constant];
  gains.kd_A_s_per_rad = 1.4 * p[inertia] * omega / p[torque_constant];
  gains.limit_A = 1e3;
  const LoopTarget target(random, 3.0, 0.8);
  AxisRecording recording = follow(setup, p, gains, target, 20.0, 5);
  SquaredError apart;
  for (std::size_t k = 0; k < recording.drive.t_s.size(); ++k)
    apart.add(recording.truth.angle_deg[k] - recording.drive.servo.target_deg[k]);
  CHECK(apart.rms() < 0.1 * 3.0 * degrees_per_radian);
  write_loop_log(setup, recording, 0.05, true, random);
  SquaredError noise;
  for (std::size_t k = 0; k < recording.drive.t_s.size(); ++k)
    noise.add(recording.log["drive_A"][k] - recording.drive.input[k].drive_A);
  CHECK(agree(noise.rms(), 0.05, 0.1));
}

TEST_CASE("a controlled body is logged once a second and stays where power can hold it") {
  Random random(11);
  const DrawnCase drawn = draw_slow_log_case(0, random);
  const auto& t_s = drawn.train["t_s"];
  for (std::size_t k = 1; k < t_s.size(); ++k) CHECK(t_s[k] - t_s[k - 1] == 1.0);
  double lowest = 1e9, highest = -1e9;
  for (const double one : drawn.train["motor_C"])
    lowest = std::min(lowest, one), highest = std::max(highest, one);
  CHECK(highest > lowest + 3.0);
  CHECK(highest < 150.0);
  CHECK(drawn.label["family"].size() == 1);
}
