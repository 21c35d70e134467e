// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/recording_file.hpp>

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/mcap_file.hpp>
#include <thermopower/io/sbgc_capture.hpp>

#include "log_text.hpp"

#include <cmath>
#include <utility>

namespace thermopower::io {

const std::vector<std::string>& known_columns() {
  static const std::vector<std::string> names = {
      "t_s",         "power_param", "drive_A",   "voltage_V", "target_deg", "target_dps",
      "target_C",    "torque_Nm",   "heat_W",    "supply_V",  "ambient_C",  "airspeed_mps",
      "neighbour_C", "rate_dps",    "current_A", "motor_C",   "angle_deg"};
  return names;
}

RecordingFile to_recording(CsvTable table) {
  RecordingFile file;
  Recording& recording = file.recording;
  recording.name = table.file;
  const auto rows = static_cast<Eigen::Index>(table.rows);
  for (auto& column : table.columns) {
    const Eigen::Map<const Eigen::VectorXd> values(column.values.data(), rows);
    if (column.name == "t_s") {
      recording.t_s = values;
    } else {
      recording.columns.push_back({column.name, values});
    }
    column.values = {};  // a million rows need not be in memory twice
  }
  for (std::size_t i = 0; i < table.run_begin.size(); ++i) {
    const std::size_t end = i + 1 < table.run_begin.size() ? table.run_begin[i + 1] : table.rows;
    recording.runs.push_back(
        {static_cast<Eigen::Index>(table.run_begin[i]), static_cast<Eigen::Index>(end), table.run_labels[i]});
  }
  const auto ranges = [](const std::vector<CsvTable::Place>& places) {
    std::vector<RowRange> list;
    for (const CsvTable::Place& one : places) {
      const auto row = static_cast<Eigen::Index>(one.row);
      if (list.empty() || list.back().end < row) list.push_back({row, row});
      list.back().end = row + 1;
    }
    return list;
  };
  const auto count = [](const std::vector<CsvTable::Place>& places, const char* one, const char* many) {
    return std::to_string(places.size()) + (places.size() == 1 ? one : many) + std::to_string(places[0].line);
  };
  if (!table.repeated.empty())
    file.findings.push_back(
        {FindingKind::repeated_frames, Severity::note, table.file, "",
         count(table.repeated, " row is the row before it once more, time included, in line ",
               " rows are the row before them once more, time included, the first in line ") +
             ": left out, and not counted where rows are counted",
         "log each row once", FindingAction::masked, ranges(table.repeated)});
  if (!table.restarts.empty())
    file.findings.push_back({FindingKind::gap_in_stamps, Severity::warning, table.file, "t_s",
                             count(table.restarts, " time falls back to where the run began, in line ",
                                   " times falls back to where the run began, first in line ") +
                                 ", as when what logs was restarted: a new run begins there",
                             "give each run its own label in a column run", FindingAction::segmented,
                             ranges(table.restarts)});
  for (const auto& name : table.ignored_text) {
    file.findings.push_back({FindingKind::text_column_ignored, Severity::note, table.file, name,
                             "holds text and is not a run label; it is left out"});
  }
  if (!table.ends_with_line_break) {
    file.findings.push_back(
        {FindingKind::no_final_line_break,
         Severity::note,
         table.file,
         {},
         "the last line has no line break; all its fields are there, but if the file was cut off inside the last "
         "number nobody can tell"});
  }
  return file;
}

namespace {

using Needs = ColumnChoice::Needs;

// A torque of the drive becomes a current before the file is read: a factor is all it takes.
void take_torque_constant(const std::string& path, ReadOptions& options) {
  for (ColumnChoice& choice : options.choices) {
    if (choice.needs != Needs::torque_constant) continue;
    if (options.torque_constant_Nm_per_A == 0.0)
      throw InputError(
          path + ": column '" + choice.name + "': " + excerpt(choice.header) +
          " is a torque, and the model has no torque_constant_Nm_per_A that makes a current of it; expected an axis in "
          "the model, or a current in A");
    choice.factor /= options.torque_constant_Nm_per_A;
  }
}

// Shares of the supply become volts once the supply is known.
void take_supply(const std::string& path, const ReadOptions& options, Recording& recording) {
  for (const ColumnChoice& choice : options.choices) {
    if (choice.needs != Needs::supply || !recording.has(choice.name)) continue;
    Eigen::VectorXd volts = recording.column(choice.name);
    double supply = options.nominal_V;
    if (!recording.has("supply_V") && !(supply > 0.0))
      throw InputError(
          path + ": column '" + choice.name + "': " + excerpt(choice.header) +
          " is a share of the supply, and nobody says how much that is; expected a column supply_V, --supply, or "
          "/supply/nominal_V in the model");
    for (Eigen::Index row = 0; row < volts.size(); ++row) {
      if (recording.has("supply_V") && std::isfinite(recording.column("supply_V")[row]))
        supply = recording.column("supply_V")[row];
      volts[row] *= supply;
    }
    recording.set(choice.name, volts);
  }
}

void take_constants(const std::string& path, const ReadOptions& options, Recording& recording) {
  for (const auto& [name, value] : options.constants) {
    if (recording.has(name))
      throw InputError(path + ": column '" + name +
                       "': is in the file, and is given as a constant, too; expected one of the two");
    recording.set(name, Eigen::VectorXd::Constant(recording.t_s.size(), value));
  }
}

RecordingFile from_text(const std::string& path, const LogText& log, const ReadOptions& options) {
  const std::string name = path == "-" ? "standard input" : path;
  RecordingFile file = to_recording(parse_csv(name, log.csv.data(), log.csv.size(), known_columns(),
                                              options.choices, {options.rows_per_s, log.lines}));
  return file;
}

RecordingFile read_any(const std::string& path, const ReadOptions& options) {
  if (is_mcap(path)) return read_mcap(path, options.choices);
  switch (kind_of_log(path)) {
    case LogKind::klippy:
      return from_text(path, klippy_as_csv(path, all_bytes_of(path)), options);
    case LogKind::marlin:
      return from_text(path, marlin_as_csv(path, all_bytes_of(path)), options);
    case LogKind::json_lines:
      return from_text(path, json_lines_as_csv(path, all_bytes_of(path)), options);
    case LogKind::numpy:
      return from_text(path, numpy_as_csv(path, all_bytes_of(path)), options);
    case LogKind::candump:
      return candump_as_recording(path, all_bytes_of(path), options.choices);
    case LogKind::sqlite_bag:
      return read_mcap(path, options.choices);
    case LogKind::csv:
      break;
  }
  if (is_sbgc_capture(path)) return read_sbgc_capture(path, options.choices);
  return to_recording(read_csv(path, known_columns(), options.choices, {options.rows_per_s, {}}));
}

}  // namespace

ReadOptions read_options(const gap::Model& model, std::vector<ColumnChoice> choices) {
  ReadOptions options;
  options.choices = std::move(choices);
  if (model.axis) options.torque_constant_Nm_per_A = model.axis->torque_constant_Nm_per_A;
  if (model.supply) options.nominal_V = model.supply->nominal_V;
  return options;
}

RecordingFile read_recording(const std::string& path, const ReadOptions& given) {
  ReadOptions options = given;
  take_torque_constant(path, options);
  RecordingFile file = read_any(path, options);
  take_constants(path, options, file.recording);
  take_supply(path, options, file.recording);
  return file;
}

RecordingFile read_recording(const std::string& path, const std::vector<ColumnChoice>& choices) {
  ReadOptions options;
  options.choices = choices;
  return read_recording(path, options);
}

}  // namespace thermopower::io
