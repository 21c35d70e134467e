// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "sqlite_bag.hpp"

#include <thermopower/io/input_error.hpp>

#include <map>

#ifdef THERMOPOWER_HAS_SQLITE
#include <sqlite3.h>

#include <memory>
#endif

namespace thermopower::io {

#ifdef THERMOPOWER_HAS_SQLITE
namespace {

constexpr const char* header_text =
    "================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";

// What older recordings leave out: the definitions of ROS 2 itself.
std::string known_definition(const std::string& type) {
  const std::string header = header_text;
  static const std::map<std::string, std::string> plain = {
      {"std_msgs/msg/Float64", "float64 data\n"},
      {"std_msgs/msg/Float32", "float32 data\n"},
      {"std_msgs/msg/Int32", "int32 data\n"},
      {"std_msgs/msg/Int16", "int16 data\n"},
      {"std_msgs/msg/UInt8", "uint8 data\n"},
      {"std_msgs/msg/UInt16", "uint16 data\n"},
      {"std_msgs/msg/Float64MultiArray",
       "MultiArrayLayout layout\nfloat64[] data\n"
       "================================================================================\nMSG: std_msgs/MultiArrayLayout\nMultiArrayDimension[] dim\nuint32 data_offset\n"
       "================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride\n"},
      {"std_msgs/msg/Float32MultiArray",
       "MultiArrayLayout layout\nfloat32[] data\n"
       "================================================================================\nMSG: std_msgs/MultiArrayLayout\nMultiArrayDimension[] dim\nuint32 data_offset\n"
       "================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride\n"}};
  static const std::map<std::string, std::string> stamped = {
      {"sensor_msgs/msg/JointState",
       "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"},
      {"sensor_msgs/msg/Temperature", "std_msgs/Header header\nfloat64 temperature\nfloat64 variance\n"},
      {"sensor_msgs/msg/Imu",
       "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
       "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n"
       "================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
       "================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"},
      {"sensor_msgs/msg/BatteryState",
       "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\nfloat32 charge\nfloat32 capacity\nfloat32 design_capacity\nfloat32 percentage\n"
       "uint8 power_supply_status\nuint8 power_supply_health\nuint8 power_supply_technology\nbool present\nfloat32[] cell_voltage\nfloat32[] cell_temperature\nstring location\nstring serial_number\n"}};
  if (const auto found = plain.find(type); found != plain.end()) return found->second;
  if (const auto found = stamped.find(type); found != stamped.end()) return found->second + header;
  return {};
}

class Database {
public:
  explicit Database(const std::string& path) : path_(path) {
    sqlite3* opened = nullptr;
    const int status = sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
    database_.reset(opened);
    if (status != SQLITE_OK) fail("cannot be opened as a database of SQLite");
  }

  bool has_table(const char* name) const {
    bool found = false;
    const std::string wanted = name;
    rows("SELECT name FROM sqlite_master WHERE type='table'",
         [&](sqlite3_stmt* row) { found = found || text(row, 0) == wanted; });
    return found;
  }

  template <class Each>
  void rows(const char* query, const Each& each) const {
    sqlite3_stmt* prepared = nullptr;
    if (sqlite3_prepare_v2(database_.get(), query, -1, &prepared, nullptr) != SQLITE_OK)
      fail(std::string("not a recording of rosbag2 (") + sqlite3_errmsg(database_.get()) +
           "); expected the tables topics and messages");
    const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement(prepared, &sqlite3_finalize);
    for (;;) {
      const int status = sqlite3_step(prepared);
      if (status == SQLITE_DONE) return;
      if (status != SQLITE_ROW) fail(std::string("is damaged: ") + sqlite3_errmsg(database_.get()));
      each(prepared);
    }
  }

  static std::string text(sqlite3_stmt* row, int column) {
    const unsigned char* const content = sqlite3_column_text(row, column);
    return content == nullptr ? std::string() : reinterpret_cast<const char*>(content);
  }

private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(path_ + ": " + what); }

  std::string path_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_{nullptr, &sqlite3_close};
};

}  // namespace

void read_sqlite_bag(const std::string& path, const McapHandlers& handlers) {
  const Database database(path);
  std::map<std::string, std::pair<std::string, std::string>> definitions;  // by type: encoding and text
  if (database.has_table("message_definitions"))
    database.rows("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions",
                  [&](sqlite3_stmt* row) {
                    definitions[Database::text(row, 0)] = {Database::text(row, 1), Database::text(row, 2)};
                  });
  std::map<std::string, std::uint16_t> schemas;
  database.rows(
      "SELECT id, name, type, serialization_format FROM topics ORDER BY id", [&](sqlite3_stmt* row) {
        const std::string type = Database::text(row, 2);
        const auto [found, is_new] = schemas.emplace(type, static_cast<std::uint16_t>(schemas.size() + 1));
        if (is_new) {
          auto definition = definitions.find(type);
          std::pair<std::string, std::string> text =
              definition == definitions.end() || definition->second.second.empty()
                  ? std::make_pair(std::string("ros2msg"), known_definition(type))
                  : definition->second;
          if (text.second.empty()) text.first = "unknown: the recording has no definition of this type";
          McapSchema schema;
          schema.id = found->second;
          schema.name = type;
          schema.encoding = text.first;
          schema.text = {reinterpret_cast<const unsigned char*>(text.second.data()), text.second.size()};
          handlers.schema(schema);
        }
        McapChannel channel;
        channel.id = static_cast<std::uint16_t>(sqlite3_column_int(row, 0));
        channel.schema = found->second;
        channel.topic = Database::text(row, 1);
        channel.encoding = Database::text(row, 3);
        handlers.channel(channel);
      });
  database.rows(
      "SELECT id, topic_id, timestamp, data FROM messages ORDER BY timestamp, id", [&](sqlite3_stmt* row) {
        McapMessage message;
        message.place.byte = static_cast<std::uint64_t>(sqlite3_column_int64(row, 0));
        message.channel = static_cast<std::uint16_t>(sqlite3_column_int(row, 1));
        message.log_ns = message.publish_ns = static_cast<std::uint64_t>(sqlite3_column_int64(row, 2));
        message.data = {static_cast<const unsigned char*>(sqlite3_column_blob(row, 3)),
                        static_cast<std::size_t>(sqlite3_column_bytes(row, 3))};
        handlers.message(message);
      });
}

#else

void read_sqlite_bag(const std::string& path, const McapHandlers&) {
  throw InputError(
      path +
      ": is a recording of ROS 2 in SQLite, and this program was built without SQLite (Debian: libsqlite3-dev); 'ros2 bag convert' makes an MCAP file of it");
}

#endif

}  // namespace thermopower::io
