// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// What `columns` proposes for logs as programs write them, in tables of its own making.

#include "../catch.hpp"

#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/column_list.hpp>
#include <thermopower/io/input_error.hpp>
#include <thermopower/io/recording_file.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace io = thermopower::io;

namespace {

/// A header row, and one function of time for each column.
template <class Row>
std::string table(const std::string& header, int rows, const Row& row) {
  std::string text = header + "\n";
  for (int i = 0; i < rows; ++i) {
    std::string line;
    for (const double value : row(i)) {
      char cell[40];
      std::snprintf(cell, sizeof cell, "%s%.12g", line.empty() ? "" : ",", value);
      line += cell;
    }
    text += line + "\n";
  }
  return text;
}

std::string proposals(const std::string& text, const std::string& joint = {}) {
  std::string all;
  for (const io::ListedColumn& one : io::list_columns("log.csv", text.data(), text.size(), joint))
    if (!one.proposed.empty())
      all += (all.empty() ? "" : "; ") + one.proposed + "=" + one.header +
             (one.unit.empty() ? "" : ":" + one.unit);
  return all;
}

double wave(int i) { return std::sin(0.02 * i); }

}  // namespace

TEST_CASE("the joint that moves is picked, with what belongs to it") {
  const std::string text = table(
      "stamp_s,hip/position,knee/position,hip/velocity,knee/velocity,hip/cmd/current,knee/cmd/current", 200,
      [](int i) {
        return std::vector<double>{0.01 * i, 0.1, wave(i), 0.0, 2.0 * std::cos(0.02 * i), 0.0, 3.0 * wave(i)};
      });
  CHECK(proposals(text) ==
        "t_s=stamp_s:s; angle_deg=knee/position; rate_dps=knee/velocity; drive_A=knee/cmd/current");
  CHECK(proposals(text, "hip") ==
        "t_s=stamp_s:s; angle_deg=hip/position; rate_dps=hip/velocity; drive_A=hip/cmd/current");
}

TEST_CASE("an effort is the drive's own torque, and never one from outside") {
  const auto row = [](int i) { return std::vector<double>{0.01 * i, wave(i), 0.9 * wave(i)}; };
  CHECK(proposals(table("time,/joint_states/elbow/position,/joint_states/elbow/effort", 50, row)) ==
        "t_s=time; angle_deg=/joint_states/elbow/position:rad; drive_A=/joint_states/elbow/effort:Nm");
  // A current that is there goes before it.
  CHECK(proposals(table("time,elbow_angle_deg,elbow_tau,elbow_current_A", 50, [](int i) {
          return std::vector<double>{0.01 * i, 50.0 * wave(10 * i), 0.9 * wave(10 * i), wave(10 * i)};
        })) == "t_s=time; angle_deg=elbow_angle_deg:deg; drive_A=elbow_current_A:A");
  CHECK(proposals(table("time,angle_deg,drive_A,external torque [Nm]", 50, [](int i) {
          return std::vector<double>{0.01 * i, wave(i), wave(i), wave(i)};
        })) == "t_s=time; angle_deg=angle_deg; drive_A=drive_A; torque_Nm=external torque [Nm]:Nm");
}

TEST_CASE("a proposal never contradicts the unit in the header") {
  const auto one = [](const std::string& header, double low, double high) {
    return proposals(table("time," + header, 20, [=](int i) {
      return std::vector<double>{1.0 * i, i % 2 ? high : low};
    }));
  };
  CHECK(one("position cmd [A]", -2.0, 2.0) == "t_s=time; drive_A=position cmd [A]:A");
  CHECK(one("arm position [mm]", -2.0, 2.0) == "t_s=time");
  CHECK(one("torque gain [Nm/A]", 0.1, 0.2) == "t_s=time");
  CHECK(one("motor current [V]", 0.1, 0.2) == "t_s=time");
  CHECK(one("fan speed [m/s]", 0.1, 0.2) == "t_s=time");
  CHECK(one("wheel speed [Hz]", -2.0, 2.0) == "t_s=time; rate_dps=wheel speed [Hz]:rev/s");
  CHECK(one("Spannung [V]", -5.0, 5.0) == "t_s=time; voltage_V=Spannung [V]:V");
  CHECK(one("motor temp [K/s]", 0.1, 0.2) == "t_s=time");
}

TEST_CASE("the supply's voltage is not the drive's, the board's temperature not the motor's") {
  const std::string text = table("time,voltage,board temp,winding temp,temp", 40, [](int i) {
    return std::vector<double>{1.0 * i, 24.0 - 0.01 * i, 30.0 + 0.1 * i, 25.0 + i, 22.0};
  });
  CHECK(proposals(text) == "t_s=time; supply_V=voltage; motor_C=winding temp");
  // A duty with a sign is a share of the supply.
  CHECK(proposals(table("t,duty,vbat", 40, [](int i) {
          return std::vector<double>{1.0 * i, wave(20 * i), 12.0};
        })) == "t_s=t; voltage_V=duty:1; supply_V=vbat");
  // Two thermometers that nothing tells apart.
  CHECK(proposals(table("t,temp 1 (C),temp 2 (C)", 40, [](int i) {
          return std::vector<double>{1.0 * i, 20.0 + 0.1 * i, 20.0 + 0.11 * i};
        })) == "t_s=t");
}

TEST_CASE("counts of a servo and registers with sign and magnitude") {
  const std::string text = table("time,goal pos (2),pos (2),speed (2)", 60, [](int i) {
    const int speed = i < 30 ? 10 * i : 32768 + 10 * (i - 30);
    return std::vector<double>{0.1 * i, 2048.0 + i, 2040.0 + i, 1.0 * speed};
  });
  CHECK(proposals(text) ==
        "t_s=time; target_deg=goal pos (2):4096; angle_deg=pos (2):4096; rate_dps=speed (2):4096/s,sign15");
  CHECK(proposals(table("time,pos", 30, [](int i) {
          return std::vector<double>{0.1 * i, 9000.0 + i};
        })) == "t_s=time");
  const io::ColumnChoice counts = io::parse_column_choice("rate_dps=speed:4096/s,sign15");
  CHECK(io::value_of(counts, 1024.0) == 90.0);
  CHECK(io::value_of(counts, 32768.0 + 1024.0) == -90.0);
}

TEST_CASE("units are scaled by a gear, pole pairs and the size of a count") {
  CHECK(io::value_of(io::parse_column_choice("rate_dps=erpm:rpm/7"), 70.0) == Approx(60.0));
  CHECK(io::value_of(io::parse_column_choice("drive_A=raw:-A*0.01"), 50.0) == Approx(-0.5));
  CHECK(io::value_of(io::parse_column_choice("angle_deg=motor:rev/50"), 25.0) == Approx(180.0));
  CHECK(io::value_of(io::parse_column_choice("power_param=pwm:127"), 127.0) == Approx(255.0));
  for (const char* wrong :
       {"rate_dps=x:rpm/0", "rate_dps=x:rpm/", "angle_deg=x:1.5", "angle_deg=x:deg,sign40", "motor_C=x:4096"})
    CHECK_THROWS_AS(io::parse_column_choice(wrong), io::InputError);
}

TEST_CASE("German headers, and the current beside a motion that nothing else drives") {
  const std::string text =
      "Zeit [ms];Motorstrom [A];Winkel [\xc2\xb0];Drehzahl [1/min]\n0;-0,5;0;0\n10;0,5;1,5;25\n20;0,7;3,5;30\n";
  CHECK(
      proposals(text) ==
      "t_s=Zeit [ms]:ms; drive_A=Motorstrom [A]:A; angle_deg=Winkel [\xc2\xb0]:deg; rate_dps=Drehzahl [1/min]:rpm");
  CHECK(proposals("Zeit;Umgebungstemperatur;Motortemperatur;Sollstrom\n0;20;21;1\n1;20;22;2\n") ==
        "t_s=Zeit; ambient_C=Umgebungstemperatur; motor_C=Motortemperatur; drive_A=Sollstrom");
}

TEST_CASE("an angle and its rate say each other's unit") {
  const auto pair = [](double angle_unit, double rate_unit) {
    return proposals(table("time,angle,omega", 300, [=](int i) {
      return std::vector<double>{0.01 * i, angle_unit * 90.0 * wave(i),
                                 rate_unit * 180.0 * std::cos(0.02 * i)};
    }));
  };
  constexpr double rad = 0.017453292519943295;
  CHECK(pair(rad, 1.0) == "t_s=time; angle_deg=angle:rad; rate_dps=omega:deg/s");
  CHECK(pair(1.0, 1.0 / 6.0) == "t_s=time; angle_deg=angle:deg; rate_dps=omega:rpm");
  CHECK(pair(1.0, rad) == "t_s=time; angle_deg=angle:deg; rate_dps=omega:rad/s");
  CHECK(pair(1.0 / 360.0, 1.0 / 360.0) == "t_s=time; angle_deg=angle; rate_dps=omega");
}

TEST_CASE("a heater's log in Marlin's letters; a T that falls is no time") {
  CHECK(proposals("time,T,@,A\n0,25,0,24\n1,40,127,24\n2,60,127,24\n3,55,0,24\n") ==
        "t_s=time; motor_C=T; power_param=@:127; ambient_C=A");
  CHECK(proposals("t,T\n0,25\n1,40\n2,30\n") == "t_s=t; motor_C=T");
  // Of hot end and bed the one that is heated, the hot end where both are; targets are no time.
  CHECK(proposals("T,T_target,B,B_target,@,B@\n24,0,25,60,0,127\n24,0,40,60,0,127\n24,0,60,60,0,40\n") ==
        "motor_C=B; power_param=B@:127");
  CHECK(proposals("T,T_target,B,B_target,@,B@\n25,0,25,60,127,127\n50,0,40,60,127,127\n60,0,60,60,9,40\n") ==
        "motor_C=T; power_param=@:127");
  // Where nobody logged the power, the target tells it.
  CHECK(proposals("time,bed_temp,bed_target\n0,25,60\n1,26,60\n2,27,60\n") ==
        "t_s=time; motor_C=bed_temp; target_C=bed_target");
  CHECK(proposals("time,extruder.temp,extruder.target\n0,25,60\n1,26,60\n2,27,60\n") ==
        "t_s=time; motor_C=extruder.temp; target_C=extruder.target");
}

TEST_CASE("dates, units below the header and pandas' index are read as they stand") {
  const auto read = [](const std::string& text, const std::vector<std::string>& columns = {}) {
    io::ReadOptions how;
    for (const std::string& one : columns) how.choices.push_back(io::parse_column_choice(one));
    return io::to_recording(
               io::parse_csv("log.csv", text.data(), text.size(), io::known_columns(), how.choices))
        .recording;
  };
  const auto dated = read(
      "t_s,motor_C\n2026-03-01T23:59:59.500Z,20\n2026-03-02T00:00:00.250Z,21\n2026-03-02 01:00:01+01:00,22\n");
  CHECK(dated.t_s[1] == 0.75);
  CHECK(dated.t_s[2] == 1.5);
  const auto of_day = read("t_s,motor_C\n23:59:59.5,20\n00:00:01,21\n");
  CHECK(of_day.t_s[1] == 1.5);
  const auto units = read("t_s,angle_deg,rate_dps\nms,rad,rpm\n0,0,0\n500,3.141592653589793,60\n");
  CHECK(units.t_s[1] == 0.5);
  CHECK(units.column("angle_deg")[1] == Approx(180.0));
  CHECK(units.column("rate_dps")[1] == 360.0);
  const auto index = read(",t_s,motor_C\n0,0,20\n1,5,21\n");
  CHECK_FALSE(index.has("index"));
  CHECK(index.t_s[1] == 5.0);
  const auto indexed = read(",motor_C\n2026-01-01 00:00:00,20\n2026-01-01 00:00:02,21\n", {"t_s=index"});
  CHECK(indexed.t_s[1] == 2.0);
  CHECK(read("t_s,motor_C,\n0,20,\n1,21,\n").rows() == 2);
  CHECK_THROWS_WITH(read("t_s,angle_deg\ns,A\n0,1\n"), ContainsSubstring("row of units says 'A'"));
}
