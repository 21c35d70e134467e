// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/detail/numeric.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/given.hpp>
#include <thermopower/plant/inline.hpp>

#include <cstddef>
#include <functional>
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

/// A curve by its values at evenly spaced knots, as a trace keeps it.
struct WrittenCurve {
  double from;                 ///< where the first knot lies
  double to;                   ///< where the last one lies
  std::vector<double> values;  ///< at the knots
};

/// Where expressions are written down.
///
/// @snippet plant_examples.cpp expression
/// How to: @ref gap_method.
class Trace {
public:
  /// The operation of a node.
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
    choice,         ///< third argument where the first (a comparison) does not hold, else the second
    curve,          ///< value of a curve, by its name, at the first
    curve_slope     ///< its slope there
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
  Expression symbol(const std::string& name);

  /// A step of a computation.
  Expression make(Kind kind, const Expression& a, const Expression& b = {}, const std::string& name = {});

  /// `yes` where the condition holds, else `no`.
  static Expression choice(const Condition& condition, const Expression& yes, const Expression& no);

  /// Value of a curve at an expression. @param id  of the curve, by which its table is called in code
  Expression curve(const std::string& id, WrittenCurve shape, const Expression& at);

  /// A curve that some step looks up. @param name  of that step
  const WrittenCurve& curve_of(const std::string& name) const { return curves_.at(name); }

  /// Runs code once for every way through its branches and joins the results by choices.
  /// @param run  called without arguments, returns a vector of expressions of always the same length
  /// @throws NotTraceable for more than `most_ways` ways
  std::vector<Expression> every_branch(const std::function<std::vector<Expression>()>& run);

  /// An expression with another in the place of one of its parts.
  Expression replaced(const Expression& in, const Expression& part, const Expression& by);

  /// A step by its place.
  Expression at(int place_of);

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

  std::vector<Expression> follow(const std::function<std::vector<Expression>()>& run,
                                 const std::vector<Decision>& from);

  bool decide(int condition);
  int place(const Expression& x);
  int intern(const Node& node);

  using Key = std::tuple<Kind, std::string, double, int, int, int>;
  std::vector<Node> nodes_;
  std::map<Key, int> known_;
  std::map<std::string, WrittenCurve> curves_;
  std::vector<Decision> path_;
  std::size_t used_ = 0;
  int ways_ = 0;
  bool following_ = false;
};

namespace detail {

inline bool is(const Expression& x, double value) { return x.is_constant() && x.constant_value() == value; }

}  // namespace detail

/// @name As with plain numbers
/// Each records what it computes; what is known already (a constant, a sum with 0) is not recorded.
/// @{

/// See above.
Expression operator+(const Expression& a, const Expression& b);
Expression operator-(const Expression& a, const Expression& b);
Expression operator*(const Expression& a, const Expression& b);
Expression operator/(const Expression& a, const Expression& b);

// With plain numbers, too: a recorded value that turns into one must not be preferred.
inline Expression operator+(const Expression& a, double b) { return a + Expression(b); }
inline Expression operator-(const Expression& a, double b) { return a - Expression(b); }
inline Expression operator*(const Expression& a, double b) { return a * Expression(b); }
inline Expression operator/(const Expression& a, double b) { return a / Expression(b); }
inline Expression operator+(double a, const Expression& b) { return Expression(a) + b; }
inline Expression operator-(double a, const Expression& b) { return Expression(a) - b; }
inline Expression operator*(double a, const Expression& b) { return Expression(a) * b; }
inline Expression operator/(double a, const Expression& b) { return Expression(a) / b; }

Condition operator<(const Expression& a, const Expression& b);
Condition operator>(const Expression& a, const Expression& b);
Condition operator<=(const Expression& a, const Expression& b);
Condition operator>=(const Expression& a, const Expression& b);
Condition operator==(const Expression& a, const Expression& b);
Condition operator!=(const Expression& a, const Expression& b);
inline Condition operator<(const Expression& a, double b) { return a < Expression(b); }
inline Condition operator>(const Expression& a, double b) { return a > Expression(b); }
inline Condition operator<=(const Expression& a, double b) { return a <= Expression(b); }
inline Condition operator>=(const Expression& a, double b) { return a >= Expression(b); }
inline Condition operator==(const Expression& a, double b) { return a == Expression(b); }
inline Condition operator!=(const Expression& a, double b) { return a != Expression(b); }

Expression exp(const Expression& x);
Expression log(const Expression& x);
Expression sin(const Expression& x);
Expression cos(const Expression& x);
Expression tanh(const Expression& x);
Expression sqrt(const Expression& x);
Expression abs(const Expression& x);
Expression pow(const Expression& x, const Expression& y);
/// @}

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
  operator double() const;  // NOLINT: effects may treat what was recorded as a plain number

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

/// A recorded column in a trace.
template <>
struct GivenFor<Expression> {
  using type = GivenExpression;  ///< still an expression
};

/// The expression itself: which way code takes is followed, not decided.
inline GivenExpression value_of(const Expression& x) { return GivenExpression(x); }
/// Whether it is a constant of some value, in the equation that is written.
inline bool is_constant(const Expression& x, double value) { return detail::is(x, value); }
/// |x|.
inline Expression magnitude(const Expression& x) { return abs(x); }
/// |x|.
inline GivenExpression magnitude(const GivenExpression& x) { return GivenExpression(abs(x)); }
/// The larger of x and a number.
Expression at_least(const Expression& x, double floor);
/// The larger of two.
Expression larger(const Expression& a, const Expression& b);

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

#ifndef THERMOPOWER_GAP_LIBRARY
#include <thermopower/plant/detail/expression.hpp>
#endif
