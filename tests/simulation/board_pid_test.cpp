// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/simulation/board_pid.hpp>

#include "../catch.hpp"

using thermopower::simulation::BoardPid;

TEST_CASE("The board asks for a share in proportion to the error and the P count") {
  BoardPid<double> board({0.03, 0.0, 0.02});
  CHECK(board.step(0.5, 0.0, 10.0, 0.001) == Approx(0.15));
  CHECK(board.step(0.5, 0.0, 20.0, 0.001) == Approx(0.30));
  CHECK(board.step(0.0, 4.0, 20.0, 0.001) == Approx(-0.08));
}

TEST_CASE("It never asks for more than there is") {
  BoardPid<double> board({0.03, 0.0, 0.0});
  CHECK(board.step(100.0, 0.0, 255.0, 0.001) == 1.0);
  CHECK(board.step(-100.0, 0.0, 255.0, 0.001) == -1.0);
}

TEST_CASE("Its integral holds a load without error and stops at the whole torque") {
  BoardPid<double> board({0.03, 2.0, 0.0});
  for (int i = 0; i < 10000; ++i) board.step(1.0, 0.0, 10.0, 0.001);
  CHECK(board.state().integral == 1.0);
  for (int i = 0; i < 250; ++i) board.step(-1.0, 0.0, 10.0, 0.001);
  CHECK(board.state().integral == Approx(0.5));
}
