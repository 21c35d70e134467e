// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/mcap_file.hpp>

#include "column_proposal.hpp"
#include "file_source.hpp"
#include "log_text.hpp"
#include "mcap_messages.hpp"
#include "sqlite_bag.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>

namespace thermopower::io {
namespace {

constexpr std::size_t most_unnamed = 8;  // elements of a list without names that are listed

/// The numbers of a field, or of one element of a list.
struct Numbers {
  std::string key;
  std::size_t samples = 0;
  double least = 0.0, greatest = 0.0;
};

struct Leaf {
  std::string path;
  std::vector<FieldNode*> names;
  std::vector<Numbers> list;
  bool text = false;
};

struct ListedTopic {
  explicit ListedTopic(const McapDecoder::Channel& of) : channel(of), tree(true) {}
  const McapDecoder::Channel& channel;
  FieldTree tree;
  std::unordered_map<const FieldNode*, Leaf> leaves;
  std::vector<const FieldNode*> order;
  std::size_t messages = 0;
  std::uint64_t first_ns = 0, last_ns = 0;
  bool stamped = true;
};

// The path of a node, by search: it is needed once for each.
bool path_of(const FieldNode& node, const FieldNode* wanted, std::string& path) {
  if (&node == wanted) return true;
  const std::size_t size = path.size();
  for (const auto& member : node.members) {
    path += (path.empty() ? "" : ".") + member->name;
    if (path_of(*member, wanted, path)) return true;
    path.resize(size);
  }
  if (node.elements == nullptr) return false;
  path += "[]";
  if (path_of(*node.elements, wanted, path)) return true;
  path.resize(size);
  return false;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

class Lister {
public:
  Lister(std::string file, const std::string& joint) : joint_(joint) { contents_.file = std::move(file); }

  /// @param records  calls the handlers with all of a file's records
  McapContents list(const std::function<void(const McapHandlers&)>& records) {
    McapHandlers handlers;
    handlers.schema = [this](const McapSchema& schema) { decoder_.add(schema); };
    handlers.channel = [this](const McapChannel& channel) { add(channel); };
    handlers.message = [this](const McapMessage& message) { add(message); };
    records(handlers);
    for (auto& [name, topic] : topics_) finish(*topic);
    propose(contents_.columns, hints_, joint_);
    for (ListedColumn& column : contents_.columns)
      if (column.proposed.empty() && column.why.empty()) column.why = "left out unless it is asked for";
    return std::move(contents_);
  }

private:
  void add(const McapChannel& record) {
    const McapDecoder::Channel* const channel = decoder_.add(record);
    if (channel != nullptr && topics_.count(channel->topic) == 0)
      topics_.emplace(channel->topic, std::make_unique<ListedTopic>(*channel));
  }

  void add(const McapMessage& message) {
    try {
      const McapDecoder::Channel& channel = decoder_.channel_of(message);
      ListedTopic& topic = *topics_.at(channel.topic);
      topic.first_ns = topic.messages == 0 ? message.log_ns : std::min(topic.first_ns, message.log_ns);
      topic.last_ns = std::max(topic.last_ns, message.log_ns);
      ++topic.messages;
      if (!channel.unreadable.empty()) return;
      try {
        McapDecoder::read(channel, message.data, topic.tree);
      } catch (const FieldError& error) {
        throw FieldError("message " + std::to_string(topic.messages) + " of " + channel.topic + ": " +
                         error.what());
      }
      topic.stamped = topic.stamped && stamp_of(topic.tree).has_value();
      for (const FieldNode* node : topic.tree.filled()) count(topic, *node);
    } catch (const FieldError& error) {
      throw InputError(contents_.file + ": " + message.place.text() + ": " + error.what());
    }
  }

  static void count(ListedTopic& topic, const FieldNode& node) {
    const auto [place, is_new] = topic.leaves.try_emplace(&node);
    Leaf& leaf = place->second;
    if (is_new) {
      path_of(topic.tree.root(), &node, leaf.path);
      for (const std::string& path : name_paths(leaf.path))
        if (FieldNode* const names = topic.tree.find(path)) leaf.names.push_back(names);
      topic.order.push_back(&node);
    }
    leaf.text = leaf.text || !node.words.empty();
    const std::vector<std::string>* names = nullptr;
    for (const FieldNode* candidate : leaf.names)
      if (names == nullptr && !candidate->words.empty()) names = &candidate->words;
    const std::size_t most = names != nullptr ? names->size() : most_unnamed;
    for (std::size_t i = 0; i < node.numbers.size() && i < most; ++i) {
      const double value = node.numbers[i];
      const std::string key = names != nullptr ? (*names)[i] : std::to_string(i);
      auto found = i < leaf.list.size() && leaf.list[i].key == key
                       ? leaf.list.begin() + static_cast<std::ptrdiff_t>(i)
                       : std::find_if(leaf.list.begin(), leaf.list.end(),
                                      [&](const Numbers& one) { return one.key == key; });
      if (found == leaf.list.end()) {
        leaf.list.push_back({key});
        found = leaf.list.end() - 1;
      }
      if (std::isnan(value)) continue;
      found->least = found->samples == 0 ? value : std::min(found->least, value);
      found->greatest = found->samples == 0 ? value : std::max(found->greatest, value);
      ++found->samples;
    }
  }

  void finish(const ListedTopic& topic) {
    McapTopic told;
    told.name = topic.channel.topic;
    told.schema = topic.channel.schema;
    told.encoding = topic.channel.encoding;
    told.messages = topic.messages;
    told.duration_s = static_cast<double>(topic.last_ns - topic.first_ns) / 1e9;
    told.stamped = topic.stamped && topic.messages > 0 && topic.channel.unreadable.empty();
    told.unreadable = topic.channel.unreadable;
    contents_.topics.push_back(told);
    for (const FieldNode* node : topic.order) {
      const Leaf& leaf = topic.leaves.at(node);
      if (ends_with(leaf.path, "covariance[]") || leaf.path.find("stamp") != std::string::npos) continue;
      for (const Numbers& numbers : leaf.list) {
        ListedColumn column;
        column.header = told.name;
        if (leaf.path.rfind("[]", 0) != 0 && !leaf.path.empty()) column.header += ".";
        const std::size_t list = leaf.path.find("[]");
        column.header += list == std::string::npos ? leaf.path
                                                   : leaf.path.substr(0, list) + "[" + numbers.key + "]" +
                                                         leaf.path.substr(list + 2);
        column.samples = numbers.samples;
        column.missing = topic.messages - std::min(topic.messages, numbers.samples);
        column.least = numbers.least;
        column.greatest = numbers.greatest;
        hints_.push_back(hint_for(topic, leaf));
        contents_.columns.push_back(std::move(column));
      }
    }
  }

  // What the definitions of ROS say, before names and ranges are asked.
  static ColumnHint hint_for(const ListedTopic& topic, const Leaf& leaf) {
    std::string type = topic.channel.schema;
    if (const std::size_t middle = type.find("/msg/"); middle != std::string::npos) type.erase(middle, 4);
    const auto nothing = [](const char* why) { return ColumnHint{{}, why, true, {}}; };
    const auto in = [&](const char* unit, const char* name = "") {
      return ColumnHint{unit, "the definition of " + type, false, name};
    };
    // Time is the messages' own; the layout of an array is no measurement.
    if (leaf.path.find("stamp") != std::string::npos ||
        leaf.path.find("time_from_start") != std::string::npos || leaf.path.compare(0, 7, "layout.") == 0)
      return nothing("");
    if (type == "sensor_msgs/JointState" || type == "trajectory_msgs/JointTrajectoryPoint") {
      if (leaf.path == "position[]") return in("rad");
      if (leaf.path == "velocity[]") return in("rad/s");
    } else if (type == "sensor_msgs/Imu") {
      if (leaf.path.compare(0, 17, "angular_velocity.") != 0) return nothing("");
      ColumnHint hint = in("rad/s");
      if (leaf.path != "angular_velocity.x") hint.because += "; take the joint's axis";
      return hint;
    } else if (type == "sensor_msgs/Temperature") {
      return leaf.path == "variance" ? nothing("") : in("degC");
    } else if (type == "sensor_msgs/BatteryState") {
      if (leaf.path == "voltage") return in("V", "supply_V");
      return nothing(leaf.path == "current" ? "the battery's current, of all motors" : "");
    }
    return {};
  }

  std::string joint_;
  std::vector<ColumnHint> hints_;
  McapContents contents_;
  McapDecoder decoder_;
  std::map<std::string, std::unique_ptr<ListedTopic>> topics_;
};

}  // namespace

McapContents list_mcap(const std::string& path, const std::string& joint) {
  if (kind_of_log(path) == LogKind::sqlite_bag)
    return Lister(path, joint).list([&](const McapHandlers& handlers) { read_sqlite_bag(path, handlers); });
  FileSource source(path);
  return Lister(source.name(), joint).list([&](const McapHandlers& handlers) {
    read_mcap_records(source.name(), source.function(), handlers);
  });
}

McapContents list_mcap(const std::string& name, const char* bytes, std::size_t size,
                       const std::string& joint) {
  return Lister(name, joint).list([&](const McapHandlers& handlers) {
    read_mcap_records(name, memory_source(bytes, size), handlers);
  });
}

std::string topics_text(const McapContents& contents) {
  std::string out;
  char row[300];
  std::snprintf(row, sizeof row, "  %-28s%10s%10s  %-14s%s\n", "topic", "messages", "per s", "time",
                "messages are");
  out += row;
  for (const McapTopic& topic : contents.topics) {
    char rate[32] = "-";
    if (topic.messages > 1 && topic.duration_s > 0.0)
      std::snprintf(rate, sizeof rate, "%.5g", static_cast<double>(topic.messages - 1) / topic.duration_s);
    std::snprintf(row, sizeof row, "  %-28.60s%10zu%10s  %-14s", topic.name.c_str(), topic.messages, rate,
                  topic.stamped ? "header.stamp" : "log_time");
    out += row + (topic.schema.empty() ? "" : topic.schema + ", ") + topic.encoding +
           (topic.unreadable.empty() ? "" : " (not readable: " + topic.unreadable + ")") + "\n";
  }
  return out;
}

std::string columns_text(const McapContents& contents) {
  return topics_text(contents) + "\n" + list_text(contents.columns) +
         next_text(contents.file, contents.columns, false);
}

}  // namespace thermopower::io
