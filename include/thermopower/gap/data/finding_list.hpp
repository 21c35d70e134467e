// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>
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

/// One entry per row, 0 or 1: whether a sample of a column is not to be believed.
typedef std::vector<char> RowMask;

/// Whether any row of a mask is set.
inline bool any_of(const RowMask& mask) { return std::find(mask.begin(), mask.end(), 1) != mask.end(); }

/// Sets the rows of a mask that another one of the same length sets.
inline void add_to(RowMask& mask, const RowMask& other) {
  assert(mask.size() == other.size());
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] |= other[i];
}

/// Makes samples of a column missing. @param mask  which; empty: none
inline void take_away(Eigen::VectorXd& values, const RowMask& mask) {
  assert(static_cast<Eigen::Index>(mask.size()) <= values.size());
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i] != 0) values[static_cast<Eigen::Index>(i)] = missing;
}

/// A mask as a rule makes it; none of its rows where the rule is taken away.
inline RowMask by(Rule rule, RowMask mask) {
  if (any_of(mask) && !holds(rule)) mask.assign(mask.size(), 0);
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

/// Names as sentences have them: "a, b and 3 more". @param most  names that are spelled
inline std::string listed(const std::vector<std::string>& names, std::size_t most = 1000) {
  std::string words;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) words += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > most) words += " and " + std::to_string(names.size() - most) + " more";
  return words;
}

/// The words about several samples as they are of one: "lie far from all around them", "lies far from all around it".
/// @param words  begin with a verb, or with "of every output" and a verb
inline std::string said_of_one(std::string words) {
  const std::string of_every = "of every output ";
  const std::size_t verb = words.rfind(of_every, 0) == 0 ? of_every.size() : 0, end = words.find(' ', verb);
  if (words.compare(verb, end - verb, "are") == 0) words.replace(verb, 3, "is");
  else words.insert(std::min(end, words.size()), "s");
  for (const auto& [many, one] : {std::pair<std::string, const char*>{"before them", "before it"},
                                  {"around them", "around it"},
                                  {"their rows are", "its row is"}})
    if (const std::size_t found = words.find(many); found != std::string::npos)
      words.replace(found, many.size(), one);
  return words;
}

/// The stretches of rows in which a mask is set.
inline std::vector<RowRange> ranges_of(const RowMask& mask) {
  std::vector<RowRange> rows;
  for_each_stretch(
      0, static_cast<Eigen::Index>(mask.size()),
      [&](Eigen::Index row) { return mask[static_cast<std::size_t>(row)] != 0; },
      [&](Eigen::Index begin, Eigen::Index end) {
        rows.push_back({begin, end});
      });
  return rows;
}

/// Collects the findings of one recording.
class FindingList {
public:
  /// @param recording  as it was given; must outlive this object
  explicit FindingList(const Recording& recording) : recording_(recording) {}

  /// Adds a finding about a column as a whole.
  void add(FindingKind kind, Severity severity, const std::string& column, const std::string& message,
           const std::string& mend = {}) {
    findings_.push_back({kind, severity, recording_.name, column, message, mend});
  }

  /// Adds a finding about the rows that are set in `mask`, and says how many and where; nothing where none is.
  /// @param words  follows the count, as in "samples stand at ..."; of one sample it is said_of_one()
  void add_rows(FindingKind kind, Severity severity, const std::string& column, const RowMask& mask,
                FindingAction action, const std::string& words, const std::string& mend = {}) {
    Finding found{kind, severity, recording_.name, column, {}, mend, action, ranges_of(mask)};
    if (found.rows.empty()) return;
    assert(found.rows.back().end <= recording_.rows());
    const Eigen::Index count = found.row_count(), first = found.rows.front().begin;
    found.message = std::to_string(count) +
                    (count == 1 ? " sample " + said_of_one(words) : " samples " + words) + ", first in row " +
                    std::to_string(recording_.first_row + first) + " (" +
                    short_number(recording_.t_s[first]) + " s)";
    for (RowRange& range : found.rows) range.begin += recording_.first_row, range.end += recording_.first_row;
    findings_.push_back(std::move(found));
  }

  /// The recording that the findings are about.
  const Recording& recording() const { return recording_; }

  /// The findings that were collected.
  std::vector<Finding> take() { return std::move(findings_); }

private:
  const Recording& recording_;
  std::vector<Finding> findings_;
};

}  // namespace thermopower::gap::engine
