// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "stream_join.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace thermopower::io {
namespace {

constexpr double no_sample = std::numeric_limits<double>::quiet_NaN();
constexpr double ns_per_s = 1e9;
constexpr std::size_t enough_samples = 20;  // to know how regularly a stream comes
constexpr double long_silence = 20.0;       // in intervals that 95 % stay below

std::string seconds(std::int64_t ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", static_cast<double>(ns) / ns_per_s);
  return std::string(text) + " s";
}

// Puts the samples in the order of their times, one for each time: the last one.
std::size_t sort_samples(Stream& stream) {
  const std::size_t count = stream.time_ns.size();
  const auto increasing = [&](std::size_t i) { return stream.time_ns[i - 1] < stream.time_ns[i]; };
  bool sorted = true;
  for (std::size_t i = 1; i < count && sorted; ++i) sorted = increasing(i);
  if (sorted) return 0;
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stream.time_ns[a] < stream.time_ns[b]; });
  std::vector<std::size_t> kept;
  for (const std::size_t i : order) {
    if (!kept.empty() && stream.time_ns[kept.back()] == stream.time_ns[i]) kept.back() = i;
    else kept.push_back(i);
  }
  const auto reorder = [&](auto& values) {
    std::remove_reference_t<decltype(values)> result;
    result.reserve(kept.size());
    for (const std::size_t i : kept) result.push_back(values[i]);
    values = std::move(result);
  };
  reorder(stream.time_ns);
  for (StreamColumn& column : stream.columns) reorder(column.values);
  return count - kept.size();
}

// The longest silence of a stream that otherwise comes regularly, up to the end of all.
void report_silence(const std::string& file, const Stream& stream, std::int64_t end,
                    std::vector<Finding>& findings) {
  if (stream.time_ns.size() < enough_samples) return;
  std::vector<std::int64_t> steps;
  std::int64_t longest = end - stream.time_ns.back(), from = stream.time_ns.back();
  for (std::size_t i = 1; i < stream.time_ns.size(); ++i) {
    steps.push_back(stream.time_ns[i] - stream.time_ns[i - 1]);
    if (steps.back() > longest) longest = steps.back(), from = stream.time_ns[i - 1];
  }
  const auto usual = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() * 95 / 100);
  std::nth_element(steps.begin(), usual, steps.end());
  if (static_cast<double>(longest) <= long_silence * static_cast<double>(*usual)) return;
  for (const StreamColumn& column : stream.columns)
    if (!is_measured(column.name))
      findings.push_back({FindingKind::gap_in_stamps, Severity::warning, file, column.name,
                          stream.name + " was silent for " + seconds(longest) + " from " +
                              seconds(from - stream.time_ns.front()) +
                              " after its first sample on (95 % of its intervals are below " +
                              seconds(*usual) + "); its last value is held meanwhile",
                          "leave that part out unless the command stood still"});
}

}  // namespace

bool is_measured(const std::string& column) {
  return column == "current_A" || column == "motor_C" || column == "angle_deg" || column == "rate_dps";
}

CsvTable join_streams(const std::string& file, std::vector<Stream> streams, std::vector<Finding>& findings) {
  std::int64_t start = std::numeric_limits<std::int64_t>::min(),
               first = std::numeric_limits<std::int64_t>::max(), end = start;
  for (Stream& stream : streams) {
    if (const std::size_t twice = sort_samples(stream))
      findings.push_back({FindingKind::repeated_frames,
                          Severity::warning,
                          file,
                          {},
                          std::to_string(twice) + " samples of " + stream.name +
                              " have the time of another one; the last one of each time is taken"});
    if (stream.time_ns.empty()) continue;
    const bool holds = std::any_of(stream.columns.begin(), stream.columns.end(),
                                   [](const StreamColumn& one) { return !is_measured(one.name); });
    if (holds) start = std::max(start, stream.time_ns.front());
    first = std::min(first, stream.time_ns.front());
    end = std::max(end, stream.time_ns.back());
  }
  for (const Stream& stream : streams) report_silence(file, stream, end, findings);

  CsvTable table;
  table.file = file;
  table.columns.push_back({"t_s", {}});
  std::size_t left_out = 0;
  for (const Stream& stream : streams)
    for (const StreamColumn& column : stream.columns) table.columns.push_back({column.name, {}});
  std::vector<std::size_t> next(streams.size(), 0);
  std::int64_t zero = 0;
  for (;;) {
    std::int64_t now = std::numeric_limits<std::int64_t>::max();
    bool more = false;
    for (std::size_t i = 0; i < streams.size(); ++i)
      if (next[i] < streams[i].time_ns.size()) now = std::min(now, streams[i].time_ns[next[i]]), more = true;
    if (!more) break;
    const bool kept = now >= start;
    if (kept && table.rows == 0) zero = now;
    if (kept) table.columns[0].values.push_back(static_cast<double>(now - zero) / ns_per_s);
    std::size_t at = 1;
    for (std::size_t i = 0; i < streams.size(); ++i) {
      Stream& stream = streams[i];
      const bool here = next[i] < stream.time_ns.size() && stream.time_ns[next[i]] == now;
      if (here) ++next[i];
      for (const StreamColumn& column : stream.columns) {
        const bool has = next[i] > 0 && (here || !is_measured(column.name));
        if (kept) table.columns[at].values.push_back(has ? column.values[next[i] - 1] : no_sample);
        ++at;
      }
    }
    if (kept) ++table.rows;
    else ++left_out;
  }
  if (left_out > 0 && table.rows > 0)
    findings.push_back({FindingKind::gap_in_stamps,
                        Severity::note,
                        file,
                        {},
                        "the first " + std::to_string(left_out) + " times (" + seconds(start - first) +
                            ") are left out: some input has no sample before"});
  table.run_labels.push_back({});
  table.run_begin.push_back(0);
  table.line_of_run.push_back(1);
  return table;
}

}  // namespace thermopower::io
