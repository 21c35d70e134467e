// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include "field_tree.hpp"
#include "mcap_records.hpp"
#include "ros2_schema.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A field as it is asked for: its path without the key of the list's element, and that key.
struct FieldPath {
  std::string path;      ///< as FieldTree::at() takes it: `position[]`
  bool in_list = false;  ///< there is a key
  std::string key;       ///< index or name of the element
  /// The index that the key is, where it is a number.
  std::optional<std::size_t> index() const;
};

/// @brief Reads `.position[elbow]` or `[2]`, what follows a topic's name. @throws FieldError what is wrong with it
FieldPath parse_field_path(const std::string& text);

/// @brief Where the names of a list's elements may stand, nearest first, for the path of a leaf in that list.
std::vector<std::string> name_paths(const std::string& leaf_path);

/// @brief Paths of the two halves of a stamp, seconds and nanoseconds, that messages are known to have.
const std::vector<std::pair<std::string, std::string>>& stamp_paths();

/// @brief Joins schemas and channels: knows how the messages of a channel are read.
class McapDecoder {
public:
  struct Channel {
    std::string topic, schema, encoding;
    std::string unreadable;                  ///< why its messages cannot be read; empty: they can
    std::shared_ptr<const Ros2Schema> type;  ///< of messages in CDR
  };

  /// Notes a schema.
  void add(const McapSchema& schema);
  /// Notes a channel. @return it; null where it was there already
  const Channel* add(const McapChannel& channel);
  /// The channel of a message. @throws FieldError where there is none
  const Channel& channel_of(const McapMessage& message) const;
  /// Reads a message's fields. @throws FieldError
  static void read(const Channel& channel, ByteView message, FieldTree& tree);

private:
  struct Schema {
    std::string name, encoding, text;
    std::shared_ptr<const Ros2Schema> type;
    std::string fault;
    bool parsed = false;
  };
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
};

/// @brief The time of measurement that a message in a tree holds, in ns; nothing where it has none, or 0.
std::optional<std::int64_t> stamp_of(FieldTree& tree);

}  // namespace thermopower::io
