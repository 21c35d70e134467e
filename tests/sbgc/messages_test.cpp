// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Messages: both ways, and what they refuse.

#include <cmath>
#include <limits>
#include <random>
#include <thermopower/sbgc/power_and_gain.hpp>

#include "support.hpp"

using namespace support;
namespace command = sbgc::command;

namespace {

using Codec = thermopower::SbgcCodec<255, sbgc::ProtocolAuto>;

// Sends a message and reads it back as `Received`, in both versions of the protocol.
template <class Received, class Sent, class Check>
void round_trip(const Sent& sent, Check check) {
  for (const sbgc::Version version : {sbgc::Version::v1, sbgc::Version::v2}) {
    Codec codec;
    const Data frame = encoded<sbgc::ProtocolAuto>(sent, version);
    REQUIRE(frame.size() == sbgc::frame_size(sent, version));
    REQUIRE(receive_all(codec, Data(frame.begin(), frame.end() - 1)).empty());
    REQUIRE(codec.receive(frame.back(), 0));
    CHECK(codec.frame().version == version);
    Received received = Received();
    REQUIRE(codec.read(received));
    check(received);
  }
}

// A payload one byte too short must be refused, and leave the message as it is.
template <class Message>
void refuses_shorter_than(std::uint8_t id, std::size_t size) {
  for (std::size_t length = 0; length < size; ++length) {
    Message message = Message();
    // A length that the compiler cannot know: it warns of what lies behind it on the way that is not taken.
    volatile std::size_t told = length;
    const Data payload(told, 1);
    CHECK_FALSE(message.read(view(id, payload)));
  }
}

}  // namespace

TEST_CASE("messages: the protocol's numbers are those of its specification") {
  // Specification 2.5: the tables of commands, of adjustable variables and of the modes of three commands.
  const int numbers[][2] = {{command::realtime_data_3, 23},
                            {command::realtime_data_4, 25},
                            {command::set_adj_vars_val, 31},
                            {command::save_params_3, 32},
                            {command::get_adj_vars_val, 64},
                            {command::confirm, 67},
                            {command::control, 67},
                            {command::get_angles, 73},
                            {command::motors_on, 77},
                            {command::data_stream_interval, 85},
                            {command::board_info, 86},
                            {command::realtime_data_custom, 88},
                            {command::motors_off, 109},
                            {command::reset, 114},
                            {command::error, 255},
                            {sbgc::variable::p_roll, 0},
                            {sbgc::variable::p_pitch, 1},
                            {sbgc::variable::p_yaw, 2},
                            {sbgc::variable::i_roll, 3},
                            {sbgc::variable::i_pitch, 4},
                            {sbgc::variable::i_yaw, 5},
                            {sbgc::variable::d_roll, 6},
                            {sbgc::variable::d_pitch, 7},
                            {sbgc::variable::d_yaw, 8},
                            {sbgc::variable::power_roll, 9},
                            {sbgc::variable::power_pitch, 10},
                            {sbgc::variable::power_yaw, 11},
                            {sbgc::control_mode::none, 0},
                            {sbgc::control_mode::speed, 1},
                            {sbgc::control_mode::angle, 2},
                            {sbgc::control_mode::speed_angle, 3},
                            {sbgc::control_mode::remote_control, 4},
                            {sbgc::control_mode::angle_rel_frame, 5},
                            {sbgc::MotorsOff::released, 0},
                            {sbgc::MotorsOff::brake, 1},
                            {sbgc::MotorsOff::safe_stop, 2},
                            {sbgc::Reset::notify, 1},
                            {sbgc::Reset::backup_state, 2},
                            {sbgc::RealtimeData::basic_size, 63},
                            {sbgc::RealtimeData::extended_size, 124}};
  for (const auto& number : numbers) CHECK(number[0] == number[1]);
}

TEST_CASE("messages: one that nobody has filled in is sent as zeros") {
  const auto zeros = [](std::uint8_t id, std::size_t size) {
    return reference::make_frame(0x3E, id, Data(size, 0));
  };
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::Confirm()) == zeros(67, 1));
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::Error()) == zeros(255, 5));
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::BoardInfo()) == zeros(86, 18));
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::Control()) == zeros(67, 15));
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::MotorsOff()) == zeros(109, 1));
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::Reset()) == zeros(114, 3));
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::DataStreamInterval()) == zeros(85, 21));
  sbgc::RealtimeFields fields;
  CHECK(encoded<sbgc::ProtocolV1>(fields) == zeros(25, 124));
  fields.extended = false;
  CHECK(encoded<sbgc::ProtocolV1>(fields) == zeros(23, 63));
  CHECK_FALSE(sbgc::Control().one_mode);
  CHECK(sbgc::GetAdjVarsView().ids.size == 0);
  CHECK(sbgc::Request().id() == 0);
}

TEST_CASE("messages: what is read stays within the message") {
  struct Guarded {
    sbgc::Error error;
    std::uint8_t behind_error;
    sbgc::DataStreamInterval stream;
    std::uint8_t behind_stream;
    sbgc::RealtimeFields fields;
    std::uint8_t behind_fields;
  } guarded = {{}, 0xEE, {}, 0xEE, {}, 0xEE};
  const Data longer(130, 1);
  REQUIRE(guarded.error.read(view(command::error, longer)));
  REQUIRE(guarded.stream.read(view(command::data_stream_interval, longer)));
  sbgc::Control control;
  REQUIRE(control.read(view(command::control, Data(15, 1))));
  CHECK_FALSE(control.one_mode);  // it lies behind the axes
  CHECK(int(guarded.behind_error) == 0xEE);
  CHECK(int(guarded.behind_stream) == 0xEE);
  REQUIRE(guarded.fields.read(view(command::realtime_data_4, longer)));
  CHECK(int(guarded.behind_fields) == 0xEE);
  CHECK(sizeof(sbgc::Error::data) == 4);
  CHECK(sizeof(sbgc::BoardInfo::reserved) == 3);
  using Fields = sbgc::RealtimeFields;
  for (const std::size_t size :
       {sizeof(Fields::acc), sizeof(Fields::gyro), sizeof(Fields::imu_angle), sizeof(Fields::frame_imu_angle),
        sizeof(Fields::target_angle), sizeof(Fields::rotor_angle), sizeof(Fields::balance_error),
        sizeof(Fields::magnetometer)})
    CHECK(size == 3 * sizeof(std::int16_t));
  CHECK(sizeof(Fields::rc) == 6 * sizeof(std::int16_t));
  CHECK(sizeof(Fields::motor_power) == 3);
  CHECK(sizeof(Fields::reserved_17) == 3);
  CHECK(sizeof(Fields::later) == 38);
  CHECK(sizeof(sbgc::Control::axis) == 3 * sizeof(sbgc::AxisControl));
}

TEST_CASE("messages: a gimbal's command is the same bytes with a table in between and without") {
  struct Command {
    std::uint8_t power[3] = {25, 125, 250};
    std::uint8_t p_gain[3] = {22, 143, 2};
  };
  const Command gimbal;
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::PowerAndGain<Command>(gimbal)) == load_hex("v1_set_adj_vars_6.hex"));
  CHECK(encoded<sbgc::ProtocolV2>(sbgc::PowerAndGain<Command>(gimbal)) == load_hex("v2_set_adj_vars_6.hex"));
}

TEST_CASE("messages: Request") {
  round_trip<sbgc::Request>(sbgc::Request(command::get_angles),
                            [](const sbgc::Request& r) { CHECK(r.id() == command::get_angles); });
  sbgc::Request request;
  CHECK_FALSE(request.read(view(command::get_angles, {1})));
  CHECK(encoded<sbgc::ProtocolV1>(request).empty());  // id 0
}

TEST_CASE("messages: Raw carries any id and any payload") {
  for (int id = 1; id <= 255; id += 2) {
    const Data payload(static_cast<std::size_t>(id), static_cast<std::uint8_t>(id));
    round_trip<sbgc::Raw>(
        sbgc::Raw{static_cast<std::uint8_t>(id), {payload.data(), static_cast<std::uint8_t>(id)}},
        [&](const sbgc::Raw& raw) {
          CHECK(int(raw.id()) == id);
          CHECK(Data(raw.data.data, raw.data.data + raw.data.size) == payload);
        });
  }
}

TEST_CASE("messages: Confirm") {
  const Data data = {5, 6};
  sbgc::Confirm confirm;
  confirm.confirmed_id = command::set_adj_vars_val;
  confirm.data = sbgc::Bytes{data.data(), 2};
  round_trip<sbgc::Confirm>(confirm, [&](const sbgc::Confirm& c) {
    CHECK(c.confirmed_id == command::set_adj_vars_val);
    CHECK(Data(c.data.data, c.data.data + c.data.size) == data);
  });
  CHECK(encoded<sbgc::ProtocolV1>(sbgc::Confirm()) == Data{0x3E, 67, 1, 68, 0, 0});
  refuses_shorter_than<sbgc::Confirm>(command::confirm, 1);
  sbgc::Confirm bare;
  const Data one = {command::set_adj_vars_val};
  REQUIRE(bare.read(view(command::confirm, one)));
  CHECK(bare.confirmed_id == command::set_adj_vars_val);
  CHECK(bare.data.size == 0);
  CHECK_FALSE(confirm.read(view(command::control, Data(13, 0))));
  CHECK_FALSE(confirm.read(view(command::control, Data(15, 0))));
  confirm.data.size = 255;  // would make 256 bytes
  CHECK(encoded<sbgc::ProtocolV1>(confirm).empty());
}

TEST_CASE("messages: Error") {
  sbgc::Error error;
  error.code = 2;
  for (std::uint8_t i = 0; i < 4; ++i) error.data[i] = static_cast<std::uint8_t>(10 + i);
  CHECK(encoded<sbgc::ProtocolV1>(error) == reference::make_frame(0x3E, 255, {2, 10, 11, 12, 13}));
  round_trip<sbgc::Error>(error, [](const sbgc::Error& e) {
    CHECK(e.code == 2);
    for (int i = 0; i < 4; ++i) CHECK(e.data[i] == 10 + i);
  });
  refuses_shorter_than<sbgc::Error>(command::error, 5);
}

TEST_CASE("messages: BoardInfo") {
  sbgc::BoardInfo info;
  info.board_version = 30;
  info.firmware_version = 2687;
  info.state_flags = 1;
  info.board_features = 0x8102;
  info.connection_flags = 1;
  info.firmware_extra_id = 0xDEADBEEF;
  info.board_features_ext = 0x0304;
  for (std::uint8_t i = 0; i < 3; ++i) info.reserved[i] = static_cast<std::uint8_t>(97 + i);
  info.base_firmware_version = 2600;
  CHECK(encoded<sbgc::ProtocolV1>(info) ==
        reference::make_frame(
            0x3E, 86,
            {30, 0x7F, 0x0A, 1, 0x02, 0x81, 1, 0xEF, 0xBE, 0xAD, 0xDE, 0x04, 0x03, 97, 98, 99, 0x28, 0x0A}));
  round_trip<sbgc::BoardInfo>(info, [&](const sbgc::BoardInfo& i) {
    CHECK(i.board_version == 30);
    CHECK(i.firmware_version == 2687);
    CHECK(i.state_flags == 1);
    CHECK(i.board_features == 0x8102);
    CHECK(i.connection_flags == 1);
    CHECK(i.firmware_extra_id == 0xDEADBEEF);
    CHECK(i.board_features_ext == 0x0304);
    for (int k = 0; k < 3; ++k) CHECK(i.reserved[k] == 97 + k);
    CHECK(i.base_firmware_version == 2600);
  });
  refuses_shorter_than<sbgc::BoardInfo>(command::board_info, 18);
}

TEST_CASE("messages: Control in both forms") {
  sbgc::Control control;
  for (std::uint8_t i = 0; i < 3; ++i) {
    control.axis[i].mode = static_cast<std::uint8_t>(sbgc::control_mode::speed + i);
    control.axis[i].speed = static_cast<std::int16_t>(-100 * (i + 1));
    control.axis[i].angle = static_cast<std::int16_t>(1000 * (i + 1));
  }
  const auto same_motion = [&](const sbgc::Control& c) {
    for (std::uint8_t i = 0; i < 3; ++i) {
      CHECK(c.axis[i].speed == control.axis[i].speed);
      CHECK(c.axis[i].angle == control.axis[i].angle);
    }
  };
  CHECK(encoded<sbgc::ProtocolV1>(control) ==
        reference::make_frame(
            0x3E, 67, {1, 2, 3, 0x9C, 0xFF, 0xE8, 0x03, 0x38, 0xFF, 0xD0, 0x07, 0xD4, 0xFE, 0xB8, 0x0B}));
  round_trip<sbgc::Control>(control, [&](const sbgc::Control& c) {
    same_motion(c);
    CHECK_FALSE(c.one_mode);
    for (std::uint8_t i = 0; i < 3; ++i) CHECK(c.axis[i].mode == control.axis[i].mode);
  });
  control.one_mode = true;
  round_trip<sbgc::Control>(control, [&](const sbgc::Control& c) {
    same_motion(c);
    CHECK(c.one_mode);
    for (std::uint8_t i = 0; i < 3; ++i) CHECK(c.axis[i].mode == control.axis[0].mode);
  });
  for (std::size_t size = 0; size < 40; ++size)
    CHECK(control.read(view(command::control, Data(size, 0))) == (size == 13 || size == 15));
}

TEST_CASE("messages: motors on and off, reset") {
  round_trip<sbgc::MotorsOn>(sbgc::MotorsOn(), [](const sbgc::MotorsOn&) {});
  sbgc::MotorsOff off;
  off.mode = sbgc::MotorsOff::safe_stop;
  round_trip<sbgc::MotorsOff>(off,
                              [](const sbgc::MotorsOff& m) { CHECK(m.mode == sbgc::MotorsOff::safe_stop); });
  CHECK(off.read(view(command::motors_off, {})));
  CHECK(off.mode == sbgc::MotorsOff::released);

  sbgc::Reset reset;
  reset.flags = sbgc::Reset::notify;
  reset.delay_ms = 1000;
  CHECK(encoded<sbgc::ProtocolV1>(reset) == reference::make_frame(0x3E, 114, {1, 0xE8, 0x03}));
  round_trip<sbgc::Reset>(reset, [](const sbgc::Reset& r) {
    CHECK(r.flags == sbgc::Reset::notify);
    CHECK(r.delay_ms == 1000);
  });
  CHECK_FALSE(reset.read(view(command::reset, {1})));
  CHECK_FALSE(reset.read(view(command::reset, {1, 2})));
  CHECK(reset.delay_ms == 1000);
  CHECK(reset.read(view(command::reset, {})));
  CHECK(reset.delay_ms == 0);
  CHECK(reset.flags == 0);
}

TEST_CASE("messages: DataStreamInterval") {
  sbgc::DataStreamInterval stream;
  stream.streamed_id = command::realtime_data_4;
  stream.interval_ms = 500;
  for (std::uint8_t i = 0; i < 8; ++i) stream.config[i] = static_cast<std::uint8_t>(70 + i);
  for (std::uint8_t i = 0; i < 10; ++i) stream.reserved[i] = static_cast<std::uint8_t>(1 + i);
  round_trip<sbgc::DataStreamInterval>(stream, [](const sbgc::DataStreamInterval& s) {
    CHECK(s.streamed_id == command::realtime_data_4);
    CHECK(s.interval_ms == 500);
    for (int i = 0; i < 8; ++i) CHECK(s.config[i] == 70 + i);
    for (int i = 0; i < 10; ++i) CHECK(s.reserved[i] == 1 + i);
  });
  CHECK(encoded<sbgc::ProtocolV1>(stream) ==
        reference::make_frame(
            0x3E, 85, {25, 0xF4, 0x01, 70, 71, 72, 73, 74, 75, 76, 77, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
  refuses_shorter_than<sbgc::DataStreamInterval>(command::data_stream_interval, 21);
}

TEST_CASE("messages: adjustable variables") {
  sbgc::SetAdjVars<3> set;
  set.vars[0] = {sbgc::variable::power_yaw, 200};
  set.vars[1] = {sbgc::variable::p_roll, -1};
  set.vars[2] = {sbgc::variable::power_yaw, std::numeric_limits<std::int32_t>::min()};
  round_trip<sbgc::AdjVarsView>(set, [](const sbgc::AdjVarsView& vars) {
    REQUIRE(vars.count() == 3);
    CHECK(vars[1].id == sbgc::variable::p_roll);
    CHECK(vars[1].value == -1);
    std::int32_t value = 5;
    CHECK(vars.find(sbgc::variable::power_yaw, value));
    CHECK(value == std::numeric_limits<std::int32_t>::min());  // the last one counts
    value = 5;
    CHECK_FALSE(vars.find(sbgc::variable::d_yaw, value));
    CHECK(value == 5);
    CHECK(int(vars[3].id) == 255);  // past the end
    CHECK(vars[255].value == 0);
  });

  sbgc::SetAdjVars<3> different = {{{1, 10}, {2, 20}, {3, 30}}};
  round_trip<sbgc::AdjVarsView>(different, [](const sbgc::AdjVarsView& vars) {
    for (std::uint8_t id = 1; id <= 3; ++id) {
      std::int32_t value = 0;
      CHECK(vars.find(id, value));
      CHECK(value == 10 * id);
    }
  });

  sbgc::SetAdjVars<50> most;
  for (std::uint8_t i = 0; i < 50; ++i) most.vars[i] = {i, i * 1000};
  round_trip<sbgc::AdjVarsView>(most, [](const sbgc::AdjVarsView& vars) {
    CHECK(vars.count() == 50);
    CHECK(vars[49].value == 49000);
  });

  sbgc::GetAdjVars<2> get = {{sbgc::variable::power_roll, sbgc::variable::p_roll}};
  CHECK(encoded<sbgc::ProtocolV1>(get) == reference::make_frame(0x3E, 64, {2, 9, 0}));
  round_trip<sbgc::GetAdjVarsView>(get, [](const sbgc::GetAdjVarsView& asked) {
    REQUIRE(asked.ids.size == 2);
    CHECK(asked.ids.data[0] == sbgc::variable::power_roll);
    CHECK(asked.ids.data[1] == sbgc::variable::p_roll);
  });

  SECTION("a count that the payload does not bear out is refused") {
    sbgc::AdjVarsView vars;
    CHECK(vars.count() == 0);
    CHECK_FALSE(vars.read(view(command::set_adj_vars_val, {})));
    CHECK_FALSE(vars.read(view(command::set_adj_vars_val, {1, 9, 0, 0, 0})));
    CHECK_FALSE(vars.read(view(command::set_adj_vars_val, Data(255, 255))));
    CHECK(vars.read(view(command::set_adj_vars_val, {0})));
    sbgc::GetAdjVarsView asked;
    CHECK_FALSE(asked.read(view(command::get_adj_vars_val, {})));
    CHECK_FALSE(asked.read(view(command::get_adj_vars_val, {2, 9})));
    CHECK(asked.read(view(command::get_adj_vars_val, {0})));
    CHECK(asked.ids.size == 0);
  }
}

TEST_CASE(
    "messages: telemetry is refused when short, and accepted with bytes of a newer firmware behind it") {
  refuses_shorter_than<sbgc::RealtimeData>(command::realtime_data_3, 63);
  refuses_shorter_than<sbgc::RealtimeData>(command::realtime_data_4, 124);
  refuses_shorter_than<sbgc::RealtimeFields>(command::realtime_data_4, 124);
  sbgc::RealtimeData data;
  CHECK_FALSE(data.read(view(command::board_info, Data(124, 0))));
  const Data longer(130, 0);
  CHECK(data.read(view(command::realtime_data_4, longer)));
  CHECK(int(data.payload_size()) == 124);
}

TEST_CASE("messages: what REALTIME_DATA_3 does not have reads as implausible") {
  const Data payload(63, 0);
  sbgc::RealtimeData data;
  REQUIRE(data.read(view(command::realtime_data_3, payload)));
  CHECK_FALSE(data.has_extended());
  CHECK_FALSE(data.motors_on());
  CHECK(data.payload().data == payload.data());
  CHECK(int(data.payload().size) == 63);
  CHECK(int(data.imu_C()) == -128);
  CHECK(int(data.frame_imu_C()) == -128);
  CHECK(std::isnan(data.current_A()));
  CHECK(data.current_mA() == 0);
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    CHECK(data.rotor_angle(axis) == 0);
    CHECK(data.balance_error(axis) == 0);
    CHECK(data.magnetometer(axis) == 0);
  }
}

TEST_CASE("messages: what REALTIME_DATA_3 does not have is not read from the bytes behind it") {
  const Data bytes(124, 0x55);
  sbgc::RealtimeData data;
  CHECK_FALSE(data.has_extended());
  REQUIRE(data.read(sbgc::Frame{command::realtime_data_3, 63, bytes.data(), sbgc::Version::v1}));
  CHECK(int(data.imu_C()) == -128);
  CHECK(int(data.frame_imu_C()) == -128);
  CHECK(std::isnan(data.current_A()));
  CHECK(data.current_mA() == 0);
  sbgc::RealtimeFields fields;
  REQUIRE(fields.read(sbgc::Frame{command::realtime_data_3, 63, bytes.data(), sbgc::Version::v1}));
  CHECK(int(fields.reserved_69) == 0);
  for (const std::uint8_t later : fields.later) CHECK(int(later) == 0);
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    CHECK(data.rotor_angle(axis) == 0);
    CHECK(data.balance_error(axis) == 0);
    CHECK(data.magnetometer(axis) == 0);
    CHECK(fields.rotor_angle[axis] == 0);
  }
}

TEST_CASE("messages: an axis that does not exist reads as yaw, inside the payload") {
  Data payload = load_hex("payload_rt4_real.hex");
  sbgc::RealtimeData data;
  REQUIRE(data.read(view(command::realtime_data_4, payload)));
  for (const std::uint8_t axis : {std::uint8_t(3), std::uint8_t(128), std::uint8_t(255)}) {
    CHECK(data.acc(axis) == data.acc(2));
    CHECK(data.gyro(axis) == data.gyro(2));
    CHECK(data.error_units(axis) == data.error_units(2));
    CHECK(data.imu_angle(axis) == data.imu_angle(2));
    CHECK(data.frame_imu_angle(axis) == data.frame_imu_angle(2));
    CHECK(data.target_angle(axis) == data.target_angle(2));
    CHECK(data.rotor_angle(axis) == data.rotor_angle(2));
    CHECK(data.balance_error(axis) == data.balance_error(2));
    CHECK(data.motor_power(axis) == data.motor_power(2));
    CHECK(data.magnetometer(axis) == data.magnetometer(2));
    CHECK(data.rc(axis == 3 ? std::uint8_t(6) : axis) == data.rc(5));
  }
}

TEST_CASE("messages: the position error does not overflow") {
  sbgc::RealtimeFields fields;
  fields.target_angle[0] = 32767;
  fields.imu_angle[0] = -32768;
  fields.target_angle[1] = -32768;
  fields.imu_angle[1] = 32767;
  round_trip<sbgc::RealtimeFields>(fields, [](const sbgc::RealtimeFields&) {});
  const Data frame = encoded<sbgc::ProtocolV1>(fields);
  const Data payload(frame.begin() + 4, frame.end() - 1);
  sbgc::RealtimeData data;
  REQUIRE(data.read(view(command::realtime_data_4, payload)));
  CHECK(data.error_units(0) == 65535);
  CHECK(data.error_units(1) == -65535);
  CHECK(is_near(data.error_deg(0), 1439.978));
}

TEST_CASE("messages: random telemetry survives fields and back, every byte") {
  std::mt19937 random(7);
  for (int run = 0; run < 200; ++run) {
    for (const std::uint8_t id : {command::realtime_data_3, command::realtime_data_4}) {
      Data payload(id == command::realtime_data_3 ? 63 : 124);
      for (std::uint8_t& byte : payload) byte = static_cast<std::uint8_t>(random());
      sbgc::RealtimeFields fields;
      REQUIRE(fields.read(view(id, payload)));
      CHECK(encoded<sbgc::ProtocolV2>(fields) == reference::make_frame(0x24, id, payload));
    }
  }
}

TEST_CASE("units: angles and speeds") {
  CHECK(sbgc::angle_deg(16384) == 360.0f);
  CHECK(sbgc::angle_deg(-4096) == -90.0f);
  CHECK(sbgc::angle_units(90.0f) == 4096);
  CHECK(sbgc::angle_units(-90.0f) == -4096);
  CHECK(sbgc::angle_units(1e9f) == 32767);
  CHECK(sbgc::angle_units(-1e9f) == -32768);
  CHECK(sbgc::angle_units(std::numeric_limits<float>::quiet_NaN()) == 0);
  CHECK(sbgc::angle_units(std::numeric_limits<float>::infinity()) == 32767);
  for (int units = -32768; units <= 32767; ++units)
    REQUIRE(sbgc::angle_units(sbgc::angle_deg(units)) == units);
  const auto units_of = [](float units) { return sbgc::angle_units(units * sbgc::deg_per_angle_unit); };
  for (const int units : {0, 1, 10, 100}) {  // the nearest
    CAPTURE(units);
    const float whole = static_cast<float>(units);
    CHECK(units_of(whole + 0.498f) == units);
    CHECK(units_of(whole + 0.502f) == units + 1);
    CHECK(units_of(-whole - 0.498f) == -units);
    CHECK(units_of(-whole - 0.502f) == -units - 1);
  }
  for (int beyond = 1; beyond < 1000; ++beyond) {
    REQUIRE(units_of(32767.0f + static_cast<float>(beyond)) == 32767);
    REQUIRE(units_of(-32768.0f - static_cast<float>(beyond)) == -32768);
  }
  CHECK(is_near(sbgc::speed_deg_per_s(1000), 122.0740379));
  CHECK(sbgc::speed_units(122.0740379f) == 1000);
  CHECK(sbgc::speed_units(-122.0740379f) == -1000);
}
