// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thermopower/sbgc/codec.hpp>
#include <vector>

#include "../catch.hpp"
#include "reference.hpp"

namespace support {

using reference::Data;
namespace sbgc = thermopower::sbgc;

inline std::ifstream open(const std::string& name) {
  std::ifstream file(std::string(THERMOPOWER_TEST_DATA) + "/sbgc/" + name);
  if (!file) throw std::runtime_error("no test data file " + name);
  return file;
}

inline Data load_hex(const std::string& name) {
  std::ifstream file = open(name);
  Data data;
  for (unsigned byte; file >> std::hex >> byte;) data.push_back(static_cast<std::uint8_t>(byte));
  if (data.empty()) throw std::runtime_error("empty test data file " + name);
  return data;
}

inline std::map<std::string, int> load_fields(const std::string& name) {
  std::ifstream file = open(name);
  std::map<std::string, int> fields;
  std::string field;
  for (int value; file >> field >> value;) fields[field] = value;
  if (fields.empty()) throw std::runtime_error("empty test data file " + name);
  return fields;
}

inline bool is_near(float value, double expected) {
  return std::fabs(static_cast<double>(value) - expected) <= 1e-6 * std::fabs(expected);
}

template <class Receiver>
reference::Frame copy(const Receiver& receiver) {
  const sbgc::Frame frame = receiver.frame();
  reference::Frame result;
  result.start = static_cast<std::uint8_t>(frame.version);
  result.id = frame.id;
  result.payload.assign(frame.payload, frame.payload + frame.size);
  return result;
}

// Everything a receiver makes of some bytes, none of them late.
template <class Receiver>
std::vector<reference::Frame> receive_all(Receiver& receiver, const Data& data, std::uint32_t now_us = 0) {
  std::vector<reference::Frame> frames;
  for (const std::uint8_t byte : data)
    for (bool got = receiver.receive(byte, now_us); got; got = receiver.next())
      frames.push_back(copy(receiver));
  return frames;
}

// What a receiver still brings out when no more bytes come.
template <class Receiver>
std::vector<reference::Frame> after_silence(Receiver& receiver, std::uint32_t now_us = 1000000) {
  std::vector<reference::Frame> frames;
  do
    if (receiver.poll(now_us)) frames.push_back(copy(receiver));
  while (receiver.has_frame() || receiver.has_unread());
  return frames;
}

template <class Receiver>
std::vector<reference::Frame> receive_then_silence(Receiver& receiver, const Data& data) {
  std::vector<reference::Frame> frames = receive_all(receiver, data);
  for (const reference::Frame& frame : after_silence(receiver)) frames.push_back(frame);
  return frames;
}

inline Data operator+(Data a, const Data& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// A frame handed to a message's read() without a wire.
inline sbgc::Frame view(std::uint8_t id, const Data& payload) {
  return sbgc::Frame{id, static_cast<std::uint8_t>(payload.size()), payload.data(), sbgc::Version::v1};
}

template <class Protocol, class Message>
Data encoded(const Message& message, sbgc::Version version = Protocol().sending()) {
  Data frame(300);
  frame.resize(sbgc::encode<Protocol>(message, frame.data(), frame.size(), version));
  return frame;
}

struct VectorWire {
  std::vector<Data> writes;
  Data all;
  std::size_t write(const std::uint8_t* data, std::size_t size) {
    writes.emplace_back(data, data + size);
    all.insert(all.end(), data, data + size);
    return size;
  }
};

}  // namespace support
