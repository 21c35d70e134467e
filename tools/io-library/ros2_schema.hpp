// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include "field_tree.hpp"
#include "mcap_records.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A message type of ROS 2 as its definition says (`ros2msg`: the text of a .msg file, followed by those of
/// the types that it uses), and its messages as CDR has them.
class Ros2Schema {
public:
  /// @throws FieldError with the line of the definition and what was expected
  Ros2Schema(const std::string& name, const std::string& text);

  /// @brief Reads a message into a tree of fields.
  /// @throws FieldError with the field and what was expected
  void read(ByteView message, FieldTree& tree) const;

private:
  enum class Kind : unsigned char { boolean, signed_int, unsigned_int, real, text, wide_text, structure };
  enum class Many : unsigned char { one, fixed, counted };
  struct Field {
    std::string name;
    Kind kind = Kind::boolean;
    Many many = Many::one;
    unsigned size = 1;        ///< of a number in bytes
    std::uint64_t count = 1;  ///< of a fixed array
    std::size_t type = 0;     ///< of a structure
    std::string type_name;    ///< of a structure, until it is found
    std::size_t line = 0;
  };
  struct Type {
    std::string name, package;
    std::vector<Field> fields;
  };
  class Walk;

  void read_definition(const std::string& name, const std::string& text);
  void read_line(std::string line, std::size_t number, Type& type);
  void find_types();
  std::size_t find_type(const Field& field, const Type& user);
  void refuse_cycles(std::size_t type, std::vector<char>& state) const;

  std::vector<Type> types_;  ///< the first is the message's
  std::map<std::string, std::size_t> by_name_;
};

}  // namespace thermopower::io
