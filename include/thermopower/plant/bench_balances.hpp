// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/bench_at_rows.hpp>
#include <thermopower/plant/balance.hpp>
#include <thermopower/plant/bench_rollout.hpp>
#include <thermopower/plant/columns.hpp>
#include <thermopower/plant/piecewise_linear.hpp>
#include <thermopower/plant/samples.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// @file bench_balances.hpp
/// The balances of a motor on a bench, circuit and body, from the laws and effects that its rollout integrates.

namespace thermopower::plant {

/// The current, given the measured temperature and supply: A.
inline Balance current_balance(const BenchAtRows& bench, const std::vector<Covariate>& covariates) {
  struct Known {
    BenchAtRows::Values v;
    Eigen::VectorXd on, charge;
  };
  const Inputs& in = bench.inputs();
  const auto k = std::make_shared<Known>();
  k->v = bench.evaluate(HeatTold::by_law);
  for (Eigen::VectorXd* of_the_body : {&k->v.heat_W, &k->v.loss_W, &k->v.capacity, &k->v.relaxation_per_s})
    of_the_body->resize(0);  // a recording may be long
  const Eigen::Index n = in.rows();
  k->on = (k->v.v_rms_V.array() > 0.0).cast<double>();
  k->charge = Eigen::VectorXd::Zero(n);
  for (const RunSpan& run : in.runs) {
    double sum = run.drawn_Ah;
    for (Eigen::Index i = run.begin; i < run.end; ++i) {
      k->charge[i] = sum;
      if (i + 1 == run.end) break;
      sum += in.held_current_A[i] * k->v.v_rms_V[i] / std::max(k->v.supply_V[i], 1e-9) *
             (in.t_s[i + 1] - in.t_s[i]) / 3600.0;
    }
  }
  Balance b;
  b.quantity = Quantity::missing_current;
  b.unit = "A";
  b.signal = Signal::current_A;
  b.instrument = Submodel::sensing_current;
  b.otherwise = Submodel::electrical;
  b.given = "Given the measured temperature and supply";
  b.form = BalanceForm::algebraic;
  b.rows = bench.rows();
  b.measured = in.of(Signal::current_A);
  b.state = in.held_current_A;
  b.flow_sampled = k->v.law_A;
  b.noise_from = b.measured - k->v.law_A;  // a step of the power is no noise
  b.reads = {Signal::motor_C};
  b.restated = RestatedQuantity{Quantity::missing_voltage, "V", k->v.ohm.cwiseProduct(k->on)};
  const std::vector<CalibratedConstant> calibrated = bench.model().calibrated();
  for (const std::size_t constant : bench.constants())
    b.constants.push_back({calibrated[constant].id, [bench, constant] {
                             Eigen::VectorXd slope = bench.slopes(HeatTold::by_law, constant).law_A;
                             return slope.cwiseAbs().maxCoeff() > 0.0 ? flow_sampled(std::move(slope))
                                                                      : Direction();
                           }});
  const auto add = [&](SubmodelName submodel, const std::string& variable, const std::string& words,
                       std::function<Eigen::MatrixXd()> columns) {
    add_sampled_freedom(b, std::move(submodel), variable, words, std::move(columns));
  };
  add(Submodel::sensing_current, "", "the same offset at every current, none included",
      [n] { return Eigen::MatrixXd(Eigen::VectorXd::Ones(n)); });
  b.freedoms.back().correction = Correction{Signal::current_A, 1.0};
  add(Submodel::electrical, "v_rms_V", "the same factor at every voltage",
      [k] { return Eigen::MatrixXd(k->v.law_A); });
  b.freedoms.back().or_instrument = Submodel::sensing_current;
  add(Submodel::electrical, "motor_C", "a resistance that depends on the temperature", [k] {
    const Eigen::VectorXd warmer = (k->v.winding_C.array() - 25.0) / 10.0;
    return columns_of({k->v.law_A, k->v.law_A.cwiseProduct(warmer)});
  });
  b.freedoms.push_back(
      {Submodel::electrical, "v_rms_V", "a voltage lost that depends on the drive", [k](double) {
         const std::vector<double> knots = equal_count_edges(k->v.v_rms_V, 5);
         return made_directions(
             BalancePart::Kind::flow_sampled, static_cast<Eigen::Index>(knots.size()),
             [k, knots](Eigen::Index i) {
               return Eigen::VectorXd(hat(k->v.v_rms_V, knots, i).cwiseProduct(k->v.law_A));
             });
       }});
  add(Submodel::electrical, "v_rms_V", "a piece of the duty that is lost", [k] {
    Eigen::MatrixXd columns(k->on.size(), 2);
    columns.col(0) = k->v.law_A;
    for (Eigen::Index i = 0; i < k->on.size(); ++i)
      columns(i, 1) =
          k->on[i] > 0.0 ? k->v.law_A[i] * std::pow(k->v.supply_V[i] / k->v.v_rms_V[i], 2.0) : 0.0;
    return columns;
  });
  add(Submodel::electrical, "v_rms_V", "a supply that gives way under load and with the charge drawn", [k] {
    return columns_of(
        {k->v.law_A, k->v.law_A.cwiseProduct(k->v.v_rms_V.cwiseAbs2()), k->v.law_A.cwiseProduct(k->charge)});
  });
  b.variables.reserve(4 + covariates.size());
  b.variables.push_back({"v_rms_V", "V", k->v.v_rms_V, OrderingVariable::Kind::held});
  b.variables.push_back(
      {"motor_C", "degC", k->v.winding_C, OrderingVariable::Kind::sampled, Signal::motor_C});
  b.variables.push_back({"law_A", "A", k->v.law_A});
  b.variables.push_back({"t_s", "s", in.t_s});
  for (const Covariate& covariate : covariates) {
    const auto z = std::make_shared<Eigen::VectorXd>(
        covariate.name == "rate_dps" ? Eigen::VectorXd(covariate.values.cwiseAbs()) : covariate.values);
    *z /= std::max(z->cwiseAbs().maxCoeff(), 1e-12);
    add(Submodel::electrical, covariate.name,
        "a voltage lost that grows with " + the_variable(covariate.name), [k, z] {
          Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(z->size(), 2);
          columns.col(0) = k->v.law_A;
          for (Eigen::Index i = 0; i < z->size(); ++i)
            if (k->v.ohm[i] > 0.0) columns(i, 1) = k->on[i] * (*z)[i] / k->v.ohm[i];
          return columns;
        });
    add(Submodel::electrical, covariate.name, "a factor that changes with " + the_variable(covariate.name),
        [k, z] {
          return columns_of({k->v.law_A, k->v.law_A.cwiseProduct(*z)});
        });
    b.variables.push_back({covariate.name, unit_of_column(covariate.name), covariate.values});
  }
  return b;
}

/// The heat of a body, given its temperature and the air's: W.
inline Balance heat_balance(const BenchAtRows& bench, const std::vector<Covariate>& covariates,
                            HeatTold told) {
  struct Known {
    BenchAtRows::Values v;
    Eigen::VectorXd rise, loss_per_K, ambient, state;
    double shortest_s = 0.0, longest_s = 0.0;
  };
  const Inputs& in = bench.inputs();
  const auto k = std::make_shared<Known>();
  k->v = bench.evaluate(told);
  for (Eigen::VectorXd* of_the_circuit : {&k->v.law_A, &k->v.ohm}) of_the_circuit->resize(0);
  const Eigen::Index n = in.rows();
  k->rise = k->v.winding_C - in.ambient_C;
  const double mean_loss = k->v.capacity.cwiseProduct(k->v.relaxation_per_s).mean();
  k->loss_per_K = Eigen::VectorXd::Constant(n, mean_loss > 0.0 ? mean_loss : 1.0);
  const double slowest_s = 1.0 / std::max(k->v.relaxation_per_s.mean(), 1e-12);
  const auto rows = bench.rows();
  k->shortest_s = std::max(2.0 * rows->interval_s, 0.004 * slowest_s);
  k->longest_s = std::max(0.4 * slowest_s, 1.5 * k->shortest_s);

  Balance b;
  b.quantity = Quantity::missing_heat;
  b.unit = "W";
  b.signal = Signal::motor_C;
  b.instrument = Submodel::sensing_temperature;
  b.otherwise = Submodel::thermal_heating;
  b.given = "Given the heat and the air temperature";
  b.form = BalanceForm::filtered;
  b.rows = rows;
  b.noise_from = in.of(Signal::motor_C);
  // Where the thermometer shows the node by a known law, its readings are undone.
  b.measured = k->v.winding_C;
  for (Eigen::Index i = 0; i < n; ++i)
    if (!std::isfinite(in.of(Signal::motor_C)[i])) b.measured[i] = missing;
  b.state = k->v.winding_C;
  b.capacity = k->v.capacity;
  b.flow_sampled = -k->v.loss_W;
  b.flow_held = k->v.heat_W;
  b.relaxation_per_s = std::move(k->v.relaxation_per_s);
  if (told != HeatTold::by_law && told != HeatTold::by_record && in.heat != HeatSource::drive)
    b.reads = {Signal::current_A};
  const std::vector<CalibratedConstant> calibrated = bench.model().calibrated();
  for (const std::size_t constant : bench.constants())
    b.constants.push_back(
        {calibrated[constant].id, [bench, told, constant, k] {
           BenchAtRows::Slopes by = bench.slopes(told, constant);
           by.capacity = by.capacity.cwiseQuotient(k->v.capacity);
           Direction direction;
           constexpr double none = 1e-9;
           if (by.heat_W.cwiseAbs().maxCoeff() > none)
             direction.push_back({BalancePart::Kind::flow_held, std::move(by.heat_W)});
           if (by.loss_W.cwiseAbs().maxCoeff() > none)
             direction.push_back({BalancePart::Kind::flow_sampled, std::move(by.loss_W), 0.0, -1.0});
           if (by.capacity.cwiseAbs().maxCoeff() > none)
             direction.push_back(
                 {BalancePart::Kind::store, k->v.winding_C, 0.0, 1.0, std::move(by.capacity)});
           return direction;
         }});
  const auto add = [&](SubmodelName submodel, const std::string& variable, const std::string& words,
                       std::function<std::vector<Direction>()> directions,
                       double least = -std::numeric_limits<double>::infinity()) {
    b.freedoms.push_back(
        {std::move(submodel), variable, words, [directions](double) { return directions(); }, least});
  };
  const auto watts = [](const Eigen::MatrixXd& columns) {
    return directions_of(columns, [](Eigen::VectorXd c) { return flow_held(std::move(c)); });
  };
  // A piecewise linear function of a variable, times a size.
  typedef std::function<Eigen::VectorXd()> Column;
  const auto watts_by = [](const std::vector<double>& knots, const Column& variable, const Column& size) {
    return made_directions(BalancePart::Kind::flow_held, static_cast<Eigen::Index>(knots.size()),
                           [knots, variable, size](Eigen::Index i) {
                             return Eigen::VectorXd(hat(variable(), knots, i).cwiseProduct(size()));
                           });
  };
  const auto contents = [k](Eigen::Index bins) {
    const double from = k->v.winding_C.minCoeff(),
                 width = (k->v.winding_C.maxCoeff() - from) / static_cast<double>(bins);
    return made_directions(BalancePart::Kind::store, bins, [k, from, width](Eigen::Index i) {
      return Eigen::VectorXd(
          (k->v.winding_C.array() - (from + width * static_cast<double>(i))).max(0.0).min(width));
    });
  };
  add(Submodel::sensing_temperature, "rise_K", "a thermometer that shows another rise than the heat makes",
      [k, watts] { return watts(k->v.heat_W); });
  add(Submodel::thermal_storage, "dT_dt", "another heat capacity",
      [k] { return std::vector<Direction>{further_store(k->v.winding_C)}; });
  add(Submodel::thermal_loss, "rise_K", "another conductance", [k, watts] { return watts(-k->v.loss_W); });
  add(Submodel::thermal_loss, "rise_K", "a loss that is there without a rise",
      [k, watts] { return watts(k->loss_per_K); });
  add(Submodel::thermal_loss, "rise_K", "a conductance that depends on the rise", [k, watts_by] {
    return watts_by(
        even_knots(k->rise, 4), [k] { return k->rise; },
        [k]() -> Eigen::VectorXd { return k->loss_per_K.cwiseProduct(k->rise); });
  });
  add(Submodel::thermal_storage, "motor_C", "a heat capacity that depends on the temperature",
      [contents] { return contents(7); });
  add(Submodel::thermal_heating, "heat_W", "a heat that is not in proportion to the law's", [k, watts_by] {
    const Column heat = [k] { return k->v.heat_W; };
    return watts_by(even_knots(k->v.heat_W, 4), heat, heat);
  });
  const bool by_supply =
      in.power_param.size() > 0 && std::holds_alternative<ThesisThermalModel>(bench.model().thermal);
  if (by_supply) {
    add(
        Submodel::thermal_heating, "v_rms_V", "heat by the power at the supply and not at the motor",
        [k, watts] {
          Eigen::VectorXd supply(k->rise.size());
          for (Eigen::Index i = 0; i < supply.size(); ++i)
            supply[i] =
                k->v.v_rms_V[i] > 0.0 ? k->v.heat_W[i] * (k->v.supply_V[i] / k->v.v_rms_V[i] - 1.0) : 0.0;
          return watts(supply);
        },
        0.0);
  }
  add(
      Submodel::thermal_storage, "dT_dt", "a part that follows the heat faster than the whole",
      [k, rows] {
        return made_directions(BalancePart::Kind::reading, 5, [k, rows](Eigen::Index i) {
          return lagged(k->v.heat_W,
                        k->shortest_s * std::pow(k->longest_s / k->shortest_s, static_cast<double>(i) / 4.0),
                        true, rows->t_s, rows->runs);
        });
      },
      0.0);
  Freedom late{Submodel::sensing_temperature, "dT_dt", "",
               [](double tau_s) {
                 return std::vector<Direction>{{{BalancePart::Kind::reading_late, {}, tau_s}}};
               },
               0.0};
  for (int i = 0; i < 14; ++i)
    late.scan.push_back(k->shortest_s * std::pow(k->longest_s / k->shortest_s, i / 13.0));
  late.words_at = [](double tau_s) {
    char text[80];
    std::snprintf(text, sizeof text, "a reading that comes %.3g s after the temperature", tau_s);
    return std::string(text);
  };
  b.freedoms.push_back(std::move(late));
  b.variables.reserve(6 + covariates.size());
  b.variables.push_back({"rise_K", "K", k->rise, OrderingVariable::Kind::sampled, Signal::motor_C});
  b.variables.push_back(
      {"motor_C", "degC", k->v.winding_C, OrderingVariable::Kind::sampled, Signal::motor_C});
  b.variables.push_back({"heat_W", "W", k->v.heat_W, OrderingVariable::Kind::held});
  b.variables.push_back(
      {"dT_dt", "K/s", k->v.winding_C, OrderingVariable::Kind::derivative, Signal::motor_C});
  b.variables.push_back(
      {"v_rms_V", "V", by_supply ? k->v.v_rms_V : std::move(k->v.v_rms_V), OrderingVariable::Kind::held});
  if (!by_supply) k->v.supply_V.resize(0);
  b.variables.push_back({"t_s", "s", in.t_s});
  for (const Covariate& covariate : covariates) {
    const auto z = std::make_shared<Eigen::VectorXd>(
        covariate.name == "rate_dps" ? Eigen::VectorXd(covariate.values.cwiseAbs()) : covariate.values);
    const bool temperature = unit_of_column(covariate.name) == "degC";
    const auto given = std::make_shared<Eigen::VectorXd>(covariate.values);
    *z /= std::max(z->cwiseAbs().maxCoeff(), 1e-12);
    add(Submodel::thermal_loss, covariate.name,
        "a conductance that changes with " + the_variable(covariate.name), [k, z, watts] {
          Eigen::MatrixXd two(z->size(), 2);
          const Eigen::VectorXd loss = k->loss_per_K.cwiseProduct(k->rise);
          two.col(0) = loss.cwiseProduct(*z);
          two.col(1) = loss.array() * z->array().sign() * z->array().abs().sqrt();
          return watts(two);
        });
    if (temperature) {
      add(Submodel::thermal_heating, covariate.name, "heat that flows in by " + the_variable(covariate.name),
          [k, given, watts] { return watts(k->loss_per_K.cwiseProduct(*given - k->v.winding_C)); });
    } else {
      add(Submodel::thermal_heating, covariate.name,
          "heat with the square of " + the_variable(covariate.name),
          [k, z, watts] { return watts(k->loss_per_K.cwiseProduct(z->cwiseAbs2())); });
      add(Submodel::thermal_heating, covariate.name, "heat that comes with " + the_variable(covariate.name),
          [k, z, watts] {
            return watts(
                columns_of({k->loss_per_K.cwiseProduct(*z), k->loss_per_K.cwiseProduct(z->cwiseAbs2())}));
          });
    }
    b.variables.push_back({covariate.name, unit_of_column(covariate.name), covariate.values});
  }
  return b;
}

/// The balances of a bench, as far as its signals are judged. Model, catalogue and inputs must outlive them.
inline std::vector<BalanceSource> bench_balances(const Model& model, const Catalogue& catalogue,
                                                 const Inputs& inputs, std::vector<Covariate> covariates) {
  std::vector<BalanceSource> list;
  const auto shared = std::make_shared<std::vector<Covariate>>(std::move(covariates));
  if (inputs.judged(Signal::current_A)) {
    list.push_back({Quantity::missing_current,
                    Signal::current_A,
                    {Signal::motor_C},
                    [&model, &catalogue, &inputs, shared](const ReadingOffsets& offsets) {
                      return current_balance(BenchAtRows(model, catalogue, inputs, offsets), *shared);
                    }});
  }
  if (!inputs.judged(Signal::motor_C)) return list;
  const auto add = [&](HeatTold told, std::vector<SignalName> reads) {
    list.push_back({Quantity::missing_heat, Signal::motor_C, std::move(reads),
                    [&model, &catalogue, &inputs, shared, told](const ReadingOffsets& offsets) {
                      return heat_balance(BenchAtRows(model, catalogue, inputs, offsets), *shared, told);
                    }});
  };
  const bool ohmic = std::holds_alternative<OhmicCurrentModel>(model.current);
  const bool polynomial = std::holds_alternative<ThesisThermalModel>(model.thermal);
  if (inputs.heat_W.size() > 0) {  // known better than by any law
    add(HeatTold::by_record, {});
    return list;
  }
  if (inputs.heat == HeatSource::law) add(HeatTold::by_law, {});
  if (inputs.heat == HeatSource::drive) add(HeatTold::by_current, {});
  if (inputs.held_current_A.size() > 0) {
    const bool powered = inputs.power_param.size() > 0;
    if (polynomial ? powered : ohmic) add(HeatTold::by_current, {Signal::current_A});
    if (powered && !polynomial && ohmic) add(HeatTold::by_electrical_power, {Signal::current_A});
  }
  return list;
}

}  // namespace thermopower::plant
