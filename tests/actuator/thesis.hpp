// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/current_model.hpp>
#include <thermopower/actuator/thermal_model.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>
#include <thermopower/motors/bgm5208_200_12.hpp>

#include <Eigen/Dense>

#include "../../examples/thesis_replay/table.hpp"
#include "near.hpp"

#include <map>

namespace thesis {

namespace tp = thermopower;

inline Table table(const std::string& number) {
  return Table::read(std::string(THERMOPOWER_TEST_DATA) + "/thesis/table" + number + ".csv", {"motor"});
}

inline const std::string small = "BGM2606-90T", large = "BGM5208-200-12";

/// Rows of Table 4.1 or 4.2, by experiment.
struct Row {
  double volt, air_C, time_min, motor_C, current_mA;
  double rate, cooling, r, r_inv;  // printed; NaN in the first row
};
inline std::map<int, std::vector<Row>> experiments(const std::string& number) {
  const Table source = table(number);
  std::map<int, std::vector<Row>> found;
  for (size_t i = 0; i < source.rows(); ++i) {
    const auto printed = [&](const char* column) {
      return source.number_if_any(i, column).value_or(std::nan(""));
    };
    found[static_cast<int>(source.number(i, "experiment"))].push_back(
        {source.number(i, "v_rms_V"), source.number(i, "T_air_C"), source.number(i, "t_min"),
         source.number(i, "T_motor_C"), source.number(i, "I_mA"), printed("dTdt_printed_C_per_min"),
         printed("cooling_printed_C_per_min"), printed("r_printed_C_per_min_per_W"),
         printed("r_inv_printed_W_min_per_C")});
  }
  return found;
}

/// Least squares: coefficients of 1, x, x^2 ...
inline Eigen::VectorXd polynomial_fit(const std::vector<double>& x, const std::vector<double>& y,
                                      int degree) {
  Eigen::MatrixXd powers(static_cast<Eigen::Index>(x.size()), degree + 1);
  Eigen::VectorXd values(static_cast<Eigen::Index>(x.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] = y[static_cast<size_t>(i)];
    for (int k = 0; k <= degree; ++k) powers(i, k) = std::pow(x[static_cast<size_t>(i)], k);
  }
  return powers.colPivHouseholderQr().solve(values);
}

/// Temperatures each minute of a motor that is heated at a constant power parameter, as eq 4.21 steps it.
template <class Heating, class Cooling, class Current>
std::vector<double> heat(const Heating& heating, const Cooling& cooling, const Current& law,
                         double power_param, double start_C, double air_C, int minutes, double dt_s = 0.03) {
  const tp::CurrentModel<Current> current(law);
  tp::ThermalModel<Heating, Cooling, tp::EulerStep> model({heating, cooling}, start_C);
  std::vector<double> temperatures = {start_C};
  const int steps = static_cast<int>(60.0 / dt_s + 0.5);
  for (int minute = 0; minute < minutes; ++minute) {
    for (int i = 0; i < steps; ++i) {
      const auto drawn = current.at_power(power_param, 13.0, model.hottest_C());
      model.step({drawn.winding_power_W, drawn.v_rms_V, {air_C, 0.0}}, dt_s);
    }
    temperatures.push_back(model.hottest_C());
  }
  return temperatures;
}

/// The same with every law of a motor.
template <class Motor>
std::vector<double> heat(double power_param, double start_C, double air_C, int minutes) {
  return heat(Motor::template heating_law<double>(), Motor::template cooling_law<double>(),
              Motor::template current_law<double>(), power_param, start_C, air_C, minutes);
}

}  // namespace thesis
