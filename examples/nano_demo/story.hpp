// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <array>
#include <string>
#include <thermopower/motors/bgm2606_90t.hpp>
#include <thermopower/motors/bgm5208_200_12.hpp>
#include <thermopower/thermopower.hpp>
#include <vector>

#include "rig.hpp"

namespace nano {

/// A part of the scripted minute.
struct Phase {
  const char* name;
  double from_s, to_s;
};

/// The minute: what pushes the gimbal, and three motors that warm as the corrected laws say.
class Story {
public:
  static const std::vector<Phase>& phases();
  static double end_s() { return phases().back().to_s; }
  static const Phase& phase_at(double time_s);

  Story();
  /// Warms the motors with the power the board has in force, and says what the board measures. For Rig.
  Rig::Truth advance(double time_s, const Rig::Board& board);

  /// True temperatures at one time.
  struct Sample {
    double time_s;
    std::array<double, 3> motor_C;
  };
  /// One per look of the board at its input.
  const std::vector<Sample>& samples() const { return samples_; }
  /// V_rms I, integrated.
  double winding_J(int axis) const { return axes_[std::size_t(axis)].winding.state().energy_J; }
  /// V_supply I, integrated.
  double supply_J(int axis) const { return axes_[std::size_t(axis)].supply.state().energy_J; }

private:
  typedef thermopower::CurrentModel<thermopower::ThesisCurrent<double>> Current;
  typedef thermopower::ThermalModel<thermopower::ThesisHeating<double>, thermopower::RateCooling<double>,
                                    thermopower::LinearizedStep>
      Thermal;
  struct Axis {
    Current current;
    Thermal thermal;
    thermopower::EnergyMeter<thermopower::AtWinding, double> winding;
    thermopower::EnergyMeter<thermopower::AtSupply, double> supply;
  };
  template <class Motor>
  static Axis axis_of();

  std::array<Axis, 3> axes_;
  std::vector<Sample> samples_;
  double last_s_ = 0;
};

}  // namespace nano
