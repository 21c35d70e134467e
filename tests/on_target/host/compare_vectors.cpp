// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// compare_vectors [--bits] <reference program> <command to run on the target...>: integers must be identical, numbers within the
// reference's bounds. Exit status 0 when they are. With --bits it prints instead, for each section: how many values it has, how many
// of them differ in a bit, and by how much at most, in millionths of the section's largest number. bits.sh makes a table of that.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace {

bool run(const std::string& command, std::vector<std::string>& lines) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return false;
  std::string line;
  for (int character; (character = std::fgetc(pipe)) != EOF;) {
    if (character == '\r') continue;
    if (character != '\n') {
      line.push_back(static_cast<char>(character));
      continue;
    }
    lines.push_back(line);
    line.clear();
  }
  return pclose(pipe) == 0;
}

float number(const std::string& hex) {
  const auto bits = static_cast<std::uint32_t>(std::stoul(hex, nullptr, 16));
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

void print_bits(const std::vector<std::string>& expected, const std::vector<std::string>& found) {
  std::string section;
  long values = 0, different = 0;
  double largest = 0, farthest = 0;
  const auto print = [&] {
    if (values != 0)
      std::cout << section << '\t' << values << '\t' << different << '\t'
                << (farthest > 0 ? 1e6 * farthest / largest : 0.0) << '\n';
    values = different = 0;
    largest = farthest = 0;
  };
  for (std::size_t index = 0; index < expected.size() && index < found.size(); ++index) {
    if (expected[index][0] == '#') {
      print();
      section = expected[index].substr(2);
      continue;
    }
    ++values;
    const bool is_float = expected[index][0] == 'f';
    const std::string want = is_float ? expected[index].substr(2, 8) : expected[index],
                      have = is_float ? found[index].substr(2, 8) : found[index];
    if (want != have) ++different;
    if (!is_float || std::isnan(number(want))) continue;
    largest = std::max(largest, std::fabs(static_cast<double>(number(want))));
    farthest =
        std::max(farthest, std::fabs(static_cast<double>(number(want)) - static_cast<double>(number(have))));
  }
  print();
}

}  // namespace

int main(int count, char** arguments) {
  const bool is_bits_asked = count > 1 && std::strcmp(arguments[1], "--bits") == 0;
  if (is_bits_asked) {
    --count;
    ++arguments;
  }
  if (count < 3) {
    std::cerr << "usage: compare_vectors [--bits] <reference program> <command to run on the target...>\n";
    return 2;
  }
  std::string target;
  for (int index = 2; index < count; ++index) target += "'" + std::string(arguments[index]) + "' ";
  std::vector<std::string> expected, found;
  if (!run("'" + std::string(arguments[1]) + "'", expected)) {
    std::cerr << arguments[1] << ": the reference program failed\n";
    return 1;
  }
  if (!run(target + "</dev/null", found)) {
    std::cerr << target << ": failed after " << found.size() << " lines"
              << (found.empty() ? "" : ", the last: " + found.back()) << '\n';
    return 1;
  }

  if (is_bits_asked) {
    print_bits(expected, found);
    return 0;
  }
  std::string section;
  long integers = 0, numbers = 0, wrong = 0;
  double fullest = 0;
  std::string fullest_at;
  for (std::size_t index = 0; index < expected.size(); ++index) {
    const std::string& reference = expected[index];
    if (reference[0] == '#') section = reference.substr(2);
    const std::string got = index < found.size() ? found[index] : "(nothing)";
    const std::string where = "line " + std::to_string(index + 1) + ", " + section;
    bool is_right = got == reference;
    if (reference[0] == 'i') ++integers;
    if (reference[0] == 'f' && got.size() == reference.size() && got[0] == 'f') {
      ++numbers;
      const double want = number(reference.substr(2, 8)), have = number(got.substr(2, 8)),
                   bound = number(reference.substr(11, 8));
      is_right = std::fabs(want - have) <= bound || (std::isnan(want) && std::isnan(have));
      if (is_right && bound > 0 && std::fabs(want - have) / bound > fullest) {
        fullest = std::fabs(want - have) / bound;
        fullest_at = where;
      }
      if (!is_right)
        std::cerr << where << ": " << have << " here, " << want << " on the PC, bound " << bound << '\n';
    } else if (!is_right) {
      std::cerr << where << ": \"" << got << "\" here, \"" << reference << "\" on the PC\n";
    }
    if (!is_right && ++wrong >= 20) break;
  }
  if (found.size() != expected.size()) {
    std::cerr << found.size() << " lines here, " << expected.size() << " on the PC\n";
    ++wrong;
  }
  std::cout << integers << " integers identical, " << numbers << " numbers within their bounds (at most "
            << std::round(fullest * 100) << " % of one, " << fullest_at << ")"
            << (wrong != 0 ? ", except those above" : "") << '\n';
  return wrong == 0 ? 0 : 1;
}
