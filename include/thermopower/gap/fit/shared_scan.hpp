// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/fitter.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <vector>

/// @file
/// Many starts of a fit looked at in few simulations.

namespace thermopower::gap::engine {

/// Looks at starts of one explanation. At several points an effect may be absent. They differ only in one of its other
/// parameters, such as how often a torque repeats in a turn. Then they are one simulation. With the effect in it several
/// times over, it tells the effect's promise at each of them.
class SharedScan {
public:
  /// Keeps references to its arguments: they must outlive this object.
  SharedScan(const FitProblem& problem, const Explanation& explanation, const std::vector<Coordinate>& list)
      : problem_(problem), explanation_(explanation), list_(list), fitter_(problem, explanation, list) {}

  /// The promise of one linear step from each point, in their order; see Fitter::scan().
  std::vector<double> costs(const std::vector<Eigen::VectorXd>& points) {
    std::vector<double> all;
    for (std::size_t begin = 0; begin < points.size(); begin = all.size()) {
      const Block block = block_of_difference(points, begin);
      const std::size_t end = alike_until(points, begin, block);
      if (end > begin + 1) look_at_alike(points, begin, end, block, all);
      else all.push_back(fitter_.scan(points[begin]));
    }
    return all;
  }

private:
  /// The coordinates of one effect.
  struct Block {
    std::size_t effect = 0;   ///< its place among the explanation's
    Eigen::Index begin = 0;   ///< first of its coordinates
    Eigen::Index size = 0;    ///< how many there are; 0: no effect at all
    int sizes = 0;            ///< of them, those that say how large it is: free, and where it is not there
    Eigen::Index other = -1;  ///< the one that differs

    Eigen::Index end() const { return begin + size; }
    bool holds(Eigen::Index at) const { return at >= begin && at < end(); }
  };

  /// The effect in which the point after `begin` differs from it, where it is in one coordinate of an effect that is not there.
  Block block_of_difference(const std::vector<Eigen::VectorXd>& points, std::size_t begin) const {
    // A plant of somebody's own may know each effect but once.
    if (begin + 1 >= points.size() || problem_.model->own) return {};
    const Eigen::VectorXd &one = points[begin], &next = points[begin + 1];
    Block block;
    block.begin = static_cast<Eigen::Index>(problem_.model->calibrated().size());
    for (; block.effect < explanation_.effects.size(); ++block.effect, block.begin += block.size) {
      const EffectInfo& info = explanation_.effects[block.effect]->info;
      block.size = static_cast<Eigen::Index>(info.parameters.size());
      if (one.segment(block.begin, block.size) == next.segment(block.begin, block.size)) continue;
      for (Eigen::Index k = 0; k < block.size; ++k) {
        const Eigen::Index at = block.begin + k;
        const Coordinate& coordinate = list_[static_cast<std::size_t>(at)];
        if (coordinate.still) continue;
        const Parameter& parameter = info.parameters[static_cast<std::size_t>(k)];
        if (one[at] != next[at] && block.other < 0) block.other = at;
        else if (one[at] == next[at] && coordinate.value_of(one[at]) == parameter.absent_at) ++block.sizes;
        else return {};
      }
      return info.states.empty() && block.sizes > 0 && block.other >= 0 ? block : Block();
    }
    return {};
  }

  /// One past the last of the points from `begin` on that differ only in the effect's one coordinate.
  static std::size_t alike_until(const std::vector<Eigen::VectorXd>& points, std::size_t begin,
                                 const Block& block) {
    std::size_t end = begin + 1;
    if (block.size == 0) return end;
    for (; end < points.size(); ++end) {
      Eigen::VectorXd same = points[end];
      same[block.other] = points[begin][block.other];
      if (same != points[begin]) break;
    }
    return end;
  }

  /// Looks at points that are alike, as many at once as one pass of derivatives carries. The part that does not depend on
  /// the effect is computed with the first of them.
  void look_at_alike(const std::vector<Eigen::VectorXd>& points, std::size_t begin, std::size_t end,
                     const Block& block, std::vector<double>& costs) {
    const int all = problem_.plant().directions_at_once(),
              starts = largest_start_size(problem_.plant(), problem_.segments);
    int others = 0;
    for (std::size_t i = 0; i < list_.size(); ++i)
      others += !list_[i].still && !block.holds(static_cast<Eigen::Index>(i));
    const auto at_once = [&](int taken) {
      return static_cast<std::size_t>(std::max(1, (all - taken) / block.sizes));
    };
    std::vector<FitProblem::Residuals> base;
    for (std::size_t from = begin; from < end;) {
      const std::size_t to = std::min(end, from + at_once(from == begin ? starts + others : starts));
      look_at(points, from, to, block, base, costs);
      from = to;
    }
  }

  /// Looks at points that are alike in one simulation.
  /// @param base  residuals with the derivatives by what does not hang on the effect; empty: they are worked out, too
  void look_at(const std::vector<Eigen::VectorXd>& points, std::size_t begin, std::size_t end,
               const Block& block, std::vector<FitProblem::Residuals>& base, std::vector<double>& costs) {
    const bool is_first = base.empty();
    const Eigen::Index n = points[begin].size(),
                       more = static_cast<Eigen::Index>(end - begin - 1) * block.size;
    Explanation many = explanation_;
    many.effects.insert(many.effects.begin() + static_cast<std::ptrdiff_t>(block.effect), end - begin - 1,
                        explanation_.effects[block.effect]);
    std::vector<Coordinate> list;
    Eigen::VectorXd at(n + more);
    const auto add = [&](Eigen::Index from, Eigen::Index to, const Eigen::VectorXd& point) {
      for (Eigen::Index i = from; i < to; ++i) {
        at[static_cast<Eigen::Index>(list.size())] = point[i];
        Coordinate& one = list.emplace_back(list_[static_cast<std::size_t>(i)]);
        one.still = one.still || i == block.other || (!is_first && !block.holds(i));
      }
    };
    add(0, block.begin, points[begin]);
    for (std::size_t k = begin; k < end; ++k) add(block.begin, block.end(), points[k]);
    add(block.end(), n, points[begin]);
    std::vector<std::vector<FitProblem::Residuals>> residuals(end - begin);
    problem_.evaluate(many, list, at, problem_.measured_starts(), true,
                      [&](std::size_t segment, const FitProblem::Residuals& all) {
                        if (is_first) base.push_back(without(all, block.end(), more));
                        for (std::size_t k = 0; k < residuals.size(); ++k) {
                          residuals[k].push_back(base[segment]);
                          residuals[k].back().jacobian.middleCols(block.begin, block.size) =
                              all.jacobian.middleCols(block.begin + static_cast<Eigen::Index>(k) * block.size,
                                                      block.size);
                        }
                      });
    for (std::size_t k = begin; k < end; ++k) costs.push_back(fitter_.scan(points[k], residuals[k - begin]));
  }

  /// Residuals without the derivatives by `count` coordinates from `from` on.
  static FitProblem::Residuals without(const FitProblem::Residuals& all, Eigen::Index from,
                                       Eigen::Index count) {
    FitProblem::Residuals one{all.value, {}, all.signal, all.row};
    const Eigen::Index behind = all.jacobian.cols() - count - from;
    one.jacobian.resize(all.jacobian.rows(), from + behind);
    one.jacobian.leftCols(from) = all.jacobian.leftCols(from);
    one.jacobian.rightCols(behind) = all.jacobian.rightCols(behind);
    return one;
  }

  const FitProblem& problem_;
  const Explanation& explanation_;
  const std::vector<Coordinate>& list_;
  Fitter fitter_;
};

}  // namespace thermopower::gap::engine
