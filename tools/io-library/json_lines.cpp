// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "log_text.hpp"

#include <thermopower/io/input_error.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>
#include <unordered_map>

namespace thermopower::io {
namespace {

using Json = nlohmann::ordered_json;
using Cells = std::vector<std::pair<std::string, std::string>>;

constexpr std::size_t most_names = 4096;

void flatten(const Json& value, const std::string& path, Cells& cells) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items())
      flatten(member, path.empty() ? key : path + "." + key, cells);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i)
      flatten(value[i], path + "[" + std::to_string(i) + "]", cells);
  } else if (value.is_boolean()) {
    cells.emplace_back(path, value.get<bool>() ? "1" : "0");
  } else if (value.is_number()) {
    cells.emplace_back(path, value.dump());
  } else if (value.is_string()) {
    cells.emplace_back(path, value.get<std::string>());
  } else {
    cells.emplace_back(path, std::string());
  }
}

}  // namespace

LogText json_lines_as_csv(const std::string& name, const std::string& text) {
  std::vector<std::string> header;
  std::unordered_map<std::string, std::size_t> place;
  std::vector<std::vector<std::string>> rows;
  LogText log;
  log.lines.push_back(1);
  std::istringstream in(text);
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto fail = [&](const std::string& what) {
      const Json whole = Json::parse(text, nullptr, false, true);
      if (whole.is_object() && whole.contains("format") && whole["format"].is_string())
        throw InputError(name + ": is a file of the format " + whole["format"].get<std::string>() +
                         "; expected a recording, such as a CSV file");
      throw InputError(name + ":" + std::to_string(number) + ": " + what +
                       "; expected a JSON object in each line, such as {\"t_s\": 0.01, \"angle_deg\": 3.2}");
    };
    const Json value = Json::parse(line, nullptr, false);
    if (value.is_discarded())
      fail(in.eof() ? "not a whole JSON object (was the file cut off?)" : "not valid JSON");
    if (!value.is_object()) fail("not a JSON object");
    Cells cells;
    flatten(value, {}, cells);
    std::vector<std::string> row(header.size());
    for (auto& [key, cell] : cells) {
      const auto [found, is_new] = place.emplace(key, header.size());
      if (is_new) {
        if (header.size() == most_names) fail("more than 4096 different names");
        header.push_back(key);
        row.emplace_back();
      }
      row[found->second] = std::move(cell);
    }
    rows.push_back(std::move(row));
    log.lines.push_back(number);
  }
  if (rows.empty()) throw InputError(name + ": no JSON object");
  log.csv = csv_row(header);
  for (std::vector<std::string>& row : rows) {
    row.resize(header.size());
    log.csv += csv_row(row);
  }
  return log;
}

}  // namespace thermopower::io
