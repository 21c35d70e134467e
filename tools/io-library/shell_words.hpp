// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A word as a shell takes it: quoted where it holds more than letters, digits and some signs.
/// `shell_words()` of it is that one word again.
std::string quoted_for_shell(const std::string& text);

/// @brief The word of a command line that begins at a place, without its quotes. It knows '...', "..." and \ as a shell does.
/// @param text    the line
/// @param at      where the word begins; afterwards the place of what ended it, or the size of the text
/// @param enders  characters that end a word outside of quotes
std::string shell_word(const std::string& text, std::size_t& at, const char* enders = " \t\r\n");

/// @brief The words of a command line, as a shell splits it.
std::vector<std::string> shell_words(const std::string& line);

}  // namespace thermopower::io
