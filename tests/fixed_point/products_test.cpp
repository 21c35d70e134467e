// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The products and the quotient that fixed-point controllers are made of, against 64-bit and floating-point
// arithmetic.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <thermopower/actuator/fixed_point/detail/reciprocal.hpp>

#include "../catch.hpp"

using namespace thermopower::fixed_point::detail;

TEST_CASE("scaled() is the rounded product over 65536, for every kind of value") {
  std::uint32_t random = 1;
  long wrong = 0;
  const auto check = [&](std::int32_t value, std::uint16_t factor) {
    const std::int64_t exact = (static_cast<std::int64_t>(value) * factor + 0x8000) >> 16;
    wrong += exact != scaled(value, factor);
  };
  for (const std::int32_t value :
       {0, 1, -1, 32767, -32768, 65535, 65536, -65536, 0x7fffffff, -0x7fffffff - 1})
    for (const int factor : {0, 1, 2, 255, 256, 32767, 32768, 65535})
      check(value, static_cast<std::uint16_t>(factor));
  for (long count = 0; count < 1000000; ++count) {
    random = random * 1664525u + 1013904223u;
    const auto value = static_cast<std::int32_t>(random);
    random = random * 1664525u + 1013904223u;
    check(value, static_cast<std::uint16_t>(random >> 16));
  }
  CHECK(wrong == 0);
}

TEST_CASE("the 16-bit products round down") {
  long wrong = 0;
  for (long left = -32767; left <= 32767; left += 37)
    for (long right = -32767; right <= 32767; right += 41)
      wrong += product_q15(static_cast<std::int16_t>(left), static_cast<std::int16_t>(right)) !=
               std::floor(double(left) * double(right) / 32768.0);
  for (long change = -32768; change <= 32767; ++change)
    for (int share = 0; share < 256; share += 15)
      wrong += part_of(static_cast<std::int16_t>(change), static_cast<std::uint8_t>(share)) !=
               std::floor(double(change) * share / 256.0);
  CHECK(wrong == 0);
}

TEST_CASE("the reciprocal is within 0.018 % and a unit, for every divisor") {
  double worst = 0;
  for (long divisor = 32768; divisor < 65536; ++divisor) {
    const double exact = 2147483648.0 / static_cast<double>(divisor);
    const double error = std::fabs(reciprocal(static_cast<std::uint16_t>(divisor)) - exact) - 1.0;
    worst = std::max(worst, error / exact);
  }
  CHECK(worst < 0.00018);
}

TEST_CASE("the products for 8-bit chips are what 32 bits give") {
  long wrong = 0;
  for (long value = -32768; value <= 32767; value += 13)
    for (long factor = 0; factor < 32768; factor += 97)
      wrong +=
          product(static_cast<std::int16_t>(value), static_cast<std::uint16_t>(factor)) != value * factor;
  for (std::uint64_t left = 0; left < 32768; left += 101)
    for (std::uint64_t right = 32768; right < 65536; right += 103)
      for (const std::uint64_t factor : {0u, 1u, 25u, 200u, 255u})
        wrong += product_of_three(static_cast<std::uint16_t>(left), static_cast<std::uint16_t>(right),
                                  static_cast<std::uint8_t>(factor)) != (left * right / 256) * factor;
  CHECK(wrong == 0);
}

TEST_CASE("the quotient is within 0.025 %, saturates near a pole and is zero beyond it") {
  double worst = 0;
  for (int exponent = -8; exponent <= 8; ++exponent)
    for (int dividend = 1; dividend < 32768; dividend += dividend / 8 + 1)
      for (int divisor = 1; divisor < 32768; divisor += divisor / 64 + 1)
        for (const int factor : {1, 7, 64, 250, 255}) {
          const double whole = std::ldexp(1.0, 15 + exponent) * dividend * factor / divisor;
          const double exact = std::min(whole, double(most_heating()));
          const double got = quotient(static_cast<std::uint16_t>(dividend), static_cast<std::uint8_t>(factor),
                                      static_cast<std::int8_t>(exponent), static_cast<std::int16_t>(divisor));
          // Rounded down at the end, and before: there a unit is multiplied by the factor and shifted.
          const double units = 2.0 + factor * std::ldexp(1.0, exponent - 8) * 65536.0 / divisor;
          worst = std::max(worst, (std::fabs(got - exact) - units) / exact);
        }
  CHECK(worst < 0.00025);
  for (const int divisor : {0, -1, -32767})
    CHECK(quotient(1000, 25, 0, static_cast<std::int16_t>(divisor)) == 0);
}
