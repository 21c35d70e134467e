// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::plant {

/// The type of what an effect is given besides states and parameters: time and recorded columns.
template <class Scalar>
struct GivenFor {
  using type = double;  ///< plain in a simulation and in a fit, as nothing is derived by it
};

/// Time and recorded columns, as an effect with this scalar is given them: `double` in a simulation and in a
/// fit, an expression where the effect writes itself down. Take it by `const auto`, not by `const double`, and
/// make a scalar of it by `Scalar(x)`.
template <class Scalar>
using Given = typename GivenFor<Scalar>::type;

}  // namespace thermopower::plant
