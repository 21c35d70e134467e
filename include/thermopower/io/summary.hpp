// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/io/names.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief What a person reads in ten seconds: the verdict, where, which and how sure, what it cannot be told
/// apart from, how far the gap shrinks, and the next experiment. Plain text of at most 100 columns.
std::string summary(const Diagnosis& diagnosis);

/// @brief Verdict and causes in one line, for places with room for no more.
std::string one_sentence(const Diagnosis& diagnosis);

/// @brief The findings of at least some severity, one under the other, each with what was done and what would mend it.
std::string findings_text(const std::vector<Finding>& findings, Severity least);

/// @brief One labelled paragraph of a summary, wrapped and indented.
std::string summary_line(const std::string& label, const std::string& text);

/// @brief The catalogue as text: id, submodel, equation, parameters with units and bounds, needs.
std::string catalogue_text(const std::vector<EffectInfo>& effects);

}  // namespace thermopower::io
