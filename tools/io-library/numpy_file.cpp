// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "log_text.hpp"

#include <thermopower/io/input_error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>

#ifdef THERMOPOWER_HAS_ZLIB
#include <zlib.h>
#endif

namespace thermopower::io {
namespace {

/// A member of a ZIP archive.
struct Member {
  std::string name;
  std::size_t method = 0, packed = 0, size = 0, at = 0;
};

/// One column, or one for each element of a row.
struct Array {
  std::string name;
  std::size_t rows = 0, columns = 1;
  std::vector<double> values;  // row by row
};

class NumpyFile {
public:
  NumpyFile(const std::string& name, const std::string& bytes) : name_(name), bytes_(bytes) {}

  LogText read() {
    std::vector<Array> arrays;
    for (const Member& member : members())
      if (member.name.size() > 4 && member.name.compare(member.name.size() - 4, 4, ".npy") == 0) {
        Array array;
        array.name = member.name.substr(0, member.name.size() - 4);
        if (parse(unpacked(member), array)) arrays.push_back(std::move(array));
      }
    // What is as long as most of it is a column; constants and settings are left out.
    std::map<std::size_t, std::size_t> lengths;
    for (const Array& array : arrays) lengths[array.rows] += array.columns;
    std::size_t rows = 0;
    for (const auto& [length, count] : lengths)
      if (length > 1 && (rows == 0 || count >= lengths[rows])) rows = length;
    if (rows == 0)
      fail(
          "no array of numbers with more than one row; expected arrays such as t_s, angle_deg of one length");
    LogText log;
    std::vector<std::string> header;
    for (const Array& array : arrays) {
      if (array.rows != rows) {
        log.notes.push_back("left out: " + array.name + ", of another length");
        continue;
      }
      for (std::size_t k = 0; k < array.columns; ++k)
        header.push_back(array.columns == 1 ? array.name : array.name + "[" + std::to_string(k) + "]");
    }
    log.csv = csv_row(header);
    std::vector<std::string> row;
    for (std::size_t i = 0; i < rows; ++i) {
      row.clear();
      for (const Array& array : arrays)
        for (std::size_t k = 0; array.rows == rows && k < array.columns; ++k)
          row.push_back(csv_number(array.values[i * array.columns + k]));
      log.csv += csv_row(row);
    }
    return log;
  }

private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  std::uint64_t number(std::size_t at, std::size_t count) const {
    if (at + count > bytes_.size()) fail("the archive ends inside a record (was the file cut off?)");
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_[at + i])) << (8 * i);
    return value;
  }

  // The directory stands at the end of the file.
  std::vector<Member> members() const {
    constexpr std::size_t end_size = 22;
    const std::size_t end = bytes_.rfind("PK\x05\x06");
    if (end == std::string::npos || end + end_size > bytes_.size())
      fail("a ZIP archive without its directory (was the file cut off?)");
    std::vector<Member> list;
    std::size_t at = static_cast<std::size_t>(number(end + 16, 4));
    for (std::size_t i = 0, count = static_cast<std::size_t>(number(end + 10, 2)); i < count; ++i) {
      if (number(at, 4) != 0x02014b50) fail("a damaged directory of the archive");
      Member member;
      member.method = static_cast<std::size_t>(number(at + 10, 2));
      member.packed = static_cast<std::size_t>(number(at + 20, 4));
      member.size = static_cast<std::size_t>(number(at + 24, 4));
      const auto name_size = static_cast<std::size_t>(number(at + 28, 2)),
                 extra = static_cast<std::size_t>(number(at + 30, 2)),
                 comment = static_cast<std::size_t>(number(at + 32, 2));
      const auto local = static_cast<std::size_t>(number(at + 42, 4));
      number(at + 46, std::min<std::size_t>(name_size, 1));
      member.name = bytes_.substr(at + 46, name_size);
      member.at = local + 30 + static_cast<std::size_t>(number(local + 26, 2)) +
                  static_cast<std::size_t>(number(local + 28, 2));
      if (member.packed == 0xffffffff || member.size == 0xffffffff)
        fail(excerpt(member.name) + " is larger than 4 GB; expected smaller arrays");
      if (member.at > bytes_.size() || member.packed > bytes_.size() - member.at)
        fail("the archive ends inside " + excerpt(member.name));
      list.push_back(member);
      at += 46 + name_size + extra + comment;
    }
    return list;
  }

  std::string unpacked(const Member& member) const {
    if (member.method == 0) return bytes_.substr(member.at, member.packed);
    if (member.method != 8) fail(excerpt(member.name) + " is packed in a way that numpy does not use");
#ifdef THERMOPOWER_HAS_ZLIB
    constexpr std::size_t most = std::size_t{1} << 31;
    if (member.size > most) fail(excerpt(member.name) + " unpacks to more than 2 GB");
    std::string out(member.size, '\0');
    z_stream stream{};
    std::string in = bytes_.substr(member.at, member.packed);
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) fail("zlib cannot be started");
    stream.next_in = reinterpret_cast<Bytef*>(&in[0]);
    stream.avail_in = static_cast<uInt>(in.size());
    stream.next_out = reinterpret_cast<Bytef*>(&out[0]);
    stream.avail_out = static_cast<uInt>(out.size());
    const int status = inflate(&stream, Z_FINISH);
    const bool whole = status == Z_STREAM_END && stream.total_out == out.size();
    inflateEnd(&stream);
    if (!whole) fail(excerpt(member.name) + " is damaged");
    return out;
#else
    fail(
        "packed by numpy.savez_compressed, and this program was built without zlib (Debian: zlib1g-dev); numpy.savez writes it plain");
#endif
  }

  static std::string between(const std::string& text, const std::string& begin, const std::string& end) {
    const std::size_t at = text.find(begin);
    if (at == std::string::npos) return {};
    const std::size_t from = at + begin.size(), to = text.find(end, from);
    return to == std::string::npos ? std::string() : text.substr(from, to - from);
  }

  // False where the array holds no numbers, or is no table.
  bool parse(const std::string& npy, Array& array) const {
    if (npy.size() < 12 || npy.compare(0, 6, "\x93NUMPY") != 0)
      fail(excerpt(array.name) + " is not an array of numpy");
    const bool wide = npy[6] >= 2;
    std::size_t size = 0;
    for (std::size_t i = 0; i < (wide ? 4u : 2u); ++i)
      size |= static_cast<std::size_t>(static_cast<unsigned char>(npy[8 + i])) << (8 * i);
    const std::size_t begin = (wide ? 12 : 10) + size;
    if (begin > npy.size()) fail(excerpt(array.name) + " is cut off");
    const std::string header = npy.substr(wide ? 12 : 10, size);
    const std::string type = between(header, "'descr': '", "'"), shape = between(header, "'shape': (", ")");
    if (between(header, "'fortran_order': ", ",") == "True")
      fail(excerpt(array.name) + " is stored column by column; numpy.ascontiguousarray mends that");
    std::vector<std::size_t> sizes;
    for (std::size_t at = 0; at < shape.size();) {
      char* end = nullptr;
      const unsigned long one = std::strtoul(shape.c_str() + at, &end, 10);
      if (end == shape.c_str() + at) break;
      sizes.push_back(one);
      at = static_cast<std::size_t>(end - shape.c_str());
      while (at < shape.size() && (shape[at] == ',' || shape[at] == ' ')) ++at;
    }
    if (sizes.empty() || type.size() < 3 || (type[0] != '<' && type[0] != '|')) return false;
    constexpr std::size_t most = 4096;
    array.rows = sizes[0];
    for (std::size_t i = 1; i < sizes.size(); ++i) {
      if (sizes[i] == 0 || sizes[i] > most || array.columns > most / sizes[i]) return false;
      array.columns *= sizes[i];
    }
    const auto width = static_cast<std::size_t>(std::atoi(type.c_str() + 2));
    const char kind = type[1];
    const bool known =
        (kind == 'f' && (width == 4 || width == 8)) || (kind == 'b' && width == 1) ||
        ((kind == 'i' || kind == 'u') && (width == 1 || width == 2 || width == 4 || width == 8));
    if (!known || array.rows == 0) return false;
    if (array.rows > (npy.size() - begin) / width / array.columns) fail(excerpt(array.name) + " is cut off");
    const std::size_t count = array.rows * array.columns;
    array.values.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      array.values.push_back(element(npy.data() + begin + i * width, kind, width));
    return true;
  }

  template <class T>
  static double as(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
  }

  static double element(const char* at, char kind, std::size_t width) {
    if (kind == 'f') return width == 4 ? as<float>(at) : as<double>(at);
    if (kind == 'b') return as<std::uint8_t>(at);
    const bool is_signed = kind == 'i';
    if (width == 1) return is_signed ? as<std::int8_t>(at) : as<std::uint8_t>(at);
    if (width == 2) return is_signed ? as<std::int16_t>(at) : as<std::uint16_t>(at);
    if (width == 4) return is_signed ? as<std::int32_t>(at) : as<std::uint32_t>(at);
    return is_signed ? as<std::int64_t>(at) : as<std::uint64_t>(at);
  }

  const std::string& name_;
  const std::string& bytes_;
};

}  // namespace

LogText numpy_as_csv(const std::string& name, const std::string& bytes) {
  return NumpyFile(name, bytes).read();
}

}  // namespace thermopower::io
