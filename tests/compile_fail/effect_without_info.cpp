// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// An effect that does not say what it is.
// standard: 17
// expect: thermopower: an effect needs 'static thermopower::plant::EffectInfo info()'

#include <thermopower/plant/catalogue.hpp>

namespace plant = thermopower::plant;

struct Drag {
#ifndef MISUSE
  static plant::EffectInfo info() {
    return {"drag", plant::Submodel::mechanical_friction, "torque -= w", "A drag.", {}, {}, "motion"};
  }
#endif
  template <class Scalar>
  static void act(const Scalar*, plant::AxisTerms<Scalar>& terms) {
    terms.load_Nm -= terms.rate_rad_per_s;
  }
};

int main() {
  plant::Catalogue catalogue;
  catalogue.add<Drag>();
}
