// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Any bytes are either a model that can be written and read again, or an InputError that names the file.

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/model_file.hpp>

#include <thermopower/plant/standard_catalogue.hpp>

#include <cstdint>
#include <cstdlib>
#include <cstring>

using namespace thermopower::gap;
namespace io = thermopower::io;

std::vector<std::string> fuzz_seeds() {
  return {
      R"({"format": "thermopower-model/1", "name": "m", "supply": {"nominal_V": 13.0}, "current": {"law": "ohmic", "resistance_ohm": 8.2},
              "thermal": {"law": "lumped", "heat_capacity_J_per_K": 60.0, "conductance_W_per_K": 0.11}})",
      R"({"format": "thermopower-model/1", "axis": {"law": "rigid", "inertia_kgm2": 1e-3, "viscous_Nms_per_rad": 1e-3,
              "torque_constant_Nm_per_A": 0.2}, "effects": {"coulomb_friction": {"Nm": 0.1}}})"};
}
std::vector<std::string> fuzz_pieces() {
  return {"{",
          "}",
          "[",
          "]",
          "\"",
          ":",
          ",",
          "null",
          "true",
          "1e999",
          "-1",
          "\\u0000",
          "\"law\"",
          "\"thesis\"",
          "\"effects\"",
          "\xff",
          std::string(200, '['),
          "1e308"};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const Model model = io::parse_model("fuzz.json", std::string(reinterpret_cast<const char*>(data), size),
                                        standard_catalogue());
    const std::string text = io::to_json(model);
    if (model.validate() || io::to_json(io::parse_model("again", text, standard_catalogue())) != text)
      std::abort();
  } catch (const io::InputError& error) {
    if (std::strncmp(error.what(), "fuzz.json:", 10) != 0) std::abort();
  }
  return 0;
}
