// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/expression.hpp>
#include <thermopower/plant/terms.hpp>

#include <pybind11/pybind11.h>

#include <cassert>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arithmetic.hpp"
#include "effect_members.hpp"

/// @file traced_effect.hpp
/// Functions in Python that are called once, with numbers that write down what is done to them, and then computed without Python.

namespace thermopower::python {

/// A number that writes down what is computed from it, as Python sees it, and the answer of a comparison.
inline void bind_traced_number(py::module_& module) {
  using plant::Condition;
  using plant::Expression;
  py::class_<Condition>(module, "TracedCondition").def("__bool__", [](const Condition& one) {
    return static_cast<bool>(one);
  });
  py::class_<Expression> number(module, "TracedNumber");
  bind_arithmetic(number);
  number
      .def("__float__",
           [](const Expression& one) {
             if (!one.is_constant())
               throw plant::NotTraceable("it makes a plain number of one that is traced");
             return one.constant_value();
           })
      .def(
          "__rpow__", [](const Expression& a, double b) { return pow(Expression(b), a); }, py::is_operator())
      .def("tan", [](const Expression& a) { return sin(a) / cos(a); });
}

/// What a function in Python computes at its place, as a list of steps.
class TracedFunction {
public:
  /// Traces a function, and compares what was written down with what the function answers.
  /// @param members  of the place
  /// @return nothing where it cannot be traced: it uses functions that a traced number does not know, branches too often, or answers
  ///         otherwise than was written down
  static std::shared_ptr<const TracedFunction> of(const py::object& act, const EffectMembers& members) {
    auto traced = std::make_shared<TracedFunction>();
    try {
      const std::vector<plant::Expression> results = traced->trace_.every_branch([&] {
        std::vector<plant::Expression> given;
        for (std::size_t i = 0; i < members.inputs(); ++i)
          given.push_back(traced->trace_.symbol(std::to_string(i)));
        std::vector<plant::Expression> answer = members.answer(act, given);
        if (traced->results_ == 0) traced->results_ = answer.size();
        if (answer.size() != traced->results_)
          throw plant::NotTraceable("its branches add different frictions");
        return answer;
      });
      traced->write_down(results);
      if (!traced->agrees(act, members)) return nullptr;
    } catch (const py::error_already_set&) {
      return nullptr;
    } catch (const plant::InvalidInput&) {  // it left no number
      return nullptr;
    } catch (const plant::NotTraceable&) {
      return nullptr;
    }
    return traced;
  }

  /// How many numbers it answers.
  std::size_t results() const { return results_; }

  /// Computes what the function answers. @param given  as many as the place has inputs  @param out  results() numbers
  template <class Scalar>
  void compute(const std::vector<Scalar>& given, std::vector<Scalar>& out) const {
    thread_local std::vector<Scalar> values;
    values.resize(steps_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) values[i] = computed(steps_[i], given, values);
    out.resize(results_);
    for (std::size_t i = 0; i < results_; ++i) out[i] = values[static_cast<std::size_t>(answers_[i])];
  }

private:
  using Kind = plant::Trace::Kind;
  enum class Function { none, exp, log, sin, cos, tanh, sqrt, abs };

  /// A step: as plant::Trace::Node has it, without names.
  struct Step {
    Kind kind;
    Function function;
    double value;       // of a constant
    std::size_t input;  // of a symbol
    int a, b, c;        // earlier steps; of a choice a comparison, what it is where that holds, and else
  };

  static Function function_of(const std::string& name) {
    constexpr std::pair<const char*, Function> known[] = {
        {"exp", Function::exp},   {"log", Function::log},   {"sin", Function::sin}, {"cos", Function::cos},
        {"tanh", Function::tanh}, {"sqrt", Function::sqrt}, {"abs", Function::abs}};
    for (const auto& [of, function] : known)
      if (name == of) return function;
    throw plant::NotTraceable("it uses " + name);
  }

  /// Keeps the steps that the results need, in their order.
  void write_down(const std::vector<plant::Expression>& results) {
    const std::vector<plant::Trace::Node>& nodes = trace_.nodes();
    std::vector<char> needed(nodes.size(), 0);
    for (const plant::Expression& one : results)
      if (!one.is_constant()) needed[static_cast<std::size_t>(one.node())] = 1;
    for (std::size_t i = nodes.size(); i-- > 0;)
      for (const int argument : {nodes[i].a, nodes[i].b, nodes[i].c})
        if (needed[i] != 0 && argument >= 0) needed[static_cast<std::size_t>(argument)] = 1;
    std::vector<int> place(nodes.size(), -1);
    const auto moved = [&](int node) { return node < 0 ? -1 : place[static_cast<std::size_t>(node)]; };
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (needed[i] == 0) continue;
      const plant::Trace::Node& node = nodes[i];
      place[i] = static_cast<int>(steps_.size());
      steps_.push_back({node.kind, node.kind == Kind::function ? function_of(node.name) : Function::none,
                        node.value, node.kind == Kind::symbol ? std::stoul(node.name) : 0, moved(node.a),
                        moved(node.b), moved(node.c)});
    }
    for (const plant::Expression& one : results) {
      answers_.push_back(one.is_constant() ? static_cast<int>(steps_.size()) : moved(one.node()));
      if (one.is_constant())
        steps_.push_back({Kind::constant, Function::none, one.constant_value(), 0, -1, -1, -1});
    }
  }

  template <class Scalar>
  static Scalar called(Function function, const Scalar& x) {
    using std::abs, std::cos, std::exp, std::log, std::sin, std::sqrt, std::tanh;
    switch (function) {
      case Function::exp:
        return exp(x);
      case Function::log:
        return log(x);
      case Function::sin:
        return sin(x);
      case Function::cos:
        return cos(x);
      case Function::tanh:
        return tanh(x);
      case Function::sqrt:
        return sqrt(x);
      case Function::abs:
        return abs(x);
      case Function::none:
        break;
    }
    return x;
  }

  template <class Scalar>
  static Scalar chosen(Kind kind, const Scalar& a, const Scalar& b, const Scalar& yes, const Scalar& no) {
    using plant::value_of;
    const double left = value_of(a), right = value_of(b);
    return (kind == Kind::less            ? left < right
            : kind == Kind::less_or_equal ? left <= right
                                          : left == right)
               ? yes
               : no;
  }
  static plant::Expression chosen(Kind kind, const plant::Expression& a, const plant::Expression& b,
                                  const plant::Expression& yes, const plant::Expression& no) {
    return plant::Trace::choice(kind == Kind::less            ? a < b
                                : kind == Kind::less_or_equal ? a <= b
                                                              : a == b,
                                yes, no);
  }

  template <class Scalar>
  Scalar computed(const Step& step, const std::vector<Scalar>& given,
                  const std::vector<Scalar>& values) const {
    const auto argument = [&](int at) -> const Scalar& { return values[static_cast<std::size_t>(at)]; };
    switch (step.kind) {
      case Kind::constant:
        return Scalar(step.value);
      case Kind::symbol:
        return given[step.input];
      case Kind::negative:
        return -argument(step.a);
      case Kind::sum:
        return argument(step.a) + argument(step.b);
      case Kind::difference:
        return argument(step.a) - argument(step.b);
      case Kind::product:
        return argument(step.a) * argument(step.b);
      case Kind::quotient:
        return argument(step.a) / argument(step.b);
      case Kind::function:
        return called(step.function, argument(step.a));
      case Kind::power:
        return raised(argument(step.a), argument(step.b));
      case Kind::choice: {
        const Step& asked = steps_[static_cast<std::size_t>(step.a)];
        return chosen(asked.kind, argument(asked.a), argument(asked.b), argument(step.b), argument(step.c));
      }
      default:
        break;  // a comparison is made where it is asked
    }
    return Scalar(0.0);
  }

  /// Whether the steps answer what the function does, for numbers of several sizes and signs. Where the function fails, as a root of
  /// a negative number does, nothing is compared.
  bool agrees(const py::object& act, const EffectMembers& members) const {
    constexpr int points = 16;
    constexpr double close = 1e-9;
    bool any = false;
    for (int point = 0; point < points; ++point) {
      std::vector<double> given, computed_now;
      for (std::size_t i = 0; i < members.inputs(); ++i) {
        // Between a hundredth and a hundred, evenly in the logarithm: the fractions of multiples of the golden ratio.
        const double turn =
            0.6180339887498949 * static_cast<double>(1 + point + points * static_cast<int>(i));
        const double share = turn - std::floor(turn);
        given.push_back(std::pow(10.0, 4.0 * share - 2.0) * (point % 4 == 3 && i % 2 == 0 ? -1.0 : 1.0));
      }
      std::vector<double> answered;
      try {
        answered = members.answer(act, given);
      } catch (const py::error_already_set&) {
        continue;
      }
      compute(given, computed_now);
      if (answered.size() != computed_now.size()) return false;
      for (std::size_t i = 0; i < answered.size(); ++i) {
        const double apart = std::abs(answered[i] - computed_now[i]);
        if (std::isfinite(answered[i]) && !(apart <= close * std::max(1.0, std::abs(answered[i]))))
          return false;
      }
      any = true;
    }
    return any;
  }

  plant::Trace trace_;  // a function may have kept a number that points to it
  std::vector<Step> steps_;
  std::vector<int> answers_;
  std::size_t results_ = 0;
};

}  // namespace thermopower::python
