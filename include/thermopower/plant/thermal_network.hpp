// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/signal.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::plant {

/// Most nodes that a network may have.
inline constexpr std::size_t most_network_nodes = 16;

/// A node of a thermal network: a part of the body whose temperature is one number.
struct NetworkNode {
  std::string name;                    ///< an identifier, as constants and effects are called after it
  double heat_capacity_J_per_K = 0.0;  ///< J/K, > 0
  std::string column = {};  ///< that its thermometer is recorded in, degC; empty: nobody measures it
  std::optional<double> initial_C =
      {};  ///< where a run starts if nobody measures it; none: where its neighbours leave it
};

/// A temperature that the network does not change: the air, a coolant, a wall.
struct GivenTemperature {
  std::string name;                        ///< an identifier
  std::string column;                      ///< that it is recorded in, degC
  std::optional<double> otherwise_C = {};  ///< its value where it is not recorded; none: it must be
};

/// A way that heat takes between two nodes, or between a node and a given temperature.
struct NetworkLink {
  std::string from;                  ///< a node
  std::string to;                    ///< another node, or a given temperature
  double conductance_W_per_K = 0.0;  ///< W/K, > 0
};

/// A winding that a recorded current heats: I^2 R, R = resistance (1 + tempco (T - reference)).
struct NetworkWinding {
  std::string node;               ///< whose temperature R follows
  double resistance_ohm = 1.0;    ///< ohm at the reference temperature, > 0
  double tempco_per_K = 0.00393;  ///< 1/K; 0 for a simulation that knows of none
  double reference_C = 25.0;      ///< degC
};

/// Heat into the network, and where it goes.
struct NetworkHeat {
  std::string column;                          ///< recorded: W, or A where there is a winding
  std::map<std::string, double> shares;        ///< by node, each 0..1, together 1
  std::optional<NetworkWinding> winding = {};  ///< the column is its current; at most one of a network
};

/// A body of any number of nodes that exchange heat with each other and with given temperatures:
///
///     C_i dT_i/dt = sum of shares of the heats + sum over links G (T_k - T_i)
///
/// A winding in a stator in a frame on a mount, each with a heat capacity, some of them with thermometers. It is a
/// description; network_model() makes a model of it that is simulated and diagnosed.
///
/// @snippet plant_examples.cpp thermal network
/// How to: @ref motor_on_a_frame.
struct ThermalNetwork {
  std::vector<NetworkNode> nodes;       ///< 1 to most_network_nodes, at least one of them measured
  std::vector<GivenTemperature> given;  ///< may be empty: then the body is insulated
  std::vector<NetworkLink> links;       ///< at most one between two
  std::vector<NetworkHeat> heat;        ///< may be empty: a body that cools

  /// Place of a node, or of a given temperature after all nodes; none where nothing is called so.
  std::optional<std::size_t> place_of(const std::string& name) const {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].name == name) return i;
    for (std::size_t i = 0; i < given.size(); ++i)
      if (given[i].name == name) return nodes.size() + i;
    return std::nullopt;
  }

  /// Whether two places are linked.
  bool linked(std::size_t a, std::size_t b) const {
    return std::any_of(links.begin(), links.end(), [&](const NetworkLink& one) {
      const auto from = place_of(one.from), to = place_of(one.to);
      return (from == a && to == b) || (from == b && to == a);
    });
  }

  /// Something that is wrong with a network.
  struct Problem {
    std::string where;  ///< `nodes/winding/heat_capacity_J_per_K`, `links/2/to`: a path through its parts
    std::string what;   ///< what it is, and what was expected
  };

  /// The first thing that is wrong, or nothing.
  std::optional<Problem> validate() const;
};

namespace detail {

/// Looks at a network part by part and keeps the first problem.
class NetworkCheck {
public:
  explicit NetworkCheck(const ThermalNetwork& network) : network_(network) {}

  std::optional<ThermalNetwork::Problem> run() {
    check_nodes();
    check_given();
    check_links();
    check_heat();
    check_names();
    check_ways();
    return problem_;
  }

private:
  void refuse(const std::string& where, const std::string& what) {
    if (!problem_) problem_ = ThermalNetwork::Problem{where, what};
  }

  static std::string shown(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (!text.empty() && text.back() == '.') text.pop_back();
    return text;
  }

  void positive(const std::string& where, double value) {
    if (!(value > 0.0) || !std::isfinite(value))
      refuse(where, "is " + shown(value) + "; expected a number above 0");
  }
  void finite(const std::string& where, double value) {
    if (!std::isfinite(value)) refuse(where, "is " + shown(value) + "; expected a finite number");
  }

  static bool is_identifier(const std::string& name) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    return !name.empty() && letter(name[0]) && std::all_of(name.begin(), name.end(), [&](char c) {
      return letter(c) || (c >= '0' && c <= '9') || c == '_';
    });
  }

  /// Every name of a node or a given temperature, and every column, once.
  void take(const std::string& where, const std::string& name, std::vector<std::string>& taken) {
    if (std::find(taken.begin(), taken.end(), name) != taken.end())
      refuse(where, "'" + name + "' is there twice; expected another name");
    taken.push_back(name);
  }

  void check_nodes() {
    if (network_.nodes.empty() || network_.nodes.size() > most_network_nodes)
      refuse("nodes", "are " + std::to_string(network_.nodes.size()) + "; expected 1 to " +
                          std::to_string(most_network_nodes));
    std::size_t measured = 0;
    for (const NetworkNode& node : network_.nodes) {
      const std::string here = "nodes/" + node.name;
      if (!is_identifier(node.name))
        refuse(here, "'" + node.name + "' is no name; expected a letter, then letters, digits and _");
      take(here, node.name, names_);
      positive(here + "/heat_capacity_J_per_K", node.heat_capacity_J_per_K);
      if (node.initial_C) finite(here + "/initial_C", *node.initial_C);
      if (node.column.empty()) continue;
      ++measured;
      take(here + "/column", node.column, columns_);
    }
    if (measured == 0 || measured > signal_count)
      refuse("nodes", std::to_string(measured) +
                          " of them have a column, that of a thermometer; expected 1 to " +
                          std::to_string(signal_count));
  }

  void check_given() {
    for (const GivenTemperature& one : network_.given) {
      const std::string here = "given/" + one.name;
      if (!is_identifier(one.name))
        refuse(here, "'" + one.name + "' is no name; expected a letter, then letters, digits and _");
      take(here, one.name, names_);
      if (one.column.empty()) refuse(here + "/column", "is empty; expected the name of a column");
      take(here + "/column", one.column, columns_);
      if (one.otherwise_C) finite(here + "/otherwise_C", *one.otherwise_C);
    }
  }

  void check_links() {
    for (std::size_t i = 0; i < network_.links.size(); ++i) {
      const NetworkLink& link = network_.links[i];
      const std::string here = "links/" + std::to_string(i);
      const auto from = network_.place_of(link.from), to = network_.place_of(link.to);
      if (!from || *from >= network_.nodes.size())
        refuse(here + "/from", "'" + link.from + "' is no node; expected one of " + list_of_nodes());
      if (!to) refuse(here + "/to", "'" + link.to + "' is neither a node nor a given temperature");
      if (from && from == to)
        refuse(here + "/to", "'" + link.to + "' is where it comes from; expected another node");
      positive(here + "/conductance_W_per_K", link.conductance_W_per_K);
      for (std::size_t k = 0; k < i; ++k) {
        const NetworkLink& other = network_.links[k];
        if ((other.from == link.from && other.to == link.to) ||
            (other.from == link.to && other.to == link.from))
          refuse(here, "'" + link.from + "' and '" + link.to +
                           "' are linked already; expected one link between two");
      }
    }
  }

  void check_heat() {
    bool wound = false;
    for (std::size_t i = 0; i < network_.heat.size(); ++i) {
      const NetworkHeat& heat = network_.heat[i];
      const std::string here = "heat/" + std::to_string(i);
      if (heat.column.empty()) refuse(here + "/column", "is empty; expected the name of a column");
      take(here + "/column", heat.column, columns_);
      double all = 0.0;
      for (const auto& [node, share] : heat.shares) {
        check_node(here + "/shares/" + node, node);
        if (!(share >= 0.0 && share <= 1.0))
          refuse(here + "/shares/" + node, "is " + shown(share) + "; expected 0 to 1");
        all += share;
      }
      constexpr double rounding = 1e-6;  // shares that are written with a few digits
      if (!(std::abs(all - 1.0) <= rounding))
        refuse(here + "/shares", "are " + shown(all) + " together; expected 1");
      if (!heat.winding) continue;
      if (wound) refuse(here, "is a second winding; expected at most one, and other heats in watts");
      wound = true;
      check_node(here + "/node", heat.winding->node);
      positive(here + "/resistance_ohm", heat.winding->resistance_ohm);
      finite(here + "/tempco_per_K", heat.winding->tempco_per_K);
      finite(here + "/reference_C", heat.winding->reference_C);
    }
  }

  void check_node(const std::string& where, const std::string& name) {
    const auto place = network_.place_of(name);
    if (!place || *place >= network_.nodes.size())
      refuse(where, "'" + name + "' is no node; expected one of " + list_of_nodes());
  }

  std::string list_of_nodes() const {
    std::string list;
    for (const NetworkNode& node : network_.nodes) list += (list.empty() ? "" : ", ") + node.name;
    return list;
  }

  /// Constants are called after what they link: `a` to `b_to_c` and `a_to_b` to `c` are one name.
  void check_names() {
    std::vector<std::string> links;
    for (std::size_t i = 0; i < network_.links.size(); ++i)
      take("links/" + std::to_string(i), network_.links[i].from + "_to_" + network_.links[i].to, links);
  }

  /// From every node there must be a way to one that is measured, or nothing tells of it.
  void check_ways() {
    if (problem_) return;
    std::vector<bool> reached(network_.nodes.size());
    for (std::size_t i = 0; i < reached.size(); ++i) reached[i] = !network_.nodes[i].column.empty();
    for (std::size_t round = 0; round < reached.size(); ++round)
      for (std::size_t a = 0; a < reached.size(); ++a)
        for (std::size_t b = 0; b < reached.size(); ++b)
          if (reached[a] && network_.linked(a, b)) reached[b] = true;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      const std::string& name = network_.nodes[i].name;
      const bool alone =
          std::none_of(network_.links.begin(), network_.links.end(),
                       [&](const NetworkLink& one) { return one.from == name || one.to == name; });
      if (alone)
        refuse("nodes/" + name, "has no link; expected a way to another node or to a given temperature");
      if (!reached[i]) refuse("nodes/" + name, "has no way to a node that is measured; expected one");
    }
  }

  const ThermalNetwork& network_;
  std::optional<ThermalNetwork::Problem> problem_;
  std::vector<std::string> names_, columns_;
};

}  // namespace detail

inline std::optional<ThermalNetwork::Problem> ThermalNetwork::validate() const {
  return detail::NetworkCheck(*this).run();
}

}  // namespace thermopower::plant
