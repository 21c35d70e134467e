// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/network_terms.hpp>
#include <thermopower/plant/thermal_network.hpp>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::plant {

/// An effect that a thermal network may have and its simulation may lack: one kind of physics, at one place.
///
/// @snippet plant_examples.cpp network effects
/// How to: @ref motor_on_a_frame.
struct NetworkEffect {
  /// The physics.
  enum class Kind {
    link,                ///< a way between two nodes
    loss,                ///< a way from a node to a given temperature
    radiation,           ///< from a node to surroundings of a given temperature
    natural_convection,  ///< the losses of a node grow with the temperature difference
    hidden_mass,         ///< a further node behind a measured one
    given_bias,          ///< a given temperature is not what is recorded
    given_drift,         ///< the same, and it moves away from it
    heat_share,          ///< another part of a heat warms a node
    tempco,              ///< the winding's resistance follows its temperature
    thermometer_bias     ///< a thermometer shows too much
  };

  EffectInfo info;         ///< id, parameters, prose
  Kind kind = Kind::link;  ///< what it does
  std::size_t place =
      0;  ///< node; of the given ones, and of a heat share, the given temperature or the source
  std::size_t other = 0;  ///< the other node, given temperature, or the node that has the share

  /// Changes the equations.
  /// @param p  its parameters in the order of its info
  template <class Scalar>
  void act(const Scalar* p, NetworkTerms<Scalar>& terms) const {
    const Scalar none = constant<Scalar>(0.0);
    switch (kind) {
      case Kind::link:
        terms.links.push_back({place, other, p[0]});
        break;
      case Kind::loss:
        terms.losses.push_back({place, other, p[0]});
        break;
      case Kind::radiation:
        terms.radiated.push_back({place, other, p[0]});
        break;
      case Kind::natural_convection:
        for (typename NetworkTerms<Scalar>::Loss& loss : terms.losses)
          if (loss.node == place) loss.natural = true, loss.exponent = p[0], loss.reference_K = p[1];
        break;
      case Kind::hidden_mass:
        terms.links.push_back({place, terms.count(), p[1]});
        terms.capacity_J_per_K.push_back(p[0]);
        break;
      case Kind::given_bias:
        terms.errors.push_back({place, p[0], none});
        break;
      case Kind::given_drift:
        terms.errors.push_back({place, none, p[0] / 3600.0});
        break;
      case Kind::heat_share: {
        std::vector<Scalar>& shares = terms.sources[place].shares;
        for (Scalar& share : shares) share *= 1.0 - p[0];
        if (shares.size() <= other) shares.resize(other + 1, none);
        shares[other] += p[0];
        break;
      }
      case Kind::tempco:
        terms.winding.tempco_per_K = p[0];
        break;
      case Kind::thermometer_bias:
        terms.reading_error_K[place] += p[0];
        break;
    }
  }
};

namespace detail {

/// Makes the effects that a network may have, one after the other.
class NetworkEffects {
public:
  explicit NetworkEffects(const ThermalNetwork& network) : network_(network) {}

  std::vector<NetworkEffect> all() {
    const std::size_t nodes = network_.nodes.size();
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t b = a + 1; b < nodes; ++b)
        if (!network_.linked(a, b)) add_link(a, b);
    for (std::size_t a = 0; a < nodes; ++a) {
      for (std::size_t k = 0; k < network_.given.size(); ++k)
        if (!network_.linked(a, nodes + k)) add_loss(a, k);
      if (!network_.given.empty()) add_radiation(a);
      add_convection(a);
      if (!network_.nodes[a].column.empty()) add_hidden_mass(a), add_thermometer_bias(a);
    }
    for (std::size_t k = 0; k < network_.given.size(); ++k) add_errors(k);
    for (std::size_t i = 0; i < network_.heat.size(); ++i) {
      add_shares(i);
      if (network_.heat[i].winding && network_.heat[i].winding->tempco_per_K == 0.0) add_tempco();
    }
    return std::move(list_);
  }

private:
  using Kind = NetworkEffect::Kind;

  std::string node(std::size_t place) const { return network_.nodes[place].name; }
  std::string balance(std::size_t place) const { return node(place) + ".balance"; }
  bool is_measured(std::size_t place) const { return !network_.nodes[place].column.empty(); }

  double largest_W_per_K() const {
    double largest = 0.0;
    for (const NetworkLink& link : network_.links) largest = std::max(largest, link.conductance_W_per_K);
    return largest > 0.0 ? largest : 1.0;
  }

  void add(Kind kind, std::size_t place, std::size_t other, EffectInfo info) {
    list_.push_back({std::move(info), kind, place, other});
  }

  /// A conductance, and where fits of it begin: at a part of the network's largest one, and near nothing.
  ParameterBuilder W_per_K() const {
    const double largest = largest_W_per_K();
    return parameter(0, "W_per_K")
        .unit("W/K")
        .within(0.0, 100.0 * largest)
        .starts({0.3 * largest, 0.03 * largest});
  }

  void add_link(std::size_t a, std::size_t b) {
    add(Kind::link, a, b,
        {node(a) + "_to_" + node(b) + "_link",
         SubmodelName(balance(is_measured(a) || !is_measured(b) ? a : b)),
         "heat from " + node(a) + " to " + node(b) + " += G (T_" + node(a) + " - T_" + node(b) + ")",
         "A contact or another way for heat between " + node(a) + " and " + node(b) +
             " that the network lacks.",
         {W_per_K()},
         {},
         "long steps of the heat, with thermometers on " + node(a) + " and on " + node(b)});
  }

  void add_loss(std::size_t a, std::size_t given) {
    const std::string& to = network_.given[given].name;
    add(Kind::loss, a, given,
        {node(a) + "_to_" + to + "_link",
         SubmodelName(balance(a)),
         "loss of " + node(a) + " += G (T_" + node(a) + " - T_" + to + ")",
         "Node " + node(a) + " gives heat to " + to + ", which the network lacks.",
         {W_per_K()},
         {},
         "a long hold and a long cooling, with a thermometer on " + node(a)});
  }

  void add_radiation(std::size_t a) {
    const std::string& to = network_.given.front().name;
    add(Kind::radiation, a, 0,
        {node(a) + "_radiation",
         SubmodelName(balance(a)),
         "loss of " + node(a) + " += sigma A eps (T^4 - T_" + to + "^4), in kelvin",
         "Node " + node(a) + " radiates: hot, it loses more than in proportion to its temperature rise.",
         {parameter(0, "emissive_area_m2").unit("m^2").within(0.0, 10.0).starts({0.0})},
         {},
         "long holds at the highest and at a low temperature"});
  }

  void add_convection(std::size_t a) {
    bool loses = false;
    for (std::size_t k = 0; k < network_.given.size(); ++k)
      loses = loses || network_.linked(a, network_.nodes.size() + k);
    if (!loses) return;
    add(Kind::natural_convection, a, 0,
        {node(a) + "_natural_convection",
         SubmodelName(balance(a)),
         "loss of " + node(a) + " = G (T - Ta) (|T - Ta| / reference)^n",
         "Warm air rises faster the warmer it is: what " + node(a) + " loses grows faster than its rise.",
         {parameter(0, "exponent").unit("1").within(0.0, 1.0).starts({0.2}),
          parameter(1, "reference_K").unit("K").within(1.0, 300.0).logarithmic().starts({20.0})},
         {},
         "long holds at the highest and at a low temperature"});
  }

  void add_hidden_mass(std::size_t a) {
    const double own = network_.nodes[a].heat_capacity_J_per_K, largest = largest_W_per_K();
    add(Kind::hidden_mass, a, 0,
        {node(a) + "_hidden_mass",
         SubmodelName(balance(a)),
         "C dT/dt = G (T_" + node(a) + " - T), the same heat out of " + node(a),
         "Behind " + node(a) + " there is a further part that nobody measures and the network lacks.",
         {parameter(0, "J_per_K")
              .unit("J/K")
              .within(1e-3 * own, 1e3 * own)
              .logarithmic()
              .starts({0.3 * own, 3.0 * own}),
          parameter(1, "W_per_K")
              .unit("W/K")
              .within(1e-4 * largest, 1e2 * largest)
              .logarithmic()
              .starts({0.2 * largest})},
         {},
         "a long hold after a long rest, and the first minutes after a step of the heat",
         {},
         false,
         // C / G: one that takes longer than the record stands for a loss.
         [](const double* p) { return p[0] / p[1]; }});
  }

  void add_thermometer_bias(std::size_t a) {
    add(Kind::thermometer_bias, a, 0,
        {node(a) + "_thermometer_bias",
         SubmodelName("sensing." + node(a)),
         "reading of " + node(a) + " = T + bias",
         "The thermometer on " + node(a) + " shows too much, or too little, by the same everywhere.",
         {parameter(0, "bias_K").unit("K").within(-40.0, 40.0).starts({0.0})},
         {},
         "a long rest, until everything is as warm as the air"});
  }

  void add_errors(std::size_t given) {
    const std::string& name = network_.given[given].name;
    add(Kind::given_bias, given, 0,
        {name + "_bias",
         SubmodelName("sensing." + name),
         "T_" + name + " = recorded + bias",
         "The temperature of " + name + " is not what is recorded, by the same all the time.",
         {parameter(0, "bias_K").unit("K").within(-40.0, 40.0).starts({0.0})},
         {},
         "a long rest with the heat off, until everything is as warm as " + name});
    add(Kind::given_drift, given, 0,
        {name + "_drift",
         SubmodelName("sensing." + name),
         "T_" + name + " = recorded + drift t",
         "The temperature of " + name +
             " moves away from what is recorded, straight from the start of a run on.",
         {parameter(0, "K_per_h").unit("K/h").within(-200.0, 200.0).starts({0.0})},
         {},
         "a long rest with the heat off, and a thermometer at " + name});
  }

  /// Which node has more of a heat, or less, than the network says; of two that share a heat one says it of both.
  void add_shares(std::size_t source) {
    const NetworkHeat& heat = network_.heat[source];
    std::size_t warmed = 0;
    for (const auto& share : heat.shares) warmed += share.second > 0.0;
    bool first = true;
    for (std::size_t a = 0; a < network_.nodes.size(); ++a) {
      const auto found = heat.shares.find(node(a));
      const double share = found == heat.shares.end() ? 0.0 : found->second;
      if (share >= 1.0) continue;  // all the others' effects take it away from this one
      if (share > 0.0 && warmed == 2 && std::exchange(first, false)) continue;
      const double least = share > 0.0 ? -share / (1.0 - share) : 0.0;
      add(Kind::heat_share, source, a,
          {node(a) + "_share_of_" + heat.column,
           SubmodelName(balance(a)),
           "heat of " + node(a) + " = (1 - s) what it was + s " + heat.column +
               "; of the others (1 - s) what it was",
           "More of a heat warms " + node(a) + " than the network says" + (share > 0.0 ? ", or less." : "."),
           {parameter(0, "share").unit("1").within(least, 1.0).starts({0.15})},
           {},
           "short strong pulses of the heat: what they warm at once is where it goes"});
    }
  }

  void add_tempco() {
    std::size_t wound = 0;
    for (const NetworkHeat& heat : network_.heat)
      if (heat.winding) wound = *network_.place_of(heat.winding->node);
    add(Kind::tempco, wound, 0,
        {node(wound) + "_tempco",
         SubmodelName(balance(wound)),
         "R = R_0 (1 + a (T - T_0))",
         "The resistance of " + node(wound) + " grows with its temperature, and its heat with that.",
         {parameter(0, "per_K").unit("1/K").within(-0.01, 0.02).starts({0.0039})},
         {},
         "the same current cold and hot"});
  }

  const ThermalNetwork& network_;
  std::vector<NetworkEffect> list_;
};

}  // namespace detail

/// The effects that a network may have besides what it says: links that it lacks, radiation and natural convection,
/// masses behind its thermometers, errors of what is given and of thermometers, other shares of the heat.
/// @param network  a valid one
inline std::vector<NetworkEffect> network_effects(const ThermalNetwork& network) {
  return detail::NetworkEffects(network).all();
}

}  // namespace thermopower::plant
