// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise/projection.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

/// @file
/// The judgement of one balance: which freedoms of its plant, with no formula, predict what the baseline does not.

namespace thermopower::gap::engine {

/// One balance, judged.
class Judgement {
public:
  /// @param slack  how far the balance's constants may be off, as a fraction
  Judgement(const plant::Balance& balance, double slack, const LocalisationThresholds& limit)
      : balance_(names_of(balance)), limit_(limit) {
    const std::unique_ptr<Projection> projection = projection_of(balance, limit_);
    floor_ = projection->floor();
    if (projection->residual().size() < limit_.least_rows) return;
    Problem problem = problem_of(balance, *projection, slack);
    std::vector<Block> blocks;
    for (const plant::Freedom& freedom : balance.freedoms)
      blocks.push_back(block_of(freedom, *projection, problem));
    const BlockFitter fitter(problem, blocks);
    choice_ = choose_blocks(fitter, floor_, limit_);
    for (const Block& block : blocks) at_.push_back(block.at);
    weigh(fitter);
    Eigen::Index from = problem.nuisance.cols() + problem.free.cols();
    for (const std::size_t i : choice_.best.blocks) {
      coefficient_.push_back(choice_.best.coefficients[from]);
      from += blocks[i].columns.cols();
    }
    if (asks_for_course()) look_for_course(balance, *projection, problem);
  }

  /// The balance's names and words, without its rows: a recording may be long, and who needs them makes them again.
  const plant::Balance& balance() const { return *balance_; }
  /// Whether the constants within their slack leave more than noise allows.
  bool gap() const {
    return choice_.none.seen_total > limit_.gap_seen * floor_ && before() > limit_.gap_unseen;
  }
  /// Indices of the freedoms chosen; the one that explains more first.
  const std::vector<std::size_t>& chosen() const { return choice_.best.blocks; }
  /// The k-th of them.
  const plant::Freedom& freedom(std::size_t k) const {
    assert(k < chosen().size() && chosen()[k] < balance_->freedoms.size());
    return balance_->freedoms[chosen()[k]];
  }
  /// Share of the excess that the k-th explains, 0..1.
  double worth(std::size_t k) const {
    assert(k < worth_.size());
    return worth_[k];
  }
  /// Its first coefficient.
  double coefficient(std::size_t k) const { return coefficient_[k]; }
  /// Its name.
  std::string words(std::size_t k) const {
    const plant::Freedom& one = freedom(k);
    return one.words_at ? one.words_at(at_[chosen()[k]]) : one.words;
  }
  /// Share of the excess on unseen stretches that all of them explain, 0..1.
  double explained() const {
    return std::min(1.0, (choice_.none.unseen_total - choice_.best.unseen_total) / excess_);
  }
  /// The rest of the constants alone on unseen stretches, in floors.
  double before() const { return choice_.none.unseen_total / floor_; }
  /// The rest of the chosen freedoms there, in floors.
  double left() const { return choice_.best.unseen_total / floor_; }
  /// Whom a course of its own accuses that no freedom of few directions describes; nullptr: none is better.
  const plant::Freedom* course() const { return course_; }
  /// Share of what the constants leave that it explains, 0..1.
  double course_share() const { return course_share_; }
  /// The cost of this account of the balance among its alternatives.
  double cost() const {
    return choice_.best.unseen_total * (1.0 + limit_.per_block * static_cast<double>(chosen().size()));
  }

private:
  static std::shared_ptr<const plant::Balance> names_of(const plant::Balance& balance) {
    auto names = std::make_shared<plant::Balance>();
    names->quantity = balance.quantity;
    names->unit = balance.unit;
    names->signal = balance.signal;
    names->instrument = balance.instrument;
    names->otherwise = balance.otherwise;
    names->given = balance.given;
    names->form = balance.form;
    names->reads = balance.reads;
    names->freedoms = balance.freedoms;
    names->courses = balance.courses;
    for (auto* list : {&names->freedoms, &names->courses})
      for (plant::Freedom& one : *list) one.directions = nullptr;
    return names;
  }

  void weigh(const BlockFitter& fitter) {
    excess_ = std::max(choice_.none.unseen_total - floor_, std::numeric_limits<double>::min());
    const std::vector<std::size_t>& blocks = choice_.best.blocks;
    const double all = std::max(0.0, choice_.none.unseen_total - choice_.best.unseen_total);
    double sum = 0.0;
    for (const std::size_t i : blocks) {
      worth_.push_back(blocks.size() == 1
                           ? all
                           : std::max(0.0, fitter.fit({blocks[i == blocks[0] ? 1 : 0]}).unseen_total -
                                               choice_.best.unseen_total));
      sum += worth_.back();
    }
    for (double& one : worth_) one *= sum > 0.0 ? std::min(1.0, all / excess_) / sum : 0.0;
  }

  bool asks_for_course() const {
    if (balance_->courses.empty() || !gap()) return false;
    const bool weak = balance_->form == plant::BalanceForm::weak;
    return left() > (weak ? limit_.weak_course : limit_.filtered_course) &&
           (weak || explained() < limit_.filtered_explained) &&
           choice_.best.seen_total > limit_.course_of_seen * choice_.none.seen_total;
  }

  void look_for_course(const plant::Balance& balance, const Projection& projection, const Problem& problem) {
    const double rows = static_cast<double>(problem.y.size()),
                 price = balance_->form == plant::BalanceForm::weak ? limit_.weak_per_direction
                                                                    : limit_.filtered_per_direction;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < balance.courses.size(); ++i) {
      const Eigen::MatrixXd columns = projection.columns(balance.courses[i].directions(0.0));
      const double free_rows = std::max(1.0, rows - price * static_cast<double>(columns.cols()));
      const double left = sum_of_squares_left(problem, columns) * rows * rows / (free_rows * free_rows);
      if (!(left < least)) continue;
      least = left;
      course_ = &balance_->courses[i];
    }
    if (!(least < limit_.course_better * std::min(choice_.best.seen_total, choice_.none.seen_total)))
      course_ = nullptr;
    course_share_ = std::clamp(1.0 - least / choice_.none.seen_total, 0.0, 1.0);
  }

  std::shared_ptr<const plant::Balance> balance_;  // shared: copies keep what points into it
  LocalisationThresholds limit_;
  Choice choice_;
  std::vector<double> worth_, coefficient_, at_;
  const plant::Freedom* course_ = nullptr;
  double floor_ = 1.0, excess_ = 1.0, course_share_ = 0.0;
};

}  // namespace thermopower::gap::engine
