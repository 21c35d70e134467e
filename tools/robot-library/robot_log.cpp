// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "robot_log.hpp"

#include <thermopower/robot/names.hpp>

#include <thermopower/io/csv_table.hpp>
#include <thermopower/io/input_error.hpp>
#include <thermopower/io/mcap_file.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

namespace thermopower::robot {
namespace {

struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  std::vector<double> t_s;
  bool is_joined = false;  // of several topics: rows may repeat what came before
};

// Seconds per unit of a column that holds the time; 0 where it does not.
double time_unit(const std::string& name) {
  std::string lower;
  for (const char c : name) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  static const std::map<std::string, double> known{
      {"t_s", 1.0},         {"time_s", 1.0},        {"t", 1.0},
      {"time", 1.0},        {"timestamp", 1.0},     {"stamp", 1.0},
      {"timestamp_s", 1.0}, {"seconds", 1.0},       {"t_ms", 1e-3},
      {"time_ms", 1e-3},    {"timestamp_ms", 1e-3}, {"t_us", 1e-6},
      {"time_us", 1e-6},    {"timestamp_us", 1e-6}, {"t_ns", 1e-9},
      {"time_ns", 1e-9},    {"timestamp_ns", 1e-9}};
  const auto found = known.find(lower);
  return found == known.end() ? 0.0 : found->second;
}

Table read_table(const std::string& path, const Robot& robot,
                 const std::vector<std::pair<std::string, std::string>>& renamed) {
  Table out;
  if (io::is_mcap(path)) {
    const io::McapContents contents = io::list_mcap(path);
    std::vector<std::string> headers;
    for (const auto& column : contents.columns)
      if (!column.text) headers.push_back(column.header);
    const std::vector<ColumnMeaning> meanings = NameMatcher(robot).match(headers, renamed);
    std::vector<io::ColumnChoice> choices;
    std::string topic;
    for (std::size_t i = 0; i < headers.size(); ++i) {
      if (meanings[i].role == Role::none) continue;
      choices.push_back({headers[i], headers[i]});
      const std::string own = headers[i].substr(0, headers[i].find('.'));
      if (!topic.empty() && own != topic) out.is_joined = true;
      topic = own;
    }
    if (choices.empty())
      throw io::InputError(path + ": no field bears the name of a joint of " + io::excerpt(robot.name) +
                           ", such as " + io::excerpt(robot.joints.front().name) +
                           "; 'thermopower-gap columns' lists the fields, and --joint LOG=MODEL renames one");
    io::RecordingFile file = io::read_mcap(path, choices);
    out.t_s.assign(file.recording.t_s.data(), file.recording.t_s.data() + file.recording.t_s.size());
    for (auto& column : file.recording.columns) {
      out.names.push_back(column.name);
      out.columns.emplace_back(column.values.data(), column.values.data() + column.values.size());
    }
    return out;
  }
  io::CsvTable table = io::read_any_csv(path);
  double unit = 0.0;
  for (auto& column : table.columns) {
    const double own = unit == 0.0 ? time_unit(column.name) : 0.0;
    if (own != 0.0) {
      unit = own;
      out.t_s = std::move(column.values);
      for (double& t : out.t_s) t *= unit;
    } else {
      out.names.push_back(column.name);
      out.columns.push_back(std::move(column.values));
    }
  }
  if (unit == 0.0)
    throw io::InputError(
        path + ": there is no time; expected a column t_s, time, timestamp, time_ms or timestamp_ns");
  return out;
}

}  // namespace

Log read_robot_log(const std::string& path, const Robot& robot,
                   const std::vector<std::pair<std::string, std::string>>& renamed) {
  Table table = read_table(path, robot, renamed);
  const std::vector<ColumnMeaning> meanings = NameMatcher(robot).match(table.names, renamed);
  // Rows: those with a time; where rows of several topics were joined, those in which a position moves on.
  std::vector<std::size_t> rows;
  std::vector<Eigen::Index> begin;
  for (std::size_t row = 0; row < table.t_s.size(); ++row) {
    if (!std::isfinite(table.t_s[row])) continue;
    if (table.is_joined && !rows.empty()) {
      bool moves = false;
      for (std::size_t i = 0; i < meanings.size() && !moves; ++i)
        moves = meanings[i].role == Role::position && table.columns[i][row] != table.columns[i][row - 1];
      if (!moves) continue;
    }
    if (!rows.empty() && table.t_s[row] == table.t_s[rows.back()]) continue;
    if (rows.empty() || table.t_s[row] < table.t_s[rows.back()])
      begin.push_back(static_cast<Eigen::Index>(rows.size()));
    rows.push_back(row);
  }
  Log log;
  log.file = path;
  log.begin = begin;
  const auto count = static_cast<Eigen::Index>(rows.size()),
             joints = static_cast<Eigen::Index>(robot.joints.size());
  log.t_s.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) log.t_s[i] = table.t_s[rows[static_cast<std::size_t>(i)]];
  std::vector<std::string> from(robot.joints.size() * 8);
  const auto put = [&](Eigen::MatrixXd& to, Eigen::Index columns, std::size_t i) {
    if (to.rows() == 0)
      to = Eigen::MatrixXd::Constant(count, columns, std::numeric_limits<double>::quiet_NaN());
    const Eigen::Index at = meanings[i].joint;
    if (to.col(at).array().isFinite().any())
      throw io::InputError(path + ": column " + io::excerpt(table.names[i]) + ": a second column for " +
                           (meanings[i].role == Role::base_pose
                                ? std::string("the base")
                                : "joint " + io::excerpt(robot.joints[static_cast<std::size_t>(at)].name)) +
                           "; expected one for each quantity");
    for (Eigen::Index row = 0; row < count; ++row)
      to(row, at) = meanings[i].factor * table.columns[i][rows[static_cast<std::size_t>(row)]];
  };
  Eigen::MatrixXd feed;
  for (std::size_t i = 0; i < meanings.size(); ++i) {
    switch (meanings[i].role) {
      case Role::position:
        put(log.position, joints, i);
        break;
      case Role::velocity:
        put(log.velocity, joints, i);
        break;
      case Role::effort:
        put(log.effort, joints, i);
        break;
      case Role::target:
        put(log.target, joints, i);
        break;
      case Role::feed:
        put(feed, joints, i);
        break;
      case Role::base_pose:
        put(log.base_pose, 7, i);
        break;
      case Role::none:
        log.not_matched.push_back(table.names[i]);
        break;
    }
  }
  if (log.position.rows() == 0) {
    std::string found;
    for (const std::string& name : table.names)
      if (found.size() < 120) found += (found.empty() ? "" : ", ") + io::excerpt(name);
    throw io::InputError(path + ": no column holds the position of a joint of " + io::excerpt(robot.name) +
                         "; expected " + "a name such as " + robot.joints.front().name +
                         "/position_rad; found " + found + "; --joint LOG=MODEL renames a joint");
  }
  // A commanded effort stands in for one that nobody measured.
  if (feed.rows() > 0 && log.effort.rows() == 0 && log.target.rows() == 0) {
    log.effort = feed;
    log.notes.push_back("the commanded effort is taken for the effort, because no effort was measured");
  }
  if (log.base_pose.rows() > 0 && !log.base_pose.allFinite()) {
    log.notes.push_back(
        "the motion of the base is incomplete; expected position x, y, z and quaternion w, x, y, z: it is left out");
    log.base_pose.resize(0, 0);
  }
  if (!log.not_matched.empty()) {
    std::string names;
    for (const std::string& name : log.not_matched)
      if (names.size() < 100) names += (names.empty() ? "" : ", ") + name;
    log.notes.push_back(std::to_string(log.not_matched.size()) + " columns belong to no joint: " + names);
  }
  return log;
}

}  // namespace thermopower::robot
