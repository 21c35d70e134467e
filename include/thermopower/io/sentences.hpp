// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/io/names.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief What a diagnosis found, in sentences for people who know nothing of ids: what is missing and how large it is, how much of
/// the error goes with it, and what the recording cannot tell. The summary, the page and the report for machines begin with them.
///
/// Units are spelt in ASCII (`degC`, `ohm`).
/// @param effects  says what an effect is; what it lacks is looked up in the standard catalogue
std::vector<std::string> sentences(const Diagnosis& diagnosis, const std::vector<EffectInfo>& effects = {});

/// @brief An id as words: "winding tempco"; a constant as "inertia of the model".
std::string effect_in_words(const std::string& effect);

/// @brief A part of the plant as words: "friction" for `mechanical.friction`; the name itself where nobody knows better.
std::string part_in_words(const std::string& submodel);

/// @brief A parameter's value as people write it: "0.393 % per K [0.388, 0.398]", "lag 25.1 s [24.0, 26.2]".
std::string in_people_units(const ParameterEstimate& parameter);

}  // namespace thermopower::io
