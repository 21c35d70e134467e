// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <optional>
#include <string_view>

namespace thermopower::gap {

/// What an explanation lacks to be named; the first of these that holds.
enum class Lacks {
  nothing,         ///< its probability says the rest
  room,            ///< a cause ended on the bounds of its range, and is none
  a_judgement,     ///< training data ruled it out before it was judged on held-out data
  use,             ///< its causes make held-out data worse than refitted constants do
  told_parameter,  ///< the data leave one of its parameters open, so that it stands for something simpler
  presence,        ///< one of its causes may as well be absent
  something_own,   ///< another explanation says the same with less
  difference       ///< refitted constants imitate it: this recording cannot show it
};

/// What is lacking as a report spells it, and in words.
struct LackInWords {
  Lacks lacks = Lacks::nothing;  ///< which
  const char* id = "";           ///< as a report spells it
  const char* words = "";        ///< for a reader
};

/// All of them, each at the place of its number.
inline constexpr std::array<LackInWords, 8> lacks_in_words = {{
    {Lacks::nothing, "nothing", ""},
    {Lacks::room, "room", "a parameter ended on its bound"},
    {Lacks::a_judgement, "a_judgement", "the training data rule it out"},
    {Lacks::use, "use", "held-out data gets worse with it"},
    {Lacks::told_parameter, "told_parameter", "the data leave one of its parameters open"},
    {Lacks::presence, "presence", "one of its causes may as well be absent"},
    {Lacks::something_own, "something_own", "another explanation says the same with less"},
    {Lacks::difference, "difference", "refitted constants imitate it: this recording cannot show it"},
}};

/// The row of what is lacking.
inline const LackInWords& in_words(Lacks lacks) {
  const LackInWords& row = lacks_in_words[static_cast<std::size_t>(lacks)];
  assert(row.lacks == lacks);
  return row;
}

/// What a report spells so; none for another word.
inline std::optional<Lacks> lacks_of(std::string_view id) {
  for (const LackInWords& row : lacks_in_words)
    if (id == row.id) return row.lacks;
  return std::nullopt;
}

}  // namespace thermopower::gap
