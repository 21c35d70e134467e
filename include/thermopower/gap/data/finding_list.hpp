// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/finding.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/gap/rule.hpp>

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// One entry per row: whether a sample of a column is not to be believed.
typedef std::vector<char> RowMask;

/// A mask as a rule makes it; none of its rows where the rule is taken away.
inline RowMask by(Rule rule, RowMask mask) {
  const auto is_set = [](char one) { return one != 0; };
  if (std::any_of(mask.begin(), mask.end(), is_set) && !holds(rule)) mask.assign(mask.size(), 0);
  return mask;
}

/// A number as sentences have it.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// A number to two digits, without an exponent where it has up to four places before the point: 240, 0.058.
inline std::string two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return short_number(std::strtod(text, nullptr));
}

/// What is said of several samples, as it is said of one: "lie far from all around them", "lies far from all around it".
inline std::string said_of_one(std::string words) {
  const std::pair<const char*, const char*> verbs[] = {
      {"are ", "is "},       {"lie ", "lies "},   {"repeat ", "repeats "}, {"jump ", "jumps "},
      {"stand ", "stands "}, {"read ", "reads "}, {"follow ", "follows "}, {"begin ", "begins "}};
  const std::string of_every = "of every output ";
  const std::size_t at = words.compare(0, of_every.size(), of_every) == 0 ? of_every.size() : 0;
  for (const auto& [many, one] : verbs) {
    const std::string verb = many;
    if (words.compare(at, verb.size(), verb) != 0) continue;
    words.replace(at, verb.size(), one);
    break;
  }
  for (const auto& [many, one] : {std::pair<const char*, const char*>{"before them", "before it"},
                                  {"around them", "around it"},
                                  {"their rows are", "its row is"}})
    if (const std::size_t found = words.find(many); found != std::string::npos)
      words.replace(found, std::string(many).size(), one);
  return words;
}

/// Collects the findings of one recording.
class FindingList {
public:
  /// @param recording  as it was given; must outlive this object
  explicit FindingList(const Recording& recording) : recording_(recording) {}

  /// Adds a finding about a column as a whole.
  void add(FindingKind kind, Severity severity, const std::string& column, const std::string& message,
           const std::string& mend = {}) {
    findings_.push_back({kind, severity, recording_.name, column, message, mend, FindingAction::none, {}});
  }

  /// Adds a finding about the rows that are set in `mask`, and says how many and where; nothing where none is.
  /// @param words  follows the count, as in "samples stand at ..."; of one sample it is said_of_one()
  void add_rows(FindingKind kind, Severity severity, const std::string& column, const RowMask& mask,
                FindingAction action, const std::string& words, const std::string& mend = {}) {
    std::vector<RowRange> rows = ranges_of(mask);
    if (rows.empty()) return;
    assert(rows.back().end <= recording_.rows());
    Eigen::Index count = 0;
    for (const RowRange& range : rows) count += range.end - range.begin;
    const Eigen::Index first = rows.front().begin;
    const std::string message = std::to_string(count) +
                                (count == 1 ? " sample " + said_of_one(words) : " samples " + words) +
                                ", first in row " + std::to_string(recording_.first_row + first) + " (" +
                                short_number(recording_.t_s[first]) + " s)";
    for (RowRange& range : rows) range.begin += recording_.first_row, range.end += recording_.first_row;
    findings_.push_back({kind, severity, recording_.name, column, message, mend, action, std::move(rows)});
  }

  /// Adds a finding as it is.
  void add(Finding finding) { findings_.push_back(std::move(finding)); }

  /// The recording that the findings are about.
  const Recording& recording() const { return recording_; }

  /// Whether nothing was found.
  bool empty() const { return findings_.empty(); }

  /// What was collected.
  std::vector<Finding> take() { return std::move(findings_); }

  /// The stretches in which a mask is set.
  static std::vector<RowRange> ranges_of(const RowMask& mask) {
    std::vector<RowRange> rows;
    for (std::size_t i = 0; i < mask.size(); ++i) {
      if (mask[i] == 0) continue;
      const auto row = static_cast<Eigen::Index>(i);
      if (!rows.empty() && rows.back().end == row) ++rows.back().end;
      else rows.push_back({row, row + 1});
    }
    return rows;
  }

private:
  const Recording& recording_;
  std::vector<Finding> findings_;
};

}  // namespace thermopower::gap::engine
