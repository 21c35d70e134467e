// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "predictions_file.hpp"

#include "engine.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace thermopower::gap::files {
namespace {

void append(std::string& out, double value) {
  if (!std::isfinite(value)) return;
  char text[32];
  out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

// RFC 4180: a field with a separator, a quote or a line break is quoted, quotes inside it are doubled.
void append_quoted(std::string& out, const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  out += '"';
}

const Eigen::VectorXd* find(const std::vector<SimulatedColumn>& signals, const std::string& name) {
  for (const auto& one : signals) {
    if (one.signal == name) return &one.values;
  }
  return nullptr;
}

}  // namespace

std::string predictions_csv(const Model& baseline, const Model& augmented,
                            const std::vector<Recording>& recordings, double horizon_s) {
  std::vector<std::vector<SimulatedColumn>> before, after;
  std::vector<std::string> signals;  // of all recordings, in order of appearance: one header fits all rows
  std::size_t runs = 0;
  for (const auto& recording : recordings) {
    before.push_back(run_simulation(baseline, recording, horizon_s));
    after.push_back(run_simulation(augmented, recording, horizon_s));
    runs += recording.spans().size();
    for (const auto* simulated : {&before.back(), &after.back()}) {
      for (const auto& one : *simulated) {
        if (std::find(signals.begin(), signals.end(), one.signal) == signals.end())
          signals.push_back(one.signal);
      }
    }
  }
  std::string out = "t_s";
  if (runs > 1) out += ",run";
  for (const auto& signal : signals) out += "," + signal + "_baseline," + signal + "_augmented";
  out += "\n";
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    std::vector<const Eigen::VectorXd*> columns;
    for (const auto& signal : signals) {
      columns.push_back(find(before[r], signal));
      columns.push_back(find(after[r], signal));
    }
    const auto spans = recordings[r].spans();
    for (std::size_t s = 0; s < spans.size(); ++s) {
      // Labels may repeat (the same file twice) or be empty; a reader needs to see where a run begins.
      std::string label = spans[s].label;
      if (label.empty()) label = std::to_string(s + 1);
      if (recordings.size() > 1) label = std::to_string(r + 1) + ":" + label;
      for (Eigen::Index row = spans[s].begin; row < spans[s].end; ++row) {
        append(out, recordings[r].t_s[row]);
        if (runs > 1) {
          out += ',';
          append_quoted(out, label);
        }
        for (const auto* column : columns) {
          out += ',';
          if (column != nullptr) append(out, (*column)[row]);
        }
        out += '\n';
      }
    }
  }
  return out;
}

}  // namespace thermopower::gap::files
