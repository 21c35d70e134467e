// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/compare/thresholds.hpp>
#include <thermopower/gap/fit/axis_averaging.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/gap/fit/segment_choice.hpp>
#include <thermopower/gap/fit/thinning.hpp>
#include <thermopower/gap/options.hpp>

#include <algorithm>
#include <cassert>
#include <memory>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// Puts recordings to a model: thinned to what its dynamics need, in windows, few enough of them to fit many
/// explanations.
class Posing {
public:
  /// How much of the data, in which windows.
  struct Extent {
    double window_s;            ///< length of the windows of an axis
    Eigen::Index bench_rows;    ///< of all recordings on the bench, about
    Eigen::Index axis_rows;     ///< of all windows of an axis, about
    Eigen::Index together = 1;  ///< neighbours among these that are kept or left out together
  };

  /// All of them must outlive this object.
  Posing(const Model& model, const Options& options, const Catalogue& catalogue)
      : model_(model), options_(options), catalogue_(catalogue) {}

  const Model& model() const { return model_; }
  const Options& options() const { return options_; }
  const Catalogue& catalogue() const { return catalogue_; }

  /// Long windows tell more than the short ones of the score; the short ones keep a bad model near the data.
  double long_window_s() const { return std::max(search_extent.fitted_window_s, options_.horizon_s); }

  /// The windows that explanations are fitted to in the end.
  Extent fitted(double window_s) const {
    return {window_s, search_extent.fitted_bench_rows, search_extent.fitted_axis_rows, 1};
  }

  /// The problem that is fitted. It keeps the thinned data.
  FitProblem pose(const std::vector<Inputs>& inputs, const Extent& extent) const {
    auto thin = std::make_shared<std::vector<Inputs>>();
    for (const Inputs& one : inputs) {
      const Eigen::Index share = std::max<Eigen::Index>(
          300, extent.bench_rows * one.rows() / std::max<Eigen::Index>(1, total_rows(inputs)));
      if (one.axis()) thin->push_back(one.bench() ? one : AxisAveraging(one).run(options_.horizon_s));
      else thin->push_back(one.bench() ? thinned_bench(one, share, model_, catalogue_) : one);
    }
    FitProblem problem;
    problem.model = &model_;
    problem.catalogue = &catalogue_;
    problem.stop = options_.stop;
    problem.segments =
        thinned_axis(cut(*thin, extent.window_s, plant_of(model_)), extent.axis_rows, extent.together);
    problem.data = std::move(thin);
    assert(std::all_of(problem.segments.begin(), problem.segments.end(), [&](const Segment& one) {
      return one.inputs >= problem.data->data() && one.inputs < problem.data->data() + problem.data->size();
    }));
    return problem;
  }

  /// Segments as a gap is judged, few enough to judge many explanations on.
  std::vector<Segment> judged(const std::vector<Inputs>& inputs) const {
    return thinned_axis(cut(inputs, options_.horizon_s, plant_of(model_)), search_extent.judged_rows);
  }

private:
  const Model& model_;
  const Options& options_;
  const Catalogue& catalogue_;
};

}  // namespace thermopower::gap::engine
