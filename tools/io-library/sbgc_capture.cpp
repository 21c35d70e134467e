// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/sbgc_capture.hpp>

#include <thermopower/io/input_error.hpp>
#include <thermopower/sbgc/codec.hpp>

#include "column_proposal.hpp"
#include "file_source.hpp"
#include "stream_join.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <utility>

namespace thermopower::io {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double deg_per_unit = 360.0 / 16384.0;
constexpr double gyro_dps = 0.06103701895;  // per unit, from the protocol's specification
constexpr double speed_dps = 0.1220740379;  // likewise, of CONTROL
constexpr std::int64_t whole_ns_per_s = 1000000000;

const char* const axis_names[] = {"roll", "pitch", "yaw"};

struct Field {
  std::string name;
  std::function<double(const sbgc::RealtimeData&)> of_telemetry;  ///< empty: it is of CONTROL
  std::function<double(const sbgc::Control&)> of_control;
};

double of_control_mode(const sbgc::AxisControl& axis, bool angle) {
  const int mode = axis.mode & 0x0f;
  using namespace sbgc::control_mode;
  if (angle)
    return mode == sbgc::control_mode::angle || mode == speed_angle || mode == angle_rel_frame
               ? axis.angle * deg_per_unit
               : no_value;
  return mode == speed || mode == speed_angle ? axis.speed * speed_dps : no_value;
}

const std::vector<Field>& fields() {
  static const std::vector<Field> list = [] {
    std::vector<Field> made;
    using Data = sbgc::RealtimeData;
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      const std::string prefix = std::string(axis_names[axis]) + ".";
      const auto add = [&](const char* name, std::function<double(const Data&)> get) {
        made.push_back({prefix + name, std::move(get), {}});
      };
      add("angle_deg", [axis](const Data& d) { return d.imu_angle(axis) * deg_per_unit; });
      add("rate_dps", [axis](const Data& d) { return d.gyro(axis) * gyro_dps; });
      add("target_deg", [axis](const Data& d) { return d.target_angle(axis) * deg_per_unit; });
      add("error_deg", [axis](const Data& d) { return d.error_units(axis) * deg_per_unit; });
      add("frame_deg", [axis](const Data& d) { return d.frame_imu_angle(axis) * deg_per_unit; });
      add("power_param", [axis](const Data& d) { return static_cast<double>(d.motor_power(axis)); });
      add("rotor_deg",
          [axis](const Data& d) { return d.has_extended() ? d.rotor_angle(axis) * deg_per_unit : no_value; });
      add("balance", [axis](const Data& d) {
        return d.has_extended() ? static_cast<double>(d.balance_error(axis)) : no_value;
      });
      made.push_back({prefix + "control_deg", {}, [axis](const sbgc::Control& c) {
                        return of_control_mode(c.axis[axis], true);
                      }});
      made.push_back({prefix + "control_dps", {}, [axis](const sbgc::Control& c) {
                        return of_control_mode(c.axis[axis], false);
                      }});
    }
    const auto add = [&](const char* name, std::function<double(const Data&)> get) {
      made.push_back({name, std::move(get), {}});
    };
    add("supply_V", [](const Data& d) { return d.battery_cV() / 100.0; });
    add("supply_A", [](const Data& d) { return d.has_extended() ? d.current_mA() / 1000.0 : no_value; });
    add("imu_C", [](const Data& d) { return d.has_extended() ? static_cast<double>(d.imu_C()) : no_value; });
    add("frame_imu_C",
        [](const Data& d) { return d.has_extended() ? static_cast<double>(d.frame_imu_C()) : no_value; });
    add("serial_errors", [](const Data& d) { return static_cast<double>(d.serial_errors()); });
    return made;
  }();
  return list;
}

/// Frames of one direction.
class Direction {
public:
  Direction() { samples_.resize(fields().size()); }

  void add(std::int64_t ns, const std::vector<std::uint8_t>& bytes) {
    told_.bytes += bytes.size();
    const auto now_us = static_cast<std::uint32_t>(static_cast<std::uint64_t>(ns / 1000) & 0xffffffffu);
    for (bool got = codec_.poll(now_us); got; got = codec_.next()) take(ns);
    for (const std::uint8_t byte : bytes)
      for (bool got = codec_.receive(byte, now_us); got; got = codec_.next()) take(ns);
  }

  // No more bytes come: whatever is incomplete is lost.
  CapturedDirection finish() {
    const auto& counters = codec_.counters();
    told_.frames = counters.frames;
    told_.lost_bytes = counters.skipped_bytes + codec_.pending();
    told_.broken_frames = counters.header_checksum + counters.invalid_id + counters.too_long +
                          counters.payload_checksum + counters.timeouts;
    return told_;
  }

  std::vector<std::int64_t> telemetry_ns, control_ns;
  /// Of a field, one for each frame that has it.
  const std::vector<double>& samples(std::size_t field) const { return samples_[field]; }

private:
  void take(std::int64_t ns) {
    sbgc::Control control;
    if (const auto* data = codec_.realtime_data()) {
      telemetry_ns.push_back(ns);
      for (std::size_t i = 0; i < fields().size(); ++i)
        if (fields()[i].of_telemetry) samples_[i].push_back(fields()[i].of_telemetry(*data));
    } else if (codec_.read(control)) {
      control_ns.push_back(ns);
      for (std::size_t i = 0; i < fields().size(); ++i)
        if (fields()[i].of_control) samples_[i].push_back(fields()[i].of_control(control));
    }
  }

  SbgcCodec<255, sbgc::ProtocolAuto> codec_{200000};  // blocks are stamped when they are read, often late
  std::vector<std::vector<double>> samples_;
  CapturedDirection told_;
};

struct Capture {
  std::string file;
  Direction directions[2];
  CapturedDirection told[2];
  std::size_t board = 0;  ///< which of the two
  std::int64_t first_ns = 0, last_ns = 0;
};

// Days since 1970 of a date of the common calendar.
std::int64_t days_of(std::int64_t year, std::int64_t month, std::int64_t day) {
  year -= month <= 2 ? 1 : 0;
  const std::int64_t era = year / 400, of_era = year - era * 400;
  const std::int64_t of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
}

class CaptureParser {
public:
  CaptureParser(const std::string& name, const std::string& text) : text_(text) { capture_.file = name; }

  Capture run() {
    for (std::size_t at = 0; at < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      line_ = text_.substr(at, end - at);
      if (!line_.empty() && line_.back() == '\r') line_.pop_back();
      ++number_;
      take_line();
      at = end + 1;
    }
    end_block();
    if (!begun_) fail("no block of bytes; expected a line that begins with '>' or '<'");
    for (int i = 0; i < 2; ++i) capture_.told[i] = capture_.directions[i].finish();
    capture_.board =
        capture_.directions[1].telemetry_ns.size() > capture_.directions[0].telemetry_ns.size() ? 1 : 0;
    return std::move(capture_);
  }

private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(capture_.file + ":" + std::to_string(number_) + ": " + what);
  }

  void take_line() {
    if (line_.empty() || line_ == "--" || line_[0] == '#') return;
    if (line_[0] == '>' || line_[0] == '<') return begin_block();
    if (line_[0] != ' ' || !begun_)
      fail(excerpt(line_) + "; expected '>' or '<' and a time, or a blank and bytes in hexadecimal");
    take_bytes(1);
  }

  void begin_block() {
    end_block();
    direction_ = line_[0] == '>' ? 0 : 1;
    const std::size_t at = line_.find_first_not_of(' ', 1);
    const std::size_t end = at == std::string::npos ? at : std::min(line_.find(' ', at), line_.size());
    if (at == std::string::npos) fail("a direction alone; expected a time after it");
    const bool date = line_.find('/', at) < end;
    const std::int64_t before = now_;
    std::size_t behind = end;
    now_ = date ? time_of_date(at, behind) : time_of_seconds(at, end);
    if (begun_ && now_ < before)
      fail("the time lies before that of the block above; expected blocks in order");
    if (!begun_) capture_.first_ns = now_;
    capture_.last_ns = now_;
    begun_ = true;
    announced_ = none;
    if (date) {
      const std::size_t length = line_.find("length=", behind);
      if (length == std::string::npos)
        fail("a date without 'length='; expected a line as 'socat -x' writes it");
      std::size_t value = 0;
      std::from_chars(line_.data() + length + 7, line_.data() + line_.size(), value);
      announced_ = value;
      announced_in_ = number_;
    } else {
      take_bytes(end);
    }
  }

  std::int64_t time_of_seconds(std::size_t at, std::size_t end) const {
    double seconds = 0.0;
    const auto [last, error] = std::from_chars(line_.data() + at, line_.data() + end, seconds);
    if (error != std::errc() || last != line_.data() + end || !(std::fabs(seconds) < 9e9))
      fail(excerpt(line_.substr(at, end - at)) +
           " is not a time; expected seconds, or a date as 'socat -x' writes it");
    return std::llround(seconds * static_cast<double>(whole_ns_per_s));
  }

  std::int64_t time_of_date(std::size_t at, std::size_t& behind) const {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0, used = 0;
    const char* const from = line_.c_str() + at;
    if (std::sscanf(from, "%4d/%2d/%2d %2d:%2d:%2d%n", &year, &month, &day, &hour, &minute, &second, &used) !=
            6 ||
        month < 1 || month > 12 || day < 1 || day > 31 || hour > 23 || minute > 59 || second > 60 ||
        year < 1970)
      fail("not a date; expected YYYY/MM/DD hh:mm:ss.ffffff as 'socat -x' writes it");
    std::int64_t part = 0, digit = whole_ns_per_s;
    behind = at + static_cast<std::size_t>(used);
    if (behind < line_.size() && line_[behind] == '.')
      for (++behind; behind < line_.size() && line_[behind] >= '0' && line_[behind] <= '9'; ++behind)
        part += (digit /= 10) * (line_[behind] - '0');
    return (days_of(year, month, day) * 86400 + hour * 3600 + minute * 60 + second) * whole_ns_per_s + part;
  }

  // Bytes in hexadecimal, each after one blank; two blanks begin what `socat -v` shows as text.
  void take_bytes(std::size_t at) {
    if (at == 1) at = 0;
    while (at < line_.size() && line_[at] == ' ') {
      ++at;
      if (at >= line_.size() || line_[at] == ' ') return;
      unsigned byte = 0;
      const std::size_t end = std::min(at + 2, line_.size());
      const auto [last, error] = std::from_chars(line_.data() + at, line_.data() + end, byte, 16);
      if (error != std::errc() || last != line_.data() + at + 2)
        fail(excerpt(line_.substr(at, 2)) + " is not a byte; expected two hexadecimal digits");
      bytes_.push_back(static_cast<std::uint8_t>(byte));
      at += 2;
    }
    if (at < line_.size())
      fail(excerpt(line_.substr(at)) + " follows on a byte; expected a blank between bytes");
  }

  void end_block() {
    if (announced_ != none && bytes_.size() != announced_)
      throw InputError(capture_.file + ":" + std::to_string(announced_in_) +
                       ": says length=" + std::to_string(announced_) + " and " +
                       std::to_string(bytes_.size()) + " bytes follow (was the capture cut off?)");
    announced_ = none;
    if (begun_) capture_.directions[direction_].add(now_, bytes_);
    bytes_.clear();
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  const std::string& text_;
  Capture capture_;
  std::string line_;
  std::size_t number_ = 0, direction_ = 0, announced_ = none, announced_in_ = 0;
  std::vector<std::uint8_t> bytes_;
  std::int64_t now_ = 0;
  bool begun_ = false;
};

std::string read_all(FileSource& source) {
  std::string text;
  std::vector<unsigned char> block(65536);
  const ByteSource from = source.function();
  for (std::size_t got = block.size(); got == block.size();) {
    got = from(block.data(), block.size());
    text.append(reinterpret_cast<const char*>(block.data()), got);
  }
  return text;
}

void report_losses(const Capture& capture, std::vector<Finding>& findings) {
  for (std::size_t i = 0; i < 2; ++i) {
    const CapturedDirection& told = capture.told[i];
    if (told.lost_bytes == 0) continue;
    findings.push_back(
        {FindingKind::missing_samples,
         Severity::warning,
         capture.file,
         {},
         std::to_string(told.lost_bytes) + " of " + std::to_string(told.bytes) + " bytes " +
             (i == capture.board ? "from" : "to") + " the board belong to no valid frame (" +
             std::to_string(told.broken_frames) + " beginnings of frames given up, " +
             std::to_string(told.frames) + " frames valid): what was in them is missing",
         "a shorter cable, a lower baud rate, or a capture from the first byte of a frame on"});
  }
}

RecordingFile to_recording(Capture capture, const std::vector<ColumnChoice>& choices) {
  const auto fail = [&](const std::string& what) { throw InputError(capture.file + ": " + what); };
  Direction& board = capture.directions[capture.board];
  Direction& host = capture.directions[1 - capture.board];
  if (board.telemetry_ns.empty())
    fail("no telemetry in either direction; expected frames REALTIME_DATA_3 or REALTIME_DATA_4");
  Stream telemetry{"telemetry", board.telemetry_ns, {}}, control{"CONTROL", host.control_ns, {}};
  if (choices.empty())
    fail(
        "no field is asked for; 'thermopower-gap columns' proposes which are (--column angle_deg=pitch.angle_deg, --map FILE)");
  for (const ColumnChoice& choice : choices) {
    const auto found = std::find_if(fields().begin(), fields().end(),
                                    [&](const Field& one) { return one.name == choice.header; });
    if (found == fields().end())
      fail("column '" + choice.name + "': there is no field " + excerpt(choice.header) +
           (choice.name == "t_s" ? "; time is that of the capture"
                                 : "; 'thermopower-gap columns' lists them"));
    const bool of_board = static_cast<bool>(found->of_telemetry);
    const auto& samples =
        (of_board ? board : host).samples(static_cast<std::size_t>(found - fields().begin()));
    if (std::all_of(samples.begin(), samples.end(), [](double value) { return std::isnan(value); }))
      fail("column '" + choice.name + "': " + excerpt(choice.header) + " is in none of " +
           std::to_string(samples.size()) +
           (of_board ? " frames of telemetry (only REALTIME_DATA_4 has all fields)" : " frames CONTROL"));
    StreamColumn column{choice.name, samples};
    for (double& value : column.values) value = value_of(choice, value);
    (of_board ? telemetry : control).columns.push_back(std::move(column));
  }
  std::vector<Stream> streams;
  for (Stream* one : {&telemetry, &control})
    if (!one->columns.empty()) streams.push_back(std::move(*one));
  std::vector<Finding> findings;
  report_losses(capture, findings);
  CsvTable table = join_streams(capture.file, std::move(streams), findings);
  if (table.rows == 0) fail("there is no time at which telemetry and commands are both known");
  RecordingFile file = io::to_recording(std::move(table));
  file.findings.insert(file.findings.begin(), findings.begin(), findings.end());
  return file;
}

SbgcCaptureContents to_contents(const Capture& capture) {
  SbgcCaptureContents contents;
  const Direction& board = capture.directions[capture.board];
  const Direction& host = capture.directions[1 - capture.board];
  contents.file = capture.file;
  contents.from_board = capture.told[capture.board];
  contents.to_board = capture.told[1 - capture.board];
  contents.telemetry = board.telemetry_ns.size();
  contents.control = host.control_ns.size();
  contents.duration_s = static_cast<double>(capture.last_ns - capture.first_ns) / 1e9;
  double widest = -1.0;
  std::string most;
  for (std::size_t i = 0; i < fields().size(); ++i) {
    const Field& field = fields()[i];
    ListedColumn column;
    column.header = field.name;
    for (const double value : (field.of_telemetry ? board : host).samples(i)) {
      if (std::isnan(value)) {
        ++column.missing;
        continue;
      }
      column.least = column.samples == 0 ? value : std::min(column.least, value);
      column.greatest = column.samples == 0 ? value : std::max(column.greatest, value);
      ++column.samples;
    }
    const std::size_t point = field.name.find('.');
    if (point != std::string::npos && field.name.compare(point, 10, ".angle_deg") == 0 &&
        column.greatest - column.least > widest)
      widest = column.greatest - column.least, most = field.name.substr(0, point);
    contents.columns.push_back(std::move(column));
  }
  for (ListedColumn& column : contents.columns) {
    const std::size_t point = column.header.find('.');
    const std::string name = point == std::string::npos ? column.header : column.header.substr(point + 1);
    const bool known = name == "angle_deg" || name == "rate_dps" || name == "target_deg" ||
                       name == "power_param" || name == "supply_V";
    if (known && column.samples > 0 &&
        (point == std::string::npos || column.header.substr(0, point) == most)) {
      column.proposed = name;
      column.why = point == std::string::npos ? "telemetry" : "the axis that moves most";
    } else {
      column.why =
          known && point != std::string::npos ? "of another axis" : "left out unless it is asked for";
    }
  }
  return contents;
}

}  // namespace

bool is_sbgc_capture(const std::string& path) {
  const int first = first_byte_of(path);
  return first == '>' || first == '<';
}

RecordingFile parse_sbgc_capture(const std::string& name, const std::string& text,
                                 const std::vector<ColumnChoice>& choices) {
  return to_recording(CaptureParser(name, text).run(), choices);
}

RecordingFile read_sbgc_capture(const std::string& path, const std::vector<ColumnChoice>& choices) {
  FileSource source(path);
  return parse_sbgc_capture(source.name(), read_all(source), choices);
}

SbgcCaptureContents list_sbgc_capture(const std::string& name, const std::string& text) {
  return to_contents(CaptureParser(name, text).run());
}

SbgcCaptureContents list_sbgc_capture(const std::string& path) {
  FileSource source(path);
  return list_sbgc_capture(source.name(), read_all(source));
}

std::string capture_text(const SbgcCaptureContents& contents) {
  char row[300];
  std::snprintf(row, sizeof row,
                "  serial line of a SimpleBGC board, %.4g s: %zu frames of telemetry, %zu CONTROL\n",
                contents.duration_s, contents.telemetry, contents.control);
  std::string out = row;
  for (const CapturedDirection* one : {&contents.from_board, &contents.to_board}) {
    std::snprintf(row, sizeof row,
                  "  %-14s %zu bytes, %zu valid frames, %zu bytes lost, %zu beginnings of frames given up\n",
                  one == &contents.from_board ? "from the board" : "to the board", one->bytes, one->frames,
                  one->lost_bytes, one->broken_frames);
    out += row;
  }
  return out;
}

std::string columns_text(const SbgcCaptureContents& contents) {
  return capture_text(contents) + "\n" + list_text(contents.columns) +
         next_text(contents.file, contents.columns, false);
}

}  // namespace thermopower::io
