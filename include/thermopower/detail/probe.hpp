// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file probe.hpp
/// What it takes to ask whether a type has what a template needs of it, so that a wrong composition is refused in
/// a sentence and not in a page.

namespace thermopower {
namespace detail {

/// Stands for `int` where all of its parameters exist, and removes a specialisation where one does not.
template <class...>
struct Exists {
  typedef int Type;
};

/// An object of any type, to ask what could be done with it.
template <class Type>
Type& probe() noexcept;

}  // namespace detail
}  // namespace thermopower
