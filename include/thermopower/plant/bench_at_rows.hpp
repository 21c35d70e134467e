// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/balance.hpp>
#include <thermopower/plant/bench_rollout.hpp>
#include <thermopower/plant/piecewise_linear.hpp>
#include <thermopower/plant/samples.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// @file bench_at_rows.hpp
/// The terms of a bench's laws at the rows of a recording: for the balances of bench_balances.hpp.

namespace thermopower::plant {

/// Where the heat of a body's balance comes from; each is a balance of its own.
enum class HeatTold {
  by_law,               ///< the circuit's law at the measured temperature
  by_current,           ///< the measured current and the winding's resistance
  by_electrical_power,  ///< the measured current and the voltage at the motor
  by_record,            ///< it is recorded itself
};

/// Where the heat comes from that a simulation of the body takes.
inline HeatTold heat_told(const Inputs& inputs) {
  if (inputs.heat_W.size() > 0) return HeatTold::by_record;
  return inputs.heat == HeatSource::law ? HeatTold::by_law : HeatTold::by_current;
}

/// The terms of a bench's laws at the rows of a recording, each at its measured inputs. Behind a thermometer that lags (a
/// model with that effect) the circuit is judged at what the thermometer shows.
///
/// How the whole works: @ref gap_method.
class BenchAtRows {
public:
  /// The quantities that a balance needs of each row.
  struct Values {
    Eigen::VectorXd law_A;             ///< what the ammeter would show
    Eigen::VectorXd ohm;               ///< volts per ampere of the motor
    Eigen::VectorXd v_rms_V;           ///< at the motor
    Eigen::VectorXd supply_V;          ///< at the bridge
    Eigen::VectorXd heat_W;            ///< into the body
    Eigen::VectorXd loss_W;            ///< out of the body, at the measured temperature
    Eigen::VectorXd capacity;          ///< J/K
    Eigen::VectorXd relaxation_per_s;  ///< of the temperature, everything else given
    Eigen::VectorXd winding_C;         ///< the thermometer's node
  };

  /// Keeps references to model, catalogue and inputs: they must outlive this object.
  BenchAtRows(const Model& model, const Catalogue& catalogue, const Inputs& inputs,
              const ReadingOffsets& offsets)
      : model_(model),
        catalogue_(catalogue),
        inputs_(inputs),
        offset_A_(offsets[Signal::current_A]),
        offset_K_(offsets[Signal::motor_C]) {
    rows_ = std::make_shared<BalanceRows>(
        BalanceRows{inputs.t_s, inputs.runs, median_interval_s(inputs.t_s, inputs.runs)});
  }

  /// The laws with the constants multiplied by `factors` (as many as Model::calibrated(), or none).
  Values evaluate(HeatTold heat, const std::vector<double>& factors = {}) const {
    return evaluate(heat, factors, true);
  }

  /// The change of a balance's flows by one more of a constant's logarithm, or of a place's value.
  struct Slopes {
    Eigen::VectorXd law_A;     ///< A
    Eigen::VectorXd heat_W;    ///< W
    Eigen::VectorXd loss_W;    ///< W
    Eigen::VectorXd capacity;  ///< J/K
  };

  /// Places in Model::calibrated() of the constants of a bench that calibration may move.
  std::vector<std::size_t> constants() const {
    std::vector<std::size_t> list;
    const std::vector<CalibratedConstant> all = model_.calibrated();
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k].has_slack && all[k].block != "axis" && all[k].block != "servo") list.push_back(k);
    return list;
  }

  /// The slopes by one constant.
  /// @param constant  its place in Model::calibrated()
  Slopes slopes(HeatTold heat, std::size_t constant) const {
    constexpr double step = 1e-4;  // of the logarithm: central differences are then exact to eight digits
    const auto flows = [&](double distance) {
      Values v = evaluate(heat, model_.moved(constant, distance), false);
      return Slopes{std::move(v.law_A), std::move(v.heat_W), std::move(v.loss_W), std::move(v.capacity)};
    };
    Slopes result = flows(step);
    const Slopes down = flows(-step);
    const auto differ = [](Eigen::VectorXd& up, const Eigen::VectorXd& by) { up = (up - by) * (0.5 / step); };
    differ(result.law_A, down.law_A);
    differ(result.heat_W, down.heat_W);
    differ(result.loss_W, down.loss_W);
    differ(result.capacity, down.capacity);
    return result;
  }

  /// The rows.
  const std::shared_ptr<const BalanceRows>& rows() const { return rows_; }
  /// The inputs given.
  const Inputs& inputs() const { return inputs_; }
  /// The model given.
  const Model& model() const { return model_; }

private:
  /// The laws.
  /// @param all  false: the flows and the capacity alone, the rest stays empty
  Values evaluate(HeatTold heat, const std::vector<double>& factors, bool all) const {
    const Instance<double> instance(model_, factors, {}, catalogue_);
    const BenchRollout<double> rollout(instance, inputs_);
    const Eigen::Index n = inputs_.rows();
    Values v;
    for (Eigen::VectorXd* one : {&v.law_A, &v.heat_W, &v.loss_W, &v.capacity})
      *one = Eigen::VectorXd::Zero(n);
    if (all)
      for (Eigen::VectorXd* one : {&v.ohm, &v.v_rms_V, &v.supply_V, &v.relaxation_per_s, &v.winding_C})
        *one = Eigen::VectorXd::Zero(n);
    for (const RunSpan& run : inputs_.runs) {
      double charge_Ah = run.drawn_Ah;
      HiddenNodes hidden;
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        const double t_s = inputs_.t_s[i] - inputs_.t_s[run.begin];
        const double step_s = i + 1 < run.end ? inputs_.t_s[i + 1] - inputs_.t_s[i] : 0.0;
        const double winding_C = inputs_.held_motor_C.size() > 0
                                     ? rollout.start(i, inputs_.held_motor_C[i] - offset_K_).winding_C
                                     : 25.0;
        if (all) v.winding_C[i] = winding_C;
        const bool powered = inputs_.power_param.size() > 0 && (instance.ohmic || instance.thesis_current);
        BenchRollout<double>::Circuit law{};
        if (powered) {
          law = rollout.circuit(i, t_s, winding_C, charge_Ah);
          v.law_A[i] = shown_A(instance, t_s, law.current_A);
          if (all) v.v_rms_V[i] = law.v_rms_V;
          if (all) v.supply_V[i] = law.supply_V;
        }
        if (all)
          v.ohm[i] = instance.ohmic        ? instance.winding.resistance_at(winding_C)
                     : law.current_A > 0.0 ? law.v_rms_V / law.current_A
                                           : 0.0;
        const double measured_A = measured_current(instance, i, t_s);
        const double true_A = std::isfinite(measured_A) ? measured_A : law.current_A;
        charge_Ah += true_A * rollout.charge_share(i) * step_s / 3600.0;
        if (!instance.lumped && !instance.thesis_thermal) continue;
        BenchRollout<double>::Circuit electrical = law;
        if (heat == HeatTold::by_record && !std::isfinite(measured_A) && !powered)
          electrical = rollout.heated(i);
        else if (heat != HeatTold::by_law)
          electrical = rollout.driven_by(i, t_s, true_A, winding_C, charge_Ah);
        if (heat == HeatTold::by_record) electrical.winding_W = inputs_.heat_W[i];
        if (heat == HeatTold::by_electrical_power) electrical.winding_W = law.v_rms_V * true_A;
        body(instance, rollout, electrical, i, t_s, step_s, winding_C, hidden, v);
      }
    }
    if (inputs_.next_share.size() > 0)
      for (const RunSpan& run : inputs_.runs)
        for (Eigen::Index i = run.begin; i + 1 < run.end; ++i)
          v.heat_W[i] += inputs_.next_share[i] * (v.heat_W[i + 1] - v.heat_W[i]);
    if (instance.thermal_structure.lagged) {
      // Behind a thermometer that lags everything is a lag later: a linear body's balance holds for it again.
      const double lag_s = std::max(instance.thermal_structure.thermometer_lag_s, 1e-9);
      for (const RunSpan& run : inputs_.runs) {
        double late_W = v.heat_W[run.begin];
        for (Eigen::Index i = run.begin; i + 1 < run.end; ++i) {
          const double step_s = inputs_.t_s[i + 1] - inputs_.t_s[i], kept = std::exp(-step_s / lag_s);
          const double behind_W = late_W - v.heat_W[i];
          late_W = v.heat_W[i] + behind_W * kept;
          v.heat_W[i] += behind_W * (1.0 - kept) * lag_s / step_s;  // its mean over the interval
        }
      }
    }
    return v;
  }

  /// Nodes that nobody measures, carried on from row to row; they start as the first measured one.
  struct HiddenNodes {
    double surface_C = missing, soaking_C = missing, enclosed_C = missing;
  };

  static void body(const Instance<double>& instance, const BenchRollout<double>& rollout,
                   const BenchRollout<double>::Circuit& electrical, Eigen::Index i, double t_s, double step_s,
                   double winding_C, HiddenNodes& hidden, Values& v) {
    constexpr double step_K = 0.01;  // for a slope by differences: losses are smooth over kelvins
    const auto& shape = instance.thermal_structure;
    const bool two = shape.two_nodes;
    if (!std::isfinite(hidden.surface_C)) {
      hidden.surface_C = hidden.soaking_C = winding_C;
      hidden.enclosed_C = rollout.heat_flows(i, t_s, electrical, winding_C, winding_C).outside_C;
    }
    const double* const enclosed_C = shape.enclosed ? &hidden.enclosed_C : nullptr;
    const double node_C = two ? hidden.surface_C : winding_C;
    const auto flows = rollout.heat_flows(i, t_s, electrical, winding_C, node_C, enclosed_C);
    const double total = flows.rise_K_per_J > 0.0 ? 1.0 / flows.rise_K_per_J : 6e4;
    const double rest = shape.own_share();
    const double soaked_W = shape.soaks ? shape.soaking_W_per_K * (node_C - hidden.soaking_C) : 0.0;
    const auto approach = [&](double gain_K_per_s, double decay_per_s) {
      return gain_K_per_s * (decay_per_s > 0.0 ? -std::expm1(-decay_per_s * step_s) / decay_per_s : step_s);
    };
    v.heat_W[i] = flows.heat_W;
    const auto above = rollout.heat_flows(i, t_s, electrical, two ? winding_C : winding_C + step_K,
                                          node_C + step_K, enclosed_C);
    if (two) {
      const double share = shape.winding_share, coupling = shape.coupling_W_per_K;
      v.capacity[i] = rest * share * total;
      v.loss_W[i] = coupling * (winding_C - hidden.surface_C);
      if (v.relaxation_per_s.size() > 0) v.relaxation_per_s[i] = coupling / v.capacity[i];
      const double outer = rest * (1.0 - share) * total;
      const double decay =
          (coupling + (above.loss_W - flows.loss_W) / step_K + (shape.soaks ? shape.soaking_W_per_K : 0.0)) /
          outer;
      hidden.surface_C +=
          approach((coupling * (winding_C - hidden.surface_C) - flows.loss_W - soaked_W) / outer, decay);
    } else {
      v.capacity[i] = rest * total;
      v.loss_W[i] = flows.loss_W + soaked_W;
      if (v.relaxation_per_s.size() > 0)
        v.relaxation_per_s[i] =
            std::max(0.0, (above.loss_W - flows.loss_W - above.heat_W + flows.heat_W) / step_K +
                              (shape.soaks ? shape.soaking_W_per_K : 0.0)) /
            (rest * total);
    }
    if (shape.soaks) {
      const double K_per_J = shape.soaking_K_per_J(1.0 / total);
      hidden.soaking_C +=
          approach((soaked_W - shape.soaking_loss_W_per_K * (hidden.soaking_C - flows.outside_C)) * K_per_J,
                   (shape.soaking_W_per_K + shape.soaking_loss_W_per_K) * K_per_J);
    }
    if (shape.enclosed) {
      const double capacity = shape.enclosed_share * total;
      hidden.enclosed_C +=
          approach((flows.loss_W - shape.enclosed_W_per_K * (hidden.enclosed_C - flows.outside_C)) / capacity,
                   shape.enclosed_W_per_K / capacity);
    }
  }

  double shown_A(const Instance<double>& instance, double t_s, double current_A) const {
    BenchReadings<double> read;
    read.t_s = t_s;
    read.measured_ambient_C = missing;
    read.motor_C = 0.0;
    read.current_A = current_A;
    for (const auto& effect : instance.bench_readings) effect(read);
    return read.current_A;
  }

  /// The true current of a measured one; readings are affine in it.
  double measured_current(const Instance<double>& instance, Eigen::Index i, double t_s) const {
    const double shown = inputs_.held_current_A.size() > 0 ? inputs_.held_current_A[i] - offset_A_
                         : inputs_.drive_A.size() > 0 && inputs_.heat == HeatSource::drive
                             ? inputs_.drive_A[i]
                             : missing;
    if (!std::isfinite(shown) || instance.bench_readings.empty()) return shown;
    const double at_0 = shown_A(instance, t_s, 0.0), at_1 = shown_A(instance, t_s, 1.0);
    return (shown - at_0) / (at_1 - at_0);
  }

  const Model& model_;
  const Catalogue& catalogue_;
  const Inputs& inputs_;
  double offset_A_ = 0.0, offset_K_ = 0.0;
  std::shared_ptr<const BalanceRows> rows_;
};

}  // namespace thermopower::plant
