// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "cost.hpp"

#include "../../on_target/report.hpp"

#if defined(__AVR__)
extern "C" char __heap_start;
#endif

namespace cost {

volatile uint32_t sink;
volatile uint8_t small_sink;
volatile float real_sink;
Given given;

extern "C" void cost_nothing() {}

void give(uint16_t round) {
  static uint32_t random = 1;
  const bool is_corner = round < counter::corners;
  // Ordinary rounds: anything between the ordinary ends. Corners: the ends of the whole range, in every
  // combination.
  const auto pick = [&](uint8_t bit, int16_t lowest, int16_t low, int16_t high, int16_t highest) {
    if (is_corner) return (round >> bit & 1) != 0 ? highest : lowest;
    random = random * 1664525u + 1013904223u;
    const uint16_t span = static_cast<uint16_t>(high - low + 1);
    return static_cast<int16_t>(low + static_cast<int16_t>((random >> 16) * span >> 16));
  };
  given.level = static_cast<uint8_t>(pick(0, 0, 10, 250, 255));
  given.warm = pick(1, -50 * 128, 25 * 128, 58 * 128, 180 * 128);
  given.air = pick(2, -60 * 128, 16 * 128, 40 * 128, 125 * 128);
  given.error_units = static_cast<uint16_t>(pick(3, 0, 0, 60, 8192));
  given.rate = static_cast<fixed::Rate>(pick(4, -16384, -300, 1000, 16383)) * 32768;
  given.ticks = static_cast<fixed::Ticks>(pick(5, 0, 60, 70, 32767) * 2 + 1);
  given.fault = is_corner && round % 7 == 6 ? tp::LimitReason::link_silent : tp::LimitReason::none;
  given.camera_C = static_cast<int8_t>(pick(2, -128, 20, 34, 34));
  given.frame_C = static_cast<int8_t>(pick(3, 34, 20, 34, 127));
  given.battery_cV = static_cast<uint16_t>(is_corner && round % 11 == 10 ? 200 : 1260);
  given.warm_C = static_cast<float>(given.warm) / 128.0f;
  given.air_C = static_cast<float>(given.air) / 128.0f;
  given.error_deg = static_cast<float>(given.error_units) * 0.02197f;
  given.camera_real_C = static_cast<float>(given.camera_C);
  given.frame_real_C = static_cast<float>(given.frame_C);
  given.level_real = static_cast<float>(given.level);
  given.power_W = given.level_real * 0.04f;
  given.elapsed_s = static_cast<float>(given.ticks) * 256e-6f;
}

namespace {

const uint16_t depth = 640;
const uint8_t colour = 0xC5;

// The free memory below a function, where no frame lies and no interrupt comes: what is no longer painted was
// stack.
[[gnu::noinline]] void paint(uintptr_t from) {
  const uintptr_t to = reinterpret_cast<uintptr_t>(__builtin_frame_address(0));
  for (uintptr_t at = from; at < to; ++at) *reinterpret_cast<volatile uint8_t*>(at) = colour;
}
[[gnu::noinline]] uint16_t stack_of(counter::Operation operation) {
  const uintptr_t here = reinterpret_cast<uintptr_t>(__builtin_frame_address(0));
#if defined(__AVR__)
  if (here - depth < reinterpret_cast<uintptr_t>(&__heap_start))
    platform::stop(4);  // it would paint over variables
#endif
  paint(here - depth);
  operation();
  uint16_t clean = 0;
  while (clean < depth && *reinterpret_cast<volatile uint8_t*>(here - depth + clean) == colour) ++clean;
  return static_cast<uint16_t>(depth - clean);
}

void put(const char* text) {
  for (; *text != '\0'; ++text) platform::put(*text);
}
void put(uint32_t value) {
  char digits[10];
  uint8_t count = 0;
  do digits[count++] = static_cast<char>('0' + value % 10u);
  while ((value /= 10u) != 0);
  while (count > 0) platform::put(digits[--count]);
}

uint32_t costs[counter::rounds];  // of ordinary rounds, in order
uint32_t empty_cost;

uint32_t beyond_empty(uint32_t cost) { return cost > empty_cost ? cost - empty_cost : 0; }

}  // namespace

void row(const char* symbol, counter::Operation operation, counter::Operation set_up, Search search,
         uint16_t search_rounds) {
  uint16_t stack = 0;
  uint32_t worst = 0;
  for (uint16_t round = 0; round < counter::corners + counter::rounds; ++round) {
    give(round);
    const uint32_t cost = counter::once(operation, set_up);
    if (cost > worst) worst = cost;
    if (round >= counter::corners) {
      uint16_t at = static_cast<uint16_t>(round - counter::corners);
      for (; at > 0 && costs[at - 1] > cost; --at) costs[at] = costs[at - 1];
      costs[at] = cost;
    }
    set_up();
    const uint16_t used = stack_of(operation);
    if (used > stack) stack = used;
  }
  for (uint16_t round = 0; round < search_rounds; ++round) {
    search(round);
    const uint32_t cost = counter::once(operation, set_up);
    if (cost > worst) worst = cost;
  }
  if (operation == cost_nothing) {
    empty_cost = costs[0];
    return;
  }
  put(symbol);
  platform::put('|');
  put(beyond_empty(costs[counter::rounds / 2]));
  platform::put('|');
  put(beyond_empty(worst));
  platform::put('|');
  put(static_cast<uint32_t>(stack));
  platform::put('\n');
}

}  // namespace cost
