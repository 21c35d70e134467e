// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Any bytes are either an MCAP recording that keeps its promises, or an InputError that names the file.

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/mcap_file.hpp>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

using namespace thermopower::gap;
namespace io = thermopower::io;

std::vector<std::string> fuzz_seeds() {
  std::vector<std::string> seeds;
  for (const char* name : {"json_plain", "cdr_plain", "cdr_chunks", "cdr_lz4", "stamped_lz4", "json_zstd"}) {
    std::ifstream file(std::string(THERMOPOWER_TEST_DATA "/mcap/") + name + ".mcap", std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    // Most of what can go wrong is in the first messages; shorter inputs are tried more often.
    seeds.push_back(text.str().substr(0, 6000));
    if (text.str().size() < 13000) seeds.push_back(text.str());
  }
  return seeds;
}
std::vector<std::string> fuzz_pieces() {
  return {std::string(8, '\0'),
          std::string(8, '\xff'),
          std::string("\x04\0\0\0", 4),
          "\x03",
          "\x04",
          "\x05",
          "\x06",
          "\x0f",
          std::string("\x05\x20\0\0\0\0\0\0\0", 9),
          "ros2msg",
          "cdr",
          "json",
          "float64[] x\n",
          "[[",
          "{\"a\":",
          "\\u00",
          "1e999",
          std::string("\x01\0\0", 3)};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const char* const bytes = reinterpret_cast<const char*>(data);
  static const std::vector<io::ColumnChoice> choices = {
      io::parse_column_choice("angle_deg=/joint_states.position[elbow]:rad"),
      io::parse_column_choice("gyro=/imu.angular_velocity.z")};
  for (int what = 0; what < 2; ++what) {
    try {
      if (what == 0) {
        io::list_mcap("fuzz.mcap", bytes, size);
      } else {
        const auto file = io::parse_mcap("fuzz.mcap", bytes, size, choices);
        if (file.recording.validate() || file.recording.rows() == 0 || file.recording.runs.empty())
          std::abort();
      }
    } catch (const io::InputError& error) {
      if (std::strncmp(error.what(), "fuzz.mcap: ", 11) != 0) std::abort();
    }
  }
  return 0;
}
