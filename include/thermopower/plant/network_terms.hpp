// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/natural_convection.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/radiation_cooling.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/network_step.hpp>
#include <thermopower/plant/thermal_network.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::plant {

/// Nodes that a network may have with the one that an effect adds.
inline constexpr std::size_t most_nodes_in_step = most_network_nodes + 1;

/// The stiff part of a network's equations, as steps of any length take it.
template <class Scalar>
using NetworkExchange = NetworkStep<Scalar, most_nodes_in_step>;

/// The equations of a thermal network with numbers in them: what effects change, and what is integrated.
///
/// @tparam Scalar  `double`, a Dual in fits, an Expression where they are written down
///
/// @snippet plant_examples.cpp network equations
/// How to: @ref motor_on_a_frame.
template <class Scalar>
struct NetworkTerms {
  /// Heat between two nodes.
  struct Link {
    std::size_t from;  ///< a node
    std::size_t to;    ///< another one
    Scalar W_per_K;    ///< conductance
  };
  /// Heat from a node to a given temperature.
  struct Loss {
    std::size_t node;         ///< that loses it
    std::size_t given;        ///< place of the given temperature in its list
    Scalar W_per_K;           ///< conductance; at `reference_K` where it grows with the difference
    bool natural = false;     ///< it grows with the difference, by `exponent`
    Scalar exponent{0.0};     ///< of natural convection
    Scalar reference_K{1.0};  ///< K, at which the conductance is as without
  };
  /// Radiation from a node to surroundings of a given temperature.
  struct Radiated {
    std::size_t node;         ///< that loses it
    std::size_t given;        ///< place of the given temperature in its list
    Scalar emissive_area_m2;  ///< emissivity times area
  };
  /// An error of a given temperature: how much warmer it is than what is recorded.
  struct GivenError {
    std::size_t given;  ///< place in the list
    Scalar K;           ///< constant part
    Scalar K_per_s;     ///< what it gains since the run's start
  };
  /// A heat, and the nodes that it warms.
  struct Source {
    std::size_t input;           ///< place among the inputs
    bool is_current;             ///< in A through the winding, else in W
    std::vector<Scalar> shares;  ///< by node; shorter: no share
  };

  std::vector<Scalar> capacity_J_per_K;                                  ///< by node
  std::vector<Link> links;                                               ///< between nodes
  std::vector<Loss> losses;                                              ///< to given temperatures
  std::vector<Radiated> radiated;                                        ///< besides
  std::vector<GivenError> errors;                                        ///< of given temperatures
  std::vector<Source> sources;                                           ///< of heat
  OhmicCurrent<Scalar> winding{Scalar(1.0), Scalar(0.0), Scalar(25.0)};  ///< that a current heats
  std::size_t winding_node = 0;         ///< whose temperature its resistance follows
  std::vector<Scalar> reading_error_K;  ///< by node: what its thermometer shows too much

  /// Number of nodes.
  std::size_t count() const { return capacity_J_per_K.size(); }

  /// A given temperature as the network sees it.
  /// @param inputs  given temperatures, then heats
  /// @param t_s     since the start of the run
  template <class Time>
  Scalar given_C(std::size_t given, const Scalar* inputs, const Time& t_s) const {
    Scalar result = inputs[given];
    for (const GivenError& one : errors)
      if (one.given == given) result += one.K + one.K_per_s * t_s;
    return result;
  }

  /// dT/dt of every node, K/s.
  /// @param node_C   temperatures, count() of them
  /// @param inputs   given temperatures, then heats
  /// @param t_s      since the start of the run
  /// @param rate     receives count() of them
  template <class Time>
  void rates(const Scalar* node_C, const Scalar* inputs, const Time& t_s, Scalar* rate) const {
    for (std::size_t i = 0; i < count(); ++i) rate[i] = constant<Scalar>(0.0);  // heat into each, W
    for (const Source& source : sources) {
      Scalar heat_W = inputs[source.input];
      if (source.is_current) heat_W *= inputs[source.input] * winding.resistance_at(node_C[winding_node]);
      for (std::size_t i = 0; i < source.shares.size(); ++i) rate[i] += source.shares[i] * heat_W;
    }
    for (const Link& link : links) {
      const Scalar flow_W = link.W_per_K * (node_C[link.from] - node_C[link.to]);
      rate[link.from] -= flow_W;
      rate[link.to] += flow_W;
    }
    for (const Loss& loss : losses) {
      const Scalar outside_C = given_C(loss.given, inputs, t_s);
      if (loss.natural)
        rate[loss.node] -= NaturalConvection<Scalar>{loss.W_per_K, loss.exponent, loss.reference_K}.loss_W(
            node_C[loss.node], {outside_C, constant<Scalar>(0.0)});
      else rate[loss.node] -= loss.W_per_K * (node_C[loss.node] - outside_C);
    }
    for (const Radiated& one : radiated)
      rate[one.node] -= RadiationCooling<Scalar>{one.emissive_area_m2, constant<Scalar>(1.0)}.loss_W(
          node_C[one.node], {given_C(one.given, inputs, t_s), constant<Scalar>(0.0)});
    for (std::size_t i = 0; i < count(); ++i) rate[i] /= capacity_J_per_K[i];
  }

  /// The stiff part: what nodes exchange, and what they lose in proportion.
  NetworkExchange<Scalar> exchange() const {
    NetworkExchange<Scalar> result(count());
    for (const Link& link : links)
      result.link(link.from, link.to, link.W_per_K / capacity_J_per_K[link.from],
                  link.W_per_K / capacity_J_per_K[link.to]);
    for (const Loss& loss : losses) result.lose(loss.node, loss.W_per_K / capacity_J_per_K[loss.node]);
    return result;
  }
};

/// Steps a network through intervals of held inputs by the Rosenbrock rule of NetworkStep: of any length, however fast
/// nodes exchange, cut until the second stage moves the nodes little.
///
/// @snippet plant_examples.cpp network equations
/// How to: @ref motor_on_a_frame.
template <class Scalar>
class NetworkIntegrator {
public:
  /// Temperatures of the nodes, degC; those beyond the count are not used.
  using Nodes = typename NetworkExchange<Scalar>::Nodes;

  /// @param terms  that must outlive it, and not change
  explicit NetworkIntegrator(const NetworkTerms<Scalar>& terms)
      : terms_(terms), exchange_(terms.exchange()) {}

  /// Goes through an interval.
  /// @param inputs  given temperatures, then heats, held over it
  /// @param t_s     its beginning, since the start of the run
  /// @param dt_s    its length, > 0
  void advance(Nodes& node_C, const Scalar* inputs, double t_s, double dt_s) {
    constexpr double enough_K =
        0.02;  // between the first and the second order: the third is far below any thermometer
    const double shortest_s = dt_s / 4096.0;
    const std::size_t count = terms_.count();
    double done_s = 0.0, h_s = dt_s;
    Nodes first, one, two, reached;
    terms_.rates(node_C.data(), inputs, t_s, first.data());
    while (done_s < dt_s) {
      set_length(h_s);
      std::copy_n(first.begin(), count, one.begin());
      exchange_.solve(one);
      for (std::size_t i = 0; i < count; ++i) reached[i] = node_C[i] + one[i] * h_s;
      terms_.rates(reached.data(), inputs, t_s + done_s + h_s, two.data());
      for (std::size_t i = 0; i < count; ++i) two[i] -= 2.0 * one[i];
      exchange_.solve(two);
      double moved_K = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        const double correction = 0.5 * h_s * (value_of(one[i]) + value_of(two[i]));
        moved_K = moved_K > (correction < 0.0 ? -correction : correction) ? moved_K
                  : correction < 0.0                                      ? -correction
                                                                          : correction;
      }
      if (moved_K > enough_K && h_s > shortest_s) {
        h_s *= 0.5;
        continue;
      }
      for (std::size_t i = 0; i < count; ++i) node_C[i] += (1.5 * one[i] + 0.5 * two[i]) * h_s;
      done_s += h_s;
      const double left_s = dt_s - done_s;
      if (!(left_s > 1e-12 * dt_s)) return;
      if (moved_K < 0.25 * enough_K) h_s *= 2.0;
      if (h_s > left_s) h_s = left_s;
      terms_.rates(node_C.data(), inputs, t_s + done_s, first.data());
    }
  }

private:
  void set_length(double h_s) {
    // Rows at one rate, and halves of it: mostly nothing is to be eliminated anew. Differences of stamps are alike to their last
    // digits, and the rule is of second order whatever length it was eliminated for.
    constexpr double alike = 1e-6;
    if (std::abs(h_s - length_s_) <= alike * h_s) return;
    exchange_.set_length(h_s);
    length_s_ = h_s;
  }

  const NetworkTerms<Scalar>& terms_;
  NetworkExchange<Scalar> exchange_;
  double length_s_ = 0.0;
};

}  // namespace thermopower::plant
