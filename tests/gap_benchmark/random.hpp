// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace gap_benchmark {

/// Random numbers that are the same on every platform: xoshiro256** seeded by splitmix64.
/// The standard library's distributions differ between vendors, and a benchmark must not.
class Random {
public:
  explicit Random(std::uint64_t seed) {
    for (auto& word : state_) {
      seed += 0x9e3779b97f4a7c15ull;
      std::uint64_t mixed = seed;
      mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9ull;
      mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebull;
      word = mixed ^ (mixed >> 31);
    }
  }

  std::uint64_t bits() {
    const auto rotate = [](std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); };
    const std::uint64_t result = rotate(state_[1] * 5, 7) * 9;
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = rotate(state_[3], 45);
    return result;
  }

  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double uniform(double from, double to) { return from + (to - from) * uniform(); }
  double log_uniform(double from, double to) { return from * std::exp(uniform() * std::log(to / from)); }
  bool chance(double probability) { return uniform() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

  /// An integer in [from, to].
  int integer(int from, int to) {
    return from + static_cast<int>(bits() % static_cast<std::uint64_t>(to - from + 1));
  }

  double gauss() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double x = 0.0, y = 0.0, square = 0.0;
    do {
      x = uniform(-1.0, 1.0);
      y = uniform(-1.0, 1.0);
      square = x * x + y * y;
    } while (square >= 1.0 || square < 1e-300);
    const double scale = std::sqrt(-2.0 * std::log(square) / square);
    spare_ = y * scale;
    has_spare_ = true;
    return x * scale;
  }

  template <class Value>
  Value pick(std::initializer_list<Value> values) {
    return *(values.begin() + integer(0, static_cast<int>(values.size()) - 1));
  }

  template <class Value>
  void shuffle(std::vector<Value>& values) {
    for (int i = static_cast<int>(values.size()) - 1; i > 0; --i)
      std::swap(values[static_cast<std::size_t>(i)], values[static_cast<std::size_t>(integer(0, i))]);
  }

private:
  std::uint64_t state_[4];
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// A slowly wandering quantity: a first-order Gauss-Markov process sampled at its own times.
class Wander {
public:
  Wander(double deviation, double time_constant_s)
      : deviation_(deviation), time_constant_s_(time_constant_s) {}

  double next(Random& random, double elapsed_s) {
    if (!started_) {
      started_ = true;
      return value_ = deviation_ * random.gauss();
    }
    const double keep = std::exp(-elapsed_s / time_constant_s_);
    return value_ = keep * value_ + deviation_ * std::sqrt(1.0 - keep * keep) * random.gauss();
  }

private:
  double deviation_;
  double time_constant_s_;
  double value_ = 0.0;
  bool started_ = false;
};

/// What noise a sensor has.
enum class NoiseKind {
  mild,         ///< white, with a share of its variance remembered over a few samples
  coloured,     ///< all of it remembered: 0.95 from one sample to the next
  heavy_tailed  ///< Student's t with three degrees of freedom, of the same standard deviation
};

/// Sensor noise of a standard deviation.
class SensorNoise {
public:
  SensorNoise(double deviation, double coloured_share, double memory_samples,
              NoiseKind kind = NoiseKind::mild)
      : kind_(kind),
        white_(deviation * std::sqrt(kind == NoiseKind::coloured ? 0.0 : 1.0 - coloured_share)),
        coloured_(deviation * std::sqrt(kind == NoiseKind::coloured ? 1.0 : coloured_share),
                  kind == NoiseKind::coloured ? -1.0 / std::log(0.95) : memory_samples) {}

  double next(Random& random) {
    double white = random.gauss();
    if (kind_ == NoiseKind::heavy_tailed) {
      double square = 0.0;
      for (int i = 0; i < 3; ++i) square += std::pow(random.gauss(), 2.0);
      white /= std::sqrt(square);  // t / sqrt(3), whose variance is one
    }
    return white_ * white + coloured_.next(random, 1.0);
  }

private:
  NoiseKind kind_;
  double white_;
  Wander coloured_;
};

}  // namespace gap_benchmark
