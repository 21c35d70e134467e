// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Wrong inputs of the program, and the answer each should get: the table is wrong_inputs.txt.

#include "../catch.hpp"
#include "../../tools/thermopower-gap/text_file.hpp"

#include <sys/stat.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

struct Row {
  int line = 0;
  std::string kind, input, expected;
  int status = 0;
};

const std::string good_model =
    R"({"format": "thermopower-model/1", "name": "motor", "supply": {"nominal_V": 13.0},
 "current": {"law": "ohmic", "resistance_ohm": 8.2, "tempco_per_K": 0.0039, "reference_C": 25.0},
 "thermal": {"law": "lumped", "heat_capacity_J_per_K": 60.0, "conductance_W_per_K": 0.11},
 "axis": {"law": "rigid", "inertia_kgm2": 1e-3, "viscous_Nms_per_rad": 1e-3, "torque_constant_Nm_per_A": 0.2},
 "effects": {"series_resistance": {"ohm": 0.5}}})";
const std::string good_csv =
    "t_s,power_param,ambient_C,motor_C,current_A\n0,100,25,25,1\n1,100,25,26,1\n2,100,25,27,1\n";

std::string unescaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      out += text[i];
      continue;
    }
    const char next = text[++i];
    if (next == 'x') {
      out += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += next == 'n' ? '\n' : next == 'r' ? '\r' : next == 't' ? '\t' : next;
    }
  }
  return out;
}

std::vector<Row> table() {
  std::ifstream file(THERMOPOWER_WRONG_INPUTS);
  std::vector<Row> rows;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> fields;
    std::size_t from = 0;
    for (std::size_t at; (at = line.find(" | ", from)) != std::string::npos; from = at + 3)
      fields.push_back(line.substr(from, at - from));
    fields.push_back(line.substr(from));
    INFO("wrong_inputs.txt:" << number);
    REQUIRE(fields.size() == 4);
    rows.push_back({number, fields[0], fields[1], fields[3], std::stoi(fields[2])});
  }
  return rows;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

void write(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

}  // namespace

TEST_CASE("every wrong input gets the answer that the table says, and leaves no output behind") {
  const fs::path work = fs::temp_directory_path() / "thermopower_wrong_inputs";
  fs::remove_all(work);
  fs::create_directories(work / "directory");
  REQUIRE(mkfifo((work / "pipe").c_str(), 0600) == 0);
  const std::vector<Row> rows = table();
  REQUIRE(rows.size() >= 200);
  for (const Row& row : rows) {
    fs::remove(work / "out.csv");
    write(work / "model.json", good_model);
    write(work / "recording.csv", good_csv);
    write(work / "robot.xml", "<mujoco model=\"arm\"><worldbody/></mujoco>");
    std::string arguments = "predict --model model.json --recording recording.csv --predictions out.csv";
    if (row.kind == "args") {
      arguments = row.input;
    } else if (row.kind == "csv") {
      write(work / "recording.csv", unescaped(row.input));
    } else if (row.kind == "json") {
      write(work / "model.json", unescaped(row.input));
    } else {
      INFO("wrong_inputs.txt:" << row.line);
      REQUIRE(row.kind == "model");
      const std::size_t arrow = row.input.find(" -> ");
      REQUIRE(arrow != std::string::npos);
      const std::string from = row.input.substr(0, arrow);
      REQUIRE(good_model.find(from) != std::string::npos);
      write(work / "model.json", replaced(good_model, from, unescaped(row.input.substr(arrow + 4))));
    }
    const std::string command = "cd '" + work.string() + "' && timeout 60 '" THERMOPOWER_GAP_PROGRAM "' " +
                                replaced(arguments, "> ", ">") + " 2>error.txt" +
                                (arguments.find('>') == std::string::npos ? " >said.txt" : "");
    const int result = std::system(command.c_str());
    const std::string error = read_text(work / "error.txt");
    CAPTURE(row.line, row.input, error);
    REQUIRE(WIFEXITED(result));
    CHECK(WEXITSTATUS(result) == row.status);
    CHECK(error.find(row.expected) != std::string::npos);
    CHECK(error.size() < 1000);  // one line for a person, not a page
    CHECK_FALSE(fs::exists(work / "out.csv"));
  }
}

TEST_CASE("wrong inputs of a whole robot name the option, the joint and what there is instead") {
  const fs::path work = fs::temp_directory_path() / "thermopower_wrong_robots";
  fs::remove_all(work);
  fs::create_directories(work);
  write(
      work / "arm.xml",
      "<mujoco model=\"arm\"><worldbody><body><joint name=\"shoulder\" axis=\"0 1 0\"/><geom size=\"0.1\"/>"
      "<body pos=\"0.3 0 0\"><joint name=\"elbow\" axis=\"0 1 0\"/><geom size=\"0.1\"/></body></body></worldbody></mujoco>");
  write(work / "log.csv",
        "t_s,shoulder/position_rad,elbow/position_rad\n0,0,0\n0.01,0.01,0.02\n0.02,0.02,0.04\n");
  const auto said = [&work](const std::string& arguments, int status) {
    const std::string command = "cd '" + work.string() + "' && '" THERMOPOWER_GAP_PROGRAM "' " + arguments +
                                " --recording log.csv >said.txt 2>&1";
    const int result = std::system(command.c_str());
    const std::string text = read_text(work / "said.txt");
    CAPTURE(arguments, text);
    if (text.find("which this program was built without") == std::string::npos)
      CHECK(WEXITSTATUS(result) == status);
    return text;
  };
  const std::string first = said("check --mjcf arm.xml --kp knee=3", 2);
  if (first.find("which this program was built without") != std::string::npos) return;
  CHECK(first.find("--kp: the robot has no joint 'knee'; it has shoulder, elbow") != std::string::npos);
  const struct {
    const char *arguments, *expected;
    int status;
  } rows[] = {
      {"check --mjcf arm.xml --kp elbw=3", "did you mean elbow?", 2},
      {"check --mjcf arm.xml --kp=-3", "--kp: '-3' is not a gain; expected a number, 0 or more", 2},
      {"check --mjcf arm.xml --joint elbow=knee",
       "--joint elbow=knee: the robot has no joint 'knee'; it has shoulder, elbow", 2},
      {"check --mjcf arm.xml --joint knee=elbow", "no column of the log has 'knee' in its header", 2},
      {"check --mjcf arm.xml --report r.json", "--report: the check of a robot's wiring is printed", 2},
      {"check --mjcf arm.xml --column motor_C=x", "--column is of a single actuator", 2},
      {"check --mjcf arm.xml",
       "The log is too short for any statement: 3 rows; expected a run of at least 60", 4},
      {"check --mjcf absent.xml", "absent.xml: cannot be read: No such file or directory", 3},
      {"check --mjcf log.csv", "log.csv: is not a robot; expected an MJCF file (<mujoco>)", 3},
      {"diagnose --mjcf arm.xml --without cogging", "--without is of a single actuator; leave it out", 2},
      {"diagnose --mjcf arm.xml --horizon 2", "--horizon is of a single actuator", 2},
      {"diagnose --mjcf arm.xml --predictions p.csv", "--predictions is of a single actuator", 2},
      {"diagnose --mjcf arm.xml --isaac a.py --mjlab ./a.py", "named twice", 2},
      {"diagnose --mjcf arm.xml --augmented arm.xml", "named twice", 2},
      {"diagnose --mjcf arm.xml --html log.csv", "named twice", 2},
  };
  for (const auto& row : rows) {
    const std::string text = said(row.arguments, row.status);
    CAPTURE(row.arguments, text);
    CHECK(text.find(row.expected) != std::string::npos);
  }
}

TEST_CASE("what the table spoils is in order before") {
  const fs::path work = fs::temp_directory_path() / "thermopower_right_inputs";
  fs::remove_all(work);
  fs::create_directories(work);
  write(work / "model.json", good_model);
  write(work / "recording.csv", good_csv);
  const std::string predict = "cd '" + work.string() +
                              "' && '" THERMOPOWER_GAP_PROGRAM
                              "' predict --model model.json --recording recording.csv --predictions out.csv";
  REQUIRE(std::system(predict.c_str()) == 0);
  CHECK(read_text(work / "out.csv").rfind("t_s,", 0) == 0);

  // Inputs alone are enough: the motor starts at the air's temperature, or where one says.
  write(work / "recording.csv", "t_s,power_param,ambient_C\n0,100,21.5\n1,100,21.5\n2,100,21.5\n");
  REQUIRE(std::system(predict.c_str()) == 0);
  std::istringstream lines(read_text(work / "out.csv"));
  std::string header, first;
  std::getline(lines, header);
  std::getline(lines, first);
  CHECK(header.find("motor_C_augmented") != std::string::npos);
  CHECK(first.find("21.5") != std::string::npos);
  REQUIRE(std::system((predict + " --start motor_C=40.25").c_str()) == 0);
  CHECK(read_text(work / "out.csv").find("40.25") != std::string::npos);

  // An axis that the program wrote may be written again.
  const std::string export_axis =
      "cd '" + work.string() +
      "' && '" THERMOPOWER_GAP_PROGRAM
      "' export --model model.json --mjcf axis.xml --urdf axis.urdf 2>left_out.txt";
  REQUIRE(std::system(export_axis.c_str()) == 0);
  CHECK(std::system(export_axis.c_str()) == 0);
}

TEST_CASE("a covariate may be called anything that is no name of the format") {
  const fs::path work = fs::temp_directory_path() / "thermopower_covariate_names";
  fs::remove_all(work);
  fs::create_directories(work);
  write(work / "model.json", good_model);
  write(work / "recording.csv",
        "t_s,power_param,ambient_C,motor_C,fan\n0,100,25,25,1\n1,100,25,26,1\n2,100,25,27,1\n");
  const std::string predict = "cd '" + work.string() +
                              "' && '" THERMOPOWER_GAP_PROGRAM
                              "' predict --model model.json --recording recording.csv --predictions out.csv";
  CHECK(std::system((predict + " --column gyro=fan --column current_A=fan 2>error.txt").c_str()) != 0);
  CHECK(std::system((predict + " --column gyro=fan").c_str()) == 0);
}

TEST_CASE("what is predicted from inputs with missing cells comes with a warning") {
  const fs::path work = fs::temp_directory_path() / "thermopower_missing_inputs";
  fs::remove_all(work);
  fs::create_directories(work);
  write(work / "model.json", good_model);
  const std::string predict =
      "cd '" + work.string() +
      "' && '" THERMOPOWER_GAP_PROGRAM
      "' predict --model model.json --recording recording.csv --predictions out.csv 2>error.txt";
  write(work / "recording.csv", good_csv);
  REQUIRE(std::system(predict.c_str()) == 0);
  CHECK(read_text(work / "error.txt").empty());
  write(work / "recording.csv", "t_s,power_param,ambient_C\n0,100,21\n1,,21\n2,100,21\n");
  REQUIRE(std::system(predict.c_str()) == 0);
  CHECK(read_text(work / "error.txt")
            .find("recording.csv: column 'power_param': 1 of 3 cells are missing, first at t_s = 1") !=
        std::string::npos);
}
