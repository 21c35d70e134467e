// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>
#include <cstdio>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace gap_benchmark {

/// Wilson's 95 % interval of a rate.
inline std::pair<double, double> wilson(int hits, int total) {
  if (total == 0) return {0.0, 1.0};
  const double z = 1.959963984540054, n = total, p = hits / n, z2 = z * z;
  const double middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half = z / (1.0 + z2 / n) * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

/// One rate of the table.
struct Tally {
  std::string key, title, target;
  bool at_most = false;
  int hits = 0, total = 0;

  double rate() const { return total ? static_cast<double>(hits) / total : 0.0; }
};

/// The rates of the table, in its order.
class Tallies {
public:
  void add(const std::string& key, bool hit) {
    for (auto& tally : list_)
      if (tally.key == key) {
        tally.hits += hit;
        ++tally.total;
        return;
      }
    throw std::logic_error("no tally " + key);
  }

  const Tally* find(const std::string& key) const {
    for (const auto& tally : list_)
      if (tally.key == key) return &tally;
    return nullptr;
  }

  void print(std::ostream& out) const {
    for (const auto& tally : list_) {
      if (!tally.total) continue;
      const auto interval = wilson(tally.hits, tally.total);
      char text[120];
      std::snprintf(text, sizeof text, "%.1f %% | %.1f to %.1f %% | %d / %d", 100.0 * tally.rate(),
                    100.0 * interval.first, 100.0 * interval.second, tally.hits, tally.total);
      out << "| " << tally.title << " | " << text << " | " << tally.target << " |\n";
    }
  }

  /// The same for a screen: a line each.
  void print_brief(std::ostream& out) const {
    for (const auto& tally : list_) {
      if (!tally.total) continue;
      char text[200];
      std::snprintf(text, sizeof text, "%6.1f %%  %4d / %-4d  %s%s%s", 100.0 * tally.rate(), tally.hits,
                    tally.total, tally.title.c_str(), tally.target.empty() ? "" : "  -  ",
                    tally.target.c_str());
      out << text << "\n";
    }
  }

private:
  std::vector<Tally> list_ = {
      {"top1", "cause named, where no wrong cause passes for it (confusability < 0.9)", "at least 95 %"},
      {"class", "truth inside the reported class", "at least 99 %"},
      {"false_gap", "gap claimed where there is none", "at most 1 %", true},
      {"unknown", "cause outside the catalogue called unexplained, or a curve", "at least 90 %"},
      {"both", "both of two causes named", "at least 85 %"},
      {"where", "signal and submodel right, from residuals alone", "at least 95 %"},
      {"coverage", "interval covers the shrinkage over many recordings", "90 to 98 %"},
      {"after", "held-out gap below 1.3 times the floor, of the explained", "at least 90 %"},
      {"left_out", "cause left out of the catalogue: unexplained or an honest class",
       "never a confident neighbour"},
      {"dirty_named", "dirty: cause named, where no wrong cause passes for it", "at least 90 %"},
      {"dirty_class", "dirty: truth inside the reported class", ""},
      {"dirty_none", "dirty: no gap where there is none", "at least 98 %"},
      {"dirty_unknown", "dirty: cause outside the catalogue not named", "at least 90 %"},
      {"dirty_confident", "dirty: a wrong name stated at 0.9 or more", "below 1 %", true},
      {"servo_named", "target logged and no current: cause named, where no wrong cause passes for it", ""},
      {"servo_class", "target logged and no current: truth inside the reported class", ""},
      {"refitted", "constants fitted without the effect: effect inside the reported class", ""},
      {"other_form", "effect of another form than the catalogue's: the nearest inside the class", ""},
      {"misspecified_confident", "misspecified: a wrong name stated at 0.9 or more", "below 1 %", true},
      {"beginner", "beginner's gaps: right", "at least 95 %"},
      {"beginner_confident", "beginner's gaps: a wrong answer stated at 0.9 or more", "at most 0.5 %", true},
      {"loops_honest", "closed loops: right or honest", "at least 95 %"},
      {"loops_named", "closed loops: cause named", "at least 90 %"},
      {"loops_false", "closed loops: a wrong cause named", "at most 1 %", true},
      {"slow_honest", "one sample a second of a faster loop: right or honest", "at least 95 %"},
      {"slow_named", "one sample a second of a faster loop: cause named", ""},
      {"slow_false", "one sample a second of a faster loop: a wrong cause named", "at most 1 %", true},
      {"unknown_curve", "cause outside the catalogue: a curve named", ""},
      {"odds_95", "stated with 0.95 or more: right", "at least 97 %"},
      {"odds_80", "stated with 0.8 to 0.95: right", "at least 80 %"},
      {"odds_50", "stated with 0.5 to 0.8: right", "at least 60 %"},
      {"parameters", "interval of a parameter covers it", "93 to 97 %"},
      {"top1_all", "cause named, all single effects", ""},
      {"both_exactly", "both of two causes named and nothing else", ""},
      {"both_as_causes", "both of two causes among the named ones, none among the moved constants", ""},
      {"both_in_class", "both of two causes inside the reported class", ""},
      {"where_exact", "submodel right to the last word", ""},
      {"coverage_sample", "interval covers the shrinkage on this very recording", ""},
      {"coverage_below", "misses of the interval that promise too much", ""},
      {"left_out_unexplained", "cause left out: called unexplained", ""},
      {"left_out_equivalent", "cause left out: a confident neighbour that nobody could tell from it", ""},
      {"bystanders", "other causes left out: the same answer", ""},
      {"honest", "score in the report agrees with its own predictions", ""},
  };
};

}  // namespace gap_benchmark
