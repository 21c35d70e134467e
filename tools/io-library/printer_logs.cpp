// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "log_text.hpp"
#include "plain_letters.hpp"
#include "time_stamp.hpp"

#include <thermopower/io/input_error.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <optional>
#include <sstream>

namespace thermopower::io {
namespace {

/// Rows whose columns appear one after the other.
class Rows {
public:
  void begin(std::size_t line) {
    cells_.emplace_back(names_.size());
    lines_.push_back(line);
  }
  bool empty() const { return cells_.empty(); }
  void put(const std::string& name, const std::string& text) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    const auto at = static_cast<std::size_t>(found - names_.begin());
    if (found == names_.end()) names_.push_back(name);
    if (cells_.back().size() <= at) cells_.back().resize(at + 1);
    cells_.back()[at] = text;
  }
  bool has(const std::string& name) const {
    return std::find(names_.begin(), names_.end(), name) != names_.end();
  }
  // Whether each row has a cell of this name.
  bool is_full(const std::string& name) const {
    const auto at = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
    return std::all_of(cells_.begin(), cells_.end(), [at](const std::vector<std::string>& row) {
      return at < row.size() && !row[at].empty();
    });
  }
  LogText finish(const std::string& left_out = {}) {
    LogText log;
    const auto out = [&](std::vector<std::string> row) {
      row.resize(names_.size());
      if (const auto at = std::find(names_.begin(), names_.end(), left_out); at != names_.end())
        row.erase(row.begin() + (at - names_.begin()));
      log.csv += csv_row(row);
    };
    out(names_);
    log.lines.push_back(1);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      out(cells_[i]);
      log.lines.push_back(lines_[i]);
    }
    return log;
  }

private:
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> cells_;
  std::vector<std::size_t> lines_;
};

bool is_number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

std::vector<std::string> words_in(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

// The settings of a heater in a configuration that says what controls it.
bool is_setting_of_heater(const std::string& key) {
  for (const char* one : {"control", "pid_kp", "pid_ki", "pid_kd", "max_delta", "max_power", "min_temp",
                          "max_temp", "pwm_cycle_time", "smooth_time"})
    if (key == one) return true;
  return false;
}

// The settings of a heater as the block of a model, where its control is one that the model has.
std::string heater_block(const std::map<std::string, std::string>& keys) {
  const bool pid = keys.at("control") == "pid";
  if (!pid && keys.at("control") != "watermark") return {};
  std::string block = std::string("\"heater\": {\"law\": ") + (pid ? "\"klipper_pid\"" : "\"bang_bang\"");
  const auto put = [&](const char* key, const char* name) {
    const auto found = keys.find(key);
    if (found != keys.end() && is_number(found->second))
      block += std::string(", \"") + name + "\": " + found->second;
  };
  if (pid) {
    put("pid_kp", "kp_per_K");
    put("pid_ki", "ki_per_K_s");
    put("pid_kd", "kd_s_per_K");
    put("smooth_time", "smooth_time_s");
  } else {
    put("max_delta", "max_delta_K");
  }
  put("max_power", "max_power");
  return block + "}";
}

}  // namespace

LogText klippy_as_csv(const std::string& name, const std::string& text) {
  Rows rows;
  std::istringstream in(text);
  std::map<std::string, std::map<std::string, std::string>> settings;
  std::string section;
  std::size_t number = 0, start = 1;
  bool ran = false;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.compare(0, 15, "Starting Klippy") == 0 || line.compare(0, 16, "Start printer at") == 0) {
      start += ran ? 1 : 0;
      ran = false;
      continue;
    }
    if (!line.empty() && line[0] == '[') {
      section = trimmed(line.substr(1, line.find(']') - 1));
      continue;
    }
    const std::size_t equals = line.find_first_of("=:");
    const std::string key = trimmed(line.substr(0, equals == std::string::npos ? 0 : equals));
    if (!section.empty() && is_setting_of_heater(key))
      settings[section][key] = trimmed(line.substr(equals + 1));
    if (line.compare(0, 6, "Stats ") != 0) continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || !is_number(line.substr(6, colon - 6))) continue;
    const std::vector<std::string> words = words_in(line.substr(colon + 1));
    std::string of;
    bool begun = false;
    for (const std::string& word : words) {
      if (word.back() == ':') {
        of = word.substr(0, word.size() - 1);
        continue;
      }
      const std::size_t at = word.find('=');
      const std::string what = word.substr(0, at == std::string::npos ? 0 : at);
      if (of.empty() || (what != "temp" && what != "target" && what != "pwm")) continue;
      const std::string value = word.substr(at + 1);
      if (!is_number(value)) continue;
      if (!begun) {
        rows.begin(number);
        rows.put("t_s", line.substr(6, colon - 6));
        rows.put("run", "start " + std::to_string(start));
        begun = ran = true;
      }
      rows.put(of + "." + what, value);
    }
  }
  if (rows.empty())
    throw InputError(
        name +
        ": a log of Klipper without a line 'Stats' that tells a temperature; expected the log of a printer that ran");
  LogText log = rows.finish();
  for (const auto& [of, keys] : settings) {
    if (keys.count("control") == 0) continue;
    std::string note = "[" + of + "]";
    for (const auto& [key, value] : keys) note += " " + key + "=" + value;
    if (const std::string block = heater_block(keys); !block.empty()) note += "; in a model: " + block;
    log.notes.push_back(note);
  }
  return log;
}

namespace {

// The time that stands before a report: a date and time in one word or two, a time of day, or seconds.
std::optional<std::string> stamp_before(const std::string& line) {
  std::vector<std::string> words = words_in(line);
  for (std::string& word : words) {
    const std::size_t begin = word.find_first_not_of("[("), end = word.find_last_not_of("]):,;");
    word = begin == std::string::npos || end == std::string::npos || end < begin
               ? std::string()
               : word.substr(begin, end + 1 - begin);
  }
  if (words.empty()) return std::nullopt;
  if (words.size() > 1) {
    const std::string two = words[0] + " " + words[1];
    if (parse_time_stamp(two.data(), two.size())) return two;
  }
  if (parse_time_stamp(words[0].data(), words[0].size()) ||
      (is_number(words[0]) && words[0].find('.') != std::string::npos))
    return words[0];
  return std::nullopt;
}

}  // namespace

LogText marlin_as_csv(const std::string& name, const std::string& text) {
  Rows rows;
  std::istringstream in(text);
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    // A report has a temperature and its target: " T:21.3 /0.0 B:22.0 /0.0 @:0 B@:0".
    std::size_t first = std::string::npos;
    std::vector<std::pair<std::string, std::string>> found;
    bool has_target = false;
    for (std::size_t at = 0; at < line.size();) {
      std::size_t key_end = at;
      while (key_end < line.size() &&
             (std::isupper(static_cast<unsigned char>(line[key_end])) != 0 ||
              std::isdigit(static_cast<unsigned char>(line[key_end])) != 0 || line[key_end] == '@'))
        ++key_end;
      const bool starts_word = at == 0 || line[at - 1] == ' ' || line[at - 1] == '\t';
      if (!starts_word || key_end == at || key_end - at > 3 || key_end >= line.size() ||
          line[key_end] != ':' || std::isdigit(static_cast<unsigned char>(line[at])) != 0) {
        ++at;
        continue;
      }
      double value = 0.0;
      std::size_t begin = key_end + 1;
      while (begin < line.size() && line[begin] == ' ') ++begin;
      const auto [end, error] = std::from_chars(line.data() + begin, line.data() + line.size(), value);
      if (error != std::errc()) {
        ++at;
        continue;
      }
      const std::string key = line.substr(at, key_end - at);
      if (first == std::string::npos) first = at;
      found.emplace_back(key, csv_number(value));
      at = static_cast<std::size_t>(end - line.data());
      std::size_t slash = at;
      while (slash < line.size() && line[slash] == ' ') ++slash;
      if (slash < line.size() && line[slash] == '/') {
        ++slash;
        while (slash < line.size() && line[slash] == ' ') ++slash;
        const auto [after, fault] = std::from_chars(line.data() + slash, line.data() + line.size(), value);
        if (fault == std::errc()) {
          found.emplace_back(key + "_target", csv_number(value));
          has_target = has_target || key[0] == 'T';
          at = static_cast<std::size_t>(after - line.data());
        }
      }
    }
    if (!has_target) continue;
    rows.begin(number);
    if (const auto stamp = stamp_before(line.substr(0, first))) rows.put("time", *stamp);
    for (const auto& [key, value] : found)
      // "T0" beside "T" is the same hot end once more.
      if (!rows.has(key) || key != "T0") rows.put(key, value);
  }
  if (rows.empty())
    throw InputError(
        name +
        ": no report of temperatures; expected lines such as 'T:21.3 /0.0 B:22.0 /0.0 @:0 B@:0' (M155 S1 asks for one a second)");
  return rows.finish(rows.has("time") && rows.is_full("time") ? "" : "time");
}

}  // namespace thermopower::io
