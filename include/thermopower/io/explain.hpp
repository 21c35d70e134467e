// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/effect.hpp>
#include <thermopower/io/names.hpp>

#include <optional>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief One paragraph of a CodePage.
struct CodeSection {
  std::string heading;   ///< the same on every page
  std::string text;      ///< sentences in plain words
  bool is_code = false;  ///< it is an equation or a list of parameters instead
};

/// @brief What a code of a report means: an effect, a finding, a verdict or a reason.
struct CodePage {
  std::string code;  ///< as reports spell it
  std::string kind;  ///< `effect`, `finding`, `verdict` or `reason`
  std::vector<CodeSection>
      sections;  ///< what it is, how it shows, what it is mistaken for, which experiment tells it, how simulators
                 ///< write it, when to ignore it
};

/// @brief The page of a code.
/// @param code     id of an effect, `calibration.<constant>`, or a finding, verdict or reason as reports spell it
/// @param effects  a catalogue that may hold effects of one's own; without it the standard one
/// @return none where no code is spelt so
std::optional<CodePage> code_page(const std::string& code,
                                  const std::vector<plant::EffectInfo>& effects = {});

/// @brief Every code that has a page: verdicts, reasons, findings, then effects.
std::vector<std::string> known_codes(const std::vector<plant::EffectInfo>& effects = {});

/// @brief A page as text of at most 100 columns.
std::string to_text(const CodePage& page);

/// @brief All pages as one page of Markdown, as the documentation has it.
std::string code_pages_markdown();

}  // namespace thermopower::io
