// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// An effect whose equation no stage would call.
// standard: 17
// expect: thermopower: an effect needs a hook

#include <thermopower/plant/catalogue.hpp>

namespace plant = thermopower::plant;

struct Drag {
  enum Parameters { size };
  static plant::EffectInfo info() {
    return {"drag",
            plant::Submodel::mechanical_friction,
            "torque -= c w",
            "A drag.",
            {plant::parameter(size, "size").within(0.0, 1.0).starts({0.0})},
            {plant::Need::axis_model},
            "motion"};
  }
#ifdef MISUSE
  template <class Scalar>
  static void act(plant::AxisTerms<Scalar>& terms, const Scalar* p) {
    terms.load_Nm -= p[size] * terms.rate_rad_per_s;
  }
#else
  template <class Scalar>
  static void act(const Scalar* p, plant::AxisTerms<Scalar>& terms) {
    terms.load_Nm -= p[size] * terms.rate_rad_per_s;
  }
#endif
};

int main() {
  plant::Catalogue catalogue;
  catalogue.add<Drag>();
}
