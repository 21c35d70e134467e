// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fit.hpp"
#include "random.hpp"

namespace gap_benchmark {

/// One cause: how large it is drawn, and what a fit may move when it is a suspect.
/// `Context` is what sizes are chosen against, `Values` the parameters of the plant.
template <class Context, class Values>
struct Effect {
  std::string id;
  std::string submodel;              ///< where it acts
  std::vector<std::string> signals;  ///< where it shows when every submodel is judged on its measured inputs
  std::function<bool(const Context&)> possible;
  std::function<void(Random&, const Context&, Values&)> draw;
  std::function<std::vector<Free>(const Context&)> suspect;
  std::vector<std::string>
      contains;  ///< causes of which this one is the richer kind: no rivals, but the same and more
};

template <class EffectType>
const EffectType& named(const std::vector<EffectType>& effects, const std::string& id) {
  for (const auto& effect : effects)
    if (effect.id == id) return effect;
  throw std::out_of_range("no effect " + id);
}

}  // namespace gap_benchmark
