// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/effect.hpp>

#include <string_view>
#include <vector>

namespace thermopower::gap {

/// The effects that a diagnosis knows. `add<MyEffect>()` adds one; nothing else changes.
class Catalogue {
public:
  /// Adds an effect type; see effect.hpp for what it must have.
  template <class Effect>
  Catalogue& add();

  /// What there is, in a fixed order.
  const std::vector<EffectInfo>& list() const { return infos_; }

private:
  std::vector<EffectInfo> infos_;
};

/// The catalogue that comes with the library.
const Catalogue& standard_catalogue();

}  // namespace thermopower::gap
