// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The same input vectors through every component by itself, on whatever machine this is built for;
// compare_vectors holds the results against the PC's.
#include "vectors_actuator.hpp"
#include "vectors_control.hpp"

int main() {
  platform::start();
  on_target::Report report;
  on_target::run_actuator(report);
  on_target::run_control(report);
  report.section("end");
  platform::stop(0);
}
