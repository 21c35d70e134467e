// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "replay.hpp"

#include <thermopower/thermopower.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "table.hpp"

namespace thesis {
namespace {

namespace tp = thermopower;

constexpr double cycle_s = 0.03;      // the program's cycle
constexpr int cycles_per_tick = 200;  // a tick is a tenth of a minute
constexpr double tick_min = cycles_per_tick * cycle_s / 60.0;
constexpr double supply_V = 13.0;
const double nothing = std::numeric_limits<double>::quiet_NaN();

/// A temperature that goes on by one tick when called.
using Tick = std::function<double()>;

/// A motor at constant power (0: cooling), open loop.
template <class Motor, class Step>
Tick open_loop(double power_param, double start_C, double air_C) {
  using Model = tp::ThermalModel<tp::ThesisHeating<double>, tp::RateCooling<double>, Step>;
  const tp::CurrentModel<tp::ThesisCurrent<double>> current(Motor::template current_law<double>());
  Model model({Motor::template heating_law<double>(), Motor::template cooling_law<double>()}, start_C);
  return [=]() mutable {
    for (int i = 0; i < cycles_per_tick; ++i) {
      const auto drawn = current.at_power(power_param, supply_V, model.hottest_C());
      model.step({drawn.winding_power_W, drawn.v_rms_V, {air_C, 0.0}}, cycle_s);
    }
    return model.hottest_C();
  };
}

/// A motor whose axis asks for one power level all the time and is limited, as in Table 5.4.
template <class Motor, class Rule>
Tick closed_loop(int power_param, double start_C, double air_C) {
  using Axis = tp::AxisController<Motor, tp::StepPowerLaw<>, tp::SafetyLimiter<Rule>, tp::NoGain>;
  Axis axis;
  axis.start(static_cast<float>(start_C));
  const float error_deg = (static_cast<float>(power_param) / 25.0f + 0.5f) / 10.0f;
  return [=]() mutable {
    for (int i = 0; i < cycles_per_tick; ++i)
      axis.step({error_deg, static_cast<float>(supply_V), static_cast<float>(air_C), tp::LimitReason::none},
                static_cast<float>(cycle_s));
    return static_cast<double>(axis.state().motor_C);
  };
}

struct Measured {
  std::vector<double> minutes, motor_C;
};

Experiment run(Experiment::Kind kind, const std::string& motor, const std::string& table, int power_param,
               const Measured& measured, Tick program, Tick corrected) {
  Experiment experiment = {kind, motor, table, power_param, {}};
  const double start_C = measured.motor_C.front();
  experiment.curve.push_back({0.0, start_C, start_C, start_C});
  size_t next = 1;
  for (int tick = 1; next < measured.minutes.size(); ++tick) {
    Point point = {tick * tick_min, nothing, program(), corrected()};
    if (std::abs(point.x - measured.minutes[next]) < tick_min / 2) point.measured = measured.motor_C[next++];
    experiment.curve.push_back(point);
  }
  return experiment;
}

template <class Motor>
Experiment open(Experiment::Kind kind, const std::string& motor, const std::string& table, int power_param,
                const Measured& measured, double air_C) {
  const double start_C = measured.motor_C.front();
  return run(kind, motor, table, power_param, measured,
             open_loop<typename Motor::AsProgrammed, tp::EulerStep>(power_param, start_C, air_C),
             open_loop<Motor, tp::LinearizedStep>(power_param, start_C, air_C));
}

template <class Motor>
Experiment current(const std::string& motor, const std::string& table, int power_param, double v_rms_V,
                   std::vector<std::pair<double, double>> measured) {
  const auto program = Motor::AsProgrammed::template current_law<double>();
  const auto corrected = Motor::template current_law<double>();
  Experiment experiment = {Experiment::Kind::current, motor, table, power_param, {}};
  std::sort(measured.begin(), measured.end());
  for (const auto& [motor_C, current_mA] : measured)
    experiment.curve.push_back({motor_C, current_mA, 1000.0 * program.current_A(v_rms_V, motor_C),
                                1000.0 * corrected.current_A(v_rms_V, motor_C)});
  return experiment;
}

/// Rows of one experiment: from `row` on while the columns that name it do not change.
size_t end_of_experiment(const Table& table, size_t row, const std::vector<std::string>& columns) {
  size_t end = row + 1;
  while (end < table.rows() && std::all_of(columns.begin(), columns.end(), [&](const auto& c) {
           return table.text(end, c) == table.text(row, c);
         }))
    ++end;
  return end;
}

Measured read_measured(const Table& table, size_t from, size_t to, const std::string& column) {
  Measured measured;
  for (size_t row = from; row < to; ++row) {
    const double minutes = table.number(row, "t_min");
    if (row == from ? minutes != 0.0 : minutes <= measured.minutes.back())
      table.refuse(row, "t_min", "expected 0 in the first row of an experiment, and later times below it");
    if (minutes > 1000.0 || std::abs(std::remainder(minutes, tick_min)) > 1e-6)
      table.refuse(row, "t_min", "expected whole tenths of a minute, at most 1000");
    measured.minutes.push_back(minutes);
    measured.motor_C.push_back(table.number(row, column));
  }
  return measured;
}

int power_of(const Table& table, size_t row) {
  const double power = table.number(row, "power_param");
  if (!(power >= 1.0 && power <= 255.0)) table.refuse(row, "power_param", "expected 1 .. 255");
  return static_cast<int>(power);
}

/// Table 4.1 or 4.2: current against temperature, and the heating that came with it.
template <class Motor>
void add_bench(std::vector<Experiment>& all, const std::string& folder, const std::string& file,
               const std::string& name) {
  const Table table = Table::read(folder + "/" + file, {"motor", "experiment", "power_param", "v_rms_V",
                                                        "T_air_C", "t_min", "T_motor_C", "I_mA"});
  for (size_t row = 0; row < table.rows();) {
    const size_t end = end_of_experiment(table, row, {"experiment"});
    const int power_param = power_of(table, row);
    std::vector<std::pair<double, double>> currents;
    for (size_t i = row; i < end; ++i)
      currents.emplace_back(table.number(i, "T_motor_C"), table.number(i, "I_mA"));
    all.push_back(
        current<Motor>(table.text(row, "motor"), name, power_param, table.number(row, "v_rms_V"), currents));
    all.push_back(open<Motor>(Experiment::Kind::heating, table.text(row, "motor"), name, power_param,
                              read_measured(table, row, end, "T_motor_C"), table.number(row, "T_air_C")));
    row = end;
  }
}

template <class Motor>
void add_cooling(std::vector<Experiment>& all, const std::string& folder, const std::string& file,
                 const std::string& name) {
  const Table table = Table::read(folder + "/" + file, {"motor", "t_min", "T_motor_C", "T_air_C"});
  all.push_back(open<Motor>(Experiment::Kind::cooling, table.text(0, "motor"), name, 0,
                            read_measured(table, 0, table.rows(), "T_motor_C"), table.number(0, "T_air_C")));
}

}  // namespace

Experiment::Distance Experiment::distance(double Point::*model) const {
  Distance distance = {0, 0.0, 0.0};
  for (size_t i = is_current() ? 0 : 1; i < curve.size(); ++i) {
    const double difference = curve[i].*model - curve[i].measured;
    if (std::isnan(difference)) continue;
    ++distance.points;
    distance.rmse += difference * difference;
    if (std::abs(difference) > std::abs(distance.worst)) distance.worst = difference;
  }
  distance.rmse = std::sqrt(distance.rmse / distance.points);
  return distance;
}

std::vector<Experiment> replay(const std::string& folder, double air_C) {
  using Small = tp::motors::Bgm2606_90t;
  using Large = tp::motors::Bgm5208_200_12;
  std::vector<Experiment> all;
  add_bench<Small>(all, folder, "table4_1.csv", "4.1");
  add_bench<Large>(all, folder, "table4_2.csv", "4.2");
  add_cooling<Small>(all, folder, "table4_3.csv", "4.3");
  add_cooling<Large>(all, folder, "table4_6.csv", "4.6");

  const Table cooling = Table::read(folder + "/table5_1.csv", {"motor", "t_min", "T_measured_C"});
  for (size_t row = 0; row < cooling.rows();) {
    const size_t end = end_of_experiment(cooling, row, {"motor"});
    const Measured measured = read_measured(cooling, row, end, "T_measured_C");
    const std::string& motor = cooling.text(row, "motor");
    all.push_back(motor == "BGM2606-90T"
                      ? open<Small>(Experiment::Kind::cooling, motor, "5.1", 0, measured, air_C)
                      : open<Large>(Experiment::Kind::cooling, motor, "5.1", 0, measured, air_C));
    row = end;
  }

  for (const std::string name : {"5.2", "5.3", "5.4"}) {
    const Table table = Table::read(folder + "/table" + name.substr(0, 1) + "_" + name.substr(2) + ".csv",
                                    {"motor", "power_param", "t_min", "T_measured_C"});
    for (size_t row = 0; row < table.rows();) {
      const size_t end = end_of_experiment(table, row, {"motor", "power_param"});
      const int power_param = power_of(table, row);
      const Measured measured = read_measured(table, row, end, "T_measured_C");
      const std::string& motor = table.text(row, "motor");
      if (name == "5.2")
        all.push_back(open<Large>(Experiment::Kind::heating, motor, name, power_param, measured, air_C));
      else if (name == "5.3")
        all.push_back(open<Small>(Experiment::Kind::heating, motor, name, power_param, measured, air_C));
      else
        all.push_back(
            run(Experiment::Kind::protection, motor, name, power_param, measured,
                closed_loop<Small::AsProgrammed, tp::PerCycle>(power_param, measured.motor_C.front(), air_C),
                closed_loop<Small, tp::PerSecond>(power_param, measured.motor_C.front(), air_C)));
      row = end;
    }
  }
  return all;
}

}  // namespace thesis
