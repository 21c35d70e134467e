// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <functional>
#include <vector>

/// @file speed_timing.hpp
/// How the benchmarks of simulation_speed measure: works in turns, medians, operations counted, and what the
/// machine could do.

namespace speed {

/// Seconds of processor time of every work in every round. The works take turns, so that whatever else the
/// machine does, and whatever clock it runs at, meets all of them alike.
inline std::vector<std::vector<double>> in_turns(int rounds,
                                                 const std::vector<std::function<void()>>& works) {
  std::vector<std::vector<double>> needed_s(works.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < works.size(); ++i) {
      const std::clock_t begin = std::clock();
      works[i]();
      needed_s[i].push_back(static_cast<double>(std::clock() - begin) / static_cast<double>(CLOCKS_PER_SEC));
    }
  }
  return needed_s;
}

/// The middle of some numbers.
inline double median(std::vector<double> numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

/// The median over the rounds of how many times `one` takes the time of `other`.
inline double median_ratio(const std::vector<double>& one, const std::vector<double>& other) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < one.size(); ++i) ratios.push_back(one[i] / other[i]);
  return median(ratios);
}

/// What was done with the numbers of a `Counted`.
struct Operations {
  double sums = 0, products = 0;
  double sums_of_products = 0;  ///< Sums one of whose terms is a product: no more can be fused.
  double divisions_and_roots = 0;

  /// Floating-point operations, in the usual way of counting: each of the four kinds and a root is one.
  /// Comparisons, selections and signs are none, though they take time.
  double total() const { return sums + products + divisions_and_roots; }
  /// The most of the multiply-add peak that any code for these operations in this order can reach on a core
  /// that does all arithmetic in its multiply-add units: a sum or a product alone takes the place of two
  /// operations, and so does a division or a root if it cost no more.
  double ceiling() const {
    const double fused = std::fmin(sums_of_products, products);
    return total() / (2.0 * (total() - fused));
  }
};

/// What was done between two counts.
inline Operations operator-(const Operations& after, const Operations& before) {
  return {after.sums - before.sums, after.products - before.products,
          after.sums_of_products - before.sums_of_products,
          after.divisions_and_roots - before.divisions_and_roots};
}

/// A number that counts what is done with it.
template <class Real>
struct Counted {
  using Scalar = Real;
  Real value = Real(0);
  bool is_product = false;
  static inline Operations done = {};

  Counted() = default;
  Counted(Real number) : value(number) {}  // NOLINT: numbers convert
  Counted(Real number, bool product) : value(number), is_product(product) {}
  Counted& operator+=(Counted other) { return *this = *this + other; }

  friend Counted operator+(Counted a, Counted b) { return added(a, b, a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return added(a, b, a.value - b.value); }
  friend Counted operator-(Counted a) { return {-a.value, a.is_product}; }
  friend Counted operator*(Counted a, Counted b) {
    ++done.products;
    return {a.value * b.value, true};
  }
  friend Counted operator/(Counted a, Counted b) { return dear(a.value / b.value); }
  friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
  friend Counted sqrt(Counted a) { return dear(std::sqrt(a.value)); }
  friend Counted exp(Counted a) { return dear(std::exp(a.value)); }
  friend Counted log(Counted a) { return dear(std::log(a.value)); }

private:
  static Counted added(Counted a, Counted b, Real value) {
    ++done.sums;
    if (a.is_product || b.is_product) ++done.sums_of_products;
    return {value};
  }
  static Counted dear(Real value) {
    ++done.divisions_and_roots;
    return {value};
  }
};

/// Floating-point operations of one call of multiply_adds().
template <class Real>
constexpr double multiply_adds_operations();

#if defined(__AVX512F__)
constexpr int register_bytes = 64;
#elif defined(__AVX__)
constexpr int register_bytes = 32;
#else
constexpr int register_bytes = 16;
#endif
constexpr long multiply_add_rounds = 5000000;

template <class Real>
constexpr double multiply_adds_operations() {
  return 2.0 * 12 * (register_bytes / static_cast<int>(sizeof(Real))) *
         static_cast<double>(multiply_add_rounds);
}

/// Multiply-adds on registers only: what one core really does of them is the peak that others are held
/// against. Twelve independent chains cover the latency of two units, and fit into sixteen registers.
template <class Real>
void multiply_adds() {
  typedef Real Vector __attribute__((vector_size(register_bytes)));
  const Vector factor = Vector{} + static_cast<Real>(0.999);
  Vector a = factor, b = a + a, c = b + a, d = c + a, e = d + a, f = e + a, g = f + a, h = g + a, i = h + a,
         j = i + a, k = j + a, l = k + a;
  for (long round = 0; round < multiply_add_rounds; ++round) {
    a = a * factor + factor, b = b * factor + factor, c = c * factor + factor, d = d * factor + factor;
    e = e * factor + factor, f = f * factor + factor, g = g * factor + factor, h = h * factor + factor;
    i = i * factor + factor, j = j * factor + factor, k = k * factor + factor, l = l * factor + factor;
  }
  volatile Real keep = (a + b + c + d + e + f + g + h + i + j + k + l)[0];
  (void)keep;
}

/// The classical Runge-Kutta step of an array of numbers, or of lanes.
template <class State, class Real, class Slope>
State runge_kutta_step(const State& y, Real h, const Slope& slope) {
  using Number = typename State::value_type;
  const auto moved = [](const State& from, const State& rate, Real by) {
    State to;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = Number(from[i] + by * rate[i]);
    return to;
  };
  State rate = slope(y), sum = rate;
  rate = slope(moved(y, rate, h / 2));
  sum = moved(sum, rate, Real(2));
  rate = slope(moved(y, rate, h / 2));
  sum = moved(sum, rate, Real(2));
  rate = slope(moved(y, rate, h));
  sum = moved(sum, rate, Real(1));
  return moved(y, sum, h / 6);
}

// Each part prints its table. @return whether what it checks before it measures holds
bool lorenz();
bool hinge();

}  // namespace speed
