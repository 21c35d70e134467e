// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "shell_words.hpp"

#include <algorithm>
#include <cstring>

namespace thermopower::io {

std::string quoted_for_shell(const std::string& text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::strchr("_=:/.%-,+@", c) != nullptr;
  });
  if (plain && text.find('\0') == std::string::npos) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

std::string shell_word(const std::string& text, std::size_t& at, const char* enders) {
  std::string word;
  char quote = 0;  // the one that is open
  for (; at < text.size(); ++at) {
    const char c = text[at];
    const bool more = at + 1 < text.size();
    if (quote == '\'') {
      if (c == quote) quote = 0;
      else word += c;
    } else if (c == '\\' && more && (quote == 0 || std::strchr("\"\\$`", text[at + 1]) != nullptr)) {
      word += text[++at];
    } else if (quote == '"' && c == quote) {
      quote = 0;
    } else if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (quote == 0 && c != '\0' && std::strchr(enders, c) != nullptr) {
      break;
    } else {
      word += c;
    }
  }
  return word;
}

std::vector<std::string> shell_words(const std::string& line) {
  constexpr const char* blanks = " \t\r\n";
  std::vector<std::string> words;
  for (std::size_t at = line.find_first_not_of(blanks); at < line.size();
       at = line.find_first_not_of(blanks, at))
    words.push_back(shell_word(line, at, blanks));
  return words;
}

}  // namespace thermopower::io
