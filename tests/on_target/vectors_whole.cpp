// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The same input vectors through whole gimbal controllers, on whatever machine this is built
// for. Apart from vectors_parts.cpp because both together do not fit the smallest flash.
#include "vectors_gimbal.hpp"

int main() {
  platform::start();
  on_target::Report report;
  on_target::run_programmed_gimbal(report);
  on_target::run_corrected_gimbal(report);
  report.section("end");
  platform::stop(0);
}
