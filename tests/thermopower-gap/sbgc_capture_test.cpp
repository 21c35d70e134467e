// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Captures of a SimpleBGC board's serial line: golden frames of tests/data/sbgc, as socat writes them and as plain lines.

#include "../catch.hpp"

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/sbgc_capture.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <sstream>

using namespace thermopower::gap;
namespace io = thermopower::io;

namespace {

// Bytes of a golden frame as text, each with a blank before it.
std::string golden(const char* name) {
  std::ifstream file(std::string(THERMOPOWER_TEST_DATA "/sbgc/") + name);
  std::string text;
  for (std::string byte; file >> byte;) text += " " + byte;
  REQUIRE(text.size() > 6);
  return text;
}

// CONTROL by the specification: id 67, three modes, then speed and angle of each axis; the last byte is the sum of the payload.
std::string control_frame(int mode, int speed, int angle) {
  std::string bytes;
  const auto put = [&](int byte) {
    char text[8];
    std::snprintf(text, sizeof text, " %02x", byte & 255);
    bytes += text;
  };
  int sum = 0;
  const auto payload = [&](int byte) { put(byte), sum += byte & 255; };
  put(0x3e), put(67), put(15), put(67 + 15);
  for (int axis = 0; axis < 3; ++axis) payload(mode);
  for (int axis = 0; axis < 3; ++axis)
    for (const int value : {speed * (axis + 1), angle * (axis + 1)}) payload(value), payload(value >> 8);
  put(sum);
  return bytes;
}

std::size_t byte_count(const std::string& bytes) { return bytes.size() / 3; }

std::string socat(char direction, const char* time, const std::string& bytes) {
  return std::string(1, direction) + " 2026/11/22 " + time + "  length=" + std::to_string(byte_count(bytes)) +
         " from=0 to=" + std::to_string(byte_count(bytes) - 1) + "\n" + bytes + "\n--\n";
}

std::vector<io::ColumnChoice> choices(const std::vector<std::string>& texts) {
  std::vector<io::ColumnChoice> list;
  for (const std::string& text : texts) list.push_back(io::parse_column_choice(text));
  return list;
}

io::RecordingFile read(const std::string& text, const std::vector<std::string>& columns) {
  return io::parse_sbgc_capture("line.txt", text, choices(columns));
}

std::string error_of(const std::string& text,
                     const std::vector<std::string>& columns = {"angle_deg=pitch.angle_deg"}) {
  try {
    read(text, columns);
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "no error";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("telemetry of both protocol versions reads as its golden decoding says") {
  for (const char* frame : {"v1_answer_rt4_real.hex", "v2_answer_rt4_real.hex"}) {
    CAPTURE(frame);
    const std::string bytes = golden(frame);
    const std::string text = socat('>', "23:59:59.900000001", golden("v1_request_realtime_data_4.hex")) +
                             socat('<', "23:59:59.950000001", bytes) +
                             "> 2026/11/23 00:00:00.150000001  length=4 from=4 to=7\n 3e 19 00 19\n" +
                             "< 2026/11/23 00:00:00.200000001  length=" + std::to_string(byte_count(bytes)) +
                             " from=0 to=0\n" + bytes + "\n";
    const Recording recording =
        read(text, {"angle_deg=pitch.angle_deg", "rate_dps=yaw.rate_dps", "target_deg=roll.target_deg",
                    "power_param=pitch.power_param", "supply_V=supply_V", "amps=supply_A", "imu=imu_C",
                    "frame=frame_imu_C", "rotor=pitch.rotor_deg", "balance=roll.balance",
                    "error=roll.error_deg", "mount=yaw.frame_deg", "turned_deg=roll.angle_deg:-rad"})
            .recording;
    REQUIRE(recording.rows() == 2);
    CHECK(recording.t_s[0] == 0.0);
    CHECK(recording.t_s[1] == 0.25);  // past midnight
    const double unit = 0.02197265625;
    CHECK(recording.column("angle_deg")[0] == -200 * unit);
    CHECK(recording.column("rate_dps")[1] == Approx(-32768 * 0.06103701895).epsilon(1e-12));
    CHECK(recording.column("target_deg")[1] == 146 * unit);
    CHECK(recording.column("power_param")[1] == 125.0);
    CHECK(recording.column("supply_V")[1] == 12.68);
    CHECK(recording.column("amps")[1] == 1.234);
    CHECK(recording.column("imu")[1] == 25.0);
    CHECK(recording.column("frame")[1] == -7.0);
    CHECK(recording.column("rotor")[1] == -46 * unit);
    CHECK(recording.column("balance")[1] == -512.0);
    CHECK(recording.column("error")[1] == 46 * unit);
    CHECK(recording.column("mount")[1] == -3 * unit);
    CHECK(recording.column("turned_deg")[0] == Approx(-100 * unit * 57.29577951308232));
  }
}

TEST_CASE("commands of the host are held between telemetry, whichever way the capture was wired") {
  const std::string answer = golden("v1_answer_rt4_real.hex");
  for (const bool turned : {false, true}) {
    CAPTURE(turned);
    const std::string host = turned ? "< " : "> ", board = turned ? "> " : "< ";
    const std::string text = host + "5.00" + control_frame(2, 100, 200) + "\n" + board + "5.01" + answer +
                             "\n" + board + "5.03" + answer + "\n" + host + "5.04" +
                             control_frame(1, -50, 0) + "\n" + board + "5.05" + answer + "\n";
    const Recording recording = read(text, {"target_deg=pitch.control_deg", "target_dps=yaw.control_dps",
                                            "angle_deg=pitch.angle_deg"})
                                    .recording;
    REQUIRE(recording.rows() == 5);
    const Eigen::VectorXd &deg = recording.column("target_deg"), &dps = recording.column("target_dps"),
                          &angle = recording.column("angle_deg");
    for (const Eigen::Index i : {0, 1, 2}) {
      CHECK(deg[i] == 400 * 0.02197265625);
      CHECK(std::isnan(dps[i]));  // an angle was commanded
    }
    CHECK(std::isnan(deg[3]));
    CHECK(dps[4] == Approx(-150 * 0.1220740379).epsilon(1e-12));
    CHECK(std::isnan(angle[0]));
    CHECK(std::isfinite(angle[1]));
    CHECK(std::isnan(angle[3]));
    CHECK(recording.t_s[4] == 0.05);
  }
}

TEST_CASE("a frame in pieces has the time of its last byte, and what is damaged is counted") {
  const std::string answer = golden("v1_answer_rt4_real.hex");
  const std::size_t half = 3 * (byte_count(answer) / 2);
  std::string broken = answer;
  broken.replace(3 * 60 + 1, 2, broken.compare(3 * 60 + 1, 2, "7d") == 0 ? "7c" : "7d");
  const std::string text = "< 1.000 aa bb" + answer.substr(0, half) + "\n< 1.004" + answer.substr(half) +
                           "\n< 1.010" + broken + "\n< 1.020" + answer + "\n< 1.030 3e 19\n";
  const io::RecordingFile file = read(text, {"angle_deg=yaw.angle_deg"});
  REQUIRE(file.recording.rows() == 2);
  CHECK(file.recording.t_s[1] == 0.016);
  const io::SbgcCaptureContents contents = io::list_sbgc_capture("line.txt", text);
  const std::size_t frame = byte_count(answer);
  CHECK(contents.from_board.bytes == 2 + 3 * frame + 2);
  CHECK(contents.from_board.frames == 2);
  CHECK(contents.from_board.lost_bytes == 2 + frame + 2);
  CHECK(contents.telemetry == 2);
  REQUIRE(file.findings.size() == 1);
  CHECK(has(file.findings[0].message, std::to_string(frame + 4) + " of " + std::to_string(3 * frame + 4) +
                                          " bytes from the board belong to no valid frame"));
}

TEST_CASE("the list proposes the axis that moves") {
  const std::string text = "< 1" + golden("v1_answer_rt4_real.hex") + "\n< 2" +
                           golden("v1_answer_rt4_ramp.hex") + "\n> 3" + control_frame(2, 1, 1) + "\n";
  const io::SbgcCaptureContents contents = io::list_sbgc_capture("line.txt", text);
  CHECK(contents.control == 1);
  CHECK(contents.duration_s == 2.0);
  double widest = 0.0;
  std::string proposed, most;
  for (const io::ListedColumn& one : contents.columns) {
    if (has(one.header, ".angle_deg") && one.greatest - one.least > widest)
      widest = one.greatest - one.least, most = one.header;
    if (one.proposed == "angle_deg") proposed = one.header;
  }
  CHECK(proposed == most);
  CHECK(has(io::columns_text(contents), "2 frames of telemetry, 1 CONTROL"));
  CHECK(has(io::columns_text(contents), "--column angle_deg=" + most));
}

TEST_CASE("what is no capture is answered with its line") {
  const std::string answer = golden("v1_answer_rt4_real.hex");
  CHECK(error_of(">\n") == "line.txt:1: a direction alone; expected a time after it");
  CHECK(has(error_of("< 1 3e 1\n"), "line.txt:1: '1' is not a byte; expected two hexadecimal digits"));
  CHECK(has(error_of("< 1 3e zz\n"), "'zz' is not a byte"));
  CHECK(has(error_of("< 1 3eaa\n"), "expected a blank between bytes"));
  CHECK(has(error_of("< x 3e\n"), "'x' is not a time"));
  CHECK(has(error_of("< 2 3e\n< 1 3e\n"), "line.txt:2: the time lies before that of the block above"));
  CHECK(has(error_of("< 1 3e\nhello\n"), "line.txt:2: 'hello'; expected '>' or '<'"));
  CHECK(has(error_of("< 2026/13/01 00:00:00 length=1\n 3e\n"), "line.txt:1: not a date"));
  CHECK(has(error_of("< 2026/11/22 00:00:00.5  length=3 from=0 to=2\n 3e 19\n< 3 3e\n"),
            "line.txt:1: says length=3 and 2 bytes follow"));
  CHECK(has(error_of("< 1 3e 19\n"), "line.txt: no telemetry in either direction"));
  CHECK(has(error_of("< 1" + answer + "\n", {}), "no field is asked for"));
  CHECK(has(error_of("< 1" + answer + "\n", {"angle_deg=tilt.angle_deg"}),
            "there is no field 'tilt.angle_deg'"));
  CHECK(has(error_of("< 1" + answer + "\n", {"target_deg=pitch.control_deg"}),
            "is in none of 0 frames CONTROL"));
  CHECK(has(error_of("< 1" + golden("v1_answer_rt3_ramp.hex") + "\n", {"amps=supply_A"}),
            "only REALTIME_DATA_4"));
}
