// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Any bytes are either a recording that keeps its promises, or an InputError that names the file.

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/recording_file.hpp>

#include <cstdint>
#include <cstdlib>
#include <cstring>

using namespace thermopower::gap;
namespace io = thermopower::io;

std::vector<std::string> fuzz_seeds() {
  return {"t_s,run,power_param,motor_C\n0,a,100,21.5\n1,a,120,21.6\n0,b,0,nan\n2,b,,22\n",
          "\xef\xbb\xbft_s,drive_A,rate_dps\r\n0,0.1,1e-3\r\n0.01,-0.2,+5\r\n",
          "t_s,note,x\n0,\"a \"\"quote\"\"\nand a line\",1\n1,b,2\n"};
}
std::vector<std::string> fuzz_pieces() {
  return {",",     "\n",
          "\r",    "\"",
          "\"\"",  "nan",
          "inf",   "-",
          "1e999", "1e-999",
          "t_s",   "run",
          "\xff",  std::string(1, '\0'),
          " ",     ";",
          "0x1",   std::string(300, '7')};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto file = io::to_recording(
        io::parse_csv("fuzz.csv", reinterpret_cast<const char*>(data), size, io::known_columns()));
    if (file.recording.validate() || file.recording.rows() == 0 || file.recording.runs.empty()) std::abort();
  } catch (const io::InputError& error) {
    if (std::strncmp(error.what(), "fuzz.csv:", 9) != 0) std::abort();
  }
  return 0;
}
