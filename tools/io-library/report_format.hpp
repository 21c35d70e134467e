// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::io {

/// What stands as "format" in a report for machines.
inline constexpr const char* report_format = "thermopower-gap-report/1";

}  // namespace thermopower::io
