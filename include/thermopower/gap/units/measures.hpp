// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/heat_between_rows.hpp>
#include <thermopower/gap/observe/prepared_recording.hpp>
#include <thermopower/gap/units/windows.hpp>
#include <thermopower/plant/bench_at_rows.hpp>
#include <thermopower/plant/sine_cosine.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// @file measures.hpp
/// The few numbers of a recording that tell a unit, a sign or exchanged columns. Each is measured once, with friction, drag, a
/// constant load and gravity left free; every hypothesis says what it should be.

namespace thermopower::gap::engine {

/// A number that a recording's columns make together, measured by expected: 1 where units and constants are right.
enum class UnitMeasure {
  slope,    ///< the rate by the slope of the angle
  drive,    ///< acceleration for each unit of the command, by the model's
  drag,     ///< the model's effort for each unit of the rate, by the measured one
  torque,   ///< a torque from outside by what it does
  target,   ///< the target by the motion that follows it
  current,  ///< the current by what the circuit draws
  supply,   ///< the supply by the model's nominal one
  heating,  ///< the rate of warming for each watt, by the model's
  cooling,  ///< the rate of cooling for each kelvin, by the model's
};

/// How many there are.
inline constexpr std::size_t unit_measure_count = 9;

/// A measure as a recording tells it.
struct Measured {
  double value = missing;      ///< measured by expected, without its sign; NaN: not told
  double sd = 0.1;             ///< standard deviation of its logarithm
  double forwards_nats = 0.0;  ///< log likelihood of a positive sign against a negative one

  /// Whether the recording tells it.
  bool is_told() const { return std::isfinite(value) && value > 0.0; }
  /// Takes what is told. @param of  the value, with its sign
  void tell(double of, double its_sd) {
    constexpr double least_sd = 0.1;
    value = std::abs(of);
    sd = std::max(least_sd, its_sd);
    forwards_nats = std::copysign(UnitThresholds().most_sign, of);
  }
};

/// How warm a column's numbers are.
struct TemperatureRange {
  double low = missing;        ///< coldest but for a few samples; NaN: not recorded
  double typical = missing;    ///< median
  double high = missing;       ///< hottest but for a few samples
  bool whole_numbers = false;  ///< all samples are

  /// Of a column; empty where it was not recorded.
  TemperatureRange(const Recording& recording, const char* column) {
    std::vector<double> values;
    if (const Eigen::VectorXd* samples = recording.find(column)) values = finite_samples(*samples);
    if (values.empty()) return;
    constexpr double lowest = 0.005, highest = 0.95;
    whole_numbers = std::all_of(values.begin(), values.end(),
                                [](double one) { return std::abs(one - std::round(one)) < 1e-6; });
    low = quantile_of(values, lowest);
    high = quantile_of(values, highest);
    typical = median_of(values);
  }
  TemperatureRange() = default;

  /// Whether it was recorded.
  bool is_known() const { return std::isfinite(typical); }
  /// Whether it cannot be in degrees Celsius: warmer throughout than a winding stands, or colder than any place on earth.
  bool is_odd() const {
    constexpr double hottest_C = 200.0, coldest_C = -90.0;
    return low > hottest_C || typical < coldest_C;
  }
};

/// Two columns that a log may have exchanged; both empty: none.
typedef std::pair<std::string, std::string> ColumnPair;

/// Everything that a recording, or a run of it, says of units.
struct UnitEvidence {
  std::array<Measured, unit_measure_count> measures;  ///< indexed by UnitMeasure
  TemperatureRange motor;                             ///< of motor_C
  TemperatureRange air;                               ///< of ambient_C
  double air_offset_K =
      missing;  ///< by how much warmer than ambient_C the air is to which the motor cools; NaN: not told
  double most_power = 0.0;      ///< largest power_param
  double interval_s = missing;  ///< median between rows
  bool is_axis = false;         ///< an axis is judged
  bool is_bench = false;        ///< a body or a circuit is judged
  std::string heated_by;  ///< column whose unit the heat depends on: power_param, current_A, drive_A, heat_W
  std::vector<std::string> columns;   ///< that have samples, `t_s` among them
  std::vector<ColumnPair> exchanged;  ///< columns that fit each other in each other's place, and only so

  /// The measure of one kind.
  Measured& operator[](UnitMeasure kind) { return measures[static_cast<std::size_t>(kind)]; }
  /// The measure of one kind.
  const Measured& operator[](UnitMeasure kind) const { return measures[static_cast<std::size_t>(kind)]; }
  /// Whether a column has samples.
  bool has(const std::string& column) const {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
  }
  /// Whether a measure is told, with the expected sign and about the expected size. @param factor  that it may be off by
  bool is_near(UnitMeasure kind, double factor) const {
    const Measured& one = (*this)[kind];
    return one.is_told() && one.forwards_nats >= 0.0 && std::abs(std::log(one.value)) < std::log(factor);
  }
};

/// The best that a regression of one column on another, and on a constant where that is asked for, tells, over all lengths of bells.
inline ToldCoefficient best_told(const Inputs& inputs, const Eigen::VectorXd& response,
                                 const Eigen::VectorXd& term, bool beside_constant) {
  WindowColumns of{Eigen::MatrixXd::Ones(response.size(), beside_constant ? 3 : 2)};
  of.columns.col(0) = term;
  of.columns.rightCols(1) = response;
  ToldCoefficient best;
  for_each_length(
      inputs.t_s, inputs.runs, [&](Eigen::Index) -> const WindowColumns& { return of; },
      [&](const WindowSums& sums) {
        const ToldCoefficient told = sums.all.solve().front();
        if (told.alike > best.alike) best = told;
      });
  return best;
}

/// The columns of an axis against each other and against what drives it.
class AxisMeasures {
public:
  /// @param inputs  of an axis; both must outlive this object
  AxisMeasures(const RigidAxisModel& axis, const Inputs& inputs)
      : axis_(axis), inputs_(inputs), command_(plant::command(inputs, axis.voltage_driven())) {
    if (inputs.judged(Signal::angle_deg)) angle_ = bridged(inputs.of(Signal::angle_deg), inputs.runs);
    if (inputs.judged(Signal::rate_dps)) rate_ = bridged(inputs.of(Signal::rate_dps), inputs.runs);
  }

  /// Writes what is told. @param is_commanded  the command was recorded
  void tell(bool is_commanded, UnitEvidence& to) {
    constexpr UnitThresholds limit;
    if (angle_.size() > 0 && rate_.size() > 0) {
      const ToldCoefficient slope =
          best_told(inputs_, interval_means(rate_), interval_slopes(inputs_.t_s, angle_), false);
      if (slope.alike > limit.same) to[UnitMeasure::slope].tell(slope.between(), 0.0);
    }
    if (inputs_.closed_loop) {
      const bool of_angle = inputs_.target_deg.size() > 0;
      const Eigen::VectorXd& moved = of_angle ? angle_ : rate_;
      if (moved.size() > 0) {
        const ToldCoefficient target =
            best_told(inputs_, of_angle ? inputs_.target_deg : inputs_.target_dps, moved, true);
        if (target.alike > limit.alike)
          to[UnitMeasure::target].tell(target.between(), -std::log(target.alike));
      }
    }
    if (is_commanded && command_.size() > 0) tell_effort(to);
  }

private:
  static constexpr Eigen::Index directed = 3;  // first terms: inertia, drag, friction
  struct Effort {
    ToldCoefficient inertia, drag, torque;
    double forwards_nats =
        0.0;  // log likelihood that inertia, drag and friction are positive, against negative
  };

  void tell_effort(UnitEvidence& to) {
    constexpr UnitThresholds limit;
    const double ohm = axis_.voltage_driven() ? axis_.resistance_ohm : 1.0,
                 gain = axis_.torque_constant_Nm_per_A / ohm;
    const double inertia = axis_.inertia_kgm2 / gain * rad_per_deg,
                 drag = (axis_.viscous_Nms_per_rad / gain +
                         (axis_.voltage_driven() ? axis_.torque_constant_Nm_per_A : 0.0)) *
                        rad_per_deg;
    const Effort effort = effort_with(0);
    const auto tell = [&](UnitMeasure kind, const ToldCoefficient& told, double value) {
      if (told.alike > limit.alike && value != 0.0) to[kind].tell(value, -std::log(told.alike));
    };
    tell(UnitMeasure::drive, effort.inertia, inertia / effort.inertia.between());
    if (effort.drag.value > 0.0) tell(UnitMeasure::drag, effort.drag, drag / effort.drag.between());
    tell(UnitMeasure::torque, effort.torque, -1.0 / (gain * effort.torque.between()));
    to[UnitMeasure::drag].forwards_nats = 0.0;
    to[UnitMeasure::drive].forwards_nats = effort.forwards_nats;
    // An effort that acts some rows after its stamp looks like one of the other sign where it changes from row to row.
    constexpr Eigen::Index most_late = 4;
    for (Eigen::Index late = 1; late <= most_late && effort.forwards_nats < 0.0; ++late)
      if (const double then = effort_with(late).forwards_nats;
          then >= std::abs(to[UnitMeasure::drive].forwards_nats))
        to[UnitMeasure::drive].forwards_nats = then;
  }

  /// The effort regressed on what the motion needs, by the bells that tell most.
  /// @param late  rows by which the effort acts after its stamp
  Effort effort_with(Eigen::Index late) const {
    constexpr UnitThresholds limit;
    Effort best;
    double least_left = 1.0 - limit.alike;
    WindowColumns columns;
    const auto of = [&](Eigen::Index length) -> const WindowColumns& {
      if (columns.columns.size() == 0 || rate_.size() == 0) columns = effort_columns(length, late);
      return columns;
    };
    for_each_length(inputs_.t_s, inputs_.runs, of, [&](const WindowSums& sums) {
      for (const WindowRegression* one : {&sums.moving, &sums.all}) {
        if (one->windows() < limit.windows) continue;
        const std::vector<ToldCoefficient> told = one->solve();
        if (told[0].alike > best.inertia.alike) best.inertia = told[0];
        if (one == &sums.all) continue;  // one that is held may be driven either way
        if (told[1].alike > best.drag.alike) best.drag = told[1];
        if (inputs_.torque_Nm.size() > 0 && told.back().alike > best.torque.alike) best.torque = told.back();
        const double free = one->left(directed, 0.0), forwards = one->left(directed, 1.0),
                     backwards = one->left(directed, -1.0);
        const double left = std::min(forwards, backwards) / free;
        if (!(left < least_left)) continue;
        least_left = left;
        constexpr double independent = 10.0;  // half the windows that count as such: a misfit remembers
        best.forwards_nats =
            std::clamp(independent * std::log(backwards / forwards), -limit.most_sign, limit.most_sign);
      }
    });
    return best;
  }

  /// Acceleration, rate, direction, a constant, the angle with its sine and cosine, a torque from outside; the effort.
  WindowColumns effort_columns(Eigen::Index length, Eigen::Index late) const {
    constexpr Eigen::Index part_of_bell = 8;
    constexpr double over_noise = 3.0, fast = 0.95;
    const Eigen::Index n = inputs_.rows(), around = std::max<Eigen::Index>(1, length / part_of_bell);
    const bool by_rate = rate_.size() > 0, has_angle = angle_.size() > 0,
               has_torque = inputs_.torque_Nm.size() > 0;
    Eigen::VectorXd rate = by_rate ? interval_means(rate_) : Eigen::VectorXd::Zero(n);
    for (const RunSpan& run : inputs_.runs)
      for (Eigen::Index i = run.begin; !by_rate && i + 1 < run.end; ++i) {
        const Eigen::Index from = std::max(run.begin, i - around), to = std::min(run.end - 1, i + 1 + around);
        rate[i] = (angle_[to] - angle_[from]) / (inputs_.t_s[to] - inputs_.t_s[from]);
      }
    std::vector<double> speeds = finite_samples(rate.cwiseAbs());
    const double noise =
        by_rate ? white_scale(inputs_.of(Signal::rate_dps), inputs_.runs)
                : white_scale(inputs_.of(Signal::angle_deg), inputs_.runs) /
                      (plant::median_interval_s(inputs_.t_s, inputs_.runs) * static_cast<double>(around));
    const double slow = std::max(MotionThresholds().moving * quantile_of(speeds, fast), over_noise * noise);
    WindowColumns all{Eigen::MatrixXd::Ones(n, 5 + (has_angle ? 3 : 0) + (has_torque ? 1 : 0)), !by_rate};
    all.columns.col(0) = interval_slopes(inputs_.t_s, by_rate ? rate_ : angle_);
    all.columns.col(1) = rate;
    all.columns.col(2) = (rate / slow).cwiseMax(-1.0).cwiseMin(1.0);
    if (has_angle) {
      all.columns.col(4) = interval_means(angle_);
      for (Eigen::Index i = 0; i < n; ++i) {
        const plant::SineCosine at(all.columns(i, 4) * rad_per_deg);
        all.columns(i, 5) = at.sine, all.columns(i, 6) = at.cosine;
      }
    }
    if (has_torque) all.columns.col(all.columns.cols() - 2) = inputs_.torque_Nm;
    for (Eigen::Index i = 0; i < n; ++i) {
      all.columns(i, all.columns.cols() - 1) = command_[std::max<Eigen::Index>(0, i - late)];
      all.moves.push_back(std::abs(rate[i]) > slow ? 1 : 0);
    }
    return all;
  }

  const RigidAxisModel& axis_;
  const Inputs& inputs_;
  const Eigen::VectorXd& command_;
  Eigen::VectorXd angle_;
  Eigen::VectorXd rate_;
};

/// The columns of a bench against its circuit, and the rate of warming against what heat and loss make it.
inline void measure_bench(const Model& model, const Inputs& inputs, const Recording& recording,
                          const Catalogue& catalogue, UnitEvidence& to) {
  constexpr UnitThresholds limit;
  to.heated_by = heat_column(inputs);
  const plant::BenchAtRows::Values law =
      plant::BenchAtRows(model, catalogue, inputs, {}).evaluate(plant::heat_told(inputs));
  // A winding's resistance at an impossible temperature says nothing.
  if (!to.motor.is_odd() && model.has_current() && recording.has("power_param") &&
      recording.has("current_A")) {
    const ToldCoefficient told = best_told(inputs, recording.column("current_A"), law.law_A, true);
    if (told.alike > limit.alike) to[UnitMeasure::current].tell(told.between(), -std::log(told.alike));
  }
  const auto* const body = std::get_if<LumpedThermalModel>(&model.thermal);
  if (body == nullptr || !inputs.judged(Signal::motor_C)) return;
  WindowColumns of{Eigen::MatrixXd::Ones(inputs.rows(), 4)};
  of.columns.col(0) = law.heat_W.cwiseQuotient(law.capacity);
  of.columns.col(1) = -law.loss_W.cwiseQuotient(law.capacity);
  of.columns.col(3) = interval_slopes(inputs.t_s, bridged(inputs.of(Signal::motor_C), inputs.runs));
  ToldCoefficient heat, loss, rest;
  for_each_length(
      inputs.t_s, inputs.runs, [&](Eigen::Index) -> const WindowColumns& { return of; },
      [&](const WindowSums& sums) {
        const std::vector<ToldCoefficient> told = sums.all.solve();
        if (std::min(told[0].alike, told[1].alike) <= std::min(heat.alike, loss.alike)) return;
        heat = told[0], loss = told[1], rest = told[2];
      });
  constexpr double significant = 3.0;
  const auto tell = [&](UnitMeasure kind, const ToldCoefficient& told, double alike) {
    if (!(told.alike > alike) || !(told.significance() > significant)) return false;
    if (!to.motor.is_odd()) to[kind].tell(told.value, 1.0 / told.significance());
    return true;
  };
  const bool warms = tell(UnitMeasure::heating, heat, limit.alike),
             cools = tell(UnitMeasure::cooling, loss, 0.5 * limit.alike);
  const double by_air_per_s = loss.value * body->conductance_W_per_K / body->heat_capacity_J_per_K;
  if (warms && cools) to.air_offset_K = rest.value / by_air_per_s;
}

/// Everything that a recording says of units.
inline UnitEvidence measure_units(const Model& model, const PreparedRecording& prepared,
                                  const Catalogue& catalogue) {
  UnitEvidence evidence;
  const Recording& recording = prepared.recording();
  const Inputs& inputs = prepared.inputs();
  evidence.columns.push_back("t_s");
  for (const Column& one : recording.columns)
    if (recording.has(one.name)) evidence.columns.push_back(one.name);
  if (recording.has("power_param"))
    for (const double power : recording.column("power_param"))
      if (power > evidence.most_power) evidence.most_power = power;
  evidence.interval_s = prepared.interval_s();
  evidence.is_axis = inputs.axis();
  evidence.is_bench = inputs.bench();
  evidence.motor = TemperatureRange(recording, "motor_C");
  evidence.air = TemperatureRange(recording, "ambient_C");
  if (recording.has("supply_V")) {
    std::vector<double> volts = finite_samples(recording.column("supply_V"));
    constexpr double loose = 0.5;  // a supply is not a constant
    Measured& supply = evidence[UnitMeasure::supply];
    supply.tell(median_of(volts) / (model.supply ? model.supply->nominal_V : 1.0), loose);
    if (!model.supply) supply.value = missing;
  }
  if (evidence.is_bench) measure_bench(model, inputs, recording, catalogue, evidence);
  if (evidence.is_axis) {
    assert(model.axis);
    const bool is_commanded =
        !inputs.closed_loop || recording.has(model.axis->voltage_driven() ? "voltage_V" : "drive_A");
    AxisMeasures(*model.axis, inputs).tell(is_commanded, evidence);
  }
  return evidence;
}

}  // namespace thermopower::gap::engine
