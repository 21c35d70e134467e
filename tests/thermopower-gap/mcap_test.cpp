// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// MCAP files as the writers of others leave them (tests/data/mcap), and files that are damaged.

#include "../catch.hpp"
#include "../../tools/thermopower-gap/text_file.hpp"

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/mcap_file.hpp>
#include <thermopower/io/recording_file.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>

using namespace thermopower::gap;
namespace io = thermopower::io;

namespace {

const std::string folder = THERMOPOWER_TEST_DATA "/mcap/";

std::vector<io::ColumnChoice> choices(const std::vector<std::string>& texts) {
  std::vector<io::ColumnChoice> list;
  for (const std::string& text : texts) list.push_back(io::parse_column_choice(text));
  return list;
}

// What the fields are, of the recording and of the table that was written beside it.
const std::vector<std::string> of_mcap = {"angle_deg=/joint_states.position[elbow]:rad",
                                          "rate_dps=/joint_states.velocity[wrist]:-rad/s",
                                          "gyro=/imu.angular_velocity.z",
                                          "motor_C=/motor/temperature.temperature:K",
                                          "supply_V=/battery.voltage",
                                          "drive_A=/elbow/command.data:mA"};
const std::vector<std::string> of_csv = {"t_s=t",          "angle_deg=angle:rad", "rate_dps=rate:-rad/s",
                                         "motor_C=temp:K", "supply_V=volts",      "drive_A=amps:mA"};

std::vector<std::string> without_command(std::vector<std::string> list) {
  list.pop_back();
  return list;
}

bool same_bits(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0;
}

void check_same(const Recording& a, const Recording& b) {
  REQUIRE(a.rows() == b.rows());
  std::size_t differing = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) differing += same_bits(a.t_s[i], b.t_s[i]) ? 0 : 1;
  CHECK(differing == 0);
  REQUIRE(a.columns.size() == b.columns.size());
  for (const Column& column : a.columns) {
    CAPTURE(column.name);
    REQUIRE(b.find(column.name) != nullptr);
    const Eigen::VectorXd& other = *b.find(column.name);
    differing = 0;
    for (Eigen::Index i = 0; i < a.rows(); ++i) differing += same_bits(column.values[i], other[i]) ? 0 : 1;
    CHECK(differing == 0);
  }
}

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string error_of_bytes(const std::string& bytes, const std::vector<std::string>& columns = of_mcap) {
  return error_of([&] { io::parse_mcap("a.mcap", bytes.data(), bytes.size(), choices(columns)); });
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// An MCAP file written by hand, from its specification.
struct Written {
  std::string bytes = "\x89MCAP0\r\n";
  static std::string number(std::uint64_t value, int size) {
    std::string out;
    for (int i = 0; i < size; ++i) out += static_cast<char>(i < 8 ? value >> 8 * i & 0xff : 0);
    return out;
  }
  static std::string text(const std::string& value) { return number(value.size(), 4) + value; }
  static std::string record(int kind, const std::string& body) {
    return static_cast<char>(kind) + number(body.size(), 8) + body;
  }
  void add(int kind, const std::string& body) { bytes += record(kind, body); }
  void schema(int id, const std::string& name, const std::string& definition,
              const std::string& encoding = "ros2msg") {
    add(3, number(static_cast<std::uint64_t>(id), 2) + text(name) + text(encoding) + text(definition));
  }
  static std::string channel_body(int id, int schema, const std::string& topic, const std::string& encoding) {
    return number(static_cast<std::uint64_t>(id), 2) + number(static_cast<std::uint64_t>(schema), 2) +
           text(topic) + text(encoding) + number(0, 4);
  }
  void channel(int id, int schema, const std::string& topic, const std::string& encoding) {
    add(4, channel_body(id, schema, topic, encoding));
  }
  static std::string message_body(int channel, std::uint64_t ns, const std::string& data) {
    return number(static_cast<std::uint64_t>(channel), 2) + number(0, 4) + number(ns, 8) + number(ns, 8) +
           data;
  }
  void message(int channel, std::uint64_t ns, const std::string& data) {
    add(5, message_body(channel, ns, data));
  }
  std::string end() {
    add(15, number(0, 4));
    add(2, number(0, 20));
    return bytes + "\x89MCAP0\r\n";
  }
};

Recording read(const std::string& bytes, const std::vector<std::string>& columns) {
  return io::parse_mcap("a.mcap", bytes.data(), bytes.size(), choices(columns)).recording;
}

std::vector<double> column(const Recording& recording, const char* name) {
  const Eigen::VectorXd& values = recording.column(name);
  return std::vector<double>(values.data(), values.data() + values.size());
}

}  // namespace

TEST_CASE("recordings of others' writers give the bits of the table with the same numbers") {
  const Recording expected = io::read_recording(folder + "arm.csv", choices(of_csv)).recording;
  REQUIRE(expected.rows() > 180);
  for (const char* file : {"cdr_plain", "cdr_chunks", "json_zstd", "cdr_zstd", "cdr_lz4"}) {
    CAPTURE(file);
    const bool packed = has(file, "zstd") || has(file, "lz4");
#if !defined(THERMOPOWER_HAS_ZSTD) || !defined(THERMOPOWER_HAS_LZ4)
    if (packed) continue;
#endif
    (void)packed;
    const auto read = io::read_recording(folder + file + ".mcap", choices(of_mcap));
    CHECK_FALSE(read.recording.validate());
    check_same(expected, read.recording);
    // The table says which rows were left out; the reader must, too.
    CHECK(std::any_of(read.findings.begin(), read.findings.end(),
                      [](const Finding& one) { return has(one.message, "are left out"); }));
  }
}

#if defined(THERMOPOWER_HAS_LZ4)
TEST_CASE("time is when something was measured, where all messages tell") {
  const Recording expected =
      io::read_recording(folder + "stamped.csv", choices(without_command(of_csv))).recording;
  Recording with_command =
      io::read_mcap(folder + "stamped_lz4.mcap", choices(without_command(of_mcap))).recording;
  Recording cleaned = expected;
  cleaned.remove("amps");
  check_same(cleaned, with_command);
}
#endif

TEST_CASE("rows are the messages' times, measured values are never held and inputs always") {
  Written file;
  file.channel(1, 0, "/drive", "json");
  file.channel(2, 0, "/enc", "json");
  file.message(2, 1000000000, R"({"a": 1.5})");
  file.message(1, 1010000000, R"({"amps": 0.25, "other": [1, {"x": "y"}]})");
  file.message(2, 1020000000, R"({"a": 2.5, "more": null})");
  file.message(1, 1030000000, R"({"amps": -0.5})");
  file.message(2, 1030000000, R"({"a": null})");
  file.message(2, 1050000000, R"({})");
  const Recording recording = read(file.end(), {"drive_A=/drive.amps", "angle_deg=/enc.a"});
  const double nan = std::nan("");
  const std::vector<double> t = {0.0, 0.01, 0.02, 0.04}, amps = {0.25, 0.25, -0.5, -0.5},
                            angle = {nan, 2.5, nan, nan};
  REQUIRE(recording.rows() == 4);
  for (Eigen::Index i = 0; i < 4; ++i) {
    CHECK(recording.t_s[i] == t[static_cast<std::size_t>(i)]);
    CHECK(same_bits(recording.column("drive_A")[i], amps[static_cast<std::size_t>(i)]));
    CHECK(same_bits(recording.column("angle_deg")[i], angle[static_cast<std::size_t>(i)]));
  }
}

TEST_CASE("messages in any order give rows in order, and the last of one time counts") {
  Written file;
  file.channel(1, 0, "/x", "json");
  for (const auto& [ns, value] : std::vector<std::pair<std::uint64_t, const char*>>{
           {3000000000, "3"}, {1000000000, "1"}, {2000000000, "9"}, {2000000000, "2"}})
    file.message(1, ns, std::string("{\"motor_C\": ") + value + "}");
  const std::string bytes = file.end();
  const auto result = io::parse_mcap("a.mcap", bytes.data(), bytes.size());
  CHECK(column(result.recording, "motor_C") == std::vector<double>{1.0, 2.0, 3.0});
  REQUIRE(result.findings.size() == 1);
  CHECK(has(result.findings[0].message, "1 samples of /x"));
}

TEST_CASE("a command that falls silent is held, and told") {
  Written file;
  file.channel(1, 0, "/cmd", "json");
  file.channel(2, 0, "/enc", "json");
  for (std::uint64_t i = 0; i < 100; ++i) {
    if (i < 40 || i > 90) file.message(1, i * 10000000, R"({"drive_A": 1})");
    file.message(2, i * 10000000, R"({"angle_deg": 1})");
  }
  const std::string bytes = file.end();
  const auto result = io::parse_mcap("a.mcap", bytes.data(), bytes.size());
  REQUIRE(result.findings.size() == 1);
  CHECK(has(result.findings[0].message, "/cmd was silent for 0.52 s from 0.39 s"));
  CHECK(result.findings[0].column == "drive_A");
}

TEST_CASE("stamps of two clocks are told") {
  Written file;
  file.channel(1, 0, "/a", "json");
  file.channel(2, 0, "/b", "json");
  for (int i = 0; i < 5; ++i) {
    const auto ns = static_cast<std::uint64_t>(10 + i) * 1000000000;
    file.message(
        1, ns,
        R"({"header": {"stamp": {"sec": )" + std::to_string(10 + i) + R"(, "nanosec": 0}}, "motor_C": 20})");
    file.message(
        2, ns + 5,
        R"({"header": {"stamp": {"sec": )" + std::to_string(7 + i) + R"(, "nanosec": 0}}, "ambient_C": 20})");
  }
  const std::string bytes = file.end();
  const auto result = io::parse_mcap("a.mcap", bytes.data(), bytes.size());
  CHECK(std::any_of(result.findings.begin(), result.findings.end(),
                    [](const Finding& one) { return one.kind == FindingKind::clock_shift; }));
  const auto by_log = io::parse_mcap("a.mcap", bytes.data(), bytes.size(), choices({"t_s=log_time"}));
  CHECK(by_log.recording.rows() == 9);  // the first temperature comes before any air
  CHECK(std::none_of(by_log.findings.begin(), by_log.findings.end(),
                     [](const Finding& one) { return one.kind == FindingKind::clock_shift; }));
}

TEST_CASE("time may be a field, and lists of structures are named by their members") {
  Written file;
  file.channel(1, 0, "/m", "json");
  file.message(1, 1, R"({"ms": 500, "motors": [{"name": "left", "T": 1}, {"name": "right", "T": 2}]})");
  file.message(1, 1, R"({"ms": 750, "motors": [{"T": 4, "name": "right"}, {"name": "left", "T": 3}]})");
  file.message(1, 1, R"({"ms": 999, "motors": [{"T": 5, "name": "right"}]})");
  const Recording recording =
      read(file.end(), {"t_s=/m.ms:ms", "motor_C=/m.motors[left].T", "neighbour_C=/m.motors[1].T"});
  CHECK(std::vector<double>(recording.t_s.data(), recording.t_s.data() + 3) ==
        std::vector<double>{0.5, 0.75, 0.999});
  CHECK(recording.column("motor_C")[0] == 1.0);
  CHECK(recording.column("motor_C")[1] == 3.0);
  CHECK(std::isnan(recording.column("motor_C")[2]));
  CHECK(recording.column("neighbour_C")[1] == 3.0);
  CHECK(std::isnan(recording.column("neighbour_C")[2]));
}

TEST_CASE("every primitive of ROS 2 is read, in both byte orders and editions of CDR") {
  const std::string definition =
      "# all of them\nbool b\nbyte y\nchar c\nint8 i8\nuint8 u8\nint16 i16\nuint16 u16\nint32 i32 -7  # a default\n"
      "uint32 u32\nint64 i64\nuint64 u64\nfloat32 f32\nfloat64 f64\nint32 A=5\nstring S=\"x#y\"\nstring<=10 s\n"
      "Empty e\nuint8[<=4] few\nuint8[] none\nfloat64[2] two\nstring[] words\nPair[] pairs\nfloat64 last\n"
      "================\nMSG: p/Pair\nint8 k\nfloat64 v\n================\nMSG: p/Empty\n";
  for (const bool big : {false, true})
    for (const bool second : {false, true}) {
      CAPTURE(big, second);
      std::string body;
      const auto put = [&](const std::string& little, std::size_t size) {
        const std::size_t step = std::min<std::size_t>(size, second ? 4 : 8);
        while (body.size() % step != 0) body += '\x5a';
        body += big ? std::string(little.rbegin(), little.rend()) : little;
      };
      const auto integer = [&](std::uint64_t value, int size) {
        put(Written::number(value, size), static_cast<std::size_t>(size));
      };
      const auto real = [&](double value) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, 8);
        integer(bits, 8);
      };
      const auto word = [&](const std::string& value) {
        integer(value.size() + 1, 4);
        body += value + '\0';
      };
      integer(1, 1), integer(200, 1), integer(201, 1), integer(0x80, 1), integer(255, 1);
      integer(0x8000, 2), integer(65535, 2), integer(0x80000000u, 4), integer(0xffffffffu, 4);
      integer(std::uint64_t{1} << 63, 8), integer(std::uint64_t{1} << 63, 8);
      integer(0x3f800001u, 4), real(0.1);
      word("abc"), integer(0, 1);
      integer(3, 4), integer(7, 1), integer(8, 1), integer(9, 1);
      integer(0, 4), real(1.5), real(2.5);
      integer(2, 4), word(""), word("xy");
      integer(2, 4), integer(255, 1), real(3.5), integer(4, 1), real(4.5);
      real(-1.25);
      const std::string head = {'\0', static_cast<char>((second ? 6 : 0) + (big ? 0 : 1)), '\0', '\0'};
      Written file;
      file.schema(1, "p/msg/All", definition);
      file.channel(1, 1, "/t", "cdr");
      file.message(1, 5, head + body);
      const Recording recording =
          read(file.end(),
               {"b=/t.b", "y=/t.y", "c=/t.c", "i8=/t.i8", "u8=/t.u8", "i16=/t.i16", "u16=/t.u16",
                "i32=/t.i32", "u32=/t.u32", "i64=/t.i64", "u64=/t.u64", "f32=/t.f32", "f64=/t.f64",
                "few=/t.few[2]", "two=/t.two[1]", "k=/t.pairs[0].k", "v=/t.pairs[1].v", "last=/t.last"});
      const std::vector<std::pair<const char*, double>> expected = {{"b", 1},
                                                                    {"y", 200},
                                                                    {"c", 201},
                                                                    {"i8", -128},
                                                                    {"u8", 255},
                                                                    {"i16", -32768},
                                                                    {"u16", 65535},
                                                                    {"i32", -2147483648.0},
                                                                    {"u32", 4294967295.0},
                                                                    {"i64", -9223372036854775808.0},
                                                                    {"u64", 9223372036854775808.0},
                                                                    {"f32", 1.00000011920928955078125},
                                                                    {"f64", 0.1},
                                                                    {"few", 9},
                                                                    {"two", 2.5},
                                                                    {"k", -1},
                                                                    {"v", 4.5},
                                                                    {"last", -1.25}};
      for (const auto& [name, value] : expected) {
        CAPTURE(name);
        CHECK(recording.column(name)[0] == value);
      }
    }
}

TEST_CASE("JSON as others write it") {
  Written file;
  file.channel(1, 0, "/j", "json");
  file.message(
      1, 1000,
      " {\"a\\u0062\\\"\" : -1.5e-3 ,\"t\":true,\"n\":NaN,\"deep\":{\"er\":[[1,2],[3]]},\"l\":[10,11], \"s\":\"\\ud83d\\ude00\"}\n");
  const Recording recording = read(file.end(), {"x=/j.ab\"", "t=/j.t", "l=/j.l[1]"});
  CHECK(recording.column("x")[0] == -1.5e-3);
  CHECK(recording.column("t")[0] == 1.0);
  CHECK(recording.column("l")[0] == 11.0);
  for (const char* wrong :
       {"{", "{\"a\"}", "{\"a\":1,}", "[1,2", "{\"a\":-}", "{\"a\":tru}", "{\"a\":\"\\x\"}", "{\"a\":1} 2",
        "{\"a\":\"\\u12\"}", "{\"a\":inf}", "\"abc", ""}) {
    CAPTURE(wrong);
    Written bad;
    bad.channel(1, 0, "/j", "json");
    const std::size_t at = bad.bytes.size();
    bad.message(1, 1000, wrong);
    const std::string error = error_of_bytes(bad.end(), {"a=/j.a"});
    CHECK(has(error, "a.mcap: message 1 of /j (byte " + std::to_string(at) + "): byte "));
    CHECK(has(error, "expected"));
  }
}

TEST_CASE("a wish that cannot be granted is answered with file, topic, field and what there is") {
  const std::string bytes = read_text(folder + "cdr_plain.mcap");
  const auto error = [&](const char* choice) { return error_of_bytes(bytes, {choice}); };
  CHECK(
      error("motor_C=/nowhere.x") ==
      "a.mcap: column 'motor_C': there is no topic for '/nowhere.x'; found '/joint_states', '/motor/temperature', "
      "'/imu', '/elbow/command', '/battery'");
  CHECK(has(error("motor_C=/imu.angular_velocity"),
            "'/imu.angular_velocity' is not a number in any of 60 messages"));
  CHECK(has(error("angle_deg=/joint_states.position[knee]"), "its list names "));
  CHECK(has(error("angle_deg=/joint_states.position[knee]"), "'elbow'"));
  CHECK(has(error("angle_deg=/joint_states.position[7]"), "is not a number in any of 120"));
  CHECK(has(error("motor_C=/battery.serial_number"), "message 1 of /battery ("));
  CHECK(has(error("motor_C=/battery.serial_number"), "field 'serial_number' is the text "));
  CHECK(has(error("angle_deg=/joint_states.position["), "expected a ']'"));
  CHECK(has(error("angle_deg=/joint_states.position[]"), "expected an index or a name"));
  CHECK(has(error("power_param=/motor/temperature.temperature:1"), "outside the range of power_param"));
  CHECK(has(error_of_bytes(bytes, {}), "no field is asked for"));
  CHECK(has(error_of_bytes(bytes, {"t_s=header.stamp", "drive_A=/elbow/command.data"}),
            "message 1 of /elbow/command"));
  CHECK(has(error_of_bytes(bytes, {"t_s=/imu.angular_velocity.x", "motor_C=/motor/temperature.temperature"}),
            "expected one topic"));
  CHECK(has(error_of_bytes(bytes, {"t_s=/imu.angular_velocity.x"}), "no field is asked for"));
  Written other;
  other.schema(1, "p.Q", "bytes", "protobuf");
  other.channel(1, 1, "/p", "protobuf");
  other.channel(2, 0, "/q", "cdr");
  const std::string foreign = other.end();
  CHECK(has(error_of_bytes(foreign, {"a=/p.x"}),
            "topic /p: its messages are encoded as 'protobuf'; expected cdr or json"));
  CHECK(has(error_of_bytes(foreign, {"a=/q.x"}), "no schema"));
  Written infinite;
  infinite.channel(1, 0, "/j", "json");
  infinite.message(1, 1, R"({"a": 1e999})");
  CHECK(has(error_of_bytes(infinite.end(), {"a=/j.a"}), "field 'a' is infinite"));
}

TEST_CASE("a definition that cannot be understood is answered with its line") {
  const auto error = [](const std::string& definition) {
    Written file;
    file.schema(1, "p/msg/Q", definition);
    file.channel(1, 1, "/q", "cdr");
    return error_of_bytes(file.end(), {"a=/q.x"});
  };
  CHECK(has(error("float64 a\nUnknown x\n"),
            "line 2 of its definition: field 'x': the type 'Unknown' is not defined"));
  CHECK(has(error("float64\n"), "line 1 of its definition: 'float64' alone"));
  CHECK(has(error("float64[x] a\n"), "expected the length of an array"));
  CHECK(has(error("float64[2 a\n"), "expected a ']'"));
  CHECK(has(error("float64 a-b\n"), "is not a name of a field"));
  CHECK(has(error("Q q\n"), "contains itself"));
}

TEST_CASE("a file that is cut off anywhere is refused, with the byte, or has all its data") {
  const std::string whole = read_text(folder + "json_plain.mcap");
  const std::vector<std::string> columns = {"angle_deg=/joint_states.position[elbow]:rad"};
  const Recording expected = read(whole, columns);
  std::size_t complete = 0, refused = 0;
  for (std::size_t size = 0; size < whole.size(); size += 1 + size % 5) {
    const std::string part = whole.substr(0, size);
    try {
      const Recording recording = read(part, columns);
      REQUIRE(recording.rows() == expected.rows());
      ++complete;
    } catch (const io::InputError& error) {
      REQUIRE(has(error.what(), "a.mcap: byte "));
      ++refused;
    }
  }
  CHECK(complete > 0);  // cuts inside the index behind the data
  CHECK(refused > 2 * complete);
  CHECK(has(error_of_bytes(whole.substr(0, 5000), columns), "messages (was the recording cut off?"));
}

TEST_CASE("a changed byte is refused or changes nothing, where check sums are") {
  for (const char* name : {"cdr_chunks.mcap", "cdr_lz4.mcap", "cdr_zstd.mcap"}) {
#if !defined(THERMOPOWER_HAS_ZSTD) || !defined(THERMOPOWER_HAS_LZ4)
    if (!has(name, "chunks")) continue;
#endif
    CAPTURE(name);
    const std::string whole = read_text(folder + name);
    const Recording expected = read(whole, of_mcap);
    std::size_t refused = 0, tried = 0;
    for (std::size_t at = 8; at < whole.size() / 2; at += 997) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
      ++tried;
      try {
        const Recording recording = read(damaged, of_mcap);
        REQUIRE(recording.rows() == expected.rows());
        REQUIRE((column(recording, "supply_V") == column(expected, "supply_V")));
      } catch (const io::InputError& error) {
        REQUIRE(has(error.what(), "a.mcap: "));
        ++refused;
      }
    }
    CHECK(refused * 10 > tried * 9);
  }
}

TEST_CASE("records that lie about their sizes cost no memory and are refused") {
  Written file;
  file.bytes += '\x05' + Written::number(std::uint64_t{1} << 60, 8);
  CHECK(has(error_of_bytes(file.bytes), "byte 8: the file ends inside the record that starts here"));
  Written chunk;
  chunk.add(6, Written::number(0, 16) + Written::number(std::uint64_t{1} << 40, 8) + Written::number(0, 4) +
                   Written::text("") + Written::number(0, 8));
  CHECK(has(error_of_bytes(chunk.end()), "expected at most"));
  Written inner;
  inner.add(6, Written::number(0, 16) + Written::number(9, 8) + Written::number(0, 4) + Written::text("") +
                   Written::number(9, 8) + '\x05' + Written::number(1000, 8));
  CHECK(has(error_of_bytes(inner.end()),
            "chunk at byte 8, byte 0 of what it unpacks to: the chunk ends inside"));
  Written strange;
  strange.add(6, Written::number(0, 16) + Written::number(1, 8) + Written::number(0, 4) +
                     Written::text("snappy") + Written::number(1, 8) + "x");
  CHECK(has(error_of_bytes(strange.end()), "compressed with 'snappy'; expected zstd, lz4 or none"));
  Written orphan;
  orphan.message(3, 5, "{}");
  CHECK(has(error_of_bytes(orphan.end()), "a message of channel 3"));
  CHECK(has(error_of_bytes("t_s,motor_C\n"), "not an MCAP file"));
}

TEST_CASE("the list of a file names topics, fields and counts, and what it proposes can be taken") {
  const io::McapContents contents = io::list_mcap(folder + "cdr_plain.mcap");
  REQUIRE(contents.topics.size() == 5);
  const auto topic = [&](const char* name) {
    for (const auto& one : contents.topics)
      if (one.name == name) return one;
    return io::McapTopic();
  };
  CHECK(topic("/joint_states").messages == 120);
  CHECK(topic("/joint_states").schema == "sensor_msgs/msg/JointState");
  CHECK(topic("/joint_states").stamped);
  CHECK_FALSE(topic("/elbow/command").stamped);
  const auto field = [&](const char* header) {
    for (const auto& one : contents.columns)
      if (one.header == header) return one;
    return io::ListedColumn();
  };
  CHECK(field("/joint_states.position[elbow]").proposed == "angle_deg");
  CHECK(field("/joint_states.position[elbow]").unit == "rad");
  CHECK(field("/joint_states.position[elbow]").samples == 120);
  CHECK(field("/joint_states.velocity[wrist]").missing == 1);
  CHECK(field("/joint_states.velocity[elbow]").proposed == "rate_dps");
  CHECK(field("/imu.angular_velocity.z").proposed.empty());
  CHECK(field("/motor/temperature.temperature").proposed == "motor_C");
  CHECK(field("/battery.voltage").proposed == "supply_V");
  CHECK(field("/battery.current").proposed.empty());
  CHECK(field("/battery.temperature").proposed.empty());
  CHECK(field("/battery.cell_voltage[2]").samples == 6);
  CHECK(field("/imu.header.stamp.sec").header.empty());
  const std::string text = io::columns_text(contents);
  CHECK(has(text, "--column 'angle_deg=/joint_states.position[elbow]:rad'"));
  const auto map = io::parse_column_map("map", io::column_map_text(contents.columns));
  CHECK(map.size() >= 4);
  CHECK(io::read_mcap(folder + "cdr_plain.mcap", map).recording.rows() > 100);
  const io::McapContents json = io::list_mcap(folder + "json_plain.mcap");
  CHECK(json.columns.size() > 10);
}

TEST_CASE("a mapping file says what is wrong in which line") {
  const auto map =
      io::parse_column_map("m.txt", "# the arm\n\n angle_deg = /js.position[elbow] :rad\r\nmotor_C=t:K\n");
  REQUIRE(map.size() == 2);
  CHECK(map[0].name == "angle_deg");
  CHECK(map[0].header == "/js.position[elbow]");
  CHECK(map[1].offset == 273.15);
  const auto error = [](const char* text) { return error_of([&] { io::parse_column_map("m.txt", text); }); };
  CHECK(has(error("a=b\nangle_deg=x:furlong\n"),
            "m.txt:2: 'angle_deg=x:furlong': 'furlong' is not a unit of angle_deg"));
  CHECK(has(error("a\n"), "m.txt:1: 'a': expected NAME=HEADER"));
  CHECK(has(error("a=b\na=c\n"), "m.txt:2: 'a' appears twice"));
  CHECK(has(error("a=b\nc=b\n"), "m.txt:2: 'b' appears twice"));
  CHECK(has(error("# none\n"), "m.txt: no line"));
}
