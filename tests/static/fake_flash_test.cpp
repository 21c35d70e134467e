// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Compiled with THERMOPOWER_FLASH_HEADER="fake_flash.hpp".
#include <thermopower/actuator/tabulated_current.hpp>
#include <thermopower/control/gain_scheduler.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>

#include "../catch.hpp"

namespace tp = thermopower;

namespace {
struct Gains {
  static constexpr uint8_t size() { return 3; }
  static const uint8_t* gains() {
    static const uint8_t table[] = {100, 60, 10};
    return tp::detail::flash_pointer(table);
  }
};

/// True when reading that address directly ends a process.
template <class Value>
bool is_unreadable(const Value* address) {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGSEGV, SIG_DFL);  // a sanitizer's report would only be noise here
    std::signal(SIGBUS, SIG_DFL);
    volatile Value value = *const_cast<const volatile Value*>(address);
    (void)value;
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return !WIFEXITED(status) || WEXITSTATUS(status) != 0;
}
}  // namespace

TEST_CASE("reading flash as RAM fails on a PC, too") {
  static const uint8_t plain = 7;
  CHECK_FALSE(is_unreadable(&plain));
  CHECK(is_unreadable(Gains::gains()));
  CHECK(is_unreadable(tp::detail::flash_pointer(&plain)));
}

TEST_CASE("a gain table is read out of flash") {
  const tp::GainScheduler<tp::TableGain<Gains> > gain;
  CHECK(gain.step(0) == 100);
  CHECK(gain.step(255) == 10);
  CHECK(gain.step(64) == 80);
}

TEST_CASE("a current table is read out of flash") {
  const tp::TabulatedCurrent<tp::ThesisCurrentSource<tp::motors::Bgm2606_90t> > table;
  const auto law = tp::motors::Bgm2606_90t::current_law<double>();
  for (double volt = 1.1; volt < 16.0; volt += 0.3)
    CHECK(std::abs(static_cast<double>(table.current_A(static_cast<float>(volt), 40.0f)) -
                   law.current_A(volt, 40.0)) < 6e-4);
}
