// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "mcap_messages.hpp"

#include <thermopower/io/input_error.hpp>

#include "json_message.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace thermopower::io {

std::optional<std::size_t> FieldPath::index() const {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), value);
  if (key.empty() || error != std::errc() || end != key.data() + key.size()) return std::nullopt;
  return value;
}

FieldPath parse_field_path(const std::string& text) {
  FieldPath field;
  const std::size_t open = text.find('[');
  field.path = text.substr(0, open);
  if (open != std::string::npos) {
    const std::size_t close = text.find(']', open);
    if (close == std::string::npos) throw FieldError("expected a ']' after the '['");
    field.in_list = true;
    field.key = text.substr(open + 1, close - open - 1);
    if (field.key.empty()) throw FieldError("expected an index or a name in the brackets");
    field.path += "[]" + text.substr(close + 1);
    if (text.find('[', close) != std::string::npos)
      throw FieldError("a list in a list; expected one pair of brackets");
  }
  if (!field.path.empty() && field.path[0] == '.') field.path.erase(0, 1);
  if (field.path.find("..") != std::string::npos || (!field.path.empty() && field.path.back() == '.'))
    throw FieldError("expected a name after each point");
  return field;
}

std::vector<std::string> name_paths(const std::string& leaf_path) {
  static const char* const names[] = {"name", "names", "joint_names", "joint_name"};
  std::vector<std::string> list;
  const std::size_t open = leaf_path.find("[]");
  if (open == std::string::npos) return list;
  if (open + 2 < leaf_path.size()) {
    for (const char* name : names) list.push_back(leaf_path.substr(0, open) + "[]." + name);
    return list;
  }
  for (std::string scope = leaf_path.substr(0, open);;) {
    const std::size_t point = scope.rfind('.');
    scope = point == std::string::npos ? std::string() : scope.substr(0, point);
    for (const char* name : names) list.push_back((scope.empty() ? "" : scope + ".") + name + "[]");
    if (scope.empty()) return list;
  }
}

const std::vector<std::pair<std::string, std::string>>& stamp_paths() {
  static const std::vector<std::pair<std::string, std::string>> list = {
      {"header.stamp.sec", "header.stamp.nanosec"},
      {"header.stamp.sec", "header.stamp.nsec"},
      {"stamp.sec", "stamp.nanosec"},
      {"stamp.sec", "stamp.nsec"},
      {"timestamp.sec", "timestamp.nanosec"},
      {"timestamp.sec", "timestamp.nsec"}};
  return list;
}

std::optional<std::int64_t> stamp_of(FieldTree& tree) {
  for (const auto& [seconds, nanoseconds] : stamp_paths()) {
    const FieldNode* const s = tree.find(seconds);
    const FieldNode* const ns = tree.find(nanoseconds);
    if (s == nullptr || ns == nullptr || s->numbers.empty() || ns->numbers.empty()) continue;
    const double whole = s->numbers[0], part = ns->numbers[0];
    const bool sensible = std::fabs(whole) < 9e9 && part >= 0.0 && part < 1e9;
    if (!sensible || (whole == 0.0 && part == 0.0)) return std::nullopt;
    return static_cast<std::int64_t>(whole) * 1000000000 + static_cast<std::int64_t>(part);
  }
  return std::nullopt;
}

void McapDecoder::add(const McapSchema& schema) {
  Schema& known = schemas_[schema.id];
  const std::string text(reinterpret_cast<const char*>(schema.text.data), schema.text.size);
  if (known.text == text && known.name == schema.name) return;  // repeated in each chunk by some writers
  known = Schema();
  known.name = schema.name;
  known.encoding = schema.encoding;
  known.text = text;
}

const McapDecoder::Channel* McapDecoder::add(const McapChannel& channel) {
  const auto [place, is_new] = channels_.try_emplace(channel.id);
  if (!is_new) return nullptr;
  Channel& added = place->second;
  added.topic = channel.topic;
  added.encoding = channel.encoding;
  const auto found = schemas_.find(channel.schema);
  if (found != schemas_.end()) added.schema = found->second.name;
  if (channel.encoding == "json") return &added;
  if (channel.encoding != "cdr") {
    added.unreadable = "its messages are encoded as " + excerpt(channel.encoding) + "; expected cdr or json";
  } else if (found == schemas_.end()) {
    added.unreadable = "its messages are encoded as cdr, and there is no schema that says what is in them";
  } else if (found->second.encoding != "ros2msg") {
    added.unreadable = "its messages are encoded as cdr with a schema in " + excerpt(found->second.encoding) +
                       "; expected ros2msg";
  } else {
    Schema& schema = found->second;
    if (!schema.parsed) {
      schema.parsed = true;
      try {
        schema.type = std::make_shared<const Ros2Schema>(schema.name, schema.text);
      } catch (const FieldError& error) {
        schema.fault = "schema " + excerpt(schema.name) + ": " + error.what();
      }
    }
    added.type = schema.type;
    added.unreadable = schema.fault;
  }
  return &added;
}

const McapDecoder::Channel& McapDecoder::channel_of(const McapMessage& message) const {
  const auto found = channels_.find(message.channel);
  if (found == channels_.end())
    throw FieldError("a message of channel " + std::to_string(message.channel) +
                     ", which no record before it describes");
  return found->second;
}

void McapDecoder::read(const Channel& channel, ByteView message, FieldTree& tree) {
  tree.clear();
  if (channel.type) channel.type->read(message, tree);
  else read_json_message(message, tree);
}

}  // namespace thermopower::io
