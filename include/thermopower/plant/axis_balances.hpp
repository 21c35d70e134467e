// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/axis_at_rows.hpp>
#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/balance.hpp>
#include <thermopower/plant/columns.hpp>
#include <thermopower/plant/piecewise_linear.hpp>
#include <thermopower/plant/samples.hpp>
#include <thermopower/plant/sine_cosine.hpp>
#include <thermopower/plant/variable_words.hpp>
#include <thermopower/plant/waves.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// @file axis_balances.hpp
/// The balances of a moving axis, its torques and its two instruments, from the equations that its rollout
/// integrates.

namespace thermopower::plant {

/// The variables of the freedoms of a moving axis. Held by tests/gap/where/localisation_test.cpp and the rows "signal
/// and submodel right" of docs/reference/gap-benchmark.md (seed 20270221).
struct AxisFreedomThresholds {
  double widest_rad = 0.5;      ///< angle over which a friction builds up, at most; shares of it by the next,
  double narrower = 0.3;        ///< each of the one before
  double resting_noises = 4.0;  ///< noises of the rate below which the axis rests
  double turned_noises = 2.0;   ///< noises of the rate by which its sign turns over
  double least_late_s = 0.004;  ///< unit of how late a torque may come, at least; else the rows' interval
  double spring_damping = 0.04;  ///< of an inertia behind a spring, of the critical one
  double lowest_Hz = 1.5;        ///< of its frequency
  double highest_Hz = 40.0;      ///< of its frequency
  double of_sampling = 0.3;      ///< highest frequency, of the rows'
  double next_frequency = 1.08;  ///< times the one before
};

namespace detail {

/// Dry friction that builds up over an angle after each reversal (Dahl's state), for several angles.
inline Eigen::MatrixXd building_up(const AxisAtRows& a) {
  constexpr AxisFreedomThresholds limit;
  const double reach =
      a.has_angle && a.angle.size() > 0 ? std::max(a.angle.maxCoeff() - a.angle.minCoeff(), 1e-3) : 1.0;
  Eigen::MatrixXd out(a.rate.size(), 4);
  for (Eigen::Index k = 0; k < out.cols(); ++k) {
    const double width =
        std::min(limit.widest_rad, reach) * std::pow(limit.narrower, static_cast<double>(k) + 1.0);
    for (const RunSpan& run : a.rows()->runs) {
      double z = 0.0;
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        out(i, k) = z;
        if (i + 1 == run.end) break;
        const double moved = 0.5 * (a.rate[i] + a.rate[i + 1]) * (a.rows()->t_s[i + 1] - a.rows()->t_s[i]);
        const double goal = moved > 0.0 ? 1.0 : -1.0;
        z = goal + (z - goal) * std::exp(-std::fabs(moved) / width);
      }
    }
  }
  return out;
}

/// Waves of the measured angle, for one scan. @param a  keeps the angle
inline std::shared_ptr<Waves> waves_of(const std::shared_ptr<const AxisAtRows>& a) {
  return std::make_shared<Waves>(std::shared_ptr<const Eigen::VectorXd>(a, &a->angle));
}

/// Temperatures above their mean.
inline Eigen::VectorXd warmer_than_mean(const Eigen::VectorXd& temperature) {
  return temperature.array() - temperature.mean();
}

/// How often a torque may repeat in a turn, as far as travel and rows show such a period.
inline std::vector<double> repeats_per_turn(const AxisAtRows& a) {
  constexpr double rows_per_period = 4.2;
  std::vector<double> counts;
  const double travel = a.angle.maxCoeff() - a.angle.minCoeff(), pace = a.rate.cwiseAbs().mean();
  for (int count = 2; count <= 64; ++count)
    if (travel * count >= rad_per_turn &&
        count * a.rows()->interval_s * pace <= rad_per_turn / rows_per_period)
      counts.push_back(count);
  return counts;
}

/// The words for a repetition in a turn.
inline std::string repeating(const char* what, double count) {
  return std::string(what) + " that repeats " + std::to_string(static_cast<int>(std::lround(count))) +
         " times a turn";
}

/// The freedoms of friction.
/// @param direction  which way the axis moves, -1 to 1
/// @param drive_Nm   torque of the drive
inline void add_friction_freedoms(Balance& b, const std::shared_ptr<const AxisAtRows>& a,
                                  const std::shared_ptr<const Eigen::VectorXd>& direction,
                                  const std::shared_ptr<const Eigen::VectorXd>& drive_Nm) {
  const auto add = [&](const std::string& variable, const std::string& words,
                       std::function<std::vector<Direction>()> directions,
                       double least = -std::numeric_limits<double>::infinity()) {
    b.freedoms.push_back({Submodel::mechanical_friction, variable, words,
                          [directions](double) { return directions(); }, least});
  };
  add(
      "rate_dps", "a friction that takes an angle to turn round",
      [a] { return sampled_directions(-building_up(*a)); }, 0.0);
  add("rate_dps", "a friction of the same size at every rate",
      [direction] { return sampled_directions(*direction); });
  add("rate_dps", "a friction that holds the axis at rest", [a, direction, drive_Nm] {
    // At rest, dry friction takes whatever the drive gives.
    const double rest = AxisFreedomThresholds().resting_noises * a->rate_noise;
    const Eigen::VectorXd moving = (a->rate.array().abs() > rest).cast<double>();
    return std::vector<Direction>{flow_sampled(direction->cwiseProduct(moving)),
                                  flow_held(drive_Nm->cwiseProduct((1.0 - moving.array()).matrix()))};
  });
  add("rate_dps", "another viscous friction", [a] { return sampled_directions(a->rate); });
  add("rate_dps", "a friction that depends on the rate",
      [a, direction] { return sampled_directions(scaled(hats(a->rate.cwiseAbs(), 5), *direction)); });
  add("rate_dps", "a friction that differs with the direction", [direction] {
    return sampled_directions(columns_of({*direction, Eigen::VectorXd::Ones(direction->size())}));
  });
  add("rate_dps", "a friction that depends on rate and direction",
      [a] { return sampled_directions(hats(a->rate, 9)); });
  add(a->command_name(), "a friction that grows with the torque", [direction, drive_Nm] {
    return std::vector<Direction>{flow_held(direction->cwiseProduct(drive_Nm->cwiseAbs()))};
  });
  if (a->inputs().covariate_motor_C.size() > 0)
    add("motor_C", "a friction that changes with the temperature", [a, direction] {
      // Grease thins by an exponential: over tens of degrees its curvature shows.
      const Eigen::VectorXd& motor_C = a->inputs().covariate_motor_C;
      const Eigen::VectorXd warmer = warmer_than_mean(motor_C);
      const Eigen::VectorXd z = warmer / std::max(warmer.cwiseAbs().maxCoeff(), 1e-12);
      return sampled_directions(
          columns_of({a->rate, a->rate.cwiseProduct(z), a->rate.cwiseProduct(z.cwiseAbs2()),
                      direction->cwiseProduct(z)}));
    });
}

/// The freedoms between command and torque.
inline void add_drive_freedoms(Balance& b, const std::shared_ptr<const AxisAtRows>& a,
                               const std::shared_ptr<const Eigen::VectorXd>& drive_Nm) {
  const auto add = [&](const std::string& variable, const std::string& words,
                       std::function<std::vector<Direction>()> directions,
                       double least = -std::numeric_limits<double>::infinity()) {
    b.freedoms.push_back(
        {Submodel::mechanical_drive, variable, words, [directions](double) { return directions(); }, least});
  };
  const auto held = [](const Eigen::MatrixXd& columns) {
    return directions_of(columns, [](Eigen::VectorXd c) { return flow_held(std::move(c)); });
  };
  add(a->command_name(), "another torque constant", [drive_Nm, held] { return held(*drive_Nm); });
  add(a->command_name(), "a torque that is not in proportion to the command",
      [drive_Nm, held] { return held(scaled(hats(drive_Nm->cwiseAbs(), 6), *drive_Nm)); });
  add(
      a->command_name() + "_per_s", "a torque that comes after the command",
      [a, drive_Nm] {
        const double unit_s = std::max(a->rows()->interval_s, AxisFreedomThresholds().least_late_s);
        std::vector<Direction> list;
        for (const double k : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0})
          list.push_back({{BalancePart::Kind::flow_held, *drive_Nm, k * unit_s},
                          {BalancePart::Kind::flow_held, *drive_Nm, 0.0, -1.0}});
        return list;
      },
      0.0);
  if (a->inputs().covariate_motor_C.size() > 0)
    add("motor_C", "a torque constant that changes with the temperature", [a, drive_Nm, held] {
      const Eigen::VectorXd& motor_C = a->inputs().covariate_motor_C;
      return held(columns_of({*drive_Nm, drive_Nm->cwiseProduct(warmer_than_mean(motor_C))}));
    });
  if (!a->has_angle) return;
  Freedom periodic{Submodel::mechanical_drive, "angle_deg", "",
                   [waves = waves_of(a), drive_Nm, held](double count) {
                     return held(scaled((*waves)(count), *drive_Nm));
                   }};
  periodic.scan = repeats_per_turn(*a);
  periodic.words_at = [](double count) { return repeating("a torque constant", count); };
  if (!periodic.scan.empty()) b.freedoms.push_back(std::move(periodic));
}

/// The freedoms of angle, time and inertia.
inline void add_load_freedoms(Balance& b, const std::shared_ptr<const AxisAtRows>& a) {
  const Eigen::Index n = a->rate.size();
  const auto add = [&](const std::string& variable, const std::string& words,
                       std::function<std::vector<Direction>()> directions) {
    b.freedoms.push_back(
        {Submodel::mechanical_load, variable, words, [directions](double) { return directions(); }});
  };
  if (a->has_angle) {
    const std::shared_ptr<Waves> waves = waves_of(a);
    add("angle_deg", "a torque with the sine of the angle",
        [waves] { return sampled_directions((*waves)(1.0)); });
    add("angle_deg", "a torque in proportion to the angle", [a, n] {
      return sampled_directions(columns_of({a->angle, Eigen::VectorXd::Ones(n)}));
    });
    add("angle_deg", "a torque that depends on the angle",
        [a] { return sampled_directions(even_hats(a->angle, 9)); });
    Freedom periodic{Submodel::mechanical_load, "angle_deg", "",
                     [waves](double count) { return sampled_directions((*waves)(count)); }};
    periodic.scan = repeats_per_turn(*a);
    periodic.words_at = [](double count) { return repeating("a torque", count); };
    if (!periodic.scan.empty()) b.freedoms.push_back(std::move(periodic));
  }
  add("t_s", "a constant torque", [n] { return sampled_directions(Eigen::VectorXd::Ones(n)); });
  b.freedoms.push_back({Submodel::mechanical_structure, "acceleration_rad_per_s2", "another inertia",
                        [a](double) { return std::vector<Direction>{further_store(a->rate)}; }});
  // A second inertia that follows the measured motion through a spring.
  constexpr AxisFreedomThresholds limit;
  Freedom spring{Submodel::mechanical_structure, "acceleration_rad_per_s2", "", [a](double hertz) {
                   const double w = rad_per_turn * hertz;
                   const SpringTwist twist(a->rate, *a->rows(), w, AxisFreedomThresholds().spring_damping);
                   return std::vector<Direction>{further_store(twist.rate_rad_per_s),
                                                 flow_sampled(w * w * twist.angle_rad)};
                 }};
  for (double hertz = limit.lowest_Hz;
       hertz <= std::min(limit.highest_Hz, limit.of_sampling / a->rows()->interval_s);
       hertz *= limit.next_frequency)
    spring.scan.push_back(hertz);
  spring.words_at = [](double hertz) {
    char words[80];
    std::snprintf(words, sizeof words, "an inertia behind a spring, %.1f Hz", hertz);
    return std::string(words);
  };
  if (!spring.scan.empty()) b.freedoms.push_back(std::move(spring));
}

}  // namespace detail

/// The torques, given the measured motion and command: N m.
inline Balance torque_balance(std::shared_ptr<const AxisAtRows> a, const std::vector<Covariate>& covariates) {
  const Inputs& in = a->inputs();
  const AxisAtRows::Values v = a->evaluate();
  const Eigen::Index n = in.rows();
  const auto drive_Nm = std::make_shared<const Eigen::VectorXd>(v.drive_Nm);
  const auto direction = std::make_shared<const Eigen::VectorXd>(
      (a->rate.array() / std::max(AxisFreedomThresholds().turned_noises * a->rate_noise, 1e-9))
          .tanh()
          .matrix());
  Balance b;
  b.quantity = Quantity::missing_torque;
  b.unit = "N m";
  b.signal = a->has_rate ? Signal::rate_dps : Signal::angle_deg;
  b.instrument = a->has_rate ? Submodel::sensing_rate : Submodel::sensing_angle;
  b.otherwise = Submodel::mechanical_drive;
  b.given = "Given the measured motion and command";
  b.form = BalanceForm::weak;
  b.rows = a->rows();
  b.measured = a->raw_rate;
  b.state = a->rate;
  if (!a->has_rate) {
    b.noise_from = a->raw_angle;
    b.noise_gain = a->slope_noise_per_angle();
  }
  b.capacity = Eigen::VectorXd::Constant(n, v.inertia_kgm2);
  b.flow_sampled = v.motion_Nm;
  b.flow_held = v.drive_Nm;
  b.held_delay_s = a->delay_s();
  if (in.torque_Nm.size() > 0) (b.held_delay_s > 0.0 ? b.flow_sampled : b.flow_held) += in.torque_Nm;
  b.half_widths = {4, 24};
  b.picture_half_width = 6;
  const std::vector<CalibratedConstant> calibrated = a->model().calibrated();
  for (const std::size_t constant : a->constants())
    b.constants.push_back({calibrated[constant].id, [a, constant, inertia_kgm2 = v.inertia_kgm2] {
                             AxisAtRows::Values by = a->slopes(constant);
                             const double store = by.inertia_kgm2 / inertia_kgm2;
                             Direction parts;
                             if (store != 0.0)
                               parts.push_back({BalancePart::Kind::store, a->rate, 0.0, store});
                             if (by.motion_Nm.cwiseAbs().maxCoeff() > 0.0)
                               parts.push_back({BalancePart::Kind::flow_sampled, std::move(by.motion_Nm)});
                             if (by.drive_Nm.cwiseAbs().maxCoeff() > 0.0)
                               parts.push_back({BalancePart::Kind::flow_held, std::move(by.drive_Nm)});
                             return parts;
                           }});
  detail::add_friction_freedoms(b, a, direction, drive_Nm);
  detail::add_drive_freedoms(b, a, drive_Nm);
  detail::add_load_freedoms(b, a);
  const std::string name = a->command_name(), unit = name == "voltage_V" ? "V" : "A";
  const Eigen::VectorXd& commanded = a->command();
  b.variables = {
      {"rate_dps", "deg/s", a->rate * deg_per_rad, OrderingVariable::Kind::sampled, Signal::rate_dps},
      {name, unit, commanded, OrderingVariable::Kind::held},
      {name + "_per_s", unit + "/s", commanded, OrderingVariable::Kind::derivative},
      {"acceleration_rad_per_s2", "rad/s2", a->rate, OrderingVariable::Kind::derivative, Signal::rate_dps},
      {"t_s", "s", in.t_s}};
  if (a->has_angle)
    b.variables.push_back(
        {"angle_deg", "deg", a->angle * deg_per_rad, OrderingVariable::Kind::sampled, Signal::angle_deg});
  if (in.covariate_motor_C.size() > 0) b.variables.push_back({"motor_C", "degC", in.covariate_motor_C});
  for (const Covariate& covariate : covariates) {
    const auto z = std::make_shared<const Eigen::VectorXd>(
        covariate.values / std::max(covariate.values.cwiseAbs().maxCoeff(), 1e-12));
    const auto add = [&](Submodel submodel, const std::string& words,
                         std::function<std::vector<Direction>(double)> directions) {
      b.freedoms.push_back(
          {submodel, covariate.name, words + the_variable(covariate.name), std::move(directions)});
    };
    add(Submodel::mechanical_drive, "a torque constant that changes with ", [drive_Nm, z](double) {
      return std::vector<Direction>{flow_held(*drive_Nm), flow_held(drive_Nm->cwiseProduct(*z))};
    });
    add(Submodel::mechanical_friction, "a friction that changes with ", [a, direction, z](double) {
      return std::vector<Direction>{flow_sampled(a->rate.cwiseProduct(*z)),
                                    flow_sampled(direction->cwiseProduct(*z))};
    });
    add(Submodel::mechanical_load, "a torque that comes with ", [z](double) {
      return std::vector<Direction>{flow_sampled(*z), flow_sampled(Eigen::VectorXd::Ones(z->size()))};
    });
    b.variables.push_back({covariate.name, unit_of_column(covariate.name), covariate.values});
  }
  return b;
}

/// The measured effort against what the servo makes of its target and of the measured motion: A.
inline Balance effort_balance(const std::shared_ptr<const AxisAtRows>& a) {
  const Inputs& in = a->inputs();
  const auto servo_A = std::make_shared<const Eigen::VectorXd>(a->servo_current_A());
  Balance b;
  b.quantity = Quantity::missing_current;
  b.unit = "A";
  b.signal = Signal::current_A;
  b.instrument = Submodel::sensing_current;
  b.otherwise = Submodel::mechanical_drive;
  b.given = "Given the measured motion and the target";
  b.form = BalanceForm::algebraic;
  b.rows = a->rows();
  b.measured = in.of(Signal::current_A);
  b.state = in.drive_A;
  b.flow_sampled = *servo_A;
  b.noise_from = b.measured - *servo_A;
  const Model& model = a->model();
  const std::vector<CalibratedConstant> calibrated = model.calibrated();
  const auto by_constant = [a, &model](std::size_t constant) {
    constexpr double step = 1e-4;  // of the logarithm
    return Eigen::VectorXd(
        (a->servo_current_A(model.moved(constant, step)) - a->servo_current_A(model.moved(constant, -step))) *
        (0.5 / step));
  };
  const auto add = [&](SubmodelName submodel, const std::string& variable, const std::string& words,
                       std::function<Eigen::MatrixXd()> columns) {
    add_sampled_freedom(b, std::move(submodel), variable, words, std::move(columns));
  };
  add(Submodel::sensing_current, "", "the same offset at every current, none included",
      [n = in.rows()] { return Eigen::MatrixXd(Eigen::VectorXd::Ones(n)); });
  for (std::size_t k = 0; k < calibrated.size(); ++k) {
    if (calibrated[k].block != "servo" || !calibrated[k].has_slack) continue;
    b.constants.push_back({calibrated[k].id, [by_constant, k] { return flow_sampled(by_constant(k)); }});
    add(Submodel::mechanical_drive, "servo_A", "another gain " + calibrated[k].id + " of the servo",
        [by_constant, k] { return Eigen::MatrixXd(by_constant(k)); });
  }
  add(Submodel::mechanical_drive, "servo_A", "a current that is not in proportion to what the servo asks for",
      [servo_A] { return Eigen::MatrixXd(scaled(hats(servo_A->cwiseAbs(), 6), *servo_A)); });
  add(Submodel::mechanical_drive, "servo_A_per_s", "a current that comes after the servo asks for it",
      [a, servo_A] {
        Eigen::VectorXd slope = Eigen::VectorXd::Zero(servo_A->size());
        const BalanceRows& rows = *a->rows();
        for (const RunSpan& run : rows.runs)
          for (Eigen::Index i = run.begin + 1; i < run.end; ++i)
            slope[i] = ((*servo_A)[i] - (*servo_A)[i - 1]) / (rows.t_s[i] - rows.t_s[i - 1]);
        return Eigen::MatrixXd(slope);
      });
  b.variables = {
      {"servo_A", "A", *servo_A},
      {"servo_A_per_s", "A/s", *servo_A, OrderingVariable::Kind::derivative},
      {"rate_dps", "deg/s", a->rate * deg_per_rad, OrderingVariable::Kind::sampled, Signal::rate_dps},
      {"t_s", "s", in.t_s}};
  return b;
}

/// The angle against the rate, two instruments that must agree: deg/s.
inline Balance instrument_balance(const AxisAtRows& a) {
  const Eigen::Index n = a.rate.size();
  const auto angle = std::make_shared<const Eigen::VectorXd>(a.angle);
  const auto rate_dps = std::make_shared<const Eigen::VectorXd>(a.rate * deg_per_rad);
  Balance b;
  b.quantity = Quantity::angle_slope_minus_rate;
  b.unit = "deg/s";
  b.signal = Signal::angle_deg;
  b.instrument = Submodel::sensing_angle;
  b.otherwise = Submodel::sensing_angle;
  b.given = "With angle and rate held against each other";
  b.form = BalanceForm::weak;
  b.rows = a.rows();
  b.measured = a.raw_angle * deg_per_rad;
  b.state = a.angle * deg_per_rad;
  b.flow_sampled = *rate_dps;
  b.flow_measured = a.raw_rate * deg_per_rad;
  b.half_widths = {16};
  b.picture_half_width = 16;
  b.reads = {Signal::rate_dps};
  b.freedoms.push_back(
      {Submodel::sensing_angle, "t_s", "the rate's integral and the angle part at a constant pace",
       [n](double) { return std::vector<Direction>{flow_sampled(Eigen::VectorXd::Ones(n))}; }});
  // A gyroscope's bias drags along a torque that is not there; a drifting angle does not.
  b.freedoms.back().or_instrument = Submodel::sensing_rate;
  b.freedoms.back().correction = Correction{Signal::rate_dps, -1.0};
  b.freedoms.push_back({Submodel::sensing_angle, "rate_dps",
                        "the angle moves by another factor than the rate says",
                        [rate_dps](double) { return std::vector<Direction>{flow_sampled(*rate_dps)}; }});
  Freedom off_centre{Submodel::sensing_angle, "angle_deg", "",
                     [rate_dps, waves = std::make_shared<Waves>(angle)](double count) {
                       return sampled_directions(scaled((*waves)(count), *rate_dps));
                     }};
  // A disc off its centre errs once a turn, an oval one twice, a magnet as often as it has pairs of poles.
  off_centre.scan = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};
  off_centre.words_at = [](double count) {
    return count == 1.0 ? "an error of the angle that repeats every turn"
                        : detail::repeating("an error of the angle", count);
  };
  b.freedoms.push_back(std::move(off_centre));
  b.variables = {
      {"rate_dps", "deg/s", *rate_dps, OrderingVariable::Kind::sampled, Signal::rate_dps},
      {"angle_deg", "deg", a.angle * deg_per_rad, OrderingVariable::Kind::sampled, Signal::angle_deg},
      {"t_s", "s", a.inputs().t_s}};
  return b;
}

/// The balances of an axis, as far as its signals are judged. Model, catalogue and inputs must outlive them.
inline std::vector<BalanceSource> axis_balances(const Model& model, const Catalogue& catalogue,
                                                const Inputs& inputs, std::vector<Covariate> covariates) {
  std::vector<BalanceSource> list;
  const bool angle = inputs.judged(Signal::angle_deg), rate = inputs.judged(Signal::rate_dps);
  if (!angle && !rate) return list;
  const auto shared = std::make_shared<std::vector<Covariate>>(std::move(covariates));
  if (angle && rate)
    list.push_back({Quantity::angle_slope_minus_rate,
                    Signal::angle_deg,
                    {Signal::rate_dps},
                    [&model, &catalogue, &inputs](const ReadingOffsets& offsets) {
                      return instrument_balance(AxisAtRows(model, catalogue, inputs, offsets));
                    }});
  list.push_back({Quantity::missing_torque,
                  rate ? Signal::rate_dps : Signal::angle_deg,
                  {},
                  [&model, &catalogue, &inputs, shared](const ReadingOffsets& offsets) {
                    return torque_balance(
                        std::make_shared<const AxisAtRows>(model, catalogue, inputs, offsets), *shared);
                  }});
  if (inputs.effort_is_output)
    list.push_back({Quantity::missing_current,
                    Signal::current_A,
                    {},
                    [&model, &catalogue, &inputs](const ReadingOffsets& offsets) {
                      return effort_balance(
                          std::make_shared<const AxisAtRows>(model, catalogue, inputs, offsets));
                    }});
  return list;
}

}  // namespace thermopower::plant
