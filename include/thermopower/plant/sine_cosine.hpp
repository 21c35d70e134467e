// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace thermopower::plant {

/// Sine and cosine of an angle at once, each to 4e-16 up to a million rad.
///
/// A search for causes turns an angle into both some ten million times, and a C library's functions set the rounding mode at each
/// call. The angle is brought into -pi/4..pi/4 by quarter turns in three parts (Cody and Waite 1980), where both are
/// polynomials, those of the Sun Microsystems fdlibm (k_sin.c, k_cos.c, 1993).
struct SineCosine {
  double sine;    ///< -1..1; not a number where the angle is none
  double cosine;  ///< the same

  /// @param angle_rad  any; beyond a million rad, and where it is no number, the C library is asked
  explicit SineCosine(double angle_rad) {
    if (!(std::abs(angle_rad) < 1e6)) {
      sine = std::sin(angle_rad);
      cosine = std::cos(angle_rad);
      return;
    }
    constexpr double per_quarter = 6.36619772367581382433e-01;  // 2 / pi
    constexpr double quarter[] = {1.57079632673412561417e+00, 6.07710050630396597660e-11,
                                  2.02226624879595063154e-21};  // pi / 2, 33 bits of it each
    // To the nearest one: so large a number has no digits behind the point, and the count in its last bits.
    constexpr double whole = 6755399441055744.0;  // 1.5 times 2^52
    const double shifted = angle_rad * per_quarter + whole, count = shifted - whole;
    const std::uint64_t quarters = bits(shifted);
    const double x = angle_rad - count * quarter[0] - count * quarter[1] - count * quarter[2], z = x * x;
    const double s =
        x + x * z *
                (-1.66666666666666324348e-01 +
                 z * (8.33333333332248946124e-03 +
                      z * (-1.98412698298579493134e-04 +
                           z * (2.75573137070700676789e-06 +
                                z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)))));
    const double c =
        1.0 - (0.5 * z -
               z * z *
                   (4.16666666666666019037e-02 +
                    z * (-1.38888888888741095749e-03 +
                         z * (2.48015872894767294178e-05 +
                              z * (-2.75573143513906633035e-07 +
                                   z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11))))));
    // Without branches: which quarter an angle is in cannot be foretold.
    const std::uint64_t crossed = 0 - (quarters & 1), swapped = (bits(s) ^ bits(c)) & crossed;
    const auto sign = [](std::uint64_t turned) { return (turned & 2) << 62; };
    sine = number(bits(s) ^ swapped ^ sign(quarters));
    cosine = number(bits(c) ^ swapped ^ sign(quarters + 1));
  }

private:
  static std::uint64_t bits(double x) {
    std::uint64_t same;
    std::memcpy(&same, &x, sizeof same);
    return same;
  }
  static double number(std::uint64_t bits) {
    double same;
    std::memcpy(&same, &bits, sizeof same);
    return same;
  }
};

}  // namespace thermopower::plant
