// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/remedy.hpp>

#include <thermopower/io/input_error.hpp>

#include "column_proposal.hpp"
#include "log_text.hpp"
#include "shell_words.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

namespace thermopower::io {
namespace {

const ColumnChoice* find(const std::vector<ColumnChoice>& choices, const std::string& name) {
  const auto found =
      std::find_if(choices.begin(), choices.end(), [&](const ColumnChoice& one) { return one.name == name; });
  return found == choices.end() ? nullptr : &*found;
}

// The unit whose factor is 1 and whose need is that of a choice.
std::string plain_unit(const std::string& name, ColumnChoice::Needs needs) {
  for (const std::string& unit : units_of(name)) {
    const ColumnChoice one = parse_column_choice(name + "=x:" + unit);
    if (one.needs == needs && one.factor == 1.0 && one.offset == 0.0) return unit;
  }
  return {};
}

// Two conversions, one after the other, as one.
ColumnChoice after(const ColumnChoice& first, const ColumnChoice& asked) {
  ColumnChoice result = asked;
  result.header = first.header;
  const bool first_is_plain = first.factor == 1.0 && first.offset == 0.0 && first.sign_bit == 0 &&
                              first.needs == ColumnChoice::Needs::nothing;
  if (first_is_plain) return result;
  if (asked.unit.empty() && asked.name == first.name) return first;
  const double factor = first.factor * asked.factor;
  const std::string unit = plain_unit(asked.name, first.needs);
  if (first.offset != 0.0 || asked.offset != 0.0 || unit.empty()) {
    // A temperature that is converted twice has no unit of its own; the second reading is what is asked for.
    return result;
  }
  const double size = std::fabs(factor);
  for (const std::string& named : units_of(asked.name)) {
    ColumnChoice exact = result;
    exact.unit = (factor < 0.0 ? "-" : "") + named;
    if (first.sign_bit > 0) exact.unit += ",sign" + std::to_string(first.sign_bit);
    const ColumnChoice one = parse_column_choice(choice_text(exact));
    if (one.needs == first.needs && one.offset == 0.0 &&
        std::fabs(std::fabs(one.factor) / size - 1.0) < 1e-12)
      return one;
  }
  result.unit = (factor < 0.0 ? "-" : "") + unit + (size == 1.0 ? "" : "*" + csv_number(size)) +
                (first.sign_bit > 0 ? ",sign" + std::to_string(first.sign_bit) : "");
  return parse_column_choice(choice_text(result));
}

/// One option: `--column` and its value, or nothing where it takes none.
struct Option {
  std::string name, value;
};

/// Options that follow each other in a text, and where they stand.
struct OptionRun {
  std::vector<Option> options;
  std::size_t begin = 0, end = 0;
};

bool takes_value(const std::string& name) {
  return name == "--column" || name == "--ambient" || name == "--supply" || name == "--constant" ||
         name == "--rate" || name == "--horizon";
}

// A word of a sentence as a shell reads it; what ends a clause is not part of it.
std::string word_at(const std::string& text, std::size_t& at) {
  std::string word = shell_word(text, at, " );");
  if (!word.empty() && word.back() == ',' && text[at - 1] == ',') word.pop_back(), --at;
  return word;
}

// The next options of a text, from a place on.
std::optional<OptionRun> next_options(const std::string& text, std::size_t from) {
  OptionRun run;
  std::size_t at = text.find("--", from);
  if (at == std::string::npos) return std::nullopt;
  run.begin = run.end = at;
  while (text.compare(at, 2, "--") == 0) {
    Option option;
    option.name = word_at(text, at);
    if (takes_value(option.name) && at < text.size() && text[at] == ' ') {
      std::size_t after = at + 1;
      const std::string value = word_at(text, after);
      // "at what --column makes of it" has none.
      if (value.find_first_of("=0123456789") != std::string::npos) option.value = value, at = after;
    }
    run.options.push_back(option);
    run.end = at;
    if (at >= text.size() || text[at] != ' ') break;
    ++at;
  }
  return run;
}

// A number that somebody typed, in another unit.
std::string typed_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

Option as_constant(const std::string& name, double value) {
  if (name == "ambient_C") return {"--ambient", typed_number(value)};
  if (name == "supply_V") return {"--supply", typed_number(value)};
  return {"--constant", name + "=" + typed_number(value)};
}

const double* constant_in(const ReadOptions& in_force, const std::string& name) {
  for (const auto& [other, value] : in_force.constants)
    if (other == name) return &value;
  return nullptr;
}

// One option of a remedy by the files' names. @param said  receives the names of the format that it settles
Option in_the_files_words(const Option& option, const ReadOptions& in_force, std::vector<std::string>& said) {
  if (option.name != "--column") return option;
  ColumnChoice asked;
  try {
    asked = parse_column_choice(option.value);
  } catch (const InputError&) {
    return option;  // words for a person: NAME=HEADER
  }
  said.push_back(asked.name);
  if (const ColumnChoice* const first = find(in_force.choices, asked.header)) {
    asked = after(*first, asked);
  } else if (const double* const value = constant_in(in_force, asked.header)) {
    return as_constant(asked.name, value_of(asked, *value));
  } else if (asked.header == "t_s" && asked.name == "t_s" && in_force.rows_per_s > 0.0) {
    return {"--rate", typed_number(in_force.rows_per_s / asked.factor)};
  }
  return {option.name, choice_text(asked)};
}

// The options with which the data were read, but for names that a remedy settles.
std::vector<Option> rest_of(const ReadOptions& in_force, const std::vector<std::string>& said) {
  const auto is_said = [&](const std::string& name) {
    return std::find(said.begin(), said.end(), name) != said.end();
  };
  std::vector<Option> rest;
  for (const ColumnChoice& one : in_force.choices)
    if (!is_said(one.name)) rest.push_back({"--column", choice_text(one)});
  for (const auto& [name, value] : in_force.constants)
    if (!is_said(name)) rest.push_back(as_constant(name, value));
  if (in_force.rows_per_s > 0.0 && !is_said("t_s"))
    rest.push_back({"--rate", typed_number(in_force.rows_per_s)});
  return rest;
}

std::string for_shell(const std::vector<Option>& options) {
  std::string text;
  for (const Option& one : options)
    text +=
        (text.empty() ? "" : " ") + one.name + (one.value.empty() ? "" : " " + quoted_for_shell(one.value));
  return text;
}

std::string python_string(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\\' || c == '\'' ? std::string("\\") + c : std::string(1, c);
  return out + "'";
}

std::string for_python(const std::vector<Option>& options) {
  std::string columns, constants, others;
  const auto list = [](std::string& of, const std::string& one) { of += (of.empty() ? "" : ", ") + one; };
  for (const Option& one : options) {
    if (one.name == "--column" && one.value.empty()) list(others, "columns");
    else if (one.name == "--column") list(columns, python_string(one.value));
    else if (one.name == "--ambient") list(constants, "'ambient_C': " + one.value);
    else if (one.name == "--supply") list(constants, "'supply_V': " + one.value);
    else if (one.name == "--constant")
      list(constants, python_string(one.value.substr(0, one.value.find('='))) + ": " +
                          one.value.substr(one.value.find('=') + 1));
    else if (one.name == "--rate") list(others, "rows_per_s=" + one.value);
    else if (one.name == "--horizon") list(others, "horizon_s=" + one.value);
    else if (one.name == "--as-recorded") list(others, "as_recorded=True");
    else if (one.name == "--heldout") list(others, "held_out");
    else list(others, one.name + (one.value.empty() ? "" : " " + one.value));
  }
  std::string text;
  if (!columns.empty()) list(text, "columns=[" + columns + "]");
  if (!constants.empty()) list(text, "constants={" + constants + "}");
  if (!others.empty()) list(text, others);
  return text;
}

// Words that name the program by its subcommands.
std::string words_for_python(std::string text) {
  for (const auto& [program, python] :
       {std::pair<std::string, std::string>{"'thermopower-gap columns FILE'", "thermopower.columns(path)"},
        {"proposes options ", "proposes "}})
    if (const std::size_t at = text.find(program); at != std::string::npos)
      text.replace(at, program.size(), python);
  return text;
}

}  // namespace

std::string choice_text(const ColumnChoice& choice) {
  std::string unit = choice.unit;
  // A header with a colon in it needs a unit after it, or the colon would begin one.
  if (unit.empty() && choice.header.find(':') != std::string::npos)
    if (const std::vector<std::string> units = units_of(choice.name); !units.empty()) unit = units.front();
  return choice.name + "=" + choice.header + (unit.empty() ? "" : ":" + unit);
}

std::string remedy_in_force(const std::string& mend, const ReadOptions& in_force, Caller caller) {
  const bool python = caller == Caller::python;
  std::string out;
  std::size_t last_end = 0;
  const auto take_words = [&](std::size_t begin, std::size_t end) {
    const std::string words = mend.substr(begin, end - begin);
    out += python ? words_for_python(words) : words;
  };
  while (const std::optional<OptionRun> run = next_options(mend, last_end)) {
    take_words(last_end, run->begin);
    last_end = run->end;
    std::vector<std::string> said;
    std::vector<Option> options;
    for (const Option& one : run->options) options.push_back(in_the_files_words(one, in_force, said));
    // Python's arguments are given once: they hold what is in force wherever they stand.
    const bool only_options = run->begin == 0 && run->end == mend.size();
    if (!said.empty() && (only_options || python))
      for (const Option& one : rest_of(in_force, said)) options.push_back(one);
    out += python ? for_python(options) : for_shell(options);
  }
  take_words(last_end, mend.size());
  return out;
}

void put_remedies_in_force(gap::Diagnosis& diagnosis, const ReadOptions& in_force, Caller caller) {
  for (Finding& one : diagnosis.findings) one.mend = remedy_in_force(one.mend, in_force, caller);
  diagnosis.next_experiment = remedy_in_force(diagnosis.next_experiment, in_force, caller);
}

void put_remedies_in_force(gap::DataReport& report, const ReadOptions& in_force, Caller caller) {
  for (Finding& one : report.findings) one.mend = remedy_in_force(one.mend, in_force, caller);
  report.next_experiment = remedy_in_force(report.next_experiment, in_force, caller);
}

}  // namespace thermopower::io
