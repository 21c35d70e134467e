// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>

#include <cstdio>

/// Prints the parts of a diagnosis that its findings stand in: verdict, where, which and how far.
inline void print(const thermopower::gap::Diagnosis& diagnosis) {
  std::printf("verdict    %s: %s\n", to_string(diagnosis.verdict), diagnosis.reason.c_str());
  for (const auto& one : diagnosis.where)
    std::printf("where      %s, %s %.0f %%: %s\n", to_string(one.signal).c_str(),
                to_string(one.submodel).c_str(), 100.0 * one.share, one.evidence.c_str());
  for (const auto& one : diagnosis.cause) {
    std::printf("which      %s (%.0f %%):", one.effect.c_str(), 100.0 * one.probability);
    for (const auto& p : one.parameters)
      std::printf(" %s %.3g [%.3g, %.3g]", p.name.c_str(), p.value, p.ci95.low, p.ci95.high);
    std::printf("\n");
  }
  for (const auto& one : diagnosis.gap)
    std::printf("how far    %s: %.3g -> %.3g %s, noise %.3g\n", to_string(one.signal).c_str(), one.before,
                one.after, one.unit.c_str(), one.noise_floor);
}
