// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../../catch.hpp"

#include <thermopower/gap/fit/segment_choice.hpp>

#include <cstddef>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

/// Windows of an axis one after the other, each carrying the states of the one before on.
std::vector<Segment> windows(std::size_t count, Eigen::Index rows) {
  std::vector<Segment> list(count);
  for (std::size_t i = 0; i < count; ++i) {
    list[i].axis = true;
    list[i].begin = static_cast<Eigen::Index>(i) * rows;
    list[i].end = list[i].begin + rows;
    list[i].carries_on = i > 0;
  }
  return list;
}

}  // namespace

TEST_CASE("of a motion that repeats every part is among the windows that are kept, whatever its period") {
  const std::vector<Segment> all = windows(60, 100);
  for (std::size_t period = 2; period <= 60; ++period) {
    int out = 0, back = 0;
    for (const Segment& one : thinned_axis(all, 1500))
      if (!one.warm_up)
        ++(static_cast<std::size_t>(one.begin / 100) % period < (period + 1) / 2 ? out : back);
    INFO("there and back every " << period << " windows: " << out << " out, " << back << " back");
    CHECK(out >= 3);
    CHECK(back >= 3);
  }
}

TEST_CASE(
    "a window that is kept carries on from the one before it, which counts only where it is kept, too") {
  const std::vector<Segment> all = windows(60, 100);
  const std::vector<Segment> kept = thinned_axis(all, 1500);
  Eigen::Index rows = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const bool follows = i > 0 && kept[i - 1].end == kept[i].begin;
    CHECK(kept[i].carries_on == follows);
    if (kept[i].warm_up) continue;
    CHECK((follows || kept[i].begin == 0));
    rows += kept[i].end - kept[i].begin;
  }
  CHECK(rows >= 1400);
  CHECK(rows <= 1900);
}

TEST_CASE("short recordings are kept whole") {
  CHECK(thinned_axis(windows(60, 10), 1500).size() == 60);
  CHECK(thinned_axis(windows(3, 1000), 1500).size() == 3);
}

TEST_CASE(
    "of windows that were chosen half can be chosen again, and each still carries on from the one before it") {
  const std::vector<Segment> kept = thinned_axis(windows(400, 10), 1000);
  const std::vector<Segment> half = thinned_axis(kept, 500);
  Eigen::Index rows = 0;
  for (std::size_t i = 0; i < half.size(); ++i) {
    if (half[i].warm_up) continue;
    rows += half[i].end - half[i].begin;
    INFO("window at row " << half[i].begin);
    CHECK((half[i].begin == 0 || (i > 0 && half[i - 1].end == half[i].begin && half[i].carries_on)));
    // What only brought states about before does not count now.
    for (const Segment& one : kept)
      if (one.begin == half[i].begin) CHECK_FALSE(one.warm_up);
  }
  CHECK(rows >= 450);
  CHECK(rows <= 550);
}
