// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/plant/signal.hpp>
#include <thermopower/io/names.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief Text with `& < > "` escaped and bytes that are no UTF-8 replaced, for HTML and SVG.
std::string escaped(const std::string& text);

/// @brief escaped(), and a long id may break after its underscores, points and slashes.
std::string breakable(const std::string& id);

/// @brief A number for people: `digits` significant digits, no exponent between 0.001 and 99999, a dash for
/// NaN.
std::string readable(double value, int digits = 3);

/// @brief What the data say of a parameter beside its value: its interval, in brackets, or that they tell nothing.
std::string known_to(const gap::ParameterEstimate& parameter);

/// @brief An interval in brackets, with as many digits as tell its ends apart, three at least.
std::string interval_text(double low, double high);
/// A range of a variable, "12.0 to 40.0"; one number where both ends read alike.
std::string range_text(double low, double high);

/// @brief A share in per cent, plain text: "83 %", ">99 %".
std::string percent_text(double share);

/// @brief A share and its interval in per cent, all to the same place: "93 % [92, 95]", "0.4 % [0.2, 0.7]".
struct PercentTexts {
  std::string value;     ///< "93"
  std::string interval;  ///< "[92, 95]"
};

/// @brief A share and its interval as text, to the place that the interval's width asks for.
PercentTexts percent_texts(double share, const gap::Interval& interval);

/// @brief Text of a report with its ASCII units as people write them: `degC` as degrees Celsius, `ohm` as its sign.
std::string with_signs(std::string text);

/// @brief A share for people, such as "83 %", "> 99 %".
std::string percent_html(double share);

/// @brief A unit as people write it: `degC` as degrees Celsius, `1` as nothing.
std::string unit_text(const std::string& unit);

/// @brief A number and its unit with a space that does not break, as HTML: a unit may come from a file.
std::string with_unit(const std::string& number, const std::string& unit);

/// @brief A signal in words: "motor temperature".
std::string signal_text(const plant::SignalName& signal);

/// @brief A column or derived variable in words and its unit; `text` is its own name where nobody knows better.
struct VariableText {
  std::string text;      ///< "temperature above the air"
  std::string unit;      ///< as people write it; empty for a pure number
  bool in_words = true;  ///< false: `text` is the name as recorded
};

/// @brief The words for a variable. @param unit  stands in where the name tells none
VariableText variable_text(const std::string& name, const std::string& unit = {});

/// @brief "words / unit", for an axis of a chart.
std::string axis_label(const VariableText& variable);

/// @brief The first letter in upper case, where it is a letter of ASCII.
std::string capital(std::string text);
/// @brief The text with a full stop behind it, where it ends with none and with no question mark.
std::string ended(std::string text);

/// @brief Ids with something in between.
std::string joined(const std::vector<std::string>& ids, const char* between = " + ");

}  // namespace thermopower::io
