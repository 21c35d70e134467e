// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "log_text.hpp"
#include "stream_join.hpp"

#include <thermopower/io/input_error.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

namespace thermopower::io {
namespace {

struct Frame {
  std::uint32_t id = 0;
  std::int64_t ns = 0;
  std::vector<unsigned char> bytes;
};

bool read_hex(const std::string& text, std::uint32_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return error == std::errc() && end == text.data() + text.size();
}

bool read_bytes(const std::string& hex, std::vector<unsigned char>& bytes) {
  if (hex.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    std::uint32_t byte = 0;
    if (!read_hex(hex.substr(i, 2), byte)) return false;
    bytes.push_back(static_cast<unsigned char>(byte));
  }
  return true;
}

// Seconds and a fraction, exactly.
bool read_ns(const std::string& text, std::int64_t& ns) {
  const std::size_t point = text.find('.');
  std::int64_t seconds = 0, fraction = 0;
  const std::string whole = text.substr(0, point);
  if (std::from_chars(whole.data(), whole.data() + whole.size(), seconds).ec != std::errc()) return false;
  std::string digits = point == std::string::npos ? "0" : text.substr(point + 1, 9);
  digits.resize(9, '0');
  if (std::from_chars(digits.data(), digits.data() + 9, fraction).ec != std::errc()) return false;
  ns = seconds * 1000000000 + fraction;
  return true;
}

std::vector<Frame> frames_of(const std::string& name, const std::string& text) {
  std::vector<Frame> frames;
  std::istringstream in(text);
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    std::istringstream words(line);
    std::vector<std::string> word;
    for (std::string one; words >> one;) word.push_back(one);
    if (word.empty()) continue;
    const auto fail = [&](const std::string& what) {
      throw InputError(
          name + ":" + std::to_string(number) + ": " + what +
          "; expected a frame as 'candump -l' or 'candump -ta' writes it: (1700000000.000000) can0 141#A100000000150000");
    };
    if (word[0].front() != '(' || word[0].back() != ')' || word.size() < 3) fail("no time in this line");
    Frame frame;
    if (!read_ns(word[0].substr(1, word[0].size() - 2), frame.ns))
      fail(excerpt(word[0]) + " is not a time in seconds");
    const std::size_t mark = word[2].find('#');
    if (mark != std::string::npos) {
      const bool fd = mark + 1 < word[2].size() && word[2][mark + 1] == '#';
      std::string data = word[2].substr(mark + (fd ? 3 : 1));
      if (!data.empty() && data[0] == 'R') continue;  // a request, which holds nothing
      if (!read_hex(word[2].substr(0, mark), frame.id) || !read_bytes(data, frame.bytes))
        fail(excerpt(word[2]) + " is not a frame");
    } else {
      std::string data;
      for (std::size_t i = 4; i < word.size(); ++i) data += word[i].size() == 2 ? word[i] : std::string();
      if (!read_hex(word[2], frame.id) || !read_bytes(data, frame.bytes)) fail("no frame in this line");
    }
    frames.push_back(std::move(frame));
  }
  if (frames.empty()) throw InputError(name + ": no frame of a CAN bus");
  return frames;
}

/// Where a number stands in the frames of one identifier.
struct BusSignal {
  std::uint32_t id = 0;
  std::optional<unsigned char> first_byte;
  char kind = 'u';  // u, i, f
  int bits = 8;
  bool big_endian = false;
  std::size_t at = 0;
};

// `141#A1.i16be@4`
std::optional<BusSignal> parse_signal(const std::string& header) {
  BusSignal signal;
  const std::size_t point = header.find('.'), at = header.find('@');
  if (point == std::string::npos || at == std::string::npos || at < point) return std::nullopt;
  std::string frame = header.substr(0, point), type = header.substr(point + 1, at - point - 1);
  const std::string byte = header.substr(at + 1);
  if (const std::size_t mark = frame.find('#'); mark != std::string::npos) {
    std::uint32_t first = 0;
    if (!read_hex(frame.substr(mark + 1), first) || first > 255) return std::nullopt;
    signal.first_byte = static_cast<unsigned char>(first);
    frame.resize(mark);
  }
  if (!read_hex(frame, signal.id)) return std::nullopt;
  if (type.size() > 2 && type.compare(type.size() - 2, 2, "be") == 0) {
    signal.big_endian = true;
    type.resize(type.size() - 2);
  }
  static const std::set<std::string> types = {"u8", "i8", "u16", "i16", "u32", "i32", "f32"};
  if (types.count(type) == 0) return std::nullopt;
  signal.kind = type[0];
  signal.bits = std::atoi(type.c_str() + 1);
  const auto [end, error] = std::from_chars(byte.data(), byte.data() + byte.size(), signal.at);
  if (error != std::errc() || end != byte.data() + byte.size() || signal.at > 63) return std::nullopt;
  return signal;
}

bool is_of(const BusSignal& signal, const Frame& frame) {
  return frame.id == signal.id &&
         frame.bytes.size() >= signal.at + static_cast<std::size_t>(signal.bits / 8) &&
         (!signal.first_byte || (!frame.bytes.empty() && frame.bytes[0] == *signal.first_byte));
}

double value_in(const BusSignal& signal, const Frame& frame) {
  std::uint32_t raw = 0;
  const int count = signal.bits / 8;
  for (int i = 0; i < count; ++i) {
    const int place = signal.big_endian ? count - 1 - i : i;
    raw |= static_cast<std::uint32_t>(frame.bytes[signal.at + static_cast<std::size_t>(i)]) << (8 * place);
  }
  if (signal.kind == 'f') {
    float value = 0.0f;
    std::memcpy(&value, &raw, sizeof value);
    return static_cast<double>(value);
  }
  if (signal.kind == 'i' && (raw >> (signal.bits - 1)) != 0)
    return static_cast<double>(raw) - std::ldexp(1.0, signal.bits);
  return static_cast<double>(raw);
}

std::string hex(std::uint32_t value, const char* format = "%X") {
  char text[16];
  std::snprintf(text, sizeof text, format, static_cast<unsigned>(value));
  return text;
}

ListedColumn changes(const std::string& header, const std::vector<const Frame*>& of) {
  const BusSignal signal = *parse_signal(header);
  ListedColumn column;
  column.header = header;
  column.why = "--column NAME=" + header + ":UNIT*SIZE takes it";
  for (const Frame* frame : of) {
    if (!is_of(signal, *frame)) continue;
    const double value = value_in(signal, *frame);
    column.least = column.samples == 0 ? value : std::min(column.least, value);
    column.greatest = column.samples == 0 ? value : std::max(column.greatest, value);
    ++column.samples;
  }
  return column;
}

// How far a number goes from frame to frame.
double roughness(const std::string& header, const std::vector<const Frame*>& of) {
  const BusSignal signal = *parse_signal(header);
  double sum = 0.0, before = std::nan("");
  for (const Frame* frame : of) {
    if (!is_of(signal, *frame)) continue;
    const double value = value_in(signal, *frame);
    if (std::isfinite(before)) sum += std::fabs(value - before);
    before = value;
  }
  return sum;
}

}  // namespace

RecordingFile candump_as_recording(const std::string& name, const std::string& text,
                                   const std::vector<ColumnChoice>& choices) {
  const std::vector<Frame> frames = frames_of(name, text);
  if (choices.empty())
    throw InputError(
        name +
        ": frames of a CAN bus say nothing of what is in them; expected a mapping, such as --column drive_A=141#A1.i16@4:A*0.01 ('thermopower-gap columns' lists what changes)");
  std::map<std::string, Stream> streams;
  for (const ColumnChoice& choice : choices) {
    const auto fail = [&](const std::string& what) {
      throw InputError(name + ": column '" + choice.name + "': " + what);
    };
    if (choice.name == "t_s") fail("time is that of the frames");
    const auto signal = parse_signal(choice.header);
    if (!signal)
      fail(
          excerpt(choice.header) +
          " is not a place in a frame; expected identifier, type and byte, such as 141.i16@4, or 141#A1.i16@4 for frames that begin with A1 (u8 i8 u16 i16 u32 i32 f32, and be behind it for the high byte first)");
    const std::string of = choice.header.substr(0, choice.header.find('.'));
    Stream& stream = streams[of];
    stream.name = of;
    StreamColumn column{choice.name, {}};
    std::vector<std::int64_t> times;
    for (const Frame& frame : frames) {
      if (frame.id != signal->id ||
          (signal->first_byte && (frame.bytes.empty() || frame.bytes[0] != *signal->first_byte)))
        continue;
      times.push_back(frame.ns);
      column.values.push_back(is_of(*signal, frame) ? value_of(choice, value_in(*signal, frame))
                                                    : std::nan(""));
    }
    if (std::none_of(column.values.begin(), column.values.end(),
                     [](double value) { return std::isfinite(value); }))
      fail("no frame of " + of + " has a number at byte " + std::to_string(signal->at));
    stream.time_ns = times;
    stream.columns.push_back(std::move(column));
  }
  std::vector<Stream> list;
  for (auto& [of, stream] : streams) list.push_back(std::move(stream));
  std::vector<Finding> findings;
  CsvTable table = join_streams(name, std::move(list), findings);
  if (table.rows == 0) throw InputError(name + ": there is no time at which all inputs are known");
  RecordingFile file = to_recording(std::move(table));
  file.findings.insert(file.findings.begin(), findings.begin(), findings.end());
  return file;
}

std::vector<ListedColumn> list_candump(const std::string& name, const std::string& text, std::string& about) {
  const std::vector<Frame> frames = frames_of(name, text);
  constexpr std::size_t few = 8;  // first bytes of an identifier that are kinds of frames
  std::map<std::uint32_t, std::set<unsigned char>> first_bytes;
  for (const Frame& frame : frames)
    if (!frame.bytes.empty()) first_bytes[frame.id].insert(frame.bytes[0]);
  std::map<std::string, std::vector<const Frame*>> kinds;
  for (const Frame& frame : frames) {
    const bool by_first =
        !frame.bytes.empty() && frame.bytes.size() > 2 && first_bytes[frame.id].size() <= few;
    kinds[hex(frame.id) + (by_first ? "#" + hex(frame.bytes[0], "%02X") : std::string())].push_back(&frame);
  }
  std::vector<ListedColumn> list;
  about = "  frames of a CAN bus                 count     per s\n";
  for (const auto& [kind, of] : kinds) {
    char row[96];
    const double span = static_cast<double>(of.back()->ns - of.front()->ns) / 1e9;
    std::snprintf(row, sizeof row, "  %-28s%13zu%10.5g\n", kind.c_str(), of.size(),
                  span > 0.0 ? static_cast<double>(of.size() - 1) / span : 0.0);
    about += row;
    const std::size_t begin = kind.find('#') == std::string::npos ? 0 : 1;
    const std::size_t size = of.front()->bytes.size();
    for (std::size_t at = begin; at < size; ++at) {
      const bool pair = (at % 2 == 0) && at + 1 < size;
      if (!pair && at % 2 == 1 && at > begin) continue;  // the second half of a pair
      ListedColumn column = changes(kind + (pair ? ".i16@" : ".u8@") + std::to_string(at), of);
      if (pair) {
        // The byte order in which the number changes more smoothly.
        ListedColumn other = changes(kind + ".i16be@" + std::to_string(at), of);
        if (roughness(other.header, of) < roughness(column.header, of)) column = std::move(other);
      }
      if (column.samples > 0 && column.greatest > column.least) list.push_back(std::move(column));
    }
  }
  return list;
}

}  // namespace thermopower::io
