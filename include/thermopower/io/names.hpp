// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::gap {}

/// Files of the diagnosis: recordings and models in, reports, pages, predictions and firmware headers out.
namespace thermopower::io {

using namespace gap;  // NOLINT: what is read and written are the diagnosis's types

}  // namespace thermopower::io
