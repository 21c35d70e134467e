// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/remedy.hpp>

#include <thermopower/io/input_error.hpp>

#include "column_proposal.hpp"
#include "log_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace thermopower::io {
namespace {

const std::string option = "--column ";

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
  result.unit = (factor < 0.0 ? "-" : "") + unit + (size == 1.0 ? "" : "*" + csv_number(size)) +
                (first.sign_bit > 0 ? ",sign" + std::to_string(first.sign_bit) : "");
  return parse_column_choice(choice_text(result));
}

}  // namespace

std::string choice_text(const ColumnChoice& choice) {
  std::string unit = choice.unit;
  // A header with a colon in it needs a unit after it, or the colon would begin one.
  if (unit.empty() && choice.header.find(':') != std::string::npos)
    if (const std::vector<std::string> units = units_of(choice.name); !units.empty()) unit = units.front();
  return choice.name + "=" + choice.header + (unit.empty() ? "" : ":" + unit);
}

std::string remedy_in_force(const std::string& mend, const std::vector<ColumnChoice>& in_force) {
  if (in_force.empty() || mend.find(option) == std::string::npos) return mend;
  std::string out;
  std::vector<std::string> said;
  std::size_t last_end = 0;
  for (std::size_t at = mend.find(option); at != std::string::npos; at = mend.find(option, last_end)) {
    const std::size_t begin = at + option.size(),
                      end = std::min(mend.find_first_of(" );,", begin), mend.size());
    out += mend.substr(last_end, at - last_end);
    last_end = end;
    const std::string text = mend.substr(begin, end - begin);
    ColumnChoice asked;
    try {
      asked = parse_column_choice(text);
    } catch (const InputError&) {
      out += option + text;  // words for a person: NAME=HEADER
      continue;
    }
    said.push_back(asked.name);
    if (const ColumnChoice* const first = find(in_force, asked.header)) asked = after(*first, asked);
    out += option + quoted_for_shell(choice_text(asked));
  }
  // The rest of the choices stays in force, wherever the remedy is put.
  const bool only_options = mend.compare(0, option.size(), option) == 0;
  if (only_options)
    for (const ColumnChoice& one : in_force)
      if (std::find(said.begin(), said.end(), one.name) == said.end())
        out += " " + option + quoted_for_shell(choice_text(one));
  return out + mend.substr(last_end);
}

void put_remedies_in_force(std::vector<Finding>& findings, const std::vector<ColumnChoice>& in_force) {
  for (Finding& one : findings) one.mend = remedy_in_force(one.mend, in_force);
}

}  // namespace thermopower::io
