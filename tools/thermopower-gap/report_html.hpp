// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/plant/effect.hpp>

#include <string>
#include <vector>

namespace thermopower::gap::files {

/// @brief The report for people: one self-contained HTML page (inline CSS and SVG, no script, no external
/// resource), light and dark, printable, under a megabyte whatever the length of the recordings.
/// @param model_name as in the model file
/// @param effects the catalogue, for what an effect is in words
std::string report_html(const Diagnosis& diagnosis, const std::string& model_name,
                        const std::vector<EffectInfo>& effects);

}  // namespace thermopower::gap::files
