// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "held_out_runs.hpp"

#include <algorithm>
#include <cmath>

namespace thermopower::io {
namespace {

bool usable(const SignalSeries& s) {
  const Eigen::Index n = s.t_s.size();
  return n > 1 && s.measured.size() == n && s.baseline.size() == n;
}

bool alike(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() && a.size() > 0 && a[0] == b[0] && a[a.size() - 1] == b[b.size() - 1];
}

// Where nobody tells: stamps that fall begin a new run.
std::vector<plant::RunSpan> spans_of(const Eigen::VectorXd& t_s) {
  std::vector<plant::RunSpan> spans;
  Eigen::Index begin = 0;
  for (Eigen::Index row = 1; row <= t_s.size(); ++row) {
    if (row < t_s.size() && t_s[row] > t_s[row - 1]) continue;
    spans.push_back({begin, row, {}});
    begin = row;
  }
  return spans;
}

struct Source {
  std::string name;
  std::vector<plant::RunSpan> spans;
  const Eigen::VectorXd* t_s;
  const Recording* recorded;
  std::vector<const SignalSeries*> signals;
};

}  // namespace

std::vector<HeldOutRun> held_out_runs(const Diagnosis& diagnosis, const std::vector<Recording>& held_out) {
  std::vector<Source> sources;
  for (const Recording& one : held_out) sources.push_back({one.name, one.spans(), &one.t_s, &one, {}});
  for (const SignalSeries& s : diagnosis.series) {
    if (!usable(s)) continue;
    // One series per signal and recording, in the recordings' order: the next one of that name is meant.
    const auto wants = [&s](const Source& one) {
      return one.name == s.recording && alike(*one.t_s, s.t_s) &&
             std::none_of(one.signals.begin(), one.signals.end(),
                          [&s](const SignalSeries* other) { return other->signal == s.signal; });
    };
    auto found = std::find_if(sources.begin(), sources.end(), wants);
    if (found == sources.end())
      found = sources.insert(sources.end(), {s.recording, spans_of(s.t_s), &s.t_s, nullptr, {}});
    found->signals.push_back(&s);
  }
  std::vector<HeldOutRun> runs;
  for (const Source& source : sources) {
    if (source.signals.empty()) continue;
    for (std::size_t i = 0; i < source.spans.size(); ++i) {
      const plant::RunSpan& span = source.spans[i];
      if (span.size() < 2) continue;
      runs.push_back({source.name, span.label, i, source.spans.size(), span.begin, span.end, source.recorded,
                      source.signals});
    }
  }
  return runs;
}

double rms_of(const HeldOutRun& run, const SignalSeries& series, const Eigen::VectorXd& simulated) {
  double sum = 0.0, samples = 0.0;
  for (Eigen::Index row = run.begin; row < run.end && row < simulated.size(); ++row) {
    const double error = simulated[row] - series.measured[row];
    if (!std::isfinite(error)) continue;
    sum += error * error;
    samples += 1.0;
  }
  return samples > 0.0 ? std::sqrt(sum / samples) : plant::missing;
}

std::optional<std::pair<double, double>> worst_stretch(const HeldOutRun& run, const SignalSeries& s,
                                                       double horizon_s) {
  constexpr double windows = 8.0, little_longer = 10.0;
  const double begin = s.t_s[run.begin], end = s.t_s[run.end - 1];
  if (!(horizon_s > 0.0) || end - begin <= little_longer * horizon_s) return std::nullopt;
  const double length = windows * horizon_s;
  double best = -1.0, best_from = begin, sum = 0.0;
  Eigen::Index first = run.begin;
  const auto square = [&s](Eigen::Index row) {
    const double error = s.baseline[row] - s.measured[row];
    return std::isfinite(error) ? error * error : 0.0;
  };
  for (Eigen::Index last = run.begin; last < run.end; ++last) {
    sum += square(last);
    while (s.t_s[last] - s.t_s[first] > length) sum -= square(first++);
    if (sum > best && s.t_s[last] - begin >= length) {
      best = sum;
      best_from = s.t_s[first];
    }
  }
  return std::make_pair(best_from, best_from + length);
}

RunErrors errors_of(const std::vector<HeldOutRun>& runs, const plant::SignalName& signal, bool augmented) {
  RunErrors of;
  for (const HeldOutRun& run : runs) {
    const SignalSeries* s = run.of_signal(signal);
    if (s == nullptr) continue;
    const Eigen::VectorXd& simulated =
        augmented && s->augmented.size() == s->t_s.size() ? s->augmented : s->baseline;
    const auto begin = static_cast<Eigen::Index>(of.errors.size());
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      of.errors.push_back(simulated[row] - s->measured[row]);
      of.t_s.push_back(s->t_s[row]);
    }
    of.runs.push_back({begin, static_cast<Eigen::Index>(of.errors.size()), run.label});
  }
  return of;
}

std::vector<RunInput> inputs_of(const HeldOutRun& run) {
  constexpr std::size_t most = 4;
  struct Input {
    const char* column;
    bool only_if_it_varies;
  };
  static constexpr Input all[] = {{"power_param", false}, {"drive_A", false},    {"voltage_V", false},
                                  {"target_deg", false},  {"target_dps", false}, {"target_C", false},
                                  {"torque_Nm", false},   {"heat_W", false},     {"supply_V", true},
                                  {"ambient_C", true},    {"airspeed_mps", true}};
  std::vector<RunInput> list;
  for (const Input& input : all) {
    const Eigen::VectorXd* values = run.recorded != nullptr ? run.recorded->find(input.column) : nullptr;
    if (values == nullptr || list.size() == most) continue;
    RunInput one{input.column, {}, {}};
    double least = plant::missing, greatest = plant::missing;
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      one.t_s.push_back(run.recorded->t_s[row]);
      one.values.push_back((*values)[row]);
      least = std::fmin(least, (*values)[row]);
      greatest = std::fmax(greatest, (*values)[row]);
    }
    if (!std::isfinite(least) || (input.only_if_it_varies && least == greatest)) continue;
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace thermopower::io
