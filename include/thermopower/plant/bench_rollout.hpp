// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/duty.hpp>
#include <thermopower/plant/bench_rates.hpp>
#include <thermopower/plant/bench_state.hpp>
#include <thermopower/plant/body_network.hpp>
#include <thermopower/plant/charge_before.hpp>
#include <thermopower/plant/exchange_step.hpp>
#include <thermopower/plant/heater_loop.hpp>
#include <thermopower/plant/rows.hpp>
#include <thermopower/plant/instance.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace thermopower::plant {

/// Simulates current and temperature of one motor, run by run. Its duty is recorded, or a heater's loop makes it of a target.
///
/// Inputs are held over each interval. The coupled equations are integrated with the midpoint rule where an
/// interval is short against every time constant and with sub-steps of the classical Runge-Kutta rule else;
/// two nodes whose exchange is fast against the interval, with an exponential rule that solves it exactly.
///
/// @snippet plant_examples.cpp bench rollout
/// How to: @ref gap_method.
template <class Scalar>
class BenchRollout {
public:
  /// Further inputs besides the recorded ones.
  struct Feed {
    bool measured_motor = false;    ///< current from the recorded temperature
    bool measured_current = false;  ///< heat from the recorded current
  };

  /// Keeps references to `instance` and `inputs`: they must outlive this object.
  BenchRollout(const Instance<Scalar>& instance, const Inputs& inputs, Feed feed)
      : instance_(instance), inputs_(inputs), feed_(feed) {}
  /// With no measured signal fed in.
  BenchRollout(const Instance<Scalar>& instance, const Inputs& inputs)
      : BenchRollout(instance, inputs, Feed()) {}

  /// Simulates the rows [begin, end) of a run that starts at `run_start_s`, from `state`, and hands the
  /// readings of each row to `sink(row, readings)`. Leaves the state at the last row.
  template <class Sink>
  void run(Eigen::Index begin, Eigen::Index end, double run_start_s, BenchState<Scalar>& state,
           Sink&& sink) const {
    std::optional<HeaterLoop<Scalar>> loop;
    if (inputs_.heater_closed && inputs_.heat == HeatSource::law && !feed_.measured_current)
      loop = set_out(begin, run_start_s, state);
    loop_duty_ = loop ? &loop->duty() : nullptr;
    for (Eigen::Index row = begin; row < end; ++row) {
      const double t_s = inputs_.t_s[row] - run_start_s;
      const auto take_sample = [&](double now_s) { sample(*loop, row, now_s, state); };
      if (loop) loop->arrive(t_s, take_sample);
      sink(row, read(row, t_s, state));
      if (row + 1 == end) break;
      const double length_s = inputs_.t_s[row + 1] - inputs_.t_s[row];
      if (!loop) follow(row, t_s, length_s, state);
      else
        loop->interval(t_s, t_s + length_s, take_sample,
                       [&](double now_s, double lasts_s) { step(row, now_s, lasts_s, state); });
    }
    loop_duty_ = nullptr;
  }

  /// The duty of 255 parts that a loop has set, while run() hands readings to its sink; NaN without a loop.
  Scalar loop_power() const {
    return loop_duty_ != nullptr ? Scalar(*loop_duty_ * full_heater_power) : constant<Scalar>(missing);
  }

  /// The state in which the readings at `row` are `motor_C`, all nodes alike.
  BenchState<Scalar> start(Eigen::Index row, double motor_C) const {
    // Readings are affine in the temperature: two evaluations invert them.
    const Scalar at_0 = reading(row, 0.0), at_1 = reading(row, 1.0);
    const Scalar true_C = (motor_C - at_0) / (at_1 - at_0);
    BenchState<Scalar> state{true_C, true_C, true_C, constant<Scalar>(0.0)};
    if (instance_.thermal_structure.has_further_nodes()) {
      const double air_C = at(inputs_.ambient_C, row);
      state.further.any = true;
      state.further.soaking_C = true_C;
      state.further.enclosed_C = std::isfinite(air_C) ? constant<Scalar>(air_C) : true_C;
    }
    return state;
  }

  /// The currents and voltages of the circuit at an instant.
  struct Circuit {
    Scalar supply_V;   ///< at the bridge
    Scalar v_rms_V;    ///< at the motor
    Scalar current_A;  ///< through the motor
    Scalar winding_W;  ///< heat of the winding
  };

  /// The circuit at a row under its recorded power, with the winding at `winding_C` and `charge_Ah` drawn so far.
  Circuit circuit(Eigen::Index row, double t_s, const Scalar& winding_C, const Scalar& charge_Ah) const {
    ElectricalTerms<Scalar> terms;
    const Scalar zero = constant<Scalar>(0.0);
    terms.t_s = t_s;
    terms.rate_dps = at(inputs_.covariate_rate_dps, row);
    terms.winding_C = winding_C;
    terms.charge_Ah = charge_Ah;
    terms.supply_V =
        constant<Scalar>(inputs_.supply_V.size() > 0 ? inputs_.supply_V[row] : inputs_.nominal_V);
    terms.duty = loop_duty_ != nullptr
                     ? *loop_duty_
                     : constant<Scalar>(duty_from_power(std::clamp(inputs_.power_param[row], 0.0, 255.0)));
    terms.source_ohm = terms.series_ohm = terms.counter_V = zero;
    terms.tempco_per_K = instance_.ohmic ? instance_.winding.tempco_per_K : zero;
    for (const auto& effect : instance_.electrical) effect(terms);
    const bool on = value_of(terms.duty) > 0.0;
    // Guarded, as the derivative of a square root at 0 is infinite.
    const Scalar root = on ? v_rms_from_duty<Scalar>(constant<Scalar>(1.0), terms.duty) : zero;
    const Scalar open_V = terms.supply_V * root - terms.counter_V;
    Circuit result{terms.supply_V, zero, zero, zero};
    if (!on || value_of(open_V) <= 0.0) return result;
    // The supply carries I sqrt(duty); its drop reaches the motor as source_ohm I duty.
    const Scalar outside_ohm = terms.series_ohm + terms.source_ohm * terms.duty;
    if (instance_.ohmic) {
      OhmicCurrent<Scalar> winding = instance_.winding;
      winding.tempco_per_K = terms.tempco_per_K;
      const Scalar resistance = winding.resistance_at(winding_C);
      result.current_A = open_V / (resistance + outside_ohm);
      result.winding_W = result.current_A * result.current_A * resistance;
    } else {
      Scalar current = instance_.current_law.current_A(open_V, winding_C);
      if (value_of(outside_ohm) != 0.0 || !instance_.electrical.empty())
        for (int i = 0; i < 4; ++i)
          current = instance_.current_law.current_A(at_least(Scalar(open_V - outside_ohm * current), 0.0),
                                                    winding_C);
      result.current_A = current;
      result.winding_W = (open_V - outside_ohm * current) * current;
    }
    result.v_rms_V = open_V - outside_ohm * result.current_A;
    result.supply_V = terms.supply_V - terms.source_ohm * result.current_A * root;
    return result;
  }

  /// The circuit at a row with a recorded current: its voltages, and the heat of that current.
  Circuit driven_by(Eigen::Index row, double t_s, double current_A, const Scalar& winding_C,
                    const Scalar& charge_Ah) const {
    Circuit result;
    if (inputs_.power_param.size() > 0) result = circuit(row, t_s, winding_C, charge_Ah);
    else result.supply_V = result.v_rms_V = constant<Scalar>(inputs_.nominal_V);
    result.current_A = constant<Scalar>(current_A);
    const double heating_A2 = current_A * current_A - inputs_.current_noise_A * inputs_.current_noise_A;
    result.winding_W = instance_.ohmic ? Scalar(instance_.winding.resistance_at(winding_C) * heating_A2)
                                       : Scalar(result.v_rms_V * current_A);
    return result;
  }

  /// The circuit if only the heat is recorded.
  Circuit heated(Eigen::Index row) const {
    const Scalar zero = constant<Scalar>(0.0), nominal_V = constant<Scalar>(inputs_.nominal_V);
    return {nominal_V, nominal_V, zero, constant<Scalar>(inputs_.heat_W[row])};
  }

  /// The heat balance of the body at an instant.
  struct HeatFlows {
    Scalar heat_W;        ///< into the winding node
    Scalar loss_W;        ///< out of the surface node
    Scalar rise_K_per_J;  ///< of all nodes together, > 0
    Scalar outside_C;     ///< the air that the surroundings have, after the effects on it
  };

  /// The heat balance at a row with these nodes (`surface_C` counts where there are two).
  /// @param enclosed_C  air around the body, where that warms up; null: it does not
  HeatFlows heat_flows(Eigen::Index row, double t_s, const Circuit& electrical, const Scalar& winding_C,
                       const Scalar& surface_C, const Scalar* enclosed_C = nullptr) const {
    ThermalTerms<Scalar> terms;
    terms.t_s = t_s;
    terms.airspeed_mps = at(inputs_.airspeed_mps, row);
    terms.neighbour_C = at(inputs_.neighbour_C, row);
    terms.rate_dps = at(inputs_.covariate_rate_dps, row);
    terms.measured_ambient_C = at(inputs_.ambient_C, row);
    terms.winding_C = winding_C;
    terms.surface_C = instance_.thermal_structure.two_nodes ? surface_C : winding_C;
    terms.current_A = electrical.current_A;
    terms.supply_V = electrical.supply_V;
    terms.v_rms_V = electrical.v_rms_V;
    AirTerms<Scalar> air;
    air.t_s = t_s;
    air.measured_ambient_C = terms.measured_ambient_C;
    air.ambient_C = constant<Scalar>(terms.measured_ambient_C);
    for (const auto& effect : instance_.air) effect(air);
    terms.ambient_C = enclosed_C != nullptr ? *enclosed_C : air.ambient_C;
    const Scalar outside_C = air.ambient_C;
    terms.heat_W = electrical.winding_W;
    terms.conductance_factor = constant<Scalar>(1.0);
    terms.extra_loss_W = constant<Scalar>(0.0);
    for (const auto& effect : instance_.thermal) effect(terms);

    Scalar rise_K_per_J, loss_W;
    const Scalar rise_K = terms.surface_C - terms.ambient_C;
    if (instance_.lumped) {
      rise_K_per_J = instance_.heat_capacity.rise_K_per_J(electrical.v_rms_V, winding_C);
      loss_W = instance_.conductance_W_per_K * terms.conductance_factor * rise_K + terms.extra_loss_W;
    } else {
      // The law has no heat capacity below its least voltage; extra watts then use the capacity just above
      // it.
      const Scalar floor_V = instance_.heating_law.minimum_V_rms + 1e-9;
      const Scalar v_V = value_of(electrical.v_rms_V) > value_of(floor_V) ? electrical.v_rms_V : floor_V;
      rise_K_per_J = instance_.heating_law.rise_K_per_J(v_V, winding_C);
      if (!(value_of(electrical.v_rms_V) > value_of(floor_V))) terms.heat_W -= electrical.winding_W;
      const Scalar natural_rate = instance_.cooling_per_s * terms.conductance_factor * rise_K;
      if (value_of(rise_K_per_J) > 0.0) {
        loss_W = natural_rate / rise_K_per_J + terms.extra_loss_W;
      } else {
        // Nor has it one where 1/r is not positive: watts do nothing there. The cooling is a rate, whatever the capacity is
        // taken to be.
        constexpr double any_K_per_J = 1.0 / 60.0;
        rise_K_per_J = constant<Scalar>(any_K_per_J);
        terms.heat_W = constant<Scalar>(0.0);
        loss_W = natural_rate / any_K_per_J;
      }
    }
    return {terms.heat_W, loss_W, rise_K_per_J, outside_C};
  }

  /// Share of the motor's current that the supply carries: sqrt(duty).
  double charge_share(Eigen::Index row) const {
    if (loop_duty_ != nullptr) return std::sqrt(value_of(*loop_duty_));
    return inputs_.power_param.size() == 0 ? 1.0 : share_of_supply(inputs_.power_param[row]);
  }

private:
  using Slope = BenchSlope<Scalar>;
  using Places = BodyPlaces;
  using Network = BodyNetwork<Scalar>;

  static double at(const Eigen::VectorXd& values, Eigen::Index row) {
    return values.size() > 0 ? values[row] : missing;
  }

  /// What the instruments show at a row in a state.
  BenchReadings<Scalar> read(Eigen::Index row, double t_s, const BenchState<Scalar>& state) const {
    const bool driven = inputs_.heat == HeatSource::law || feed_.measured_motor;
    BenchReadings<Scalar> read;
    read.t_s = t_s;
    read.measured_ambient_C = at(inputs_.ambient_C, row);
    read.motor_C = instance_.thermal_structure.lagged ? state.thermometer_C : state.winding_C;
    read.current_A = constant<Scalar>(0.0);
    if (driven && inputs_.power_param.size() > 0) {
      const Scalar winding_C =
          feed_.measured_motor ? constant<Scalar>(at(inputs_.held_motor_C, row)) : state.winding_C;
      read.current_A = circuit(row, t_s, winding_C, state.charge_Ah).current_A;
    }
    for (const auto& effect : instance_.bench_readings) effect(read);
    return read;
  }

  /// Lets the heater's loop read the thermometer. A jump of its duty that came later would have left the body to the duty before it
  /// until then.
  void sample(HeaterLoop<Scalar>& loop, Eigen::Index row, double t_s, BenchState<Scalar>& state) const {
    const Slope before = loop.jumps() ? slope(row, t_s, state) : Slope();
    const Scalar moved_s = loop.sample(read(row, t_s, state).motor_C, inputs_.target_C[row]);
    if (is_constant(moved_s, 0.0)) return;
    const Slope after = slope(row, t_s, state);
    state = moved(moved(state, before, moved_s), after, Scalar(-moved_s));
  }

  /// The heater's loop as it begins at a row: it has held the body where that is.
  HeaterLoop<Scalar> set_out(Eigen::Index begin, double run_start_s, const BenchState<Scalar>& state) const {
    HeaterLoop<Scalar> loop(instance_.heater);
    const Scalar all = constant<Scalar>(1.0);
    const double t_s = inputs_.t_s[begin] - run_start_s;
    loop_duty_ = &all;
    const Circuit full = circuit(begin, t_s, state.winding_C, state.charge_Ah);
    const HeatFlows flows = heat_flows(begin, t_s, full, state.winding_C, state.surface_C);
    loop_duty_ = nullptr;
    const double held = value_of(flows.loss_W) / value_of(flows.heat_W);
    loop.start(read(begin, t_s, state).motor_C, inputs_.target_C[begin], std::isfinite(held) ? held : 0.0,
               t_s);
    return loop;
  }

  Scalar reading(Eigen::Index row, double motor_C) const {
    BenchReadings<Scalar> read;
    read.measured_ambient_C = at(inputs_.ambient_C, row);
    read.motor_C = constant<Scalar>(motor_C);
    read.current_A = constant<Scalar>(0.0);
    for (const auto& effect : instance_.bench_readings) effect(read);
    return read.motor_C;
  }

  Circuit powered(Eigen::Index row, double t_s, const BenchState<Scalar>& state) const {
    Circuit result = circuit_of_source(row, t_s, state);
    if (inputs_.heat_W.size() > 0) result.winding_W = constant<Scalar>(inputs_.heat_W[row]);
    return result;
  }

  Circuit circuit_of_source(Eigen::Index row, double t_s, const BenchState<Scalar>& state) const {
    if (inputs_.heat == HeatSource::law && !feed_.measured_current)
      return circuit(row, t_s, state.winding_C, state.charge_Ah);
    if (inputs_.heat == HeatSource::recorded && !feed_.measured_current) return heated(row);
    const double recorded =
        inputs_.heat == HeatSource::drive ? inputs_.drive_A[row] : inputs_.held_current_A[row];
    return driven_by(row, t_s, recorded, state.winding_C, state.charge_Ah);
  }

  /// An interval, with the inputs of its row and those of the next one for as long as each is in force.
  void follow(Eigen::Index row, double t_s, double dt_s, BenchState<Scalar>& state) const {
    const double next_s = inputs_.next_share.size() > 0 ? inputs_.next_share[row] * dt_s : 0.0;
    if (next_s < dt_s) step(row, t_s, dt_s - next_s, state);
    if (next_s > 0.0) step(row + 1, t_s + dt_s - next_s, next_s, state);
  }

  Slope slope(Eigen::Index row, double t_s, const BenchState<Scalar>& state) const {
    const Circuit electrical = powered(row, t_s, state);
    if (!instance_.lumped && !instance_.thesis_thermal) {
      const Scalar still = constant<Scalar>(0.0);
      return {still, still, electrical.current_A * charge_share(row) * (1.0 / 3600.0), {}};
    }
    const auto& shape = instance_.thermal_structure;
    const HeatFlows flows = heat_flows(row, t_s, electrical, state.winding_C, state.surface_C,
                                       shape.enclosed ? &state.further.enclosed_C : nullptr);
    Slope rate;
    if (shape.has_further_nodes()) {
      further_slope(state, flows, rate);
      rate.charge = electrical.current_A * charge_share(row) * (1.0 / 3600.0);
      return rate;
    }
    if (shape.two_nodes) {
      const Scalar flow_W = coupling_W_per_K_ * (state.winding_C - state.surface_C);
      rate.winding = (flows.heat_W - flow_W) * flows.rise_K_per_J / shape.winding_share;
      rate.surface = (flow_W - flows.loss_W) * flows.rise_K_per_J / (1.0 - shape.winding_share);
    } else {
      rate.winding = (flows.heat_W - flows.loss_W) * flows.rise_K_per_J;
      rate.surface = rate.winding;
    }
    rate.charge = electrical.current_A * charge_share(row) * (1.0 / 3600.0);
    return rate;
  }

  /// Every node, with a node behind the surface, or air around it that warms up.
  void further_slope(const BenchState<Scalar>& state, const HeatFlows& flows, Slope& rate) const {
    const auto& shape = instance_.thermal_structure;
    const Scalar& rise_K_per_J = flows.rise_K_per_J;
    const Scalar zero = constant<Scalar>(0.0);
    const Scalar& surface_C = shape.two_nodes ? state.surface_C : state.winding_C;
    const Scalar soaked_W =
        shape.soaks ? Scalar(shape.soaking_W_per_K * (surface_C - state.further.soaking_C)) : zero;
    const Scalar rest = shape.own_share();  // of the heat capacity, in winding and surface
    if (shape.two_nodes) {
      const Scalar flow_W = coupling_W_per_K_ * (state.winding_C - state.surface_C);
      rate.winding = (flows.heat_W - flow_W) * rise_K_per_J / (rest * shape.winding_share);
      rate.surface = (flow_W - flows.loss_W - soaked_W) * rise_K_per_J / (rest * (1.0 - shape.winding_share));
    } else {
      rate.winding = (flows.heat_W - flows.loss_W - soaked_W) * rise_K_per_J / rest;
      rate.surface = rate.winding;
    }
    rate.further.any = true;
    rate.further.soaking_C =
        shape.soaks
            ? Scalar((soaked_W - shape.soaking_loss_W_per_K * (state.further.soaking_C - flows.outside_C)) *
                     shape.soaking_K_per_J(rise_K_per_J))
            : zero;
    rate.further.enclosed_C =
        shape.enclosed
            ? Scalar((flows.loss_W - shape.enclosed_W_per_K * (state.further.enclosed_C - flows.outside_C)) *
                     rise_K_per_J / shape.enclosed_share)
            : zero;
  }

  void step(Eigen::Index row, double t_s, double dt_s, BenchState<Scalar>& state) const {
    const auto& shape = instance_.thermal_structure;
    coupling_W_per_K_ = shape.coupling_W_per_K;
    double stiffness = dt_s * fastest_per_s(instance_, state);
    if (shape.has_further_nodes()) {
      further_steps(row, t_s, dt_s, stiffness, state);
      return;
    }
    if (shape.two_nodes && !shape.lagged && stiffness > 0.6) {
      exchange(row, t_s, dt_s, state);
      return;
    }
    constexpr double stiffest = 25.0;
    if (stiffness > stiffest) {
      // Nodes that are one within a twentieth of an interval look like one: a slower exchange shows the same.
      coupling_W_per_K_ *= stiffest / stiffness;
      stiffness = stiffest;
    }
    if (stiffness < 0.02) {
      const Slope first = slope(row, t_s, state);
      const Slope middle = slope(row, t_s + 0.5 * dt_s, moved(state, first, 0.5 * dt_s));
      settle(state, moved(state, middle, dt_s), dt_s);
      return;
    }
    classical_steps(row, t_s, dt_s, static_cast<int>(std::ceil(stiffness / 0.6)), state);
  }

  /// An interval in so many steps of the classical Runge-Kutta rule.
  void classical_steps(Eigen::Index row, double t_s, double dt_s, int steps,
                       BenchState<Scalar>& state) const {
    const double h_s = dt_s / steps;
    for (int i = 0; i < steps; ++i) {
      const double now_s = t_s + i * h_s;
      const Slope k1 = slope(row, now_s, state);
      const Slope k2 = slope(row, now_s + 0.5 * h_s, moved(state, k1, 0.5 * h_s));
      const Slope k3 = slope(row, now_s + 0.5 * h_s, moved(state, k2, 0.5 * h_s));
      const Slope k4 = slope(row, now_s + h_s, moved(state, k3, h_s));
      settle(state, moved(state, runge_kutta_mean(k1, k2, k3, k4), h_s), h_s);
    }
  }

  Network network(const Places& at, const BenchState<Scalar>& state) const {
    const Scalar rise_K_per_J = storage_K_per_J(instance_, state);
    const Scalar loss_per_s =
        instance_.lumped ? Scalar(instance_.conductance_W_per_K * rise_K_per_J) : instance_.cooling_per_s;
    return body_network(instance_.thermal_structure, at, coupling_W_per_K_, rise_K_per_J, loss_per_s);
  }

  /// An interval of more nodes than two: one step of the classical Runge-Kutta rule where that is stable, else steps of
  /// NetworkStep that are cut until its second stage moves the nodes little.
  void further_steps(Eigen::Index row, double t_s, double dt_s, double stiffness,
                     BenchState<Scalar>& state) const {
    constexpr double one_step = 1.2, enough_K = 0.05;
    if (stiffness < one_step) {
      classical_steps(row, t_s, dt_s, 1, state);
      return;
    }
    const double shortest_s = dt_s / 1024.0;
    const Places at(instance_.thermal_structure);
    double done_s = 0.0, h_s = dt_s;
    Slope first = slope(row, t_s, state);
    Network linear = network(at, state);
    linear.set_length(h_s);
    for (;;) {
      const typename Network::Nodes one = linear.solved(nodes_of(at, first));
      const Slope last = slope(row, t_s + done_s + h_s, moved(state, slope_of(at, one, first.charge), h_s));
      typename Network::Nodes two = nodes_of(at, last);
      for (std::size_t i = 0; i < at.count; ++i) two[i] -= 2.0 * one[i];
      linear.solve(two);
      double moved_K = 0.0;
      typename Network::Nodes all = one;
      for (std::size_t i = 0; i < at.count; ++i) {
        moved_K = std::max(moved_K, 0.5 * h_s * std::abs(value_of(one[i]) + value_of(two[i])));
        all[i] = 1.5 * one[i] + 0.5 * two[i];
      }
      if (moved_K > enough_K && h_s > shortest_s) {
        linear.set_length(h_s *= 0.5);
        continue;
      }
      settle(state, moved(state, slope_of(at, all, 0.5 * (first.charge + last.charge)), h_s), h_s);
      done_s += h_s;
      if (!(done_s < dt_s)) return;
      const double next_s = std::min(moved_K < 0.25 * enough_K ? 2.0 * h_s : h_s, dt_s - done_s);
      if (next_s != h_s) linear.set_length(h_s = next_s);
      first = slope(row, t_s + done_s, state);
    }
  }

  /// An interval of two nodes with a fast exchange, in steps that are cut until what the linear part does not
  /// know (the resistance that follows the temperature, losses that are not proportional) moves them little.
  void exchange(Eigen::Index row, double t_s, double dt_s, BenchState<Scalar>& state) const {
    constexpr double enough_K = 0.02;
    const double shortest_s = dt_s / 1024.0;
    const auto& shape = instance_.thermal_structure;
    const Scalar share = shape.winding_share, rest = 1.0 - shape.winding_share;
    const Scalar rise_K_per_J = storage_K_per_J(instance_, state);
    const Scalar flow_per_s = coupling_W_per_K_ * rise_K_per_J;
    const Scalar loss_per_s =
        instance_.lumped ? Scalar(instance_.conductance_W_per_K * rise_K_per_J) : instance_.cooling_per_s;
    ExchangeStep<Scalar> linear(flow_per_s / share, flow_per_s / rest, loss_per_s / rest);
    using Pair = typename ExchangeStep<Scalar>::Pair;
    double done_s = 0.0, h_s = dt_s;
    Slope first = slope(row, t_s, state);
    linear.set_length(h_s);
    for (;;) {
      const Pair moved = linear.moved({first.winding, first.surface});
      BenchState<Scalar> reached = state;
      reached.winding_C += moved.winding;
      reached.surface_C += moved.surface;
      reached.charge_Ah += first.charge * h_s;
      const Slope last = slope(row, t_s + done_s + h_s, reached);
      const Pair known = linear.exchanged(moved);
      const Pair correction = linear.corrected(
          {last.winding - first.winding - known.winding, last.surface - first.surface - known.surface});
      const double moved_K = std::abs(value_of(correction.winding)) + std::abs(value_of(correction.surface));
      if (moved_K > enough_K && h_s > shortest_s) {
        h_s *= 0.5;
        linear.set_length(h_s);
        continue;
      }
      reached.winding_C += correction.winding;
      reached.surface_C += correction.surface;
      reached.charge_Ah += (last.charge - first.charge) * (0.5 * h_s);
      state = reached;
      done_s += h_s;
      if (!(done_s < dt_s)) return;
      const double next_s = std::min(moved_K < 0.25 * enough_K ? 2.0 * h_s : h_s, dt_s - done_s);
      if (next_s != h_s) linear.set_length(h_s = next_s);
      first = slope(row, t_s + done_s, state);
    }
  }

  /// Accepts a step, and lets the thermometer follow a winding that moved in a straight line: exact for any
  /// lag, however short.
  void settle(BenchState<Scalar>& state, const BenchState<Scalar>& reached, double h_s) const {
    if (!instance_.thermal_structure.lagged) {
      state = reached;
      return;
    }
    using std::exp;
    const Scalar& lag_s = instance_.thermal_structure.thermometer_lag_s;
    const Scalar behind_K = (reached.winding_C - state.winding_C) * (lag_s / h_s);
    const Scalar decay = exp(-h_s / lag_s);
    const Scalar thermometer_C =
        reached.winding_C - behind_K + (state.thermometer_C - state.winding_C + behind_K) * decay;
    state = reached;
    state.thermometer_C = thermometer_C;
  }

  const Instance<Scalar>& instance_;
  const Inputs& inputs_;
  Feed feed_;
  mutable Scalar coupling_W_per_K_;  ///< of the step under way
  mutable const Scalar* loop_duty_ =
      nullptr;  ///< that the heater's loop has set, in run(); null: it is recorded
};

}  // namespace thermopower::plant
