// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/invalid_input.hpp>
#include <thermopower/plant/model.hpp>
#include <thermopower/plant/quantity.hpp>
#include <thermopower/plant/segment.hpp>
#include <thermopower/plant/signal.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::plant {

/// The balance that turns a missing rate of a signal into a missing quantity: of a heat, a torque, a flow.
struct PlantBalance {
  std::string
      constant;  ///< of the plant, by its name: the rate times it is the quantity, as with a heat capacity
  QuantityName quantity;  ///< `Quantity::missing_heat`, or one of one's own
  std::string unit;       ///< of the quantity, as reports spell it
  /// Constants, conductances of a node, whose sum over `constant` is how fast what was missing leaves again, 1/s, while
  /// its neighbours stay as they are: what shows at the end of an interval is less than what was missing in it.
  /// None: it stays.
  std::vector<std::string> leaves_by = {};
};

/// A signal of a plant of your own: a column of the recording that a diagnosis judges.
struct PlantSignal {
  std::string name;  ///< of the column, ends in its unit, as in `level_m`
  std::string unit;  ///< as reports spell it
  std::string
      submodel;  ///< who is at fault where the signal does not move as the equations say: `tank.outflow`
  std::optional<PlantBalance> balance = {};  ///< none: what is missing is told as a rate of the signal
  std::string note = {};  ///< how it is judged, for the evidence; empty: nothing to be said
};

/// An input of a plant of your own: a column of the recording, held from its row to the next one.
struct PlantInput {
  std::string name;                      ///< of the column
  std::string unit;                      ///< as reports spell it
  std::optional<double> otherwise = {};  ///< its value where it is not recorded; none: it must be
};

/// A state of a plant of your own.
struct PlantState {
  std::string name;      ///< for messages
  std::string unit;      ///< of the state
  int measured_by = -1;  ///< place of the signal that shows it as it is (but for sensor effects); -1: none
  double initial = 0.0;  ///< where a run starts if nobody measures it, in its unit
  double spread = 1.0;   ///< how far it typically moves, > 0, in its unit: the scale of steps and priors
  int shows_in = 0;      ///< of a state that nobody measures: place of the signal that tells its start
};

/// The description of a plant of your own, for people and for the engine.
struct PlantInfo {
  std::string type;                      ///< stable, snake_case
  std::vector<PlantConstant> constants;  ///< in the order in which its equations read them
  std::vector<PlantInput> inputs;        ///< in the same sense
  std::vector<PlantState> states;        ///< at most `largest_start`
  std::vector<PlantSignal> signals;      ///< one to `signal_count`
  /// Runs in windows that restart from the measured states, as an axis does, else over whole runs.
  bool windowed = false;

  /// @throws InvalidInput naming what cannot be used, and what was expected
  void validate() const {
    const auto refuse = [&](const std::string& what) { throw InvalidInput("plant '" + type + "': " + what); };
    if (type.empty()) refuse("has no type");
    if (signals.empty() || signals.size() > signal_count)
      refuse("has " + std::to_string(signals.size()) + " signals, expected 1 to " +
             std::to_string(signal_count));
    if (states.size() > largest_start)
      refuse("has " + std::to_string(states.size()) + " states, expected at most " +
             std::to_string(largest_start));
    for (const PlantState& state : states) {
      const int count = static_cast<int>(signals.size());
      if (state.measured_by >= count || state.shows_in < 0 || state.shows_in >= count)
        refuse("state '" + state.name + "' names a signal that there is not");
      if (!(state.spread > 0.0) || !std::isfinite(state.spread) || !std::isfinite(state.initial))
        refuse("state '" + state.name + "': expected a spread above 0 and a finite initial value");
    }
    for (const PlantSignal& signal : signals) {
      if (!signal.balance) continue;
      std::vector<std::string> named = signal.balance->leaves_by;
      named.push_back(signal.balance->constant);
      for (const std::string& name : named) {
        bool known = false;
        for (const PlantConstant& constant : constants) known = known || constant.name == name;
        if (!known)
          refuse("signal '" + signal.name + "': its balance names '" + name + "', which is no constant");
      }
    }
    for (const PlantConstant& constant : constants)
      if (constant.block.empty() || constant.name.empty()) refuse("a constant has no block or no name");
  }
};

}  // namespace thermopower::plant
