// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

// Debian's Emscripten (3.1.6) comes with a standard library that has no std::from_chars and std::to_chars of double yet.
// Included before everything else where a program is compiled to WebAssembly; nowhere else. There is one locale there, "C".

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace std {

/// The longest number at the beginning of a text, as std::from_chars: no blanks, no plus sign, no hexadecimal digits.
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const char* at = first;
  if (at < last && *at == '-') ++at;
  const char* const digits = at;
  const auto is_digit = [&](const char* one) { return one < last && *one >= '0' && *one <= '9'; };
  bool any = false;
  while (is_digit(at)) any = true, ++at;
  if (at < last && *at == '.') {
    const char* fraction = at + 1;
    while (is_digit(fraction)) any = true, ++fraction;
    if (any) at = fraction;
  }
  if (any && at < last && (*at == 'e' || *at == 'E')) {
    const char* exponent = at + 1;
    if (exponent < last && (*exponent == '-' || *exponent == '+')) ++exponent;
    if (is_digit(exponent)) {
      while (is_digit(exponent)) ++exponent;
      at = exponent;
    }
  }
  if (!any)
    for (const char* word : {"infinity", "inf", "nan"}) {
      const size_t size = strlen(word);
      if (static_cast<size_t>(last - digits) < size) continue;
      bool same = true;
      for (size_t i = 0; i < size; ++i) same = same && (digits[i] | 32) == word[i];
      if (!same) continue;
      at = digits + size;
      any = true;
      break;
    }
  if (!any) return {first, errc::invalid_argument};
  char text[512];
  const size_t size = static_cast<size_t>(at - first);
  if (size >= sizeof text) return {at, errc::result_out_of_range};
  memcpy(text, first, size);
  text[size] = 0;
  const double read = strtod(text, nullptr);
  const bool spelled = *digits > '9';
  if (!spelled && (isinf(read) || (read == 0.0 && strpbrk(text, "123456789") != nullptr &&
                                   strpbrk(text, "123456789") < text + strcspn(text, "eE"))))
    return {at, errc::result_out_of_range};
  value = read;
  return {at, errc()};
}

/// The shortest text that reads back as the same number.
inline to_chars_result to_chars(char* first, char* last, double value) {
  char text[40];
  int size = 0;
  for (int digits = 1; digits <= 17; ++digits) {
    size = snprintf(text, sizeof text, "%.*g", digits, value);
    if (!(value == value) || strtod(text, nullptr) == value) break;
  }
  if (last - first < size) return {last, errc::value_too_large};
  memcpy(first, text, static_cast<size_t>(size));
  return {first + size, errc()};
}

}  // namespace std
