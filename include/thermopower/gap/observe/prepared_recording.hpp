// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/clock.hpp>
#include <thermopower/gap/observe/command_between_rows.hpp>
#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/data/frame_masks.hpp>
#include <thermopower/gap/observe/lagging_output.hpp>
#include <thermopower/gap/data/sample_masks.hpp>
#include <thermopower/gap/data/segments.hpp>
#include <thermopower/gap/data/slow_sensors.hpp>
#include <thermopower/gap/observe/under_way.hpp>
#include <thermopower/gap/rule.hpp>
#include <thermopower/plant/variable_words.hpp>
#include <thermopower/plant/samples.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// A recording as every stage of a diagnosis uses it: validated and checked once, when it is made.
///
/// Samples that are not to be believed are missing; inputs have no holes; where time passed unrecorded or an input
/// was not known the run is cut, and the rows in between are left out. `findings` says so.
class PreparedRecording {
public:
  /// @param model       says which columns are inputs, and which outputs are judged
  /// @param recorded    as it was given
  /// @param as_recorded findings are made, but nothing is masked or cut
  /// @throws InvalidInput where the recording is invalid (Recording::validate())
  PreparedRecording(const Model& model, const Recording& recorded, bool as_recorded = false);

  /// The believed samples; all rows lie in a run.
  const Recording& recording() const { return believed_; }
  /// The same as the rollouts of the model take it.
  const Inputs& inputs() const { return inputs_; }
  /// Gives away recording().
  Recording take_recording() && { return std::move(believed_); }
  /// Gives away inputs().
  Inputs take_inputs() && { return std::move(inputs_); }
  /// All findings, in a fixed order: stamps, then column by column.
  const std::vector<Finding>& findings() const { return findings_; }
  /// For each row of recording() its row in the whole recording as it was given.
  const std::vector<Eigen::Index>& source_rows() const { return source_rows_; }
  /// Median interval between rows in s.
  double interval_s() const { return interval_s_; }
  /// Takes other values of a command than were recorded.
  /// @param values  its means over the intervals after each row of recording()
  /// @param unknown what of each row's nobody knows
  void take_command(const Model& model, const std::string& column, Eigen::VectorXd values,
                    UnknownCommand unknown) {
    believed_.set(column, std::move(values));
    renew_inputs(model);
    inputs_.command_unknown = std::move(unknown);
  }
  /// Lets a servo's target go on between the rows. @param share  of the way to the next row's, on average
  void take_targets_between(const Model& model, double share) {
    const Eigen::VectorXd deg = inputs_.target_deg, dps = inputs_.target_dps;
    for (const char* column : {"target_deg", "target_dps"})
      if (believed_.has(column))
        believed_.set(column, mean_command(believed_.column(column), believed_.runs, share));
    renew_inputs(model);
    inputs_.target_deg = deg;
    inputs_.target_dps = dps;
    inputs_.target_moves = true;
    constexpr double told_apart = 0.1;  // rows
    const double of_samples = plant::moving_target_share(plant::servo_gains(model).period_s, interval_s_);
    if (std::abs(share - of_samples) > told_apart) inputs_.target_lead = share - of_samples;
    replay_servo(model, inputs_);
  }
  /// Says how noisy the command is. @param sd  standard deviation, in its unit
  void set_command_noise(double sd) { inputs_.command_noise = sd; }
  /// Says how noisy the current is that heats the bench: its variance heats nothing. @param sd_A  standard deviation
  void set_current_noise(double sd_A) { inputs_.current_noise_A = inputs_.command_noise = sd_A; }
  /// Lets the inputs of the next row be in force before it. @param share  part of the interval after each row
  void take_next_before_it(Eigen::VectorXd share) { inputs_.next_share = std::move(share); }
  /// Reads an output earlier that comes late. Comes before what is said of the command. @param lag_s  by so much, at least 0
  void read_earlier_by(const Model& model, const std::string& column, double lag_s) {
    believed_.set(column, read_earlier(believed_.column(column), believed_.t_s, believed_.spans(), lag_s));
    renew_inputs(model);
  }
  /// Leaves an output out. Comes before what is said of the command. @param sentence  why it is not judged
  void leave_out(const Model& model, const std::string& column, const std::string& sentence) {
    believed_.remove(column);
    renew_inputs(model);
    for (plant::NotJudged& note : inputs_.not_judged)
      if (note.what == column) note.sentence = sentence;
  }
  /// Says whether the first command of a run was in force before that already. @param run  place among the runs
  void set_driven_before(std::size_t run, bool was) {
    believed_.runs = believed_.spans();
    believed_.runs[run].was_driven = inputs_.runs[run].was_driven = was;
  }
  /// Rows that were given.
  Eigen::Index recorded_rows() const { return recorded_rows_; }

private:
  /// Prepares what is believed.
  void renew_inputs(const Model& model) {
    inputs_ = prepare(model, believed_);
    if (!starts_between_samples_) return;
    for (const Signal signal : {Signal::angle_deg, Signal::rate_dps})
      if (inputs_.judged(signal))
        inputs_.between_samples[static_cast<std::size_t>(signal)] =
            between_samples(inputs_.t_s, inputs_.runs, inputs_.of(signal));
  }
  bool is_temperature(const std::string& name) const;
  bool is_output(const std::string& name) const;
  void read_the_clock(FindingList& list);
  void mask_outputs(const Recording& recorded, FindingList& list);
  void mask_output(const Recording& recorded, const std::string& name, Eigen::VectorXd& values,
                   FindingList& list);
  void find_starts(FindingList& list);
  void mask_slow_input(const std::string& name, Eigen::VectorXd& values, FindingList& list);
  double stands_between_samples(const Recording& recorded, const std::string& name) const;
  void fill_inputs(const Model& model, const Recording& recorded, FindingList& list);
  void keep_known_rows();

  const plant::PlantInfo* own_ = nullptr;  ///< of a plant of one's own, while the recording is prepared
  bool moves_ = false;                     ///< angle and rate are outputs of an axis, and no covariates
  bool electrical_ = false;                ///< the supply drives what is judged
  bool starts_between_samples_ = false;    ///< angle and rate never stand in one row
  bool drives_by_current_ = false;         ///< current_A is an input: nothing else tells the heat
  Recording believed_;
  RowMask unknown_;
  RowMask
      untold_current_;  ///< samples of a current that heats which stood still or at the end of the sensor's range
  Inputs inputs_;
  std::vector<Finding> findings_;
  std::vector<Eigen::Index> source_rows_;
  double interval_s_ = 0.0;
  Eigen::Index recorded_rows_ = 0;
};

/// Bounds of what a temperature of, or near, a motor can be, in degC.
struct PossibleTemperature {
  static constexpr double low_C = -60.0;   ///< colder than any place a motor is run in
  static constexpr double high_C = 500.0;  ///< hotter than any insulation stands

  /// Whether a temperature is possible.
  static bool holds(double value_C) { return value_C > low_C && value_C < high_C; }
  /// Whether it is beyond a bound; a missing one is not.
  static bool is_beyond(double value_C) { return value_C < low_C || value_C > high_C; }
};

/// Rows that are set in either mask.
inline RowMask either(RowMask one, const RowMask& other) {
  assert(one.size() == other.size());
  for (std::size_t i = 0; i < one.size(); ++i) one[i] = one[i] != 0 || other[i] != 0 ? 1 : 0;
  return one;
}

inline PreparedRecording::PreparedRecording(const Model& model, const Recording& recorded, bool as_recorded)
    : believed_(recorded),
      unknown_(static_cast<std::size_t>(recorded.rows()), 0),
      recorded_rows_(recorded.rows()) {
  if (const auto problem = recorded.validate())
    throw InvalidInput("recording '" + recorded.name + "': " + *problem);
  believed_.runs = recorded.spans();
  FindingList list(recorded);
  for (const Column& column : recorded.columns)
    if (!recorded.has(column.name)) {
      list.add(FindingKind::empty_column, Severity::warning, column.name, "is there, but has no sample");
      believed_.empty_columns.push_back(column.name);
      believed_.remove(column.name);
    }
  if (model.own) own_ = model.own->equations->info();
  moves_ = model.has_axis();
  // A row that is lost stops no clock: it is read before the runs are cut there.
  read_the_clock(list);
  believed_.runs = cut_at(believed_.runs, by(Rule::pauses, check_stamps(model, list, believed_.runs)), true);
  if (moves_ && believed_.has("angle_deg")) {
    const Eigen::VectorXd angle = unwrapped(believed_.column("angle_deg"), believed_.runs);
    const RowMask elsewhere = check_resets(list, angle, believed_.find("rate_dps"), believed_.runs);
    believed_.runs = cut_at(believed_.runs, by(Rule::resets, elsewhere), false);
  }
  electrical_ = model.has_current() && recorded.has("power_param");
  drives_by_current_ = !recorded.has("power_param") && !recorded.has(heater_power_column) &&
                       !recorded.has("drive_A") && !recorded.has("heat_W") && model.has_thermal();
  mask_outputs(recorded, list);
  fill_inputs(model, recorded, list);
  if (moves_) mark_under_way(believed_);
  interval_s_ = plant::median_interval_s(believed_.t_s, believed_.spans(), 0.0);
  findings_ = list.take();
  if (as_recorded) {
    for (Finding& one : findings_) one.action = FindingAction::none;
    believed_ = recorded;
    unknown_.assign(unknown_.size(), 0);
  }
  keep_known_rows();
  renew_inputs(model);
  own_ = nullptr;
}

/// Whether a column is a temperature that the model simulates: what it stores heat in cannot jump.
inline bool PreparedRecording::is_temperature(const std::string& name) const {
  if (own_ == nullptr) return name == "motor_C";
  return std::any_of(own_->signals.begin(), own_->signals.end(),
                     [&](const plant::PlantSignal& one) { return one.name == name && one.unit == "degC"; });
}

/// Whether a column is measured of what the model simulates; of a plant of one's own, whether it is one that the checks
/// know something of: a temperature.
inline bool PreparedRecording::is_output(const std::string& name) const {
  if (own_ != nullptr) return is_temperature(name);
  return name == "current_A" || name == "motor_C" || (moves_ && (name == "angle_deg" || name == "rate_dps"));
}

/// Takes the stamps of the clock that the recorded ones jitter around, where the outputs were read by it.
inline void PreparedRecording::read_the_clock(FindingList& list) {
  std::vector<const Eigen::VectorXd*> outputs;
  for (const Column& column : believed_.columns)
    if (is_output(column.name)) outputs.push_back(&column.values);
  std::optional<ClockStamps> clock =
      clock_behind(believed_.t_s, cut_at_long_pauses(believed_.t_s, believed_.runs), outputs);
  if (!clock || !holds(Rule::clock)) return;
  list.add(FindingKind::jittering_stamps, Severity::note, "t_s",
           "stray by " + short_number(clock->jitter_s) + " s around a clock of " +
               short_number(clock->period_s) + " s, and the outputs were read at its ticks: those are used",
           "stamp a reading where it is taken");
  believed_.t_s = std::move(clock->t_s);
}

inline void PreparedRecording::mask_outputs(const Recording& recorded, FindingList& list) {
  for (Column& column : believed_.columns) {
    // A current holds because the power does; or, as what heats, because it is held.
    if (!is_output(column.name) || (column.name == "current_A" && own_ == nullptr)) continue;
    const std::optional<SlowColumn> held = held_between_updates(column.values, believed_.runs);
    const std::optional<SlowColumn> straight =
        held ? std::nullopt : straight_between_updates(believed_.t_s, column.values, believed_.runs);
    if ((!held && !straight) || !holds(Rule::slow_sensors)) continue;
    const SlowColumn& slow = held ? *held : *straight;
    take_away(column.values, slow.between);
    list.add_rows(held ? FindingKind::held_samples : FindingKind::interpolated_samples, Severity::note,
                  column.name, slow.between, FindingAction::masked,
                  (held ? "repeat the reading" : "lie on straight lines between the readings") +
                      std::string(" of a sensor that speaks every ") + std::to_string(slow.rows_apart) +
                      " rows: only what is new is used",
                  "log each reading when it comes, or leave the cells between two empty");
  }
  std::vector<const Eigen::VectorXd*> outputs;
  for (const Column& column : recorded.columns)
    if (recorded.has(column.name) && is_output(column.name) && shows_frames(column.values, believed_.runs))
      outputs.push_back(&column.values);
  const RowMask repeated = repeated_frames(outputs, believed_.runs);
  list.add_rows(FindingKind::repeated_frames, Severity::warning, "", repeated, FindingAction::masked,
                "of every output repeat the row before them", "log each frame once");
  for (Column& column : believed_.columns) {
    const bool slow = column.name == "ambient_C" || column.name == "neighbour_C" ||
                      (electrical_ && column.name == "supply_V");
    if (is_output(column.name)) {
      take_away(column.values, repeated);
      mask_output(recorded, column.name, column.values, list);
    } else if (slow) {
      mask_slow_input(column.name, column.values, list);
    }
  }
  // A frame whose sensors said nothing may look right in one of them.
  std::vector<const Eigen::VectorXd*> lost_in;
  std::vector<Column*> lossy;
  std::vector<double> defaults;
  for (Column& column : believed_.columns) {
    if (!is_output(column.name)) continue;
    const Eigen::VectorXd& as_it_was = *recorded.find(column.name);
    const double value = default_reading(as_it_was, column.values);
    if (!std::isfinite(value)) continue;
    lost_in.push_back(&as_it_was);
    lossy.push_back(&column);
    defaults.push_back(value);
  }
  RowMask lost = lost_frames(lost_in, defaults, believed_.runs);
  for (std::size_t i = 0; i < lost.size(); ++i)
    if (std::none_of(lossy.begin(), lossy.end(), [at = static_cast<Eigen::Index>(i)](const Column* one) {
          return std::isfinite(one->values[at]);
        }))
      lost[i] = 0;
  list.add_rows(FindingKind::glitched_samples, Severity::warning, "", lost, FindingAction::masked,
                "read what the sensors read when they say nothing", "look at what reads the sensors");
  for (Column* column : lossy) take_away(column->values, lost);
  find_starts(list);
}

/// Finds starts for windows where angle and rate never stand in one row.
inline void PreparedRecording::find_starts(FindingList& list) {
  if (!moves_ || !believed_.has("angle_deg") || !believed_.has("rate_dps")) return;
  if (!are_apart(believed_.column("angle_deg"), believed_.column("rate_dps"))) return;
  starts_between_samples_ = true;
  list.add(
      FindingKind::separate_samples, Severity::note, "angle_deg",
      "hardly ever stands in a row with rate_dps: windows start from what the one is between its samples");
}

inline void PreparedRecording::mask_output(const Recording& recorded, const std::string& name,
                                           Eigen::VectorXd& values, FindingList& list) {
  const std::vector<RunSpan>& runs = believed_.runs;
  const auto mask = [&](FindingKind kind, const RowMask& rows, const char* words, const char* mend = "") {
    take_away(values, rows);
    const Severity severity = kind == FindingKind::spiked_samples ? Severity::note : Severity::warning;
    list.add_rows(kind, severity, name, rows, FindingAction::masked, words, mend);
  };
  const Eigen::Index present = recorded.find(name)->array().isFinite().count();
  if (present < recorded.rows()) {
    constexpr double many = 0.2;
    const double share = 1.0 - static_cast<double>(present) / static_cast<double>(recorded.rows());
    list.add(FindingKind::missing_samples, share > many ? Severity::warning : Severity::note, name,
             std::to_string(recorded.rows() - present) + " of " + std::to_string(recorded.rows()) +
                 " samples are missing (" + short_number(100.0 * share) + " %)");
  }
  if (is_temperature(name)) {
    std::vector<double> samples = finite_samples(values);
    RowMask impossible(unknown_.size(), 0);
    if (PossibleTemperature::holds(median_of(samples)))
      for (Eigen::Index i = 0; i < values.size(); ++i)
        impossible[static_cast<std::size_t>(i)] = PossibleTemperature::is_beyond(values[i]) ? 1 : 0;
    mask(FindingKind::impossible_samples, by(Rule::impossible, std::move(impossible)),
         "are no temperature of a motor", "look at the thermometer's wiring");
  }
  if (name == "angle_deg") {
    Eigen::VectorXd whole = unwrapped(values, runs);
    if ((values.array().isFinite() && whole.array() != values.array()).any()) {
      list.add(FindingKind::wrapped_angle, Severity::note, name,
               "starts anew after each turn; it is unwrapped");
      values = std::move(whole);
    }
  }
  ColumnTraits traits;
  traits.cannot_jump = is_temperature(name);
  traits.zero_is_rest = name == "rate_dps" || name == "current_A" || name == "angle_deg";
  traits.t_s = &believed_.t_s;
  if (name == "angle_deg") traits.at_rest = believed_.find("rate_dps");
  if (name == "rate_dps") traits.integral = believed_.find("angle_deg");
  const Eigen::VectorXd* power = name == "current_A" ? believed_.find("power_param") : nullptr;
  traits.begins_with_a_step = power != nullptr;
  const std::vector<RunSpan> steady = power != nullptr ? steady_runs(*power, runs) : runs;
  SampleMasks masks(values, steady, traits);
  if (power != nullptr) {
    const RowMask lost = lost_current(values, *power, masks.scale());
    masks.take(lost);
    mask(FindingKind::glitched_samples, lost, "are 0 where current flows at that power otherwise",
         "look at the current sensor's bus");
  }
  const RowMask spikes = masks.spikes(), bursts = masks.bursts();
  mask(FindingKind::spiked_samples, spikes, "lie far from all around them");
  mask(FindingKind::glitched_samples, bursts, "jump away and back",
       "look at what reads the sensor (a default reading, a word that wraps)");
  traits.begins_with_a_step = false;
  SampleMasks still(values, runs, traits);
  // First: all but the first sample of a clipped stretch look frozen.
  const RowMask clipped = still.clipped();
  mask(FindingKind::clipped_samples, clipped, "stand at the end of the sensor's range",
       "use a sensor with a wider range");
  // A current that stands more often than it moves is what somebody set: as what heats, it is held.
  constexpr double mostly = 0.5;
  const bool is_set = name == "current_A" && !electrical_ && still.equal_share() > mostly;
  const RowMask frozen = is_set ? RowMask(unknown_.size(), 0) : still.frozen();
  mask(FindingKind::frozen_samples, frozen, "repeat the value before them where noise or motion would show",
       "look at what reads the sensor");
  if (name == "current_A" && drives_by_current_) untold_current_ = either(clipped, frozen);
  if (still.equal_share() > 0.999999 && present > 20)
    list.add(FindingKind::constant_column, Severity::note, name, "never changes");
  const double quantum = quantum_of(values);
  std::vector<double> steps = step_sizes(values, runs);
  if (quantum > 0.0 && median_of(steps) < 1.5 * quantum && quantum > 1e-6)
    list.add(FindingKind::coarse_quantum, Severity::note, name,
             "comes in steps of " + short_number(quantum) + ": rounding alone errs by " +
                 short_number(quantum / std::sqrt(12.0)) + " (RMS) where the signal crosses many of them");
}

inline void PreparedRecording::mask_slow_input(const std::string& name, Eigen::VectorXd& values,
                                               FindingList& list) {
  ColumnTraits traits;
  traits.cannot_jump = name != "supply_V";  // a supply gives way to the load
  SampleMasks masks(values, believed_.runs, traits);
  const RowMask spikes = masks.spikes();
  RowMask mask = either(spikes, masks.bursts());
  if (const Eigen::VectorXd* power = name == "supply_V" ? believed_.find("power_param") : nullptr)
    for (Eigen::Index row = 1; row < power->size(); ++row)
      if ((*power)[row] != (*power)[row - 1])  // a step of the load may show for a row
        mask[static_cast<std::size_t>(row)] = mask[static_cast<std::size_t>(row) - 1] = 0;
  take_away(values, mask);
  list.add_rows(FindingKind::spiked_samples, Severity::note, name, mask, FindingAction::masked,
                "lie far from all around them");
}

/// How long an input may stand between two samples because it is logged in rows of its own: what a merge of streams makes. 0
/// where it is not.
inline double PreparedRecording::stands_between_samples(const Recording& recorded,
                                                        const std::string& name) const {
  const Eigen::VectorXd& values = *recorded.find(name);
  const auto is_apart = [&](const Column& column) {
    return is_output(column.name) && are_apart(values, column.values);
  };
  if (std::none_of(recorded.columns.begin(), recorded.columns.end(), is_apart)) return 0.0;
  return SlowSensorThresholds().nearest * median_distance_s(believed_.t_s, believed_.runs, values);
}

inline void PreparedRecording::fill_inputs(const Model& model, const Recording& recorded, FindingList& list) {
  std::vector<InputColumn> inputs(std::begin(input_columns), std::end(input_columns));
  if (drives_by_current_) inputs.push_back({"current_A", InputPace::slow});
  for (const InputColumn& input : inputs) {
    Column* found = nullptr;
    for (Column& column : believed_.columns)
      if (column.name == input.name) found = &column;
    if (found == nullptr || found->values.array().isFinite().all()) continue;
    const Eigen::Index holes = recorded.rows() - recorded.find(input.name)->array().isFinite().count();
    RowMask mask(unknown_.size(), 0);
    const double stands_s = is_ignored(model, input.name) ? std::numeric_limits<double>::infinity()
                                                          : stands_between_samples(recorded, input.name);
    found->values = known_input(input, found->values, believed_.t_s, believed_.runs, mask, stands_s,
                                std::string(input.name) == "current_A" ? untold_current_ : RowMask());
    if (std::isinf(stands_s) && !found->values.array().isFinite().all()) {
      believed_.remove(input.name);  // a run without a sample
      continue;
    }
    unknown_ = either(std::move(unknown_), mask);
    list.add_rows(FindingKind::unknown_input, Severity::note, input.name, mask, FindingAction::segmented,
                  "are missing between values that differ; their rows are not judged",
                  "log the inputs at every row");
    if (holes > 0 && ranges_of(mask).empty())
      list.add(FindingKind::missing_samples, Severity::note, input.name,
               std::to_string(holes) + " samples are missing between values that tell what they were");
  }
}

inline void PreparedRecording::keep_known_rows() {
  constexpr SegmentThresholds limit;
  std::vector<RunSpan> kept;
  const std::vector<RunSpan> runs =
      without(believed_.runs.empty() ? believed_.spans() : believed_.runs, unknown_);
  const bool cut = runs.size() != believed_.spans().size();
  for (const RunSpan& run : runs)
    if (!cut || run.size() >= limit.least_rows) kept.push_back(run);
  source_rows_.clear();
  for (RunSpan& run : kept) {
    const auto begin = static_cast<Eigen::Index>(source_rows_.size());
    for (Eigen::Index row = run.begin; row < run.end; ++row)
      source_rows_.push_back(believed_.first_row + row);
    run.begin = begin;
    run.end = static_cast<Eigen::Index>(source_rows_.size());
  }
  believed_.runs = std::move(kept);
  assert(static_cast<Eigen::Index>(source_rows_.size()) <= believed_.rows());
  const auto rows = static_cast<Eigen::Index>(source_rows_.size());
  if (rows == believed_.rows()) return;
  const auto kept_of = [&](const Eigen::VectorXd& values) {
    Eigen::VectorXd result(rows);
    for (Eigen::Index i = 0; i < rows; ++i)
      result[i] = values[source_rows_[static_cast<std::size_t>(i)] - believed_.first_row];
    return result;
  };
  believed_.t_s = kept_of(believed_.t_s);
  for (Column& column : believed_.columns) column.values = kept_of(column.values);
}

}  // namespace thermopower::gap::engine
