// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/explain.hpp>

#include "effect_notes.hpp"
#include "finding_notes.hpp"
#include "html_text.hpp"
#include "wrapped.hpp"

#include <thermopower/gap/reason.hpp>
#include <thermopower/gap/verdict.hpp>
#include <thermopower/io/sentences.hpp>
#include <thermopower/plant/calibration_id.hpp>
#include <thermopower/plant/curve_id.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <cctype>

namespace thermopower::io {
namespace {

constexpr const char* headings[] = {"Meaning",    "Signs",         "Mistaken for",
                                    "Experiment", "In simulators", "Negligible"};

CodePage page_of(const std::string& code, const char* kind, const std::vector<std::string>& texts) {
  CodePage page{code, kind, {}};
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (!texts[i].empty()) page.sections.push_back({headings[i], texts[i], false});
  return page;
}

std::string sentence(const std::string& text) {
  if (text.empty()) return text;
  const std::string begun = capital(text);
  return begun.back() == '.' ? begun : begun + ".";
}

std::string parameters_of(const EffectInfo& effect) {
  std::string text;
  for (const plant::Parameter& one : effect.parameters)
    text += (text.empty() ? "" : "; ") + one.name + (one.unit == "1" ? "" : " in " + one.unit) + ", " +
            readable(one.lower) + " to " + readable(one.upper);
  return text;
}

std::string needs_of(const EffectInfo& effect) {
  std::string text;
  for (const plant::Need one : effect.needs)
    text += (text.empty() ? " It needs: " : ", ") + std::string(to_string(one));
  return text.empty() ? text : text + ".";
}

CodePage page_of_effect(const EffectInfo& effect) {
  const EffectNotes* const notes = notes_of(effect.id);
  const auto note = [notes](const char* EffectNotes::*which) {
    return notes == nullptr ? std::string() : notes->*which;
  };
  CodePage page =
      page_of(effect.id, "effect",
              {sentence(effect.prose) + " It acts in the " + part_in_words(to_string(effect.submodel)) + ".",
               note(&EffectNotes::shows), sentence(note(&EffectNotes::mistaken_for)),
               sentence(effect.experiment) + needs_of(effect), note(&EffectNotes::in_simulators),
               note(&EffectNotes::ignore_when)});
  if (!effect.equation.empty()) page.sections.push_back({"Equation", effect.equation, true});
  if (!effect.parameters.empty() && !plant::is_curve(effect.id))
    page.sections.push_back({"Parameters", parameters_of(effect), true});
  return page;
}

CodePage page_of_constant(const std::string& code) {
  const std::string id = code.substr(sizeof plant::calibration_prefix - 1);
  return page_of(
      code, "effect",
      {"A constant of the model, " + id +
           ", is off by more than two of the uncertainties that the model file states or that are assumed. Its parameter is the factor on the configured value.",
       "The simulation is wrong in proportion, and refitted constants alone take the gap away.",
       "An effect that does the same over the recorded range, and a common factor of two constants: then a unit, a gear or the supply is wrong.",
       "Measure the constant by itself. Or vary the inputs over their whole range, slowly and fast.",
       "It is a number of the description: change it there. --augmented writes the model with it.",
       "Where the fitted value is within what is known of it."});
}

struct VerdictNotes {
  Verdict verdict;
  const char* is;
  const char* shows;
  const char* mistaken_for;
  const char* experiment;
  const char* ignore_when;
};

constexpr VerdictNotes verdicts[] = {
    {Verdict::no_gap,
     "The simulation, as it is configured, predicts held-out data as well as their noise allows.",
     "Every judged signal is within one and a half times its noise floor.",
     "A recording that does not excite what is wrong: nothing shows in a motor that stays cold.",
     "Record what the simulation will be used for: the largest power, the fastest motion, the longest run.",
     "Signals under 'not judged' do not count."},
    {Verdict::explained, "One explanation brings held-out data near their noise, and no other is as likely.",
     "The error with the effect is within one and a half times the noise floor in every judged signal.",
     "An effect that the catalogue lacks and that does the same in this recording: see 'looks like'.",
     "The experiment under 'next' confirms it or not.",
     "Where the interval of a parameter is wider than the use allows."},
    {Verdict::partial,
     "The named causes take a proven part of the held-out error away, and a rest stays above the noise.",
     "'remaining' says which signal, how much and how it varies.",
     "A full explanation. The rest may have another cause.",
     "Take the named cause into the model (--augmented), and diagnose again with recordings that show the rest.",
     "Where the rest is smaller than the use asks for."},
    {Verdict::ambiguous,
     "Several explanations bring held-out data near their noise, and this recording cannot tell them apart.",
     "'or' lists them.", "Uncertainty about whether there is a gap: there is one.",
     "The experiment under 'next' is the one in which they differ.",
     "Where any of them serves: inside the recorded range they predict the same."},
    {Verdict::unexplained, "There is a gap, and no effect of the catalogue closes it on held-out data.",
     "The missing quantity is drawn over what it follows most.",
     "A model whose constants are far off, or data in another unit.",
     "Record one thing at a time: the same motion cold and hot, the same power at rest and turning.",
     "Where the error is small enough for the use."},
    {Verdict::insufficient, "The data are too few for any statement, or cannot be believed as they stand.",
     "A finding of severity error names the column and what would mend it.",
     "A verdict about the simulation: it says nothing of it.", "What the finding or 'next' says.", "Never."}};

struct ReasonNotes {
  Reason reason;
  const char* experiment;
};

constexpr ReasonNotes reasons[] = {
    {Reason::too_little_data, "Record for longer, or as the finding says."},
    {Reason::configured_model_passes, "Record what the simulation will be used for."},
    {Reason::constants_within_known, "Take the refitted constants over (--augmented): they cost nothing."},
    {Reason::constants_moved, "Measure the constant that moved by itself."},
    {Reason::common_factor,
     "Read unit, gear ratio, supply and clock once more; record again with the right one."},
    {Reason::constants_close_most,
     "Measure those constants by themselves, correct them, and diagnose again."},
    {Reason::constants_leave_a_rest, "Vary one input at a time, over its whole range."},
    {Reason::cause_explains, "The experiment under 'next' confirms it."},
    {Reason::several_explain, "The experiment under 'next' tells them apart."},
    {Reason::cause_or_constants,
     "Measure the constants by themselves, and say in the model file how well they are known."},
    {Reason::cause_closes_a_part, "Take the cause into the model and diagnose again."},
    {Reason::several_close_a_part, "The experiment under 'next' tells them apart."},
    {Reason::closes_too_little, "Vary one input at a time, over its whole range."},
    {Reason::no_explanation_likely, "Record for longer, with larger and slower changes."},
    {Reason::simulation_runs_away,
     "Check units and signs with 'thermopower-gap check', and the model's constants."}};

CodePage page_of_verdict(const VerdictNotes& one) {
  return page_of(to_string(one.verdict), "verdict",
                 {one.is, one.shows, one.mistaken_for, one.experiment,
                  "It judges a simulation; no simulator writes it.", one.ignore_when});
}

CodePage page_of_reason(const ReasonNotes& one) {
  return page_of(code_of(one.reason), "reason",
                 {sentence(to_string(one.reason)),
                  "The report has it under decision, with every number that it was read off.", "",
                  one.experiment, "", ""});
}

CodePage page_of_finding(const FindingNotes& one) {
  return page_of(
      to_string(one.kind), "finding",
      {one.is, one.shows, one.mistaken_for, one.experiment,
       "It is about the recording. A log that a simulator writes has none of it.", one.ignore_when});
}

std::vector<EffectInfo> catalogue_of(const std::vector<EffectInfo>& effects) {
  std::vector<EffectInfo> all = effects;
  for (const EffectInfo& one : plant::standard_catalogue().list())
    if (std::none_of(all.begin(), all.end(), [&](const EffectInfo& known) { return known.id == one.id; }))
      all.push_back(one);
  return all;
}

std::vector<CodePage> every_page(const std::vector<EffectInfo>& effects) {
  std::vector<CodePage> list;
  for (const VerdictNotes& one : verdicts) list.push_back(page_of_verdict(one));
  for (const ReasonNotes& one : reasons) list.push_back(page_of_reason(one));
  for (const FindingNotes& one : finding_notes()) list.push_back(page_of_finding(one));
  for (const EffectInfo& one : catalogue_of(effects)) list.push_back(page_of_effect(one));
  return list;
}

}  // namespace

std::optional<CodePage> code_page(const std::string& code, const std::vector<EffectInfo>& effects) {
  if (plant::is_calibration(code)) return page_of_constant(code);
  for (CodePage& one : every_page(effects))
    if (one.code == code) return std::move(one);
  return std::nullopt;
}

std::vector<std::string> known_codes(const std::vector<EffectInfo>& effects) {
  std::vector<std::string> list;
  for (const CodePage& one : every_page(effects)) list.push_back(one.code);
  return list;
}

std::string to_text(const CodePage& page) {
  std::string out = page.code + "  (" + page.kind + ")\n";
  for (const CodeSection& one : page.sections)
    out += "  " + one.heading + "\n    " + wrapped(one.text, 4) + "\n";
  return out;
}

std::string code_pages_markdown() {
  std::string out;
  std::string kind;
  const auto literal = [](const std::string& text) {
    std::string plain;
    bool option = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
      // Two dashes would become one.
      if (!option && text.compare(i, 2, "--") == 0) plain += '`', option = true;
      else if (option && std::isalnum(static_cast<unsigned char>(text[i])) == 0 && text[i] != '-')
        plain += '`', option = false;
      plain += text[i] == '<'   ? "&lt;"
               : text[i] == '>' ? "&gt;"
               : text[i] == '|' ? "&#124;"
                                : std::string(1, text[i]);
    }
    return option ? plain + '`' : plain;
  };
  for (const CodePage& page : every_page({})) {
    if (page.kind != kind) out += (kind.empty() ? "## " : "\n## ") + capital(page.kind) + "s\n";
    kind = page.kind;
    out += "\n### " + page.code + "\n\n";
    for (const CodeSection& one : page.sections) {
      const bool is_code = one.is_code && one.text.find('|') == std::string::npos;  // it would end the cell
      out += "| " + one.heading + " | " + (is_code ? "`" + one.text + "`" : literal(one.text)) + " |\n";
      if (&one == &page.sections.front()) out += "|---|---|\n";
    }
  }
  return out;
}

}  // namespace thermopower::io
