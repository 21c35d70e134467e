// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/recording.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

/// @file gate_channels.hpp
/// What one channel alone can tell: stamps, holes, quanta, frozen or saturated stretches, wraps, spikes.

namespace thermopower::gap::detail {

/// Collects findings of one recording.
class FindingList {
public:
  explicit FindingList(const Recording& recording) : recording_(recording) {}

  void add(const char* code, Severity severity, const std::string& column, const std::string& message) {
    findings_.push_back({code, severity, recording_.name, column, message});
  }

  const Recording& recording() const { return recording_; }
  std::vector<Finding> take() { return std::move(findings_); }

private:
  const Recording& recording_;
  std::vector<Finding> findings_;
};

inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// The median; reorders the values.
inline double median_of(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const std::size_t middle = values.size() / 2;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(middle), values.end());
  return values[middle];
}

/// The smallest step between consecutive samples, 0 where there is none.
inline double quantum_of(const Eigen::VectorXd& values) {
  double quantum = 0.0;
  for (Eigen::Index i = 1; i < values.size(); ++i) {
    const double step = std::fabs(values[i] - values[i - 1]);
    if (std::isfinite(step) && step > 1e-9 && (quantum == 0.0 || step < quantum)) quantum = step;
  }
  return quantum;
}

inline void check_stamps(FindingList& list) {
  const Recording& r = list.recording();
  std::vector<double> steps;
  Eigen::Index repeated = 0, backward = 0, first_repeated = -1, first_backward = -1;
  for (const RunSpan& run : r.spans()) {
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
      const double step = r.t_s[i] - r.t_s[i - 1];
      if (step > 0.0) {
        steps.push_back(step);
      } else if (step == 0.0) {
        if (repeated++ == 0) first_repeated = i;
      } else if (step < 0.0) {
        if (backward++ == 0) first_backward = i;
      }
    }
  }
  if (repeated > 0) {
    list.add("repeated_stamps", Severity::error, "t_s",
             std::to_string(repeated) + " stamps repeat the one before, first at " +
                 short_number(r.t_s[first_repeated]) + " s");
  }
  if (backward > 0) {
    const double jump = r.t_s[first_backward] - r.t_s[first_backward - 1];
    const bool wrap =
        std::fabs(std::fabs(jump) - 65.536) < 1.0 || std::fabs(std::fabs(jump) - 65536.0) < 700.0;
    list.add("decreasing_stamps", Severity::error, "t_s",
             std::to_string(backward) + " stamps go back, first by " + short_number(-jump) + " s at " +
                 short_number(r.t_s[first_backward - 1]) + " s" +
                 (wrap ? ": a 16-bit counter that wraps?" : ""));
  }
  if (steps.size() < 3) return;
  const double usual = median_of(steps);
  std::sort(steps.begin(), steps.end());
  const double shortest = steps[steps.size() / 50], longest = steps[steps.size() - 1 - steps.size() / 50];
  if (longest > 1.3 * usual || shortest < 0.7 * usual) {
    list.add("irregular_stamps", Severity::note, "t_s",
             "the interval varies from " + short_number(shortest) + " to " + short_number(longest) +
                 " s around " + short_number(usual) + " s");
  }
  if (steps.back() > 10.0 * usual && steps.back() > 3.0 * longest) {
    list.add("gap_in_stamps", Severity::warning, "t_s",
             "a pause of " + short_number(steps.back()) + " s where the usual interval is " +
                 short_number(usual) + " s");
  }
}

inline void check_frozen(FindingList& list, const Column& column, const std::vector<std::string>& inputs) {
  const Recording& r = list.recording();
  Eigen::Index longest = 0, at = 0;
  std::vector<double> stretches;
  for (const RunSpan& run : r.spans()) {
    for (Eigen::Index i = run.begin; i < run.end;) {
      Eigen::Index end = i + 1;
      while (end < run.end && column.values[end] == column.values[i]) ++end;
      if (std::isfinite(column.values[i])) stretches.push_back(static_cast<double>(end - i));
      if (end - i > longest) {
        longest = end - i;
        at = i;
      }
      i = end;
    }
  }
  if (stretches.size() == 1 && longest > 20) {
    list.add("constant_channel", Severity::note, column.name,
             "holds " + short_number(column.values[0]) + " throughout");
    return;
  }
  if (longest < 30 || static_cast<double>(longest) < 0.05 * static_cast<double>(r.rows())) return;
  if (static_cast<double>(longest) < 20.0 * std::max(median_of(stretches), 1.0)) return;
  if (column.values[at] == 0.0) return;  // at rest, nothing is what a good sensor reads
  for (const auto& name : inputs) {      // a channel may rest while its cause rests
    const Eigen::VectorXd* input = r.find(name);
    if (input == nullptr ||
        !(input->segment(at, longest).maxCoeff() > input->segment(at, longest).minCoeff()))
      continue;
    list.add("frozen_channel", Severity::warning, column.name,
             "repeats " + short_number(column.values[at]) + " for " + std::to_string(longest) +
                 " rows from " + short_number(r.t_s[at]) + " s while " + name + " changes");
    return;
  }
}

inline void check_saturated(FindingList& list, const Column& column) {
  const Eigen::VectorXd& v = column.values;
  for (const bool top : {true, false}) {
    double extreme = 0.0, next = 0.0;
    bool any = false, second = false;
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      const double x = top ? v[i] : -v[i];
      if (!std::isfinite(x)) continue;
      if (!any || x > extreme) {
        if (any) {
          next = extreme;
          second = true;
        }
        extreme = x;
        any = true;
      } else if (x < extreme && (!second || x > next)) {
        next = x;
        second = true;
      }
    }
    Eigen::Index at_extreme = 0, at_next = 0, in_rows = 0;
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      const double x = top ? v[i] : -v[i];
      if (x == extreme) {
        ++at_extreme;
        if (i > 0 && v[i - 1] == v[i]) ++in_rows;
      }
      if (x == next) ++at_next;
    }
    if (second && extreme != 0.0 && at_extreme >= 20 && at_extreme * 100 >= v.size() &&
        at_extreme > 8 * at_next && 2 * in_rows > at_extreme) {
      list.add("saturated_channel", Severity::warning, column.name,
               std::to_string(at_extreme) + " samples stand at its " + (top ? "largest" : "least") +
                   " value " + short_number(top ? extreme : -extreme) + " and hardly any near it");
    }
  }
}

inline void check_wraps(FindingList& list, const Column& column) {
  const Recording& r = list.recording();
  const double quantum = quantum_of(column.values);
  if (quantum <= 0.0) return;
  const bool angle = column.name == "angle_deg";
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (Eigen::Index i = 0; i < column.values.size(); ++i) {
    if (!std::isfinite(column.values[i])) continue;
    least = std::min(least, column.values[i]);
    most = std::max(most, column.values[i]);
  }
  Eigen::Index turns = 0, words = 0, first = -1;
  for (const RunSpan& run : r.spans()) {
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
      const double jump = std::fabs(column.values[i] - column.values[i - 1]);
      if (!std::isfinite(jump)) continue;
      const bool turn = angle && jump > 270.0 && jump <= 361.0;
      const bool word = std::fabs(jump / quantum - 65536.0) < 0.02 * 65536.0 && jump > 0.8 * (most - least);
      if ((turn || word) && first < 0) first = i;
      turns += turn ? 1 : 0;
      words += word ? 1 : 0;
    }
  }
  if (turns > 0) {
    list.add("wrapped_channel", Severity::warning, column.name,
             "jumps by a full turn " + std::to_string(turns) + " times, first at " +
                 short_number(r.t_s[first]) + " s; expected an angle that does not wrap");
  } else if (words > 0) {
    list.add("wrapped_channel", Severity::warning, column.name,
             "jumps by 65536 of its steps " + std::to_string(words) + " times, first at " +
                 short_number(r.t_s[first]) + " s: a 16-bit counter that wraps");
  }
}

inline void check_spikes(FindingList& list, const Column& column) {
  const Recording& r = list.recording();
  std::vector<double> sizes;
  for (const RunSpan& run : r.spans()) {
    for (Eigen::Index i = run.begin + 1; i + 1 < run.end; ++i) {
      const double size = std::fabs(column.values[i] - 0.5 * (column.values[i - 1] + column.values[i + 1]));
      if (std::isfinite(size)) sizes.push_back(size);
    }
  }
  if (sizes.size() < 30) return;
  const double usual = std::max(median_of(sizes) / 0.55, quantum_of(column.values));
  std::sort(sizes.begin(), sizes.end());
  const double high = std::max(2.0 * usual, sizes[sizes.size() * 99 / 100]);
  Eigen::Index spikes = 0, first = -1;
  for (const RunSpan& run : r.spans()) {
    for (Eigen::Index i = run.begin + 1; i + 1 < run.end; ++i) {
      const double before = column.values[i] - column.values[i - 1],
                   after = column.values[i + 1] - column.values[i];
      // Out and back: an edge of the input goes one way only.
      if (before * after < 0.0 && std::min(std::fabs(before), std::fabs(after)) > 6.0 * high) {
        if (spikes++ == 0) first = i;
      }
    }
  }
  if (spikes > 0 && 200 * spikes < column.values.size()) {
    list.add("outliers", Severity::warning, column.name,
             std::to_string(spikes) + " isolated spikes, first at " + short_number(r.t_s[first]) + " s (" +
                 short_number(column.values[first]) + ")");
  }
}

inline void check_channel(FindingList& list, const Column& column) {
  const Eigen::Index rows = column.values.size();
  const Eigen::Index present = column.values.array().isFinite().count();
  if (present == 0) {
    list.add("empty_channel", Severity::warning, column.name, "has no sample at all");
    return;
  }
  if (present < rows) {
    char text[80];
    std::snprintf(text, sizeof text, "%td of %td samples are missing (%.1f %%)",
                  static_cast<std::ptrdiff_t>(rows - present), static_cast<std::ptrdiff_t>(rows),
                  100.0 * static_cast<double>(rows - present) / static_cast<double>(rows));
    list.add("missing_samples", 5 * (rows - present) > rows ? Severity::warning : Severity::note, column.name,
             text);
  }
  const bool output = column.name == "motor_C" || column.name == "current_A" || column.name == "rate_dps" ||
                      column.name == "angle_deg";
  if (!output) return;
  check_frozen(list, column, {"power_param", "drive_A"});
  if (column.name != "motor_C") check_saturated(list, column);
  check_wraps(list, column);
  check_spikes(list, column);
  const double quantum = quantum_of(column.values);
  std::vector<double> steps;
  for (Eigen::Index i = 1; i < rows; ++i) {
    const double step = std::fabs(column.values[i] - column.values[i - 1]);
    if (std::isfinite(step)) steps.push_back(step);
  }
  if (quantum > 0.0 && median_of(steps) < 1.5 * quantum && quantum > 1e-6) {
    list.add("quantum", Severity::note, column.name,
             "comes in steps of " + short_number(quantum) + ": no model can be told to be better than " +
                 short_number(quantum / std::sqrt(12.0)));
  }
}

}  // namespace thermopower::gap::detail
