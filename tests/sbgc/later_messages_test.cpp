// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Messages beyond telemetry and POWER, against bytes that were packed by another program (Python's struct, a bitwise CRC)
// from the specification's tables.

#include "support.hpp"

using namespace support;

namespace {

/// The only frame in a file, received by either protocol.
struct Received {
  thermopower::SbgcCodec<255, sbgc::ProtocolAuto> codec;
  explicit Received(const char* name) {
    const Data bytes = load_hex(name);
    bool has_frame = false;
    for (const std::uint8_t byte : bytes) has_frame = codec.receive(byte, 0);
    if (!has_frame) throw std::runtime_error(std::string("no frame in ") + name);
  }
};

template <class Message>
void refuses_every_shorter(const char* name, Message message) {
  const Data bytes = load_hex(name);
  Data payload(bytes.begin() + 4, bytes.end() - 1);
  const std::uint8_t id = bytes[1];
  CHECK(message.read(view(id, payload)));
  while (!payload.empty()) {
    payload.pop_back();
    Message another = message;
    CHECK_FALSE(another.read(view(id, payload)));
  }
}

}  // namespace

TEST_CASE("answers to GET_ANGLES") {
  for (const char* name : {"v1_answer_get_angles.hex", "v2_answer_get_angles.hex"}) {
    const Received received(name);
    sbgc::Angles angles;
    REQUIRE(received.codec.read(angles));
    CHECK(angles.imu_angle(0) == 100);
    CHECK(angles.target_angle(0) == 146);
    CHECK(angles.target_speed(0) == -8);
    CHECK(angles.imu_angle(1) == -200);
    CHECK(angles.target_angle(1) == -8192);
    CHECK(angles.target_angle(2) == 16384);
    CHECK(angles.target_speed(2) == 32767);
    CHECK(angles.target_speed(7) == 32767);
    CHECK(angles.target_angle_deg(1) == -180.0f);
    CHECK(is_near(angles.error_deg(1), (-8192 + 200) * 360.0 / 16384.0));
    CHECK(is_near(angles.imu_angle_deg(0), 100 * 360.0 / 16384.0));
  }
  refuses_every_shorter("v1_answer_get_angles.hex", sbgc::Angles());
  sbgc::Angles none;
  CHECK_FALSE(none.read(view(sbgc::command::get_angles_ext, Data(54, 0))));
}

TEST_CASE("answers to GET_ANGLES_EXT") {
  const Received received("v1_answer_get_angles_ext.hex");
  sbgc::AnglesExt angles;
  REQUIRE(received.codec.read(angles));
  CHECK(angles.imu_angle(0) == 100);
  CHECK(angles.target_angle(1) == -8192);
  CHECK(angles.frame_cam_angle(0) == -70000);
  CHECK(angles.frame_cam_angle(1) == 5);
  CHECK(angles.frame_cam_angle(2) == 2147483647);
  CHECK(angles.frame_cam_angle(200) == 2147483647);
  CHECK(is_near(angles.error_deg(2), (16384 - 8191) * 360.0 / 16384.0));
  refuses_every_shorter("v1_answer_get_angles_ext.hex", sbgc::AnglesExt());
}

TEST_CASE("custom telemetry: motor currents and temperatures of newer boards") {
  const std::uint32_t fields =
      sbgc::custom::imu_angles | sbgc::custom::target_angles | sbgc::custom::power_state;
  sbgc::RealtimeCustomRequest request;
  request.fields = fields;
  CHECK(encoded<sbgc::ProtocolV1>(request) == load_hex("v1_request_custom_angles_power_state.hex"));
  for (const char* name :
       {"v1_answer_custom_angles_power_state.hex", "v2_answer_custom_angles_power_state.hex"}) {
    const Received received(name);
    sbgc::RealtimeCustom data(fields);
    CHECK(data.payload_size() == 60);
    REQUIRE(received.codec.read(data));
    CHECK(data.timestamp_ms() == 54321);
    CHECK(sbgc::read_i16(data.field(sbgc::custom::imu_angles) + 2) == -200);
    CHECK(sbgc::read_i16(data.field(sbgc::custom::target_angles) + 4) == 16384);
    CHECK(data.motor_power(0) == -1.0f);
    CHECK(is_near(data.motor_power(1), 0.25));
    CHECK(data.motor_current_A(0) == 0.0f);
    CHECK(is_near(data.motor_current_A(1), 1.234));
    CHECK(is_near(data.motor_current_A(2), 65.535));
    CHECK(int(data.motor_C(0)) == -7);
    CHECK(int(data.motor_C(1)) == 25);
    CHECK(int(data.motor_C(2)) == 112);
    CHECK_FALSE(data.is_over_current(1));
    CHECK(data.is_over_current(2));
    CHECK(int(data.power_state()) == 1);
    CHECK(is_near(data.battery_V(), 12.68));
    CHECK(is_near(data.current_A(), 2.345));
    CHECK(data.warns_of_heat());
  }
  SECTION("what was not asked for is implausible, not a mild 0") {
    sbgc::RealtimeCustom data(sbgc::custom::imu_angles);
    REQUIRE(data.read(view(sbgc::command::realtime_data_custom, Data(8, 1))));
    CHECK(int(data.motor_C(0)) == -128);
    CHECK(std::isnan(data.motor_current_A(0)));
    CHECK(std::isnan(data.battery_V()));
    CHECK(std::isnan(data.current_A()));
    CHECK(std::isnan(data.motor_power(0)));
    CHECK_FALSE(data.warns_of_heat());
    CHECK_FALSE(data.is_over_current(0));
    CHECK(int(data.power_state()) == -128);
    CHECK(data.field(sbgc::custom::target_angles) == nullptr);
  }
  SECTION("a field of unknown size is refused: what follows it could not be found") {
    for (const std::uint32_t unknown : {1u << 9, 1u << 10, 1u << 16, 1u << 31}) {
      sbgc::RealtimeCustom data(unknown | sbgc::custom::power_state);
      CHECK(data.payload_size() == 0);
      CHECK_FALSE(data.read(view(sbgc::command::realtime_data_custom, Data(255, 0))));
    }
  }
  SECTION("every field is where the ones before it end") {
    const std::uint32_t all = 0xF9FF;
    sbgc::RealtimeCustom data(all);
    // Nine of 6 bytes and less: 7 x 6 + 12 + 24 + 36 of the first, 9 + 12 + 40 + 20 + 46 of the rest.
    CHECK(data.payload_size() == 2 + 36 + 6 + 6 - 6 + 12 + 24 + 36 - 6 + 9 + 12 + 40 + 20 + 46);
    const Data payload(data.payload_size(), 0);
    REQUIRE(data.read(view(sbgc::command::realtime_data_custom, payload)));
    CHECK(data.field(sbgc::custom::power_state) == payload.data() + payload.size() - 46);
    CHECK(data.field(sbgc::custom::imu_angles) == payload.data() + 2);
    CHECK(data.field(sbgc::custom::acc) == payload.data() + 2 + 5 * 6 + 12 + 24 + 36);
  }
  sbgc::RealtimeCustom data(fields);
  refuses_every_shorter("v1_answer_custom_angles_power_state.hex", data);
}

TEST_CASE("a profile's parameters are read, changed and written back, and nothing else changes") {
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::ReadParams3()) == load_hex("v1_request_read_params_3.hex"));
  const Received received("v1_answer_read_params_3.hex");
  sbgc::Params3 params;
  REQUIRE(received.codec.read(params));
  CHECK(int(params.profile()) == 2);
  CHECK(int(params.p_gain(0)) == 7 * 1 + 3);
  CHECK(int(params.i_gain(1)) == 7 * 8 + 3);
  CHECK(int(params.d_gain(2)) == 7 * 15 + 3);
  CHECK(int(params.power(0)) == 7 * 4 + 3);
  CHECK(int(params.poles(2)) == 7 * 18 + 3);
  CHECK(int(params.poles(9)) == 7 * 18 + 3);
  CHECK(is_near(params.lowest_battery_V(), 10.5));
  CHECK(is_near(params.reference_battery_V(), 16.8));
  params.set_power(0, 100);
  params.set_p_gain(2, 77);
  CHECK(encoded<sbgc::ProtocolV1>(params) == load_hex("v1_write_params_3_changed.hex"));
  params.set_profile(sbgc::ReadParams3::current());
  CHECK(int(params.profile()) == 255);
  refuses_every_shorter("v1_answer_read_params_3.hex", sbgc::Params3());
}

TEST_CASE("what board it is, and its motors on and off, byte for byte") {
  const Received received("v1_answer_board_info.hex");
  sbgc::BoardInfo info;
  REQUIRE(received.codec.read(info));
  CHECK(int(info.board_version) == 36);
  CHECK(info.firmware_version == 2733);
  CHECK(info.board_features == 0x0123);
  CHECK(info.firmware_extra_id == 0xDEADBEEF);
  CHECK(info.board_features_ext == 0x8001);
  CHECK(info.base_firmware_version == 2730);
  CHECK(encoded<sbgc::ProtocolV1>(info) == load_hex("v1_answer_board_info.hex"));
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::MotorsOn()) == load_hex("v1_motors_on.hex"));
  sbgc::MotorsOff off;
  off.mode = sbgc::MotorsOff::safe_stop;
  CHECK(encoded<sbgc::ProtocolV1>(off) == load_hex("v1_motors_off_safe.hex"));
}

TEST_CASE("a variable that is a float") {
  const sbgc::SetAdjVars<1> set = {{sbgc::AdjVar::of_float(44, -1.5f)}};
  CHECK(encoded<sbgc::ProtocolV1>(set) == load_hex("v1_set_adj_var_float.hex"));
  const Received received("v1_set_adj_var_float.hex");
  sbgc::AdjVarsView view;
  REQUIRE(received.codec.read(view));
  CHECK(view[0].as_float() == -1.5f);
  CHECK(int(view[0].id) == 44);
}

TEST_CASE("a board that stopped because of heat says so, and for nothing else") {
  sbgc::RealtimeFields fields;
  const auto is_hot = [&] {
    sbgc::RealtimeData data;
    const Data bytes = encoded<sbgc::ProtocolV1>(fields);
    const Data payload(bytes.begin() + 4, bytes.end() - 1);
    REQUIRE(data.read(view(sbgc::command::realtime_data_4, payload)));
    return data.is_overheated();
  };
  const std::vector<int> hot = {2, 8, 13, 18, 23, 24};
  for (int code = 0; code < 256; ++code) {
    fields.system_sub_error = static_cast<std::uint8_t>(code);
    fields.system_error = 0x0800;
    CHECK(is_hot() == (std::find(hot.begin(), hot.end(), code) != hot.end()));
    fields.system_error = 0xF7FF;  // all but the emergency stop: what the code was about is over
    CHECK_FALSE(is_hot());
  }
}

TEST_CASE("an answer takes no other message for itself, however long that is") {
  const Data longest(255, 2);
  const auto other = view(sbgc::command::confirm, longest);
  CHECK_FALSE(sbgc::Angles().read(other));
  CHECK_FALSE(sbgc::AnglesExt().read(other));
  CHECK_FALSE(sbgc::Params3().read(other));
  CHECK(sbgc::Params3().read(view(sbgc::command::read_params_3, longest)));
  CHECK(sbgc::Params3().read(view(sbgc::command::write_params_3, longest)));
  sbgc::RealtimeCustom data(sbgc::custom::power_state);
  CHECK_FALSE(data.read(other));
  // Nothing was read yet; then bit 1 of the warnings says that a motor is too hot, and no axis is beyond the third.
  CHECK(data.field(sbgc::custom::power_state) == nullptr);
  CHECK_FALSE(data.warns_of_heat());
  REQUIRE(data.read(view(sbgc::command::realtime_data_custom, longest)));
  CHECK(data.warns_of_heat());
  CHECK(int(data.motor_C(2)) == int(data.motor_C(200)));
  const Data cool(255, 1);
  REQUIRE(data.read(view(sbgc::command::realtime_data_custom, cool)));
  CHECK_FALSE(data.warns_of_heat());
}
