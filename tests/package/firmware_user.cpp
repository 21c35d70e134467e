// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a firmware author writes after `#include <thermopower/thermopower.hpp>`; built here in every way the library can be taken in.
#include <thermopower/thermopower.hpp>

#include <stdio.h>

namespace tp = thermopower;
typedef tp::AxisController<tp::motors::Bgm2606_90t> Roll;

int main() {
  const tp::GainConfig gain = {24.0f, 4.0f};
  Roll roll(Roll::Config::with_gain(gain));
  const Roll::Inputs calm = {0.05f, 13.0f, 25.0f, tp::LimitReason::none};
  const Roll::Inputs gust = {2.0f, 13.0f, 25.0f, tp::LimitReason::none};
  const unsigned at_rest = roll.step(calm, 0.01f).power;
  // The limiter starts fully open, so a gust gets the highest level at once.
  const unsigned in_gust = roll.step(gust, 0.01f).power;
  printf("power at rest %u, in a gust %u, library %d.%d.%d\n", at_rest, in_gust, tp::Version::major_number(),
         tp::Version::minor_number(), tp::Version::patch_number());
  return at_rest == 25 && in_gust == 250 ? 0 : 1;
}
