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

/// @brief What one direction of a captured serial line came to.
struct CapturedDirection {
  std::size_t bytes = 0;       ///< captured
  std::size_t frames = 0;      ///< valid frames
  std::size_t lost_bytes = 0;  ///< that belong to no valid frame
  std::size_t broken_frames =
      0;  ///< beginnings of frames that were given up (a check sum, a pause, a wrong length)
};

/// @brief What a capture of the serial line of a SimpleBGC board holds.
struct SbgcCaptureContents {
  std::string file;                   ///< path
  CapturedDirection from_board;       ///< the direction that telemetry comes from
  CapturedDirection to_board;         ///< the other one
  std::size_t telemetry = 0;          ///< frames REALTIME_DATA_3 and _4
  std::size_t control = 0;            ///< frames CONTROL
  double duration_s = 0.0;            ///< from the first block of bytes to the last one
  std::vector<ListedColumn> columns;  ///< the fields, with proposals for the axis that moves most
};

/// @brief Whether a file (`-`: standard input) begins like a capture, with `>` or `<`. Nothing is consumed.
bool is_sbgc_capture(const std::string& path);

/// @brief Lists the fields of a capture. @throws InputError, see read_sbgc_capture()
SbgcCaptureContents list_sbgc_capture(const std::string& path);

/// @brief The contents as text for a person, with the options `--column` that take the proposals.
std::string columns_text(const SbgcCaptureContents& contents);

/// @brief Reads a recording of one axis of a gimbal from a capture of its serial line, both directions.
///
/// Two forms of text, one block of bytes after the other, may be mixed:
///
///     > 2026/11/22 14:00:00.123456  length=4 from=0 to=3      as `socat -x` writes to its standard error;
///      3e 19 00 19                                             the bytes in the lines below
///     < 12.345678 3e 19 7c 95 ...                             seconds on any clock and the bytes, in hexadecimal
///
/// `>` and `<` are the two directions; which of them the board speaks is told by its telemetry. Frames of protocol versions 1 and 2
/// are found by SbgcCodec, damaged ones are skipped, and what was lost is a finding. A frame's time is that of the block
/// with its last byte.
///
/// Fields are chosen like columns: `pitch.angle_deg`, `pitch.rate_dps`, `pitch.target_deg`, `pitch.error_deg`, `pitch.frame_deg`,
/// `pitch.rotor_deg`, `pitch.power_param`, `pitch.balance` (telemetry), `pitch.control_deg`, `pitch.control_dps` (what the host commanded), likewise `roll.` and
/// `yaw.`, and `supply_V`, `supply_A` (drawn by all motors), `imu_C`, `frame_imu_C`. Telemetry and commands are joined as the topics of an
/// MCAP file are, see read_mcap().
/// @throws InputError with file and line and what was expected
RecordingFile read_sbgc_capture(const std::string& path, const std::vector<ColumnChoice>& choices);

/// @brief The same on a text in memory; `name` stands in messages where a path would.
RecordingFile parse_sbgc_capture(const std::string& name, const std::string& text,
                                 const std::vector<ColumnChoice>& choices);

/// @brief The list of a text in memory.
SbgcCaptureContents list_sbgc_capture(const std::string& name, const std::string& text);

}  // namespace thermopower::io
