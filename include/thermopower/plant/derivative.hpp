// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/expression.hpp>

#include <cstddef>
#include <map>

namespace thermopower::plant {

/// Derivative of an expression by a symbol: as long as the expression, and written down like it. Of a choice
/// it is the derivative of what is chosen; the slope of a curve counts as constant.
inline Expression derivative(const Expression& of, const Expression& by) {
  if (of.is_constant()) return 0.0;
  Trace& trace = *of.trace();
  std::map<int, Expression> known;
  const auto slope = [&](const auto& self, int place) -> Expression {
    const auto found = known.find(place);
    if (found != known.end()) return found->second;
    const Trace::Node node = trace.nodes()[static_cast<std::size_t>(place)];
    const Expression here = trace.at(place), a = node.a < 0 ? Expression() : trace.at(node.a),
                     b = node.b < 0 ? Expression() : trace.at(node.b);
    Expression result = 0.0;
    switch (node.kind) {
      case Trace::Kind::symbol:
        result = place == by.node() ? 1.0 : 0.0;
        break;
      case Trace::Kind::negative:
        result = -self(self, node.a);
        break;
      case Trace::Kind::sum:
        result = self(self, node.a) + self(self, node.b);
        break;
      case Trace::Kind::difference:
        result = self(self, node.a) - self(self, node.b);
        break;
      case Trace::Kind::product:
        result = self(self, node.a) * b + a * self(self, node.b);
        break;
      case Trace::Kind::quotient:
        result = (self(self, node.a) - here * self(self, node.b)) / b;
        break;
      case Trace::Kind::power: {
        const Expression exponent = self(self, node.b);
        result = b * here / a * self(self, node.a);
        if (!detail::is(exponent, 0.0)) result += here * log(a) * exponent;
        break;
      }
      case Trace::Kind::choice:
        result = Trace::choice(Condition(&trace, node.a), self(self, node.b), self(self, node.c));
        break;
      case Trace::Kind::function: {
        const Expression inner = self(self, node.a);
        if (node.name == "exp") result = here * inner;
        else if (node.name == "log") result = inner / a;
        else if (node.name == "sin") result = cos(a) * inner;
        else if (node.name == "cos") result = -sin(a) * inner;
        else if (node.name == "tanh") result = (1.0 - here * here) * inner;
        else if (node.name == "sqrt") result = 0.5 / here * inner;
        else result = Trace::choice(a < 0.0, -inner, inner);
        break;
      }
      case Trace::Kind::curve:
        result = trace.make(Trace::Kind::curve_slope, a, {}, node.name) * self(self, node.a);
        break;
      case Trace::Kind::curve_slope:
      case Trace::Kind::constant:
      case Trace::Kind::less:
      case Trace::Kind::less_or_equal:
      case Trace::Kind::equal:
        break;
    }
    return known[place] = result;
  };
  return slope(slope, of.node());
}

}  // namespace thermopower::plant
