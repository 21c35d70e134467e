// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace nano {

/// A symbol of a program: where it lies and how long it is.
struct Symbol {
  std::uint32_t address = 0;  ///< As in the file: RAM addresses start at 0x800000.
  std::uint32_t size = 0;     ///< Bytes.
};

/// What a program for the ATmega328P occupies, from its ELF file.
struct ElfFacts {
  std::uint32_t flash_bytes = 0;       ///< Code, tables, and the initial values of variables.
  std::uint32_t static_ram_bytes = 0;  ///< Variables, initialised or not.
  std::map<std::string, Symbol> symbols;

  /// @throws std::runtime_error naming the file and what is wrong with it
  static ElfFacts read(const std::string& path);
};

}  // namespace nano
