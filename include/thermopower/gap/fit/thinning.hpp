// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/noise.hpp>
#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/gap/fit/segment_simulation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace thermopower::gap::engine {

/// Rows of several recordings together.
inline Eigen::Index total_rows(const std::vector<Inputs>& inputs) {
  Eigen::Index rows = 0;
  for (const Inputs& one : inputs) rows += one.rows();
  return rows;
}

/// When rows of a bench become one. Held by tests/gap/fit/shortened_test.cpp: the mean error of the simulation under test
/// stays. The short recording tells as much as the whole one.
struct ThinningThresholds {
  double of_time_constant = 0.02;  ///< of the baseline's: as long blocks last in which the power switches,
  double even_blocks = 4.0;        ///< and so many times that those in which it does not
  double usual_time_constant_s = 100.0;  ///< where the baseline has none
  double alike = 0.05;      ///< share by which a measured current or heat may differ and be the same
  double one_level = 0.02;  ///< share by which powers may differ for their current to be observed
  double rate_varies =
      0.02;             ///< standard deviation of a rate, as a share, from which its square is kept, too
  double middle = 0.6;  ///< share of a block by which the mean of its stamps must have come
};

/// Shortens a recording of a motor on the bench to about `rows` rows.
///
/// Temperatures are smooth while the power is constant, so the mean over a block of rows says as much as its
/// samples. If the power switches within a block, the block is short against every time constant of the baseline. The order
/// of the powers is forgotten, and their durations are kept. There are up to three levels, once before the block's centre
/// and once after it. Outputs are means with their number in `repeats`. A mean is not quite the middle, and a sorted block
/// not quite the true one. The loss of the baseline's own simulation is made up for, so that the mean of its errors stays.
class BenchThinning {
public:
  /// @param full       the recording; must outlive this object
  /// @param rows       about so many are kept, > 0
  /// @param longest_s  blocks in which the power switches are no longer than this
  /// @param baseline   simulates the loss; must outlive this object
  /// @param catalogue  knows the effects of the baseline; must outlive this object
  BenchThinning(const Inputs& full, Eigen::Index rows, double longest_s, const Model& baseline,
                const Catalogue& catalogue)
      : full_(full), longest_s_(longest_s), baseline_(baseline), catalogue_(catalogue) {
    block_ = (2 * full.rows() + rows - 1) / rows;
  }

  /// The shorter recording, or the full one where there is nothing to gain.
  Inputs run() {
    if (block_ < 5 || full_.heater_closed) return full_;  // a loop answers each sample
    Inputs thin = full_;
    thin.runs.clear();
    thin.next_share.resize(0);  // what the baseline gains by it is made up for
    for (const RunSpan& span : full_.runs) {
      const Eigen::Index begin = static_cast<Eigen::Index>(rows_.size());
      for (Eigen::Index row = span.begin; row < span.end;) row = add_block(span, row);
      thin.runs.push_back(
          {begin, static_cast<Eigen::Index>(rows_.size()), span.label, span.goes_on, span.drawn_Ah});
    }
    if (10 * rows_.size() > 8 * static_cast<std::size_t>(full_.rows())) return full_;
    const auto count = static_cast<Eigen::Index>(rows_.size());
    thin.t_s.resize(count);
    thin.repeats.setOnes(count);
    for (Eigen::Index i = 0; i < count; ++i) thin.t_s[i] = rows_[static_cast<std::size_t>(i)].t_s;
    for (const auto input :
         {&Inputs::power_param, &Inputs::supply_V, &Inputs::ambient_C, &Inputs::airspeed_mps,
          &Inputs::neighbour_C, &Inputs::held_motor_C, &Inputs::heat_W})
      gather(full_.*input, thin.*input, false);
    for (const auto input : {&Inputs::covariate_rate_dps, &Inputs::drive_A, &Inputs::held_current_A})
      gather(full_.*input, thin.*input, true);  // heat goes with the square
    thin.command_noise *=
        std::sqrt(static_cast<double>(count) / static_cast<double>(full_.rows()));  // of means
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (std::isfinite(rows_[i].rate_dps))
        thin.covariate_rate_dps[static_cast<Eigen::Index>(i)] = rows_[i].rate_dps;
    std::vector<Signal> judged;
    for (const Signal signal : {Signal::motor_C, Signal::current_A})
      if (full_.judged(signal)) judged.push_back(signal);
    for (const Signal signal : judged) observe(signal, thin);
    const Simulated whole = simulated(full_), shortened = simulated(thin);
    for (const Signal signal : judged) {
      const auto at = static_cast<std::size_t>(signal);
      thin.sample_noise[at] = noise_of_samples(signal, whole[at]);
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const double lost = shortened[at][row] - mean_of(rows_[i], signal, whole[at]).value;
        if (std::isfinite(lost)) thin.measured[at][row] += lost;
      }
    }
    return thin;
  }

private:
  /// One row of the result: the rows of the full recording that its inputs and outputs are the means of.
  struct Row {
    double t_s = 0.0;
    std::vector<Eigen::Index> of;                 ///< inputs
    Eigen::Index motor_begin = 0, motor_end = 0;  ///< motor_C; empty: none
    bool current = false;                         ///< whether current_A is the mean over `of`
    double rate_dps = missing;                    ///< where it is not the root mean square over `of`
  };

  Eigen::Index add_block(const RunSpan& span, Eigen::Index row) {
    if (row < span.begin + 3) {  // the start is measured there
      add_uniform(row, row + 1);
      return row + 1;
    }
    const Eigen::Index limit = std::min(span.end, row + block_);
    Eigen::Index mixed = row + 1;
    while (mixed < limit && full_.t_s[mixed] - full_.t_s[row] < longest_s_) ++mixed;
    // Two rows make a block of one power, six one of several.
    const Eigen::Index same = constant_until(row, span.end);
    if (3 * (same - row) >= mixed - row) {
      add_even(row, same);
      return same;
    }
    if (mixed - row < 8) {
      for (Eigen::Index one = row; one < mixed; ++one) add_uniform(one, one + 1);
      return mixed;
    }
    add_mixed(row, mixed, mixed < span.end ? full_.t_s[mixed] : full_.t_s[mixed - 1]);
    return mixed;
  }

  /// Rows of one power in blocks of equal length. They are no longer than asked for, and so short that the mean temperature
  /// is that of the middle.
  void add_even(Eigen::Index begin, Eigen::Index end) {
    const Eigen::Index count = end - begin;
    const double lasts_s = full_.t_s[end - 1] - full_.t_s[begin];
    const auto by_time = static_cast<Eigen::Index>(std::ceil(lasts_s / (limit_.even_blocks * longest_s_)));
    const Eigen::Index parts = std::min(count, std::max((count + block_ - 1) / block_, by_time));
    if (parts <= 1) {
      add_uniform(begin, end);
      return;
    }
    for (Eigen::Index part = 0; part < parts; ++part)  // uneven stamps can leave a part too long
      add_even(begin + count * part / parts, begin + count * (part + 1) / parts);
  }

  /// The value that makes the heat of a row: its power, or where that is not recorded its current.
  double heat_level(Eigen::Index row) const {
    if (full_.power_param.size() > 0) return full_.power_param[row];
    if (full_.heat == HeatSource::drive) return std::abs(full_.drive_A[row]);
    if (full_.heat == HeatSource::recorded) return full_.heat_W[row];
    return full_.held_current_A.size() > 0 ? full_.held_current_A[row] : 0.0;
  }

  /// Whether a heat that is recorded itself is the same at two rows, to a twentieth.
  bool same_heat(Eigen::Index one, Eigen::Index other) const {
    return full_.heat_W.size() == 0 ||
           std::abs(full_.heat_W[one] - full_.heat_W[other]) <= limit_.alike * std::abs(full_.heat_W[other]);
  }

  Eigen::Index constant_until(Eigen::Index row, Eigen::Index limit) const {
    Eigen::Index end = row + 1;
    // A measured current is never constant: a spread within a twentieth counts as constant.
    const double slack = full_.power_param.size() > 0 ? 0.0 : limit_.alike * std::abs(heat_level(row));
    while (end < limit && std::abs(heat_level(end) - heat_level(row)) <= slack && same_heat(end, row)) ++end;
    return end;
  }

  /// One row where there is one; else one from the start and one from the middle, which is observed.
  void add_uniform(Eigen::Index begin, Eigen::Index end) {
    Row row;
    for (Eigen::Index one = begin; one < end; ++one) row.of.push_back(one);
    row.t_s = full_.t_s[begin];
    Rates rates;
    if (end - begin > 1) {
      rates = rates_of(begin, end);
      row.rate_dps = rates.before;
      rows_.push_back(row);
      row.t_s = full_.t_s.segment(begin, end - begin).mean();
    }
    Row middle = row;
    middle.motor_begin = begin;
    middle.motor_end = end;
    middle.current = true;
    middle.rate_dps = rates.mean;
    rows_.push_back(std::move(middle));
    if (!std::isfinite(rates.after)) return;
    row.t_s = rates.after_s;
    row.rate_dps = rates.after;
    rows_.push_back(std::move(row));
  }

  /// The rates that stand for those of a block; NaN where they hardly vary.
  struct Rates {
    double before = missing;  ///< up to the middle
    double mean = missing;    ///< from the middle on, where the current is observed
    double after = missing;   ///< from `after_s` on, for half as long as `before`
    double after_s = missing;
  };

  /// A counter-voltage goes with the mean rate, and a loss with the square: these have both.
  Rates rates_of(Eigen::Index begin, Eigen::Index end) const {
    if (full_.covariate_rate_dps.size() == 0) return {};
    const auto rates = full_.covariate_rate_dps.segment(begin, end - begin).array().abs();
    const auto stamps = full_.t_s.segment(begin, end - begin);
    const double mean = rates.mean(), variance = (rates - mean).square().mean();
    const double rows = static_cast<double>(end - begin), since_s = full_.t_s[begin];
    const double before_s = stamps.mean() - since_s;
    const double lasts_s = (full_.t_s[end - 1] - since_s) * rows / (rows - 1.0);
    if (!(variance > limit_.rate_varies * limit_.rate_varies * mean * mean) ||
        !(before_s < limit_.middle * lasts_s))
      return {};
    const double below = std::sqrt(variance * lasts_s / (3.0 * before_s));
    return {std::max(mean - below, 0.0), mean, mean + 2.0 * below, since_s + lasts_s - 0.5 * before_s};
  }

  void add_mixed(Eigen::Index begin, Eigen::Index end, double until_s) {
    std::vector<Eigen::Index> order;
    for (Eigen::Index one = begin; one < end; ++one) order.push_back(one);
    sort_by(order, [&](Eigen::Index row) { return heat_level(row); });
    // Cut at the two widest steps of the level.
    std::array<std::size_t, 2> cuts{0, 0};
    std::array<double, 2> widest{0.0, 0.0};
    for (std::size_t i = 1; i < order.size(); ++i) {
      const double step = heat_level(order[i]) - heat_level(order[i - 1]);
      if (step > widest[0]) {
        widest[1] = widest[0], cuts[1] = cuts[0];
        widest[0] = step, cuts[0] = i;
      } else if (step > widest[1]) {
        widest[1] = step, cuts[1] = i;
      }
    }
    std::sort(cuts.begin(), cuts.end());
    std::vector<std::size_t> edges{0, cuts[0], cuts[1], order.size()};
    const double whole_s = until_s - full_.t_s[begin],
                 share_s = 0.5 * whole_s / static_cast<double>(order.size());
    double now_s = full_.t_s[begin];
    for (int half = 0; half < 2; ++half) {
      bool first = true;
      for (std::size_t k = 0; k < 3; ++k) {
        if (edges[k + 1] == edges[k]) continue;
        Row row;
        row.of.assign(order.begin() + static_cast<std::ptrdiff_t>(edges[k]),
                      order.begin() + static_cast<std::ptrdiff_t>(edges[k + 1]));
        row.t_s = now_s;
        if (half == 1 && first) row.motor_begin = begin, row.motor_end = end;
        row.current = half == 1 && heat_level(row.of.back()) - heat_level(row.of.front()) <=
                                       limit_.one_level * std::abs(heat_level(row.of.back()));
        now_s += share_s * static_cast<double>(row.of.size());
        first = false;
        rows_.push_back(std::move(row));
      }
    }
  }

  void gather(const Eigen::VectorXd& from, Eigen::VectorXd& to, bool squared) const {
    if (from.size() == 0) return;
    Eigen::VectorXd values(static_cast<Eigen::Index>(rows_.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      double sum = 0.0;
      const std::vector<Eigen::Index>& of = rows_[i].of;
      for (Eigen::Index row : of) sum += squared ? from[row] * from[row] : from[row];
      const double mean = sum / static_cast<double>(of.size());
      values[static_cast<Eigen::Index>(i)] = of.size() == 1 ? from[of[0]] : squared ? std::sqrt(mean) : mean;
    }
    to = std::move(values);
  }

  void observe(Signal signal, Inputs& thin) const {
    // A sensor slower than the rows is in some of them only.
    const double usual =
        static_cast<double>(full_.of(signal).array().isFinite().count()) / static_cast<double>(full_.rows());
    Eigen::VectorXd& to = thin.measured[static_cast<std::size_t>(signal)];
    to = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(rows_.size()), missing);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      double asked = 0.0;
      for_observed(rows_[i], signal, [&](Eigen::Index) { asked += 1.0; });
      const Mean mean = mean_of(rows_[i], signal, full_.of(signal));
      if (mean.count <= 0.0 || 3.0 * mean.count < 2.0 * usual * asked) continue;
      to[static_cast<Eigen::Index>(i)] = mean.value;
      // Rows carry one weight for both signals, which have the same number of samples wherever both are observed. In mixed
      // blocks the temperature has more, and the current's number counts.
      thin.repeats[static_cast<Eigen::Index>(i)] = mean.count;
    }
  }

  /// Calls `use(row)` for the rows of the full recording that a signal's observation is the mean of.
  template <class Use>
  static void for_observed(const Row& row, Signal signal, Use&& use) {
    if (signal == Signal::motor_C)
      for (Eigen::Index one = row.motor_begin; one < row.motor_end; ++one) use(one);
    else if (row.current)
      for (Eigen::Index one : row.of) use(one);
  }

  struct Mean {
    double value = 0.0, count = 0.0;
  };

  /// Mean of some values over the rows at which the signal was measured.
  Mean mean_of(const Row& row, Signal signal, const Eigen::VectorXd& values) const {
    Mean mean;
    for_observed(row, signal, [&](Eigen::Index one) {
      if (std::isfinite(full_.of(signal)[one])) mean.value += values[one], mean.count += 1.0;
    });
    mean.value /= std::max(mean.count, 1.0);
    return mean;
  }

  /// The baseline's values, indexed by Signal.
  typedef std::array<Eigen::VectorXd, 2> Simulated;

  Simulated simulated(const Inputs& inputs) const {
    Simulated result;
    result.fill(Eigen::VectorXd::Constant(inputs.rows(), missing));
    std::vector<Segment> segments;
    const Plant& plant = plant_of(baseline_);
    plant.cut(inputs, 0.0, segments);
    simulate_segments(baseline_, catalogue_, segments, SimulationMode::free_running,
                      [&](std::size_t index, const Readings& readings) {
                        const std::vector<Signal>& signals = plant.signals(segments[index]);
                        for (std::size_t k = 0; k < signals.size(); ++k) {
                          const auto at = static_cast<std::size_t>(signals[k]);
                          if (at >= result.size()) continue;  // a loop's duty
                          for (Eigen::Index row = segments[index].begin; row < segments[index].end; ++row)
                            result[at][row] = readings.value(row, static_cast<int>(k));
                        }
                      });
    return result;
  }

  /// The noise of single samples. A step of the power moves the errors of a model, too. It is not noise.
  double noise_of_samples(Signal signal, const Eigen::VectorXd& simulated) const {
    const Eigen::VectorXd& measured = full_.of(signal);
    std::vector<double> errors;
    std::vector<bool> gaps;
    for (const RunSpan& run : full_.runs)
      for (Eigen::Index row = run.begin; row < run.end; ++row) {
        const double error = simulated[row] - measured[row];
        if (!std::isfinite(error)) continue;
        errors.push_back(error);
        gaps.push_back(row == run.begin || heat_level(row) != heat_level(row - 1));
      }
    return noise_sd(errors, gaps, quantum_of(measured));
  }

  static constexpr ThinningThresholds limit_{};
  const Inputs& full_;
  Eigen::Index block_ = 1;
  double longest_s_ = 1.0;
  const Model& baseline_;
  const Catalogue& catalogue_;
  std::vector<Row> rows_;
};

/// Shortens a bench recording; blocks of mixed power stay within a fiftieth of the baseline's time constant.
inline Inputs thinned_bench(const Inputs& full, Eigen::Index rows, const Model& model,
                            const Catalogue& catalogue) {
  constexpr ThinningThresholds limit;
  double tau_s = limit.usual_time_constant_s;
  if (const auto* lumped = std::get_if<LumpedThermalModel>(&model.thermal))
    tau_s = lumped->heat_capacity_J_per_K / lumped->conductance_W_per_K;
  else if (const auto* polynomial = std::get_if<ThesisThermalModel>(&model.thermal))
    tau_s = 60.0 / polynomial->cooling_per_min;
  return BenchThinning(full, rows, limit.of_time_constant * tau_s, model, catalogue).run();
}

}  // namespace thermopower::gap::engine
