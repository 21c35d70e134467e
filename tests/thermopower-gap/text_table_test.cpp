// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/text_table.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace {

namespace io = thermopower::io;

/// The table of some bytes in a file of its own.
io::TextTable table_of(const std::string& bytes) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("table" + std::to_string(getpid()) + ".csv")).string();
  std::ofstream(path, std::ios::binary) << bytes;
  struct Remove {
    const std::string& path;
    ~Remove() { std::remove(path.c_str()); }
  } remove{path};
  return io::read_text_table(path);
}

std::string fault_of(const std::string& bytes) {
  try {
    table_of(bytes);
  } catch (const io::InputError& error) {
    const std::string text = error.what();
    return text.substr(text.find(".csv") + 4);
  }
  return {};
}

}  // namespace

TEST_CASE("a table of words: quotes, comments, line ends, a byte-order mark") {
  const io::TextTable table = table_of(
      "\xef\xbb\xbf# a comment with \"a quote\n\nlog,unit\r\na.csv,\"one, \"\"two\"\"\"\r\n#b.csv,x\n"
      "c.csv,\"over\ntwo # lines\"\nd.csv,");
  CHECK(table.header == std::vector<std::string>{"log", "unit"});
  CHECK(table.header_line == 3);
  REQUIRE(table.rows.size() == 3);
  CHECK(table.rows[0].cells == std::vector<std::string>{"a.csv", "one, \"two\""});
  CHECK(table.rows[0].line == 4);
  CHECK(table.rows[1].cells == std::vector<std::string>{"c.csv", "over\ntwo # lines"});
  CHECK(table.rows[1].line == 6);
  CHECK(table.rows[2].cells == std::vector<std::string>{"d.csv", ""});
  CHECK(table.rows[2].line == 8);
  CHECK(table_of("").header.empty());
}

TEST_CASE("a table of words that is wrong is refused with its line") {
  CHECK(fault_of("a,b\n1\n") == ":2: 1 cells; expected 2 as in the header row");
  CHECK(fault_of("a,b\n1,2\n1,2,3\n") == ":3: 3 cells; expected 2 as in the header row");
  CHECK(fault_of("a,b\n1,\"2\n\n") == ":2: a quote that is never closed; expected a closing '\"'");
  CHECK_THAT(fault_of("a,b\n1,2\"3\n"), ContainsSubstring(":2: a quote within a cell"));
  CHECK_THROWS_AS(io::read_text_table("/nowhere/at/all.csv"), io::InputError);
  CHECK_THROWS_AS(io::read_text_table("/"), io::InputError);
}

TEST_CASE("what is written as a cell reads back") {
  std::string text = "a,b\n";
  const std::vector<std::string> cells = {"plain", "with \"quotes\", commas\nand lines"};
  io::append_csv_cell(text, cells[0]);
  text += ",";
  io::append_csv_cell(text, cells[1]);
  const io::TextTable table = table_of(text + "\n");
  REQUIRE(table.rows.size() == 1);
  CHECK(table.rows[0].cells == cells);
}
