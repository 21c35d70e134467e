// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Logs of other programs, written here as those programs write them, read from files.

#include "../catch.hpp"

#include <thermopower/io/column_list.hpp>
#include <thermopower/io/input_error.hpp>
#include <thermopower/io/recording_file.hpp>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace io = thermopower::io;
namespace fs = std::filesystem;

namespace {

/// A file in a folder of its own, gone with it.
class Written {
public:
  Written(const std::string& name, const std::string& bytes)
      : folder_(fs::temp_directory_path() / ("thermopower_log_kinds_" + std::to_string(++count_))) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    path = (folder_ / name).string();
  }
  ~Written() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  std::string path;

private:
  fs::path folder_;
  static int count_;
};
int Written::count_ = 0;

io::ReadOptions mapped(const std::vector<std::string>& columns) {
  io::ReadOptions how;
  for (const std::string& one : columns) how.choices.push_back(io::parse_column_choice(one));
  return how;
}

template <class Number>
void append(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// A member of a ZIP archive without packing, as numpy.savez writes it.
std::string npz(const std::vector<std::pair<std::string, std::string>>& members) {
  std::string out, directory;
  for (const auto& [name, data] : members) {
    const auto at = static_cast<std::uint32_t>(out.size());
    std::string sizes;
    append(sizes, std::uint32_t{0});  // check sum, which is not looked at
    append(sizes, static_cast<std::uint32_t>(data.size()));
    append(sizes, static_cast<std::uint32_t>(data.size()));
    append(sizes, static_cast<std::uint16_t>(name.size()));
    append(sizes, std::uint16_t{0});
    const std::string head(std::string("\x14\0\0\0\0\0\0\0\0\0", 10));
    out += std::string("PK\x03\x04", 4) + head + sizes + name + data;
    directory +=
        std::string("PK\x01\x02", 4) + std::string("\x14\0", 2) + head + sizes + std::string(10, '\0');
    append(directory, at);
    directory += name;
  }
  const auto begin = static_cast<std::uint32_t>(out.size());
  out += directory + std::string("PK\x05\x06\0\0\0\0", 8);
  append(out, static_cast<std::uint16_t>(members.size()));
  append(out, static_cast<std::uint16_t>(members.size()));
  append(out, static_cast<std::uint32_t>(directory.size()));
  append(out, begin);
  append(out, std::uint16_t{0});
  return out;
}

std::string npy(const std::string& shape, const std::vector<double>& values) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + shape + "), }";
  header.resize(117, ' ');
  header += '\n';
  std::string out = std::string("\x93NUMPY\x01\0", 8);
  append(out, static_cast<std::uint16_t>(header.size()));
  out += header;
  for (const double value : values) append(out, value);
  return out;
}

}  // namespace

TEST_CASE("klippy.log: the heaters' temperature, target and power, and the gains in the same file") {
  std::string text =
      "Starting Klippy...\n===== Config file =====\n[extruder]\nheater_pin = PA1\ncontrol = pid\npid_kp = 21.5\nmax_power = 0.8\n[fan]\npin = PB1\n"
      "=======================\n";
  for (int i = 0; i < 12; ++i)
    text += "Stats " + std::to_string(100 + i) +
            ".5: gcodein=0 mcu: mcu_awake=0.001 freq=72 heater_bed: target=0 temp=22.1 pwm=0.000 sysload=0.1 "
            "print_time=9 extruder: target=210 temp=" +
            std::to_string(25 + i) + ".3 pwm=0.5\nReset MCU 'mcu'\n";
  const Written log("klippy.log", text);
  const auto recording =
      io::read_recording(log.path, mapped({"motor_C=extruder.temp", "power_param=extruder.pwm:1"})).recording;
  REQUIRE(recording.rows() == 12);
  CHECK(recording.t_s[1] - recording.t_s[0] == 1.0);
  CHECK(recording.column("motor_C")[11] == 36.3);
  CHECK(recording.column("power_param")[0] == 127.5);
  const io::LogContents contents = io::list_log(log.path);
  const std::string shown = io::columns_text(contents);
  CHECK_THAT(shown, ContainsSubstring("[extruder] control=pid max_power=0.8 pid_kp=21.5"));
  CHECK_THAT(shown, ContainsSubstring(
                        "\"heater\": {\"law\": \"klipper_pid\", \"kp_per_K\": 21.5, \"max_power\": 0.8}"));
  CHECK_THAT(shown, ContainsSubstring("--column power_param=extruder.pwm:1") &&
                        ContainsSubstring("--column motor_C=extruder.temp") &&
                        ContainsSubstring("--ambient DEGC"));
}

TEST_CASE("a serial log of Marlin, with stamps and without") {
  const Written bare(
      "serial.log",
      "start\necho:Marlin 2.1\n T:21.3 /210.0 B:22.0 /60.0 @:127 B@:64\nok T:24.5 /210.0 B:22.1 /60.0 @:127 B@:64\nX:0.0 Y:0.0\n"
      " T:30.0 /210.0 B:22.3 /60.0 @:100 B@:64\n");
  CHECK_THROWS_WITH(io::read_recording(bare.path, mapped({"motor_C=T"})), ContainsSubstring("--rate"));
  io::ReadOptions how = mapped({"motor_C=T", "power_param=@:127"});
  how.rows_per_s = 0.5;
  const auto recording = io::read_recording(bare.path, how).recording;
  REQUIRE(recording.rows() == 3);
  CHECK(recording.t_s[2] == 4.0);
  CHECK(recording.column("motor_C")[1] == 24.5);
  CHECK(recording.column("T_target")[1] == 210.0);
  CHECK(recording.column("power_param")[0] == 255.0);
  const Written stamped(
      "octoprint.log",
      "2026-02-01 10:00:00,250 - Send: M105\n2026-02-01 10:00:00,500 - Recv: ok T:21.3 /0.0 @:0\n"
      "2026-02-01 10:00:02,000 - Recv: ok T:21.4 /0.0 @:5\n");
  CHECK(io::read_recording(stamped.path, mapped({"t_s=time:s", "motor_C=T"})).recording.t_s[1] == 1.5);
}

TEST_CASE("JSON lines: members of members, lists, what is missing in some lines") {
  const Written log(
      "log.jsonl",
      "{\"t_s\":0,\"joint\":{\"q\":[1.5,2]},\"on\":true}\n\n{\"t_s\":0.5,\"joint\":{\"q\":[1.75,2]},\"angle_deg\":3}\n");
  const auto recording = io::read_recording(log.path, mapped({"rate_dps=joint.q[0]"})).recording;
  REQUIRE(recording.rows() == 2);
  CHECK(recording.column("rate_dps")[1] == 1.75);
  CHECK(recording.column("angle_deg")[1] == 3.0);
  CHECK(recording.column("angle_deg")[0] != recording.column("angle_deg")[0]);
  const Written cut("cut.jsonl", "{\"t_s\":0}\n{\"t_s\":");
  CHECK_THROWS_WITH(io::read_recording(cut.path),
                    ContainsSubstring("cut.jsonl:2: ") && ContainsSubstring("cut off"));
  // A line that is told is the file's own.
  const Written back("back.jsonl", "{\"t_s\":1}\n\n\n{\"t_s\":0}\n");
  CHECK_THROWS_WITH(io::read_recording(back.path), ContainsSubstring("back.jsonl:4: "));
}

TEST_CASE("frames of a CAN bus by a mapping: both byte orders, signs, the first byte as a kind") {
  const Written log(
      "can.log",
      "(1700000000.000000) can0 141#A1000000FFEC0000\n(1700000000.001000) can0 241#A11E0000FF9C0001\n"
      "(1700000000.010000) can0 141#A100000000150000\n(1700000000.011000) can0 241#A11E0000FF9D0002\n"
      "(1700000000.012000) can0 241#9AFFFFFFFFFFFFFF\n");
  const auto recording =
      io::read_recording(log.path, mapped({"drive_A=141#A1.i16be@4:A*0.01", "angle_deg=241#A1.i16be@4",
                                           "motor_C=241#A1.u8@1"}))
          .recording;
  REQUIRE(recording.rows() == 4);
  CHECK(recording.column("drive_A")[0] == Approx(-0.2));
  CHECK(recording.column("drive_A")[1] == Approx(-0.2));  // held
  CHECK(recording.column("drive_A")[2] == Approx(0.21));
  CHECK(recording.column("angle_deg")[1] == -100.0);
  CHECK(recording.column("motor_C")[1] == 30.0);
  CHECK(recording.t_s[3] == Approx(0.011));
  CHECK_THROWS_WITH(io::read_recording(log.path), ContainsSubstring("expected a mapping"));
  CHECK_THROWS_WITH(io::read_recording(log.path, mapped({"drive_A=141:A"})),
                    ContainsSubstring("not a place in a frame"));
  CHECK_THAT(io::columns_text(io::list_log(log.path)),
             ContainsSubstring("141") && ContainsSubstring("--column NAME="));
}

TEST_CASE("arrays of numpy: vectors and the columns of a matrix") {
  const Written log("log.npz", npz({{"t_s.npy", npy("3,", {0.0, 0.5, 1.0})},
                                    {"q.npy", npy("3, 2", {1.0, 2.0, 3.0, 4.0, 5.0, 6.0})},
                                    {"kt.npy", npy("1,", {0.9})}}));
  const auto recording = io::read_recording(log.path, mapped({"angle_deg=q[1]"})).recording;
  REQUIRE(recording.rows() == 3);
  CHECK(recording.column("angle_deg")[2] == 6.0);
  CHECK(recording.column("q[0]")[0] == 1.0);
  CHECK_FALSE(recording.has("kt"));
}

TEST_CASE("a file that is not read is named as what it is, with the lines that convert it") {
  struct Case {
    const char *name, *bytes;
    std::size_t size;
    const char *kind, *line;
  };
  const Case cases[] = {{"a.parquet", "PAR1....", 8, "Parquet", "pd.read_parquet("},
                        {"a.bag", "#ROSBAG V2.0\n", 13, "bag of ROS 1", "AnyReader"},
                        {"a.mf4", "MDF     4.10", 12, "MDF file (.mf4)", "asammdf"},
                        {"a.pt", "PK\x03\x04\0\0", 6, "PyTorch (.pt)", "torch.load("},
                        {"a.h5", "\x89HDF\r\n\x1a\n", 8, "HDF5", "h5py"},
                        {"a.mat", "MATLAB 5.0 MAT-file", 19, "MATLAB file", "scipy.io.loadmat("},
                        {"a.pkl", "\x80\x04\x95", 3, "pickle", "pandas.read_pickle("}};
  for (const Case& one : cases) {
    CAPTURE(one.name);
    const Written file(one.name, std::string(one.bytes, one.size));
    CHECK_THROWS_WITH(io::read_recording(file.path), ContainsSubstring(one.kind) &&
                                                         ContainsSubstring(one.line) &&
                                                         ContainsSubstring("a.csv"));
    CHECK_THROWS_AS(io::list_log(file.path), io::InputError);
  }
}

TEST_CASE("constants, a torque of the drive and a share of the supply take what the model says") {
  const Written log("log.csv", "t_s,angle_deg,effort,duty\n0,0,0.9,0.5\n1,1,-1.8,-0.25\n");
  io::ReadOptions how = mapped({"drive_A=effort:Nm", "voltage_V=duty:1"});
  CHECK_THROWS_WITH(io::read_recording(log.path, how), ContainsSubstring("torque_constant_Nm_per_A"));
  how.torque_constant_Nm_per_A = 0.9;
  CHECK_THROWS_WITH(io::read_recording(log.path, how), ContainsSubstring("share of the supply"));
  how.constants = {{"supply_V", 12.0}, {"ambient_C", 24.0}};
  const auto recording = io::read_recording(log.path, how).recording;
  CHECK(recording.column("drive_A")[1] == Approx(-2.0));
  CHECK(recording.column("voltage_V")[0] == 6.0);
  CHECK(recording.column("ambient_C")[1] == 24.0);
  how.constants = {{"angle_deg", 1.0}};
  CHECK_THROWS_WITH(io::read_recording(log.path, how), ContainsSubstring("expected one of the two"));
}
