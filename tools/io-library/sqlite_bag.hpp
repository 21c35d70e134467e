// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "mcap_records.hpp"

#include <string>

namespace thermopower::io {

/// @brief Reads a recording of ROS 2 in SQLite (rosbag2, `.db3`) as if it were MCAP: the same handlers, in the order of time.
/// Definitions of message types are those in the file; where an older rosbag2 left them out, those of the types that
/// robots log most (`sensor_msgs/JointState`, `Imu`, `Temperature`, `BatteryState`, `std_msgs` numbers and arrays).
/// @throws InputError with file and what was expected
void read_sqlite_bag(const std::string& path, const McapHandlers& handlers);

}  // namespace thermopower::io
