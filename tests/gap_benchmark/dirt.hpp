// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "random.hpp"
#include "recording.hpp"

namespace gap_benchmark {

/// What is wrong with a log that nothing is wrong with the motor for.
enum class Dirt {
  coloured,         ///< every sensor's noise is a first-order process that remembers 0.95 of its last value
  heavy_tailed,     ///< Student's t with three degrees of freedom
  coarse,           ///< outputs come in steps of several standard deviations of their noise
  outliers,         ///< one sample in a hundred is anywhere
  lost_frames,      ///< 0 A, 85.0 degC, an angle and a rate of 0: what a sensor says when it says nothing
  repeated_frames,  ///< the frame before once more, a few rows long
  holes,            ///< cells are missing, one by one and in stretches, of inputs, too
  pauses,           ///< the logger stops for a while; what the inputs did meanwhile nobody wrote down
  jitter,           ///< stamps are off by a tenth of the interval
  clipped,          ///< an output ends at a limit of its sensor
  frozen            ///< an output stands still for a stretch
};

inline const char* name(Dirt dirt) {
  static const char* const names[] = {"coloured noise", "heavy-tailed noise",
                                      "coarse steps",   "outliers",
                                      "lost frames",    "repeated frames",
                                      "holes",          "pauses",
                                      "jitter",         "clipped",
                                      "frozen"};
  return names[static_cast<int>(dirt)];
}

inline const std::vector<Dirt>& all_dirt() {
  static const std::vector<Dirt> all = {Dirt::coloured, Dirt::heavy_tailed, Dirt::coarse,
                                        Dirt::outliers, Dirt::lost_frames,  Dirt::repeated_frames,
                                        Dirt::holes,    Dirt::pauses,       Dirt::jitter,
                                        Dirt::clipped,  Dirt::frozen};
  return all;
}

inline bool has(const std::vector<Dirt>& list, Dirt dirt) {
  return std::find(list.begin(), list.end(), dirt) != list.end();
}

/// Dirties a log after it was written; what belongs to the noise itself (coloured, heavy-tailed, coarse) is
/// drawn with the noise. The true inputs of the plant stay what they were: only the log suffers.
class Soiling {
public:
  Soiling(Recording& log, Random& random) : log_(log), random_(random) {
    for (auto& column : log_.columns)
      if (column.name == "current_A" || column.name == "motor_C" || column.name == "angle_deg" ||
          column.name == "rate_dps")
        outputs_.push_back(&column);
  }

  void apply(const std::vector<Dirt>& list) {
    for (const Dirt dirt : list) apply(dirt);
    if (has(list, Dirt::pauses)) pauses();  // last: it takes rows away
  }

private:
  void apply(Dirt dirt) {
    switch (dirt) {
      case Dirt::outliers:
        for (Column* output : outputs_) {
          const double spread = spread_of(*output);
          for (std::size_t k = 1; k < rows(); ++k)
            if (random_.chance(0.01))
              output->values[k] += random_.sign() * spread * random_.uniform(0.4, 2.0);
        }
        break;
      case Dirt::lost_frames:
        for (std::size_t k = 1; k < rows(); ++k) {
          if (!random_.chance(0.006)) continue;
          for (Column* output : outputs_) output->values[k] = output->name == "motor_C" ? 85.0 : 0.0;
        }
        break;
      case Dirt::repeated_frames:
        for (std::size_t k = 1; k < rows(); ++k) {
          if (!random_.chance(0.004)) continue;
          const std::size_t end = std::min(rows(), k + static_cast<std::size_t>(random_.integer(2, 6)));
          for (const std::size_t last = k - 1; k < end; ++k)
            for (Column* output : outputs_) output->values[k] = output->values[last];
        }
        break;
      case Dirt::holes:
        for (auto& column : log_.columns) {
          if (column.name == "t_s") continue;
          for (std::size_t k = 1; k < rows(); ++k)
            if (random_.chance(0.01)) column.values[k] = missing;
          for (int i = 0; i < 2; ++i) {
            const std::size_t from = place(0.01);
            for (std::size_t k = from; k < from + rows() / 100; ++k) column.values[k] = missing;
          }
        }
        break;
      case Dirt::jitter: {
        auto& t = log_.columns.front().values;
        for (std::size_t k = 1; k + 1 < rows(); ++k) {
          const double least = 0.5 * std::min(t[k] - t[k - 1], t[k + 1] - t[k]);
          if (least > 0.0) t[k] += 0.2 * least * random_.uniform(-1.0, 1.0);
        }
        break;
      }
      case Dirt::clipped: {
        Column& output =
            *outputs_[static_cast<std::size_t>(random_.integer(0, static_cast<int>(outputs_.size()) - 1))];
        double most = 0.0;
        for (const double value : output.values)
          most = std::isnan(value) ? most : std::max(most, std::fabs(value));
        for (auto& value : output.values)
          if (!std::isnan(value)) value = std::clamp(value, -0.85 * most, 0.85 * most);
        break;
      }
      case Dirt::frozen: {
        Column& output =
            *outputs_[static_cast<std::size_t>(random_.integer(0, static_cast<int>(outputs_.size()) - 1))];
        const std::size_t from = place(0.05);
        for (std::size_t k = from; k < from + rows() / 20; ++k) output.values[k] = output.values[from];
        break;
      }
      default:
        break;
    }
  }

  void pauses() {
    std::vector<char> kept(rows(), 1);
    for (int i = 0; i < 3; ++i) {
      const std::size_t from = place(0.02);
      std::fill_n(kept.begin() + static_cast<std::ptrdiff_t>(from), rows() / 50, 0);
    }
    const auto thin = [&](auto& values) {
      std::size_t to = 0;
      for (std::size_t k = 0; k < kept.size(); ++k)
        if (kept[k]) values[to++] = values[k];
      values.resize(to);
    };
    for (auto& column : log_.columns) thin(column.values);
    if (!log_.run.empty()) thin(log_.run);
  }

  std::size_t rows() const { return log_.rows(); }

  /// Where a stretch of that share of the rows may begin: neither at the start nor at the end.
  std::size_t place(double share) {
    return static_cast<std::size_t>(static_cast<double>(rows()) * random_.uniform(0.05, 0.94 - share));
  }

  static double spread_of(const Column& column) {
    double low = 1e300, high = -1e300;
    for (const double value : column.values)
      if (!std::isnan(value)) low = std::min(low, value), high = std::max(high, value);
    return std::max(high - low, std::pow(10.0, -column.decimals));
  }

  Recording& log_;
  Random& random_;
  std::vector<Column*> outputs_;
};

}  // namespace gap_benchmark
