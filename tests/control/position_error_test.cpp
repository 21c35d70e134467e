// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/control/position_error.hpp>

#include "near.hpp"

#include <limits>
#include <random>

namespace tp = thermopower;

TEST_CASE("an angle is folded by whole turns to -180 .. 180 degrees") {
  CHECK(tp::wrap_deg(0.0f) == 0.0f);
  CHECK(tp::wrap_deg(180.0f) == 180.0f);
  CHECK(tp::wrap_deg(-180.0f) == -180.0f);
  CHECK(tp::wrap_deg(181.0f) == -179.0f);
  CHECK(tp::wrap_deg(-181.0f) == 179.0f);
  CHECK(tp::wrap_deg(360.0f) == 0.0f);
  CHECK(tp::wrap_deg(725.0f) == 5.0f);
  CHECK(std::abs(tp::wrap_deg(540.0f)) == 180.0f);
}

TEST_CASE(
    "every angle up to a million degrees folds into the range, and is whole turns away from where it was") {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> exponent(-3.0f, 6.0f);
  for (int i = 0; i < 2000000; ++i) {
    float angle = std::pow(10.0f, exponent(random));
    if (i % 2 == 1) angle = -angle;
    if (i % 3 == 0)
      angle = std::round(angle / 180.0f) * 180.0f;  // the edges, where rounding could choose the wrong turn
    const float folded = tp::wrap_deg(angle);
    if (std::abs(angle) >= 1.0e6f) continue;
    const double turns = (static_cast<double>(angle) - static_cast<double>(folded)) / 360.0;
    if (folded < -180.0f || folded > 180.0f || std::abs(turns - std::round(turns)) > 1e-9) {
      CAPTURE(angle, folded);
      FAIL("not folded");
    }
  }
  SUCCEED();
}

TEST_CASE("what is no angle gives NaN") {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity(), 1.0e6f, -3.0e38f})
    CHECK(std::isnan(tp::wrap_deg(bad)));
}

TEST_CASE("the error across 180 degrees is the short way round") {
  CHECK(tp::position_error_deg(179.0f, -179.0f) == Near(-2.0));
  CHECK(tp::position_error_deg(-179.0f, 179.0f) == Near(2.0));
  CHECK(tp::position_error_deg(10.0f, 4.0f) == Near(6.0));
}

TEST_CASE("in the board's units every pair of angles gives the short way round") {
  // A grid of strides coprime to the turn meets every residue; the extremes of int16 are added.
  const auto check = [](int target, int measured) {
    int expected = (target - measured) % 16384;
    if (expected < 0) expected += 16384;
    if (expected >= 8192) expected -= 16384;
    const int got = tp::position_error_units(static_cast<int16_t>(target), static_cast<int16_t>(measured));
    if (got != expected) {
      CAPTURE(target, measured, expected, got);
      FAIL("not the short way");
    }
  };
  for (int target = -32768; target <= 32767; target += 37)
    for (int measured = -32768; measured <= 32767; measured += 41) check(target, measured);
  for (int target = -32768; target <= 32767; ++target)
    for (const int measured : {-32768, -16384, -8192, -1, 0, 1, 8191, 8192, 16383, 32767})
      check(target, measured);
  SUCCEED();
}

TEST_CASE("units and degrees agree about the size of every error") {
  for (int target = -16384; target <= 16384; target += 13) {
    for (int measured = -8192; measured <= 8191; measured += 101) {
      const float from_units = tp::deg_from_units(
          tp::position_error_units(static_cast<int16_t>(target), static_cast<int16_t>(measured)));
      const float from_deg = tp::position_error_deg(tp::deg_from_units(static_cast<int16_t>(target)),
                                                    tp::deg_from_units(static_cast<int16_t>(measured)));
      // At exactly half a turn both signs are right.
      REQUIRE(std::abs(std::abs(from_units) - std::abs(from_deg)) < 1e-3f);
    }
  }
  CHECK(tp::deg_from_units(8192) == 180.0f);
  CHECK(tp::deg_from_units(-4096) == -90.0f);
}

TEST_CASE("the size of the error is the original's, program lines 188 and 189") {
  std::mt19937 random(6);
  std::uniform_int_distribution<int> angle(-32768, 32767);
  for (int i = 0; i < 200000; ++i) {
    const int16_t target = static_cast<int16_t>(angle(random)),
                  measured = static_cast<int16_t>(angle(random));
    float e = std::abs((static_cast<float>(target) - static_cast<float>(measured)) / 45.5111f);
    while (e > 180.0f) e = std::abs(e - 360.0f);
    const float ours = std::abs(tp::deg_from_units(tp::position_error_units(target, measured)));
    // 45.5111 is 16384/360 to six digits: 2.4e-7 of up to four turns.
    REQUIRE(std::abs(ours - e) < 2e-3f);
  }
}
