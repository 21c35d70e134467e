// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/io/names.hpp>
#include <thermopower/io/provenance.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief The report for people: one self-contained HTML page, light and dark, printable, legible on a telephone,
/// under 300 KB besides the data, whatever the length of the recordings.
///
/// Style, pictures and a small script are inside, nothing is loaded. The script adds zoom and values under the
/// pointer; everything reads without it.
/// @param model_name as in the model file
/// @param effects the catalogue, for what an effect is in words
/// @param held_out the recordings it was judged on: they tell runs apart and show what drove them
/// @param made_of what it was made of, as one line below the answer
std::string report_html(const Diagnosis& diagnosis, const std::string& model_name,
                        const std::vector<EffectInfo>& effects, const std::vector<Recording>& held_out = {},
                        const Provenance& made_of = {});

}  // namespace thermopower::io
