// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "plain_letters.hpp"
#include "unit_words.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace thermopower::io {
namespace {

struct Spelling {
  const char* text;  // small letters where the case does not matter
  Dimension dimension;
  const char* unit;         // as --column takes it
  bool exact_case = false;  // one letter says little: its case must be right
};

constexpr Spelling spellings[] = {
    {"s", Dimension::time, "s", true},
    {"sec", Dimension::time, "s"},
    {"secs", Dimension::time, "s"},
    {"second", Dimension::time, "s"},
    {"seconds", Dimension::time, "s"},
    {"sek", Dimension::time, "s"},
    {"ms", Dimension::time, "ms"},
    {"msec", Dimension::time, "ms"},
    {"millis", Dimension::time, "ms"},
    {"us", Dimension::time, "us"},
    {"usec", Dimension::time, "us"},
    {"micros", Dimension::time, "us"},
    {"ns", Dimension::time, "ns"},
    {"nsec", Dimension::time, "ns"},
    {"min", Dimension::time, "min"},
    {"h", Dimension::time, "h", true},
    {"C", Dimension::temperature, "C", true},
    {"degC", Dimension::temperature, "degC", true},
    {"degc", Dimension::temperature, "degC"},
    {"deg c", Dimension::temperature, "degC"},
    {"celsius", Dimension::temperature, "degC"},
    {"F", Dimension::temperature, "F", true},
    {"degf", Dimension::temperature, "degF"},
    {"deg f", Dimension::temperature, "degF"},
    {"fahrenheit", Dimension::temperature, "degF"},
    {"K", Dimension::temperature, "K", true},
    {"kelvin", Dimension::temperature, "K"},
    {"ddegc", Dimension::temperature, "ddegC"},
    {"mdegc", Dimension::temperature, "mdegC"},
    {"A", Dimension::current, "A", true},
    {"amp", Dimension::current, "A"},
    {"amps", Dimension::current, "A"},
    {"ampere", Dimension::current, "A"},
    {"ma", Dimension::current, "mA"},
    {"ua", Dimension::current, "uA"},
    {"V", Dimension::voltage, "V", true},
    {"volt", Dimension::voltage, "V"},
    {"volts", Dimension::voltage, "V"},
    {"mv", Dimension::voltage, "mV"},
    {"nm", Dimension::torque, "Nm"},
    {"n m", Dimension::torque, "Nm"},
    {"n*m", Dimension::torque, "Nm"},
    {"n.m", Dimension::torque, "Nm"},
    {"mnm", Dimension::torque, "mNm"},
    {"ncm", Dimension::torque, "Ncm"},
    {"deg", Dimension::angle, "deg"},
    {"degree", Dimension::angle, "deg"},
    {"degrees", Dimension::angle, "deg"},
    {"grad", Dimension::angle, "deg"},
    {"rad", Dimension::angle, "rad"},
    {"radian", Dimension::angle, "rad"},
    {"radians", Dimension::angle, "rad"},
    {"mrad", Dimension::angle, "mrad"},
    {"rev", Dimension::angle, "rev"},
    {"revs", Dimension::angle, "rev"},
    {"turn", Dimension::angle, "rev"},
    {"turns", Dimension::angle, "rev"},
    {"revolutions", Dimension::angle, "rev"},
    {"deg/s", Dimension::rate, "deg/s"},
    {"degs", Dimension::rate, "deg/s"},
    {"deg/sec", Dimension::rate, "deg/s"},
    {"deg s", Dimension::rate, "deg/s"},
    {"deg per s", Dimension::rate, "deg/s"},
    {"dps", Dimension::rate, "dps"},
    {"grad/s", Dimension::rate, "deg/s"},
    {"rad/s", Dimension::rate, "rad/s"},
    {"rads", Dimension::rate, "rad/s"},
    {"rad/sec", Dimension::rate, "rad/s"},
    {"rad s", Dimension::rate, "rad/s"},
    {"rad per s", Dimension::rate, "rad/s"},
    {"rad per sec", Dimension::rate, "rad/s"},
    {"radps", Dimension::rate, "rad/s"},
    {"mrad/s", Dimension::rate, "mrad/s"},
    {"rev/s", Dimension::rate, "rev/s"},
    {"rev s", Dimension::rate, "rev/s"},
    {"revs/s", Dimension::rate, "rev/s"},
    {"turn/s", Dimension::rate, "rev/s"},
    {"turns/s", Dimension::rate, "rev/s"},
    {"turns s", Dimension::rate, "rev/s"},
    {"rps", Dimension::rate, "rev/s"},
    {"hz", Dimension::rate, "rev/s"},
    {"1/s", Dimension::rate, "rev/s"},
    {"rpm", Dimension::rate, "rpm"},
    {"1/min", Dimension::rate, "rpm"},
    {"u/min", Dimension::rate, "rpm"},
    {"min-1", Dimension::rate, "rpm"},
    {"min^-1", Dimension::rate, "rpm"},
    {"rev/min", Dimension::rate, "rpm"},
    {"r/min", Dimension::rate, "rpm"},
    {"W", Dimension::power, "W", true},
    {"watt", Dimension::power, "W"},
    {"watts", Dimension::power, "W"},
    {"mw", Dimension::power, "mW"},
    {"kw", Dimension::power, "kW"},
    {"%", Dimension::share, "%"},
    {"pct", Dimension::share, "%"},
    {"percent", Dimension::share, "%"},
    {"prozent", Dimension::share, "%"},
    {"m/s", Dimension::speed, "m/s"},
    {"m s", Dimension::speed, "m/s"},
    {"mps", Dimension::speed, "m/s"},
    {"km/h", Dimension::speed, "km/h"},
    {"kmh", Dimension::speed, "km/h"},
    {"m", Dimension::other, "", true},
    {"mm", Dimension::other, ""},
    {"cm", Dimension::other, ""},
    {"kg", Dimension::other, ""},
    {"N", Dimension::other, "", true},
    {"ohm", Dimension::other, ""},
    {"ohms", Dimension::other, ""},
    {"bar", Dimension::other, ""},
    {"pa", Dimension::other, ""},
    {"hpa", Dimension::other, ""},
    {"wh", Dimension::other, ""},
    {"ah", Dimension::other, ""},
    {"mah", Dimension::other, ""},
    {"khz", Dimension::other, ""},
    {"J", Dimension::other, "", true},
    {"g", Dimension::other, "", true},
    {"db", Dimension::other, ""},
    {"m/s2", Dimension::other, ""},
    {"m/s^2", Dimension::other, ""},
    {"counts", Dimension::other, ""},
    {"ticks", Dimension::other, ""},
    {"lsb", Dimension::other, ""},
    {"bool", Dimension::other, ""},
    {"-", Dimension::other, ""},
};

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

UnitWord find_unit(const std::string& text) {
  std::string lower = text;
  for (char& c : lower) c = small(c);
  for (const Spelling& one : spellings)
    if (one.exact_case ? text == one.text : lower == one.text) return {one.dimension, one.unit, {}};
  return {};
}

}  // namespace

std::string plain_header(const std::string& header) {
  static constexpr const char* others[][2] = {
      {"\xc2\xb0", "deg"},      {"\xc2\xba", "deg"},   {"\xc3\xa4", "ae"},
      {"\xc3\xb6", "oe"},       {"\xc3\xbc", "ue"},    {"\xc3\x9f", "ss"},
      {"\xc3\x84", "Ae"},       {"\xc3\x96", "Oe"},    {"\xc3\x9c", "Ue"},
      {"\xc2\xb5", "u"},        {"\xce\xbc", "u"},     {"\xc2\xb7", "*"},
      {"\xe2\x8b\x85", "*"},    {"\xc2\xb2", "2"},     {"\xce\xa9", "ohm"},
      {"\xe2\x84\x83", "degC"}, {"\xcf\x89", "omega"}, {"\xce\xb8", "theta"},
      {"\xcf\x84", "tau"},      {"\xcf\x86", "angle"}, {"\xe2\x81\xbb\xc2\xb9", "-1"}};
  std::string out = header;
  for (const auto& [from, to] : others) {
    const std::string what = from;
    for (std::size_t at = out.find(what); at != std::string::npos; at = out.find(what, at))
      out.replace(at, what.size(), to);
  }
  return out;
}

UnitWord unit_word(const std::string& given) {
  std::string text = trimmed(plain_header(given));
  while (text.size() > 2 &&
         ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')')))
    text = trimmed(text.substr(1, text.size() - 2));
  if (text.empty()) return {};
  if (const UnitWord found = find_unit(text); found.dimension != Dimension::none) return found;
  // A quotient or product of units is one that no column has.
  const std::size_t slash = text.find_first_of("/*");
  if (slash != std::string::npos && slash > 0 && slash + 1 < text.size() &&
      find_unit(trimmed(text.substr(0, slash))).dimension != Dimension::none)
    return {Dimension::other, {}, {}};
  return {};
}

UnitWord unit_in_header(const std::string& given) {
  const std::string header = trimmed(plain_header(given));
  const auto with_name = [](UnitWord found, const std::string& name) {
    found.name = name;
    return found;
  };
  const UnitWord none = {Dimension::none, {}, header};
  if (header.empty()) return none;
  // The whole header, where it is a word of its own: "rpm".
  if (const UnitWord whole = header.size() > 2 ? find_unit(header) : UnitWord();
      whole.dimension == Dimension::rate || whole.dimension == Dimension::share)
    return with_name(whole, header);
  // In brackets at the end; brackets that hold no unit say whose the column is.
  if (header.back() == ']' || header.back() == ')') {
    const std::size_t open = header.find_last_of("[(");
    if (open == std::string::npos || open == 0) return none;
    const std::string before = trimmed(header.substr(0, open));
    if (const UnitWord found = unit_word(header.substr(open)); found.dimension != Dimension::none)
      return with_name(found, before);
    const UnitWord found = unit_in_header(before);
    return with_name(found, found.name + " " + header.substr(open));
  }
  if (header.back() == '%') return {Dimension::share, "%", header.substr(0, header.size() - 1)};
  // Behind the last separators: up to three words, longest first. A word alone is a name and no unit.
  std::vector<std::size_t> starts;
  for (std::size_t i = 1; i < header.size(); ++i)
    if (is_letter_or_digit(header[i]) && !is_letter_or_digit(header[i - 1]) && header[i - 1] != '/')
      starts.push_back(i);
  for (std::size_t count = std::min<std::size_t>(3, starts.size()); count > 0; --count) {
    const std::size_t start = starts[starts.size() - count];
    std::string end = header.substr(start);
    std::replace(end.begin(), end.end(), '_', ' ');
    const UnitWord found = find_unit(end);
    if (found.dimension == Dimension::none) continue;
    if (end.size() == 1 && header[start - 1] != '_' && header[start - 1] != ' ') continue;
    return with_name(found, header.substr(0, start));
  }
  return none;
}

}  // namespace thermopower::io
