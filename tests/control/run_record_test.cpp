// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Recorded runs: what is written is replayed, and what differs, is damaged or is missing is said.

#include <thermopower/run_record.hpp>

#include <cmath>
#include <string>

#include "../catch.hpp"

namespace {

namespace tp = thermopower;

struct Text {
  std::string all;
  std::size_t write(const std::uint8_t* bytes, std::size_t count) {
    all.append(reinterpret_cast<const char*>(bytes), count);
    return count;
  }
};

/// Sums what it is told; a step remembers those before it. @tparam error  added to each answer
template <int error>
struct Summing {
  struct Told {
    std::uint16_t addend;
    std::uint32_t scale;
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.addend, self.scale);
    }
  };
  struct Answered {
    std::uint8_t low;
    float mean[2];
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.low, self.mean);
    }
  };
  Answered step(const Told& told) {
    sum += told.addend;
    ++count;
    const float mean = static_cast<float>(sum) / static_cast<float>(count * told.scale);
    const float off = error == 1 ? std::nextafterf(mean, 1e9f) : mean;
    return {static_cast<std::uint8_t>(sum + (error == 2 ? 1 : 0)), {off, -mean}};
  }
  std::uint32_t sum = 0, count = 0;
};
typedef Summing<0> Firmware;

/// The same fields in another order.
struct Other : Firmware {
  struct Told : Firmware::Told {
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.scale, self.addend);
    }
  };
};

std::string recorded(int steps) {
  Text text;
  tp::RunWriter<Text> writer(text);
  Firmware firmware;
  writer.begin(Firmware::Told(), Firmware::Answered());
  for (int i = 0; i < steps; ++i) {
    const Firmware::Told told = {static_cast<std::uint16_t>(i * 977), static_cast<std::uint32_t>(i + 1)};
    writer.step(told, firmware.step(told));
  }
  return text.all;
}

template <class Replayed>
tp::RunReplayed replay(const std::string& text) {
  tp::RunReplay<Replayed> replay;
  for (const char character : text) replay.feed(character);
  return replay.result();
}

std::string without_line(const std::string& text, int line) {
  std::size_t from = 0;
  while (line-- > 0) from = text.find('\n', from) + 1;
  return text.substr(0, from) + text.substr(text.find('\n', from) + 1);
}

}  // namespace

TEST_CASE("a recorded run replays bit for bit, across the wrap of its step numbers") {
  const tp::RunReplayed result = replay<Firmware>(recorded(600));
  CHECK(result.is_identical());
  CHECK(result.steps == 600);
}

TEST_CASE("a line is the bytes that the page says") {
  CHECK(recorded(0).substr(0, 3) == "P01");
  const std::string line = recorded(1).substr(recorded(0).size());
  // Step 0; 0 and 1; the sum, and the mean and its opposite: 0 and -0.
  CHECK(line.substr(0, 3 + 4 + 8 + 2 + 16) ==
        "R00"
        "0000"
        "01000000"
        "00"
        "0000000000000080");
  CHECK(line.size() == 3 + 4 + 8 + 2 + 16 + 4 + 1);
}

TEST_CASE("an answer that differs is told from a decision that does, and the first field of them is named") {
  const tp::RunReplayed last_bit = replay<Summing<1>>(recorded(20));
  CHECK_FALSE(last_bit.is_identical());
  CHECK(last_bit.different == 20);
  CHECK(last_bit.decisions_other == 0);
  CHECK(last_bit.most_units == 1);
  CHECK(last_bit.first.step == 1);
  CHECK(last_bit.first.field == 2);
  CHECK(last_bit.first.is_float);
  CHECK(last_bit.first.replayed == last_bit.first.recorded + 1);
  const tp::RunReplayed decision = replay<Summing<2>>(recorded(20));
  CHECK(decision.decisions_other == 20);
  CHECK(decision.first.field == 1);
  CHECK_FALSE(decision.first.is_float);
  CHECK(replay<Firmware>(recorded(20)).first.step == 0);
}

TEST_CASE("a line that is damaged or missing ends the comparison until the firmware starts again") {
  const std::string whole = recorded(20);
  std::string damaged = whole;
  damaged[damaged.size() / 2] = damaged[damaged.size() / 2] == '0' ? '1' : '0';
  const tp::RunReplayed one = replay<Firmware>(damaged + whole);
  CHECK(one.damaged == 1);
  CHECK(one.steps < 40);
  CHECK(one.steps >= 20);
  CHECK(one.different == 0);
  CHECK_FALSE(one.is_identical());

  const tp::RunReplayed two = replay<Firmware>(without_line(whole, 8) + whole);
  CHECK(two.lost == 1);
  CHECK(two.steps == 7 + 20);
  CHECK(two.different == 0);
  CHECK_FALSE(two.is_identical());
}

TEST_CASE("every change of a single character of a recording is noticed or changes nothing") {
  const std::string whole = recorded(4);
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const char other : {'0', '7', 'f', 'R', 'P', ' ', '\n', '\r', 'x'}) {
      std::string changed = whole;
      changed[at] = other;
      const tp::RunReplayed result = replay<Firmware>(changed);
      INFO("character " << at << " is " << int(other));
      CHECK((changed == whole || !result.is_identical() || result.steps < 4));
      CHECK(result.different == 0);
    }
}

TEST_CASE(
    "other lines and line ends are left alone; another firmware's recording and none are no identical run") {
  std::string text = recorded(5);
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\r\n");
  CHECK(replay<Firmware>("motor_C:25\n\n" + text + "bye\n").is_identical());
  CHECK_FALSE(replay<Firmware>("").is_identical());
  const tp::RunReplayed other = replay<Other>(text);
  CHECK(other.is_other_layout);
  CHECK(other.steps == 0);
  CHECK_FALSE(replay<Firmware>(recorded(5).substr(recorded(0).size())).is_identical());
}
