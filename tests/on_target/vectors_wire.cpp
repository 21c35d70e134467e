// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The same input vectors through the codec, on whatever machine this is built for. Apart from vectors_whole.cpp because both
// together do not fit the smallest flash.
#include "vectors_sbgc.hpp"

int main() {
  platform::start();
  on_target::Report report;
  on_target::run_sbgc(report);
  report.section("end");
  platform::stop(0);
}
