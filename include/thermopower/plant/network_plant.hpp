// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/inline.hpp>
#include <thermopower/plant/network_effects.hpp>
#include <thermopower/plant/network_terms.hpp>
#include <thermopower/plant/own_plant.hpp>
#include <thermopower/plant/thermal_network.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::plant {

/// The equations of a network with a plant's constants and effects.
/// @param constants  heat capacities, conductances, then resistance and tempco where there is a winding
/// @param effects    that act, with their parameters
template <class Scalar>
NetworkTerms<Scalar> network_terms(
    const ThermalNetwork& network, const std::vector<Scalar>& constants,
    const std::vector<std::pair<const NetworkEffect*, std::vector<Scalar>>>& effects = {}) {
  const std::size_t nodes = network.nodes.size();
  NetworkTerms<Scalar> terms;
  terms.capacity_J_per_K.assign(constants.begin(), constants.begin() + static_cast<std::ptrdiff_t>(nodes));
  terms.reading_error_K.assign(nodes, constant<Scalar>(0.0));
  std::size_t next = nodes;
  for (const NetworkLink& link : network.links) {
    const std::size_t from = *network.place_of(link.from), to = *network.place_of(link.to);
    if (to < nodes) terms.links.push_back({from, to, constants[next++]});
    else terms.losses.push_back({from, to - nodes, constants[next++]});
  }
  for (std::size_t i = 0; i < network.heat.size(); ++i) {
    const NetworkHeat& heat = network.heat[i];
    typename NetworkTerms<Scalar>::Source source{network.given.size() + i, heat.winding.has_value(), {}};
    source.shares.assign(nodes, constant<Scalar>(0.0));
    for (const auto& [node, share] : heat.shares)
      source.shares[*network.place_of(node)] = constant<Scalar>(share);
    terms.sources.push_back(std::move(source));
    if (!heat.winding) continue;
    terms.winding_node = *network.place_of(heat.winding->node);
    terms.winding = {constants[next], constants[next + 1], constant<Scalar>(heat.winding->reference_C)};
    next += 2;
  }
  for (const auto& [effect, parameters] : effects) effect->act(parameters.data(), terms);
  return terms;
}

/// A thermal network as the engine asks it.
///
/// @snippet plant_examples.cpp thermal network
/// How to: @ref motor_on_a_frame.
class NetworkPlant : public OwnPlant {
public:
  /// @throws InvalidInput where it is no network, in one sentence
  explicit NetworkPlant(ThermalNetwork network);

  /// As it was given: a model's constants may be others.
  const ThermalNetwork& network() const { return network_; }

  /// The network with the constants of a model of it.
  ThermalNetwork network_of(const Model& model) const;

  std::unique_ptr<Rollout> rollout(const Model& model, const Catalogue&, const ParameterPoint& point,
                                   const Directions& directions, SimulationMode) const override;

  std::vector<WrittenEquation> written(const Model& model, Trace& trace) const override;

private:
  std::size_t at_behind() const { return network_.nodes.size(); }

  template <class Scalar>
  std::unique_ptr<Rollout> made(const Model& model, const ParameterPoint& point,
                                const Directions& directions) const;

  ThermalNetwork network_;
  std::vector<NetworkEffect> list_;
};

/// A model of a thermal network, as `gap::diagnose` takes it.
/// @param name  as reports call the model
/// @throws InvalidInput where it is no network, in one sentence
Model network_model(ThermalNetwork network, std::string name);

}  // namespace thermopower::plant

#ifndef THERMOPOWER_GAP_LIBRARY
#include <thermopower/plant/detail/network_plant.hpp>
#endif
