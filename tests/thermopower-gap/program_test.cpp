// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include "../gap/plants.hpp"
#include <thermopower/io/model_file.hpp>

#include <nlohmann/json.hpp>

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

using namespace thermopower::gap;
namespace io = thermopower::io;
namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::string csv(const Recording& r) {
  std::ostringstream out;
  out.precision(10);
  out << "t_s";
  for (const auto& column : r.columns) out << "," << column.name;
  out << "\n";
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    out << r.t_s[i];
    for (const auto& column : r.columns) out << "," << column.values[i];
    out << "\n";
  }
  return out.str();
}

/// A folder with a model and recordings, gone when the test is over.
struct Folder {
  fs::path path;
  explicit Folder(const char* name)
      : path(fs::temp_directory_path() / (std::string("thermopower_gap_") + name)) {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }

  void bench(const test::BenchFault& fault) const {
    write(path / "model.json", io::to_json(test::bench_model()));
    write(path / "train.csv", csv(test::bench_recording(fault, 900, 1)));
    write(path / "heldout.csv", csv(test::bench_recording(fault, 600, 2)));
  }

  struct Result {
    int status;
    std::string out, error;
  };

  Result run(const std::string& arguments) const {
    const std::string command =
        "cd '" + path.string() + "' && '" THERMOPOWER_GAP_PROGRAM "' " + arguments + " > stdout 2> stderr";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(path / "stdout"), text_of(path / "stderr")};
  }

  std::size_t count() const {
    std::size_t n = 0;
    for (const auto& entry : fs::directory_iterator(path))
      n += entry.path().filename() != "stdout" && entry.path().filename() != "stderr" ? 1 : 0;
    return n;
  }
};

const std::string inputs = "--model model.json --recording train.csv --heldout heldout.csv ";
const std::string outputs =
    "--report report.json --html report.html --predictions predictions.csv --augmented augmented.json --header motor_model.hpp ";

}  // namespace

TEST_CASE("a loss that grows with the rise is diagnosed from files to files") {
  const Folder folder("whole");
  test::BenchFault fault;
  fault.series_ohm = 1.5;
  folder.bench(fault);
  const auto first = folder.run("diagnose " + inputs + outputs + "--threads 1");
  CAPTURE(first.out, first.error);
  REQUIRE(first.status == 0);
  CHECK(first.error.empty());
  CHECK_THAT(first.out, ContainsSubstring("series_resistance"));

  SECTION("the report names signal, submodel and effect, and how far the gap shrinks") {
    const auto report = nlohmann::json::parse(text_of(folder.path / "report.json"));
    CHECK(report["verdict"] == "explained");
    CHECK(report["where"][0]["signal"] == "current_A");
    CHECK(report["where"][0]["submodel"] == "electrical");
    REQUIRE(report["cause"].size() == 1);
    CHECK(report["cause"][0]["effect"] == "series_resistance");
    const auto& ohm = report["cause"][0]["parameters"]["ohm"];
    CHECK(ohm["ci95"][0].get<double>() < ohm["value"].get<double>());
    CHECK(ohm["value"].get<double>() == Approx(1.5).epsilon(0.25));
    CHECK(report["gap"]["current_A"]["shrunk_by"].get<double>() > 0.8);
    CHECK(report["gap"]["current_A"]["after"].get<double>() <
          1.3 * report["gap"]["current_A"]["noise_floor"].get<double>());
  }
  SECTION("one thread or two, once or twice: the same bytes") {
    std::vector<std::string> before;
    const std::vector<std::string> names = {"report.json", "report.html", "predictions.csv", "augmented.json",
                                            "motor_model.hpp"};
    for (const auto& name : names) before.push_back(text_of(folder.path / name));
    REQUIRE(folder.run("diagnose " + inputs + outputs + "--threads 2").status == 0);
    for (std::size_t i = 0; i < names.size(); ++i) {
      CAPTURE(names[i]);
      CHECK(text_of(folder.path / names[i]) == before[i]);
    }
  }
  SECTION("predict gives the augmented predictions again") {
    REQUIRE(
        folder.run("predict --model augmented.json --recording heldout.csv --predictions again.csv").status ==
        0);
    std::istringstream one(text_of(folder.path / "predictions.csv")), two(text_of(folder.path / "again.csv"));
    std::string a, b;
    std::getline(one, a);
    std::getline(two, b);
    CHECK(a == b);
    CHECK(a == "t_s,current_A_baseline,current_A_augmented,motor_C_baseline,motor_C_augmented");
    int rows = 0;
    const auto cell = [](const std::string& row, int column) {
      std::istringstream cells(row);
      std::string text;
      for (int i = 0; i <= column; ++i) std::getline(cells, text, ',');
      return text;
    };
    while (std::getline(one, a) && std::getline(two, b)) {
      ++rows;
      for (const int column : {0, 2, 4}) REQUIRE(cell(a, column) == cell(b, column));
    }
    CHECK(rows == 600);
  }
  SECTION("the header compiles as C++11") {
    write(
        folder.path / "use.cpp",
        "#include \"motor_model.hpp\"\nint main() { return motor_model::Motor::current().current_A(0.0f, 25.0f) == 0.0f ? 0 : 1; }\n");
    const std::string command = "cd '" + folder.path.string() +
                                "' && c++ -std=c++11 -Wall -Wextra -Werror -I'" THERMOPOWER_INCLUDE
                                "' use.cpp -o use && ./use";
    CHECK(std::system(command.c_str()) == 0);
    if (std::system("avr-gcc --version > /dev/null 2>&1") == 0) {
      const std::string avr =
          "cd '" + folder.path.string() +
          "' && avr-gcc -std=gnu++11 -mmcu=atmega328p -Os -Wall -Wextra -Werror -I'" THERMOPOWER_INCLUDE
          "' -c use.cpp -o use.o";
      CHECK(std::system(avr.c_str()) == 0);
    }
  }
  SECTION("an effect taken from the catalogue is not found") {
    REQUIRE(folder.run("diagnose " + inputs + "--report without.json --without series_resistance").status ==
            0);
    const auto report = nlohmann::json::parse(text_of(folder.path / "without.json"));
    CHECK_THAT(report["cause"].dump(), !ContainsSubstring("series_resistance"));
    CHECK_THAT(report["alternatives"].dump(), !ContainsSubstring("series_resistance"));
  }
  SECTION("without held-out files the end of the recording is held out") {
    REQUIRE(folder.run("diagnose --model model.json --recording train.csv --predictions own.csv").status ==
            0);
    const std::string own = text_of(folder.path / "own.csv");
    const auto rows = static_cast<double>(std::count(own.begin(), own.end(), '\n') - 1);
    CHECK(rows > 900 * 0.2);
    CHECK(rows < 900 * 0.4);
  }
}

namespace {

/// Columns of a CSV file by their names; an empty cell is NaN.
std::map<std::string, std::vector<double>> columns_of(const fs::path& path) {
  std::ifstream file(path);
  std::string line, cell;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> columns;
  std::getline(file, line);
  std::istringstream header(line);
  while (std::getline(header, cell, ',')) names.push_back(cell);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    for (const std::string& name : names) {
      cell.clear();
      std::getline(cells, cell, ',');
      columns[name].push_back(cell.empty() ? std::nan("") : std::stod(cell));
    }
  }
  return columns;
}

}  // namespace

TEST_CASE("a report's score is that of its own predictions, though its data have holes and spikes") {
  const Folder folder("honest");
  test::BenchFault fault;
  fault.series_ohm = 1.5;
  folder.bench(fault);
  const Recording whole = test::bench_recording(fault, 600, 2);
  Recording broken;
  std::vector<Eigen::Index> kept;  // an hour at another power was not logged
  for (Eigen::Index i = 0; i < whole.rows(); ++i)
    if (i < 130 || i >= 260) kept.push_back(i);
  const auto rows = static_cast<Eigen::Index>(kept.size());
  broken.t_s.resize(rows);
  for (Eigen::Index i = 0; i < rows; ++i) broken.t_s[i] = whole.t_s[kept[static_cast<std::size_t>(i)]];
  for (const auto& column : whole.columns) {
    Eigen::VectorXd values(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      values[i] = column.values[kept[static_cast<std::size_t>(i)]];
      if (column.name == "motor_C" && i % 40 == 17) values[i] += 15.0;
    }
    broken.set(column.name, values);
  }
  write(folder.path / "heldout.csv", csv(broken));
  REQUIRE(folder.run("diagnose " + inputs + "--report report.json --predictions predictions.csv").status ==
          0);
  const auto report = nlohmann::json::parse(text_of(folder.path / "report.json"));
  std::map<std::string, std::vector<bool>> masked;
  bool segmented = false;
  for (const auto& finding : report["findings"]) {
    if (finding["recording"] != "heldout.csv") continue;
    segmented = segmented || finding["action"] == "segmented";
    std::vector<bool>& mask = masked[finding["column"].get<std::string>()];
    mask.resize(static_cast<std::size_t>(rows), false);
    for (const auto& range : finding["rows"])
      for (auto i = range[0].get<std::size_t>(); finding["action"] == "masked" && i < range[1]; ++i)
        mask[i] = true;
  }
  REQUIRE(segmented);
  REQUIRE(masked.count("motor_C") == 1);
  REQUIRE(std::count(masked["motor_C"].begin(), masked["motor_C"].end(), true) > 5);
  auto predicted = columns_of(folder.path / "predictions.csv"),
       measured = columns_of(folder.path / "heldout.csv");
  REQUIRE(predicted["t_s"].size() == static_cast<std::size_t>(rows));
  for (const char* signal : {"current_A", "motor_C"})
    for (const auto& [column, score] : {std::pair("_baseline", "before"), std::pair("_augmented", "after")}) {
      CAPTURE(signal, score);
      double squares = 0.0, count = 0.0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(rows); ++i) {
        const double error = predicted[std::string(signal) + column][i] - measured[signal][i];
        const auto mask = masked.find(signal);
        if (!std::isfinite(error) || (mask != masked.end() && mask->second[i])) continue;
        squares += error * error;
        count += 1.0;
      }
      CHECK(std::sqrt(squares / count) == Approx(report["gap"][signal][score].get<double>()).epsilon(1e-6));
    }
}

TEST_CASE("a motor that matches has no gap, and nothing is accused") {
  const Folder folder("none");
  folder.bench({});
  REQUIRE(folder.run("diagnose " + inputs + "--report report.json").status == 0);
  const auto report = nlohmann::json::parse(text_of(folder.path / "report.json"));
  CHECK(report["verdict"] == "no_gap");
  CHECK(report["cause"].empty());
  CHECK(report["where"].empty());
}

TEST_CASE("what a recording lacks is not judged, and the report says so") {
  const Folder folder("lacking");
  folder.bench({});
  for (const char* name : {"train.csv", "heldout.csv"}) {
    Recording r = test::bench_recording({}, 600, name == std::string("train.csv") ? 5 : 6);
    r.remove("current_A");
    write(folder.path / name, csv(r));
  }
  REQUIRE(folder.run("diagnose " + inputs + "--report report.json").status == 0);
  const auto report = nlohmann::json::parse(text_of(folder.path / "report.json"));
  CHECK_FALSE(report["gap"].contains("current_A"));
  CHECK_THAT(report["not_judged"].dump(), ContainsSubstring("current_A"));
}

TEST_CASE("exit statuses and messages, and nothing half-written") {
  const Folder folder("faulty");
  folder.bench({});
  write(folder.path / "broken.csv", "t_s,motor_C\n0,1\n1,hot\n");
  write(folder.path / "broken.json", "{\"format\": ");
  write(folder.path / "short.csv",
        "t_s,power_param,current_A,motor_C,ambient_C\n0,100,0.5,20,20\n2,100,0.5,20,20\n");
  const std::size_t files_before = folder.count();
  struct Case {
    std::string arguments;
    int status;
    std::string part;
  };
  const std::vector<Case> cases = {
      {"", 2, "subcommand"},
      {"diagnose", 2, "--recording"},
      {"diagnose " + inputs + "--horizont 3", 2, "horizont"},
      {"diagnose " + inputs + "--horizon -1", 2, "horizon"},
      {"diagnose " + inputs + "--without gremlins", 2, "no effect 'gremlins'"},
      {"diagnose " + inputs + "--report x --html x", 2, "named twice"},
      {"diagnose " + inputs + "--report train.csv", 2, "named twice"},
      {"diagnose --model model.json --recording nowhere.csv --report report.json", 3,
       "nowhere.csv: cannot be read"},
      {"diagnose --model nowhere.json --recording train.csv --report report.json", 3,
       "nowhere.json: cannot be read"},
      {"diagnose --model model.json --recording broken.csv --report report.json", 3,
       "broken.csv:3: column 'motor_C': 'hot' is not a number"},
      {"diagnose --model broken.json --recording train.csv --report report.json", 3,
       "broken.json:1:12: not JSON"},
      {"diagnose --model model.json --recording . --report report.json", 3, "is a directory"},
      {"diagnose " + inputs + "--report 'no such folder/report.json'", 3,
       "no such folder/report.json: cannot be written"},
      {"predict --model model.json --recording broken.csv --predictions p.csv", 3, "broken.csv:3"},
  };
  for (const auto& one : cases) {
    const auto result = folder.run(one.arguments);
    CAPTURE(one.arguments, result.out, result.error);
    CHECK(result.status == one.status);
    CHECK_THAT(result.error, ContainsSubstring(one.part));
    CHECK(folder.count() == files_before);
  }
  const auto little = folder.run(
      "diagnose --model model.json --recording short.csv --heldout short.csv --report report.json");
  CHECK(little.status == 4);
  CHECK(nlohmann::json::parse(text_of(folder.path / "report.json"))["verdict"] == "insufficient");
}

TEST_CASE("check says what the data can show, and what would mend them") {
  const Folder folder("check");
  folder.bench({});
  const auto sound = folder.run("check " + inputs + "--report check.json");
  CAPTURE(sound.out, sound.error);
  REQUIRE(sound.status == 0);
  CHECK_THAT(sound.out, ContainsSubstring("heat_capacity"));
  CHECK_THAT(sound.out, ContainsSubstring("can show"));
  CHECK_THAT(sound.out, ContainsSubstring("neighbour_heating: neighbour_C"));
  const auto report = nlohmann::json::parse(text_of(folder.path / "check.json"));
  CHECK(report["believable"] == true);
  CHECK(report["constants"]["resistance"]["sd_together"].get<double>() < 0.01);
  CHECK(report["signals"]["motor_C"]["noise"].get<double>() ==
        Approx(0.104).epsilon(0.2));  // 0.1 and steps of 0.1

  // The same log in degrees Fahrenheit: refused with the option that mends it, and believed with it.
  for (const char* file : {"train.csv", "heldout.csv"}) {
    Recording r = test::bench_recording({}, 900, file[0]);
    for (const char* column : {"motor_C", "ambient_C"})
      r.set(column, (r.column(column).array() * 1.8 + 32.0).matrix());
    write(folder.path / file, csv(r));
  }
  for (const char* command : {"check ", "diagnose "}) {
    const auto refused = folder.run(command + inputs);
    CHECK(refused.status == 4);
    CHECK_THAT(refused.out, ContainsSubstring("motor_C=motor_C:degF"));
  }
  const std::string mend = "--column motor_C=motor_C:degF --column ambient_C=ambient_C:degF ";
  CHECK(folder.run("check " + inputs + mend).status == 0);
  const auto mended = folder.run("diagnose " + inputs + mend + "--report report.json");
  CHECK(mended.status == 0);
  CHECK(nlohmann::json::parse(text_of(folder.path / "report.json"))["verdict"] == "no_gap");
  CHECK(folder.run("check " + inputs + "--column motor_C=temp:degX").status == 2);
  CHECK(folder.run("check " + inputs + "--column motor_C=temp").status == 3);
}

TEST_CASE("the catalogue is listed, with every id of the interface") {
  const Folder folder("effects");
  const auto result = folder.run("effects");
  CHECK(result.status == 0);
  for (const char* id : {"second_thermal_mass",
                         "radiation",
                         "natural_convection",
                         "forced_airflow",
                         "ambient_bias",
                         "neighbour_heating",
                         "motion_heating",
                         "thermometer_lag",
                         "thermometer_gain",
                         "supply_power_heating",
                         "calibration.",
                         "supply_sag",
                         "series_resistance",
                         "dead_time",
                         "back_emf",
                         "current_sensor_offset",
                         "current_sensor_gain",
                         "winding_tempco",
                         "coulomb_friction",
                         "asymmetric_friction",
                         "stribeck_friction",
                         "load_friction",
                         "drive_deadband",
                         "imbalance",
                         "cable_spring",
                         "cogging",
                         "compliance",
                         "actuation_delay",
                         "torque_saturation",
                         "torque_fade",
                         "angle_scale",
                         "angle_bias_drift",
                         "rate_bias",
                         "quadratic_drag",
                         "target_delay",
                         "idle_heat",
                         "unknown.load(angle_deg)",
                         "unknown.friction(rate_dps)",
                         "unknown.drive(drive_A)",
                         "unknown.loss(rise_K)",
                         "unknown.heat(current_A)",
                         "unknown.voltage(motor_C)"}) {
    CAPTURE(id);
    CHECK_THAT(result.out, ContainsSubstring(id));
  }
  CHECK(folder.run("--version").status == 0);
  CHECK(folder.run("--help").status == 0);
}
