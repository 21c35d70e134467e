// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/robot/diagnose.hpp>

#include <thermopower/robot/forward_fit.hpp>
#include <thermopower/robot/groups.hpp>

#include "replay.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace thermopower::robot {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double explained_share = 0.25;     // of the gap left: little
constexpr double small_share = 0.05;         // of the effort: nobody asks for more
constexpr double large_share = 0.15;         // of the effort: a gap that somebody would ask about
constexpr double least_moving_share = 0.02;  // of the rows in which a joint must move
constexpr int folds = 5;                     // of each stretch, for the tracking error
constexpr double relevant_share =
    0.03;  // of the effort that causes must account for; less is nobody's question
// Joints that are built alike have the same answer, unless the error of one of them falls by so much with a cause of its own.
// A logarithm.
constexpr double own_gain = 0.25;
constexpr double earlier_wins = 0.03;      // share of the effort that a longer delay must win
constexpr double controlled_share = 0.35;  // of a measured effort that a position controller may leave
// Share of a measured effort that a position controller may leave where its own words tell the instant of the state in it.
constexpr double commanded_share = 0.1;
constexpr double near_gain = 0.2;  // share of the model's gain within which a regression's is taken for it
constexpr double between_rows = 0.25;  // rows by which a state is not that of a row

Log part_of(const Log& log, bool last, double share) {
  Log out;
  out.file = log.file;
  std::vector<Eigen::Index> rows;
  for (std::size_t run = 0; run < log.begin.size(); ++run) {
    const Eigen::Index begin = log.begin[run], end = log.end(run);
    const Eigen::Index cut =
        begin + static_cast<Eigen::Index>((1.0 - share) * static_cast<double>(end - begin));
    const Eigen::Index from = last ? cut : begin, to = last ? end : cut;
    if (from >= to) continue;
    out.begin.push_back(static_cast<Eigen::Index>(rows.size()));
    for (Eigen::Index row = from; row < to; ++row) rows.push_back(row);
  }
  const auto take = [&](const auto& from, auto& to) {
    if (from.rows() > 0) to = from(rows, Eigen::all);
  };
  out.t_s = log.t_s(rows);
  take(log.position, out.position);
  take(log.velocity, out.velocity);
  take(log.effort, out.effort);
  take(log.target, out.target);
  take(log.base_pose, out.base_pose);
  return out;
}

/// A log on an even clock, and what the body asks for in it.
struct Prepared {
  Series series;
  BodyRows body;
};

class Diagnoser {
public:
  Diagnoser(const Body& body, const Robot& robot, const Options& options) : body_(body), options_(options) {
    out_.robot = robot;
  }

  RobotDiagnosis run(const Log& recorded, const std::vector<Log>& held_out) {
    Log log = recorded;
    const Wiring wiring = check_wiring(body_, out_.robot, log, options_.wiring);
    out_.wiring = wiring.findings;
    target_delay_s_ = wiring.target_delay_s;
    if (!options_.as_recorded) {
      mend(wiring, log);
      mend(wiring, out_.robot);
    }
    out_.log = log.file;
    out_.notes = log.notes;
    Log train = log, judged;
    if (held_out.empty()) {
      train = part_of(log, false, options_.held_out_share);
      judged = part_of(log, true, options_.held_out_share);
    } else {
      judged = together(held_out);
      if (!options_.as_recorded) mend(wiring, judged);
    }
    refuse(log);
    train_ = prepare(train);
    held_ = prepare(judged);
    out_.rows = train_.series.rows();
    out_.held_out_rows = held_.series.rows();
    out_.step_s = train_.series.step_s;
    out_.cutoff_Hz = train_.series.cutoff_Hz;
    refuse_still_joints();
    find_ground();
    find_timing();
    fit_joints();
    choose_causes();
    fit_chosen();
    judge();
    conclude();
    return std::move(out_);
  }

private:
  std::size_t count() const { return out_.robot.joints.size(); }
  const Joint& joint(std::size_t j) const { return out_.robot.joints[j]; }
  bool judged(std::size_t j) const { return out_.joints[j].verdict != JointVerdict::not_judged; }
  static Eigen::Index index(std::size_t j) { return static_cast<Eigen::Index>(j); }

  void refuse(std::size_t j, const std::string& reason) {
    out_.joints[j].verdict = JointVerdict::not_judged;
    if (out_.joints[j].reason.empty()) out_.joints[j].reason = reason;
  }

  // Joints whose position or effort nobody logged.
  void refuse(const Log& log) {
    out_.joints.resize(count());
    out_.effort_is_measured = log.effort.rows() > 0;
    std::string without_gains;
    for (std::size_t j = 0; j < count(); ++j) {
      JointDiagnosis& one = out_.joints[j];
      one.name = joint(j).name;
      one.configured = one.recalibrated = one.found = configured(joint(j));
      if (!Log::has(log.position, index(j))) {
        refuse(j, "its position is not in the log");
        continue;
      }
      if (Log::has(log.effort, index(j))) continue;
      if (!Log::has(log.target, index(j))) {
        refuse(j, "the log has neither its effort nor its target");
      } else if (!std::isfinite(joint(j).kp)) {
        refuse(
            j,
            "the log has its target and no effort, and the model has no gain: --kp and --kd give the gains");
      }
    }
    for (const JointGroup& group : groups_of(out_.robot)) {
      out_.groups.push_back({group.name, group.members, {}, {}, {}});
      for (const int member : group.members)
        out_.joints[static_cast<std::size_t>(member)].group = static_cast<int>(out_.groups.size()) - 1;
    }
  }

  Prepared prepare(Log log) const {
    // A joint that nobody logged stands in the middle of its travel.
    for (std::size_t j = 0; j < count(); ++j) {
      if (Log::has(log.position, index(j))) continue;
      const bool limited = std::isfinite(joint(j).lower) && std::isfinite(joint(j).upper);
      log.position.col(index(j)).setConstant(limited ? 0.5 * (joint(j).lower + joint(j).upper) : 0.0);
      if (log.velocity.rows() > 0) log.velocity.col(index(j)).setZero();
    }
    Prepared out;
    out.series = make_series(log, options_.smoothing);
    if (out.series.rows() > 0) out.body = body_.ask(out.series.motion);
    return out;
  }

  void refuse_still_joints() {
    for (std::size_t j = 0; j < count(); ++j) {
      if (!judged(j)) continue;
      if (train_.series.rows() == 0) {
        refuse(j, "the log is too short");
        continue;
      }
      const Eigen::VectorXd w = train_.series.motion.velocity.col(index(j));
      const double noise = 3.0 * train_.series.rate_noise[index(j)] + 1e-4;
      const double moving =
          static_cast<double>((w.array().abs() > noise).count()) / static_cast<double>(w.size());
      if (moving < least_moving_share) refuse(j, "it hardly moves");
    }
  }

  // The weight of a robot that stands goes through its legs. A force straight up at the ends of the limbs is fitted to what the
  // efforts of each limb lack; in the air it is near zero.
  void find_ground() {
    if (!out_.robot.floating_base || options_.in_the_air || train_.series.rows() == 0) return;
    const LimbForces forces = body_.upward_force(train_.series.motion);
    if (forces.effort.rows() == 0) return;
    const int limbs = 1 + *std::max_element(forces.limb_of_joint.begin(), forces.limb_of_joint.end());
    double carried = 0.0;
    std::vector<double> force(static_cast<std::size_t>(std::max(0, limbs)), 0.0);
    for (int limb = 0; limb < limbs; ++limb) {
      double product = 0.0, square = 0.0;
      for (std::size_t j = 0; j < count(); ++j) {
        if (forces.limb_of_joint[j] != limb || !judged(j)) continue;
        const Eigen::VectorXd effort = effort_of(train_.series, index(j), joint(j), {});
        const Eigen::VectorXd lacks = effort - train_.body.torque.col(index(j));
        product += lacks.dot(forces.effort.col(index(j)));
        square += forces.effort.col(index(j)).squaredNorm();
      }
      if (square > 0.0) force[static_cast<std::size_t>(limb)] = product / square;
      carried += force[static_cast<std::size_t>(limb)];
    }
    constexpr double g = 9.81;
    if (carried < options_.ground_share * out_.robot.mass_kg * g) return;
    out_.stands_on_ground = true;
    for (std::size_t j = 0; j < count(); ++j) {
      const int limb = forces.limb_of_joint[j];
      if (limb < 0 || force[static_cast<std::size_t>(limb)] < 0.05 * out_.robot.mass_kg * g) continue;
      if (forces.effort.col(index(j)).squaredNorm() > 0.0)
        refuse(
            j,
            "its limb stands on the ground, and nobody logged the force there: log in the air or on a stand");
    }
    char text[160];
    std::snprintf(text, sizeof text, "the limbs carry %.0f N of the robot's %.0f N: it stands on the ground",
                  carried, out_.robot.mass_kg * g);
    out_.notes.push_back(text);
  }

  // When the effort acts, one answer for all joints.
  void find_timing() {
    if (out_.effort_is_measured) {
      find_gains();
      find_jump();
    } else {
      timing_.late_s = delay_with(timing_, 0.0);
    }
    out_.delay_s = timing_.late_s;
  }

  // How the measured effort follows the logged target: what a position controller commands, so many rows later.
  void find_gains() {
    const Eigen::Index rows = train_.series.rows();
    double least = std::numeric_limits<double>::infinity();
    for (int late = 0; late <= static_cast<int>(options_.latest_rows); ++late) {
      std::vector<double> gain(count(), 0.0), ripple(count(), 0.0);
      double sum = 0.0;
      for (std::size_t j = 0; j < count(); ++j) {
        const Eigen::VectorXd target = train_.series.smooth_target.col(index(j));
        if (!judged(j) || !is_effort_measured(train_.series, index(j)) || !target.allFinite()) continue;
        Eigen::MatrixXd columns(rows, 4);
        columns.col(0) = earlier(train_.series, target, late);
        columns.col(1) = train_.series.motion.position.col(index(j));
        columns.col(2) = train_.series.motion.velocity.col(index(j));
        columns.col(3).setOnes();
        const Eigen::VectorXd effort = train_.series.effort.col(index(j));
        const Eigen::VectorXd value = columns.householderQr().solve(effort);
        const double left =
            (effort - columns * value).norm() / (effort.array() - effort.mean()).matrix().norm();
        sum += std::log(std::min(1.0, left) + 1e-6);
        if (!(left < controlled_share && value[0] > 0.0)) continue;
        // Noise of the position makes the regression's gain too large in a light joint.
        const double kp = joint(j).kp;
        gain[j] = std::fabs(value[0] - kp) < near_gain * kp ? kp : value[0];
        const double inertia = train_.body.inertia.col(index(j)).mean() + joint(j).armature;
        if (value[2] < 0.0 && inertia > 0.0)
          ripple[j] = ripple_share(-value[2] * train_.series.step_s / inertia);
      }
      if (sum < least) {
        least = sum;
        timing_.target_rows = late;
        timing_.gain = gain;
        timing_.ripple = ripple;
      }
    }
  }

  /// Time in s by which the state in the logged effort is older than the logged state; 0 where no joint tells.
  ///
  /// A position controller commands kp (target - q) - kd w. With a state that is s older this is, to first order in s,
  /// kp target - kp q - (kd - kp s) w + kd s a. The regression on the acceleration a tells s. Friction and weight are not in the
  /// command, so the joint's own equation of motion does not pass for it.
  double age_of_state() const {
    std::vector<double> ages;
    for (std::size_t j = 0; j < count(); ++j) {
      if (timing_.gain.empty() || timing_.gain[j] == 0.0) continue;
      const Eigen::VectorXd effort = train_.series.effort.col(index(j));
      Eigen::MatrixXd columns(train_.series.rows(), 5);
      columns.col(0) = earlier(train_.series, train_.series.smooth_target.col(index(j)), timing_.target_rows);
      columns.col(1) = train_.series.motion.position.col(index(j));
      columns.col(2) = train_.series.motion.velocity.col(index(j));
      columns.col(3) = train_.series.motion.acceleration.col(index(j));
      columns.col(4).setOnes();
      const Eigen::VectorXd value = columns.householderQr().solve(effort);
      const double left =
          (effort - columns * value).norm() / (effort.array() - effort.mean()).matrix().norm();
      const double kp = -value[1], root = value[2] * value[2] + 4.0 * kp * value[3];
      if (left > commanded_share || !(kp > 0.0) || !(root > 0.0)) continue;
      ages.push_back((value[2] + std::sqrt(root)) / (2.0 * kp));
    }
    if (ages.empty()) return 0.0;
    const auto middle = ages.begin() + static_cast<std::ptrdiff_t>(ages.size() / 2);
    std::nth_element(ages.begin(), middle, ages.end());
    return std::clamp(*middle, -train_.series.step_s, options_.latest_rows * train_.series.step_s);
  }

  /// What is left of a joint's effort in units of what noise leaves, as a logarithm.
  ///
  /// The acceleration is noisy, too: a delay that looks like less inertia would win without need.
  double beyond_noise(std::size_t j, const JointProblem& problem, const JointFitter::Left& left) const {
    const Series& series = train_.series;
    const double noise = series.effort_noise.size() > 0 ? series.effort_noise[index(j)] : 0.0;
    const double wobble = (problem.inertia() + left.armature) * series.acceleration_noise[index(j)];
    return 0.5 * std::log((left.effort * left.effort + 1e-24) / (noise * noise + wobble * wobble + 1e-24)) +
           options_.fit.price * left.numbers;
  }

  /// Mean over the joints. Without `families` each joint has the causes that it asks for: what the timing accounts for is not taken
  /// for a cause.
  double beyond_noise(const EffortTiming& timing, const std::vector<Family>* families) const {
    double sum = 0.0, used = 0.0;
    for (std::size_t j = 0; j < count(); ++j) {
      if (!judged(j)) continue;
      JointProblem problem(train_.series, train_.body, index(j), joint(j), timing, options_.fit.blocks, true);
      if (problem.moving_rows() < 20 * options_.fit.blocks) continue;
      JointFitter fitter(problem, options_.fit);
      if (families == nullptr) fitter.fit();
      sum += beyond_noise(j, problem, families == nullptr ? fitter.left_now() : fitter.left_with(*families));
      used += 1.0;
    }
    return used > 0.0 ? sum / used : 0.0;
  }

  // Whether the log holds the effort just after the controllers took over a target, just before, or neither; and how late.
  void find_jump() {
    const double age_s = age_of_state();
    std::vector<double> kinds{0.0};
    const bool is_of_its_row = std::fabs(age_s) < between_rows * train_.series.step_s;
    // An effort whose state lies between the rows is a mean, and has no jump.
    if (is_of_its_row &&
        std::any_of(timing_.gain.begin(), timing_.gain.end(), [](double one) { return one > 0.0; }))
      kinds = {0.0, 1.0, -1.0};
    double least = std::numeric_limits<double>::infinity();
    EffortTiming best = timing_;
    const auto judge = [&](EffortTiming trial, double late_s, double price) {
      trial.late_s = late_s;
      const double left = beyond_noise(trial, nullptr) + price;
      if (left < least) least = left, best = trial;
    };
    for (const double after : kinds) {
      EffortTiming trial = timing_;
      trial.after_jump = after;
      // An effort that was averaged before it was logged acts before its row.
      const double late_s = delay_with(trial, -1.0);
      judge(trial, late_s, price_of(late_s));
      // What the controllers themselves say costs nothing.
      if (!is_of_its_row) judge(trial, -age_s, 0.0);
    }
    timing_ = best;
    // A target that is held to the next row is half a row old on average. An effort just before its jump is older by a row than one
    // just after it, and neither is a delay.
    target_delay_s_ =
        std::max(0.0, target_delay_s_ - 0.5 * (1.0 - timing_.after_jump) * train_.series.step_s);
  }

  // What a delay must win, as a logarithm: there is often none, and a long one is rare.
  double price_of(double late_s) const {
    return late_s == 0.0 ? 0.0 : earlier_wins * std::max(2.0, std::fabs(late_s) / train_.series.step_s);
  }

  // One delay for all joints, in s: the shortest that leaves nearly the least effort.
  double delay_with(EffortTiming timing, double earliest_rows) const {
    const std::vector<Family> usual{Family::armature, Family::damping,           Family::friction,
                                    Family::constant, Family::position_friction, Family::spring};
    const auto left_with = [&](double late_s) {
      timing.late_s = late_s;
      if (out_.effort_is_measured) return beyond_noise(timing, &usual);
      double sum = 0.0, used = 0.0;
      for (std::size_t j = 0; j < count(); ++j) {
        if (!judged(j)) continue;
        JointProblem problem(train_.series, train_.body, index(j), joint(j), timing, options_.fit.blocks);
        if (problem.moving_rows() < 20 * options_.fit.blocks) continue;
        JointFitter fitter(problem, options_.fit);
        sum += std::log(fitter.held_out(usual) + 1e-12);
        used += 1.0;
      }
      return used > 0.0 ? sum / used : 0.0;
    };
    double least = left_with(0.0), best = 0.0;
    for (double rows = earliest_rows; rows <= options_.latest_rows + 1e-9; rows += 0.5) {
      if (rows == 0.0) continue;
      const double late_s = rows * train_.series.step_s;
      const double left = left_with(late_s) + price_of(late_s);
      if (left < least) least = left, best = late_s;
    }
    return best;
  }

  void fit_joints() {
    fits_.resize(count());
    effort_rms_.assign(count(), 0.0);
    for (std::size_t j = 0; j < count(); ++j) {
      if (!judged(j)) continue;
      JointProblem problem(train_.series, train_.body, index(j), joint(j), timing_, options_.fit.blocks);
      if (problem.moving_rows() < 20 * options_.fit.blocks) {
        refuse(j, "it moves in too few rows");
        continue;
      }
      fits_[j] = JointFitter(problem, options_.fit).fit();
      effort_rms_[j] = fits_[j].effort_rms;
    }
  }

  bool can_simulate(std::size_t j) const {
    return judged(j) && train_.series.target.col(index(j)).allFinite() && std::isfinite(joint(j).kp);
  }

  // Where the effort was measured it leads; where it follows from the targets, the tracking error says the same and more.
  bool leads_tracking(std::size_t j) const { return !out_.effort_is_measured && can_simulate(j); }

  using Families = std::set<Family>;

  static std::vector<Family> list(const Families& set) { return {set.begin(), set.end()}; }

  /// Errors on parts of the log that took no part in the fit, as logarithms: of the tracking, or of the effort. Empty: it cannot be.
  const std::vector<double>& errors(std::size_t j, const Families& families) {
    const auto [at, is_new] = known_.emplace(std::make_pair(j, families), std::vector<double>());
    if (!is_new) return at->second;
    JointProblem problem = problem_of(j);
    JointFitter fitter(problem, options_.fit);
    at->second = fitter.block_errors(list(families));
    if (at->second.empty() || !leads_tracking(j)) return at->second;
    at->second.clear();
    const JointDynamics start = start_of(j, problem, families);
    const ForwardFitter forward(train_.series, train_.body, index(j));
    for (int fold = 0; fold < folds; ++fold) {
      const double from = static_cast<double>(fold) / folds, to = static_cast<double>(fold + 1) / folds;
      const JointDynamics d = forward.fit(start, list(families), {{0.0, from}, {to, 1.0}});
      fold_fits_[{j, families}].push_back(d);
      at->second.push_back(std::log(forward.error(d, {{from, to}})));
    }
    return at->second;
  }

  JointProblem problem_of(std::size_t j) const {
    return {train_.series, train_.body, index(j), joint(j), timing_, options_.fit.blocks};
  }

  JointDynamics start_of(std::size_t j, JointProblem& problem, const Families& families) const {
    JointFitter fitter(problem, options_.fit);
    const JointFit inverse = fitter.exactly(list(families));
    JointDynamics d = with_terms(joint(j), problem, inverse);
    d.delay_s = out_.effort_is_measured ? target_delay_s_ : out_.delay_s;
    return d;
  }

  /// Gain of one set of causes over another in a joint: mean logarithm over the parts, and its standard error.
  struct Gain {
    double mean = -1.0, error = 0.0;
  };
  Gain gain(std::size_t j, const Families& without, const Families& with) {
    const std::vector<double> before = errors(j, without), after = errors(j, with);
    if (before.empty() || before.size() != after.size()) return {};
    if (!is_relevant(j, without, with)) return {0.0, 0.0};
    const double n = static_cast<double>(before.size());
    double sum = 0.0, square = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const double one = std::clamp(before[i] - after[i], -2.0, 2.0);
      sum += one;
      square += one * one;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, square / n - mean * mean) / std::max(1.0, n - 1.0))};
  }

  /// Whether a set of causes is better than another one for these joints: more than half of them gain, and so do all together.
  bool is_better(const std::vector<std::size_t>& members, const Families& without, const Families& with,
                 double* total) {
    std::size_t more = 0;
    double sum = 0.0;
    const bool single = members.size() == 1;
    for (const std::size_t j : members) {
      const Gain one = gain(j, without, with);
      const double least = single ? single_least_ : 0.5 * options_.fit.least_gain;
      const double errors_wanted = single ? options_.fit.standard_errors : 0.5 * options_.fit.standard_errors;
      if (one.mean > least && one.mean > errors_wanted * one.error) ++more;
      sum += one.mean;
    }
    *total = sum / static_cast<double>(members.size());
    return 2 * more > members.size() && *total > (single ? single_least_ : options_.fit.least_gain);
  }

  /// Adds to `begin`, one by one, the causes that these joints gain most by; then takes out again what is not missed. The four
  /// constants move together: every explanation but the empty one refits them.
  Families chosen(const std::vector<std::size_t>& members, const Families& begin,
                  const Families& candidates) {
    Families now = begin;
    double won = 0.0;
    while (now.size() < four_constants().size() + static_cast<std::size_t>(options_.fit.most_terms)) {
      double best = 0.0;
      Families next;
      std::vector<Families> steps{four_constants()};
      for (const Family one : candidates) {
        steps.push_back(four_constants());
        steps.back().insert(one);
      }
      for (Families with : steps) {
        with.insert(now.begin(), now.end());
        if (with == now || !is_better(members, now, with, &won)) continue;
        won -= options_.fit.price * static_cast<double>(with.size() - now.size());
        if (won > best) best = won, next = with;
      }
      if (next.empty()) break;
      now = next;
    }
    for (bool again = true; again;) {
      again = false;
      for (const Family one : Families(now)) {
        if (begin.count(one) != 0 || four_constants().count(one) != 0) continue;
        Families without = now;
        without.erase(one);
        if (is_better(members, without, now, &won)) continue;
        now = without;
        again = true;
        break;
      }
    }
    return now;
  }

  static const Families& four_constants() {
    static const Families four{Family::armature, Family::damping, Family::friction, Family::constant};
    return four;
  }

  /// Those of a set of causes that are told: a constant only where it is missed when it stays as configured.
  Families told_of(const std::vector<std::size_t>& members, const Families& set) {
    Families told;
    double won = 0.0, most = -1.0;
    Family first = Family::friction;
    for (const Family one : set) {
      if (four_constants().count(one) == 0) {
        told.insert(one);
        continue;
      }
      Families without = set;
      without.erase(one);
      if (is_better(members, without, set, &won)) told.insert(one);
      if (won > most) most = won, first = one;
    }
    if (told.empty() && !set.empty()) told.insert(first);
    return told;
  }

  // One answer for joints that are built alike, and what a single one of them has besides.
  void choose_causes() {
    chosen_.resize(count());
    told_.resize(count());
    for (const GroupDiagnosis& group : out_.groups) {
      std::vector<std::size_t> members;
      Families candidates;
      for (const int member : group.members) {
        const auto j = static_cast<std::size_t>(member);
        if (!judged(j)) continue;
        members.push_back(j);
        for (const Family one : candidates_of(j)) candidates.insert(one);
      }
      Families common, told;
      if (members.size() > 1) {
        common = chosen(members, {}, candidates);
        told = told_of(members, common);
      }
      single_least_ = members.size() > 1 ? own_gain : options_.fit.least_gain;
      for (const std::size_t j : members) {
        chosen_[j] = chosen({j}, common, candidates_of(j));
        told_[j] = told;
        if (chosen_[j] != common || common.empty()) {
          const Families own = told_of({j}, chosen_[j]);
          told_[j].insert(own.begin(), own.end());
        }
      }
    }
  }

  /// Whether more causes account for a material part of the joint's effort.
  bool is_relevant(std::size_t j, const Families& without, const Families& with) {
    const double part = std::pow(left(j, without), 2) - std::pow(left(j, with), 2);
    return part > std::pow(relevant_share * effort_rms_[j], 2);
  }

  /// Effort in N m that a set of causes leaves in the blocks that took no part in its fit.
  double left(std::size_t j, const Families& families) {
    const auto [at, is_new] = left_.emplace(std::make_pair(j, families), 0.0);
    if (is_new) {
      JointProblem problem = problem_of(j);
      at->second = JointFitter(problem, options_.fit).held_out(list(families));
    }
    return at->second;
  }

  Families candidates_of(std::size_t j) const {
    Families out;
    for (const Term& term : fits_[j].terms) {
      out.insert(term.family);
      out.insert(term.predicts_alike.begin(), term.predicts_alike.end());
    }
    for (const Family one : four_constants()) out.erase(one);
    return out;
  }

  void fit_chosen() {
    for (std::size_t j = 0; j < count(); ++j) {
      if (!judged(j)) continue;
      JointDiagnosis& one = out_.joints[j];
      JointProblem problem = problem_of(j);
      fits_[j] = JointFitter(problem, options_.fit).exactly(list(chosen_[j]));
      for (const Term& term : fits_[j].terms)
        if (told_[j].count(term.family) != 0) one.causes.push_back(term);
      one.found = start_of(j, problem, chosen_[j]);
      one.recalibrated = start_of(j, problem, four_constants());
      if (!leads_tracking(j)) continue;
      const ForwardFitter forward(train_.series, train_.body, index(j));
      one.found = forward.fit(one.found, list(chosen_[j]));
      one.recalibrated = five_constants(forward, one.recalibrated);
    }
  }

  // What people fit: armature, damping, friction, a constant and a delay of the joint's own.
  JointDynamics five_constants(const ForwardFitter& forward, const JointDynamics& start) const {
    JointDynamics best = forward.fit(start, list(four_constants()));
    double least = forward.error(best);
    for (int rows = 0; rows <= static_cast<int>(options_.latest_rows); ++rows) {
      JointDynamics late = start;
      late.delay_s = rows * train_.series.step_s;
      late = forward.fit(late, list(four_constants()));
      const double error = forward.error(late);
      if (error < least) least = error, best = late;
    }
    return best;
  }

  // Effort in N m, root mean square, that these constants do not account for, and that of the joint.
  double effort_left(const JointProblem& problem, const JointDynamics& d) const {
    const Joint& base = problem.joint();
    const Eigen::MatrixXd& c = problem.columns();
    const auto column = [&](Regressor which) { return c.col(static_cast<int>(which)); };
    Eigen::VectorXd needed = column(Regressor::model);
    needed += (d.armature - base.armature) * column(Regressor::acceleration);
    needed += (d.damping - base.damping) * column(Regressor::velocity);
    needed += (d.friction - base.friction) * column(Regressor::sign);
    needed += (d.stiffness - base.stiffness) * column(Regressor::position);
    needed.array() +=
        d.bias + base.stiffness * base.spring_rest + (d.stiffness - base.stiffness) * problem.middle();
    needed += d.gravity_error * column(Regressor::gravity) + d.moment_a * column(Regressor::moment_a) +
              d.moment_b * column(Regressor::moment_b) + d.load_friction * column(Regressor::load) +
              d.drag * column(Regressor::drag);
    if (d.friction_slope != 0.0)
      needed += d.friction_slope * (column(Regressor::sign_position) +
                                    (problem.middle() - d.friction_middle) * column(Regressor::sign));
    if (d.stribeck != 0.0) needed += d.stribeck * problem.stribeck_column(d.stribeck_rate);
    if (d.ripple.size() == 3)
      needed += d.ripple[1] * problem.ripple_column(d.ripple[0], false) +
                d.ripple[2] * problem.ripple_column(d.ripple[0], true);
    needed /= d.effort_scale;
    double square = 0.0, rows = 0.0;
    for (Eigen::Index row = 0; row < c.rows(); ++row) {
      if (problem.block_of()[static_cast<std::size_t>(row)] < 0) continue;
      square += std::pow(problem.effort()[row] - needed[row], 2);
      rows += 1.0;
    }
    return rows > 0.0 ? std::sqrt(square / rows) : nothing;
  }

  void judge() {
    if (held_.series.rows() == 0) {
      out_.notes.push_back("there are too few rows to judge on");
      return;
    }
    for (std::size_t j = 0; j < count(); ++j) {
      if (!judged(j)) continue;
      JointDiagnosis& one = out_.joints[j];
      const auto left = [&](const JointDynamics& d) {
        const JointProblem problem(held_.series, held_.body, index(j), joint(j),
                                   d.delay_s != 0.0 || out_.effort_is_measured ? timing_ : EffortTiming(),
                                   options_.fit.blocks);
        double square = 0.0, rows = 0.0;
        for (Eigen::Index row = 0; row < problem.effort().size(); ++row)
          if (problem.block_of()[static_cast<std::size_t>(row)] >= 0)
            square += problem.effort()[row] * problem.effort()[row], rows += 1.0;
        one.effort_rms = rows > 0.0 ? std::sqrt(square / rows) : nothing;
        return effort_left(problem, d);
      };
      one.effort = {left(one.configured), left(one.recalibrated), left(one.found)};
    }
    bool any = false;
    for (std::size_t j = 0; j < count(); ++j) any = any || can_simulate(j);
    if (!any) {
      out_.notes.push_back(
          "without targets and gains the robot is not simulated: the effort alone is judged");
      return;
    }
    std::vector<char> driven;
    for (std::size_t j = 0; j < count(); ++j) driven.push_back(can_simulate(j) ? 1 : 0);
    const Replay replay(body_, held_.series, driven);
    const auto track = [&](double Gap::*which, JointDynamics JointDiagnosis::*constants) {
      std::vector<JointDynamics> joints;
      for (const JointDiagnosis& one : out_.joints) joints.push_back(one.*constants);
      Eigen::MatrixXd simulated = replay.positions(joints);
      double sum = 0.0, rows = 0.0;
      for (std::size_t j = 0; j < count(); ++j) {
        if (!can_simulate(j)) continue;
        const double square = (simulated - held_.series.measured).col(index(j)).squaredNorm(),
                     n = static_cast<double>(simulated.rows());
        out_.joints[j].tracking.*which = std::sqrt(square / n);
        sum += square;
        rows += n;
      }
      out_.tracking.*which = std::sqrt(sum / rows);
      return simulated;
    };
    out_.position_configured = track(&Gap::before, &JointDiagnosis::configured);
    track(&Gap::recalibrated, &JointDiagnosis::recalibrated);
    out_.position_found = track(&Gap::after, &JointDiagnosis::found);
    out_.replayed = held_.series;
  }

  static double share_left(const Gap& gap) { return gap.after / gap.before; }

  void conclude() {
    for (std::size_t j = 0; j < count(); ++j) {
      if (!judged(j)) continue;
      JointDiagnosis& one = out_.joints[j];
      list_changes(one, fits_[j], joint(j));
      find_covariance(one, j);
      const Gap& gap = std::isfinite(one.tracking.after) ? one.tracking : one.effort;
      if (one.causes.empty()) {
        one.verdict = one.effort.before > large_share * one.effort_rms ? JointVerdict::unexplained
                                                                       : JointVerdict::no_gap;
      } else if (share_left(gap) < explained_share || one.effort.after < small_share * one.effort_rms) {
        one.verdict = JointVerdict::explained;
      } else {
        one.verdict = share_left(gap) < 0.95 ? JointVerdict::partial : JointVerdict::unexplained;
      }
    }
    pool();
  }

  static void list_changes(JointDiagnosis& one, const JointFit& fit, const Joint& joint) {
    const JointDynamics &a = one.configured, &b = one.found;
    const char *torque = joint.slides ? "N" : "N m", *per = joint.slides ? "m" : "rad";
    const std::string rate = std::string(joint.slides ? "N s/m" : "N m s/rad"),
                      stiff = std::string(torque) + "/" + per;
    const auto error_of = [&](const char* name) {
      for (const Term& term : fit.terms)
        for (const Coefficient& number : term.numbers)
          if (number.name == name) return number.error;
      return nothing;
    };
    const auto put = [&](const char* name, const std::string& unit, double from, double to,
                         const char* number) {
      if (from != to) one.changes.push_back({name, unit, from, to, error_of(number)});
    };
    put("armature", joint.slides ? "kg" : "kg m2", a.armature, b.armature, "armature");
    put("damping", rate, a.damping, b.damping, "damping");
    put("friction", torque, a.friction, b.friction, "friction");
    put("constant", torque, a.bias, b.bias, "constant");
    put("stiffness", stiff, a.stiffness, b.stiffness, "stiffness");
    put("gravity_error", "1", 0.0, b.gravity_error, "gravity_share");
    put("moment_a", joint.slides ? "kg" : "kg m", 0.0, b.moment_a, "moment_a");
    put("moment_b", joint.slides ? "kg" : "kg m", 0.0, b.moment_b, "moment_b");
    put("stribeck", torque, 0.0, b.stribeck, "stribeck");
    put("friction_slope", stiff, 0.0, b.friction_slope, "friction_slope");
    put("load_friction", "1", 0.0, b.load_friction, "load_share");
    put("drag", joint.slides ? "N s2/m2" : "N m s2/rad2", 0.0, b.drag, "drag");
    put("effort_scale", "1", 1.0, b.effort_scale, "effort_share");
    if (b.ripple.size() == 3) {
      put("ripple_sine", torque, 0.0, b.ripple[1], "sine");
      put("ripple_cosine", torque, 0.0, b.ripple[2], "cosine");
    }
  }

  // A number that a change's name stands for.
  static double number_of(const std::string& name, const JointDynamics& d) {
    const std::pair<const char*, double JointDynamics::*> members[] = {
        {"armature", &JointDynamics::armature},           {"damping", &JointDynamics::damping},
        {"friction", &JointDynamics::friction},           {"constant", &JointDynamics::bias},
        {"stiffness", &JointDynamics::stiffness},         {"gravity_error", &JointDynamics::gravity_error},
        {"moment_a", &JointDynamics::moment_a},           {"moment_b", &JointDynamics::moment_b},
        {"stribeck", &JointDynamics::stribeck},           {"friction_slope", &JointDynamics::friction_slope},
        {"load_friction", &JointDynamics::load_friction}, {"drag", &JointDynamics::drag},
        {"effort_scale", &JointDynamics::effort_scale}};
    for (const auto& [known, member] : members)
      if (name == known) return d.*member;
    if (d.ripple.size() != 3) return 0.0;
    return name == "ripple_sine" ? d.ripple[1] : d.ripple[2];
  }

  // The jackknife over parts of the log, where the tracking was fitted; else the standard errors of the regression alone.
  void find_covariance(JointDiagnosis& one, std::size_t j) const {
    const auto count = index(one.changes.size());
    one.covariance = Eigen::MatrixXd::Zero(count, count);
    const auto known = fold_fits_.find({j, chosen_[j]});
    if (known == fold_fits_.end() || known->second.size() < 2) {
      for (Eigen::Index i = 0; i < count; ++i)
        one.covariance(i, i) = std::pow(one.changes[static_cast<std::size_t>(i)].error, 2);
      return;
    }
    const std::vector<JointDynamics>& fits = known->second;
    const double n = static_cast<double>(fits.size());
    Eigen::MatrixXd values(index(fits.size()), count);
    for (std::size_t fold = 0; fold < fits.size(); ++fold)
      for (Eigen::Index i = 0; i < count; ++i)
        values(index(fold), i) = number_of(one.changes[static_cast<std::size_t>(i)].name, fits[fold]);
    values = (values.rowwise() - values.colwise().mean()).eval();
    one.covariance = (n - 1.0) / n * values.transpose() * values;
    for (Eigen::Index i = 0; i < count; ++i)
      one.changes[static_cast<std::size_t>(i)].error = std::sqrt(one.covariance(i, i));
  }

  static std::string set_text(const std::set<Family>& set) {
    std::string out;
    for (const Family one : set) out += (out.empty() ? "" : " + ") + std::string(to_string(one));
    return out.empty() ? "none" : out;
  }

  // Mean and spread over joints that are built alike, and which of them does not fit.
  void pool() {
    for (GroupDiagnosis& group : out_.groups) {
      std::vector<std::size_t> members;
      for (const int member : group.members)
        if (judged(static_cast<std::size_t>(member))) members.push_back(static_cast<std::size_t>(member));
      if (members.size() < 2) continue;
      const auto has = [&](std::size_t j, Family family) {
        return std::any_of(out_.joints[j].causes.begin(), out_.joints[j].causes.end(),
                           [&](const Term& term) { return term.family == family; });
      };
      std::set<Family> common;
      for (std::size_t i = 0; i < family_count; ++i) {
        std::size_t with = 0;
        for (const std::size_t j : members) with += has(j, static_cast<Family>(i)) ? 1 : 0;
        if (2 * with >= members.size() && with > 0) common.insert(static_cast<Family>(i));
      }
      group.causes.assign(common.begin(), common.end());
      for (const std::size_t j : members) {
        std::set<Family> own;
        for (const Term& term : out_.joints[j].causes) own.insert(term.family);
        std::set<Family> more, less;
        std::set_difference(own.begin(), own.end(), common.begin(), common.end(),
                            std::inserter(more, more.end()));
        std::set_difference(common.begin(), common.end(), own.begin(), own.end(),
                            std::inserter(less, less.end()));
        if (!more.empty()) out_.joints[j].difference = "has " + set_text(more) + " besides";
        if (!less.empty())
          out_.joints[j].difference +=
              (out_.joints[j].difference.empty() ? "lacks " : ", lacks ") + set_text(less);
      }
      const struct {
        const char *name, *unit;
        double JointDynamics::*member;
        double scale;
      } numbers[] = {{"armature", "kg m2", &JointDynamics::armature, 1e-3},
                     {"damping", "N m s/rad", &JointDynamics::damping, 1e-2},
                     {"friction", "N m", &JointDynamics::friction, 1e-2},
                     {"stiffness", "N m/rad", &JointDynamics::stiffness, 1e-2},
                     {"gravity_error", "1", &JointDynamics::gravity_error, 1e-2},
                     {"friction_slope", "N m/rad", &JointDynamics::friction_slope, 1e-2},
                     {"load_friction", "1", &JointDynamics::load_friction, 1e-2},
                     {"effort_scale", "1", &JointDynamics::effort_scale, 1e-2}};
      for (const auto& number : numbers) {
        double sum = 0.0, square = 0.0;
        std::vector<double> values;
        for (const std::size_t j : members) values.push_back(out_.joints[j].found.*number.member);
        const double n = static_cast<double>(values.size()),
                     from = out_.joints[members[0]].configured.*number.member;
        for (const double value : values) sum += value, square += value * value;
        if (std::all_of(values.begin(), values.end(), [&](double v) { return v == from; })) continue;
        const double mean = sum / n,
                     spread = std::sqrt(std::max(0.0, square / n - mean * mean) * n / (n - 1.0));
        group.pooled.push_back({number.name, number.unit, from, mean, spread});
        if (members.size() < 3) continue;
        std::sort(values.begin(), values.end());
        const double median = values[values.size() / 2];
        std::vector<double> away;
        for (const double value : values) away.push_back(std::fabs(value - median));
        std::sort(away.begin(), away.end());
        const double usual = std::max({1.5 * away[away.size() / 2], 0.1 * std::fabs(median), number.scale});
        for (const std::size_t j : members) {
          const double value = out_.joints[j].found.*number.member;
          if (std::fabs(value - median) < 4.0 * usual) continue;
          char text[120];
          std::snprintf(text, sizeof text, "%s %.3g where the others have about %.3g", number.name, value,
                        median);
          std::string& said = out_.joints[j].difference;
          said += (said.empty() ? "" : "; ") + std::string(text);
        }
      }
      for (const std::size_t j : members)
        if (!out_.joints[j].difference.empty()) {
          out_.joints[j].differs = true;
          group.different.push_back(static_cast<int>(j));
        }
    }
  }

  const Body& body_;
  Options options_;
  RobotDiagnosis out_;
  Prepared train_, held_;
  double single_least_ = 0.05;  // logarithm by which a cause of a single joint must lower its error
  EffortTiming timing_;
  double target_delay_s_ = 0.0;  // of the targets, told by the measured efforts
  std::vector<JointFit> fits_;
  std::vector<double> effort_rms_;
  std::vector<Families> chosen_, told_;
  std::map<std::pair<std::size_t, Families>, double> left_;
  std::map<std::pair<std::size_t, Families>, std::vector<JointDynamics>>
      fold_fits_;  // each without one part of the log
  std::map<std::pair<std::size_t, Families>, std::vector<double>> known_;
};

}  // namespace

Log together(const std::vector<Log>& logs) {
  Log out;
  for (const Log& log : logs) {
    const Eigen::Index before = out.t_s.size();
    for (const Eigen::Index begin : log.begin) out.begin.push_back(before + begin);
    const auto append = [&](const Eigen::MatrixXd& from, Eigen::MatrixXd& to, Eigen::Index rows) {
      const Eigen::Index columns = std::max(from.cols(), to.cols());
      if (columns == 0) return;
      Eigen::MatrixXd all = Eigen::MatrixXd::Constant(before + rows, columns, nothing);
      if (to.rows() > 0) all.topRows(before) = to;
      if (from.rows() > 0) all.bottomRows(rows) = from;
      to = all;
    };
    append(log.position, out.position, log.rows());
    append(log.velocity, out.velocity, log.rows());
    append(log.effort, out.effort, log.rows());
    append(log.target, out.target, log.rows());
    append(log.base_pose, out.base_pose, log.rows());
    Eigen::VectorXd t(before + log.rows());
    t << out.t_s, log.t_s;
    out.t_s = t;
    out.notes.insert(out.notes.end(), log.notes.begin(), log.notes.end());
    out.file += (out.file.empty() ? "" : ", ") + log.file;
  }
  return out;
}

RobotDiagnosis diagnose(const Body& body, const Robot& robot, const Log& log,
                        const std::vector<Log>& held_out, const Options& options) {
  return Diagnoser(body, robot, options).run(log, held_out);
}

}  // namespace thermopower::robot
