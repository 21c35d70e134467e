// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A few hundred runs of the campaign; the target run_fault_campaign makes a hundred thousand.

#include "fault_campaign.hpp"

#include "../catch.hpp"

TEST_CASE("whatever fails around it, a certified axis passes no limit, says what failed, and comes back") {
  campaign::Tally tally;
  for (std::uint32_t seed = 1; seed <= 500; ++seed) campaign::run(seed, tally);
  CHECK(tally.colder == 0);
  CHECK(tally.over == 0);
  CHECK(tally.uncontrolled < tally.runs / 5);  // the others say nothing about limits
  CHECK(tally.hottest_over_K > -6.0);          // nor would cold motors
  CHECK(tally.back > 600);
  CHECK(tally.not_back == 0);
  for (int fault = 0; fault < campaign::fault_count; ++fault) {
    INFO(campaign::name(fault));
    CHECK(tally.faults[fault] > 30);
    CHECK(tally.named[fault] == tally.nameable[fault]);
    CHECK(tally.slowest_clear_s[fault] < 0.1);
    // Twenty resets count 2 s of any power each, which is 40 s of heat that nobody saw.
    CHECK(tally.slowest_back_s[fault] < (fault == campaign::reset_series ? 120.0 : 60.0));
  }
}

TEST_CASE("the campaign finds a program that forgets") {
  campaign::Tally tally;
  for (std::uint32_t seed = 1; seed <= 300; ++seed) campaign::run(seed, tally, true);
  CHECK(tally.colder > 50);
}

TEST_CASE("the campaign finds a program that believes its thermistors") {
  campaign::Tally tally;
  for (std::uint32_t seed = 1; seed <= 300; ++seed) campaign::run(seed, tally, false, true);
  CHECK(tally.colder > 20);
  CHECK(tally.over > 0);
}
