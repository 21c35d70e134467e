// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/io/input_error.hpp>

#include <string>

namespace test {

/// What is said of an input as it is read; "no error" where nothing is.
template <class Read>
std::string input_error_of(Read&& read) {
  try {
    read();
  } catch (const thermopower::io::InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace test
