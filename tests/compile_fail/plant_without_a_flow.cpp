// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A plant of one's own that does not say how its states change.
// standard: 17
// expect: thermopower: a plant needs 'template <class Scalar, class Effects> static void flow(

#include <thermopower/plant/state_plant.hpp>

namespace plant = thermopower::plant;

struct Tank {
  static plant::PlantInfo info() { return {}; }
  template <class Scalar>
  struct Terms {
    Scalar level_m;
  };
#ifdef MISUSE
  template <class Scalar>
  static Scalar flow(const Scalar* states) {
    return -states[0];
  }
#else
  template <class Scalar, class Effects>
  static void flow(const Scalar*, const Scalar* states, const Scalar*, const Effects&, Scalar* rates) {
    rates[0] = -states[0];
  }
#endif
  template <class Scalar, class Effects>
  static void read(const Scalar*, const Scalar* states, const Scalar*, const Effects&, Scalar* signals) {
    signals[0] = states[0];
  }
};

thermopower::plant::Model model = plant::adapt<Tank>("tank");
