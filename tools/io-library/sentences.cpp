// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/sentences.hpp>

#include "html_text.hpp"

#include <thermopower/plant/calibration_id.hpp>
#include <thermopower/plant/curve_id.hpp>
#include <thermopower/plant/standard_catalogue.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <utility>

namespace thermopower::io {
namespace {

// More numbers than these belong into a table.
constexpr std::size_t most_parameters = 4, most_alternatives = 3, most_signals = 3;
// A share of an error that nobody would miss.
constexpr double hardly_anything = 0.005;

using IdAndWords = std::pair<const char*, const char*>;

template <std::size_t N>
const char* word_for(const std::array<IdAndWords, N>& list, const std::string& key) {
  for (const IdAndWords& one : list)
    if (key == one.first) return one.second;
  return nullptr;
}

// Constants that a fit may move, by the id that follows `calibration.`.
constexpr std::array<IdAndWords, 16> constants = {{{"resistance", "winding's resistance"},
                                                   {"tempco", "winding's temperature coefficient"},
                                                   {"base", "current law's base"},
                                                   {"slope", "current law's slope"},
                                                   {"heat_capacity", "heat capacity"},
                                                   {"conductance", "thermal conductance to the air"},
                                                   {"rinv", "heating law's factor"},
                                                   {"cooling", "cooling rate"},
                                                   {"inertia", "inertia"},
                                                   {"viscous", "viscous friction"},
                                                   {"torque_constant", "torque constant"},
                                                   {"motor_resistance", "motor's resistance"},
                                                   {"kp", "servo's proportional gain"},
                                                   {"kd", "servo's damping gain"},
                                                   {"ki", "servo's integral gain"},
                                                   {"body_heat_capacity", "body's heat capacity"}}};

constexpr std::array<IdAndWords, 12> parts = {{{"electrical", "electrical circuit"},
                                               {"thermal.heating", "heating"},
                                               {"thermal.storage", "heat storage"},
                                               {"thermal.loss", "heat loss"},
                                               {"mechanical.drive", "drive"},
                                               {"mechanical.friction", "friction"},
                                               {"mechanical.load", "load"},
                                               {"mechanical.structure", "inertia and structure"},
                                               {"sensing.current", "current sensor"},
                                               {"sensing.temperature", "thermometer"},
                                               {"sensing.angle", "angle sensor"},
                                               {"sensing.rate", "rate sensor"}}};

std::string spaced(std::string id) {
  std::replace(id.begin(), id.end(), '_', ' ');
  return id;
}

std::string with_plain_unit(const std::string& number, const std::string& unit) {
  return unit.empty() || unit == "1" ? number : number + " " + unit;
}

// "lag" of `lag_s` in s, nothing of `Nm` in N m: the unit stands behind the number.
std::string name_without_unit(const std::string& name, const std::string& unit) {
  std::string ending;
  for (const char one : unit) {
    if (one == '/') ending += ending.empty() || ending == "1" ? "per_" : "_per_";
    else if (one != ' ' && one != '^') ending += one;
  }
  if (ending.compare(0, 5, "1per_") == 0) ending.erase(0, 1);
  if (ending.compare(0, 5, "1_per") == 0) ending.erase(0, 2);
  std::string spread = unit;
  std::replace(spread.begin(), spread.end(), ' ', '_');
  spread.erase(std::remove(spread.begin(), spread.end(), '^'), spread.end());
  if (const std::size_t slash = spread.find('/'); slash != std::string::npos)
    spread.replace(slash, 1, "_per_");
  for (const std::string& one : {ending, spread, std::string(unit == "deg/s" ? "dps" : "")}) {
    if (one.empty() || one == "1") continue;
    if (name == one) return {};
    if (name.size() > one.size() + 1 && name.compare(name.size() - one.size(), one.size(), one) == 0 &&
        name[name.size() - one.size() - 1] == '_')
      return spaced(name.substr(0, name.size() - one.size() - 1));
  }
  return spaced(name);
}

const EffectInfo* info_of(const std::string& id, const std::vector<EffectInfo>& effects) {
  for (const EffectInfo& one : effects)
    if (one.id == id) return &one;
  static const std::vector<EffectInfo> standard = plant::standard_catalogue().list();
  for (const EffectInfo& one : standard)
    if (one.id == id) return &one;
  return nullptr;
}

// Where its first thought ends: before the first stop that stands in no brackets.
std::size_t end_of_first_clause(const std::string& prose) {
  int depth = 0;
  for (std::size_t i = 0; i < prose.size(); ++i) {
    const char one = prose[i];
    if (one == '(') ++depth;
    else if (one == ')') --depth;
    else if (depth == 0 && (one == ';' || one == ':' || (one == '.' && i + 1 == prose.size()))) return i;
  }
  return prose.size();
}

std::string parameters_in_words(const Cause& cause) {
  std::string list;
  if (plant::is_curve(cause.effect) || cause.parameters.size() > most_parameters) return list;
  // The numbers that the data tell, where they tell any; all of them stand under `which`.
  const bool tells = std::any_of(cause.parameters.begin(), cause.parameters.end(),
                                 [](const ParameterEstimate& one) { return one.told; });
  std::vector<ParameterEstimate> shown;
  for (const ParameterEstimate& one : cause.parameters)
    if (!(one.value == 0.0 && one.at_bound) && one.told == tells) shown.push_back(one);
  if (shown.size() == 1 && shown.front().unit != "1") shown.front().name.clear();
  for (const ParameterEstimate& one : shown) list += (list.empty() ? "" : ", ") + in_people_units(one);
  return list;
}

std::string cause_sentence(const Cause& cause, const std::vector<EffectInfo>& effects) {
  if (plant::is_calibration(cause.effect)) {
    const std::string id = cause.effect.substr(sizeof plant::calibration_prefix - 1);
    const char* const word = word_for(constants, id);
    const std::string the = "The " + (word != nullptr ? std::string(word) : "constant " + id);
    if (cause.parameters.empty()) return the + " is not what the model says.";
    const ParameterEstimate& move = cause.parameters.front();
    const std::string interval = move.told ? " " + known_to(move) : "";
    if (move.unit == "rad")
      return the + " is elsewhere: by " + readable(move.value) + " rad" + interval + ".";
    return the + " is not what the model says: the recording asks for " + readable(move.value) +
           " times that" + interval + ".";
  }
  const EffectInfo* const info = info_of(cause.effect, effects);
  std::string text =
      info != nullptr && !info->prose.empty() ? info->prose : effect_in_words(cause.effect) + ".";
  text = capital(text);
  if (text.back() != '.') text += '.';
  const std::string numbers = parameters_in_words(cause);
  if (numbers.empty()) return text;
  const std::size_t at = end_of_first_clause(text);
  if (at > 0 && text[at - 1] == ')') return text.insert(at - 1, "; " + numbers);
  return text.insert(at, " (" + numbers + ")");
}

// "current" of the motor current: the motor is no news.
std::string error_of(const plant::SignalName& signal) {
  const std::string words = plant::in_words(to_string(signal));
  return (words.compare(0, 6, "motor ") == 0 ? words.substr(6) : words) + " error";
}

std::string listed(const std::vector<std::string>& parts_of_it) {
  std::string out;
  for (std::size_t i = 0; i < parts_of_it.size(); ++i)
    out += (i == 0 ? "" : i + 1 == parts_of_it.size() ? " and " : ", ") + parts_of_it[i];
  return out;
}

std::string removal(const Diagnosis& diagnosis) {
  std::vector<std::string> removed, grown;
  for (const GapScore& one : diagnosis.gap) {
    if (one.shrunk_by >= hardly_anything)
      removed.push_back(percent_text(one.shrunk_by) + " of the " + error_of(one.signal));
    else if (one.shrunk_by <= -hardly_anything)
      grown.push_back("the " + error_of(one.signal) + " by " + percent_text(-one.shrunk_by));
  }
  const bool constants_alone =
      std::all_of(diagnosis.cause.begin(), diagnosis.cause.end(),
                  [](const Cause& one) { return plant::is_calibration(one.effect); });
  const std::string doing =
      std::string(constants_alone ? "Correcting " : "Adding ") + (diagnosis.cause.size() > 1 ? "them" : "it");
  std::string text;
  if (!removed.empty()) text = doing + " removes " + listed(removed);
  if (!grown.empty()) text += (text.empty() ? doing : " and") + std::string(" raises ") + listed(grown);
  if (text.empty()) return {};
  return text + (diagnosis.verdict == Verdict::explained ? "; the rest is what noise makes." : ".");
}

std::string alternatives(const Diagnosis& diagnosis, const std::vector<EffectInfo>& effects) {
  if (diagnosis.alternatives.empty()) return {};
  std::string text;
  std::size_t told = 0;
  for (const std::vector<std::string>& ids : diagnosis.alternatives) {
    if (told == most_alternatives) break;
    std::string one;
    for (const std::string& id : ids) one += (one.empty() ? "" : " with ") + effect_in_words(id);
    if (ids.size() == 1)
      if (const EffectInfo* const info = info_of(ids.front(), effects);
          info != nullptr && !info->prose.empty()) {
        std::string clause = info->prose.substr(0, end_of_first_clause(info->prose));
        clause[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(clause[0])));
        if (clause.find('(') == std::string::npos) one += " (" + clause + ")";
      }
    text += (text.empty() ? "" : ", or ") + one;
    ++told;
  }
  const std::size_t more = diagnosis.alternatives.size() - told;
  if (more > 0) text += ", or " + std::to_string(more) + " more";
  return "On these data it could as well be " + text + ".";
}

const GapScore* largest(const Diagnosis& diagnosis) {
  const GapScore* most = nullptr;
  const auto size = [](const GapScore& one) {
    return one.noise_floor > 0.0 ? one.before / one.noise_floor : one.before;
  };
  for (const GapScore& one : diagnosis.gap)
    if (most == nullptr || size(one) > size(*most)) most = &one;
  return most;
}

std::string agreement(const Diagnosis& diagnosis) {
  const bool refitted = diagnosis.why == Reason::constants_within_known;
  std::vector<std::string> list;
  for (const GapScore& one : diagnosis.gap) {
    if (list.size() == most_signals) break;
    list.push_back(plant::the_variable(to_string(one.signal)) + " to " +
                   with_plain_unit(readable(refitted ? one.recalibrated : one.before), one.unit) +
                   " (noise makes " + readable(one.noise_floor) + ")");
  }
  if (list.empty()) return {};
  return std::string(refitted ? "With constants within what is known of them the simulation predicts "
                              : "The simulation as configured predicts ") +
         listed(list) + ".";
}

}  // namespace

std::string effect_in_words(const std::string& effect) {
  if (plant::is_curve(effect)) {  // unknown.<balance>(<variable>)
    const std::size_t opens = effect.find('('), begins = plant::curve_prefix.size();
    if (opens == std::string::npos || effect.back() != ')') return effect;
    const std::string variable = effect.substr(opens + 1, effect.size() - opens - 2);
    return "an unknown " + effect.substr(begins, opens - begins) + " that follows " +
           plant::the_variable(variable);
  }
  if (!plant::is_calibration(effect)) return spaced(effect);
  const std::string id = effect.substr(sizeof plant::calibration_prefix - 1);
  const char* const word = word_for(constants, id);
  return word != nullptr ? std::string("another ") + word : "another value of " + id;
}

std::string part_in_words(const std::string& submodel) {
  const char* const word = word_for(parts, submodel);
  return word != nullptr ? word : submodel;
}

std::string in_people_units(const ParameterEstimate& parameter) {
  const bool per_kelvin = parameter.unit == "1/K";
  const double factor = per_kelvin ? 100.0 : 1.0;
  const std::string unit = per_kelvin ? "% per K" : parameter.unit;
  const std::string name = name_without_unit(parameter.name, parameter.unit);
  std::string text = name.empty() ? "" : name + " ";
  text += with_plain_unit(readable(factor * parameter.value), unit);
  if (!parameter.told) return text + ", which these data do not tell";
  text += " " + interval_text(factor * parameter.ci95.low, factor * parameter.ci95.high);
  if (parameter.at_bound) text += " (on its bound)";
  return text;
}

std::vector<std::string> sentences(const Diagnosis& diagnosis, const std::vector<EffectInfo>& effects) {
  std::vector<std::string> list;
  const auto add = [&list](const std::string& text) {
    if (!text.empty()) list.push_back(text);
  };
  switch (diagnosis.verdict) {
    case Verdict::explained:
    case Verdict::partial:
    case Verdict::ambiguous:
      for (const Cause& cause : diagnosis.cause) add(cause_sentence(cause, effects));
      add(removal(diagnosis));
      add(alternatives(diagnosis, effects));
      if (diagnosis.remaining)
        add("A rest stays: the error of " + plant::the_variable(to_string(diagnosis.remaining->signal)) +
            " is " + readable(diagnosis.remaining->times_floor) + " times what noise makes.");
      break;
    case Verdict::no_gap:
      add(agreement(diagnosis));
      break;
    case Verdict::unexplained:
      if (const GapScore* const most = largest(diagnosis)) {
        const bool better = most->recalibrated < (1.0 - hardly_anything) * most->before;
        add("The simulation as configured is off by " + with_plain_unit(readable(most->before), most->unit) +
            " in " + plant::the_variable(to_string(most->signal)) + " (RMS), where noise makes " +
            readable(most->noise_floor) + ".");
        if (better)
          add("Refitted constants bring that down to " +
              with_plain_unit(readable(most->recalibrated), most->unit) +
              "; no effect of the catalogue is shown to take the rest away.");
        else add("Neither other constants nor an effect of the catalogue is shown to take that away.");
      }
      break;
    case Verdict::insufficient:
      if (const Finding* const one = deciding(diagnosis.findings))
        add(ended(capital(one->column.empty() ? one->message : one->column + " " + one->message)));
      else if (!diagnosis.reason.empty()) add(ended(capital(diagnosis.reason)));
      break;
  }
  return list;
}

}  // namespace thermopower::io
