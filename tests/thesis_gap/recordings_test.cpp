// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The recordings in examples/thesis_gap are the thesis's tables in another form, and nothing else.
#include "../../examples/thesis_replay/table.hpp"
#include "../catch.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace {

using thesis::Table;

struct Sample {
  double t_s, power_param, current_A, motor_C, ambient_C;  // no current: NaN
};

const double none = std::nan("");

Table thesis_table(const std::string& number) {
  return Table::read(std::string(THERMOPOWER_TEST_DATA) + "/thesis/table" + number + ".csv", {"motor"});
}

// Heating runs of chapter 4 (with current and air) or 5 (with neither), as printed.
void add_heating(std::vector<Sample>& samples, const std::string& number, const char* motor_column) {
  const Table table = thesis_table(number);
  const bool has_current = number.front() == '4';
  for (size_t row = 0; row < table.rows(); ++row) {
    samples.push_back({60.0 * table.number(row, "t_min"), table.number(row, "power_param"),
                       has_current ? table.number(row, "I_mA") / 1000.0 : none,
                       table.number(row, motor_column), has_current ? table.number(row, "T_air_C") : 26.0});
  }
}

void add_cooling(std::vector<Sample>& samples, const std::string& number, const std::string& motor,
                 const char* motor_column) {
  const Table table = thesis_table(number);
  for (size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, "motor") != motor) continue;
    samples.push_back({60.0 * table.number(row, "t_min"), 0.0, none, table.number(row, motor_column),
                       number.front() == '4' ? table.number(row, "T_air_C") : 26.0});
  }
}

void check(const std::string& file, const std::vector<Sample>& expected) {
  const Table recording = Table::read(std::string(THERMOPOWER_RECORDINGS) + "/" + file, {"run"});
  REQUIRE(recording.rows() == expected.size());
  for (size_t row = 0; row < expected.size(); ++row) {
    INFO(file << " row " << row);
    CHECK(recording.number(row, "t_s") == Approx(expected[row].t_s));
    CHECK(recording.number(row, "power_param") == expected[row].power_param);
    CHECK(recording.number(row, "supply_V") == 13.0);
    CHECK(recording.number(row, "motor_C") == Approx(expected[row].motor_C));
    CHECK(recording.number(row, "ambient_C") == Approx(expected[row].ambient_C));
    const auto current = recording.number_if_any(row, "current_A");
    CHECK(current.has_value() == !std::isnan(expected[row].current_A));
    if (current) CHECK(*current == Approx(expected[row].current_A));
  }
}

}  // namespace

TEST_CASE("the recordings of chapter 4 are Tables 4.1 and 4.3, 4.2 and 4.6") {
  std::vector<Sample> small, large;
  add_heating(small, "4_1", "T_motor_C");
  add_cooling(small, "4_3", "BGM2606-90T", "T_motor_C");
  check("bgm2606_chapter4.csv", small);
  add_heating(large, "4_2", "T_motor_C");
  add_cooling(large, "4_6", "BGM5208-200-12", "T_motor_C");
  check("bgm5208_chapter4.csv", large);
}

TEST_CASE("the recordings of chapter 5 are the measured columns of Tables 5.1 and 5.3, 5.1 and 5.2") {
  std::vector<Sample> small, large;
  add_cooling(small, "5_1", "BGM2606-90T", "T_measured_C");
  add_heating(small, "5_3", "T_measured_C");
  check("bgm2606_chapter5.csv", small);
  add_cooling(large, "5_1", "BGM5208-200-12", "T_measured_C");
  add_heating(large, "5_2", "T_measured_C");
  check("bgm5208_chapter5.csv", large);
}
