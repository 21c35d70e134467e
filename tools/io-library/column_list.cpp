// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/column_list.hpp>

#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/csv_table.hpp>

#include <thermopower/io/mcap_file.hpp>
#include <thermopower/io/sbgc_capture.hpp>

#include "column_proposal.hpp"
#include "html_text.hpp"
#include "log_text.hpp"
#include "shell_words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace thermopower::io {
namespace {

// The bit of a 16-bit register that is its sign: whole numbers, none below 0, of which some lie a little above 2^15 and none
// between these and the others.
int sign_bit_of(const std::vector<double>& values) {
  constexpr int bit = 15;
  constexpr double sign = 32768.0, small = 0.75 * sign;
  double plain = 0.0, behind_sign = 0.0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    if (value < 0.0 || value >= 2.0 * sign) return 0;
    if (value < sign) plain = std::max(plain, value);
    else behind_sign = std::max(behind_sign, value - sign);
  }
  return behind_sign > 0.0 && plain < small && behind_sign < small ? bit : 0;
}

std::vector<ListedColumn> listed(const CsvTable& table, const std::string& joint) {
  std::vector<ListedColumn> list;
  std::vector<ColumnHint> hints;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const CsvTable::Column& column = table.columns[i];
    ListedColumn one;
    one.header = column.name;
    one.whole = true;
    std::size_t falls = 0;
    double before = 0.0;
    for (const double value : column.values) {
      if (std::isnan(value)) {
        ++one.missing;
        continue;
      }
      falls += one.samples > 0 && value < before ? 1 : 0;
      before = value;
      one.least = one.samples == 0 ? value : std::min(one.least, value);
      one.greatest = one.samples == 0 ? value : std::max(one.greatest, value);
      one.whole = one.whole && value == std::floor(value);
      ++one.samples;
    }
    // A clock falls where a log was begun anew, and nowhere else.
    constexpr std::size_t rows_of_a_run = 8;
    one.rises = falls * rows_of_a_run <= one.samples && (one.samples >= rows_of_a_run || falls == 0);
    one.whole = one.whole && one.samples > 0;
    if (one.whole) one.sign_bit = sign_bit_of(column.values);
    if (i < table.units.size()) one.file_unit = table.units[i];
    ColumnHint hint;
    if (std::find(table.stamps.begin(), table.stamps.end(), column.name) != table.stamps.end()) {
      hint.name = "t_s";
      hint.unit = column.name.find(':') == std::string::npos ? "" : "s";
      hint.because = "dates or times of day, in s since the first";
    } else if (i == 0 && column.name == "index") {
      hint.not_meant = true;
      hint.because = "the number of the row: left out unless it is asked for";
    }
    hints.push_back(hint);
    list.push_back(std::move(one));
  }
  for (const auto& name : table.ignored_text) {
    ListedColumn one;
    one.header = name;
    one.text = true;
    list.push_back(std::move(one));
    hints.emplace_back();
  }
  propose(list, hints, joint, &table);
  return list;
}

bool proposes(const std::vector<ListedColumn>& columns, const char* name) {
  return std::any_of(columns.begin(), columns.end(),
                     [name](const ListedColumn& one) { return one.proposed == name; });
}

}  // namespace

std::vector<ListedColumn> list_columns(const std::string& path, const std::string& joint) {
  return list_log(path, joint).columns;
}

LogContents list_log(const std::string& path, const std::string& joint) {
  LogContents contents;
  contents.file = path;
  const auto of_text = [&](const LogText& log) {
    contents.columns = list_columns(path, log.csv.data(), log.csv.size(), joint);
    for (const std::string& note : log.notes) contents.about += "  " + note + "\n";
  };
  if (is_mcap(path)) {
    McapContents mcap = list_mcap(path, joint);
    contents.about = topics_text(mcap);
    contents.columns = std::move(mcap.columns);
    contents.needs_time = false;
    return contents;
  }
  switch (kind_of_log(path)) {
    case LogKind::klippy:
      of_text(klippy_as_csv(path, all_bytes_of(path)));
      return contents;
    case LogKind::marlin:
      of_text(marlin_as_csv(path, all_bytes_of(path)));
      return contents;
    case LogKind::json_lines:
      of_text(json_lines_as_csv(path, all_bytes_of(path)));
      return contents;
    case LogKind::numpy:
      of_text(numpy_as_csv(path, all_bytes_of(path)));
      return contents;
    case LogKind::candump:
      contents.columns = list_candump(path, all_bytes_of(path), contents.about);
      contents.needs_time = false;
      return contents;
    case LogKind::sqlite_bag: {
      McapContents bag = list_mcap(path, joint);
      contents.about = topics_text(bag);
      contents.columns = std::move(bag.columns);
      contents.needs_time = false;
      return contents;
    }
    case LogKind::csv:
      break;
  }
  if (is_sbgc_capture(path)) {
    SbgcCaptureContents capture = list_sbgc_capture(path);
    contents.about = capture_text(capture);
    contents.columns = std::move(capture.columns);
    contents.needs_time = false;
    return contents;
  }
  contents.columns = listed(read_any_csv(path), joint);
  return contents;
}

std::string columns_text(const LogContents& contents) {
  return contents.about + (contents.about.empty() ? "" : "\n") + list_text(contents.columns) +
         next_text(contents.file == "-" ? "log.csv" : contents.file, contents.columns, contents.needs_time);
}

std::vector<ListedColumn> list_columns(const std::string& name, const char* bytes, std::size_t size,
                                       const std::string& joint) {
  return listed(parse_any_csv(name, bytes, size), joint);
}

std::string choice_text(const ListedColumn& column) {
  if (column.proposed.empty() || (column.proposed == column.header && column.unit.empty())) return {};
  // A row of units says it where the header is the format's.
  if (column.proposed == column.header && !column.file_unit.empty()) return {};
  // A header with a colon in it needs a unit after it, or the colon would begin one.
  std::string as = column.unit;
  if (as.empty() && column.header.find(':') != std::string::npos) as = units_of(column.proposed).front();
  return column.proposed + "=" + column.header + (as.empty() ? "" : ":" + as);
}

std::string list_text(const std::vector<ListedColumn>& columns) {
  std::size_t width = 28;
  for (const auto& one : columns) width = std::max(width, std::min<std::size_t>(one.header.size() + 1, 60));
  const int wide = static_cast<int>(width);
  char row[240];
  std::snprintf(row, sizeof row, "  %-*s%9s%9s%12s%12s  %s\n", wide, "column", "samples", "missing", "least",
                "greatest", "may be");
  std::string out = row;
  for (const auto& one : columns) {
    if (one.text) {
      std::snprintf(row, sizeof row, "  %-*.60s  text, left out unless it is called 'run'\n", wide,
                    one.header.c_str());
      out += row;
      continue;
    }
    const std::string unit = one.unit.empty() ? "" : " in " + one.unit;
    const std::string guess = one.proposed.empty() ? (one.why.empty() ? "a covariate" : one.why)
                                                   : one.proposed + unit + " (" + one.why + ")";
    std::snprintf(row, sizeof row, "  %-*.60s%9zu%9zu%12s%12s  ", wide, one.header.c_str(), one.samples,
                  one.missing, one.samples > 0 ? readable(one.least).c_str() : "-",
                  one.samples > 0 ? readable(one.greatest).c_str() : "-");
    out += row + guess + "\n";
  }
  return out;
}

std::string diagnose_command(const std::string& file, const std::vector<ListedColumn>& columns) {
  std::string out = "thermopower-gap diagnose --model model.json --recording " + quoted_for_shell(file);
  for (const auto& one : columns)
    if (const std::string choice = choice_text(one); !choice.empty())
      out += " --column " + quoted_for_shell(choice);
  return out;
}

std::string next_text(const std::string& file, const std::vector<ListedColumn>& columns, bool needs_time) {
  const bool moves = proposes(columns, "angle_deg") || proposes(columns, "rate_dps");
  const bool driven = proposes(columns, "drive_A") || proposes(columns, "voltage_V") ||
                      proposes(columns, "target_deg") || proposes(columns, "target_dps");
  const bool warms = proposes(columns, "motor_C");
  std::string missing, options;
  if (needs_time && !proposes(columns, "t_s")) {
    options += " --rate HZ";
    missing +=
        "No column looks like time: --column t_s=HEADER:UNIT says which one it is, or --rate HZ how many rows are a second.\n";
  }
  if (warms && !proposes(columns, "ambient_C")) {
    options += " --ambient DEGC";
    missing += "No column looks like the air's temperature: --ambient says what it was.\n";
  }
  if (moves && !driven)
    missing +=
        "No column looks like what drives the joint: expected a current, a voltage, a duty or a target "
        "(--column drive_A=HEADER, voltage_V=HEADER or target_deg=HEADER).\n";
  if (moves && proposes(columns, "drive_A") &&
      (proposes(columns, "target_deg") || proposes(columns, "target_dps")))
    missing +=
        "With a servo in the model, a measured effort may be compared instead of driving it: --column current_A=HEADER:UNIT.\n";
  if (proposes(columns, "target_C")) missing += "The model needs the heater's loop: a block \"heater\".\n";
  if (!moves && !warms)
    missing +=
        "No column looks like a motion or a motor's temperature: --column motor_C=HEADER or angle_deg=HEADER says which one is.\n";
  return "\nIf that is so:\n\n    " + diagnose_command(file, columns) + options +
         "\n\n'thermopower-gap init' writes model.json.\n" + missing;
}

std::string columns_text(const std::vector<ListedColumn>& columns, const std::string& file) {
  return list_text(columns) + next_text(file, columns, true);
}

std::string column_map_text(const std::vector<ListedColumn>& columns) {
  std::string out =
      "# NAME=HEADER[:UNIT], as --column takes it; what stands behind a '#' is a proposal not taken\n";
  for (const auto& one : columns) {
    const std::string choice = choice_text(one);
    if (!choice.empty()) out += choice + "\n";
    else if (one.proposed.empty() && !one.text) out += "# NAME=" + one.header + "\n";
  }
  return out;
}

}  // namespace thermopower::io
