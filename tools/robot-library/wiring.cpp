// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/robot/wiring.hpp>

#include "assignment.hpp"
#include "unit_factors.hpp"
#include "wiring_evidence.hpp"
#include "wiring_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

namespace thermopower::robot {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double close_factor = 1.25;      // two factors that differ by less are the same
constexpr double clear_factor = 1.2;       // gains that differ by more are not the same
constexpr double closer_share = 0.45;      // of a gain's logarithmic error that its exchange may leave
constexpr double unclear_factor = 2.0;     // the same where the effort was not measured
constexpr double controlled_share = 0.35;  // of the effort's spread that a controller may leave
constexpr double moved_share = 0.5;       // of the effort's spread that the rigid body and friction may leave
constexpr double least_delay_s = 1e-3;    // that is worth a sentence
constexpr double samples_per_turn = 2.0;  // of a motion: where it turns, and how far it goes
constexpr double common_share = 0.6;  // of the joints that must have a unit, so that the others have it, too
constexpr Index few_rows = 500;       // for hypotheses that ask the rigid body once more

// Units of an angle and of a rate: logged number per rad or rad/s.
constexpr std::array<double, 3> angle_units{1.0, plant::deg_per_rad, turns_per_rad};
constexpr std::array<double, 4> rate_units{1.0, plant::deg_per_rad, rpm, turns_per_rad};

Wires identity(std::size_t joints) {
  Wires out;
  for (std::size_t j = 0; j < joints; ++j) out.source.push_back(static_cast<int>(j));
  out.factor.assign(joints, 1.0);
  out.offset.assign(joints, 0.0);
  return out;
}

std::size_t at(Index i) { return static_cast<std::size_t>(i); }
Index index(std::size_t i) { return static_cast<Index>(i); }

/// What a column is to a joint: the factor that fits best, and what it costs.
struct Link {
  double cost = 0.0, factor = 1.0, left = 1.0, constant = 0.0;
  double without = 1.0;  // what is left where the column is not asked at all
};

/// Each joint with each column of another quantity.
struct Links {
  std::vector<std::vector<Link>> of;  ///< [joint][column]; best over the factors
  std::vector<Link> named;            ///< each joint with its own column as it is named
  std::vector<char> known;            ///< joint and column both say something
};

class Checker {
public:
  Checker(const Body& body, const Robot& robot, const WiringOptions& options)
      : body_(body), robot_(robot), options_(options) {}

  Wiring run(const Log& log) {
    const std::size_t n = robot_.joints.size();
    out_.position = out_.velocity = out_.effort = out_.target = identity(n);
    for (std::size_t j = 0; j < n; ++j) out_.gains.push_back(static_cast<int>(j));
    raw_ = wiring_rows(log, options_.most_rows);
    if (raw_.position.rows() == 0) return std::move(out_);
    rows_ = raw_;
    check_angles();
    check_range();
    ask_body();
    check_effort();
    attribute();
    check_gains();
    check_whole_joints();
    check_offsets();
    check_delay();
    describe();
    return std::move(out_);
  }

private:
  std::size_t count() const { return robot_.joints.size(); }
  const Joint& joint(std::size_t j) const { return robot_.joints[j]; }

  double nats(std::size_t i, double left) const {
    return 0.5 * samples_per_turn * rows_.independent[index(i)] *
           std::log(left * left + options_.floor_share * options_.floor_share);
  }

  // ---- position, velocity, target: who belongs to whom, with which factor

  // The velocity's column against the slope of each joint's position.
  Links link_velocities() const {
    Links out = empty_links(rows_.velocity);
    for (std::size_t i = 0; i < count(); ++i)
      for (std::size_t k = 0; k < count(); ++k) {
        if (out.known[i] == 0 || out.known[k] == 0) continue;
        const VectorXd slope = rows_.slope.col(index(i)), logged = rows_.velocity.col(index(k));
        const double ss = slope.squaredNorm(), ls = slope.dot(logged), ll = logged.squaredNorm();
        consider(out, i, k, rate_units, angle_units, [&](double factor) {
          return Link{0.0, factor,
                      std::sqrt(std::max(0.0, ss - 2.0 * ls / factor + ll / (factor * factor)) / ss), 0.0};
        });
      }
    return out;
  }

  // The target's column: what leads a joint is its position, and what the controller needs to move it.
  Links link_targets() const {
    Links out = empty_links(rows_.target);
    const Index rows = rows_.position.rows();
    const MatrixXd targets = rows_.target.rowwise() - rows_.target.colwise().mean();
    for (std::size_t i = 0; i < count(); ++i) {
      if (out.known[i] == 0) continue;
      const VectorXd w = rows_.slope.col(index(i));
      MatrixXd x(rows, 3);
      x.col(0) = rows_.acceleration.col(index(i));
      x.col(1) = w;
      x.col(2) = (w.array() / (0.05 * spread(w) + 1e-9)).tanh();
      const VectorXd p_all = rows_.position.col(index(i));
      const VectorXd p = p_all.array() - p_all.mean();
      const double pp = p.squaredNorm();
      x = (x.rowwise() - x.colwise().mean()).eval();
      const MatrixXd gram = x.transpose() * x, with_targets = x.transpose() * targets;
      const VectorXd with_p = x.transpose() * p, tp = targets.transpose() * p;
      const double without = std::sqrt(fit_bounded(gram, -with_p, pp, 0).square / pp);
      for (std::size_t k = 0; k < count(); ++k) {
        if (out.known[k] == 0) continue;
        const double tt = targets.col(index(k)).squaredNorm();
        consider(out, i, k, angle_units, angle_units, [&](double f) {
          const double square = tt / (f * f) - 2.0 * tp[index(k)] / f + pp;
          const BoundedFit fit = fit_bounded(gram, with_targets.col(index(k)) / f - with_p, square, 0);
          return Link{0.0, f, std::sqrt(fit.square / pp),
                      rows_.target.col(index(k)).mean() / f - p_all.mean(), without};
        });
      }
    }
    return out;
  }

  Links empty_links(const MatrixXd& columns) const {
    Links out;
    out.of.assign(count(), std::vector<Link>(count()));
    out.named.assign(count(), Link());
    out.known.assign(count(), 0);
    for (std::size_t j = 0; j < count(); ++j)
      out.known[j] = columns.rows() > 0 && rows_.moves[j] != 0 && columns.col(index(j)).allFinite() &&
                     spread(columns.col(index(j))) > 0.0;
    return out;
  }

  // One line of the table after the other; the cheapest is kept. A unit may be the column's own or the position's.
  template <class Own, class Position, class Make>
  void consider(Links& out, std::size_t i, std::size_t k, const Own& own, const Position& position,
                const Make& make) const {
    std::set<double> factors;
    for (const double a : own)
      for (const double b : position)
        if (a == 1.0 || b == 1.0 || a == b) factors.insert(a == b ? 1.0 : a / b);
    Link best;
    best.cost = 1e300;
    for (const double size : factors)
      for (const double sign : {1.0, -1.0}) {
        Link one = make(sign * size);
        const double away = one.constant / options_.offset_rad;
        one.cost = nats(i, one.left) + std::min(0.5 * away * away, options_.fault_nats);
        if (i == k && sign * size == 1.0) out.named[i] = one;
        if (size != 1.0) one.cost += options_.fault_nats;
        if (sign < 0.0) one.cost += options_.fault_nats;
        if (one.cost < best.cost) best = one;
      }
    if (i != k) best.cost += options_.fault_nats;
    out.of[i][k] = best;
  }

  // Which column belongs to which joint, with which factor: identity and 1 unless another answer is clearly better.
  void decide(const Links& links, std::vector<int>& source, std::vector<double>& factor) const {
    const auto n = index(count());
    MatrixXd cost = MatrixXd::Zero(n, n);
    for (Index i = 0; i < n; ++i)
      for (Index k = 0; k < n; ++k) {
        const bool known = links.known[at(i)] != 0 && links.known[at(k)] != 0;
        cost(i, k) = known ? links.of[at(i)][at(k)].cost : i == k ? 0.0 : 1e6;
      }
    source = cheapest_assignment(cost);
    factor.assign(count(), 1.0);
    const auto is_clear = [&](std::size_t i, std::size_t k) {
      const Link &named = links.named[i], &best = links.of[i][k];
      return best.left < options_.most_left * std::min({1.0, named.left, best.without});
    };
    keep_clear_cycles(source, [&](int i, int k) {
      return std::make_pair(links.named[at(i)].cost - links.of[at(i)][at(k)].cost, is_clear(at(i), at(k)));
    });
    std::map<double, double> by_size;
    double known = 0.0;
    for (std::size_t i = 0; i < count(); ++i) {
      if (links.known[i] == 0) continue;
      const std::size_t k = at(source[i]);
      const Link& best = links.of[i][k];
      const bool is_exchanged = k != i;
      const bool wins = links.named[i].cost - best.cost > options_.least_nats && is_clear(i, k);
      if (is_exchanged || wins) factor[i] = best.factor;
      by_size[std::fabs(factor[i])] += 1.0;
      known += 1.0;
    }
    // A unit that most joints have is that of all of them. A joint that follows its target badly may look as if one of the two
    // were in turns; nobody logs a single joint so.
    for (const auto& [size, joints] : by_size) {
      if (size == 1.0) continue;
      const bool is_common = joints >= common_share * known;
      const bool is_turns = std::fabs(std::log(size * turns_per_rad)) < 0.01 ||
                            std::fabs(std::log(size / turns_per_rad)) < 0.01;
      for (double& one : factor) {
        if (is_common && std::fabs(one) == 1.0) one *= size;
        if (!is_common && is_turns && std::fabs(one) == size) one /= size;
      }
    }
  }

  // Cycles of a permutation in which every member gains clearly stay; the others are undone.
  template <class Gain>
  void keep_clear_cycles(std::vector<int>& source, const Gain& gain) const {
    std::vector<char> seen(source.size(), 0);
    for (std::size_t first = 0; first < source.size(); ++first) {
      std::vector<int> cycle;
      double won = 0.0;
      bool clear = true;
      for (int i = static_cast<int>(first); seen[at(i)] == 0; i = source[at(i)]) {
        seen[at(i)] = 1;
        cycle.push_back(i);
        const auto [nats, is_clear] = gain(i, source[at(i)]);
        won += nats;
        clear = clear && is_clear;
      }
      if (cycle.size() < 2) continue;
      if (clear && won > options_.least_nats * static_cast<double>(cycle.size())) continue;
      for (const int i : cycle) source[at(i)] = i;
    }
  }

  void check_angles() {
    std::vector<int> velocity_from = out_.velocity.source, target_from = out_.target.source;
    std::vector<double> by_velocity(count(), 1.0), by_target(count(), 1.0);
    const bool has_velocity = rows_.velocity.rows() > 0, has_target = rows_.target.rows() > 0;
    if (has_velocity) decide(link_velocities(), velocity_from, by_velocity);
    if (has_target) decide(link_targets(), target_from, by_target);
    // A joint whose velocity and target both disagree with its position in the same way: the position is at fault.
    for (std::size_t j = 0; j < count(); ++j) {
      const bool both = has_velocity && has_target;
      if (both && velocity_from[j] == target_from[j] && velocity_from[j] != static_cast<int>(j)) {
        // Column `source` belongs here: so this position belongs there.
        out_.position.source[at(velocity_from[j])] = static_cast<int>(j);
      } else {
        out_.velocity.source[j] = velocity_from[j];
        out_.target.source[j] = target_from[j];
      }
    }
    for (std::size_t j = 0; j < count(); ++j) {
      // Factors are told for the joint whose position it is: j counts the position's column.
      double position = 1.0;
      const double rv = by_velocity[j], rt = by_target[j];
      const auto unit_of_position = [](double ratio) {  // the unit that only the position can have
        const double size = std::fabs(ratio);
        return std::fabs(size * plant::deg_per_rad - 1.0) < 0.01 ? plant::deg_per_rad
               : std::fabs(size * turns_per_rad - 1.0) < 0.01    ? turns_per_rad
                                                                 : 1.0;
      };
      if (has_target && rt != 1.0) position = unit_of_position(rt);
      if (position == 1.0 && has_velocity && rv != 1.0) position = unit_of_position(rv);
      const bool velocity_turned = has_velocity && rv < 0.0, target_turned = has_target && rt < 0.0;
      if (velocity_turned && target_turned) position = -position;
      const std::size_t to = position_owner(j);
      out_.position.factor[to] = position;
      if (has_velocity) out_.velocity.factor[to] = rv * position;
      if (has_target) out_.target.factor[to] = rt * position;
    }
    rows_ = put_right(raw_, out_);
  }

  // The joint that a position's column belongs to.
  std::size_t position_owner(std::size_t column) const {
    for (std::size_t j = 0; j < count(); ++j)
      if (out_.position.source[j] == static_cast<int>(column)) return j;
    return column;
  }

  // ---- the range of each joint

  double outside(std::size_t j, const VectorXd& position) const {
    const double lower = joint(j).lower, upper = joint(j).upper;
    if (!std::isfinite(lower) || !std::isfinite(upper) || !position.allFinite()) return 0.0;
    const double slack = options_.range_share * (upper - lower) + 0.02;
    const double outside = static_cast<double>(
        ((position.array() < lower - slack) || (position.array() > upper + slack)).count());
    return outside / static_cast<double>(position.size());
  }

  // Angle of all quantities of a joint: the unit of all joints, then sign and zero of one.
  void check_range() {
    std::size_t out_of_range = 0, back = 0, limited = 0;
    for (std::size_t j = 0; j < count(); ++j) {
      if (!std::isfinite(joint(j).lower) || !std::isfinite(joint(j).upper)) continue;
      if (!rows_.position.col(index(j)).allFinite()) continue;
      ++limited;
      if (outside(j, rows_.position.col(index(j))) < 0.2) continue;
      ++out_of_range;
      back += outside(j, rows_.position.col(index(j)) / plant::deg_per_rad) < 0.02 ? 1 : 0;
    }
    const bool has_target = rows_.target.rows() > 0, has_velocity = rows_.velocity.rows() > 0;
    if (limited > 0 && 2 * out_of_range > limited && 10 * back > 9 * out_of_range) {
      for (std::size_t j = 0; j < count(); ++j) scale_joint(j, plant::deg_per_rad, has_velocity, has_target);
      rows_ = put_right(raw_, out_);
      return;
    }
    constexpr double pi = 3.14159265358979323846;
    for (std::size_t j = 0; j < count(); ++j) {
      const VectorXd position = rows_.position.col(index(j));
      if (outside(j, position) < 0.2) continue;
      std::vector<std::pair<double, double>> good;  // sign, offset
      for (const double sign : {1.0, -1.0})
        for (const double offset : {0.0, pi, -pi, 0.5 * pi, -0.5 * pi, 2.0 * pi, -2.0 * pi})
          if ((sign < 0.0 || offset != 0.0) && outside(j, VectorXd(sign * position.array() - offset)) < 0.02)
            good.emplace_back(sign, offset);
      // Of lines with one fault, exactly one must bring the joint back.
      std::vector<std::pair<double, double>> single;
      for (const auto& one : good)
        if (one.first > 0.0 || one.second == 0.0) single.push_back(one);
      // A target or velocity that was found turned against the position says that the sign is at fault.
      const bool turned = out_.target.factor[j] < 0.0 || out_.velocity.factor[j] < 0.0;
      if (turned && !single.empty() && single.back().first < 0.0) single = {single.back()};
      if (turned && !single.empty() && single.front().first < 0.0) single = {single.front()};
      if (single.size() != 1) continue;
      if (single.front().first < 0.0) {
        scale_joint(j, -1.0, has_velocity, has_target);
      } else {
        out_.position.offset[j] += single.front().second;
        if (has_target) out_.target.offset[j] += single.front().second;
      }
    }
    rows_ = put_right(raw_, out_);
  }

  void scale_joint(std::size_t j, double factor, bool has_velocity, bool has_target) {
    out_.position.factor[j] *= factor;
    if (has_velocity) out_.velocity.factor[j] *= factor;
    if (has_target) out_.target.factor[j] *= factor;
  }

  // ---- effort

  void ask_body() {
    Motion motion = rows_.base;
    motion.position = rows_.position;
    motion.velocity = rows_.slope;
    motion.acceleration = rows_.acceleration;
    for (Index j = 0; j < motion.position.cols(); ++j)
      if (!motion.position.col(j).allFinite()) {
        const Joint& one = joint(at(j));
        const bool limited = std::isfinite(one.lower) && std::isfinite(one.upper);
        motion.position.col(j).setConstant(limited ? 0.5 * (one.lower + one.upper) : 0.0);
        motion.velocity.col(j).setZero();
        motion.acceleration.col(j).setZero();
      }
    if (motion.base_pose.rows() > 0 && !motion.base_pose.allFinite()) motion.base_pose.resize(0, 7);
    rigid_ = body_.ask(motion).torque;
  }

  bool has(const MatrixXd& quantity, std::size_t j) const {
    return quantity.rows() > 0 && quantity.col(index(j)).allFinite();
  }

  // The effort as a position controller makes it: K (target - position) - D velocity.
  Misfit controlled(std::size_t j, const VectorXd& effort) const {
    MatrixXd x(effort.size(), 2);
    x.col(0) = late_target(j, late_s_) - rows_.position.col(index(j));
    x.col(1) = rows_.slope.col(index(j));
    return fit_columns(effort, x, 2);
  }

  // The effort as the rigid body and friction ask for it.
  Misfit moved(std::size_t j, const VectorXd& effort) const {
    const VectorXd w = rows_.slope.col(index(j));
    MatrixXd x(effort.size(), 4);
    x.col(0) = rigid_.col(index(j));
    x.col(1) = rows_.acceleration.col(index(j));
    x.col(2) = w;
    x.col(3) = (w.array() / (0.05 * spread(w) + 1e-9)).tanh();
    return fit_columns(effort, x, 0);
  }

  void check_effort() {
    if (rows_.effort.rows() == 0) return;
    Links links = empty_links(rows_.effort);
    delay_targets();
    // The controller tells more than the body, where it is one that the log's target and position make up.
    std::size_t controls = 0, known = 0;
    if (rows_.target.rows() > 0)
      for (std::size_t j = 0; j < count(); ++j) {
        if (links.known[j] == 0 || !has(rows_.target, j)) continue;
        ++known;
        double least = 1.0;
        for (std::size_t k = 0; k < count(); ++k)
          if (links.known[k] != 0) least = std::min(least, controlled(j, rows_.effort.col(index(k))).left);
        controls += least < controlled_share ? 1 : 0;
      }
    is_controlled_ = known > 0 && 2 * controls > known;
    // Without a controller the body must account for most efforts as they are named. On the ground it does not.
    if (!is_controlled_) {
      std::size_t accounted = 0, all = 0;
      for (std::size_t j = 0; j < count(); ++j) {
        if (links.known[j] == 0) continue;
        ++all;
        accounted += moved(j, rows_.effort.col(index(j))).left < moved_share ? 1 : 0;
      }
      if (2 * accounted <= all) return;
    }
    for (std::size_t i = 0; i < count(); ++i)
      for (std::size_t k = 0; k < count(); ++k) {
        if (links.known[i] == 0 || links.known[k] == 0) continue;
        if (is_controlled_ && !has(rows_.target, i)) continue;
        const VectorXd effort = rows_.effort.col(index(k));
        Link best;
        best.cost = 1e300;
        for (const double sign : {1.0, -1.0}) {
          Misfit fit = is_controlled_ ? controlled(i, sign * effort) : moved(i, sign * effort);
          if (is_controlled_ && fit.coefficient[0] <= 0.0) fit.left = 1.0;
          Link one{nats(i, fit.left), sign, fit.left, 0.0};
          if (i == k && sign > 0.0) links.named[i] = one;
          if (sign < 0.0) one.cost += options_.fault_nats;
          if (one.cost < best.cost) best = one;
        }
        if (i != k) best.cost += options_.fault_nats;
        links.of[i][k] = best;
      }
    std::vector<double> sign;
    decide(links, out_.effort.source, sign);
    for (std::size_t j = 0; j < count(); ++j) out_.effort.factor[j] = sign[j];
  }

  // ---- position against all others: who is at fault

  // Quantities besides the position that the log has.
  std::vector<Wires*> others() {
    std::vector<Wires*> out;
    if (raw_.velocity.rows() > 0) out.push_back(&out_.velocity);
    if (raw_.target.rows() > 0) out.push_back(&out_.target);
    if (raw_.effort.rows() > 0) out.push_back(&out_.effort);
    return out;
  }

  // Where everything else has the same fault, it is the position's. With one other quantity the rigid body decides.
  void attribute() {
    const std::vector<Wires*> all = others();
    if (all.empty()) return;
    bool any = false;
    for (std::size_t j = 0; j < count(); ++j) {
      const int source = all.front()->source[j];
      any = any || source != static_cast<int>(j) || all.front()->factor[j] < 0.0;
    }
    if (!any) return;
    Wiring instead = out_;
    const auto take = [&](Wiring& to, Wires* from, const Wires& with) {
      (from == &out_.velocity ? to.velocity : from == &out_.target ? to.target : to.effort) = with;
    };
    // Exchanged: all in the same way.
    std::vector<int> common = all.front()->source;
    for (const Wires* one : all)
      for (std::size_t j = 0; j < count(); ++j)
        if (one->source[j] != common[j]) common[j] = static_cast<int>(j);
    bool is_permutation = true;
    for (std::size_t j = 0; j < count(); ++j)
      is_permutation = is_permutation && std::count(common.begin(), common.end(), static_cast<int>(j)) == 1;
    bool changed = false;
    if (is_permutation) {
      for (std::size_t j = 0; j < count(); ++j) {
        if (common[j] == static_cast<int>(j)) continue;
        instead.position.source[at(common[j])] = static_cast<int>(j);
        changed = true;
      }
      for (Wires* one : all) {
        Wires with = *one;
        for (std::size_t j = 0; j < count(); ++j)
          if (common[j] != static_cast<int>(j)) with.source[j] = static_cast<int>(j);
        take(instead, one, with);
      }
    }
    // Turned: all of them.
    for (std::size_t j = 0; j < count(); ++j) {
      // An effort's sign is told against target less position: a position that is turned leaves it as it is.
      bool turned = out_.target.factor[j] < 0.0 || out_.velocity.factor[j] < 0.0;
      if (raw_.velocity.rows() > 0) turned = turned && out_.velocity.factor[j] < 0.0;
      if (raw_.target.rows() > 0) turned = turned && out_.target.factor[j] < 0.0;
      if (raw_.effort.rows() > 0) turned = turned && out_.effort.factor[j] < 0.0;
      if (!turned || out_.position.factor[j] < 0.0) continue;
      changed = true;
      instead.position.factor[j] *= -1.0;
      if (raw_.velocity.rows() > 0) instead.velocity.factor[j] *= -1.0;
      if (raw_.target.rows() > 0) instead.target.factor[j] *= -1.0;
      if (raw_.effort.rows() > 0) instead.effort.factor[j] *= -1.0;
    }
    if (!changed) return;
    if (all.size() == 1 && !is_better(instead)) return;
    out_ = instead;
    rows_ = put_right(raw_, out_);
    ask_body();
  }

  // Whether another wiring keeps the joints in their range, and accounts for the efforts, better than the present one.
  bool is_better(const Wiring& other) const {
    const WiringRows then = put_right(raw_, other);
    double now_out = 0.0, then_out = 0.0;
    for (std::size_t j = 0; j < count(); ++j) {
      now_out += outside(j, rows_.position.col(index(j)));
      then_out += outside(j, then.position.col(index(j)));
    }
    if (std::fabs(now_out - then_out) > 0.2) return then_out < now_out;
    for (std::size_t j = 0; j < count(); ++j)
      if (!rows_.position.col(index(j)).allFinite()) return false;
    return gain_of(accounts(fewer(rows_)), accounts(fewer(then))) > options_.fault_nats;
  }

  // ---- gains, and the unit of the effort

  void check_gains() {
    std::vector<double> ratio(count(), 0.0);  // gain by the log per gain as stated, own joint
    std::vector<double> gain(count(), 0.0);
    const bool measured = rows_.effort.rows() > 0;
    if (rows_.target.rows() == 0 || (measured && !is_controlled_)) return;
    std::vector<std::size_t> known;
    std::vector<double> ratios;
    for (std::size_t j = 0; j < count(); ++j) {
      if (!has(rows_.target, j) || rows_.moves[j] == 0 || !(joint(j).kp > 0.0)) continue;
      if (measured && !has(rows_.effort, j)) continue;
      const Misfit fit = measured ? controlled(j, rows_.effort.col(index(j))) : needed(j);
      if (fit.left > (measured ? controlled_share : moved_share) || !(fit.coefficient[0] > 0.0)) continue;
      gain[j] = fit.coefficient[0];
      ratio[j] = gain[j] / joint(j).kp;
      known.push_back(j);
      ratios.push_back(ratio[j]);
    }
    if (known.size() < 2) return;
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2),
                     ratios.end());
    const double common = ratios[ratios.size() / 2];
    double unit = 1.0;
    for (const double one : {plant::deg_per_rad, 1.0 / plant::deg_per_rad, 1000.0, 100.0})
      if (measured && std::fabs(std::log(common / one)) < std::log(close_factor)) unit = one;
    if (unit == plant::deg_per_rad || unit == 1.0 / plant::deg_per_rad) out_.gain_factor = 1.0 / unit;
    if (unit == 1000.0 || unit == 100.0)
      for (double& one : out_.effort.factor) one *= unit;
    const double whole = measured ? unit : 1.0;
    MatrixXd cost = MatrixXd::Zero(index(count()), index(count()));
    cost.setConstant(1e6);
    for (std::size_t j = 0; j < count(); ++j) cost(index(j), index(j)) = 0.0;
    const auto away = [&](std::size_t i, std::size_t k) {
      return std::fabs(std::log(gain[i] / (joint(k).kp * whole)));
    };
    for (const std::size_t i : known)
      for (const std::size_t k : known) cost(index(i), index(k)) = away(i, k) + (i == k ? 0.0 : 0.05);
    std::vector<int> source = cheapest_assignment(cost);
    const double clear = std::log(measured ? clear_factor : unclear_factor);
    keep_clear_cycles(source, [&](int i, int k) {
      const bool is_clear = gain[at(i)] > 0.0 && gain[at(k)] > 0.0 && away(at(i), at(i)) > clear &&
                            away(at(i), at(k)) < closer_share * away(at(i), at(i));
      return std::make_pair(is_clear ? 1e3 : 0.0, is_clear);
    });
    out_.gains = source;
    rows_ = put_right(raw_, out_);
  }

  // The gain without a measured effort: what moves the rigid body and overcomes friction is K (target - position).
  Misfit needed(std::size_t j) const {
    const VectorXd w = rows_.slope.col(index(j));
    MatrixXd x(w.size(), 4);
    x.col(0) = rows_.target.col(index(j)) - rows_.position.col(index(j));
    x.col(1) = -w;
    x.col(2) = -rows_.acceleration.col(index(j));
    x.col(3) = -(w.array() / (0.05 * spread(w) + 1e-9)).tanh();
    return fit_columns(rigid_.col(index(j)), x, 0);
  }

  // ---- joints whose columns are all exchanged, or all turned

  VectorXd effort_of(const WiringRows& rows, std::size_t j, const Joint& gains) const {
    if (rows.effort.rows() > 0) return rows.effort.col(index(j));
    const double kd = std::isfinite(gains.kd) ? gains.kd : 0.0;
    return gains.kp * (rows.target.col(index(j)) - rows.position.col(index(j))) -
           kd * rows.slope.col(index(j));
  }

  bool has_effort(const WiringRows& rows, std::size_t j) const {
    if (rows.moves[j] == 0) return false;
    if (rows.effort.rows() > 0) return rows.effort.col(index(j)).allFinite();
    return rows.target.rows() > 0 && rows.target.col(index(j)).allFinite() && std::isfinite(joint(j).kp);
  }

  /// How well the rigid body and friction account for the efforts, for each joint as left share.
  std::vector<double> accounts(const WiringRows& rows) const {
    Motion motion = rows.base;
    motion.position = rows.position;
    motion.velocity = rows.slope;
    motion.acceleration = rows.acceleration;
    const MatrixXd rigid = body_.ask(motion).torque;
    std::vector<double> out(count(), -1.0);
    for (std::size_t j = 0; j < count(); ++j) {
      if (!has_effort(rows, j)) continue;
      const VectorXd effort = effort_of(rows, j, joint(at(out_.gains[j])));
      const VectorXd w = rows.slope.col(index(j));
      MatrixXd x(effort.size(), 3);
      x.col(0) = rows.acceleration.col(index(j));
      x.col(1) = w;
      x.col(2) = (w.array() / (0.05 * spread(w) + 1e-9)).tanh();
      const Misfit fit = fit_columns(effort - rigid.col(index(j)), x, 0);
      const double all = spread(effort);
      const double constant = std::min(std::fabs(fit.constant), 3.0 * all);
      const double left = fit.left * spread(effort - rigid.col(index(j)));
      out[j] = all > 0.0 ? std::sqrt(left * left + 0.1 * constant * constant) / all : 1.0;
    }
    return out;
  }

  double gain_of(const std::vector<double>& before, const std::vector<double>& after) const {
    double sum = 0.0;
    for (std::size_t j = 0; j < count(); ++j)
      if (before[j] >= 0.0 && after[j] >= 0.0)
        sum += std::clamp(nats(j, before[j]) - nats(j, after[j]), -100.0, 100.0);
    return sum;
  }

  WiringRows fewer(const WiringRows& all) const {
    const Index stride = std::max<Index>(1, all.position.rows() / few_rows),
                rows = all.position.rows() / stride;
    WiringRows out = all;
    const auto thin = [&](const MatrixXd& from, MatrixXd& to) {
      if (from.rows() == 0) return;
      to.resize(rows, from.cols());
      for (Index i = 0; i < rows; ++i) to.row(i) = from.row(i * stride);
    };
    thin(all.position, out.position);
    thin(all.slope, out.slope);
    thin(all.acceleration, out.acceleration);
    thin(all.velocity, out.velocity);
    thin(all.effort, out.effort);
    thin(all.target, out.target);
    thin(all.base.base_pose, out.base.base_pose);
    thin(all.base.base_velocity, out.base.base_velocity);
    thin(all.base.base_acceleration, out.base.base_acceleration);
    return out;
  }

  void check_whole_joints() {
    for (std::size_t j = 0; j < count(); ++j)
      if (!rows_.position.col(index(j)).allFinite()) return;
    const WiringRows few = fewer(rows_);
    std::vector<double> now = accounts(few);
    std::vector<std::size_t> suspects;
    for (std::size_t j = 0; j < count(); ++j)
      if (now[j] > moved_share) suspects.push_back(j);
    // Where most joints are not accounted for, the body is not what moves: it may stand on the ground.
    if (suspects.empty() || 2 * suspects.size() > count()) return;
    const auto swap_all = [&](WiringRows& rows, std::size_t a, std::size_t b) {
      for (MatrixXd* one : {&rows.position, &rows.slope, &rows.acceleration, &rows.effort, &rows.target})
        if (one->rows() > 0) one->col(index(a)).swap(one->col(index(b)));
    };
    const auto turn_all = [&](WiringRows& rows, std::size_t a) {
      for (MatrixXd* one : {&rows.position, &rows.slope, &rows.acceleration, &rows.effort, &rows.target})
        if (one->rows() > 0) one->col(index(a)) *= -1.0;
    };
    for (int pass = 0; pass < 4; ++pass) {
      double best = options_.least_nats + options_.fault_nats;
      std::pair<std::size_t, std::size_t> chosen{0, 0};
      bool any = false;
      std::vector<double> then;
      const auto consider = [&](std::size_t a, std::size_t b) {
        WiringRows rows = few;
        if (a == b) turn_all(rows, a);
        else swap_all(rows, a, b);
        const std::vector<double> after = accounts(rows);
        const double won = gain_of(now, after) - (a == b ? 0.0 : options_.least_nats);
        const bool is_clear = after[a] < options_.most_left * now[a] && after[a] < moved_share &&
                              (a == b || after[b] < std::max(moved_share, options_.most_left * now[b]));
        if (won > best && is_clear) best = won, chosen = {a, b}, then = after, any = true;
      };
      for (const std::size_t a : suspects) {
        if (now[a] < moved_share) continue;
        consider(a, a);
        for (std::size_t b = 0; b < count(); ++b)
          if (b != a && now[b] >= 0.0 && (now[b] > 0.5 * moved_share)) consider(a, b);
      }
      if (!any) return;
      const auto [a, b] = chosen;
      for (Wires* one : {&out_.position, &out_.velocity, &out_.effort, &out_.target}) {
        if (a == b) {
          one->factor[a] *= -1.0;
          one->offset[a] *= -1.0;
        } else {
          std::swap(one->source[a], one->source[b]);
          std::swap(one->factor[a], one->factor[b]);
          std::swap(one->offset[a], one->offset[b]);
        }
      }
      rows_ = put_right(raw_, out_);
      ask_body();
      now = accounts(fewer(rows_));
      return;
    }
  }

  // ---- zeros

  // Largest effort in N m with which a joint may carry the whole robot; 0 where the base is fixed.
  double standing(std::size_t j) const {
    if (lift_.rows() == 0) return 0.0;
    return lift_.col(index(j)).cwiseAbs().maxCoeff() * robot_.mass_kg * 9.81;
  }

  void check_offsets() {
    if (rows_.target.rows() == 0) return;
    if (robot_.floating_base) {
      Motion motion = rows_.base;
      motion.position = rows_.position;
      if (motion.position.allFinite()) lift_ = body_.upward_force(motion).effort;
    }
    for (std::size_t j = 0; j < count(); ++j) {
      if (!has(rows_.target, j) || rows_.moves[j] == 0) continue;
      double offset = 0.0;
      if (rows_.effort.rows() > 0) {
        if (!is_controlled_ || !has(rows_.effort, j)) continue;
        const Misfit fit = controlled(j, rows_.effort.col(index(j)));
        if (fit.left > controlled_share || !(fit.coefficient[0] > 0.0)) continue;
        // Effort 0 belongs to target = position.
        offset = -fit.constant / fit.coefficient[0];
        if (std::fabs(offset) < options_.offset_rad) continue;
      } else {
        const double kp = joint(at(out_.gains[j])).kp * 1.0;
        const VectorXd error = rows_.target.col(index(j)) - rows_.position.col(index(j));
        if (std::isfinite(kp) && kp > 0.0) {
          const VectorXd rest = error - rigid_.col(index(j)) / kp;
          offset = rest.mean();
          const double usual =
              (rigid_.col(index(j)).cwiseAbs().maxCoeff() + joint(j).friction + standing(j)) / kp;
          if (std::fabs(offset) < std::max(options_.offset_rad, 2.0 * usual)) continue;
          // What the joint's friction and a load can hold, moves with the joint: the rest is steady.
          if (spread(rest) > std::fabs(offset)) continue;
        } else {
          offset = error.mean();
          if (std::fabs(offset) < 3.0 * options_.offset_rad || spread(error) > 0.3 * std::fabs(offset))
            continue;
        }
      }
      out_.target.offset[j] += offset;
    }
    rows_ = put_right(raw_, out_);
  }

  // ---- delay of the whole bus: the measured effort follows the target by so much

  VectorXd late_target(std::size_t j, double late_s) const {
    const VectorXd target = rows_.target.col(index(j));
    if (late_s == 0.0) return target;
    VectorXd out(target.size());
    const double shift = late_s / rows_.step_s;
    std::size_t stretch = 0;
    for (Index row = 0; row < target.size(); ++row) {
      while (stretch + 1 < rows_.begins.size() && at(row) >= rows_.begins[stretch + 1]) ++stretch;
      const double from =
          std::max(static_cast<double>(rows_.begins[stretch]), static_cast<double>(row) - shift);
      const auto below = static_cast<Index>(std::floor(from));
      const double share = from - static_cast<double>(below);
      out[row] = target[below] + (share > 0.0 ? share * (target[below + 1] - target[below]) : 0.0);
    }
    return out;
  }

  // The delay with which the controllers account for the efforts best, in all joints together.
  void delay_targets() {
    late_s_ = 0.0;
    if (rows_.target.rows() == 0 || rows_.effort.rows() == 0 || !(rows_.step_s > 0.0)) return;
    const double half = 0.5 * rows_.step_s;
    double least = 0.0;
    std::vector<double> sums;
    std::size_t best = 0;
    for (std::size_t i = 0; static_cast<double>(i) * half <= options_.latest_s; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < count(); ++j) {
        if (!has(rows_.target, j) || !has(rows_.effort, j) || rows_.moves[j] == 0) continue;
        late_s_ = static_cast<double>(i) * half;
        sum += nats(j, controlled(j, rows_.effort.col(index(j))).left);
      }
      sums.push_back(sum);
      if (i == 0 || sum < least - options_.least_nats) least = sum, best = i;
      if (i > best + 12) break;
    }
    late_s_ = static_cast<double>(best) * half;
    if (best == 0 || best + 1 >= sums.size()) return;
    // The middle of the parabola through the best and its neighbours.
    const double a = sums[best - 1], b = sums[best], c = sums[best + 1];
    if (a > b && c > b) late_s_ += 0.5 * half * (a - c) / (a - 2.0 * b + c);
  }

  void check_delay() {
    if (!is_controlled_) return;
    delay_targets();
    out_.target_delay_s = late_s_;
    if (late_s_ < least_delay_s) return;
    WiringFinding late;
    late.fault = WiringFault::delay;
    late.quantity = Role::target;
    late.number = late_s_;
    char text[160];
    std::snprintf(text, sizeof text, "the efforts follow the targets %.3g ms late, in all joints",
                  1e3 * late_s_);
    late.text = text;
    delays_.push_back(late);
  }

  // ---- words

  void describe() {
    for (std::size_t j = 0; j < count(); ++j)
      if (outside(j, rows_.position.col(index(j))) > 0.2) lost_.push_back(j);
    if (raw_.velocity.rows() == 0) out_.velocity = {};
    if (raw_.target.rows() == 0) out_.target = {};
    if (raw_.effort.rows() == 0) out_.effort = {};
    out_.findings = wiring_words(robot_, out_, lost_);
    out_.findings.insert(out_.findings.end(), delays_.begin(), delays_.end());
  }

  const Body& body_;
  const Robot& robot_;
  const WiringOptions& options_;
  Wiring out_;
  WiringRows raw_, rows_;
  MatrixXd rigid_;
  MatrixXd lift_;  // effort per N under the end of the joint's limb
  bool is_controlled_ = false;
  double late_s_ = 0.0;  // of the targets against the efforts
  std::vector<std::size_t> lost_;
  std::vector<WiringFinding> delays_;
};

}  // namespace
Wiring check_wiring(const Body& body, const Robot& robot, const Log& log, const WiringOptions& options) {
  return Checker(body, robot, options).run(log);
}

void mend(const Wiring& wiring, Log& log) {
  const auto put = [](const Wires& wires, Eigen::MatrixXd& quantity) {
    if (quantity.rows() == 0 || wires.source.empty()) return;
    const MatrixXd from = quantity;
    for (Index j = 0; j < from.cols(); ++j)
      quantity.col(j) = from.col(wires.source[at(j)]).array() / wires.factor[at(j)] - wires.offset[at(j)];
  };
  put(wiring.position, log.position);
  put(wiring.velocity, log.velocity);
  put(wiring.effort, log.effort);
  put(wiring.target, log.target);
}

void mend(const Wiring& wiring, Robot& robot) {
  const Robot from = robot;
  for (std::size_t j = 0; j < wiring.gains.size(); ++j) {
    const Joint& own = from.joints[at(wiring.gains[j])];
    robot.joints[j].kp = own.kp / wiring.gain_factor;
    robot.joints[j].kd = own.kd / wiring.gain_factor;
  }
}

}  // namespace thermopower::robot
