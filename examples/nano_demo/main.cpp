// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  does the program for the Nano do its work on the real chip, at the real pace of its serial line?
// Model:    an ATmega328P simulated cycle by cycle, an emulated SimpleBGC board, and motors that warm as the
//           corrected laws say.
// Notation: cycles at 16 MHz; POWER and P in counts of 0 .. 255.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <numeric>

#include <thermopower/io/output_files.hpp>

#include "rig.hpp"
#include "story.hpp"
#include "trace.hpp"

namespace {

using nano::Story;

template <class Value>
Value median(std::vector<Value> values) {
  if (values.empty()) return Value();
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void run(nano::Rig& rig, const Story& story) {
  const bool is_terminal = isatty(STDOUT_FILENO) != 0;
  std::size_t counted = 0;
  for (const nano::Phase& phase : Story::phases()) {
    while (rig.time_s() < phase.to_s - 1e-4) {
      rig.run_until(std::min(phase.to_s, rig.time_s() + 0.25));
      if (!is_terminal) continue;
      const auto& motor_C = story.samples().back().motor_C;
      std::printf("\r%5.1f of %.0f s  %-24s POWER %3d %3d %3d  motors %.1f %.1f %.1f degC ", rig.time_s(),
                  Story::end_s(), phase.name, rig.board().power(0), rig.board().power(1),
                  rig.board().power(2), motor_C[0], motor_C[1], motor_C[2]);
      std::fflush(stdout);
    }
    if (is_terminal) std::printf("\r%-110s\r", "");
    const auto& motor_C = story.samples().back().motor_C;
    std::printf("%5.1f s  %-24s %4zu updates, POWER %3d %3d %3d, motors %.1f %.1f %.1f degC\n", rig.time_s(),
                phase.name, rig.updates().size() - counted, rig.board().power(0), rig.board().power(1),
                rig.board().power(2), motor_C[0], motor_C[1], motor_C[2]);
    std::fflush(stdout);
    counted = rig.updates().size();
  }
}

void print_axes(const nano::Trace& trace, const Story& story) {
  const double percent = trace.points.empty() ? 0 : 100.0 / double(trace.points.size());
  const auto share = [&](const char* label, auto belongs) {
    std::printf("  %-30s", label);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto count = std::count_if(trace.points.begin(), trace.points.end(),
                                       [&](const nano::Point& point) { return belongs(point.axes[axis]); });
      std::printf("%9.1f %%", percent * double(count));
    }
    std::printf("\n");
  };
  const auto highest = [&](const char* label, double nano::AxisPoint::*member) {
    std::printf("  %-30s", label);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double value = -1e300;
      for (const nano::Point& point : trace.points) value = std::max(value, point.axes[axis].*member);
      std::printf("%6.1f degC", value);
    }
    std::printf("\n");
  };
  std::printf("\n%-32s%11s%11s%11s\n", "Share of the updates", "roll", "pitch", "yaw");
  for (int from = 1; from <= 250; from = from == 1 ? 25 : from + 25) {
    const int to = from == 1 ? 24 : (from == 250 ? 255 : from + 24);
    share(("POWER " + std::to_string(from) + " .. " + std::to_string(to)).c_str(),
          [&](const nano::AxisPoint& point) { return point.power >= from && point.power <= to; });
  }
  using thermopower::LimitReason;
  for (const LimitReason reason : {LimitReason::none, LimitReason::safety_temperature,
                                   LimitReason::over_temperature, LimitReason::recovering})
    share((std::string("limiter: ") + nano::words(reason)).c_str(),
          [&](const nano::AxisPoint& point) { return point.reason == reason; });
  share("limiter: fault", [](const nano::AxisPoint& point) { return thermopower::is_fault(point.reason); });
  std::printf("\n%-32s%11s%11s%11s\n", "Motors", "roll", "pitch", "yaw");
  highest("hottest, as the chip believes", &nano::AxisPoint::estimate_C);
  highest("hottest, as it was", &nano::AxisPoint::true_C);
  std::printf("  %-30s%9.1f J%10.1f J%10.1f J\n", "energy in the winding, V_rms I", story.winding_J(0),
              story.winding_J(1), story.winding_J(2));
  std::printf("  %-30s%9.1f J%10.1f J%10.1f J\n", "energy from the supply, 13 V I", story.supply_J(0),
              story.supply_J(1), story.supply_J(2));
}

void print_link_and_chip(nano::Rig& rig, const nano::Trace& trace) {
  std::vector<std::uint64_t> response, update;
  for (const nano::Update& each : rig.updates()) {
    response.push_back(each.response_cycles());
    if (each.queued_cycle != 0) update.push_back(each.queued_cycle - each.last_in_cycle);
  }
  const auto& counters = rig.board().counters();
  std::printf("\nLink\n");
  std::printf(
      "  requests %llu, answers %llu, commands obeyed %llu; frames lost: %llu to the chip, %llu to the "
      "board\n",
      static_cast<unsigned long long>(rig.requests()),
      static_cast<unsigned long long>(counters.telemetry_sent),
      static_cast<unsigned long long>(counters.variables_set),
      static_cast<unsigned long long>(counters.telemetry_sent - rig.updates().size() - rig.under_way()),
      static_cast<unsigned long long>(rig.board().received().payload_checksum +
                                      rig.board().received().timeouts));
  std::printf(
      "  fullest receive buffer %u of 63 bytes; the controller on this computer gives the chip's commands in "
      "%.2f %% of updates\n",
      rig.fullest_receive_buffer(),
      trace.points.empty() ? 0.0 : 100.0 * double(trace.agreeing) / double(trace.points.size()));
  std::printf("\nChip: ATmega328P at 16 MHz\n");
  std::printf("  flash %u B, static RAM %u B, deepest stack %u B\n", rig.chip().elf().flash_bytes,
              rig.chip().elf().static_ram_bytes, unsigned(rig.chip().deepest_stack_bytes()));
  if (response.empty()) return;
  std::printf("  last byte in to first byte out: median %llu cycles (%.2f ms), worst %llu\n",
              static_cast<unsigned long long>(median(response)), double(median(response)) / 16000.0,
              static_cast<unsigned long long>(*std::max_element(response.begin(), response.end())));
  if (update.empty()) return;
  std::printf("  last byte in to whole command handed over: median %llu cycles, worst %llu\n",
              static_cast<unsigned long long>(median(update)),
              static_cast<unsigned long long>(*std::max_element(update.begin(), update.end())));
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app(
      "Runs nano_gimbal on a simulated ATmega328P against an emulated SimpleBGC board, through a scripted "
      "minute.");
  std::string elf, csv, svg;
  app.add_option("--elf", elf,
                 "Program for the ATmega328P: build/avr-nano/bin/nano_gimbal.elf of the preset avr-nano")
      ->required();
  app.add_option("--csv", csv, "Write the traces here");
  app.add_option("--svg", svg, "Write a picture of the traces here");
  CLI11_PARSE(app, count, arguments);
  try {
    if (::access(elf.c_str(), R_OK) != 0)
      throw std::runtime_error(elf + ": no such program. Build it first: cmake --workflow --preset avr-nano");
    thermopower::io::OutputFiles files;
    if (!csv.empty()) files.expect(csv);
    if (!svg.empty()) files.expect(svg);

    Story story;
    nano::Rig rig(elf, {},
                  [&](double time_s, nano::Rig::Board& board) { return story.advance(time_s, board); });
    run(rig, story);
    if (rig.updates().empty())
      throw std::runtime_error(elf + ": in a minute, this program answered no telemetry");
    const nano::Trace trace = nano::Trace::of(rig, story);
    print_axes(trace, story);
    print_link_and_chip(rig, trace);
    if (!csv.empty()) files.put(csv, trace.csv());
    if (!svg.empty()) files.put(svg, trace.svg());
    files.commit();
  } catch (const thermopower::io::OutputError& error) {
    std::cerr << "nano_demo: " << error.what() << '\n';
    return 3;
  } catch (const std::exception& error) {
    std::cerr << "nano_demo: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
