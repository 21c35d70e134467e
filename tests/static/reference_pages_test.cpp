// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The tables of docs/reference are what the headers say. Run with THERMOPOWER_UPDATE_DOCS=1 to write them
// anew.

#include "../catch.hpp"
#include "../../tools/thermopower-gap/text_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

namespace fs = std::filesystem;

namespace {

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  REQUIRE(file.good());
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// A table of the enumerators of a header: number, name, meaning.
std::string enumerators(const std::string& header) {
  static const std::regex enumerator(R"(\s*(\w+) = (\d+),?\s*///<\s*(.*))");
  std::string table = "| number | name | meaning |\n|---:|---|---|\n";
  for (const std::string& line : lines_of(fs::path(THERMOPOWER_INCLUDE) / header)) {
    std::smatch match;
    if (std::regex_match(line, match, enumerator))
      table += "| " + match[2].str() + " | `" + match[1].str() + "` | " + match[3].str() + " |\n";
  }
  return table;
}

/// Every menu in the headers of the firmware: the tables of laws, rules and steps in their file comments.
std::string menus() {
  std::map<std::string, std::string> found;
  for (const char* folder : {"actuator", "control", "sbgc"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(THERMOPOWER_INCLUDE) / folder)) {
      if (entry.path().extension() != ".hpp") continue;
      static const std::regex head(
          "/// \\| (law|rule|step|limiter|motor|network|heat|gain|drive|supply) \\|.*");
      std::string table;
      bool is_menu = false;
      for (const std::string& line : lines_of(entry.path())) {
        const bool is_head = std::regex_match(line, head);
        is_menu = line.rfind("/// |", 0) == 0 && (is_menu || is_head);
        if (is_head && !table.empty()) table += "\n";
        if (is_menu) table += line.substr(4) + "\n";
      }
      const std::string name = fs::relative(entry.path(), THERMOPOWER_INCLUDE).generic_string();
      if (!table.empty()) found[name] = table;
    }
  }
  std::string text;
  for (const auto& [name, table] : found) text += "\n## " + name + "\n\n" + table;
  return text;
}

void check_page(const std::string& page, const std::string& expected) {
  const std::string begin = "<!-- from the headers: begin -->\n", end = "<!-- from the headers: end -->";
  const fs::path path = fs::path(THERMOPOWER_DOCS_DIR) / "reference" / page;
  const std::string whole = read_text(path);
  const size_t from = whole.find(begin), to = whole.find(end);
  REQUIRE(from != std::string::npos);
  REQUIRE(to != std::string::npos);
  const std::string written = whole.substr(from + begin.size(), to - from - begin.size());
  if (std::getenv("THERMOPOWER_UPDATE_DOCS") != nullptr) {
    std::ofstream(path) << whole.substr(0, from) << begin << expected << whole.substr(to);
    return;
  }
  INFO("docs/reference/" << page << " is not what the headers say; THERMOPOWER_UPDATE_DOCS=1 writes it anew");
  CHECK(written == expected);
}

}  // namespace

TEST_CASE("docs/reference/config-errors.md lists every field that validate() can name") {
  check_page("config-errors.md", enumerators("config_error.hpp"));
}

TEST_CASE("docs/reference/limit-reasons.md lists every reason a limiter can give") {
  check_page("limit-reasons.md", enumerators("control/limit_reason.hpp"));
}

TEST_CASE("docs/reference/policies.md holds every menu of the headers") {
  check_page("policies.md", menus());
}

TEST_CASE("stable numbers: no enumerator is given twice") {
  for (const char* header : {"config_error.hpp", "control/limit_reason.hpp"}) {
    std::map<std::string, int> seen;
    std::istringstream table(enumerators(header));
    for (std::string line; std::getline(table, line);) ++seen[line.substr(0, line.find('|', 1))];
    for (const auto& [number, count] : seen) {
      CAPTURE(header, number);
      CHECK(count == 1);
    }
  }
}

TEST_CASE("the front page links every page") {
  const std::string front = read_text(fs::path(THERMOPOWER_DOCS_DIR) / "index.md");
  int pages = 0;
  for (const auto& entry : fs::recursive_directory_iterator(THERMOPOWER_DOCS_DIR)) {
    if (entry.path().extension() != ".md" || entry.path().filename() == "index.md") continue;
    const std::string page = fs::relative(entry.path(), THERMOPOWER_DOCS_DIR).generic_string();
    CAPTURE(page);
    CHECK(front.find("](" + page + ")") != std::string::npos);
    ++pages;
  }
  CHECK(pages > 40);
}

TEST_CASE("the headers that are called stable exist") {
  static const std::regex row(R"(^\| `([a-z_/]+\.hpp)` \|.*)");
  int count = 0;
  for (const std::string& line : lines_of(fs::path(THERMOPOWER_DOCS_DIR) / "reference/stability.md")) {
    std::smatch match;
    if (!std::regex_match(line, match, row)) continue;
    INFO(match[1]);
    CHECK(fs::exists(fs::path(THERMOPOWER_INCLUDE) / match[1].str()));
    ++count;
  }
  CHECK(count > 10);
}
