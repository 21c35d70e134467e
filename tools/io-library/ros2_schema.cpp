// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "ros2_schema.hpp"

#include <thermopower/io/input_error.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <sstream>

namespace thermopower::io {
namespace {

// `sensor_msgs/msg/Imu` and `sensor_msgs/Imu` are one type.
std::string short_type(const std::string& name) {
  const std::size_t middle = name.find("/msg/");
  return middle == std::string::npos ? name : name.substr(0, middle) + name.substr(middle + 4);
}

std::string package_of(const std::string& type) { return type.substr(0, type.find('/')); }

}  // namespace

Ros2Schema::Ros2Schema(const std::string& name, const std::string& text) {
  read_definition(name, text);
  find_types();
  std::vector<char> state(types_.size(), 0);
  refuse_cycles(0, state);
}

void Ros2Schema::read_definition(const std::string& name, const std::string& text) {
  types_.push_back({short_type(name), package_of(name), {}});
  by_name_[types_[0].name] = 0;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.rfind("====", 0) == 0) continue;  // between two definitions
    if (line.rfind("MSG:", 0) == 0) {
      std::string type = line.substr(4);
      type.erase(0, type.find_first_not_of(" \t"));
      type.erase(type.find_last_not_of(" \t\r") + 1);
      type = short_type(type);
      if (!by_name_.emplace(type, types_.size()).second)
        throw FieldError("line " + std::to_string(number) + " of its definition: " + excerpt(type) +
                         " is defined twice");
      types_.push_back({type, package_of(type), {}});
      continue;
    }
    read_line(line, number, types_.back());
  }
}

void Ros2Schema::read_line(std::string line, std::size_t number, Type& type) {
  line.erase(std::min(line.find('#'), line.size()));
  std::istringstream words(line);
  std::string what, name, third;
  if (!(words >> what)) return;
  const auto fail = [&](const std::string& text) {
    throw FieldError("line " + std::to_string(number) + " of its definition: " + text);
  };
  if (!(words >> name)) fail(excerpt(what) + " alone; expected a type and a name");
  words >> third;
  if (name.find('=') != std::string::npos || third.rfind("=", 0) == 0) return;  // a constant
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  if (!std::all_of(name.begin(), name.end(), plain)) fail(excerpt(name) + " is not a name of a field");
  Field field;
  field.name = name;
  field.line = number;
  const std::size_t bracket = what.find('[');
  if (bracket != std::string::npos) {
    const std::string inside = what.substr(bracket + 1, what.size() - bracket - 2);
    if (what.back() != ']') fail(excerpt(what) + " is not a type; expected a ']' at its end");
    field.many = inside.empty() || inside.rfind("<=", 0) == 0 ? Many::counted : Many::fixed;
    if (field.many == Many::fixed) {
      const auto [end, error] = std::from_chars(inside.data(), inside.data() + inside.size(), field.count);
      if (error != std::errc() || end != inside.data() + inside.size() || field.count == 0)
        fail(excerpt(what) + " is not a type; expected the length of an array in brackets");
    }
    what.erase(bracket);
  }
  what.erase(std::min(what.find("<="), what.size()));  // of a text: how long it may be
  struct Primitive {
    const char* name;
    Kind kind;
    unsigned size;
  };
  static const Primitive primitives[] = {
      {"bool", Kind::boolean, 1},        {"byte", Kind::unsigned_int, 1},   {"char", Kind::unsigned_int, 1},
      {"int8", Kind::signed_int, 1},     {"uint8", Kind::unsigned_int, 1},  {"int16", Kind::signed_int, 2},
      {"uint16", Kind::unsigned_int, 2}, {"int32", Kind::signed_int, 4},    {"uint32", Kind::unsigned_int, 4},
      {"int64", Kind::signed_int, 8},    {"uint64", Kind::unsigned_int, 8}, {"float32", Kind::real, 4},
      {"float64", Kind::real, 8},        {"string", Kind::text, 4},         {"wstring", Kind::wide_text, 4}};
  const auto* found = std::find_if(std::begin(primitives), std::end(primitives),
                                   [&](const Primitive& one) { return what == one.name; });
  if (found != std::end(primitives)) {
    field.kind = found->kind;
    field.size = found->size;
  } else {
    field.kind = Kind::structure;
    field.type_name = what;
  }
  type.fields.push_back(std::move(field));
}

void Ros2Schema::find_types() {
  for (std::size_t i = 0; i < types_.size(); ++i)  // it grows on the way
    for (std::size_t k = 0; k < types_[i].fields.size(); ++k)
      if (types_[i].fields[k].kind == Kind::structure) {
        const std::size_t type = find_type(types_[i].fields[k], types_[i]);
        types_[i].fields[k].type = type;
      }
}

std::size_t Ros2Schema::find_type(const Field& field, const Type& user) {
  const std::string name = short_type(field.type_name);
  std::vector<std::string> names = {name};
  if (name.find('/') == std::string::npos) {
    names = {user.package + "/" + name};
    if (name == "Header") names.push_back("std_msgs/Header");
    if (name == "time" || name == "duration")
      names.push_back(name == "time" ? "builtin_interfaces/Time" : "builtin_interfaces/Duration");
  }
  for (const std::string& one : names) {
    const auto known = by_name_.find(one);
    if (known != by_name_.end()) return known->second;
  }
  // Some writers take these for granted.
  const std::string& last = names.back();
  if (last == "builtin_interfaces/Time" || last == "builtin_interfaces/Duration") {
    Type stamp{last, "builtin_interfaces", {}};
    read_line("int32 sec", 0, stamp);
    read_line("uint32 nanosec", 0, stamp);
    by_name_[last] = types_.size();
    types_.push_back(std::move(stamp));
    return types_.size() - 1;
  }
  throw FieldError("line " + std::to_string(field.line) + " of its definition: field '" + field.name +
                   "': the type " + excerpt(field.type_name) + " is not defined");
}

void Ros2Schema::refuse_cycles(std::size_t type, std::vector<char>& state) const {
  if (state[type] == 2) return;
  if (state[type] == 1)
    throw FieldError("its definition: " + excerpt(types_[type].name) + " contains itself");
  state[type] = 1;
  for (const Field& field : types_[type].fields)
    if (field.kind == Kind::structure) refuse_cycles(field.type, state);
  state[type] = 2;
}

/// One message, front to back.
class Ros2Schema::Walk {
public:
  Walk(const Ros2Schema& schema, ByteView message, FieldTree& tree)
      : schema_(schema), message_(message), tree_(tree) {}

  void run() {
    if (message_.size < 4)
      throw FieldError("a message of " + std::to_string(message_.size) +
                       " bytes; expected the four that begin CDR");
    const unsigned kind = message_.data[1];
    const bool second = kind == 6 || kind == 7;  // XCDR2, where 8 bytes are aligned as 4 are
    if (message_.data[0] != 0 || (kind > 1 && !second))
      throw FieldError("CDR of the kind " + std::to_string(message_.data[0] * 256 + kind) +
                       "; expected 0 or 1 (plain), or 6 or 7 (plain, second edition)");
    swapped_ = (kind & 1) == 0;
    most_aligned_ = second ? 4 : 8;
    structure(0, &tree_.root(), 0, 0);
  }

private:
  [[noreturn]] void fail(const Field& field, std::uint64_t wanted) const {
    throw FieldError("field '" + field.name + "': the message of " + std::to_string(message_.size) +
                     " bytes ends inside it; expected " + std::to_string(wanted) + " more from byte " +
                     std::to_string(at_) + " on");
  }

  void align(std::size_t size) {
    const std::size_t step = std::min(size, most_aligned_);
    at_ += (step - (at_ - 4) % step) % step;
  }

  void expect(const Field& field, std::uint64_t size) const {
    if (at_ > message_.size || size > message_.size - at_) fail(field, size);
  }

  std::uint64_t bits(std::size_t size) {
    std::uint64_t value = 0;
    const unsigned char* const bytes = message_.data + at_;
    for (std::size_t i = 0; i < size; ++i)
      value |= std::uint64_t{bytes[swapped_ ? size - 1 - i : i]} << 8 * i;
    at_ += size;
    return value;
  }

  std::uint64_t count(const Field& field) {
    align(4);
    expect(field, 4);
    return bits(4);
  }

  double number(const Field& field) {
    const std::uint64_t value = bits(field.size);
    switch (field.kind) {
      case Kind::signed_int: {
        const unsigned unused = 64 - 8 * field.size;
        std::int64_t with_sign = 0;
        const std::uint64_t shifted = value << unused;
        std::memcpy(&with_sign, &shifted, 8);
        return static_cast<double>(with_sign >> unused);
      }
      case Kind::real:
        if (field.size == 8) {
          double real = 0.0;
          std::memcpy(&real, &value, 8);
          return real;
        } else {
          const auto half = static_cast<std::uint32_t>(value);
          float real = 0.0f;
          std::memcpy(&real, &half, 4);
          return static_cast<double>(real);
        }
      default:
        return static_cast<double>(value);
    }
  }

  // A list in a list has no name by which it could be asked for: it is walked past.
  void structure(std::size_t type, FieldNode* node, std::size_t index, unsigned lists) {
    const Type& definition = schema_.types_[type];
    for (const Field& field : definition.fields) {
      FieldNode* const child = tree_.member(node, field.name.data(), field.name.size());
      if (field.many == Many::one) {
        one(field, child, index, lists);
        continue;
      }
      const std::uint64_t length = field.many == Many::fixed ? field.count : count(field);
      FieldNode* const elements = lists == 0 ? tree_.elements(child) : nullptr;
      list(field, elements, length, lists + 1);
    }
    // C++ has no empty structure, and so a message has a byte for it.
    if (definition.fields.empty()) ++at_;
    if (at_ > message_.size)
      throw FieldError("the message of " + std::to_string(message_.size) + " bytes ends inside '" +
                       definition.name + "'");
  }

  void list(const Field& field, FieldNode* elements, std::uint64_t length, unsigned lists) {
    if (length == 0) return;
    const bool plain =
        field.kind != Kind::structure && field.kind != Kind::text && field.kind != Kind::wide_text;
    if (plain) {
      align(field.size);
      if (length > message_.size) fail(field, length);
      expect(field, length * field.size);
      if (elements == nullptr) {
        at_ += static_cast<std::size_t>(length) * field.size;
        return;
      }
    }
    for (std::uint64_t i = 0; i < length; ++i) one(field, elements, static_cast<std::size_t>(i), lists);
  }

  void one(const Field& field, FieldNode* node, std::size_t index, unsigned lists) {
    if (field.kind == Kind::structure) {
      structure(field.type, node, index, lists);
    } else if (field.kind == Kind::wide_text) {
      throw FieldError("field '" + field.name + "': texts of wide characters cannot be read");
    } else if (field.kind == Kind::text) {
      const std::uint64_t length = count(field);
      expect(field, length);
      const char* const text = reinterpret_cast<const char*>(message_.data + at_);
      const auto size = static_cast<std::size_t>(length);
      if (node != nullptr)
        tree_.put(node, index, std::string(text, size > 0 && text[size - 1] == 0 ? size - 1 : size));
      at_ += size;
    } else {
      align(field.size);
      expect(field, field.size);
      if (node == nullptr) at_ += field.size;
      else tree_.put(node, index, number(field));
    }
  }

  const Ros2Schema& schema_;
  ByteView message_;
  FieldTree& tree_;
  std::size_t at_ = 4;
  std::size_t most_aligned_ = 8;
  bool swapped_ = false;
};

void Ros2Schema::read(ByteView message, FieldTree& tree) const { Walk(*this, message, tree).run(); }

}  // namespace thermopower::io
