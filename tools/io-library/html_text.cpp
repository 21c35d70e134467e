// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "html_text.hpp"

#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace thermopower::io {
namespace {

// Length of the UTF-8 sequence at `i`; 0 where there is none. Neither longer than it need be, nor half a pair of
// UTF-16, nor above U+10FFFF (RFC 3629): browsers and JSON take none of these.
std::size_t sequence_at(const std::string& text, std::size_t i) {
  const auto byte_at = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char byte = byte_at(i);
  const std::size_t length = byte < 0x80                   ? 1
                             : byte >= 0xc2 && byte < 0xe0 ? 2
                             : byte >= 0xe0 && byte < 0xf0 ? 3
                             : byte >= 0xf0 && byte < 0xf5 ? 4
                                                           : 0;
  if (length == 1 && byte < 0x20 && byte != '\n' && byte != '\t') return 0;
  for (std::size_t k = 1; k < length; ++k)
    if (i + k >= text.size() || (byte_at(i + k) & 0xc0) != 0x80) return 0;
  if ((byte == 0xe0 && byte_at(i + 1) < 0xa0) || (byte == 0xed && byte_at(i + 1) >= 0xa0)) return 0;
  if ((byte == 0xf0 && byte_at(i + 1) < 0x90) || (byte == 0xf4 && byte_at(i + 1) >= 0x90)) return 0;
  return length;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  out.reserve(text.size() + 16);
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = sequence_at(text, i);
    if (length == 0) {
      out += "\uFFFD";
      ++i;
      continue;
    }
    if (length > 1) out.append(text, i, length);
    else if (text[i] == '&') out += "&amp;";
    else if (text[i] == '<') out += "&lt;";
    else if (text[i] == '>') out += "&gt;";
    else if (text[i] == '"') out += "&quot;";
    else out += text[i];
    i += length;
  }
  return out;
}

std::string breakable(const std::string& id) {
  std::string out;
  for (const char one : escaped(id)) {
    out += one;
    if (one == '_' || one == '/' || one == '.') out += "<wbr>";
  }
  return out;
}

std::string readable(double value, int digits) {
  if (!std::isfinite(value)) return "\u2013";
  const double size = std::fabs(value);
  char text[48];
  if (size != 0.0 && (size < 1e-3 || size >= 1e5)) {
    std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
  } else {
    int decimals = size == 0.0 ? 0 : std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(size))));
    // Rounded up to the next power of ten it has a digit more: 9.999 is 10.0.
    const double next = std::pow(10.0, digits - decimals);
    if (decimals > 0 && size + 0.5 * std::pow(10.0, -decimals) >= next) --decimals;
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
  }
  return text;
}

std::string known_to(const gap::ParameterEstimate& parameter) {
  if (!parameter.told) return "(not told by these data)";
  return interval_text(parameter.ci95.low, parameter.ci95.high) +
         (parameter.at_bound ? ", on its bound" : "");
}

std::string interval_text(double low, double high) {
  constexpr int least_digits = 3, most_digits = 7;
  int digits = least_digits;
  while (digits < most_digits && low != high && readable(low, digits) == readable(high, digits)) ++digits;
  return "[" + readable(low, digits) + ", " + readable(high, digits) + "]";
}

std::string range_text(double low, double high) {
  const std::string from = readable(low), to = readable(high);
  return from == to ? from : from + " to " + to;
}

std::string percent_text(double share) {
  if (!std::isfinite(share)) return "?";
  char text[16];
  if (share > 0.99 && share < 1.0) return ">99 %";
  std::snprintf(text, sizeof text, "%.0f %%", 100.0 * share);
  return text;
}

PercentTexts percent_texts(double share, const gap::Interval& interval) {
  if (!std::isfinite(share)) return {"?", "[?, ?]"};
  // A tenth of the interval is more than anybody needs, and two places after the point more than anything has.
  const double width = 100.0 * (interval.high - interval.low);
  const int places = width >= 2.0 || !(width > 0.0) ? 0 : width >= 0.2 ? 1 : 2;
  const auto text = [places](double value) {
    char digits[24];
    std::snprintf(digits, sizeof digits, "%.*f", places, 100.0 * value + 0.0);
    if (digits[0] == '-' && std::strtod(digits, nullptr) == 0.0) return std::string(digits + 1);
    return std::string(std::isfinite(value) ? digits : "\u2013");
  };
  return {text(share), "[" + text(interval.low) + ", " + text(interval.high) + "]"};
}

std::string with_signs(std::string text) {
  constexpr std::pair<const char*, const char*> signs[] = {{" degC", "\u00a0\u00b0C"},
                                                           {" ohm", "\u00a0\u03a9"},
                                                           {" deg/s", "\u00a0\u00b0/s"},
                                                           {" m^2", "\u00a0m\u00b2"},
                                                           {" rad/s2", "\u00a0rad/s\u00b2"}};
  for (const auto& [plain, sign] : signs) {
    const std::string from = plain;
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos;) {
      const std::size_t end = at + from.size();
      const bool ends = end == text.size() || std::isalnum(static_cast<unsigned char>(text[end])) == 0;
      // A unit follows a number or an interval.
      const bool begins =
          at > 0 && (std::isdigit(static_cast<unsigned char>(text[at - 1])) != 0 || text[at - 1] == ']');
      if (ends && begins) text.replace(at, from.size(), sign);
      at += ends && begins ? std::string(sign).size() : 1;
    }
  }
  return text;
}

std::string percent_html(double share) {
  if (!std::isfinite(share)) return "\u2013";
  if (share > 0.99 && share < 1.0) return "&gt;\u200a99\u00a0%";
  if (share > 0.0 && share < 0.01) return "&lt;\u200a1\u00a0%";
  char text[16];
  std::snprintf(text, sizeof text, "%.0f\u00a0%%", 100.0 * share);
  return text;
}

std::string unit_text(const std::string& unit) {
  if (unit == "degC") return "\u00b0C";
  if (unit == "deg") return "\u00b0";
  if (unit == "deg/s" || unit == "dps") return "\u00b0/s";
  if (unit == "rad/s2") return "rad/s\u00b2";
  if (unit == "ohm") return "\u03a9";
  if (unit == "1") return "";
  return unit;
}

std::string with_unit(const std::string& number, const std::string& unit) {
  const std::string text = escaped(unit_text(unit));
  return text.empty() ? number : number + "\u00a0" + text;
}

std::string signal_text(const plant::SignalName& signal) { return plant::in_words(to_string(signal)); }

VariableText variable_text(const std::string& name, const std::string& unit) {
  if (const plant::VariableWords* const words = plant::words_of(name))
    return {words->text, unit_text(words->unit)};
  return {name, unit_text(unit), false};
}

std::string axis_label(const VariableText& variable) {
  return variable.unit.empty() ? variable.text : variable.text + " / " + variable.unit;
}

std::string capital(std::string text) {
  // A name with an underscore stays as it is spelt.
  const bool is_name = text.substr(0, text.find(' ')).find('_') != std::string::npos;
  if (!is_name && !text.empty() && text[0] >= 'a' && text[0] <= 'z')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string ended(std::string text) {
  if (text.empty() || (text.back() != '.' && text.back() != '?')) text += '.';
  return text;
}

std::string joined(const std::vector<std::string>& ids, const char* between) {
  std::string out;
  for (const auto& id : ids) out += (out.empty() ? "" : between) + id;
  return out;
}

}  // namespace thermopower::io
