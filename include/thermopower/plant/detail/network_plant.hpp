// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/carried_on.hpp>
#include <thermopower/plant/network_plant.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::plant {

namespace detail {

/// How a network is started where nobody measures it.
struct NetworkStarts {
  double spread_K = 10.0;  ///< a hidden node lies so near to where its neighbours leave it, mostly
  double farthest_K =
      20.0;              ///< and no further from there than this, besides what known temperatures differ by
  double given_K = 0.5;  ///< the same where the network says where it starts
  double alone_W_per_K = 1e-9;  ///< draws a node without any way to what is known to the mean of it
  double otherwise_C = 20.0;    ///< where nothing at all is known
};
inline constexpr NetworkStarts network_starts{};

/// Places of a network's things in the lists of the plant that is made of it.
struct NetworkPlaces {
  std::vector<int> signal;  ///< of each node; -1: nobody measures it
  std::vector<std::size_t>
      starts;              ///< node of each state whose start is an unknown; `behind` for an effect's
  std::size_t behind = 0;  ///< the node that an effect adds: after all others

  explicit NetworkPlaces(const ThermalNetwork& network) : behind(network.nodes.size()) {
    int next = 0;
    for (std::size_t i = 0; i < network.nodes.size(); ++i) {
      const bool measured = !network.nodes[i].column.empty();
      signal.push_back(measured ? next++ : -1);
      if (measured) starts.push_back(i);
    }
    constexpr std::size_t most = static_cast<std::size_t>(largest_start);
    if (starts.size() < most) starts.push_back(behind);
    for (std::size_t i = 0; i < network.nodes.size(); ++i)
      if (signal[i] < 0 && starts.size() < most) starts.push_back(i);
  }
};

/// Signal of the measured node that is the fewest links away from another one.
inline int nearest_signal(const ThermalNetwork& network, const NetworkPlaces& at, std::size_t node) {
  std::vector<std::size_t> reached{node};
  for (std::size_t next = 0; next < reached.size(); ++next) {
    if (at.signal[reached[next]] >= 0) return at.signal[reached[next]];
    for (std::size_t i = 0; i < network.nodes.size(); ++i)
      if (network.linked(reached[next], i) && std::find(reached.begin(), reached.end(), i) == reached.end())
        reached.push_back(i);
  }
  return 0;
}

/// What a network is made of, for the engine. @throws InvalidInput where it is none, in one sentence
inline PlantInfo network_info(const ThermalNetwork& network) {
  if (const auto problem = network.validate())
    throw InvalidInput("thermal network: " + problem->where + " " + problem->what);
  PlantInfo info;
  info.type = "thermal_network";
  for (const NetworkNode& node : network.nodes)
    info.constants.push_back({"nodes", node.name + "_J_per_K", "J/K", node.heat_capacity_J_per_K});
  for (const NetworkLink& link : network.links)
    info.constants.push_back(
        {"links", link.from + "_to_" + link.to + "_W_per_K", "W/K", link.conductance_W_per_K});
  for (const GivenTemperature& one : network.given)
    info.inputs.push_back({one.column, "degC", one.otherwise_C});
  for (const NetworkHeat& heat : network.heat) {
    info.inputs.push_back({heat.column, heat.winding ? "A" : "W"});
    if (!heat.winding) continue;
    info.constants.push_back({"heat", "resistance_ohm", "ohm", heat.winding->resistance_ohm});
    info.constants.push_back({"heat", "tempco_per_K", "1/K", heat.winding->tempco_per_K, true, false});
  }
  const NetworkPlaces at(network);
  for (std::size_t i = 0; i < network.nodes.size(); ++i) {
    if (at.signal[i] < 0) continue;
    const NetworkNode& node = network.nodes[i];
    PlantSignal signal{node.column, "degC", node.name + ".balance"};
    std::string unmeasured;
    for (std::size_t k = 0; k < network.nodes.size(); ++k)
      if (at.signal[k] < 0 && network.linked(i, k))
        unmeasured += (unmeasured.empty() ? "" : " and ") + network.nodes[k].name;
    if (unmeasured.empty()) {
      signal.balance = PlantBalance{node.name + "_J_per_K", Quantity::missing_heat, "W"};
      for (const NetworkLink& link : network.links)
        if (link.from == node.name || link.to == node.name)
          signal.balance->leaves_by.push_back(link.from + "_to_" + link.to + "_W_per_K");
    } else signal.note = "judged by simulation, as nobody measures " + unmeasured;
    info.signals.push_back(std::move(signal));
  }
  for (const std::size_t node : at.starts) {
    PlantState state;
    state.unit = "degC";
    state.spread = network_starts.spread_K;
    if (node == at.behind) {
      state.name = "behind";
    } else {
      const NetworkNode& one = network.nodes[node];
      state.name = one.name;
      state.measured_by = at.signal[node];
      state.shows_in = nearest_signal(network, at, node);
      if (state.measured_by < 0 && one.initial_C) state.spread = network_starts.given_K;
    }
    info.states.push_back(std::move(state));
  }
  return info;
}

/// The ids and parameters of effects.
inline std::vector<EffectInfo> infos_of(const std::vector<NetworkEffect>& effects) {
  std::vector<EffectInfo> list;
  for (const NetworkEffect& one : effects) list.push_back(one.info);
  return list;
}

/// A network under way.
template <class Scalar>
class NetworkRollout : public OwnRollout {
public:
  NetworkRollout(const OwnPlant& plant, const ThermalNetwork& network, NetworkTerms<Scalar> terms,
                 const Directions& directions, int starts_from)
      : OwnRollout(plant),
        network_(network),
        at_(network),
        terms_(std::move(terms)),
        integrator_(terms_),
        directions_(directions.count),
        starts_from_(starts_from) {}
  NetworkRollout(const NetworkRollout&) = delete;  // the integrator points into it
  NetworkRollout& operator=(const NetworkRollout&) = delete;

  void roll(const Segment& segment, const Start& start, Readings& out) override {
    const Inputs& inputs = *segment.inputs;
    out.reset(segment.begin, segment.end, static_cast<int>(plant_.info()->signals.size()), directions_);
    std::vector<Scalar> fed = fed_at(inputs, segment.begin);
    Nodes node_C = started(segment, start, fed);
    const double began_s = inputs.t_s[segment.run.begin];
    for (Eigen::Index row = segment.begin; row < segment.end; ++row) {
      for (std::size_t i = 0; i < at_.signal.size(); ++i)
        if (at_.signal[i] >= 0) out.put(row, at_.signal[i], Scalar(node_C[i] + terms_.reading_error_K[i]));
      if (row + 1 >= segment.run.end) continue;
      for (std::size_t i = 0; i < fed.size(); ++i) fed[i] = constant<Scalar>(inputs.own_inputs[i][row]);
      integrator_.advance(node_C, fed.data(), inputs.t_s[row] - began_s,
                          inputs.t_s[row + 1] - inputs.t_s[row]);
    }
    for (std::size_t i = 0; i < terms_.count(); ++i) forget(node_C[i], starts_from_);
    carried_.leave(node_C);
  }

  std::vector<HiddenStart> hidden_starts(const Segment& segment) const override {
    std::vector<HiddenStart> list;
    for (HiddenStart& one : plant_.hidden_starts(segment)) {
      const std::size_t node = at_.starts[static_cast<std::size_t>(one.coordinate)];
      if (node >= terms_.count()) continue;
      const bool is_said = node < network_.nodes.size() && network_.nodes[node].initial_C.has_value();
      one.farthest = is_said ? network_starts.given_K : network_starts.farthest_K + known_span_K(segment);
      list.push_back(one);
    }
    return list;
  }

private:
  using Nodes = typename NetworkIntegrator<Scalar>::Nodes;

  static std::vector<Scalar> fed_at(const Inputs& inputs, Eigen::Index row) {
    std::vector<Scalar> fed;
    for (const Eigen::VectorXd& values : inputs.own_inputs) fed.push_back(constant<Scalar>(values[row]));
    return fed;
  }

  bool is_measured(const Segment& segment, std::size_t node) const {
    return node < at_.signal.size() && at_.signal[node] >= 0 &&
           segment.inputs->judged(static_cast<Signal>(at_.signal[node])) &&
           std::isfinite(segment.inputs->of(static_cast<Signal>(at_.signal[node]))[segment.begin]);
  }

  /// What the temperatures that are known at a segment's begin differ by.
  double known_span_K(const Segment& segment) const {
    double low = 1e300, high = -1e300;
    const auto take = [&](double C) { low = std::min(low, C), high = std::max(high, C); };
    for (std::size_t i = 0; i < at_.signal.size(); ++i)
      if (is_measured(segment, i))
        take(segment.inputs->of(static_cast<Signal>(at_.signal[i]))[segment.begin]);
    for (std::size_t i = 0; i < network_.given.size(); ++i)
      take(segment.inputs->own_inputs[i][segment.begin]);
    return high > low ? high - low : 0.0;
  }

  /// Temperatures of all nodes at a segment's begin: measured, said, carried on, or where the others leave them.
  Nodes started(const Segment& segment, const Start& start, const std::vector<Scalar>& fed) {
    const std::optional<Nodes>& carried = carried_.into(segment);
    Nodes node_C;
    node_C.fill(constant<Scalar>(0.0));
    std::vector<bool> known(terms_.count(), false);
    for (std::size_t i = 0; i < terms_.count(); ++i) {
      known[i] = true;
      if (is_measured(segment, i))
        node_C[i] =
            segment.inputs->of(static_cast<Signal>(at_.signal[i]))[segment.begin] - terms_.reading_error_K[i];
      else if (segment.carries_on && carried) node_C[i] = (*carried)[i];
      else if (i < network_.nodes.size() && network_.nodes[i].initial_C)
        node_C[i] = constant<Scalar>(*network_.nodes[i].initial_C);
      else known[i] = false;
    }
    const double t_s = segment.inputs->t_s[segment.begin] - segment.inputs->t_s[segment.run.begin];
    settle(known, fed, t_s, node_C);
    for (std::size_t i = 0; i < at_.starts.size(); ++i) {
      if (at_.starts[i] >= terms_.count()) continue;
      Scalar off = constant<Scalar>(start[static_cast<Eigen::Index>(i)]);
      const int direction = starts_from_ + static_cast<int>(i);
      if (direction >= 0 && direction < directions_) seed(off, direction);
      node_C[at_.starts[i]] += off;
    }
    return node_C;
  }

  /// Lets nodes of which nothing is known have the temperatures that they keep while the others do, without heat.
  void settle(const std::vector<bool>& known, const std::vector<Scalar>& fed, double t_s,
              Nodes& node_C) const {
    double mean_C = 0.0, count = 0.0;
    for (std::size_t i = 0; i < known.size(); ++i)
      if (known[i]) mean_C += value_of(node_C[i]), count += 1.0;
    mean_C = count > 0.0 ? mean_C / count : network_starts.otherwise_C;
    // Every row: sum of conductances times its own temperature less those of its unknown neighbours.
    const std::size_t nodes = known.size();
    std::vector<std::vector<Scalar>> matrix(nodes, std::vector<Scalar>(nodes, constant<Scalar>(0.0)));
    std::vector<Scalar> right(nodes, constant<Scalar>(network_starts.alone_W_per_K * mean_C));
    for (std::size_t i = 0; i < nodes; ++i) matrix[i][i] = constant<Scalar>(network_starts.alone_W_per_K);
    const auto draw = [&](std::size_t node, const Scalar& W_per_K, const Scalar& to_C) {
      matrix[node][node] += W_per_K;
      right[node] += W_per_K * to_C;
    };
    for (const auto& loss : terms_.losses)
      draw(loss.node, loss.W_per_K, terms_.given_C(loss.given, fed.data(), t_s));
    for (const auto& link : terms_.links)
      for (const auto& [one, other] : {std::pair(link.from, link.to), std::pair(link.to, link.from)}) {
        if (known[other]) draw(one, link.W_per_K, node_C[other]);
        else matrix[one][one] += link.W_per_K, matrix[one][other] -= link.W_per_K;
      }
    // Dominated by its diagonal: no pivots are searched.
    for (std::size_t pivot = 0; pivot < nodes; ++pivot)
      for (std::size_t i = pivot + 1; i < nodes && !known[pivot]; ++i) {
        if (known[i]) continue;
        const Scalar factor = matrix[i][pivot] / matrix[pivot][pivot];
        for (std::size_t k = pivot; k < nodes; ++k) matrix[i][k] -= factor * matrix[pivot][k];
        right[i] -= factor * right[pivot];
      }
    for (std::size_t i = nodes; i-- > 0;) {
      if (known[i]) continue;
      for (std::size_t k = i + 1; k < nodes; ++k)
        if (!known[k]) right[i] -= matrix[i][k] * node_C[k];
      node_C[i] = right[i] / matrix[i][i];
    }
  }

  const ThermalNetwork& network_;
  NetworkPlaces at_;
  NetworkTerms<Scalar> terms_;
  NetworkIntegrator<Scalar> integrator_;
  int directions_, starts_from_;
  CarriedOn<std::optional<Nodes>> carried_;
};

}  // namespace detail

THERMOPOWER_GAP_INLINE NetworkPlant::NetworkPlant(ThermalNetwork network)
    : OwnPlant(detail::network_info(network), detail::infos_of(network_effects(network))),
      network_(std::move(network)),
      list_(network_effects(network_)) {}

THERMOPOWER_GAP_INLINE ThermalNetwork NetworkPlant::network_of(const Model& model) const {
  ThermalNetwork result = network_;
  std::size_t next = 0;
  const auto take = [&](double& value) { value = model.own->constants[next++].value; };
  for (NetworkNode& node : result.nodes) take(node.heat_capacity_J_per_K);
  for (NetworkLink& link : result.links) take(link.conductance_W_per_K);
  for (NetworkHeat& heat : result.heat)
    if (heat.winding) take(heat.winding->resistance_ohm), take(heat.winding->tempco_per_K);
  return result;
}

template <class Scalar>
std::unique_ptr<Rollout> NetworkPlant::made(const Model& model, const ParameterPoint& point,
                                            const Directions& directions) const {
  const AtPoint<Scalar> at = at_point<Scalar>(model, point, directions);
  std::vector<std::pair<const NetworkEffect*, std::vector<Scalar>>> effects;
  for (const auto& [place, parameters] : at.effects) effects.emplace_back(&list_[place], parameters);
  return std::make_unique<detail::NetworkRollout<Scalar>>(*this, network_,
                                                          network_terms(network_, at.constants, effects),
                                                          directions, point.size() - directions.first);
}

THERMOPOWER_GAP_INLINE std::unique_ptr<Rollout> NetworkPlant::rollout(const Model& model, const Catalogue&,
                                                                      const ParameterPoint& point,
                                                                      const Directions& directions,
                                                                      SimulationMode) const {
  check_effects(model);
  if (directions.count > 0) return made<Dual>(model, point, directions);
  return made<double>(model, point, directions);
}

THERMOPOWER_GAP_INLINE std::vector<WrittenEquation> NetworkPlant::written(const Model& model,
                                                                          Trace& trace) const {
  check_effects(model);
  std::vector<Expression> constants, nodes, inputs;
  std::vector<std::string> arguments;
  const auto given = [&](const std::string& name, std::vector<Expression>& list) {
    arguments.push_back(name);
    list.push_back(trace.symbol(name));
  };
  for (const PlantConstant& constant : model.own->constants) constants.push_back(constant.value);
  std::vector<std::pair<const NetworkEffect*, std::vector<Expression>>> effects;
  for (const auto& effect : model.effects) {
    const NetworkEffect& one = list_[place_of(effect.first)];
    const std::vector<double> values = parameters_of(model, one.info);
    effects.emplace_back(&one, std::vector<Expression>(values.begin(), values.end()));
  }
  const NetworkTerms<Expression> terms = network_terms(network_, constants, effects);
  std::vector<std::string> names;
  for (const NetworkNode& node : network_.nodes) names.push_back(node.name);
  while (names.size() < terms.count())
    names.push_back("behind" + (names.size() == at_behind() ? std::string() : std::to_string(names.size())));
  for (const std::string& name : names) given(name + "_node_C", nodes);
  for (const PlantInput& input : info_.inputs) given(input.name + "_in", inputs);
  arguments.push_back("t_s");
  const Expression t_s = trace.symbol("t_s");
  const std::vector<Expression> rates = trace.every_branch([&] {
    std::vector<Expression> result(terms.count());
    terms.rates(nodes.data(), inputs.data(), t_s, result.data());
    return result;
  });
  std::vector<WrittenEquation> list;
  for (std::size_t i = 0; i < rates.size(); ++i)
    list.push_back(
        {names[i] + "_K_per_s",
         "How fast the temperature of " + names[i] + " moves, K/s; t_s: since the start of the run.",
         arguments, rates[i]});
  for (std::size_t i = 0; i < network_.nodes.size(); ++i)
    if (!network_.nodes[i].column.empty())
      list.push_back({names[i] + "_reading_C",
                      "What the thermometer on " + names[i] + " shows, degC.",
                      {arguments[i]},
                      nodes[i] + terms.reading_error_K[i]});
  return list;
}

THERMOPOWER_GAP_INLINE Model network_model(ThermalNetwork network, std::string name) {
  return OwnPlant::model(std::make_shared<NetworkPlant>(std::move(network)), std::move(name));
}

}  // namespace thermopower::plant
