// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace thermopower::plant {

/// One parameter of an effect.
struct Parameter {
  std::string name;                 ///< as in model files and reports
  std::string unit;                 ///< "1" for a pure number
  double lower = 0.0;               ///< physical bound
  double upper = 1.0;               ///< physical bound
  std::vector<double> starts = {};  ///< where fits begin, inside the bounds, at least one
  bool logarithmic = false;  ///< positive and known by order of magnitude only: fitted as its logarithm
  std::string starts_relative_to = {};  ///< a column: the starts are fractions of its largest magnitude
  std::optional<double> standard = {};  ///< its value where a model leaves it out; none: it must be given
  /// At its bounds the effect is another one: a fit that ends there explains nothing.
  bool degenerate_at_bounds = false;
};

/// What an effect is, for people and for the engine. The equation in code is the effect's hooks.
struct EffectInfo {
  std::string id;                     ///< stable, snake_case
  std::string submodel;               ///< `thermal.loss`, `mechanical.friction`, ...
  std::string equation;               ///< one line of text
  std::string prose;                  ///< one line: what it is and how it shows
  std::vector<Parameter> parameters;  ///< in the order the hooks see them
  std::vector<std::string> needs;     ///< columns and model blocks without which it cannot be judged
  std::string experiment;             ///< the excitation that shows it best
};

}  // namespace thermopower::plant
