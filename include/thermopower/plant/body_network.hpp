// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/bench_state.hpp>
#include <thermopower/plant/network_step.hpp>
#include <thermopower/plant/terms.hpp>

#include <cstddef>

namespace thermopower::plant {

/// Places of a body's nodes in a network. Where winding and surface are one, both have its place, the first one.
///
/// How the whole works: @ref gap_method.
struct BodyPlaces {
  std::size_t surface;   ///< node that the air cools
  std::size_t soaking;   ///< node behind the surface, where there is one
  std::size_t enclosed;  ///< air around the body, where it warms up
  std::size_t count;     ///< nodes

  /// @param shape  says which nodes there are
  template <class Scalar>
  explicit BodyPlaces(const ThermalStructure<Scalar>& shape)
      : surface(shape.two_nodes ? 1 : 0),
        soaking(surface + 1),
        enclosed(soaking + (shape.soaks ? 1 : 0)),
        count(enclosed + (shape.enclosed ? 1 : 0)) {}
};

/// The heat that the nodes of a body with more of them than two exchange, as steps of any length take it.
template <class Scalar>
using BodyNetwork = NetworkStep<Scalar, 4>;

/// The network of a body.
/// @param coupling_W_per_K  between winding and surface
/// @param rise_K_per_J      what a joule warms all nodes but the enclosed air by, together
/// @param loss_per_s        of the surface to the air, relative to all that
template <class Scalar>
BodyNetwork<Scalar> body_network(const ThermalStructure<Scalar>& shape, const BodyPlaces& at,
                                 const Scalar& coupling_W_per_K, const Scalar& rise_K_per_J,
                                 const Scalar& loss_per_s) {
  const Scalar rest = shape.own_share();
  const Scalar surface_share = shape.two_nodes ? Scalar(rest * (1.0 - shape.winding_share)) : rest;
  BodyNetwork<Scalar> result(at.count);
  if (shape.two_nodes) {
    const Scalar flow_per_s = coupling_W_per_K * rise_K_per_J;
    result.link(0, at.surface, flow_per_s / (rest * shape.winding_share), flow_per_s / surface_share);
  }
  if (shape.soaks) {
    const Scalar soaking_K_per_J = shape.soaking_K_per_J(rise_K_per_J);
    result.link(at.surface, at.soaking, shape.soaking_W_per_K * rise_K_per_J / surface_share,
                shape.soaking_W_per_K * soaking_K_per_J);
    result.lose(at.soaking, shape.soaking_loss_W_per_K * soaking_K_per_J);
  }
  if (shape.enclosed) {
    result.link(at.surface, at.enclosed, loss_per_s / surface_share, loss_per_s / shape.enclosed_share);
    result.lose(at.enclosed, shape.enclosed_W_per_K * rise_K_per_J / shape.enclosed_share);
  } else {
    result.lose(at.surface, loss_per_s / surface_share);
  }
  return result;
}

/// A slope of every node as a network takes it.
template <class Scalar>
typename BodyNetwork<Scalar>::Nodes nodes_of(const BodyPlaces& at, const BenchSlope<Scalar>& rate) {
  typename BodyNetwork<Scalar>::Nodes nodes;
  nodes.fill(constant<Scalar>(0.0));
  nodes[0] = rate.winding;
  if (at.surface > 0) nodes[at.surface] = rate.surface;
  if (at.enclosed > at.soaking) nodes[at.soaking] = rate.further.soaking_C;
  if (at.count > at.enclosed) nodes[at.enclosed] = rate.further.enclosed_C;
  return nodes;
}

/// And back. @param charge  Ah/s
template <class Scalar>
BenchSlope<Scalar> slope_of(const BodyPlaces& at, const typename BodyNetwork<Scalar>::Nodes& nodes,
                            const Scalar& charge) {
  const Scalar still = constant<Scalar>(0.0);
  BenchSlope<Scalar> rate{nodes[0], nodes[at.surface], charge, {}};
  rate.further.any = true;
  rate.further.soaking_C = at.enclosed > at.soaking ? nodes[at.soaking] : still;
  rate.further.enclosed_C = at.count > at.enclosed ? nodes[at.enclosed] : still;
  return rate;
}

}  // namespace thermopower::plant
