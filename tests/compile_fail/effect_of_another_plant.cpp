// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// An effect that acts on terms which the plant it is given to does not have.
// standard: 17
// expect: thermopower: an effect of a plant needs

#include <thermopower/plant/state_plant.hpp>

namespace plant = thermopower::plant;

struct Tank {
  static plant::PlantInfo info() { return {}; }
  template <class Scalar>
  struct Terms {
    Scalar outflow_m3_per_s;
  };
  template <class Scalar, class Effects>
  static void flow(const Scalar*, const Scalar* states, const Scalar*, const Effects& effects,
                   Scalar* rates) {
    Terms<Scalar> terms{states[0]};
    effects(terms);
    rates[0] = -terms.outflow_m3_per_s;
  }
  template <class Scalar, class Effects>
  static void read(const Scalar*, const Scalar* states, const Scalar*, const Effects&, Scalar* signals) {
    signals[0] = states[0];
  }
};

struct Leak {
  static plant::EffectInfo info() { return {}; }
#ifdef MISUSE
  template <class Scalar>
  static void act(const Scalar* p, plant::AxisTerms<Scalar>& terms) {
    terms.load_Nm += p[0];
  }
#else
  template <class Scalar>
  static void act(const Scalar* p, Tank::Terms<Scalar>& terms) {
    terms.outflow_m3_per_s += p[0];
  }
#endif
};

thermopower::plant::Model model = plant::adapt<Tank, Leak>("tank");
