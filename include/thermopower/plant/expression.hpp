// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/detail/numeric.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/given.hpp>

#include <cmath>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace thermopower::plant {

/// Thrown where an equation cannot be written down: it turns a traced value into a plain number, or branches
/// too often. `what()` is one sentence.
class NotTraceable : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

class Trace;
class Condition;

/// A scalar that remembers how it was computed: stepped in this one, an equation writes itself down.
///
/// Arithmetic on it builds nodes of a Trace, each distinct one once, with constants folded. A comparison
/// yields a Condition; where code branches on one, Trace::every_branch() runs it once for each way. Without a
/// trace it is a constant.
///
/// @snippet plant_examples.cpp expression
/// How to: @ref gap_method.
class Expression {
public:
  using Scalar = double;  ///< the type of literals, as the actuator's laws ask for it

  Expression() = default;
  /// A constant.
  Expression(double value) : value_(value) {}  // NOLINT: literals mix with expressions in every law
  /// A node of a trace, which must outlive it.
  Expression(Trace* trace, int node) : trace_(trace), node_(node) {}

  /// Whether it is a plain number.
  bool is_constant() const { return trace_ == nullptr; }
  /// The number, where it is one.
  double constant_value() const { return value_; }
  /// Its node in the trace; -1 for a constant.
  int node() const { return node_; }
  /// Its trace; nullptr for a constant.
  Trace* trace() const { return trace_; }

  /// @name As with plain numbers
  /// @{

  /// See above.
  Expression operator-() const;
  Expression& operator+=(const Expression& b);
  Expression& operator-=(const Expression& b);
  Expression& operator*=(const Expression& b);
  Expression& operator/=(const Expression& b);
  /// @}

private:
  Trace* trace_ = nullptr;
  int node_ = -1;
  double value_ = 0.0;
};

/// A comparison of expressions. As a bool it asks its trace which way to take.
///
/// @snippet plant_examples.cpp expression
/// How to: @ref gap_method.
class Condition {
public:
  /// Known beforehand.
  explicit Condition(bool value) : value_(value) {}
  /// A node of a trace.
  Condition(Trace* trace, int node) : trace_(trace), node_(node) {}
  /// Which way to take. @throws NotTraceable outside of Trace::every_branch()
  operator bool() const;  // NOLINT: code branches on it
  /// Its trace; nullptr where it is known beforehand.
  Trace* trace() const { return trace_; }
  /// Its node.
  int node() const { return node_; }
  /// Its value, where it is known beforehand.
  bool value() const { return value_; }

private:
  Trace* trace_ = nullptr;
  int node_ = -1;
  bool value_ = false;
};

/// Where expressions are written down.
///
/// @snippet plant_examples.cpp expression
/// How to: @ref gap_method.
class Trace {
public:
  /// What a node does with its arguments.
  enum class Kind {
    constant,       ///< a number
    symbol,         ///< an input by its name
    negative,       ///< the first argument with the other sign
    sum,            ///< first plus second
    difference,     ///< first less second
    product,        ///< first times second
    quotient,       ///< first by second
    function,       ///< a function of the first by its name
    power,          ///< first to the power of the second
    less,           ///< is the first less than the second?
    less_or_equal,  ///< is the first not more than the second?
    equal,          ///< are both equal?
    choice          ///< third argument where the first (a comparison) does not hold, else the second
  };

  /// One step of a computation. Arguments are nodes made before it.
  struct Node {
    Kind kind;         ///< what it does
    std::string name;  ///< of a symbol or a function (exp, log, sin, cos, tanh, sqrt, abs)
    double value;      ///< of a constant
    int a;             ///< first argument; -1: none
    int b;             ///< second argument; -1: none
    int c;             ///< third argument; -1: none
  };

  Trace() = default;
  Trace(const Trace&) = delete;  // expressions point to it
  Trace& operator=(const Trace&) = delete;

  /// A quantity that the equation is given, by its name in code.
  Expression symbol(const std::string& name) { return {this, intern({Kind::symbol, name, 0.0, -1, -1, -1})}; }

  /// A step of a computation.
  Expression make(Kind kind, const Expression& a, const Expression& b = {}, const std::string& name = {}) {
    const bool two = kind != Kind::negative && kind != Kind::function;
    return {this, intern({kind, name, 0.0, place(a), two ? place(b) : -1, -1})};
  }

  /// `yes` where the condition holds, else `no`.
  static Expression choice(const Condition& condition, const Expression& yes, const Expression& no) {
    if (condition.trace() == nullptr) return condition.value() ? yes : no;
    Trace& trace = *condition.trace();
    const int a = trace.place(yes), b = trace.place(no);
    if (a == b) return yes;
    return {&trace, trace.intern({Kind::choice, "", 0.0, condition.node(), a, b})};
  }

  /// Runs code once for every way through its branches and joins the results by choices.
  /// @param run  called without arguments, returns a vector of expressions of always the same length
  /// @throws NotTraceable for more than `most_ways` ways
  template <class Run>
  std::vector<Expression> every_branch(Run&& run) {
    ways_ = 0;
    auto joined = follow(run, {});
    following_ = false;
    return joined;
  }

  /// An expression with another in the place of one of its parts.
  Expression replaced(const Expression& in, const Expression& part, const Expression& by);

  /// A step by its place.
  Expression at(int place_of) {
    const Node& node = nodes_[static_cast<std::size_t>(place_of)];
    return node.kind == Kind::constant ? Expression(node.value) : Expression(this, place_of);
  }

  /// The steps, arguments before what uses them.
  const std::vector<Node>& nodes() const { return nodes_; }

  /// Ways through the branches of one equation beyond which it is not written down.
  static constexpr int most_ways = 64;

private:
  friend class Condition;
  struct Decision {
    int condition;
    bool value;
  };

  template <class Run>
  std::vector<Expression> follow(Run& run, const std::vector<Decision>& from) {
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

  bool decide(int condition) {
    if (!following_) throw NotTraceable("its code branches where no branch can be followed");
    for (std::size_t i = 0; i < used_; ++i)
      if (path_[i].condition == condition) return path_[i].value;
    if (used_ == path_.size()) path_.push_back({condition, true});
    return path_[used_++].value;
  }

  int place(const Expression& x) {
    return x.is_constant() ? intern({Kind::constant, "", x.constant_value(), -1, -1, -1}) : x.node();
  }

  int intern(const Node& node) {
    const Key key(node.kind, node.name, node.value, node.a, node.b, node.c);
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    nodes_.push_back(node);
    return known_[key] = static_cast<int>(nodes_.size()) - 1;
  }

  using Key = std::tuple<Kind, std::string, double, int, int, int>;
  std::vector<Node> nodes_;
  std::map<Key, int> known_;
  std::vector<Decision> path_;
  std::size_t used_ = 0;
  int ways_ = 0;
  bool following_ = false;
};

namespace detail {

inline Trace* trace_of(const Expression& a, const Expression& b) {
  return a.is_constant() ? b.trace() : a.trace();
}

inline bool is(const Expression& x, double value) { return x.is_constant() && x.constant_value() == value; }

inline Condition compare(Trace::Kind kind, const Expression& a, const Expression& b, bool known) {
  if (a.is_constant() && b.is_constant()) return Condition(known);
  return {trace_of(a, b), trace_of(a, b)->make(kind, a, b).node()};
}

inline Expression call(const char* name, const Expression& x, double known) {
  return x.is_constant() ? Expression(known) : x.trace()->make(Trace::Kind::function, x, {}, name);
}

}  // namespace detail

inline Condition::operator bool() const { return trace_ == nullptr ? value_ : trace_->decide(node_); }

inline Expression Expression::operator-() const {
  if (is_constant()) return -value_;
  const Trace::Node& node = trace_->nodes()[static_cast<std::size_t>(node_)];
  if (node.kind == Trace::Kind::negative) return {trace_, node.a};
  return trace_->make(Trace::Kind::negative, *this);
}

/// @name As with plain numbers
/// Each records what it computes; what is known already (a constant, a sum with 0) is not recorded.
/// @{

/// See above.
inline Expression operator+(const Expression& a, const Expression& b) {
  if (a.is_constant() && b.is_constant()) return a.constant_value() + b.constant_value();
  if (detail::is(a, 0.0)) return b;
  if (detail::is(b, 0.0)) return a;
  return detail::trace_of(a, b)->make(Trace::Kind::sum, a, b);
}

inline Expression operator-(const Expression& a, const Expression& b) {
  if (a.is_constant() && b.is_constant()) return a.constant_value() - b.constant_value();
  if (detail::is(a, 0.0)) return -b;
  if (detail::is(b, 0.0)) return a;
  if (a.trace() == b.trace() && a.node() == b.node()) return 0.0;
  return detail::trace_of(a, b)->make(Trace::Kind::difference, a, b);
}

inline Expression operator*(const Expression& a, const Expression& b) {
  if (a.is_constant() && b.is_constant()) return a.constant_value() * b.constant_value();
  if (detail::is(a, 1.0)) return b;
  if (detail::is(b, 1.0)) return a;
  if (detail::is(a, 0.0) || detail::is(b, 0.0)) return 0.0;
  return detail::trace_of(a, b)->make(Trace::Kind::product, a, b);
}

inline Expression operator/(const Expression& a, const Expression& b) {
  if (a.is_constant() && b.is_constant()) return a.constant_value() / b.constant_value();
  if (detail::is(b, 1.0)) return a;
  if (!a.is_constant() && !b.is_constant()) {  // (x b) / b
    const Trace::Node product = a.trace()->nodes()[static_cast<std::size_t>(a.node())];
    if (product.kind == Trace::Kind::product && product.b == b.node()) return a.trace()->at(product.a);
    if (product.kind == Trace::Kind::product && product.a == b.node()) return a.trace()->at(product.b);
  }
  return detail::trace_of(a, b)->make(Trace::Kind::quotient, a, b);
}

// With plain numbers, too: a recorded value that turns into one must not be preferred.
inline Expression operator+(const Expression& a, double b) { return a + Expression(b); }
inline Expression operator-(const Expression& a, double b) { return a - Expression(b); }
inline Expression operator*(const Expression& a, double b) { return a * Expression(b); }
inline Expression operator/(const Expression& a, double b) { return a / Expression(b); }
inline Expression operator+(double a, const Expression& b) { return Expression(a) + b; }
inline Expression operator-(double a, const Expression& b) { return Expression(a) - b; }
inline Expression operator*(double a, const Expression& b) { return Expression(a) * b; }
inline Expression operator/(double a, const Expression& b) { return Expression(a) / b; }

inline Condition operator<(const Expression& a, const Expression& b) {
  return detail::compare(Trace::Kind::less, a, b, a.constant_value() < b.constant_value());
}
inline Condition operator>(const Expression& a, const Expression& b) { return b < a; }
inline Condition operator<=(const Expression& a, const Expression& b) {
  return detail::compare(Trace::Kind::less_or_equal, a, b, a.constant_value() <= b.constant_value());
}
inline Condition operator>=(const Expression& a, const Expression& b) { return b <= a; }
inline Condition operator==(const Expression& a, const Expression& b) {
  return detail::compare(
      Trace::Kind::equal, a, b,
      !(a.constant_value() < b.constant_value()) && !(b.constant_value() < a.constant_value()));
}
inline Condition operator!=(const Expression& a, const Expression& b) {
  return Condition(!static_cast<bool>(a == b));
}
inline Condition operator<(const Expression& a, double b) { return a < Expression(b); }
inline Condition operator>(const Expression& a, double b) { return a > Expression(b); }
inline Condition operator<=(const Expression& a, double b) { return a <= Expression(b); }
inline Condition operator>=(const Expression& a, double b) { return a >= Expression(b); }
inline Condition operator==(const Expression& a, double b) { return a == Expression(b); }
inline Condition operator!=(const Expression& a, double b) { return a != Expression(b); }

inline Expression exp(const Expression& x) { return detail::call("exp", x, std::exp(x.constant_value())); }
inline Expression log(const Expression& x) { return detail::call("log", x, std::log(x.constant_value())); }
inline Expression sin(const Expression& x) { return detail::call("sin", x, std::sin(x.constant_value())); }
inline Expression cos(const Expression& x) { return detail::call("cos", x, std::cos(x.constant_value())); }
inline Expression tanh(const Expression& x) { return detail::call("tanh", x, std::tanh(x.constant_value())); }
inline Expression sqrt(const Expression& x) { return detail::call("sqrt", x, std::sqrt(x.constant_value())); }
inline Expression abs(const Expression& x) { return detail::call("abs", x, std::abs(x.constant_value())); }
inline Expression pow(const Expression& x, const Expression& y) {
  if (x.is_constant() && y.is_constant()) return std::pow(x.constant_value(), y.constant_value());
  return detail::trace_of(x, y)->make(Trace::Kind::power, x, y);
}
/// @}

inline Expression& Expression::operator+=(const Expression& b) { return *this = *this + b; }
inline Expression& Expression::operator-=(const Expression& b) { return *this = *this - b; }
inline Expression& Expression::operator*=(const Expression& b) { return *this = *this * b; }
inline Expression& Expression::operator/=(const Expression& b) { return *this = *this / b; }

inline Expression Trace::replaced(const Expression& in, const Expression& part, const Expression& by) {
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

/// The value of a recorded column, or the plain value of an expression: still an expression. Only where code
/// insists on a plain number it throws NotTraceable.
class GivenExpression : public Expression {
public:
  GivenExpression() = default;
  /// A constant.
  GivenExpression(double value) : Expression(value) {}  // NOLINT: as with plain numbers
  /// Any expression.
  explicit GivenExpression(const Expression& one) : Expression(one) {}
  /// The number, where it is one. @throws NotTraceable where it is none
  operator double() const {  // NOLINT: effects may treat what was recorded as a plain number
    if (!is_constant()) throw NotTraceable("its code turns a value into a plain number");
    return constant_value();
  }

  /// @name Arithmetic among such values yields such a value
  /// @{

  /// See above.
  friend GivenExpression operator+(const GivenExpression& a, const GivenExpression& b) {
    return GivenExpression(a.expression() + b.expression());
  }
  friend GivenExpression operator+(const GivenExpression& a, double b) {
    return GivenExpression(a.expression() + b);
  }
  friend GivenExpression operator+(double a, const GivenExpression& b) {
    return GivenExpression(a + b.expression());
  }
  friend GivenExpression operator-(const GivenExpression& a, const GivenExpression& b) {
    return GivenExpression(a.expression() - b.expression());
  }
  friend GivenExpression operator-(const GivenExpression& a, double b) {
    return GivenExpression(a.expression() - b);
  }
  friend GivenExpression operator-(double a, const GivenExpression& b) {
    return GivenExpression(a - b.expression());
  }
  friend GivenExpression operator*(const GivenExpression& a, const GivenExpression& b) {
    return GivenExpression(a.expression() * b.expression());
  }
  friend GivenExpression operator*(const GivenExpression& a, double b) {
    return GivenExpression(a.expression() * b);
  }
  friend GivenExpression operator*(double a, const GivenExpression& b) {
    return GivenExpression(a * b.expression());
  }
  friend GivenExpression operator/(const GivenExpression& a, const GivenExpression& b) {
    return GivenExpression(a.expression() / b.expression());
  }
  friend GivenExpression operator/(const GivenExpression& a, double b) {
    return GivenExpression(a.expression() / b);
  }
  friend GivenExpression operator/(double a, const GivenExpression& b) {
    return GivenExpression(a / b.expression());
  }
  /// @}

private:
  const Expression& expression() const { return *this; }
};

/// What a recorded column is in a trace.
template <>
struct GivenFor<Expression> {
  using type = GivenExpression;  ///< still an expression
};

/// The expression itself: which way code takes is followed, not decided.
inline GivenExpression value_of(const Expression& x) { return GivenExpression(x); }
/// |x|.
inline Expression magnitude(const Expression& x) { return abs(x); }
/// |x|.
inline GivenExpression magnitude(const GivenExpression& x) { return GivenExpression(abs(x)); }
/// The larger of x and a number.
inline Expression at_least(const Expression& x, double floor) { return Trace::choice(x > floor, x, floor); }
/// The larger of two.
inline Expression larger(const Expression& a, const Expression& b) { return Trace::choice(b > a, b, a); }

}  // namespace thermopower::plant

namespace thermopower {
namespace detail {

/// The laws of actuator/ in a scalar that remembers.
template <>
struct Numeric<plant::Expression> {
  using Real = double;  ///< the type of literals
  static plant::Expression constant(double value) { return value; }
  static plant::Expression square_root(const plant::Expression& x) { return sqrt(x); }
  static plant::Expression exponential(const plant::Expression& x) { return exp(x); }
  static plant::Expression power(const plant::Expression& base, const plant::Expression& exponent) {
    return pow(base, exponent);
  }
  static plant::Expression choose_if_greater(const plant::Expression& left, const plant::Expression& right,
                                             const plant::Expression& yes, const plant::Expression& no) {
    return plant::Trace::choice(left > right, yes, no);
  }
};

}  // namespace detail
}  // namespace thermopower
