// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/recording_file.hpp>

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/mcap_file.hpp>
#include <thermopower/io/sbgc_capture.hpp>

#include <utility>

namespace thermopower::io {

const std::vector<std::string>& known_columns() {
  static const std::vector<std::string> names = {"t_s",        "power_param", "drive_A",      "voltage_V",
                                                 "target_deg", "target_dps",  "torque_Nm",    "heat_W",
                                                 "supply_V",   "ambient_C",   "airspeed_mps", "neighbour_C",
                                                 "rate_dps",   "current_A",   "motor_C",      "angle_deg"};
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
                             "holds text and is no run label; it is not used"});
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

RecordingFile read_recording(const std::string& path, const std::vector<ColumnChoice>& choices) {
  if (is_mcap(path)) return read_mcap(path, choices);
  if (is_sbgc_capture(path)) return read_sbgc_capture(path, choices);
  return to_recording(read_csv(path, known_columns(), choices));
}

}  // namespace thermopower::io
