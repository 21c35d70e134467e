// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdexcept>
#include <string>

namespace thermopower::io {

/// @brief Unreadable or invalid input: the program ends with exit status 3 and this text on stderr.
///
/// The text has the form compilers use, so that editors can jump to it: `file:line: column 'name': what is
/// wrong; what was expected`. Parts that do not apply are left out (a missing file has no line).
class InputError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// @brief Puts `text` in single quotes for an error message: control characters and broken UTF-8 become
/// `\xNN`, and what is longer than `limit` bytes is cut and its length told. Safe for any bytes.
inline std::string excerpt(const char* text, std::size_t size, std::size_t limit = 40) {
  static const char* const digits = "0123456789abcdef";
  std::string out = "'";
  for (std::size_t i = 0; i < size && i < limit; ++i) {
    const unsigned char byte = static_cast<unsigned char>(text[i]);
    if (byte >= 0x20 && byte < 0x7f) {
      out += static_cast<char>(byte);
    } else {
      out += "\\x";
      out += digits[byte >> 4];
      out += digits[byte & 15];
    }
  }
  out += size > limit ? "...' (" + std::to_string(size) + " bytes)" : "'";
  return out;
}

/// @copydoc excerpt(const char*, std::size_t, std::size_t)
inline std::string excerpt(const std::string& text) { return excerpt(text.data(), text.size()); }

}  // namespace thermopower::io
