// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/joint.hpp>
#include <thermopower/robot/log.hpp>

#include <string>
#include <utility>
#include <vector>

namespace thermopower::robot {

/// @brief Reads the log of a whole robot from a CSV or MCAP file. Names are matched as NameMatcher does.
///
/// Time is the column `t_s`, `time_s`, `time`, `t`, `timestamp` or one with `_ms`, `_us`, `_ns` behind. Where it falls back, a new run
/// starts.
/// @param renamed  pairs of a joint's name in the log and in the model
/// @throws io::InputError with the file and what was expected: no time, no position of any joint
Log read_robot_log(const std::string& path, const Robot& robot,
                   const std::vector<std::pair<std::string, std::string>>& renamed = {});

}  // namespace thermopower::robot
