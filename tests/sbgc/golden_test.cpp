// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Bytes that the vendor's libraries produced, and what those libraries decoded.

#include "support.hpp"

using namespace support;
namespace command = sbgc::command;

namespace {

struct Command {
  std::uint8_t power[3] = {25, 125, 250};
  std::uint8_t p_gain[3] = {22, 143, 2};
};

sbgc::SetAdjVars<1> one_at_its_limit() {
  sbgc::SetAdjVars<1> message;
  message.vars[0] = sbgc::AdjVar{sbgc::variable::power_yaw, 2147483647};
  return message;
}

// Names as in the files, values as this library reads them.
std::map<std::string, int> fields_of(const sbgc::RealtimeData& data) {
  std::map<std::string, int> fields;
  fields["unpack_error"] = 0;
  fields["cmd"] = data.id();
  for (std::uint8_t i = 0; i < 3; ++i) {
    const std::string index = "[" + std::to_string(i) + "]";
    fields["acc" + index] = data.acc(i);
    fields["gyro" + index] = data.gyro(i);
    fields["imu_angle" + index] = data.imu_angle(i);
    fields["frame_imu_angle" + index] = data.frame_imu_angle(i);
    fields["target_angle" + index] = data.target_angle(i);
    fields["motor_power" + index] = data.motor_power(i);
    if (!data.has_extended()) continue;
    fields["rotor_angle" + index] = data.rotor_angle(i);
    fields["balance_error" + index] = data.balance_error(i);
    fields["magnetometer_data" + index] = data.magnetometer(i);
  }
  for (std::uint8_t i = 0; i < 6; ++i) fields["rc_raw[" + std::to_string(i) + "]"] = data.rc(i);
  fields["serial_error_cnt"] = data.serial_errors();
  fields["system_error"] = data.system_error();
  fields["cycle_time_us"] = data.cycle_time_us();
  fields["i2c_error_count"] = data.i2c_errors();
  fields["battery_voltage_cV"] = data.battery_cV();
  fields["state_flags1"] = data.flags();
  fields["cur_imu"] = data.imu();
  fields["cur_profile"] = data.profile();
  if (data.has_extended()) {
    fields["current_mA"] = data.current_mA();
    fields["imu_temp"] = data.imu_C();
    fields["frame_imu_temp"] = data.frame_imu_C();
  }
  return fields;
}

template <class Codec>
std::map<std::string, int> decode(const Data& bytes) {
  Codec codec;
  REQUIRE(receive_all(codec, Data(bytes.begin(), bytes.end() - 1)).empty());
  REQUIRE(codec.receive(bytes.back(), 0));
  const sbgc::RealtimeData* data = codec.realtime_data();
  REQUIRE(data != nullptr);
  return fields_of(*data);
}

}  // namespace

TEST_CASE("golden: CRC-16 check value") {
  sbgc::Crc16 crc;
  CHECK(crc.value() == 0);
  for (const char c : std::string("123456789")) crc.add(static_cast<std::uint8_t>(c));
  CHECK(crc.value() == 0xBCDD);
}

TEST_CASE("golden: requests and commands encode to the vendor libraries' bytes") {
  using V1 = sbgc::ProtocolV1;
  using V2 = sbgc::ProtocolV2;
  CHECK(encoded<V1>(sbgc::Request(command::board_info)) == load_hex("v1_request_board_info.hex"));
  CHECK(encoded<V1>(sbgc::Request(command::realtime_data_3)) == load_hex("v1_request_realtime_data_3.hex"));
  CHECK(encoded<V1>(sbgc::Request(command::realtime_data_4)) == load_hex("v1_request_realtime_data_4.hex"));
  CHECK(encoded<V2>(sbgc::Request(command::realtime_data_3)) == load_hex("v2_request_realtime_data_3.hex"));
  CHECK(encoded<V2>(sbgc::Request(command::realtime_data_4)) == load_hex("v2_request_realtime_data_4.hex"));
  CHECK(encoded<V1>(sbgc::power_and_gain(Command())) == load_hex("v1_set_adj_vars_6.hex"));
  CHECK(encoded<V2>(sbgc::power_and_gain(Command())) == load_hex("v2_set_adj_vars_6.hex"));
  CHECK(encoded<V1>(one_at_its_limit()) == load_hex("v1_set_adj_vars_1_max.hex"));
  CHECK(encoded<V2>(one_at_its_limit()) == load_hex("v2_set_adj_vars_1_max.hex"));
}

TEST_CASE("golden: telemetry decodes to what the vendor's library decoded") {
  using V1 = thermopower::SbgcCodec<>;
  using V2 = thermopower::SbgcCodec<124, sbgc::ProtocolV2>;
  CHECK(decode<V1>(load_hex("v1_answer_rt3_ramp.hex")) == load_fields("v1_answer_rt3_ramp_decoded.txt"));
  CHECK(decode<V1>(load_hex("v1_answer_rt4_ramp.hex")) == load_fields("v1_answer_rt4_ramp_decoded.txt"));
  CHECK(decode<V1>(load_hex("v1_answer_rt4_real.hex")) == load_fields("v1_answer_rt4_real_decoded.txt"));
  CHECK(decode<V2>(load_hex("v2_answer_rt4_real.hex")) == load_fields("v1_answer_rt4_real_decoded.txt"));
}

TEST_CASE("golden: telemetry in physical units") {
  thermopower::SbgcCodec<> codec;
  const Data bytes = load_hex("v1_answer_rt4_real.hex");
  receive_all(codec, Data(bytes.begin(), bytes.end() - 1));
  REQUIRE(codec.receive(bytes.back(), 0));
  const sbgc::RealtimeData& data = *codec.realtime_data();

  // imu 100, -200, 8191; target 146, -8192, 16384
  CHECK(data.error_units(0) == 46);
  CHECK(data.error_units(1) == -7992);
  CHECK(data.error_units(2) == 8193);
  CHECK(is_near(data.error_deg(0), 46 * 360.0 / 16384));
  CHECK(is_near(data.imu_angle_deg(2), 8191 * 360.0 / 16384));
  CHECK(data.target_angle_deg(2) == 360.0f);
  CHECK(is_near(data.frame_imu_angle_deg(2), -3 * 360.0 / 16384));
  CHECK(is_near(data.battery_V(), 12.68));
  CHECK(is_near(data.current_A(), 1.234));
  CHECK(data.motors_on());
  CHECK(data.imu_C() == 25);
  CHECK(data.frame_imu_C() == -7);
}

TEST_CASE("golden: telemetry encodes to the same bytes, from the view and from the fields") {
  using V1 = sbgc::ProtocolV1;
  using V2 = sbgc::ProtocolV2;
  for (const char* name : {"v1_answer_rt3_ramp.hex", "v1_answer_rt4_ramp.hex", "v1_answer_rt4_real.hex"}) {
    INFO(name);
    const Data bytes = load_hex(name);
    thermopower::SbgcCodec<> codec;
    receive_all(codec, Data(bytes.begin(), bytes.end() - 1));
    REQUIRE(codec.receive(bytes.back(), 0));
    sbgc::RealtimeFields fields;
    REQUIRE(codec.read(fields));
    CHECK(encoded<V1>(*codec.realtime_data()) == bytes);
    CHECK(encoded<V1>(fields) == bytes);
    if (std::string(name) == "v1_answer_rt4_real.hex")
      CHECK(encoded<V2>(fields) == load_hex("v2_answer_rt4_real.hex"));
  }
}

TEST_CASE("golden: the payload alone, taken as a frame of either version") {
  const Data payload = load_hex("payload_rt4_real.hex");
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::Raw{25, {payload.data(), 124}}) ==
        load_hex("v1_answer_rt4_real.hex"));
  CHECK(encoded<sbgc::ProtocolV2>(sbgc::Raw{25, {payload.data(), 124}}) ==
        load_hex("v2_answer_rt4_real.hex"));
}

TEST_CASE("golden: the variables of a command read back") {
  for (const char* name : {"v1_set_adj_vars_6.hex", "v2_set_adj_vars_6.hex"}) {
    INFO(name);
    const Data bytes = load_hex(name);
    thermopower::SbgcCodec<124, sbgc::ProtocolAuto> codec;
    receive_all(codec, Data(bytes.begin(), bytes.end() - 1));
    REQUIRE(codec.receive(bytes.back(), 0));
    sbgc::AdjVarsView vars;
    REQUIRE(codec.read(vars));
    REQUIRE(vars.count() == 6);
    const int expected[6][2] = {{9, 25}, {10, 125}, {11, 250}, {0, 22}, {1, 143}, {2, 2}};
    for (std::uint8_t i = 0; i < 6; ++i) {
      CHECK(int(vars[i].id) == expected[i][0]);
      CHECK(vars[i].value == expected[i][1]);
    }
  }
}
