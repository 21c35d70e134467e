// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <optional>
#include <string_view>

namespace thermopower::gap {

/// The conclusion of a diagnosis.
enum class Verdict {
  no_gap,        ///< the simulation, its constants within their uncertainties, scores near the noise
  explained,     ///< the causes bring held-out data near the noise floor, and nothing else does
  partial,       ///< the causes take a proven part of the held-out gap away; the rest is above the noise
  ambiguous,     ///< several explanations do, and this recording cannot tell them apart
  unexplained,   ///< there is a gap, and no effect (or small set of them) of the catalogue closes it
  insufficient,  ///< too little data for any statement
};

/// The verdict as the report spells it.
inline const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::no_gap:
      return "no_gap";
    case Verdict::explained:
      return "explained";
    case Verdict::partial:
      return "partial";
    case Verdict::ambiguous:
      return "ambiguous";
    case Verdict::unexplained:
      return "unexplained";
    case Verdict::insufficient:
      return "insufficient";
  }
  return "insufficient";
}

/// The verdict that a report spells so; none for another word.
inline std::optional<Verdict> verdict_of(std::string_view text) {
  for (const Verdict one : {Verdict::no_gap, Verdict::explained, Verdict::partial, Verdict::ambiguous,
                            Verdict::unexplained, Verdict::insufficient})
    if (text == to_string(one)) return one;
  return std::nullopt;
}

}  // namespace thermopower::gap
