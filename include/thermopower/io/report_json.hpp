// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/io/names.hpp>
#include <thermopower/io/provenance.hpp>
#include <thermopower/plant/effect.hpp>

#include <string>

namespace thermopower::io {

/// @brief The report for machines ("thermopower-gap-report/1", @ref gap_files).
///
/// Keys in a fixed order, numbers that read back bit by bit, NaN and infinities as null, no time stamp and no
/// duration: the same diagnosis gives the same bytes.
/// @param effects  the catalogue, for what an effect is in words; without it the standard one
/// @param made_of  what it was made of; its date is left out
std::string report_json(const Diagnosis& diagnosis, const std::vector<EffectInfo>& effects = {},
                        const Provenance& made_of = {});

/// @brief The same with the model that was diagnosed, under `model`: thermopower-gap design needs it.
std::string report_json(const Diagnosis& diagnosis, const Model& model,
                        const std::vector<EffectInfo>& effects = {}, const Provenance& made_of = {});

/// @brief The findings as a JSON list, as reports have it under `findings`.
std::string findings_json(const std::vector<Finding>& findings);

}  // namespace thermopower::io
