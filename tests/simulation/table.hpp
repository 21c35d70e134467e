// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// A table of the thesis: one map from column to cell per row.
inline std::vector<std::map<std::string, std::string>> thesis_table(const std::string& name) {
  std::ifstream file(std::string(THERMOPOWER_TEST_DATA) + "/thesis/" + name);
  if (!file) throw std::runtime_error("cannot open the table " + name);
  const auto cells = [](const std::string& line) {
    std::vector<std::string> all;
    std::stringstream stream(line + ",");
    for (std::string cell; std::getline(stream, cell, ',');) all.push_back(cell);
    return all;
  };
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> header = cells(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> row = cells(line);
    rows.emplace_back();
    for (std::size_t i = 0; i < header.size() && i < row.size(); ++i) rows.back()[header[i]] = row[i];
  }
  return rows;
}
