// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// fault_campaign [<runs>]: runs of four minutes each, 100 000 if nothing is said, on all cores; prints what came of
// them as a table, and fails when one run broke a promise.

#include "fault_campaign.hpp"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <thread>

int main(int argument_count, char** arguments) {
  const long runs = argument_count > 1 ? std::strtol(arguments[1], nullptr, 10) : 100000;
  if (runs < 1) {
    std::fprintf(stderr, "usage: fault_campaign [<runs>]\n");
    return 2;
  }
  const unsigned count = std::max(1u, std::thread::hardware_concurrency());
  std::atomic<long> next{0};
  std::vector<campaign::Tally> tallies(count);
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < count; ++i)
    threads.emplace_back([&, i] {
      for (long run = next++; run < runs; run = next++)
        campaign::run(static_cast<std::uint32_t>(run + 1), tallies[i]);
    });
  for (std::thread& thread : threads) thread.join();
  campaign::Tally all;
  for (const campaign::Tally& tally : tallies) all.add(tally);

  bool is_kept = all.colder == 0 && all.over == 0 && all.not_back == 0;
  std::printf(
      "%ld runs of %.0f s. A certified bound below the truth: %ld. Over a limit: %ld; closest %.2f K.\n",
      all.runs, campaign::run_s, all.colder, all.over, all.hottest_over_K);
  std::printf(
      "Not counted as over, because a board held a larger power than it was told for more than %.0f s: %ld.\n",
      campaign::horizon_s, all.uncontrolled);
  std::printf(
      "All bearable power back after %ld faults, not within two minutes after %ld; %ld runs ended first.\n\n",
      all.back, all.not_back, all.undecided);
  std::printf(
      "| fault | times | named | reason gone within, s | bearable power back within, s |\n|---|---|---|---|---|\n");
  for (int i = 0; i < campaign::fault_count; ++i) {
    std::printf("| %s | %ld | ", campaign::name(i), all.faults[i]);
    if (all.nameable[i] == 0) std::printf("- | ");
    else if (all.as_factor[i] == 0) std::printf("%ld of %ld | ", all.named[i], all.nameable[i]);
    else std::printf("%ld of %ld, and %ld as a factor | ", all.named[i], all.nameable[i], all.as_factor[i]);
    std::printf("%.2f | %.0f |\n", all.slowest_clear_s[i], all.slowest_back_s[i]);
    is_kept = is_kept && all.named[i] + all.as_factor[i] == all.nameable[i];
  }
  return is_kept ? 0 : 1;
}
