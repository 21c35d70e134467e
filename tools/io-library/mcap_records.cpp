// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "mcap_records.hpp"

#include <thermopower/io/input_error.hpp>

#include "chunk_compression.hpp"
#include "crc32.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace thermopower::io {
namespace {

constexpr unsigned char magic[8] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::uint64_t largest_chunk = std::uint64_t{1} << 30;  // unpacked; writers take some megabytes
constexpr std::size_t read_at_once = std::size_t{1} << 20;

enum Opcode : unsigned char {
  header_op = 0x01,
  footer_op = 0x02,
  schema_op = 0x03,
  channel_op = 0x04,
  message_op = 0x05,
  chunk_op = 0x06,
  data_end_op = 0x0f
};

std::uint64_t little_endian(const unsigned char* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i > 0; --i) value = value << 8 | bytes[i - 1];
  return value;
}

class Reader {
public:
  Reader(const std::string& name, const ByteSource& source, const McapHandlers& handlers)
      : name_(name), source_(source), handlers_(handlers) {}

  void run() {
    unsigned char start[sizeof magic];
    const std::size_t got = take(start, sizeof start);
    if (!begins_like_mcap(start, got))
      throw InputError(
          name_ +
          ": byte 0: not an MCAP file, and no CSV text or SimpleBGC capture; expected it to begin with 0x89 'MCAP0'");
    while (record()) {
    }
  }

private:
  // Fields of one record, front to back.
  class Fields {
  public:
    Fields(const Reader& reader, const McapPlace& place, const char* record, ByteView bytes)
        : reader_(reader), place_(place), record_(record), bytes_(bytes) {}
    std::uint64_t number(std::size_t size, const char* what) {
      return little_endian(raw(size, what).data, size);
    }
    std::string text(const char* what) {
      const ByteView view = raw(number(4, what), what);
      return std::string(reinterpret_cast<const char*>(view.data), view.size);
    }
    ByteView raw(std::uint64_t size, const char* what) {
      if (size > bytes_.size - at_)
        reader_.fail(place_, std::string(record_) + " of " + std::to_string(bytes_.size) +
                                 " bytes ends inside its " + what + ", which takes " + std::to_string(size) +
                                 " from its byte " + std::to_string(at_) + " on");
      const ByteView view{bytes_.data + at_, static_cast<std::size_t>(size)};
      at_ += view.size;
      return view;
    }
    ByteView rest() const { return {bytes_.data + at_, bytes_.size - at_}; }

  private:
    const Reader& reader_;
    const McapPlace& place_;
    const char* record_;
    ByteView bytes_;
    std::size_t at_ = 0;
  };

  [[noreturn]] void fail(const McapPlace& place, const std::string& what) const {
    throw InputError(name_ + ": " + place.text() + ": " + what);
  }

  [[noreturn]] void fail_cut_off(std::uint64_t record_at) const {
    McapPlace place;
    place.byte = record_at;
    fail(place, "the file ends inside the record that starts here, after " + std::to_string(messages_) +
                    " messages (was the recording cut off? 'mcap recover' keeps what is whole)");
  }

  std::size_t take(unsigned char* to, std::size_t size) {
    const std::size_t got = source_(to, size);
    // The sum covers what comes before the record that holds it.
    sum_before_record_ = in_head_ ? sum_.value() : sum_before_record_;
    sum_.add(to, got);
    at_ += got;
    return got;
  }

  // Reads one record of the file; false at its end.
  bool record() {
    McapPlace place;
    place.byte = at_;
    unsigned char head[9];
    in_head_ = true;
    const std::size_t got = take(head, sizeof head);
    in_head_ = false;
    if (got == 0 && data_ended_) return false;
    if (got == sizeof magic && data_ended_ && std::memcmp(head, magic, sizeof magic) == 0) return false;
    if (got < sizeof head) {
      if (data_ended_) return false;  // cut off in the index, which nobody needs: all data are here
      fail_cut_off(place.byte);
    }
    const std::uint64_t size = little_endian(head + 1, 8);
    const bool wanted =
        !data_ended_ && (head[0] == schema_op || head[0] == channel_op || head[0] == message_op ||
                         head[0] == chunk_op || head[0] == data_end_op);
    if (head[0] == 0) fail(place, "a record of kind 0; expected a kind from 1 on (is the file damaged?)");
    body_.clear();
    for (std::uint64_t left = size; left > 0;) {
      const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(left, read_at_once));
      const std::size_t from = wanted ? body_.size() : 0;
      if (body_.size() < from + part) body_.resize(from + part);
      if (take(body_.data() + from, part) < part) {
        if (data_ended_) return false;
        fail_cut_off(place.byte);
      }
      left -= part;
    }
    if (head[0] == footer_op) {
      if (!data_ended_)
        fail(place, "the footer comes before the end of the data; expected a record of kind 15 first");
      return false;
    }
    if (!wanted) return true;
    const ByteView body{body_.data(), static_cast<std::size_t>(size)};
    if (head[0] == chunk_op) chunk(place, body);
    else if (head[0] == data_end_op) data_end(place, body);
    else item(head[0], place, body);
    return true;
  }

  void data_end(const McapPlace& place, ByteView body) {
    Fields fields(*this, place, "end of the data", body);
    const auto sum = static_cast<std::uint32_t>(fields.number(4, "check sum"));
    data_ended_ = true;
    if (sum != 0 && sum != sum_before_record_)
      fail(place, "the check sum of all data before this byte is wrong; the file is damaged");
  }

  void chunk(const McapPlace& place, ByteView body) {
    Fields fields(*this, place, "chunk", body);
    fields.number(8, "start");
    fields.number(8, "end");
    const std::uint64_t size = fields.number(8, "size");
    const auto sum = static_cast<std::uint32_t>(fields.number(4, "check sum"));
    const std::string compression = fields.text("compression");
    const ByteView packed = fields.raw(fields.number(8, "records"), "records");
    if (size > largest_chunk)
      fail(place, "a chunk that says to unpack to " + std::to_string(size) + " bytes; expected at most " +
                      std::to_string(largest_chunk));
    const std::string fault =
        unpack_chunk(compression, packed.data, packed.size, static_cast<std::size_t>(size), chunk_);
    if (!fault.empty()) fail(place, "the chunk cannot be read: " + fault);
    if (sum != 0) {
      Crc32 actual;
      actual.add(chunk_.data(), chunk_.size());
      if (actual.value() != sum) fail(place, "the check sum of the chunk is wrong; the file is damaged");
    }
    McapPlace inside = place;
    inside.in_chunk = true;
    for (std::size_t at = 0; at < chunk_.size();) {
      inside.chunk_byte = at;
      const std::size_t left = chunk_.size() - at;
      const std::uint64_t length = left < 9 ? 0 : little_endian(chunk_.data() + at + 1, 8);
      if (left < 9 || length > left - 9) fail(inside, "the chunk ends inside the record that starts here");
      item(chunk_[at], inside, {chunk_.data() + at + 9, static_cast<std::size_t>(length)});
      at += 9 + static_cast<std::size_t>(length);
    }
  }

  void item(unsigned char kind, const McapPlace& place, ByteView body) {
    if (kind == schema_op) {
      Fields fields(*this, place, "schema", body);
      McapSchema schema;
      schema.id = static_cast<std::uint16_t>(fields.number(2, "id"));
      schema.name = fields.text("name");
      schema.encoding = fields.text("encoding");
      schema.text = fields.raw(fields.number(4, "text"), "text");
      if (schema.id == 0) fail(place, "a schema with id 0; expected an id from 1 on");
      handlers_.schema(schema);
    } else if (kind == channel_op) {
      Fields fields(*this, place, "channel", body);
      McapChannel channel;
      channel.id = static_cast<std::uint16_t>(fields.number(2, "id"));
      channel.schema = static_cast<std::uint16_t>(fields.number(2, "schema's id"));
      channel.topic = fields.text("topic");
      channel.encoding = fields.text("encoding");
      handlers_.channel(channel);
    } else if (kind == message_op) {
      Fields fields(*this, place, "message", body);
      McapMessage message;
      message.channel = static_cast<std::uint16_t>(fields.number(2, "channel"));
      fields.number(4, "sequence");
      message.log_ns = fields.number(8, "log time");
      message.publish_ns = fields.number(8, "publish time");
      message.data = fields.rest();
      message.place = place;
      handlers_.message(message);
      ++messages_;
    } else if (kind == chunk_op) {
      fail(place, "a chunk inside a chunk");
    }
  }

  const std::string& name_;
  const ByteSource& source_;
  const McapHandlers& handlers_;
  std::vector<unsigned char> body_, chunk_;
  Crc32 sum_;
  std::uint32_t sum_before_record_ = 0;
  std::uint64_t at_ = 0, messages_ = 0;
  bool data_ended_ = false, in_head_ = false;
};

}  // namespace

std::string McapPlace::text() const {
  if (!in_chunk) return "byte " + std::to_string(byte);
  return "chunk at byte " + std::to_string(byte) + ", byte " + std::to_string(chunk_byte) +
         " of what it unpacks to";
}

bool begins_like_mcap(const unsigned char* bytes, std::size_t size) {
  return size >= sizeof magic && std::memcmp(bytes, magic, sizeof magic) == 0;
}

void read_mcap_records(const std::string& name, const ByteSource& source, const McapHandlers& handlers) {
  Reader(name, source, handlers).run();
}

}  // namespace thermopower::io
