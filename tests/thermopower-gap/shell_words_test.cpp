// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Lines are split into words as the shell of this machine splits them.

#include "../catch.hpp"
#include "shell_words.hpp"

#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace io = thermopower::io;

namespace {

/// What sh makes of a line: its words, each ended by a byte 1.
std::vector<std::string> words_of_sh(const std::string& line) {
  std::FILE* const pipe = popen(("printf '%s\\001' " + line).c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::vector<std::string> words;
  std::string word;
  for (int c; (c = std::fgetc(pipe)) != EOF;)
    if (c == 1) words.push_back(word), word.clear();
    else word += static_cast<char>(c);
  CHECK(pclose(pipe) == 0);
  return words;
}

}  // namespace

TEST_CASE("a line has the words that a shell sees in it") {
  for (const char* line :
       {"--column motor_C=temp:degF", "--column 'motor_C=Motor Temp (degF):degF' --ambient 24",
        "a 'b c'd\"e f\"g", "'it'\\''s' \"a \\\"b\\\" \\c\"", "\\ a b\\\\c", "  a\t b ", "'' \"\" x",
        "--constant 'name with \"quotes\"=2'"}) {
    CAPTURE(line);
    CHECK(io::shell_words(line) == words_of_sh(line));
  }
  CHECK(io::shell_words("").empty());
  CHECK(io::shell_words(" \t\r\n").empty());
}

TEST_CASE("whatever is quoted for a shell is one word again, for a shell and here") {
  std::mt19937 random(1);
  const std::string letters = "ab '\"\\$`*?();|&<>#~!=:/%\t";
  for (int i = 0; i < 40; ++i) {
    std::string word;
    for (std::size_t k = random() % 12; k > 0; --k) word += letters[random() % letters.size()];
    const std::string quoted = io::quoted_for_shell(word);
    CAPTURE(word, quoted);
    CHECK(io::shell_words(quoted) == std::vector<std::string>{word});
    CHECK(words_of_sh(quoted) == std::vector<std::string>{word});
  }
}

TEST_CASE("a word may end at other characters, and tells where") {
  const std::string sentence = "(--column 'motor_C=a b:degF'; then)";
  std::size_t at = 1;
  CHECK(io::shell_word(sentence, at, " );") == "--column");
  CHECK(sentence[at] == ' ');
  ++at;
  CHECK(io::shell_word(sentence, at, " );") == "motor_C=a b:degF");
  CHECK(sentence[at] == ';');
}
