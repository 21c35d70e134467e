// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "axis.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

int last_power = -1, last_gain = -1;

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  REQUIRE(file.good());
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// Where it is indented does not matter, what it says does.
std::string trimmed(const std::string& line) {
  const auto first = line.find_first_not_of(' ');
  return first == std::string::npos ? "" : line.substr(first);
}

bool contains(const std::vector<std::string>& lines, const std::vector<std::string>& block) {
  for (std::size_t at = 0; at + block.size() <= lines.size(); ++at) {
    std::size_t same = 0;
    while (same < block.size() && trimmed(lines[at + same]) == trimmed(block[same])) ++same;
    if (same == block.size()) return true;
  }
  return false;
}

std::vector<std::vector<std::string>> cpp_blocks(const fs::path& page) {
  std::vector<std::vector<std::string>> blocks;
  bool inside = false;
  for (const std::string& line : lines_of(page)) {
    if (line == "```cpp") {
      blocks.emplace_back();
      inside = true;
    } else if (line == "```") {
      inside = false;
    } else if (inside) {
      blocks.back().push_back(line);
    }
  }
  return blocks;
}

}  // namespace

void set_motor(uint8_t power, uint8_t p_gain) {
  last_power = power;
  last_gain = p_gain;
}

TEST_CASE("every piece of C++ in the README is compiled by a test") {
  const fs::path root = THERMOPOWER_ROOT;
  const auto blocks = cpp_blocks(root / "README.md");
  REQUIRE(blocks.size() >= 2);
  for (const auto& block : blocks) {
    REQUIRE_FALSE(block.empty());
    INFO("the block that begins with: " << block.front());
    CHECK((contains(lines_of(root / "tests/readme/axis.cpp"), block) ||
           contains(lines_of(root / "examples/10_own_effect/own_effect.cpp"), block) ||
           contains(lines_of(root / "examples/10_own_effect/stiffening_hose.hpp"), block)));
  }
}

TEST_CASE("the README's axis is driven hard, then held back, and its gain follows") {
  control_cycle(2.0f, 13.0f, 25.0f, 0.03f);
  CHECK(last_power == 250);
  const int gain_at_full_power = last_gain;
  for (int i = 0; i < 5 * 60 * 33; ++i) control_cycle(2.0f, 13.0f, 25.0f, 0.03f);
  CHECK(last_power < 125);
  CHECK(last_power >= 1);
  CHECK(last_gain > gain_at_full_power);
}
