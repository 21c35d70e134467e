// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// Voltage induced by the recorded rate.
struct BackEmf {
  /// What it is.
  static EffectInfo info() {
    return {"back_emf",
            "electrical",
            "I = (V_rms - k |rate|) / R(T)",
            "A turning motor pushes back: less current at the same voltage.",
            {{"V_s_per_rad", "V s/rad", 0.0, 100.0, {0.0}, false}},
            {"current", "current_A", "power_param", "rate_dps"},
            "the same power at rest and turning fast"};
  }

  /// Sets a voltage against the drive.
  template <class Scalar>
  static void act(const Scalar* p, ElectricalTerms<Scalar>& terms) {
    const double rate_rad_per_s = terms.rate_dps * 0.017453292519943295;
    terms.counter_V += p[0] * (rate_rad_per_s < 0.0 ? -rate_rad_per_s : rate_rad_per_s);
  }
};

}  // namespace thermopower::plant
