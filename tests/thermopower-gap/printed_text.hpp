// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <nlohmann/json.hpp>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

/// What people read of a report, as text, and its numbers to the rounding they are printed with. Nothing here is of the
/// library: a writer that is wrong must not be believed by its own words.
namespace printed {

using Json = nlohmann::json;

inline std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
    text.replace(at, what.size(), with);
  return text;
}

inline std::string trimmed(const std::string& text) {
  const std::size_t from = text.find_first_not_of(" \n\t"), to = text.find_last_not_of(" \n\t");
  return from == std::string::npos ? std::string() : text.substr(from, to - from + 1);
}

/// As browsers show it, without what has no width, with plain spaces and signs.
inline std::string decoded(std::string text) {
  for (const char* gone : {"<wbr>", "\u00ad"}) text = replaced(text, gone, "");
  for (const char* space : {"\u00a0", "\u2009", "\u200a", "\u2002"}) text = replaced(text, space, " ");
  text = replaced(text, "\u2212", "-");
  text = replaced(replaced(replaced(text, "&lt;", "<"), "&gt;", ">"), "&quot;", "\"");
  return replaced(text, "&amp;", "&");
}

/// A piece of a page without its tags: pieces of a line of their own end lines.
inline std::string without_tags(std::string html) {
  static const std::regex ends(
      "<br>|</p>|</li>|</div>|</h[1-3]>|</figcaption>|<small>|</small>|"
      "<span class=\"(more|mend|soft|name|key)[^>]*>|</span>");
  html = std::regex_replace(html, ends, "\n");
  return trimmed(decoded(std::regex_replace(html, std::regex("<[^>]*>"), "")));
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::string line;
  for (const char one : text + "\n") {
    if (one != '\n') line += one;
    else {
      if (!trimmed(line).empty()) lines.push_back(trimmed(line));
      line.clear();
    }
  }
  return lines;
}

/// A number as it is printed: signs, digits, point, exponent.
inline const char* const number = "([-+]?[0-9]+(?:\\.[0-9]+)?(?:e[-+]?[0-9]+)?|\u2013|\\?)";
/// A share as it is printed.
inline const char* const share = "((?:[<>] ?)?-?[0-9]+(?:\\.[0-9]+)? %|\u2013|\\?)";

/// Whether a printed number is the value, to half a unit of its last digit.
inline bool is(const std::string& text, const Json& value) {
  if (value.is_null()) return text == "\u2013" || text == "?";
  const double seen = std::strtod(text.c_str(), nullptr), meant = value.get<double>();
  std::size_t decimals = 0;
  const std::size_t point = text.find('.'), exponent = text.find('e');
  if (point != std::string::npos) decimals = std::min(exponent, text.size()) - point - 1;
  double unit = std::pow(10.0, -static_cast<double>(decimals));
  if (exponent != std::string::npos) unit *= std::pow(10.0, std::atoi(text.c_str() + exponent + 1));
  return !text.empty() && std::fabs(seen - meant) <= 0.5 * unit * (1.0 + 1e-6) + 1e-12 * std::fabs(meant);
}

/// Whether a printed share ("98 %", "> 99 %", "<1 %") is the value.
inline bool is_share(const std::string& text, const Json& value) {
  if (value.is_null()) return text == "\u2013" || text == "?";
  const double meant = value.get<double>();
  if (text == "> 99 %" || text == ">99 %") return meant > 0.99 && meant < 1.0;
  if (text == "< 1 %") return meant > 0.0 && meant < 0.01;
  if (text[0] == '<' || text[0] == '>') return false;
  return is(text.substr(0, text.find(' ')), 100.0 * meant);
}

/// A sentence whose numbers have to be accounted for: each is taken by somebody who knows what stands behind it.
class Sentence {
public:
  explicit Sentence(std::string text) : text_(std::move(text)), known_(text_.size(), false) {}

  const std::string& text() const { return text_; }

  /// Knows the numbers of a text that stands here as it does elsewhere. @return whether it does
  bool take(const std::string& verbatim) {
    bool found = false;
    for (std::size_t at = 0; !verbatim.empty() && (at = text_.find(verbatim, at)) != std::string::npos;
         at += verbatim.size()) {
      know(at, verbatim.size());
      found = true;
    }
    return found;
  }

  /// Knows what each place that matches says. @return how many do
  int take(const std::string& pattern, const std::function<void(const std::smatch&)>& check) {
    const std::regex expression(pattern);
    int count = 0;
    for (std::sregex_iterator one(text_.begin(), text_.end(), expression), end; one != end; ++one, ++count) {
      check(*one);
      know(static_cast<std::size_t>(one->position()), static_cast<std::size_t>(one->length()));
    }
    return count;
  }

  /// The numbers that nobody took; digits inside a name are none.
  std::vector<std::string> left() const {
    std::vector<std::string> words;
    const auto in_word = [&](std::size_t i) {
      const auto one = static_cast<unsigned char>(text_[i]);
      return std::isalnum(one) != 0 || one == '_' || one == '.' || one == '^' || one >= 0x80;
    };
    for (std::size_t i = 0; i < text_.size();) {
      std::size_t end = i;
      while (end < text_.size() && in_word(end)) ++end;
      std::size_t last = end;
      while (last > i && text_[last - 1] == '.') --last;  // of a sentence
      bool taken = true;
      for (std::size_t k = i; k < last; ++k) taken = taken && known_[k];
      if (end > i && std::isdigit(static_cast<unsigned char>(text_[i])) != 0 && !taken)
        words.push_back(text_.substr(i, end - i));
      i = std::max(end, i + 1);
    }
    return words;
  }

private:
  void know(std::size_t at, std::size_t length) {
    for (std::size_t i = at; i < at + length; ++i) known_[i] = true;
  }

  std::string text_;
  std::vector<bool> known_;
};

}  // namespace printed
