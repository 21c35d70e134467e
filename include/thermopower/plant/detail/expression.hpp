// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/expression.hpp>

#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::plant {

namespace detail {

inline Trace* trace_of(const Expression& a, const Expression& b) {
  return a.is_constant() ? b.trace() : a.trace();
}

inline Condition compare(Trace::Kind kind, const Expression& a, const Expression& b, bool known) {
  if (a.is_constant() && b.is_constant()) return Condition(known);
  return {trace_of(a, b), trace_of(a, b)->make(kind, a, b).node()};
}

inline Expression call(const char* name, const Expression& x, double known) {
  return x.is_constant() ? Expression(known) : x.trace()->make(Trace::Kind::function, x, {}, name);
}

}  // namespace detail

THERMOPOWER_GAP_INLINE Expression Trace::symbol(const std::string& name) {
  return {this, intern({Kind::symbol, name, 0.0, -1, -1, -1})};
}

THERMOPOWER_GAP_INLINE Expression Trace::make(Kind kind, const Expression& a, const Expression& b,
                                              const std::string& name) {
  const bool two =
      kind != Kind::negative && kind != Kind::function && kind != Kind::curve && kind != Kind::curve_slope;
  return {this, intern({kind, name, 0.0, place(a), two ? place(b) : -1, -1})};
}

THERMOPOWER_GAP_INLINE Expression Trace::choice(const Condition& condition, const Expression& yes,
                                                const Expression& no) {
  if (condition.trace() == nullptr) return condition.value() ? yes : no;
  Trace& trace = *condition.trace();
  const int a = trace.place(yes), b = trace.place(no);
  if (a == b) return yes;
  return {&trace, trace.intern({Kind::choice, "", 0.0, condition.node(), a, b})};
}

THERMOPOWER_GAP_INLINE Expression Trace::curve(const std::string& id, WrittenCurve shape,
                                               const Expression& at) {
  curves_[id] = std::move(shape);
  return make(Kind::curve, at, {}, id);
}

THERMOPOWER_GAP_INLINE std::vector<Expression> Trace::every_branch(
    const std::function<std::vector<Expression>()>& run) {
  ways_ = 0;
  auto joined = follow(run, {});
  following_ = false;
  return joined;
}

THERMOPOWER_GAP_INLINE Expression Trace::at(int place_of) {
  const Node& node = nodes_[static_cast<std::size_t>(place_of)];
  return node.kind == Kind::constant ? Expression(node.value) : Expression(this, place_of);
}

THERMOPOWER_GAP_INLINE std::vector<Expression> Trace::follow(
    const std::function<std::vector<Expression>()>& run, const std::vector<Decision>& from) {
  if (++ways_ > most_ways) throw NotTraceable("its code branches too often");
  path_ = from;
  used_ = 0;
  following_ = true;
  std::vector<Expression> results = run();
  const std::vector<Decision> path = path_;
  for (std::size_t i = path.size(); i > from.size(); --i) {
    std::vector<Decision> other(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(i));
    other.back().value = false;
    const std::vector<Expression> otherwise = follow(run, other);
    for (std::size_t k = 0; k < results.size(); ++k)
      results[k] = choice(Condition(this, path[i - 1].condition), results[k], otherwise[k]);
  }
  return results;
}

THERMOPOWER_GAP_INLINE bool Trace::decide(int condition) {
  if (!following_) throw NotTraceable("its code branches where no branch can be followed");
  for (std::size_t i = 0; i < used_; ++i)
    if (path_[i].condition == condition) return path_[i].value;
  // A loop that waits for a condition would never end: both its ways are followed.
  if (used_ == static_cast<std::size_t>(most_ways)) throw NotTraceable("its code branches too often");
  if (used_ == path_.size()) path_.push_back({condition, true});
  return path_[used_++].value;
}

THERMOPOWER_GAP_INLINE int Trace::place(const Expression& x) {
  return x.is_constant() ? intern({Kind::constant, "", x.constant_value(), -1, -1, -1}) : x.node();
}

THERMOPOWER_GAP_INLINE int Trace::intern(const Node& node) {
  const Key key(node.kind, node.name, node.value, node.a, node.b, node.c);
  const auto known = known_.find(key);
  if (known != known_.end()) return known->second;
  nodes_.push_back(node);
  return known_[key] = static_cast<int>(nodes_.size()) - 1;
}

THERMOPOWER_GAP_INLINE Condition::operator bool() const {
  return trace_ == nullptr ? value_ : trace_->decide(node_);
}

THERMOPOWER_GAP_INLINE Expression Expression::operator-() const {
  if (is_constant()) return -value_;
  const Trace::Node& node = trace_->nodes()[static_cast<std::size_t>(node_)];
  if (node.kind == Trace::Kind::negative) return {trace_, node.a};
  return trace_->make(Trace::Kind::negative, *this);
}

THERMOPOWER_GAP_INLINE Expression operator+(const Expression& a, const Expression& b) {
  if (a.is_constant() && b.is_constant()) return a.constant_value() + b.constant_value();
  if (detail::is(a, 0.0)) return b;
  if (detail::is(b, 0.0)) return a;
  return detail::trace_of(a, b)->make(Trace::Kind::sum, a, b);
}

THERMOPOWER_GAP_INLINE Expression operator-(const Expression& a, const Expression& b) {
  if (a.is_constant() && b.is_constant()) return a.constant_value() - b.constant_value();
  if (detail::is(a, 0.0)) return -b;
  if (detail::is(b, 0.0)) return a;
  if (a.trace() == b.trace() && a.node() == b.node()) return 0.0;
  return detail::trace_of(a, b)->make(Trace::Kind::difference, a, b);
}

THERMOPOWER_GAP_INLINE Expression operator*(const Expression& a, const Expression& b) {
  if (a.is_constant() && b.is_constant()) return a.constant_value() * b.constant_value();
  if (detail::is(a, 1.0)) return b;
  if (detail::is(b, 1.0)) return a;
  if (detail::is(a, 0.0) || detail::is(b, 0.0)) return 0.0;
  return detail::trace_of(a, b)->make(Trace::Kind::product, a, b);
}

THERMOPOWER_GAP_INLINE Expression operator/(const Expression& a, const Expression& b) {
  if (a.is_constant() && b.is_constant()) return a.constant_value() / b.constant_value();
  if (detail::is(b, 1.0)) return a;
  if (!a.is_constant() && !b.is_constant()) {  // (x b) / b
    const Trace::Node product = a.trace()->nodes()[static_cast<std::size_t>(a.node())];
    if (product.kind == Trace::Kind::product && product.b == b.node()) return a.trace()->at(product.a);
    if (product.kind == Trace::Kind::product && product.a == b.node()) return a.trace()->at(product.b);
  }
  return detail::trace_of(a, b)->make(Trace::Kind::quotient, a, b);
}

THERMOPOWER_GAP_INLINE Condition operator<(const Expression& a, const Expression& b) {
  return detail::compare(Trace::Kind::less, a, b, a.constant_value() < b.constant_value());
}
THERMOPOWER_GAP_INLINE Condition operator>(const Expression& a, const Expression& b) { return b < a; }
THERMOPOWER_GAP_INLINE Condition operator<=(const Expression& a, const Expression& b) {
  return detail::compare(Trace::Kind::less_or_equal, a, b, a.constant_value() <= b.constant_value());
}
THERMOPOWER_GAP_INLINE Condition operator>=(const Expression& a, const Expression& b) { return b <= a; }
THERMOPOWER_GAP_INLINE Condition operator==(const Expression& a, const Expression& b) {
  return detail::compare(
      Trace::Kind::equal, a, b,
      !(a.constant_value() < b.constant_value()) && !(b.constant_value() < a.constant_value()));
}
THERMOPOWER_GAP_INLINE Condition operator!=(const Expression& a, const Expression& b) {
  return Condition(!static_cast<bool>(a == b));
}

THERMOPOWER_GAP_INLINE Expression exp(const Expression& x) {
  return detail::call("exp", x, std::exp(x.constant_value()));
}
THERMOPOWER_GAP_INLINE Expression log(const Expression& x) {
  return detail::call("log", x, std::log(x.constant_value()));
}
THERMOPOWER_GAP_INLINE Expression sin(const Expression& x) {
  return detail::call("sin", x, std::sin(x.constant_value()));
}
THERMOPOWER_GAP_INLINE Expression cos(const Expression& x) {
  return detail::call("cos", x, std::cos(x.constant_value()));
}
THERMOPOWER_GAP_INLINE Expression tanh(const Expression& x) {
  return detail::call("tanh", x, std::tanh(x.constant_value()));
}
THERMOPOWER_GAP_INLINE Expression sqrt(const Expression& x) {
  return detail::call("sqrt", x, std::sqrt(x.constant_value()));
}
THERMOPOWER_GAP_INLINE Expression abs(const Expression& x) {
  return detail::call("abs", x, std::abs(x.constant_value()));
}
THERMOPOWER_GAP_INLINE Expression pow(const Expression& x, const Expression& y) {
  if (x.is_constant() && y.is_constant()) return std::pow(x.constant_value(), y.constant_value());
  return detail::trace_of(x, y)->make(Trace::Kind::power, x, y);
}

THERMOPOWER_GAP_INLINE Expression& Expression::operator+=(const Expression& b) { return *this = *this + b; }
THERMOPOWER_GAP_INLINE Expression& Expression::operator-=(const Expression& b) { return *this = *this - b; }
THERMOPOWER_GAP_INLINE Expression& Expression::operator*=(const Expression& b) { return *this = *this * b; }
THERMOPOWER_GAP_INLINE Expression& Expression::operator/=(const Expression& b) { return *this = *this / b; }

THERMOPOWER_GAP_INLINE Expression Trace::replaced(const Expression& in, const Expression& part,
                                                  const Expression& by) {
  if (in.is_constant() || part.is_constant()) return in;
  std::map<int, Expression> known{{part.node(), by}};
  const auto copy = [&](const auto& self, int at) -> Expression {
    const auto found = known.find(at);
    if (found != known.end()) return found->second;
    const Node node = nodes_[static_cast<std::size_t>(at)];
    if (node.kind == Kind::constant) return node.value;
    if (node.kind == Kind::symbol) return {this, at};
    const auto argument = [&](int place_of) { return place_of < 0 ? -1 : place(self(self, place_of)); };
    const int a = argument(node.a), b = argument(node.b), c = argument(node.c);
    return known[at] = {this, intern({node.kind, node.name, node.value, a, b, c})};
  };
  return copy(copy, in.node());
}

THERMOPOWER_GAP_INLINE GivenExpression::operator double() const {
  if (!is_constant()) throw NotTraceable("its code turns a value into a plain number");
  return constant_value();
}

THERMOPOWER_GAP_INLINE Expression at_least(const Expression& x, double floor) {
  return Trace::choice(x > floor, x, floor);
}

THERMOPOWER_GAP_INLINE Expression larger(const Expression& a, const Expression& b) {
  return Trace::choice(b > a, b, a);
}

}  // namespace thermopower::plant
