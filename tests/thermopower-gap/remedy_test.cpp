// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// What a finding says to type works when it is typed, in the place of the options and besides them.

#include "../catch.hpp"

#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/remedy.hpp>

#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace io = thermopower::io;
namespace fs = std::filesystem;

namespace {

std::string in_force(const std::string& mend, const std::vector<std::string>& columns) {
  io::ReadOptions how;
  for (const std::string& one : columns) how.choices.push_back(io::parse_column_choice(one));
  return io::remedy_in_force(mend, how);
}

struct Ran {
  int status;
  std::string text;
};

Ran run(const std::string& arguments) {
  const std::string command = std::string("\"") + THERMOPOWER_GAP_PROGRAM + "\" " + arguments + " 2>&1";
  Ran ran{0, {}};
  FILE* const pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  char part[4096];
  while (const std::size_t n = std::fread(part, 1, sizeof part, pipe)) ran.text.append(part, n);
  const int status = pclose(pipe);
  ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ran;
}

/// The remedy as the screen has it, its lines joined.
std::string remedy_on(const std::string& screen) {
  std::string text;
  for (const char c : screen) {
    const bool blank = c == ' ' || c == '\n';
    if (!blank || (!text.empty() && text.back() != ' ')) text += blank ? ' ' : c;
  }
  const std::string mark = "To mend it: ";
  const std::size_t at = text.find(mark + "--column");
  if (at == std::string::npos) return {};
  // Options follow each other; the first word that is none ends them.
  std::string out;
  std::size_t from = at + mark.size();
  while (text.compare(from, 9, "--column ") == 0) {
    const std::size_t end = std::min(text.find(' ', from + 9), text.size());
    out += (out.empty() ? "" : " ") + text.substr(from, end - from);
    from = end + 1;
    if (from >= text.size()) break;
  }
  return out;
}

/// A joint of 0.012 kg m^2 driven by steps of current, its angle and rate in radians, under names of a robot's program.
std::string joint_in_radians() {
  std::string csv = "stamp_ms,cmd,joint_pos,joint_vel\n";
  double angle = 0.0, rate = 0.0;
  unsigned random = 7;
  double current = 0.0;
  for (int i = 0; i < 3000; ++i) {
    if (i % 40 == 0) {
      random = random * 1103515245u + 12345u;
      current = static_cast<double>((random >> 16) % 401) / 100.0 - 2.0;
    }
    char row[120];
    std::snprintf(row, sizeof row, "%d,%.6g,%.9g,%.9g\n", 5 * i, current, angle, rate);
    csv += row;
    for (int k = 0; k < 10; ++k) {
      rate += 0.0005 * (0.9 * current - 0.03 * rate) / 0.012;
      angle += 0.0005 * rate;
    }
  }
  return csv;
}

}  // namespace

TEST_CASE("a remedy is said in the columns of the file, and the other choices stay in force") {
  CHECK(in_force("--column angle_deg=angle_deg:rad", {"t_s=stamp:ms", "angle_deg=pos"}) ==
        "--column angle_deg=pos:rad --column t_s=stamp:ms");
  CHECK(in_force("--column drive_A=drive_A:-A", {"drive_A=current:mA"}) == "--column drive_A=current:-mA");
  CHECK(in_force("--column drive_A=drive_A:-A", {"drive_A=current:A*0.02"}) ==
        "--column 'drive_A=current:-A*0.02'");
  CHECK(in_force("--column drive_A=drive_A:mA", {"drive_A=raw:A*0.5"}) == "--column 'drive_A=raw:A*5e-04'");
  CHECK(in_force("--column angle_deg=rate_dps --column rate_dps=angle_deg",
                 {"angle_deg=a:rad", "rate_dps=b:rad/s"}) ==
        "--column angle_deg=b:rad --column rate_dps=a:rad/s");
  CHECK(in_force("--column rate_dps=rate_dps:-deg/s", {"rate_dps=speed:4096/s,sign15"}).find(",sign15") !=
        std::string::npos);
  CHECK(in_force("--column drive_A=rate_dps --column rate_dps=drive_A", {"drive_A=a", "rate_dps=b"}) ==
        "--column drive_A=b --column rate_dps=a");
  CHECK(in_force("--column motor_C=motor_C:degF", {"motor_C=Winding Temp"}) ==
        "--column 'motor_C=Winding Temp:degF'");
  CHECK(in_force("--column motor_C=motor_C:degF", {}) == "--column motor_C=motor_C:degF");
  CHECK(in_force("record once more", {"motor_C=x"}) == "record once more");
  // Words around it stay.
  CHECK(in_force("sample faster (--column t_s=t_s:ms)", {"t_s=stamp"}) ==
        "sample faster (--column t_s=stamp:ms)");
}

TEST_CASE("a column that was given as a constant, or a time by a rate, has its option") {
  io::ReadOptions how;
  how.choices = {io::parse_column_choice("motor_C=temp")};
  how.constants = {{"ambient_C", 71.6}, {"supply_V", 12000.0}, {"airspeed_mps", 2.0}};
  how.rows_per_s = 0.2;
  CHECK(io::remedy_in_force("--column motor_C=motor_C:degF --column ambient_C=ambient_C:degF", how) ==
        "--column motor_C=temp:degF --ambient 22 --supply 12000 --constant airspeed_mps=2 --rate 0.2");
  CHECK(io::remedy_in_force("--column supply_V=supply_V:mV", how) ==
        "--supply 12 --column motor_C=temp --ambient 71.6 --constant airspeed_mps=2 --rate 0.2");
  CHECK(io::remedy_in_force("sample faster (--column t_s=t_s:ms), or judge longer: --horizon 40", how) ==
        "sample faster (--rate 200), or judge longer: --horizon 40");
}

TEST_CASE("Python is told its own arguments") {
  io::ReadOptions how;
  how.choices = {io::parse_column_choice("motor_C=it's warm"), io::parse_column_choice("t_s=stamp:ms")};
  how.constants = {{"ambient_C", 71.6}};
  const auto told = [&](const std::string& mend) {
    return io::remedy_in_force(mend, how, io::Caller::python);
  };
  CHECK(told("--column motor_C=motor_C:degF --column ambient_C=ambient_C:degF") ==
        "columns=['motor_C=it\\'s warm:degF', 't_s=stamp:ms'], constants={'ambient_C': 22}");
  CHECK(told("sample faster, or judge over longer windows: --horizon 40") ==
        "sample faster, or judge over longer windows: horizon_s=40");
  CHECK(told("hold out another recording, or leave --heldout away") ==
        "hold out another recording, or leave held_out away");
  CHECK(told("look at its unit, and at what --column makes of it") ==
        "look at its unit, and at what columns makes of it");
  CHECK(told("'thermopower-gap columns FILE' proposes options --column NAME=HEADER:UNIT") ==
        "thermopower.columns(path) proposes columns=['NAME=HEADER:UNIT']");
}

TEST_CASE("the remedy of a wrong unit is pasted, and the data can be believed") {
  const fs::path folder = fs::temp_directory_path() / "thermopower_remedy_test";
  fs::create_directories(folder);
  std::ofstream(folder / "log.csv") << joint_in_radians();
  std::ofstream(folder / "model.json") << R"({"format": "thermopower-model/1",
    "axis": {"law": "rigid", "inertia_kgm2": 0.012, "viscous_Nms_per_rad": 0.03, "torque_constant_Nm_per_A": 0.9}})";
  const std::string base =
      "check --model " + (folder / "model.json").string() + " --recording " + (folder / "log.csv").string();
  const std::string columns =
      " --column t_s=stamp_ms:ms --column drive_A=cmd --column angle_deg=joint_pos --column rate_dps=joint_vel";
  const Ran wrong = run(base + columns);
  REQUIRE(wrong.status == 4);
  const std::string mend = remedy_on(wrong.text);
  CAPTURE(wrong.text, mend);
  REQUIRE_FALSE(mend.empty());
  const Ran instead = run(base + " " + mend), besides = run(base + columns + " " + mend);
  CAPTURE(instead.text);
  CHECK(instead.status == 0);
  CHECK(besides.status == 0);
  fs::remove_all(folder);
}
