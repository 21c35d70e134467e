// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The same input vectors through everything that computes in whole numbers, on whatever machine this is built
// for.
#include "vectors_fixed.hpp"

int main() {
  namespace motors = thermopower::motors;
  platform::start();
  on_target::Report report;
  on_target::run_products(report);
  on_target::run_fixed_heating<motors::Bgm2606_90t::AsProgrammed>(report);
  on_target::run_fixed_heating<motors::Bgm5208_200_12::AsProgrammed>(report);
  on_target::run_fixed_heating<motors::Bgm2606_90t>(report);
  on_target::run_fixed_heating<motors::Bgm5208_200_12>(report);
  on_target::run_fixed_gimbal(report);
  on_target::run_monitor(report);
  report.section("end");
  platform::stop(0);
}
