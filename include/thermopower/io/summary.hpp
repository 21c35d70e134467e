// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/io/names.hpp>
#include <thermopower/io/provenance.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief What a person reads in ten seconds: the verdict, the answer in words, where, which and how sure, what it cannot be told
/// apart from, how far the gap shrinks, and the next experiment. Plain text of at most 100 columns.
/// @param effects  the catalogue, for what an effect is in words; without it the standard one
std::string summary(const Diagnosis& diagnosis, const std::vector<EffectInfo>& effects = {});

/// @brief The same as Markdown, to be pasted into an issue or a pull request.
/// @param model_name  as in the model file; may be empty
/// @param effects  as above
/// @param made_of  what it was made of
std::string summary_markdown(const Diagnosis& diagnosis, const std::string& model_name,
                             const std::vector<EffectInfo>& effects = {}, const Provenance& made_of = {});

/// @brief Verdict and causes in one line, for places with room for no more.
std::string one_sentence(const Diagnosis& diagnosis);

/// @brief The findings of at least some severity, one under the other, each with what was done and what would mend it.
std::string findings_text(const std::vector<Finding>& findings, Severity least);

/// @brief One labelled paragraph of a summary, wrapped and indented.
std::string summary_line(const std::string& label, const std::string& text);

/// @brief The catalogue as text: id, submodel, equation, parameters with units and bounds, needs.
std::string catalogue_text(const std::vector<EffectInfo>& effects);

}  // namespace thermopower::io
