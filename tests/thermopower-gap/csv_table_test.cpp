// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"
#include "input_error_of.hpp"

#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/column_list.hpp>
#include <thermopower/io/input_error.hpp>
#include <thermopower/io/recording_file.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

using namespace thermopower::gap;
namespace io = thermopower::io;
using io::CsvTable;

namespace {

CsvTable parse(const std::string& text) {
  return io::parse_csv("log.csv", text.data(), text.size(), io::known_columns());
}

std::string error_of(const std::string& text) {
  return test::input_error_of([&] { parse(text); });
}

}  // namespace

TEST_CASE("a recording keeps every number, bit by bit") {
  const CsvTable table = parse("t_s,motor_C,my_sensor\n0,21.5,1e-3\n0.1,22,-4\n0.25,21.9375,+7\n");
  REQUIRE(table.rows == 3);
  REQUIRE(table.columns.size() == 3);
  CHECK(table.columns[0].values == std::vector<double>{0.0, 0.1, 0.25});
  CHECK(table.columns[1].values == std::vector<double>{21.5, 22.0, 21.9375});
  CHECK(table.columns[2].values == std::vector<double>{1e-3, -4.0, 7.0});
}

TEST_CASE("numbers of any magnitude survive writing and reading") {
  std::mt19937_64 random(7);
  std::string text = "t_s,x\n";
  std::vector<double> written;
  for (int i = 0; i < 2000; ++i) {
    const double value = std::ldexp(std::uniform_real_distribution<double>(-1.0, 1.0)(random),
                                    static_cast<int>(random() % 600) - 300);
    char row[64];
    std::snprintf(row, sizeof row, "%d,%.17g\n", i, value);
    text += row;
    written.push_back(value);
  }
  CHECK(parse(text).columns[1].values == written);
}

TEST_CASE("empty cells and nan are missing samples") {
  const CsvTable table = parse("t_s,motor_C\n0,\n1,nan\n2,NaN\n3,5\n");
  CHECK(std::isnan(table.columns[1].values[0]));
  CHECK(std::isnan(table.columns[1].values[1]));
  CHECK(std::isnan(table.columns[1].values[2]));
  CHECK(table.columns[1].values[3] == 5.0);
}

TEST_CASE(
    "a byte-order mark, CRLF, blank lines, spaces, quotes and a missing last line break change nothing") {
  const CsvTable plain = parse("t_s,motor_C\n0,1\n1,2\n");
  for (const char* text : {"\xef\xbb\xbft_s,motor_C\n0,1\n1,2\n", "t_s,motor_C\r\n0,1\r\n1,2\r\n",
                           "t_s,motor_C\n\n0,1\n\n\n1,2\n", "t_s, motor_C\n0 , 1\n1,2\n",
                           "\"t_s\",\"motor_C\"\n\"0\",\"1\"\n1,2\n", "t_s,motor_C\n0,1\n1,2"}) {
    CAPTURE(text);
    const CsvTable table = parse(text);
    REQUIRE(table.rows == 2);
    CHECK(table.columns[0].values == plain.columns[0].values);
    CHECK(table.columns[1].values == plain.columns[1].values);
  }
  CHECK_FALSE(parse("t_s,motor_C\n0,1\n1,2").ends_with_line_break);
}

TEST_CASE("a change of the run label starts a run, and time starts anew with it") {
  const CsvTable table = parse("t_s,run,motor_C\n0,a,1\n1,a,1\n0,\"b, second\",1\n5,a,1\n");
  CHECK(table.run_begin == std::vector<std::size_t>{0, 2, 3});
  CHECK(table.run_labels == std::vector<std::string>{"a", "b, second", "a"});
}

TEST_CASE("a text column nobody knows is left out, and said to be") {
  const CsvTable table = parse("t_s,note,motor_C\n0,warm,1\n1,\"cold\nand wet\",2\n");
  CHECK(table.columns.size() == 2);
  CHECK(table.ignored_text == std::vector<std::string>{"note"});
  const auto file = io::to_recording(table);
  REQUIRE(file.findings.size() == 1);
  CHECK(file.findings[0].kind == FindingKind::text_column_ignored);
  CHECK(file.findings[0].column == "note");
}

TEST_CASE("every kind of malformed input is refused with file, line, column and what was expected") {
  struct Case {
    const char* text;
    std::vector<std::string> parts;
  };
  const std::string nul = std::string("t_s,motor_C\n0,1") + '\0' + "\n";
  const std::vector<Case> cases = {
      {"", {"log.csv: ", "empty", "expected a header row"}},
      {"t_s,motor_C\n", {"log.csv: ", "only a header row", "at least one data row"}},
      {"t_s,motor_C\n0,1\n1,2x\n",
       {"log.csv:3: ", "column 'motor_C'", "'2x' is not a number", "expected a decimal number"}},
      {"t_s,motor_C\n0,1\n1,0x10\n", {"log.csv:3: ", "'0x10' is not a number"}},
      {"t_s,motor_C\n0,1,2\n", {"log.csv:2: ", "3 fields", "expected 2 as in the header row"}},
      {"t_s,motor_C\n0\n1,2\n", {"log.csv:2: ", "column 'motor_C'", "1 field ", "expected 2"}},
      {"t_s,motor_C\n0,1\n1", {"log.csv:3: ", "ends inside this row", "cut off"}},
      {"t_s,x,x\n0,1,2\n", {"log.csv:1: ", "column 'x' appears twice", "distinct names"}},
      {"t_s,,x\n0,1,2\n", {"log.csv:2: ", "column number 2 has no name and holds '1'"}},
      {"time,motor_C\n0,1\n", {"log.csv:1: ", "no column 't_s'", "found 'time', 'motor_C'"}},
      {"t_s|motor_C\n0|1\n", {"log.csv:1: ", "no column 't_s'", "separated by commas, semicolons or tabs"}},
      {"t_s,motor_C\n0,1\n0,2\n", {"log.csv:3: ", "column 't_s'", "0 s follows 0 s", "strictly increasing"}},
      {"t_s,motor_C\n1,1\n0.5,2\n", {"log.csv:3: ", "0.5 s follows 1 s"}},
      {"t_s,motor_C\n,1\n", {"log.csv:2: ", "column 't_s'", "time is missing"}},
      {"t_s,motor_C\n0,inf\n", {"log.csv:2: ", "'inf' is not finite", "finite number"}},
      {"t_s,motor_C\n0,1e999\n", {"log.csv:2: ", "'1e999' is not finite"}},
      {"t_s,motor_C\n0,\"1\n", {"log.csv:2: ", "column 'motor_C'", "never closed", "closing '\"'"}},
      {"t_s,motor_C\n0,1\"2\n", {"log.csv:2: ", "column 'motor_C'", "a quote inside a field"}},
      {"t_s,power_param\n0,256\n",
       {"log.csv:2: ", "column 'power_param'", "expected 0..255", "--column power_param=power_param:1023"}},
      {"t_s,power_param\n0,60000\n", {"log.csv:2: ", "--column power_param=power_param:65535"}},
      {"t_s,power_param\n0,-1\n", {"log.csv:2: ", "expected 0..255"}},
      {"t_s,x\n0,1\n1,oops\n", {"log.csv:3: ", "column 'x'", "'oops' is not a number"}},
      {"t_s,motor_C\n0,warm\n", {"log.csv:2: ", "column 'motor_C'", "'warm' is not a number"}},
      {"\xff\xfet", {"log.csv:1: ", "UTF-16", "expected UTF-8"}},
      {"PK\x03\x04zip", {"log.csv:1: ", "ZIP", "expected CSV"}},
      {"t_s,note,motor_C\n0,\"a\nb\",1\n1,c,bad\n", {"log.csv:4: ", "column 'motor_C'", "'bad'"}},
  };
  for (const auto& one : cases) {
    const std::string message = error_of(one.text);
    CAPTURE(one.text, message);
    for (const auto& part : one.parts) CHECK_THAT(message, ContainsSubstring(part));
  }
  CHECK_THAT(error_of(nul), ContainsSubstring("'1\\x00' is not a number"));
}

TEST_CASE("a field without end is refused before it fills the memory") {
  const std::string quoted = "t_s,motor_C\n0,\"" + std::string(1 << 20, 'x');
  CHECK_THAT(error_of(quoted),
             ContainsSubstring("log.csv:2: column 'motor_C': the quote that opens this field is not closed"));
  const std::string plain = "t_s,motor_C\n0," + std::string(1 << 20, '1');
  CHECK_THAT(error_of(plain),
             ContainsSubstring("log.csv:2: column 'motor_C': field of more than 4096 bytes"));
}

TEST_CASE("an excerpt of binary junk is readable, short and pure ASCII") {
  const std::string message = error_of("t_s,motor_C\n0,\x01\x80\xff" + std::string(100, 'z') + "\n");
  CHECK_THAT(message, ContainsSubstring("'\\x01\\x80\\xff" + std::string(37, 'z') + "...' (103 bytes)"));
  for (const char c : message) CHECK(static_cast<unsigned char>(c) < 0x80);
}

TEST_CASE("what is no readable file is told apart") {
  const auto folder = std::filesystem::temp_directory_path();
  CHECK_THROWS_WITH(io::read_recording(folder.string()),
                    ContainsSubstring("is a directory; expected a CSV file"));
  CHECK_THROWS_WITH(io::read_recording((folder / "there is no such file").string()),
                    ContainsSubstring("cannot be read: No such file"));
}

TEST_CASE("columns go by other names and units where they are asked for so") {
  const auto choice = [](const char* text) { return io::parse_column_choice(text); };
  const std::string text = "stamp,temp,duty,current,motor_C\n0,77,0.5,-250,1\n1000,86,1,-500,2\n";
  const auto table = io::parse_csv("log.csv", text.data(), text.size(), io::known_columns(),
                                   {choice("t_s=stamp:ms"), choice("motor_C=temp:degF"),
                                    choice("power_param=duty:1"), choice("drive_A=current:-mA")});
  const Recording r = io::to_recording(table).recording;
  REQUIRE(r.rows() == 2);
  CHECK(r.t_s[1] == Approx(1.0));
  CHECK(r.column("motor_C")[0] == Approx(25.0));
  CHECK(r.column("motor_C")[1] == Approx(30.0));
  CHECK(r.column("power_param")[0] == Approx(127.5));
  CHECK(r.column("drive_A")[1] == Approx(0.5));
  CHECK(r.columns.size() == 3);  // the file's own motor_C gave way
}

TEST_CASE("words of a power and parts of a degree are units") {
  const std::string text = "t_s,power_param,motor_C,ambient_C\n0,1023,251,24500\n";
  const auto table = io::parse_csv("log.csv", text.data(), text.size(), io::known_columns(),
                                   {io::parse_column_choice("power_param=power_param:1023"),
                                    io::parse_column_choice("motor_C=motor_C:ddegC"),
                                    io::parse_column_choice("ambient_C=ambient_C:mdegC")});
  const Recording r = io::to_recording(table).recording;
  CHECK(r.column("power_param")[0] == Approx(255.0));
  CHECK(r.column("motor_C")[0] == Approx(25.1));
  CHECK(r.column("ambient_C")[0] == Approx(24.5));
}

TEST_CASE("what --column cannot mean is said") {
  const auto said = [](const char* text) {
    try {
      io::parse_column_choice(text);
    } catch (const io::InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  CHECK_THAT(said("motor_C"), ContainsSubstring("expected NAME=HEADER"));
  CHECK_THAT(said("motor_C=temp:degX"),
             ContainsSubstring("'degX' is not a unit of motor_C; expected one of degC"));
  CHECK_THAT(said("wind=fan:rpm"), ContainsSubstring("takes none"));
  CHECK(said("motor_C=temp") == "nothing");
  const std::string text = "t_s,a\n0,1\n";
  try {
    io::parse_csv("log.csv", text.data(), text.size(), io::known_columns(),
                  {io::parse_column_choice("motor_C=temp")});
    FAIL("a column that is not there");
  } catch (const io::InputError& error) {
    CHECK_THAT(error.what(),
               ContainsSubstring("log.csv:1: no column 'temp' in the header row (asked for as motor_C)"));
  }
}

TEST_CASE("semicolons, tabs, decimal commas and comments are read as the same numbers") {
  const io::CsvTable plain = parse("t_s,motor_C,run\n0,20.5,a\n1,,a\n2.5,-1e3,a\n");
  for (const char* text :
       {"t_s;motor_C;run\n0;20,5;a\n1;;a\n2,5;-1e3;a\n", "t_s;motor_C;run\n0;20.5;a\n1;;a\n2.5;-1e3;a\n",
        "t_s\tmotor_C\trun\n0\t20,5\ta\n1\t\ta\n2,5\t-1e3\ta\n",
        "# a rig, 3 runs; noon\n\n#\nt_s,motor_C,run\n# begin\n0,20.5,a\n1,,a\n#2,99,b\n2.5,-1e3,a\n# end",
        "# made by a program\n# t_s, motor_C, run\n0,20.5,1\n1,,1\n2.5,-1e3,1\n",
        "#t_s;motor_C;run\r\n0;20,5;1\r\n1;;1\r\n2,5;-1e3;1\r\n"}) {
    CAPTURE(text);
    const io::CsvTable other = parse(text);
    REQUIRE(other.rows == plain.rows);
    REQUIRE(other.columns.size() == 2);
    for (std::size_t column = 0; column < 2; ++column) {
      CHECK(other.columns[column].name == plain.columns[column].name);
      for (std::size_t row = 0; row < plain.rows; ++row) {
        const double a = plain.columns[column].values[row], b = other.columns[column].values[row];
        CHECK((a == b || (std::isnan(a) && std::isnan(b))));
      }
    }
    CHECK(other.run_labels.size() == 1);
  }
}

TEST_CASE("what might change a number a thousandfold is refused, and lines are still counted") {
  CHECK_THROWS_WITH(parse("t_s;motor_C\n0;20.5\n1;1,234\n"),
                    ContainsSubstring("log.csv:3: column 'motor_C'") &&
                        ContainsSubstring("another decimal separator than line 2"));
  CHECK_THROWS_WITH(parse("t_s;motor_C\n0;1.234,5\n"), ContainsSubstring("is not a number"));
  CHECK_THROWS_WITH(parse("# one\n# two\nt_s,motor_C\n# four\n0,1\n0,2\n"), ContainsSubstring("log.csv:6: "));
  CHECK_THROWS_WITH(parse("# only a comment"), ContainsSubstring("the file is empty"));
  // A quoted field that begins a line with '#' is no comment; a '#' inside a row begins none.
  const io::CsvTable quoted = parse("t_s,note\n0,\"two\n# lines\"\n1,a # b\n");
  CHECK(quoted.rows == 2);
  // A comment as long as the blocks in which files are read.
  const io::CsvTable broad =
      parse("t_s,x\n# " + std::string(200000, 'c') + "\n0,1\n" + "# " + std::string(70000, '#') + "\n1,2\n");
  CHECK(broad.rows == 2);
}

TEST_CASE("a file's columns are listed, and what they may be is proposed") {
  const std::string text =
      "stamp [ms];Motor Temp (degF);duty;jointVelocity_rad_s;cmd current;supply voltage;note;kettle;motor_C\n"
      "20;70;0,8;-3;1;12;a;5;1\n0;;0;3;2;12;b;6;2\n10;71;0,5;0;3;12;c;7;3\n";
  const std::vector<io::ListedColumn> list = io::list_columns("log.csv", text.data(), text.size());
  REQUIRE(list.size() == 9);
  const auto column = [&](const std::string& header) {
    for (const auto& one : list)
      if (one.header == header) return one;
    FAIL(header);
    return io::ListedColumn();
  };
  const auto check = [&](const char* header, const char* name, const char* unit) {
    CAPTURE(header);
    CHECK(column(header).proposed == name);
    CHECK(column(header).unit == unit);
  };
  check("stamp [ms]", "t_s", "ms");
  check("duty", "power_param", "1");
  check("jointVelocity_rad_s", "rate_dps", "rad/s");
  check("cmd current", "drive_A", "");
  check("supply voltage", "supply_V", "");
  check("kettle", "", "");
  check("motor_C", "motor_C", "");
  check("Motor Temp (degF)", "", "");  // the one of that name is it
  CHECK(column("note").text);
  CHECK(column("Motor Temp (degF)").missing == 1);
  CHECK(column("jointVelocity_rad_s").least == -3.0);
  const std::string shown = io::columns_text(list);
  CHECK_THAT(shown, ContainsSubstring("--column 't_s=stamp [ms]:ms'") &&
                        ContainsSubstring("--column rate_dps=jointVelocity_rad_s:rad/s") &&
                        !ContainsSubstring("No column looks like time"));
  // What is proposed is what the option reads.
  for (const auto& one : list)
    if (!one.proposed.empty() && !one.unit.empty())
      CHECK(io::parse_column_choice(one.proposed + "=" + one.header + ":" + one.unit).header == one.header);
}

TEST_CASE("a row that is there twice is left out, and where the clock begins anew a run does") {
  std::string twice = "t_s,motor_C,x\n0,20,\n1,21,1\n1,21,1\n2,22,2\n3,23,\n3,23,\n3,23,\n4,24,\n";
  const io::RecordingFile mended = io::to_recording(parse(twice));
  REQUIRE(mended.recording.rows() == 5);
  CHECK(mended.recording.t_s[4] == 4.0);
  CHECK(mended.recording.column("motor_C")[4] == 24.0);
  CHECK(mended.recording.column("x").size() == 5);
  REQUIRE(mended.findings.size() == 1);
  CHECK(mended.findings[0].kind == FindingKind::repeated_frames);
  CHECK(mended.findings[0].action == FindingAction::masked);
  CHECK_THAT(mended.findings[0].message, ContainsSubstring("3 rows are") && ContainsSubstring("line 4"));

  std::string restarted = "t_s,motor_C\n";
  for (const int first : {10, 0, 5})
    for (int i = 0; i < 12; ++i) restarted += std::to_string(first + 10 * i) + "," + std::to_string(i) + "\n";
  const io::RecordingFile cut = io::to_recording(parse(restarted));
  REQUIRE(cut.recording.runs.size() == 3);
  CHECK(cut.recording.runs[1].begin == 12);
  CHECK(cut.recording.runs[2].begin == 24);
  REQUIRE(cut.findings.size() == 1);
  CHECK(cut.findings[0].kind == FindingKind::gap_in_stamps);
  CHECK(cut.findings[0].action == FindingAction::segmented);
  REQUIRE(cut.findings[0].rows.size() == 2);
  CHECK(cut.findings[0].rows[0].begin == 12);
  CHECK_THAT(cut.findings[0].message, ContainsSubstring("2 times") && ContainsSubstring("line 14"));
}

TEST_CASE("what a column may be in is told by words and ranges") {
  const auto proposals = [](const std::string& header, const std::string& first, const std::string& last) {
    const std::string text = header + "\n" + first + "\n" + last + "\n";
    std::string all;
    for (const io::ListedColumn& one : io::list_columns("log.csv", text.data(), text.size()))
      all += (all.empty() ? "" : " ") + (one.proposed.empty() ? "-" : one.proposed) +
             (one.unit.empty() ? "" : ":" + one.unit);
    return all;
  };
  CHECK(proposals("time", "0", "4200000") == "t_s:ms");
  CHECK(proposals("t_s", "0", "4200000") == "t_s:ms");
  CHECK(proposals("t_s", "0", "4200") == "t_s");
  CHECK(proposals("time", "0", "4200000000") == "t_s:us");
  CHECK(proposals("time", "1764000000", "1764000600") == "t_s");
  CHECK(proposals("time", "1764000000000", "1764000600000") == "t_s:ms");
  CHECK(proposals("stamp", "1764000000000000000", "1764000600000000000") == "t_s:ns");
  CHECK(proposals("duty_pct", "0", "0.9") == "power_param:%");
  CHECK(proposals("duty", "0", "1023") == "-");
  CHECK(proposals("power_param", "0", "80") == "power_param");
  CHECK(proposals("power_param", "0", "0.8") == "power_param:1");
  CHECK(proposals("Tamb (K)", "293", "294") == "ambient_C:K");
  CHECK(proposals("T_amb", "293", "294") == "ambient_C:K");
  CHECK(proposals("T_amb", "20", "21") == "ambient_C");
  CHECK(proposals("Tmotor", "300", "340") == "motor_C:K");
  CHECK(proposals("current", "-3", "850") == "current_A:mA");
  CHECK(proposals("current_A", "0", "2") == "current_A");
}
