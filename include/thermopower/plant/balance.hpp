// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/quantity.hpp>
#include <thermopower/plant/rows.hpp>
#include <thermopower/plant/signal.hpp>
#include <thermopower/plant/submodel.hpp>

#include <Eigen/Core>

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file balance.hpp
/// The missing quantities at measured rows, in one balance per conservation law or pair of instruments:
///
/// \f[ \mathrm{missing} = c \, \frac{\mathrm{d}x}{\mathrm{d}t} - f_\mathrm{sampled} - f_\mathrm{held} \f]
///
/// with the stored state x (a temperature, a rate, an angle), what stores it c, and the flows into it at the
/// measured state. A law without a store is a balance of its measured output alone: missing = x - f. A plant
/// states its balances; the localisation integrates them and knows no equation.

namespace thermopower::plant {

/// How a balance is compared with its measurement.
enum class BalanceForm {
  algebraic,  ///< row by row: the law has no store
  weak,       ///< integrated against smooth test functions of compact support: what moves within many rows
  filtered,   ///< through the baseline's own linear response: what is slow against the interval between rows
};

/// The rows that balances stand on.
///
/// How the whole works: @ref gap_method.
struct BalanceRows {
  Eigen::VectorXd t_s;        ///< stamps, strictly increasing inside a run
  std::vector<RunSpan> runs;  ///< rows between which time passes
  double interval_s = 1.0;    ///< median interval between rows

  /// Number of rows.
  Eigen::Index size() const { return t_s.size(); }
};

/// One way in which values that a plant computes enter its balance, one value per row.
///
/// How the whole works: @ref gap_method.
struct BalancePart {
  /// Where they enter.
  enum class Kind {
    flow_sampled,  ///< a flow, known at the row's instant, in the balance's unit
    flow_held,     ///< a flow that holds over the interval that starts at the row, in the balance's unit
    store,         ///< a further store: takes capacity times the derivative of these, in the state's unit
    reading,       ///< shown besides the state by its instrument, in the state's unit; not for the weak form
    reading_late,  ///< the instrument follows the state with `delay_s` as time constant; `filtered` only
  };
  Kind kind = Kind::flow_sampled;  ///< where the values enter
  Eigen::VectorXd values;          ///< one per row; none for reading_late, and where `make` makes them
  double delay_s = 0.0;            ///< of a held flow: it starts that much later than the balance's own
  double factor = 1.0;             ///< multiplies them
  Eigen::VectorXd weight = {};     ///< of a store: multiplies the derivative row by row; empty: 1
  std::function<Eigen::VectorXd()> make =
      nullptr;  ///< makes `values` when asked for, as a recording may be long
};

/// A direction in which a balance can be off: the sum of its parts.
using Direction = std::vector<BalancePart>;

/// The correction of a signal's reading if an instrument is at fault, per unit of the coefficient that a freedom was fitted
/// with.
struct Correction {
  Signal signal = Signal{};  ///< whose reading
  double offset = 0.0;       ///< to be taken off, in the signal's unit
};

/// A deviation of a plant from its equation, without a formula: a few directions.
///
/// How the whole works: @ref gap_method.
struct Freedom {
  SubmodelName submodel;  ///< who is at fault if this helps
  std::string variable;   ///< what orders the missing quantity then: one of the balance's variables, or empty
  std::string words;      ///< "a loss that depends on the rise": for the evidence
  /// The directions; made when asked for, as a recording may be long. `at` is one of `scan`.
  std::function<std::vector<Direction>(double at)> directions;
  /// Bound of every coefficient from below: 0 for what acts one way only.
  double least = -std::numeric_limits<double>::infinity();
  std::vector<double> scan = {};  ///< values of which the best is taken; empty: `directions(0)` once
  std::function<std::string(double at)> words_at = nullptr;  ///< words for the scan's best; empty: `words`
  /// The instrument that may be at fault instead: it is, where other balances hold better without its reading,
  /// or with `correction` applied to it.
  std::optional<SubmodelName> or_instrument = {};
  std::optional<Correction> correction =
      {};  ///< see `or_instrument`; also of a fault of the instrument itself
};

/// Something that may order a missing quantity.
struct OrderingVariable {
  /// How it is averaged where a missing quantity is.
  enum class Kind {
    sampled,     ///< known at the row's instant
    held,        ///< holds over the interval that starts at the row
    derivative,  ///< the derivative of the values is meant
  };
  std::string name;                  ///< a column, or a derived name such as `rise_K`
  std::string unit;                  ///< of the variable (of its derivative where that is meant)
  Eigen::VectorXd values;            ///< one per row
  Kind kind = Kind::sampled;         ///< how it is averaged
  SignalName from = SignalName("");  ///< the signal whose reading it is, where it is one
};

/// The same missing quantity stated as another one: volts that would drive the missing amperes.
struct RestatedQuantity {
  QuantityName quantity;   ///< what it is called then
  std::string unit;        ///< its unit
  Eigen::VectorXd factor;  ///< multiplies the missing quantity row by row
};

/// One constant of a balance, and what moving it does.
///
/// How the whole works: @ref gap_method.
struct ConstantDirection {
  std::string name;  ///< of the constant
  /// Flow per logarithm of the constant; made when asked for, as a recording may be long. Empty: it does nothing here.
  std::function<Direction()> direction;

  /// A direction that is at hand.
  ConstantDirection(std::string its_name, Direction at_hand)
      : name(std::move(its_name)), direction([at_hand = std::move(at_hand)] { return at_hand; }) {}
  /// A direction that is made when asked for.
  ConstantDirection(std::string its_name, std::function<Direction()> make)
      : name(std::move(its_name)), direction(std::move(make)) {}
};

/// One balance of a plant at the rows of a recording.
struct Balance {
  QuantityName quantity;    ///< what may be missing; balances of one quantity are alternatives of each other
  std::string unit;         ///< of the missing quantity
  SignalName signal;        ///< the measured signal that its residual shows in
  SubmodelName instrument;  ///< that shows the signal
  SubmodelName otherwise;   ///< who is at fault where no freedom helps
  std::string given;        ///< "Given the measured motion and command": what the balance takes as known
  BalanceForm form = BalanceForm::algebraic;  ///< how it is compared
  std::shared_ptr<const BalanceRows> rows;    ///< not null
  Eigen::VectorXd measured;                   ///< the state as measured; NaN where missing
  Eigen::VectorXd state;                      ///< the same without holes
  Eigen::VectorXd capacity = {};              ///< what stores the state, row by row; empty: 1
  Eigen::VectorXd flow_sampled;               ///< at the row's instant, at the measured state
  Eigen::VectorXd flow_held = {};             ///< over the row's interval; empty: none
  double held_delay_s = 0.0;                  ///< the held flow starts that much after its row
  Eigen::VectorXd relaxation_per_s = {};      ///< `filtered`: -(d flow/d state) / capacity
  Eigen::VectorXd flow_measured = {};  ///< the reading that the sampled flow is, NaN where missing; or empty
  Eigen::VectorXd noise_from = {};     ///< samples whose white noise `measured` carries; empty: itself
  double noise_gain = 1.0;             ///< multiplies the noise of `noise_from`
  double noise = 0.0;  ///< standard deviation of the noise of `measured` where it is known; else 0
  std::vector<ConstantDirection> constants = {};  ///< what may be off within its slack
  std::vector<SignalName> reads = {};             ///< other signals whose readings make its flows
  std::vector<Freedom> freedoms = {};             ///< what may be otherwise
  std::vector<OrderingVariable> variables = {};   ///< what may order the missing quantity
  std::optional<RestatedQuantity> restated = {};  ///< for faults of the plant rather than of the instrument
  std::vector<int> half_widths = {};  ///< `weak`: of the test functions, in rows; narrow ones see fast faults
  int picture_half_width = 0;         ///< rows that a sample of the missing quantity spans; 0: as noise asks
  double per_display_unit = 1.0;      ///< the missing quantity is divided by this for display
};

/// The offsets of a plant's readings before they enter a balance, by signal, in the signals' units.
using ReadingOffsets = PerSignal<double>;

/// A balance that is made when a stage asks for it.
///
/// How the whole works: @ref gap_method.
struct BalanceSource {
  QuantityName quantity;                               ///< as in Balance
  SignalName signal;                                   ///< as in Balance
  std::vector<SignalName> reads;                       ///< as in Balance
  std::function<Balance(const ReadingOffsets&)> make;  ///< the balance, its readings corrected by these
};

/// A recorded column that no law uses, and that may order what is missing.
struct Covariate {
  std::string name;        ///< of the column
  Eigen::VectorXd values;  ///< one per row, without holes
};

/// The unit that a column's name ends in: `degC` for `_C`, `m/s` for `_mps`, ...; empty where it has none.
inline std::string unit_of_column(const std::string& name) {
  const auto ends = [&](const std::string& tail) {
    return name.size() > tail.size() && name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
  };
  if (ends("_C")) return "degC";
  if (ends("_mps")) return "m/s";
  if (ends("_dps")) return "deg/s";
  if (ends("_deg")) return "deg";
  if (ends("_pct")) return "%";
  const auto at = name.rfind('_');
  return at == std::string::npos ? "" : name.substr(at + 1);
}

/// A direction of one part.
inline Direction flow_held(Eigen::VectorXd values) {
  return {{BalancePart::Kind::flow_held, std::move(values)}};
}
/// A direction of one part.
inline Direction flow_sampled(Eigen::VectorXd values) {
  return {{BalancePart::Kind::flow_sampled, std::move(values)}};
}
/// A direction of one part.
inline Direction further_store(Eigen::VectorXd values, Eigen::VectorXd weight = {}) {
  return {{BalancePart::Kind::store, std::move(values), 0.0, 1.0, std::move(weight)}};
}
/// A direction of one part.
inline Direction further_reading(Eigen::VectorXd values) {
  return {{BalancePart::Kind::reading, std::move(values)}};
}
/// One direction per column, each made by `one(column)`.
template <class One>
std::vector<Direction> directions_of(const Eigen::MatrixXd& columns, One&& one) {
  std::vector<Direction> list;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) list.push_back(one(Eigen::VectorXd(columns.col(k))));
  return list;
}

/// One direction per column, sampled at the rows.
inline std::vector<Direction> sampled_directions(const Eigen::MatrixXd& columns) {
  return directions_of(columns, [](Eigen::VectorXd column) { return flow_sampled(std::move(column)); });
}

/// Adds a freedom of a balance whose directions are columns that are made when asked for.
/// @param variable  that it goes with; empty: with none
inline void add_sampled_freedom(Balance& balance, SubmodelName submodel, const std::string& variable,
                                const std::string& words, std::function<Eigen::MatrixXd()> columns) {
  balance.freedoms.push_back({std::move(submodel), variable, words, [columns = std::move(columns)](double) {
                                return sampled_directions(columns());
                              }});
}

/// Directions of one part each, whose values are made one after the other, when asked for.
/// @param kind   where they enter
/// @param count  of them
/// @param column  makes the values of the k-th, one per row
inline std::vector<Direction> made_directions(BalancePart::Kind kind, Eigen::Index count,
                                              const std::function<Eigen::VectorXd(Eigen::Index k)>& column) {
  std::vector<Direction> list;
  for (Eigen::Index k = 0; k < count; ++k)
    list.push_back({{kind, {}, 0.0, 1.0, {}, [column, k] { return column(k); }}});
  return list;
}

}  // namespace thermopower::plant
