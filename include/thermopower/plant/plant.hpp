// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/model.hpp>
#include <thermopower/plant/rows.hpp>
#include <thermopower/plant/segment.hpp>
#include <thermopower/plant/simulation_mode.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace thermopower::plant {

struct PlantInfo;

/// A point in the space that a fit moves in: factors on a model's constants, and parameters of effects that act
/// besides the model's own.
///
/// @snippet plant_examples.cpp rollout
/// How to: @ref gap_method, @ref diagnose_a_gap.
struct ParameterPoint {
  std::vector<double> factors;  ///< by which each of Model::calibrated() is moved; empty: none is
  std::vector<const CatalogueEntry*> effects;  ///< that act in addition, not owned
  std::vector<double> parameters;              ///< of `effects`, one effect after the other, in their units
  /// Derivative of each factor, then of each parameter, by the coordinate that a fit moves it with; empty: 1.
  std::vector<double> speed;
  std::vector<bool>
      still;  ///< of each factor and parameter: it does not move, and is no direction; empty: all move

  /// How many factors and parameters there are.
  int size() const { return static_cast<int>(factors.size() + parameters.size()); }

  /// How many directions factors and parameters make: those that move.
  int directions() const { return size() - static_cast<int>(std::count(still.begin(), still.end(), true)); }

  /// The direction of a factor or, after all of them, a parameter; -1: it does not move.
  int direction(int index) const {
    if (still.empty()) return index;
    if (still[static_cast<std::size_t>(index)]) return -1;
    return index - static_cast<int>(std::count(still.begin(), still.begin() + index, true));
  }
};

/// The directions that one rollout differentiates by: `count` of them from `first` on, in the order factors,
/// parameters, coordinates of the segment's start.
struct Directions {
  int first = 0;  ///< index of the first one
  int count = 0;  ///< how many; 0: values alone
};

/// The result of a rollout for a segment: a value for each of its signals at each of its rows, with derivatives.
///
/// @snippet plant_examples.cpp rollout
/// How to: @ref gap_method, @ref diagnose_a_gap.
class Readings {
public:
  /// Makes room for rows [begin, end), all NaN.
  void reset(Eigen::Index begin, Eigen::Index end, int signals, int directions) {
    begin_ = begin;
    signals_ = signals;
    directions_ = directions;
    const std::size_t count = static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(signals);
    value_.assign(count, missing);
    slope_.assign(count * static_cast<std::size_t>(directions), 0.0);
  }

  /// Sets the value of the `signal`-th signal of the segment at a row, with the derivatives that it carries.
  template <class Scalar>
  void put(Eigen::Index row, int signal, const Scalar& simulated) {
    const std::size_t at = place(row, signal);
    value_[at] = value_of(simulated);
    double* slope = slope_.data() + at * static_cast<std::size_t>(directions_);
    for (int k = 0; k < directions_; ++k) slope[k] = derivative_of(simulated, k);
  }
  /// Sets a derivative alone.
  void put_slope(Eigen::Index row, int signal, int direction, double slope) {
    slope_[place(row, signal) * static_cast<std::size_t>(directions_) + static_cast<std::size_t>(direction)] =
        slope;
  }

  /// Value of the `signal`-th signal of the segment at a row; NaN where it could not be simulated.
  double value(Eigen::Index row, int signal) const { return value_[place(row, signal)]; }
  /// Its derivative in the `direction`-th direction of the rollout.
  double slope(Eigen::Index row, int signal, int direction) const {
    return slope_[place(row, signal) * static_cast<std::size_t>(directions_) +
                  static_cast<std::size_t>(direction)];
  }
  /// Its derivatives in all directions, one after the other; null where there are none.
  const double* slopes(Eigen::Index row, int signal) const {
    return slope_.data() + place(row, signal) * static_cast<std::size_t>(directions_);
  }
  /// How many directions there are.
  int directions() const { return directions_; }

private:
  std::size_t place(Eigen::Index row, int signal) const {
    return static_cast<std::size_t>(row - begin_) * static_cast<std::size_t>(signals_) +
           static_cast<std::size_t>(signal);
  }

  Eigen::Index begin_ = 0;
  int signals_ = 0, directions_ = 0;
  std::vector<double> value_, slope_;
};

/// A start that nobody measures, so that a simulation takes the one that fits the segment's data best.
struct HiddenStart {
  int coordinate = 0;              ///< of the segment's start
  Signal shows_in = Signal{};      ///< the signal whose data tell it
  double trial = 1.0;              ///< how far it is moved to see what it does, in its unit
  double noise_per_spread = 0.02;  ///< noise of that signal relative to how far such starts spread
  double farthest = 100.0;         ///< no further than this from 0, in its unit
};

/// A plant at one point of its parameters, under way through the segments of recordings.
///
/// @snippet plant_examples.cpp rollout
/// How to: @ref gap_method, @ref diagnose_a_gap.
class Rollout {
public:
  virtual ~Rollout() = default;

  /// Simulates a segment and leaves its readings, and their derivatives in the directions of this rollout, in
  /// `out`. Segments of one recording are to be given in order: states that nobody measures are carried on. The segment
  /// that was rolled last may be rolled again, as with other starts: what was carried into it is carried into it again.
  /// @param start  how far the segment's start is from the measured one, as many as Plant::start_size()
  virtual void roll(const Segment& segment, const Start& start, Readings& out) = 0;

  /// The starts of a segment that nobody measures and that matter at this point.
  virtual std::vector<HiddenStart> hidden_starts(const Segment& segment) const = 0;

  /// Standard deviation of the segment's start where it is taken from measured values with this noise.
  virtual Start measured_start_sd(const Segment& segment,
                                  const std::array<double, signal_count>& sigma) const = 0;

  /// Whether states that nobody measures pass from each window of a recording into the next, so that the noise of all
  /// starts before a window tells in it.
  virtual bool carries_states() const { return false; }
};

/// The equations of a plant as an object: everything that the stages of a diagnosis ask of it.
///
/// A Model says which plant it is of, with which constants and effects; a Plant holds no values. Stages never
/// state an equation: whatever answers these questions is diagnosed like the library's own plants.
///
/// @snippet plant_examples.cpp rollout
/// How to: @ref gap_method, @ref diagnose_a_gap.
class Plant {
public:
  virtual ~Plant() = default;

  /// The description of a plant of your own; null for the library's.
  virtual const PlantInfo* info() const { return nullptr; }
  /// The effects that a plant of one's own may have, in place of the library's; null for the library's.
  virtual const Catalogue* effects() const { return nullptr; }

  /// The signals that a segment is simulated for, in the order of its readings.
  virtual const std::vector<Signal>& signals(const Segment& segment) const = 0;

  /// Cuts a recording into segments, appended to `segments`: whole runs, or windows of `horizon_s` (whole runs
  /// where that is not positive or infinite). They refer to `inputs`, which must outlive them.
  virtual void cut(const Inputs& inputs, double horizon_s, std::vector<Segment>& segments) const = 0;

  /// How many unknowns the start of a segment has, at most `largest_start`.
  virtual int start_size(const Segment& segment) const = 0;

  /// Inverse standard deviations of a segment's start around the measured one, for measured signals with this
  /// noise.
  virtual Start start_weight(const Segment& segment, const std::array<double, signal_count>& sigma) const = 0;

  /// How many directions one rollout carries best; more take several rollouts.
  virtual int directions_at_once() const { return dual_width; }

  /// The plant with a model's constants, at a point. `model` and `catalogue` (which knows the effects of both)
  /// must outlive the rollout, and so must the entries of the point.
  /// @throws InvalidInput for an effect or parameter of the model that the catalogue does not know
  virtual std::unique_ptr<Rollout> rollout(const Model& model, const Catalogue& catalogue,
                                           const ParameterPoint& point, const Directions& directions,
                                           SimulationMode mode) const = 0;
};

}  // namespace thermopower::plant
