// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace thermopower::plant {

/// One of a closed set of names, or a name of a plant of the user's own that the set does not list.
///
/// Engine and writers compare with the members of the set (`submodel == Submodel::thermal_loss`); a user's
/// plant brings names of its own, which are carried through to the reports. A name that the set lists is that
/// member, however it was made: two equal texts are equal names.
///
/// @tparam Known an enum that counts from 0, with `const char* to_string(Known)` and `int count_of(Known)`
///
/// @snippet plant_examples.cpp open name
/// How to: @ref diagnose_a_gap.
template <class Known>
class OpenName {
  static_assert(
      std::is_enum<Known>::value,
      "thermopower: the parameter of OpenName must be an enum, with to_string() and count_of() beside it");

public:
  /// The first member of the set.
  OpenName() = default;
  /// A member of the set.
  OpenName(Known known) : known_(known) {}  // NOLINT(google-explicit-constructor): the set is part of it
  /// The member of that name, or a name of one's own; may be empty.
  explicit OpenName(std::string_view name) {
    for (int i = 0; i < count_of(Known{}); ++i) {
      known_ = static_cast<Known>(i);
      if (name == to_string(known_)) return;
    }
    is_own_ = true;
    own_ = name;
  }

  /// The member of the set; none for a name of one's own.
  std::optional<Known> known() const { return is_own_ ? std::nullopt : std::optional<Known>(known_); }

  /// The name as reports spell it.
  std::string text() const { return is_own_ ? own_ : std::string(to_string(known_)); }

  /// Whether both are the same name.
  friend bool operator==(const OpenName& a, const OpenName& b) {
    return a.is_own_ == b.is_own_ && (a.is_own_ ? a.own_ == b.own_ : a.known_ == b.known_);
  }
  /// Whether the names differ.
  friend bool operator!=(const OpenName& a, const OpenName& b) { return !(a == b); }
  /// The name as reports spell it.
  friend std::string to_string(const OpenName& name) { return name.text(); }

private:
  Known known_{};
  bool is_own_ = false;
  std::string own_;
};

}  // namespace thermopower::plant
