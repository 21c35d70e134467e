// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/column_list.hpp>
#include <thermopower/io/recording_file.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A topic of an MCAP file.
struct McapTopic {
  std::string name;          ///< such as `/joint_states`
  std::string schema;        ///< type of its messages, such as `sensor_msgs/msg/JointState`; may be empty
  std::string encoding;      ///< of its messages: `cdr`, `json`, ...
  std::size_t messages = 0;  ///< how many there are
  double duration_s = 0.0;   ///< from its first message to its last one, on the recorder's clock
  bool stamped = false;      ///< its messages hold the time at which they were measured
  std::string unreadable;    ///< why its messages cannot be read; empty: they can
};

/// @brief What an MCAP file holds.
struct McapContents {
  std::string file;                   ///< path
  std::vector<McapTopic> topics;      ///< in the order of their names
  std::vector<ListedColumn> columns;  ///< their numeric fields, with proposals
};

/// @brief Whether a file (`-`: standard input) begins like an MCAP file. Nothing is consumed. A file that cannot be
/// opened begins like none.
bool is_mcap(const std::string& path);

/// @brief Lists topics and fields of an MCAP file. `joint` is as in list_columns(). @throws InputError, see read_mcap()
McapContents list_mcap(const std::string& path, const std::string& joint = {});

/// @brief The same on bytes in memory; `name` stands in messages where a path would.
McapContents list_mcap(const std::string& name, const char* bytes, std::size_t size,
                       const std::string& joint = {});

/// @brief The contents as text for a person, with the options `--column` that take the proposals.
std::string columns_text(const McapContents& contents);

/// @brief Reads a recording from an MCAP file: chunks plain, in zstd or in lz4; messages in JSON, or in CDR with the
/// definitions of ROS 2 (`ros2msg`).
///
/// A choice's header is a field: topic, point, and the path inside the message, as in `/imu.angular_velocity.z`. An element of a
/// list is named by its index or by the name that the message gives it in a list `name`, `names` or `joint_names`
/// beside or above: `/joint_states.position[2]`, `/joint_states.position[elbow]`, `/drives.motors[left].temperature`. A field of
/// any topic that bears a name of the format (`motor_C`) needs no choice. All else is left out.
///
/// **One time base.** Nothing is interpolated or resampled. Each message becomes a row at its own time; messages of the same
/// nanosecond share it. A measured column (`current_A`, `motor_C`, `angle_deg`, `rate_dps`) has samples in the rows of its
/// own messages alone. Everything else is held from message to message, as inputs are; rows before the first message of any
/// of these are left out. Time is counted from the first row that is kept. It is `header.stamp`, the time of measurement,
/// where the messages of all topics that are used have one, else the time at which the recorder took them; `t_s=log_time`,
/// `t_s=publish_time`, `t_s=header.stamp` say so by hand, and `t_s=/topic.field[:unit]` takes a field, where all columns
/// are of that topic.
///
/// Memory grows with the fields that are chosen and not with the file.
/// @param path  file to read, `-` for standard input
/// @throws InputError with file, byte, message, topic and field, and what was expected: damaged or cut-off files, check sums that
/// do not hold, fields that are nowhere, that are text or infinite
RecordingFile read_mcap(const std::string& path, const std::vector<ColumnChoice>& choices = {});

/// @brief The same on bytes in memory; `name` stands in messages where a path would.
RecordingFile parse_mcap(const std::string& name, const char* bytes, std::size_t size,
                         const std::vector<ColumnChoice>& choices = {});

}  // namespace thermopower::io
