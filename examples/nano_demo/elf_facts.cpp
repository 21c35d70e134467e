// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "elf_facts.hpp"

#include <fcntl.h>
#include <gelf.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace nano {
namespace {

class OpenElf {
public:
  explicit OpenElf(const std::string& path) : file_(::open(path.c_str(), O_RDONLY)) {
    if (file_ < 0) throw std::runtime_error(path + ": " + std::strerror(errno));
    elf_version(EV_CURRENT);
    elf_ = elf_begin(file_, ELF_C_READ, nullptr);
    GElf_Ehdr header;
    if (elf_ == nullptr || elf_kind(elf_) != ELF_K_ELF || gelf_getehdr(elf_, &header) == nullptr) {
      close();
      throw std::runtime_error(path + ": not an ELF file");
    }
    if (header.e_machine != EM_AVR) {
      close();
      throw std::runtime_error(path + ": an ELF file, but not for AVR (machine " +
                               std::to_string(header.e_machine) + ")");
    }
  }
  OpenElf(const OpenElf&) = delete;
  OpenElf& operator=(const OpenElf&) = delete;
  ~OpenElf() { close(); }
  Elf* get() const { return elf_; }

private:
  void close() {
    if (elf_ != nullptr) elf_end(elf_);
    ::close(file_);
  }
  int file_;
  Elf* elf_ = nullptr;
};

void read_symbols(Elf* elf, Elf_Scn* section, const GElf_Shdr& header, ElfFacts& facts) {
  Elf_Data* data = elf_getdata(section, nullptr);
  if (data == nullptr || header.sh_entsize == 0) return;
  for (std::size_t index = 0; index < header.sh_size / header.sh_entsize; ++index) {
    GElf_Sym symbol;
    if (gelf_getsym(data, static_cast<int>(index), &symbol) == nullptr) continue;
    const char* name = elf_strptr(elf, header.sh_link, symbol.st_name);
    if (name != nullptr && *name != '\0')
      facts.symbols[name] = {static_cast<std::uint32_t>(symbol.st_value),
                             static_cast<std::uint32_t>(symbol.st_size)};
  }
}

}  // namespace

ElfFacts ElfFacts::read(const std::string& path) {
  const OpenElf elf(path);
  ElfFacts facts;
  for (Elf_Scn* section = nullptr; (section = elf_nextscn(elf.get(), section)) != nullptr;) {
    GElf_Shdr header;
    if (gelf_getshdr(section, &header) == nullptr) continue;
    const auto bytes = static_cast<std::uint32_t>(header.sh_size);
    const bool is_loaded = (header.sh_flags & SHF_ALLOC) != 0;
    const bool is_ram = header.sh_addr >= 0x800000u && header.sh_addr < 0x810000u;
    if (is_loaded && header.sh_type == SHT_PROGBITS && header.sh_addr < 0x810000u) facts.flash_bytes += bytes;
    if (is_loaded && is_ram) facts.static_ram_bytes += bytes;
    if (header.sh_type == SHT_SYMTAB) read_symbols(elf.get(), section, header, facts);
  }
  if (facts.flash_bytes == 0) throw std::runtime_error(path + ": holds no program");
  return facts;
}

}  // namespace nano
