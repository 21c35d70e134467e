// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/observe/command_between_rows.hpp>
#include <thermopower/gap/observe/current_noise.hpp>
#include <thermopower/gap/observe/experiment.hpp>
#include <thermopower/gap/observe/heater_duty.hpp>
#include <thermopower/gap/observe/heat_between_rows.hpp>
#include <thermopower/gap/observe/lagging_output.hpp>
#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/observe/target_between_rows.hpp>
#include <thermopower/gap/observe/under_way.hpp>
#include <thermopower/gap/detail/dead_columns.hpp>
#include <thermopower/gap/rule.hpp>
#include <thermopower/gap/units/choose_units.hpp>
#include <thermopower/gap/units/clock_shift.hpp>
#include <thermopower/gap/units/detached_sensor.hpp>
#include <thermopower/plant/inline.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace thermopower::gap::engine {

/// Adds findings to others.
inline void append(std::vector<Finding>& findings, const std::vector<Finding>& more) {
  findings.insert(findings.end(), more.begin(), more.end());
}

/// Reads a rate that comes behind its angle in the training recordings, or an angle that comes behind its rate,
/// earlier by as much where that is less than half a row, or where the two differ by more than the lag; else leaves
/// it out.
inline void mend_what_lags(const Model& model, CheckedRecordings& checked, std::vector<Finding>& findings) {
  if (!model.has_axis()) return;
  RateLag rate_lag;
  for (const PreparedRecording& one : checked.train) rate_lag.add(one.inputs());
  const RateLag::Found found = rate_lag.found();
  if (!found.lag_s || !holds(Rule::lag)) return;
  const double lag_s = std::abs(*found.lag_s);
  const std::string late = *found.lag_s > 0.0 ? "rate_dps" : "angle_deg";
  const std::string words =
      "comes " + short_number(lag_s) +
      (*found.lag_s > 0.0 ? " s behind the slope of angle_deg" : " s behind what rate_dps sums up to");
  for (PreparedRecording* const one : checked.all()) {
    if (!one->inputs().judged(Signal::angle_deg) || !one->inputs().judged(Signal::rate_dps)) continue;
    const bool kept = found.differ_by_more || lag_s <= LagThresholds().within_a_row * one->interval_s();
    findings.push_back(
        {FindingKind::lagging_output, kept ? Severity::note : Severity::warning, one->recording().name, late,
         words + ": filtered, or read later; it is " + (kept ? "read that much earlier" : "not judged"),
         "log it unfiltered and with the instant it is of",
         kept ? FindingAction::none : FindingAction::masked});
    if (kept) one->read_earlier_by(model, late, lag_s);
    else one->leave_out(model, late, plant::the_variable(late) + " is not judged: it " + words);
  }
}

/// Chooses the units of all recordings. Other questions to the columns are asked only where their units are right.
/// @param spans  given_spans() of the recordings in training, then of those held out
inline void check_units(const Model& model, CheckedRecordings& checked,
                        const std::vector<std::vector<RunSpan>>& spans, const Catalogue& catalogue,
                        double most_power, std::vector<Finding>& findings) {
  // Nobody but its author knows the units of the columns of a plant of one's own.
  if (model.own) return;
  UnitChoice units(model, catalogue, most_power);
  std::size_t at = 0;
  for (const PreparedRecording* const one : checked.all()) units.add(*one, spans[at++]);
  std::vector<Finding> found;
  units.find(found);
  if (!found.empty() && holds(Rule::units)) append(findings, found);
  if (!units.is_as_expected()) return;
  std::vector<Finding> detached;
  check_motion_sensors(model, checked.train,
                       [&](const std::vector<Finding>& some) { append(detached, some); });
  for (const PreparedRecording* const one : checked.all()) {
    FindingList list(one->recording());
    check_thermometer(model, *one, catalogue, list);
    check_current_clock(model, *one, catalogue, list);
    append(detached, list.take());
  }
  if (!detached.empty() && holds(Rule::detached_sensors)) append(findings, detached);
}

/// Lets the target of a servo go on between the rows where the training recordings say that it did.
inline void read_targets_between_rows(const Model& model, CheckedRecordings& checked,
                                      const Catalogue& catalogue, std::vector<Finding>& findings) {
  if (!model.has_axis() || !model.has_servo()) return;
  TargetBetweenRows between(model, catalogue);
  const auto is_closed = [](const PreparedRecording& one) {
    return one.inputs().axis() && one.inputs().closed_loop && !one.inputs().target_moves;
  };
  for (const PreparedRecording& one : checked.train)
    if (is_closed(one)) between.add(one.inputs());
  const auto share = between.steady();
  if (!share || !holds(Rule::target_between_rows)) return;
  for (PreparedRecording* const one : checked.all()) {
    if (!is_closed(*one)) continue;
    findings.push_back({FindingKind::sampled_command, Severity::note, one->recording().name,
                        one->inputs().target_deg.size() > 0 ? "target_deg" : "target_dps",
                        "went on between the rows, as the motion shows: the servo is given what lies " +
                            short_number(100.0 * share->value) +
                            " % of the way to the next row's, on average",
                        "log the target at the rate it is set"});
    one->take_targets_between(model, share->value);
  }
}

/// Whether a recording is of an axis whose command was logged.
inline bool is_commanded(const PreparedRecording& one) {
  return one.inputs().axis() && !one.inputs().closed_loop;
}

/// The command of the model's axis in a recording.
inline const Eigen::VectorXd& command_of(const Model& model, const PreparedRecording& one) {
  return plant::command(one.inputs(), model.axis->voltage_driven());
}

/// The motion of the axes in training whose command was logged. It refers to these recordings.
inline MotionRegression commanded_motion(const Model& model, const CheckedRecordings& checked) {
  MotionRegression motion;
  for (const PreparedRecording& one : checked.train)
    if (is_commanded(one)) motion.add(one.inputs(), command_of(model, one));
  return motion;
}

/// Lets the first command of a run that begins at rest be in force before it, or none, where its first rows show which, by
/// what the motion makes of earlier commands in the training recordings. Comes before what is said of the command between the rows.
inline void read_what_drove_before(const Model& model, CheckedRecordings& checked) {
  if (!model.has_axis()) return;
  const MotionRegression motion = commanded_motion(model, checked);
  const DrivenBefore before(motion);
  for (PreparedRecording* const one : checked.all()) {
    if (!is_commanded(*one)) continue;
    const std::vector<RunSpan>& runs = one->inputs().runs;
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (const auto was = before.was(one->inputs(), command_of(model, *one), runs[i]);
          was && !runs[i].goes_on && holds(Rule::driven_before))
        one->set_driven_before(i, *was);
  }
}

/// Takes the command of an axis between the rows for what the training recordings say it was, in all recordings.
inline void read_between_rows(const Model& model, CheckedRecordings& checked, double horizon_s,
                              std::vector<Finding>& findings) {
  if (!model.has_axis()) return;
  const MotionRegression motion = commanded_motion(model, checked);
  const CommandBetweenRows between(motion, horizon_s);
  const double noise = between.noise();
  const auto share = between.steady();
  if ((!share && !(noise > 0.0)) || !holds(Rule::command_between_rows)) return;
  for (PreparedRecording* const one : checked.all()) {
    if (!is_commanded(*one)) continue;
    const std::string column = command_column(one->inputs());
    const auto note = [&](FindingKind kind, const std::string& message, const char* mend) {
      findings.push_back({kind, Severity::note, one->recording().name, column, message, mend});
    };
    if (share) {
      note(FindingKind::sampled_command,
           "went on between the rows, as the motion shows: its mean until the next row is taken, " +
               short_number(100.0 * share->value) + " % of the way to that one's",
           "log the command at the rate it is set, or the mean of it between the rows");
      const Eigen::VectorXd& command = command_of(model, *one);
      const std::vector<RunSpan> runs = one->recording().spans();
      UnknownCommand unknown;
      if (!(noise > 0.0)) unknown.between = unknown_between(command, runs);
      constexpr double sure = 2.0;  // standard errors: 95 %
      unknown.shift = sure * share->error * steps_of(command, runs);
      one->take_command(model, column, mean_command(command, runs, share->value), std::move(unknown));
    }
    if (noise > 0.0) {
      const char* unit = model.axis->voltage_driven() ? " V" : " A";
      note(FindingKind::noisy_command,
           "has noise of " + short_number(noise) + unit +
               " that no motion follows: what a simulation wanders by it counts as noise",
           "log the command that was sent, not the current that was measured");
      one->set_command_noise(noise);
    }
  }
}

/// Takes off the heat of a bench what its current sensor reads where nothing flows in the training recordings, in all
/// recordings.
inline void read_current_noise(const Model& model, CheckedRecordings& checked,
                               std::vector<Finding>& findings) {
  // The other laws' heat goes with the current itself, of which noise is no part on average.
  const bool goes_with_square = std::holds_alternative<OhmicCurrentModel>(model.current);
  if (model.own || !model.has_thermal() || !goes_with_square || model.has_axis()) return;
  const auto is_heated = [](const PreparedRecording& one) {
    const Inputs& inputs = one.inputs();
    return inputs.judged(Signal::motor_C) && inputs.heat_W.size() == 0 &&
           (inputs.heat == HeatSource::measured || inputs.heat == HeatSource::drive);
  };
  CurrentNoise noise;
  for (const PreparedRecording& one : checked.train)
    if (is_heated(one))
      noise.add(one.inputs().heat == HeatSource::drive ? one.inputs().drive_A : one.inputs().held_current_A,
                one.inputs().runs);
  const std::optional<double> sd_A = noise.sd_A();
  if (!sd_A || !holds(Rule::current_noise)) return;
  for (PreparedRecording* const one : checked.all()) {
    if (!is_heated(*one)) continue;
    findings.push_back({FindingKind::noisy_command, Severity::note, one->recording().name,
                        heat_column(one->inputs()),
                        "has noise of " + short_number(*sd_A) +
                            " A where nothing flows: its square is taken off the heat, and what a simulation "
                            "wanders by the rest of it counts as noise",
                        "log the mean square of the current between the rows"});
    one->set_current_noise(*sd_A);
  }
}

/// Lets the power of a bench be switched when the training recordings say that it was and the held-out ones do not
/// say otherwise, in all recordings.
inline void read_when_switched(const Model& model, CheckedRecordings& checked, const Catalogue& catalogue,
                               std::vector<Finding>& findings) {
  if (model.own || !model.has_thermal()) return;
  const auto heat_of = [&](const PreparedRecording& one) {
    return heat_at_rows(model, catalogue, one.inputs());
  };
  const auto is_heated = [](const PreparedRecording& one) {
    return one.inputs().judged(Signal::motor_C) &&
           one.inputs().target_C.size() == 0;  // a loop's duty is a mean
  };
  const auto seen_in = [&](const std::vector<PreparedRecording>& recordings) {
    HeatBetweenRows between;
    for (const PreparedRecording& one : recordings)
      if (is_heated(one)) between.add(one.inputs(), heat_of(one));
    return between;
  };
  const HeatBetweenRows between = seen_in(checked.train);
  const std::optional<double> share = between.share();
  if (!share || between.differs_from(seen_in(checked.held_out)) || !holds(Rule::heat_between_rows)) return;
  for (PreparedRecording* const one : checked.all()) {
    if (!is_heated(*one)) continue;
    findings.push_back(switched_between_rows(one->recording().name, one->inputs(), *share));
    one->take_next_before_it(switched_share(one->inputs(), heat_of(*one), *share));
  }
}

THERMOPOWER_GAP_INLINE CheckedRecordings check(const Model& model, std::vector<Recording> train,
                                               std::vector<Recording> held_out, const CheckOptions& options,
                                               const Catalogue& catalogue) {
  CheckedRecordings result;
  std::vector<Finding>& findings = result.findings;
  double most_power = 0.0;
  for (auto* all : {&train, &held_out})
    for (Recording& one : *all) {
      one = with_heater_duty(model, std::move(one));
      if (one.has("power_param"))
        for (const double power : one.column("power_param"))
          if (power > most_power) most_power = power;
    }
  std::vector<std::vector<RunSpan>> spans;
  const auto take = [&](std::vector<Recording>& recordings, std::vector<PreparedRecording>& to) {
    to.reserve(recordings.size());
    for (Recording& one : recordings) {
      spans.push_back(given_spans(one));
      to.emplace_back(model, one, options.as_recorded);
      append(findings, to.back().findings());
      one = Recording();
    }
  };
  take(train, result.train);
  take(held_out, result.held_out);
  check_units(model, result, spans, catalogue, most_power, findings);
  leave_out_what_is_dead(model, result, options.as_recorded, findings);
  if (!options.as_recorded) {
    mend_what_lags(model, result, findings);
    read_what_drove_before(model, result);
    read_between_rows(model, result, options.horizon_s, findings);
    read_targets_between_rows(model, result, catalogue, findings);
    read_current_noise(model, result, findings);
    read_when_switched(model, result, catalogue, findings);
  }
  append(findings, check_experiment(result.train, result.held_out, options.horizon_s));
  // A horizon or a rest that does not fit says nothing of its own where the unit of a column is wrong.
  const auto rank = [](const Finding& one) {
    const bool unit = one.kind == FindingKind::wrong_unit || one.kind == FindingKind::wrong_sign ||
                      one.kind == FindingKind::swapped_columns;
    return one.severity != Severity::error ? 2 : unit ? 0 : 1;
  };
  sort_by(findings, rank);
  return result;
}

}  // namespace thermopower::gap::engine
