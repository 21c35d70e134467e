// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "config_error.hpp"
#include "detail/crc16.hpp"

/// @file config_record.hpp
/// Any component's configuration as a record of bytes, for an EEPROM, a file or a wire, and back.
///
///     uint8_t bytes[64];
///     const size_t size = write_config(config, 1, bytes, sizeof bytes);
///     ...
///     AxisController<Motor>::Config config = AxisController<Motor>::Config::standard();
///     if (read_config(config, 1, bytes, sizeof bytes).error != ConfigRecordError::none) ...  // config is as it was
///
/// | byte | what |
/// |---|---|
/// | 0, 1 | 0x54, 0x50: "TP" |
/// | 2 | format of the record, 1 |
/// | 3 | version of the configuration: yours |
/// | 4, 5 | layout: CRC-16 of the kinds of all fields, in order |
/// | 6, 7 | bytes of fields that follow |
/// | 8 ... | the fields in the order of their declaration: float as IEEE 754 binary32, whole numbers as they are |
/// | last 2 | CRC-16/CCITT-FALSE of everything before |
///
/// Every number has its lowest byte first, whatever the machine. A configuration of your own is stored when it has
/// `template <class Self, class Archive> static void each_field(Self& self, Archive& archive) { archive(self.first,
/// self.second); }`; its fields are numbers, arrays, and structs that have the same.

namespace thermopower {

/// Why a record was not read.
/// @ingroup control
enum class ConfigRecordError : uint8_t {
  none = 0,            ///< It was read.
  too_short = 1,       ///< Fewer bytes than a record has.
  not_a_record = 2,    ///< It does not begin as a record of this format: an empty memory, or another one's.
  damaged = 3,         ///< The check sum is wrong.
  other_version = 4,   ///< Written for another version of the configuration.
  other_layout = 5,    ///< Its fields are of other kinds, or another number of them: another component's.
  config_refused = 6,  ///< It is whole, but `validate()` refuses what it says.
};

/// What reading a record came to.
/// @ingroup control
struct ConfigRead {
  ConfigRecordError error;  ///< `none` when the configuration was read.
  ConfigError field;        ///< With `config_refused`: what `validate()` said.
};

namespace detail {

/// Hands every number of a configuration to a sink, structs and arrays taken apart.
template <class Sink>
class FieldArchive {
public:
  explicit FieldArchive(Sink& sink) noexcept : sink_(sink) {}
  void operator()() noexcept {}
  template <class First, class... Rest>
  void operator()(First& first, Rest&... rest) noexcept {
    take(first, 0);
    (*this)(rest...);
  }

private:
  template <class Field>
  auto take(Field& field, int) noexcept -> decltype(Field::each_field(field, *this), void()) {
    Field::each_field(field, *this);
  }
  template <class Element, size_t count>
  void take(Element (&fields)[count], int) noexcept {
    for (size_t i = 0; i < count; ++i) take(fields[i], 0);
  }
  template <class Number>
  void take(Number& number, long) noexcept {
    sink_.number(number);
  }
  Sink& sink_;
};

/// Has `each_field`.
template <class Config>
struct HasFields {
  struct Nothing {
    template <class Number>
    void number(Number&) noexcept {}
  };
  template <class Type>
  static char test(decltype(Type::each_field(*static_cast<Type*>(nullptr),
                                             *static_cast<FieldArchive<Nothing>*>(nullptr)),
                            0)*);
  template <class Type>
  static long test(...);
  static constexpr bool value = sizeof(test<Config>(nullptr)) == 1;
};

/// Size and kinds of a configuration's fields.
class FieldLayout {
public:
  void number(const float&) noexcept { add('f', 4); }
  void number(const uint8_t&) noexcept { add('b', 1); }
  void number(const uint16_t&) noexcept { add('h', 2); }
  void number(const uint32_t&) noexcept { add('w', 4); }
  uint16_t size() const noexcept { return size_; }
  uint16_t kinds() const noexcept { return kinds_; }

private:
  void add(char kind, uint8_t bytes) noexcept {
    const uint8_t code = static_cast<uint8_t>(kind);
    kinds_ = crc16(&code, 1, kinds_);
    size_ = static_cast<uint16_t>(size_ + bytes);
  }
  uint16_t size_ = 0, kinds_ = 0xffffu;
};

class FieldWriter {
public:
  explicit FieldWriter(uint8_t* bytes) noexcept : next_(bytes) {}
  void number(const float& value) noexcept {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(bits, 4);
  }
  void number(const uint8_t& value) noexcept { put(value, 1); }
  void number(const uint16_t& value) noexcept { put(value, 2); }
  void number(const uint32_t& value) noexcept { put(value, 4); }

private:
  void put(uint32_t value, uint8_t bytes) noexcept {
    for (; bytes != 0; --bytes, value >>= 8) *next_++ = static_cast<uint8_t>(value);
  }
  uint8_t* next_;
};

class FieldReader {
public:
  explicit FieldReader(const uint8_t* bytes) noexcept : next_(bytes) {}
  void number(float& value) noexcept {
    const uint32_t bits = get(4);
    memcpy(&value, &bits, sizeof value);
  }
  void number(uint8_t& value) noexcept { value = static_cast<uint8_t>(get(1)); }
  void number(uint16_t& value) noexcept { value = static_cast<uint16_t>(get(2)); }
  void number(uint32_t& value) noexcept { value = get(4); }

private:
  uint32_t get(uint8_t bytes) noexcept {
    uint32_t value = 0;
    for (uint8_t i = 0; i < bytes; ++i) value |= static_cast<uint32_t>(*next_++) << (8u * i);
    return value;
  }
  const uint8_t* next_;
};

/// Bytes before the fields and after them.
constexpr uint16_t config_record_head() { return 8; }
/// @copydoc config_record_head
constexpr uint16_t config_record_tail() { return 2; }

inline void put_word(uint8_t* bytes, uint16_t value) noexcept {
  bytes[0] = static_cast<uint8_t>(value);
  bytes[1] = static_cast<uint8_t>(value >> 8);
}
inline uint16_t word_at(const uint8_t* bytes) noexcept {
  return static_cast<uint16_t>(bytes[0] | static_cast<uint16_t>(static_cast<uint16_t>(bytes[1]) << 8));
}

/// What is wrong with a record before its fields are looked at.
inline ConfigRecordError find_record_error(const FieldLayout& layout, uint8_t version, const uint8_t* bytes,
                                           size_t size) noexcept {
  if (size < static_cast<size_t>(config_record_head() + config_record_tail()))
    return ConfigRecordError::too_short;
  if (bytes[0] != 0x54 || bytes[1] != 0x50 || bytes[2] != 1) return ConfigRecordError::not_a_record;
  const uint16_t fields = word_at(bytes + 6);
  if (size - config_record_head() - config_record_tail() < fields) return ConfigRecordError::too_short;
  const uint16_t summed = static_cast<uint16_t>(config_record_head() + fields);
  if (crc16(bytes, summed) != word_at(bytes + summed)) return ConfigRecordError::damaged;
  if (bytes[3] != version) return ConfigRecordError::other_version;
  return word_at(bytes + 4) == layout.kinds() && fields == layout.size() ? ConfigRecordError::none
                                                                         : ConfigRecordError::other_layout;
}

template <class Config>
FieldLayout layout_of(const Config& config) noexcept {
  static_assert(
      HasFields<const Config>::value,
      "thermopower: this configuration cannot be stored: it needs static each_field(self, archive)");
  FieldLayout layout;
  FieldArchive<FieldLayout> archive(layout);
  Config::each_field(config, archive);
  return layout;
}

}  // namespace detail

/// Bytes of a configuration's record. @param config  only its type counts
/// @ingroup control
template <class Config>
size_t config_record_size(const Config& config) noexcept {
  return static_cast<size_t>(detail::config_record_head()) + detail::layout_of(config).size() +
         detail::config_record_tail();
}

/// Writes a configuration, good or bad, as a record.
/// @param version  of what the fields mean, 0 .. 255: raise it when a field changes its meaning, and give two
///                 components whose fields are of the same kinds different ones: nothing else tells them apart
/// @param bytes    where to  @param size  how much room there is
/// @return bytes written; 0 when there is not room for all of them: then nothing is
/// @ingroup control
template <class Config>
size_t write_config(const Config& config, uint8_t version, uint8_t* bytes, size_t size) noexcept {
  const detail::FieldLayout layout = detail::layout_of(config);
  const uint16_t summed = static_cast<uint16_t>(detail::config_record_head() + layout.size());
  if (size < static_cast<size_t>(summed) + detail::config_record_tail()) return 0;
  bytes[0] = 0x54;
  bytes[1] = 0x50;
  bytes[2] = 1;
  bytes[3] = version;
  detail::put_word(bytes + 4, layout.kinds());
  detail::put_word(bytes + 6, layout.size());
  detail::FieldWriter writer(bytes + detail::config_record_head());
  detail::FieldArchive<detail::FieldWriter> archive(writer);
  Config::each_field(config, archive);
  detail::put_word(bytes + summed, detail::crc16(bytes, summed));
  return static_cast<size_t>(summed) + detail::config_record_tail();
}

/// Reads a configuration from a record, and asks its `validate()`.
/// @param config   unchanged unless the result is `ConfigRecordError::none`
/// @param version  the record must have been written with  @param bytes  a record; what follows it is not read
/// @param size     bytes there are
/// @ingroup control
template <class Config>
ConfigRead read_config(Config& config, uint8_t version, const uint8_t* bytes, size_t size) noexcept {
  ConfigRead result = {detail::find_record_error(detail::layout_of(config), version, bytes, size),
                       ConfigError::none};
  if (result.error != ConfigRecordError::none) return result;
  Config stored = config;
  detail::FieldReader reader(bytes + detail::config_record_head());
  detail::FieldArchive<detail::FieldReader> archive(reader);
  Config::each_field(stored, archive);
  result.field = stored.validate();
  if (is_error(result.field)) result.error = ConfigRecordError::config_refused;
  else config = stored;
  return result;
}

}  // namespace thermopower
