// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/mcap_file.hpp>

#include <thermopower/io/input_error.hpp>

#include "file_source.hpp"
#include "log_text.hpp"
#include "mcap_messages.hpp"
#include "sqlite_bag.hpp"
#include "stream_join.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <utility>

namespace thermopower::io {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr double other_clock_s = 0.5;  // between what two topics' stamps are behind the recorder's clock

enum class Clock { stamps_if_all, stamps, log, publish, field };

/// A column that is taken from a topic.
struct Taken {
  ColumnChoice choice;
  std::string path;  ///< as the user has it, behind the topic
  FieldPath field;
  FieldNode* node = nullptr;
  std::vector<FieldNode*> names;  ///< where the element's name may be looked up
  std::size_t last_index = 0;     ///< where it was the last time
  bool implied = false;           ///< nobody asked for it: it bears a name of the format
  bool seen = false;
  std::vector<double> values;
};

/// A topic some of whose fields are taken.
struct Topic {
  explicit Topic(std::string topic) : name(std::move(topic)), tree(false) {}
  std::string name;
  FieldTree tree;
  std::vector<Taken> taken;
  std::vector<std::int64_t> log_ns, publish_ns, stamp_ns;
  std::size_t messages = 0, without_stamp = 0;
  std::string first_without_stamp;  ///< which message
};

class Selector {
public:
  Selector(std::string file, const std::vector<ColumnChoice>& choices) : file_(std::move(file)) {
    for (const ColumnChoice& choice : choices) {
      if (choice.name != "t_s") {
        wanted_.push_back(choice);
        continue;
      }
      const std::string& clock = choice.header;
      clock_ = clock == "log_time"       ? Clock::log
               : clock == "publish_time" ? Clock::publish
               : clock == "header.stamp" ? Clock::stamps
                                         : Clock::field;
      if (clock_ == Clock::field) wanted_.push_back(choice);
    }
    used_.assign(wanted_.size(), 0);
  }

  /// @param records  calls the handlers with all of a file's records
  RecordingFile read(const std::function<void(const McapHandlers&)>& records) {
    McapHandlers handlers;
    handlers.schema = [this](const McapSchema& schema) { decoder_.add(schema); };
    handlers.channel = [this](const McapChannel& channel) { add(channel); };
    handlers.message = [this](const McapMessage& message) { add(message); };
    records(handlers);
    return finish();
  }

private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(file_ + ": " + what); }
  [[noreturn]] void fail(const std::string& column, const std::string& what) const {
    fail("column '" + column + "': " + what);
  }

  // What is asked for of a topic that appears.
  void add(const McapChannel& record) {
    const McapDecoder::Channel* const channel = decoder_.add(record);
    if (channel == nullptr) return;
    seen_topics_.push_back(channel->topic);
    if (topics_.count(channel->topic) != 0) {
      refuse_unreadable(*channel, *topics_.at(channel->topic));
      return;
    }
    auto topic = std::make_unique<Topic>(channel->topic);
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      const std::string& header = wanted_[i].header;
      const std::size_t size = topic->name.size();
      if (header.compare(0, size, topic->name) != 0) continue;
      if (header.size() > size && header[size] != '.' && header[size] != '[') continue;
      if (used_[i] != 0)
        fail(wanted_[i].name, excerpt(header) + " may be a field of two topics; expected one that is");
      used_[i] = 1;
      take(*topic, wanted_[i], header.substr(size), false);
    }
    if (channel->unreadable.empty())
      for (const std::string& name : known_columns()) {
        const bool chosen = std::any_of(wanted_.begin(), wanted_.end(),
                                        [&](const ColumnChoice& one) { return one.name == name; });
        if (name != "t_s" && !chosen) take(*topic, {name, name}, "." + name, true);
      }
    if (topic->taken.empty()) return;
    refuse_unreadable(*channel, *topic);
    for (const auto& [seconds, nanoseconds] : stamp_paths()) {
      topic->tree.at(seconds);
      topic->tree.at(nanoseconds);
    }
    topics_.emplace(channel->topic, std::move(topic));
  }

  void refuse_unreadable(const McapDecoder::Channel& channel, const Topic& topic) const {
    if (channel.unreadable.empty()) return;
    for (const Taken& one : topic.taken)
      if (!one.implied) fail(one.choice.name, "topic " + channel.topic + ": " + channel.unreadable);
  }

  void take(Topic& topic, const ColumnChoice& choice, const std::string& path, bool implied) {
    Taken taken;
    taken.choice = choice;
    taken.path = path;
    taken.implied = implied;
    try {
      taken.field = parse_field_path(path);
      taken.node = &topic.tree.at(taken.field.path);
      if (taken.field.in_list && !taken.field.index())
        for (const std::string& names : name_paths(taken.field.path))
          taken.names.push_back(&topic.tree.at(names));
    } catch (const FieldError& error) {
      fail(choice.name, excerpt(choice.header) + ": " + error.what());
    }
    topic.taken.push_back(std::move(taken));
  }

  void add(const McapMessage& message) {
    try {
      const McapDecoder::Channel& channel = decoder_.channel_of(message);
      const auto found = topics_.find(channel.topic);
      if (found == topics_.end() || !channel.unreadable.empty()) return;
      Topic& topic = *found->second;
      ++topic.messages;
      try {
        McapDecoder::read(channel, message.data, topic.tree);
        keep(topic, message);
      } catch (const FieldError& error) {
        fail(place(topic, message) + ": " + error.what());
      }
    } catch (const FieldError& error) {
      fail(message.place.text() + ": " + error.what());
    }
  }

  static std::string place(const Topic& topic, const McapMessage& message) {
    return "message " + std::to_string(topic.messages) + " of " + topic.name + " (" + message.place.text() +
           ")";
  }

  static std::int64_t checked_ns(std::uint64_t ns, const char* which) {
    if (ns > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() / 2))
      throw FieldError(std::string(which) + " is " + std::to_string(ns) +
                       " ns; expected a time of this century");
    return static_cast<std::int64_t>(ns);
  }

  void keep(Topic& topic, const McapMessage& message) {
    topic.log_ns.push_back(checked_ns(message.log_ns, "the log time"));
    topic.publish_ns.push_back(checked_ns(message.publish_ns, "the publish time"));
    const auto stamp = stamp_of(topic.tree);
    topic.stamp_ns.push_back(stamp.value_or(0));
    if (!stamp && topic.without_stamp++ == 0) topic.first_without_stamp = place(topic, message);
    for (Taken& one : topic.taken) one.values.push_back(value_of(one));
  }

  double value_of(Taken& one) const {
    const std::vector<double>& numbers = one.node->numbers;
    std::size_t index = 0;
    if (one.field.in_list) {
      const auto number = one.field.index();
      if (number) {
        index = *number;
      } else {
        const std::vector<std::string>* names = nullptr;
        for (const FieldNode* candidate : one.names)
          if (names == nullptr && !candidate->words.empty()) names = &candidate->words;
        if (names == nullptr) return missing;
        index = one.last_index;
        if (index >= names->size() || (*names)[index] != one.field.key)
          index = static_cast<std::size_t>(std::find(names->begin(), names->end(), one.field.key) -
                                           names->begin());
        if (index >= names->size()) return missing;
        one.last_index = index;
      }
    }
    if (index >= numbers.size()) {
      if (index < one.node->words.size() && !one.implied)
        throw FieldError("field '" + one.path.substr(one.path.find('.') == 0 ? 1 : 0) + "' is the text " +
                         excerpt(one.node->words[index]) + "; expected a number");
      return missing;
    }
    const double number = numbers[index];
    one.seen = true;
    if (std::isinf(number))
      throw FieldError("field '" + one.path.substr(1) +
                       "' is infinite; expected a finite number, or nan for a missing sample");
    const double value = io::value_of(one.choice, number);
    if (one.choice.name == "power_param" && !std::isnan(value) && !(value >= 0.0 && value <= 255.0))
      throw FieldError("field '" + one.path.substr(1) +
                       "' is outside the range of power_param; expected 0..255");
    return value;
  }

  RecordingFile finish() {
    for (std::size_t i = 0; i < wanted_.size(); ++i)
      if (used_[i] == 0)
        fail(wanted_[i].name,
             "there is no topic for " + excerpt(wanted_[i].header) + "; found " + topic_list());
    std::vector<Topic*> used;
    for (auto& [name, topic] : topics_) {
      for (const Taken& one : topic->taken)
        if (!one.seen && !one.implied) fail_unseen(*topic, one);
      topic->taken.erase(std::remove_if(topic->taken.begin(), topic->taken.end(),
                                        [](const Taken& one) { return !one.seen; }),
                         topic->taken.end());
      if (!topic->taken.empty()) used.push_back(topic.get());
    }
    std::map<std::string, const Topic*> columns;
    for (const Topic* topic : used)
      for (const Taken& one : topic->taken) {
        const auto [place, is_new] = columns.emplace(one.choice.name, topic);
        if (!is_new)
          fail(one.choice.name, "is in " + place->second->name + " and in " + topic->name +
                                    "; expected one: --column " + one.choice.name + "=" + topic->name +
                                    one.path + " says which");
      }
    columns.erase("t_s");
    if (columns.empty())
      fail(
          "no field is asked for, and none bears a name of the format; 'thermopower-gap columns' proposes which are "
          "(--column motor_C=/topic.field:unit, --map FILE)");
    RecordingFile file;
    CsvTable table = clock_ == Clock::field ? by_field(used) : by_clock(used, file.findings);
    table.file = file_;
    std::vector<Finding> found = std::move(file.findings);
    file = to_recording(std::move(table));
    file.findings.insert(file.findings.begin(), found.begin(), found.end());
    return file;
  }

  [[noreturn]] void fail_unseen(const Topic& topic, const Taken& one) const {
    const std::string where = excerpt(one.choice.header);
    if (topic.messages == 0) fail(one.choice.name, "topic " + topic.name + " has no message");
    std::string names;
    for (const FieldNode* candidate : one.names)
      for (const std::string& name : candidate->words)
        if (names.size() < 120) names += (names.empty() ? "" : ", ") + excerpt(name);
    fail(one.choice.name,
         where + " is not a number in any of " + std::to_string(topic.messages) + " messages" +
             (names.empty() ? "; expected a field that holds one ('thermopower-gap columns' lists them)"
                            : "; its list names " + names));
  }

  std::string topic_list() const {
    std::string found;
    for (const std::string& name : seen_topics_)
      if (found.size() < 120) found += (found.empty() ? "" : ", ") + excerpt(name);
    return found.empty() ? "no topic" : found;
  }

  // Time is a field: there is one topic, and its messages are the rows.
  CsvTable by_field(const std::vector<Topic*>& used) const {
    if (used.size() != 1)
      fail("t_s", "is a field of one topic, and columns are asked for of " + std::to_string(used.size()) +
                      "; expected one topic, or t_s=log_time");
    CsvTable table;
    const std::vector<double>* time = nullptr;
    for (Taken& one : used[0]->taken) {
      if (one.choice.name == "t_s") time = &one.values;
    }
    for (std::size_t row = 0; row < time->size(); ++row)
      if (!((*time)[row] > (row == 0 ? -std::numeric_limits<double>::infinity() : (*time)[row - 1])))
        fail("t_s", "time of message " + std::to_string(row + 1) + " of " + used[0]->name +
                        " is missing or not above the one before; expected strictly increasing time");
    table.rows = time->size();
    for (Taken& one : used[0]->taken) table.columns.push_back({one.choice.name, std::move(one.values)});
    table.run_labels.push_back({});
    table.run_begin.push_back(0);
    table.line_of_run.push_back(1);
    return table;
  }

  CsvTable by_clock(const std::vector<Topic*>& used, std::vector<Finding>& findings) {
    const Topic* bare = nullptr;
    for (const Topic* topic : used)
      if (bare == nullptr && topic->without_stamp > 0) bare = topic;
    if (clock_ == Clock::stamps && bare != nullptr)
      fail("t_s", bare->first_without_stamp +
                      " has no header.stamp; expected one in every message, or t_s=log_time");
    Clock clock = clock_;
    if (clock == Clock::stamps_if_all) {
      // Some messages with and some without is no habit but a fault: rows by two clocks would be mixed unseen.
      for (const Topic* topic : used)
        if (topic->without_stamp > 0 && topic->without_stamp < topic->messages)
          fail(
              "t_s",
              topic->first_without_stamp +
                  " has no header.stamp, though others of this topic have; t_s=log_time takes the recorder's clock");
      clock = bare == nullptr ? Clock::stamps : Clock::log;
    }
    if (clock == Clock::stamps) compare_clocks(used, findings);
    std::vector<Stream> streams;
    for (Topic* topic : used) {
      Stream stream;
      stream.name = topic->name;
      stream.time_ns = std::move(clock == Clock::stamps    ? topic->stamp_ns
                                 : clock == Clock::publish ? topic->publish_ns
                                                           : topic->log_ns);
      for (Taken& one : topic->taken) stream.columns.push_back({one.choice.name, std::move(one.values)});
      streams.push_back(std::move(stream));
    }
    CsvTable table = join_streams(file_, std::move(streams), findings);
    if (table.rows == 0)
      fail("there is no time at which all inputs are known: some begins after everything else has ended");
    return table;
  }

  // Stamps of two clocks would shift an input against what it causes.
  void compare_clocks(const std::vector<Topic*>& used, std::vector<Finding>& findings) const {
    std::map<double, const Topic*> behind;
    for (const Topic* topic : used) {
      std::vector<std::int64_t> delays;
      for (std::size_t i = 0; i < topic->log_ns.size(); ++i)
        delays.push_back(topic->log_ns[i] - topic->stamp_ns[i]);
      const auto middle = delays.begin() + static_cast<std::ptrdiff_t>(delays.size() / 2);
      std::nth_element(delays.begin(), middle, delays.end());
      behind[static_cast<double>(*middle) / 1e9] = topic;
    }
    const auto &least = *behind.begin(), &most = *behind.rbegin();
    if (most.first - least.first <= other_clock_s) return;
    char text[64];
    std::snprintf(text, sizeof text, "%.4g and %.4g s", least.first, most.first);
    findings.push_back({FindingKind::clock_shift, Severity::warning, file_, "t_s",
                        "the stamps of " + least.second->name + " and " + most.second->name + " are " + text +
                            " behind the recorder's clock: they may be of two clocks",
                        "--column t_s=log_time"});
  }

  std::string file_;
  Clock clock_ = Clock::stamps_if_all;
  std::vector<ColumnChoice> wanted_;
  std::vector<char> used_;
  McapDecoder decoder_;
  std::map<std::string, std::unique_ptr<Topic>> topics_;
  std::vector<std::string> seen_topics_;
};

}  // namespace

RecordingFile read_mcap(const std::string& path, const std::vector<ColumnChoice>& choices) {
  if (kind_of_log(path) == LogKind::sqlite_bag)
    return Selector(path, choices).read([&](const McapHandlers& handlers) {
      read_sqlite_bag(path, handlers);
    });
  FileSource source(path);
  return Selector(source.name(), choices).read([&](const McapHandlers& handlers) {
    read_mcap_records(source.name(), source.function(), handlers);
  });
}

RecordingFile parse_mcap(const std::string& name, const char* bytes, std::size_t size,
                         const std::vector<ColumnChoice>& choices) {
  return Selector(name, choices).read([&](const McapHandlers& handlers) {
    read_mcap_records(name, memory_source(bytes, size), handlers);
  });
}

bool is_mcap(const std::string& path) {
  // HDF5 begins with the same byte.
  return first_byte_of(path) == 0x89 && !begins_with(path, "\x89HDF");
}

}  // namespace thermopower::io
