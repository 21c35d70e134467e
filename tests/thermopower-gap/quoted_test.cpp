// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What pages quote of the diagnosis is what the program says: words as they are, numbers to 3 % or one in their last
// place, so that another compiler's rounding is none.

#include "../catch.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Words = std::vector<std::string>;

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// Brackets and commas are words of their own, so that numbers are numbers.
Words words_of(const std::string& line) {
  std::string apart;
  for (const char one : line) {
    if (one == '[' || one == ']' || one == '(' || one == ')' || one == ',' || one == '|') {
      apart += ' ';
      apart += one;
      apart += ' ';
    } else {
      apart += one;
    }
  }
  std::istringstream in(apart);
  return {std::istream_iterator<std::string>(in), {}};
}

bool same_number(const std::string& a, const std::string& b) {
  char *end_a = nullptr, *end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
  if (end_a == a.c_str() || end_b == b.c_str() || *end_a != '\0' || *end_b != '\0') return false;
  const std::size_t point = a.find('.');
  const double last =
      std::pow(10.0, point == std::string::npos ? 0.0 : -static_cast<double>(a.size() - point - 1));
  return std::fabs(x - y) <= std::max(0.03 * std::fabs(y), 1.01 * last);
}

/// Whether a line of the program is the quoted one; a quoted "..." stands for the rest.
bool says(const Words& line, const Words& quoted) {
  for (std::size_t i = 0; i < quoted.size(); ++i) {
    if (quoted[i] == "...") return true;
    if (i >= line.size() || (line[i] != quoted[i] && !same_number(line[i], quoted[i]))) return false;
  }
  return line.size() == quoted.size();
}

std::string diagnosed(const std::string& arguments) {
  const std::string command =
      std::string("\"") + THERMOPOWER_GAP_PROGRAM + "\" diagnose " + arguments + " 2>&1";
  std::string out;
  FILE* const pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  char part[4096];
  while (const std::size_t n = std::fread(part, 1, sizeof part, pipe)) out.append(part, n);
  CHECK(pclose(pipe) == 0);
  return out;
}

std::string recorded(const std::string& model, const std::string& train, const std::string& heldout) {
  return "--model " + model + " --recording " + train + " --heldout " + heldout;
}

/// Indented lines of a page that begin as the program's do.
std::vector<std::string> quotes_of(const std::string& page) {
  std::vector<std::string> quotes;
  for (const std::string& line : lines_of(page)) {
    if (line.compare(0, 4, "    ") != 0) continue;
    const Words words = words_of(line);
    if (words.empty()) continue;
    for (const char* first : {"EXPLAINED", "AMBIGUOUS", "UNEXPLAINED", "PARTLY", "where", "which", "or",
                              "with", "motor", "angle", "angular", "next"})
      if (words[0] == first) quotes.push_back(line);
  }
  return quotes;
}

void check_quotes(const std::string& page, std::size_t least, const std::string& said) {
  const std::vector<std::string> quotes = quotes_of(text_of(std::string(THERMOPOWER_ROOT) + "/" + page));
  CHECK(quotes.size() >= least);
  for (const std::string& quote : quotes) {
    bool found = false;
    for (const std::string& line : lines_of(said)) found = found || says(words_of(line), words_of(quote));
    CAPTURE(page, quote, said);
    CHECK(found);
  }
}

}  // namespace

TEST_CASE("README and the first diagnosis quote what the program says of the known gap") {
  const std::string here = THERMOPOWER_KNOWN_GAP;
  const std::string said =
      diagnosed(recorded(here + "/model.json", here + "/train.csv", here + "/heldout.csv"));
  check_quotes("README.md", 6, said);
  check_quotes("docs/learn/first-diagnosis.md", 6, said);
}

TEST_CASE(
    "the motor on a frame is diagnosed as its page says, as a whole, without its first cause, and part by part") {
  const std::string here = THERMOPOWER_JOINTS;
  const std::string files =
      recorded(here + "/frame.json", here + "/frame_train.csv", here + "/frame_heldout.csv");
  check_quotes("docs/how-to/motor-on-a-frame.md", 7,
               diagnosed(files) + diagnosed(files + " --without contact_resistance") +
                   diagnosed(recorded(here + "/bolted.json", here + "/bolted_train.csv",
                                      here + "/bolted_heldout.csv")));
}

TEST_CASE("the table and the quotation of the thesis's motors are what the program says of them") {
  const std::string here = std::string(THERMOPOWER_ROOT) + "/examples/thesis_gap/",
                    page = text_of(std::string(THERMOPOWER_ROOT) + "/docs/explain/real-recordings.md");
  const struct {
    const char *row, *name, *laws;
  } motors[] = {{"BGM5208-200-12", "bgm5208", "programmed"},
                {"BGM5208-200-12", "bgm5208", "printed"},
                {"BGM2606-90T", "bgm2606", "programmed"},
                {"BGM2606-90T", "bgm2606", "printed"}};
  for (const auto& motor : motors) {
    const std::string said =
        diagnosed(recorded(here + motor.name + "_" + motor.laws + ".json",
                           here + motor.name + "_chapter4.csv", here + motor.name + "_chapter5.csv"));
    if (motor.laws == std::string("programmed") && motor.name == std::string("bgm5208"))
      check_quotes("docs/explain/real-recordings.md", 2, said);
    Words verdict, score;
    for (const std::string& line : lines_of(said)) {
      const Words words = words_of(line);
      if (verdict.empty()) verdict = words;
      if (words.size() > 7 && words[1] == "temperature" && words[2] == "/") score = words;
    }
    REQUIRE(score.size() > 7);
    Words row;
    for (const std::string& line : lines_of(page)) {
      const Words words = words_of(line);
      if (words.size() > 4 && words[0] == "|" && words[1] == motor.row && words[3] == motor.laws) row = words;
    }
    CAPTURE(motor.name, motor.laws, row, said);
    REQUIRE(row.size() > 10);
    std::string told;  // "PARTLY EXPLAINED" is "partly explained"
    for (const std::string& word : verdict)
      for (const char one : word) told += one >= 'A' && one <= 'Z' ? static_cast<char>(one - 'A' + 'a') : one;
    std::string written;
    for (std::size_t i = 5; row[i] != "|"; ++i) written += row[i];
    CHECK(written.compare(0, told.size(), told) == 0);
    // The four numbers stand before the last bar, with bars between them.
    for (std::size_t k = 0; k < 4; ++k) {
      const std::string& in_page = row[row.size() - 8 + 2 * k];
      CAPTURE(k, in_page, score[4 + k]);
      CHECK((in_page == score[4 + k] || same_number(in_page, score[4 + k])));
    }
  }
}
