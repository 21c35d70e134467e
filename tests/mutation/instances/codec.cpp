// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// All of the codec as object code, with nothing known of what it is called with: what mutation.py compares.
#include <thermopower/sbgc/codec.hpp>
#include <thermopower/sbgc/poller.hpp>
#include <thermopower/sbgc/power_and_gain.hpp>

namespace sbgc = thermopower::sbgc;

struct Wire {
  size_t write(const uint8_t* data, size_t size);
};
struct SilentWire {
  void write(const uint8_t* data, size_t size);
};
struct Own {
  uint8_t id() const;
  size_t payload_size() const;
  template <class Sink>
  void write_payload(Sink& sink) const {
    for (size_t i = 0; i < payload_size(); ++i) sink.put(id());
  }
};
struct Sink {
  void put(uint8_t byte);
};
struct Command {
  uint8_t power[3];
  uint8_t p_gain[3];
};

template class sbgc::Receiver<255, sbgc::ProtocolV1>;
template class sbgc::Receiver<255, sbgc::ProtocolV2>;
template class sbgc::Receiver<255, sbgc::ProtocolAuto>;
template class sbgc::Receiver<249, sbgc::ProtocolAuto>;
template class sbgc::Receiver<250, sbgc::ProtocolV1>;
template class sbgc::Receiver<0, sbgc::ProtocolV1>;
template class thermopower::SbgcCodec<>;
template class thermopower::SbgcCodec<255, sbgc::ProtocolAuto>;
template class sbgc::BasicPoller<sbgc::StandardPolling>;
template class sbgc::PowerAndGain<Command>;
template struct sbgc::SetAdjVars<50>;
template struct sbgc::GetAdjVars<50>;
template struct sbgc::SetAdjVars<6> sbgc::power_and_gain(const Command&) noexcept;

template <class Codec, class Message>
void with_codec(Codec& codec, Message& message, uint8_t* frame, size_t capacity, Wire& wire,
                SilentWire& silent) {
  codec.read(message);
  codec.realtime_data();
  codec.encode(message, frame, capacity);
  codec.send(message, wire);
  codec.send(message, silent);
}
template <class Message>
size_t with(Message& message, uint8_t* frame, size_t capacity, Wire& wire, SilentWire& silent, Sink& sink,
            sbgc::Version version) {
  message.write_payload(sink);
  return sbgc::encode<sbgc::ProtocolV1>(message, frame, capacity) +
         sbgc::encode<sbgc::ProtocolV2>(message, frame, capacity, version) +
         sbgc::encode<sbgc::ProtocolAuto>(message, frame, capacity, version) +
         sbgc::send<sbgc::ProtocolV1>(message, wire) +
         sbgc::send<sbgc::ProtocolAuto, 1>(message, silent, version) +
         sbgc::send<sbgc::ProtocolV2, 255>(message, silent, version);
}
#define every_message(what)                                                                        \
  what(sbgc::Request) what(sbgc::Raw) what(sbgc::MotorsOn) what(sbgc::MotorsOff) what(sbgc::Reset) \
      what(sbgc::DataStreamInterval) what(sbgc::Control) what(sbgc::Confirm) what(sbgc::Error)     \
          what(sbgc::BoardInfo) what(sbgc::RealtimeFields) what(sbgc::RealtimeData)
#define instantiate(Message)                                                                             \
  template size_t with(Message&, uint8_t*, size_t, Wire&, SilentWire&, Sink&, sbgc::Version);            \
  template void with_codec(thermopower::SbgcCodec<>&, Message&, uint8_t*, size_t, Wire&, SilentWire&);   \
  template void with_codec(thermopower::SbgcCodec<255, sbgc::ProtocolAuto>&, Message&, uint8_t*, size_t, \
                           Wire&, SilentWire&);
every_message(instantiate) template size_t
    with(sbgc::SetAdjVars<50>&, uint8_t*, size_t, Wire&, SilentWire&, Sink&, sbgc::Version);
template size_t with(sbgc::GetAdjVars<50>&, uint8_t*, size_t, Wire&, SilentWire&, Sink&, sbgc::Version);
template size_t with(sbgc::PowerAndGain<Command>&, uint8_t*, size_t, Wire&, SilentWire&, Sink&,
                     sbgc::Version);
template size_t with(Own&, uint8_t*, size_t, Wire&, SilentWire&, Sink&, sbgc::Version);

// Constants that no function above needs, and what a message is before anybody has filled it.
extern const int ids[] = {sbgc::command::realtime_data_3,
                          sbgc::command::realtime_data_4,
                          sbgc::command::set_adj_vars_val,
                          sbgc::command::save_params_3,
                          sbgc::command::get_adj_vars_val,
                          sbgc::command::confirm,
                          sbgc::command::control,
                          sbgc::command::get_angles,
                          sbgc::command::motors_on,
                          sbgc::command::data_stream_interval,
                          sbgc::command::board_info,
                          sbgc::command::realtime_data_custom,
                          sbgc::command::motors_off,
                          sbgc::command::reset,
                          sbgc::command::error,
                          sbgc::variable::p_roll,
                          sbgc::variable::p_pitch,
                          sbgc::variable::p_yaw,
                          sbgc::variable::i_roll,
                          sbgc::variable::i_pitch,
                          sbgc::variable::i_yaw,
                          sbgc::variable::d_roll,
                          sbgc::variable::d_pitch,
                          sbgc::variable::d_yaw,
                          sbgc::variable::power_roll,
                          sbgc::variable::power_pitch,
                          sbgc::variable::power_yaw,
                          sbgc::control_mode::none,
                          sbgc::control_mode::speed,
                          sbgc::control_mode::angle,
                          sbgc::control_mode::speed_angle,
                          sbgc::control_mode::remote_control,
                          sbgc::control_mode::angle_rel_frame,
                          sbgc::MotorsOff::released,
                          sbgc::MotorsOff::brake,
                          sbgc::MotorsOff::safe_stop,
                          sbgc::Reset::notify,
                          sbgc::Reset::backup_state,
                          int(sbgc::Version::v1),
                          int(sbgc::Version::v2)};
extern const size_t sizes[] = {sizeof(sbgc::Receiver<255, sbgc::ProtocolV2>),
                               sizeof(sbgc::RealtimeFields),
                               sizeof(thermopower::SbgcCodec<>),
                               sizeof(sbgc::Control),
                               sizeof(sbgc::BoardInfo),
                               sizeof(sbgc::DataStreamInterval),
                               sizeof(sbgc::Error)};
#define set_fresh(Message) \
  void fresh(Message& message) { message = Message(); }
set_fresh(sbgc::Request) set_fresh(sbgc::MotorsOff) set_fresh(sbgc::Reset) set_fresh(sbgc::DataStreamInterval)
    set_fresh(sbgc::Control) set_fresh(sbgc::Confirm) set_fresh(sbgc::Error) set_fresh(sbgc::BoardInfo)
        set_fresh(sbgc::RealtimeFields) set_fresh(sbgc::RealtimeData) set_fresh(sbgc::AdjVarsView)
            set_fresh(sbgc::GetAdjVarsView) set_fresh(sbgc::Poller) set_fresh(sbgc::ProtocolAuto)
                set_fresh(thermopower::SbgcCodec<>)
