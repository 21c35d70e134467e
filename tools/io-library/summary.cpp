// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/summary.hpp>
#include <thermopower/io/sentences.hpp>
#include <thermopower/plant/variable_words.hpp>
#include <thermopower/plant/calibration_id.hpp>
#include <thermopower/plant/curve_id.hpp>

#include "html_text.hpp"
#include "wrapped.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace thermopower::io {
namespace {

std::string line(const std::string& label, const std::string& text) {
  std::string head = "  " + label;
  head.resize(14, ' ');
  return head + wrapped(text, 14) + "\n";
}

// As the terminal writes it: `ohm`, not a sign.
std::string plain_unit(const std::string& number, const std::string& unit) {
  return unit == "1" || unit.empty() ? number : number + " " + unit;
}

const char* headline(Verdict verdict) {
  switch (verdict) {
    case Verdict::no_gap:
      return "NO GAP";
    case Verdict::explained:
      return "EXPLAINED";
    case Verdict::partial:
      return "PARTLY EXPLAINED";
    case Verdict::ambiguous:
      return "AMBIGUOUS";
    case Verdict::unexplained:
      return "UNEXPLAINED";
    case Verdict::insufficient:
      return "INSUFFICIENT DATA";
  }
  return "";
}

std::string occurrences_text(const std::vector<Occurrence>& list) {
  std::string out;
  for (const auto& one : list) {
    out += (out.empty() ? "" : ", ") + one.recording;
    if (!one.run.empty()) out += " run " + one.run;
    if (one.held_out) out += " (held out)";
    if (one.from_s) out += " from " + readable(*one.from_s) + " s on";
  }
  return out;
}

std::string regime_text(const Regime& regime) {
  const plant::VariableWords* const words = plant::words_of(regime.variable);
  return plant::in_words(regime.variable) + " " +
         plain_unit(range_text(regime.from, regime.to), words != nullptr ? words->unit : "");
}

std::string shrunk_text(const GapScore& gap) {
  const PercentTexts texts = percent_texts(gap.shrunk_by, gap.ci95);
  return texts.value + " % " + texts.interval;
}

std::string gap_table(const Diagnosis& diagnosis) {
  if (diagnosis.gap.empty()) return {};
  char row[200];
  std::snprintf(row, sizeof row, "\n  %-24s%13s%14s%13s%13s   %s\n", "RMSE, held out", "as configured",
                "recalibrated", "with effect", "noise floor", "shrunk by [95 %]");
  std::string out = row;
  for (const auto& gap : diagnosis.gap) {
    std::string shrunk = diagnosis.cause.empty() ? "-" : shrunk_text(gap);
    std::snprintf(row, sizeof row, "  %-24s%13s%14s%13s%13s   ",
                  (plant::in_words(to_string(gap.signal)) + " / " + gap.unit).c_str(),
                  readable(gap.before).c_str(), readable(gap.recalibrated).c_str(),
                  diagnosis.cause.empty() ? "-" : readable(gap.after).c_str(),
                  readable(gap.noise_floor).c_str());
    out += row + shrunk + "\n";
  }
  return out;
}

/// The parameters of a cause with their intervals.
std::string sizes_of(const std::vector<ParameterEstimate>& parameters) {
  std::string text;
  for (const ParameterEstimate& parameter : parameters)
    text += (text.empty() ? ": " : ", ") + parameter.name + " " +
            plain_unit(readable(parameter.value), parameter.unit) + " " + known_to(parameter);
  return text;
}

/// The first and the last value of a curve: ten values with their intervals are for the page and the report.
std::string ends_of_curve(const std::vector<ParameterEstimate>& values) {
  if (values.empty()) return "";
  const auto end = [](const ParameterEstimate& one) {
    return plain_unit(readable(one.value), one.unit) + " " + known_to(one);
  };
  return ": " + end(values.front()) + " at the low end of the range seen, " + end(values.back()) +
         " at the high end";
}

}  // namespace

std::string summary(const Diagnosis& diagnosis, const std::vector<EffectInfo>& effects) {
  std::string out = std::string(headline(diagnosis.verdict)) + "\n";
  const std::string words = joined(sentences(diagnosis, effects), " ");
  if (!words.empty()) out += line("", words);
  if (!diagnosis.reason.empty()) out += line("why", diagnosis.reason);
  out += findings_text(diagnosis.findings, Severity::warning);
  // Constants within what is known of them may take away what the model as configured shows.
  const std::string difference = diagnosis.verdict == Verdict::no_gap ? "difference as configured" : "gap";
  bool first = true;
  for (const auto& where : diagnosis.where) {
    std::string text = plant::in_words(to_string(where.signal)) + ", " + to_string(where.submodel) + " (" +
                       (takes_gap_away(where) ? percent_text(where.share) + " of the " + difference
                                              : "no one place takes the " + difference + " away") +
                       ")";
    if (where.regime) text += ", most for " + regime_text(*where.regime);
    if (!where.only_in.empty()) text += "; only in " + occurrences_text(where.only_in);
    out += line(first ? "where" : "", text);
    first = false;
  }
  first = true;
  for (const auto& cause : diagnosis.cause) {
    out += line(first ? "which" : "", cause.effect + " (" + percent_text(cause.probability) + ")" +
                                          (plant::is_curve(cause.effect) ? ends_of_curve(cause.parameters)
                                                                         : sizes_of(cause.parameters)));
    first = false;
  }
  for (const auto& constant : diagnosis.constants) {
    const std::string as = plant::calibration_id(constant.name);
    const bool is_cause = std::any_of(diagnosis.cause.begin(), diagnosis.cause.end(),
                                      [&](const Cause& cause) { return cause.effect == as; });
    if (!is_cause && (!constant.within_known || constant.on_bound))
      out += line("with", constant.name + " " + readable(constant.configured) + " -> " +
                              readable(constant.fitted) + " (known to " +
                              (constant.is_place ? readable(constant.uncertainty) + " rad"
                                                 : percent_text(constant.uncertainty)) +
                              (constant.on_bound ? "; as far as a fit may move it)" : ")"));
  }
  if (diagnosis.remaining) {
    const Remaining& rest = *diagnosis.remaining;
    std::string text = plant::in_words(to_string(rest.signal)) + " stays at " +
                       readable(rest.times_floor, 3) + " times its noise floor, " + percent_text(rest.share) +
                       " of the gap";
    if (rest.submodel) text += std::string("; ") + to_string(*rest.submodel);
    if (rest.regime) text += ", most for " + regime_text(*rest.regime);
    if (!rest.looks.empty()) text += "; " + rest.looks;
    out += line("remaining", text);
  }
  std::string others;
  for (const auto& one : diagnosis.alternatives) others += (others.empty() ? "" : "; ") + joined(one);
  if (!others.empty()) out += line("or", others + " (this recording cannot tell them apart)");
  out += gap_table(diagnosis);
  if (!diagnosis.next_experiment.empty() || !diagnosis.not_judged.empty()) out += "\n";
  if (!diagnosis.recalibration.empty()) out += line("constants", diagnosis.recalibration);
  if (!diagnosis.next_experiment.empty()) out += line("next", diagnosis.next_experiment);
  for (const auto& one : diagnosis.not_judged) out += line("not judged", one);
  return out;
}

namespace {

// What Markdown takes for its own is said to be text.
std::string markdown(const std::string& text) {
  std::string out;
  for (const char one : text) {
    if (one == '|' || one == '*' || one == '_' || one == '<' || one == '`' || one == '[' || one == '\\')
      out += '\\';
    out += one == '\n' ? ' ' : one;
  }
  return out;
}

std::string item(const std::string& label, const std::string& text) {
  return "- **" + label + ":** " + text + "\n";
}

}  // namespace

std::string summary_markdown(const Diagnosis& diagnosis, const std::string& model_name,
                             const std::vector<EffectInfo>& effects, const Provenance& made_of) {
  std::string out = "### Sim-to-real gap" + (model_name.empty() ? "" : " of " + markdown(model_name)) + ": " +
                    headline(diagnosis.verdict) + "\n\n";
  for (const std::string& one : sentences(diagnosis, effects)) out += markdown(one) + "\n";
  const bool has_cause = !diagnosis.cause.empty();
  if (!diagnosis.gap.empty()) {
    out += std::string("\n| RMSE, held out | as configured | constants refitted |") +
           (has_cause ? " with the effect |" : "") + " noise floor |" +
           (has_cause ? " shrunk by [95 %] |" : "") + "\n|---|---:|---:|" +
           (has_cause ? "---:|---:|---:|" : "---:|") + "\n";
    for (const GapScore& gap : diagnosis.gap)
      out += "| " + markdown(plant::in_words(to_string(gap.signal)) + " / " + gap.unit) + " | " +
             readable(gap.before) + " | " + readable(gap.recalibrated) + " | " +
             (has_cause ? readable(gap.after) + " | " : "") + readable(gap.noise_floor) + " |" +
             (has_cause ? " " + shrunk_text(gap) + " |" : "") + "\n";
  }
  out += "\n";
  for (const Cause& cause : diagnosis.cause)
    out += item("Which", "`" + cause.effect + "`, probability " + percent_text(cause.probability));
  for (const std::vector<std::string>& one : diagnosis.alternatives)
    out += item("Or", "`" + joined(one) + "`");
  for (const Location& where : diagnosis.where)
    out += item("Where", markdown(plant::in_words(to_string(where.signal))) + ", `" +
                             to_string(where.submodel) + "`" +
                             (takes_gap_away(where) ? ", " + percent_text(where.share) + " of the gap" : ""));
  std::vector<std::string> told;
  for (const Finding& one : diagnosis.findings) {
    if (one.severity < Severity::warning) continue;
    const std::string text = (one.column.empty() ? "" : "`" + one.column + "` ") + markdown(one.message) +
                             (one.mend.empty() ? "" : ". To mend it: `" + one.mend + "`");
    if (std::find(told.begin(), told.end(), text) != told.end()) continue;
    told.push_back(text);
    out += item("Data", text);
  }
  if (!diagnosis.reason.empty()) out += item("Why", markdown(diagnosis.reason));
  if (!diagnosis.next_experiment.empty()) out += item("Next", markdown(diagnosis.next_experiment));
  if (const std::string from = provenance_line(made_of); !from.empty()) out += "\n" + markdown(from) + "\n";
  return out;
}

std::string summary_line(const std::string& label, const std::string& text) { return line(label, text); }

std::string findings_text(const std::vector<Finding>& findings, Severity least) {
  std::string out;
  bool counts_rows = false;
  std::vector<std::string> told;  // the same fault in several recordings is told once
  for (const auto& finding : findings) {
    if (finding.severity < least) continue;
    if (std::find(told.begin(), told.end(), finding.column + finding.message) != told.end()) continue;
    told.push_back(finding.column + finding.message);
    std::string text = finding.recording + (finding.column.empty() ? "" : ", column " + finding.column) +
                       ": " + finding.message;
    if (finding.action != FindingAction::none) text += std::string(" [") + to_string(finding.action) + "]";
    if (!finding.mend.empty()) text = ended(text) + " To mend it: " + finding.mend;
    out += line(finding.severity == Severity::note ? "note" : "data", text);
    counts_rows = counts_rows || !finding.rows.empty();
  }
  if (counts_rows)
    out += line(
        "rows",
        "are counted from 0 below the header: in a CSV file without comments and blank lines, row 0 is line 2");
  return out;
}

std::string one_sentence(const Diagnosis& diagnosis) {
  std::string out = std::string("verdict ") + to_string(diagnosis.verdict);
  for (const auto& cause : diagnosis.cause)
    out += (&cause == &diagnosis.cause.front() ? ", " : " + ") + cause.effect;
  return out;
}

std::string catalogue_text(const std::vector<EffectInfo>& effects) {
  std::string out;
  for (const auto& effect : effects) {
    out += effect.id + "  (" + to_string(effect.submodel) + ")\n";
    out += "    " + wrapped(effect.prose, 4) + "\n";
    if (!effect.equation.empty()) out += "    equation    " + wrapped(effect.equation, 16) + "\n";
    bool first = true;
    for (const auto& parameter : effect.parameters) {
      out += std::string(first ? "    parameters  " : "                ") + parameter.name + " in " +
             (parameter.unit == "1" ? "1" : parameter.unit) + ", " + readable(parameter.lower) + " to " +
             readable(parameter.upper) +
             (parameter.standard ? ", " + readable(*parameter.standard) + " where left out" : std::string()) +
             "\n";
      first = false;
    }
    std::string needs;
    for (const Need need : effect.needs) needs += std::string(needs.empty() ? "" : ", ") + to_string(need);
    if (!needs.empty()) out += "    needs       " + wrapped(needs, 16) + "\n";
    out += "\n";
  }
  out +=
      "calibration.<constant>\n    a constant of the model itself is off by more than two of its uncertainties: resistance, tempco,\n"
      "    base, slope, heat_capacity, conductance, rinv, cooling, inertia, viscous, torque_constant, or\n"
      "    <effect>.<parameter> of an effect in the model; as a factor on the configured value.\n";
  return out;
}

}  // namespace thermopower::io
