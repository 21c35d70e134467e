// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "expression_text.hpp"

#include <cctype>
#include <cstdio>
#include <map>

namespace thermopower::io {
namespace {

using plant::Expression;
using plant::Trace;
using Kind = Trace::Kind;

/// How tightly an operation binds, as in C++.
enum Binding { choice_binds = 1, comparison_binds, sum_binds, product_binds, sign_binds, all_binds };

class Printer {
public:
  Printer(const Trace& trace, Spelling spelling)
      : trace_(trace), nodes_(trace.nodes()), spelling_(spelling) {}

  /// Says that a node has a name of its own from here on.
  void name(int node, const std::string& text) { named_[node] = text; }

  std::string text(int node, int at_least) const {
    const auto known = named_.find(node);
    if (known != named_.end()) return known->second;
    int binds = all_binds;
    std::string out = plain(node, binds);
    return binds < at_least ? "(" + out + ")" : out;
  }

private:
  std::string two(const Trace::Node& node, const char* sign, int left, int right) const {
    return text(node.a, left) + sign + text(node.b, right);
  }

  std::string plain(int place, int& binds) const {
    const Trace::Node& node = nodes_[static_cast<std::size_t>(place)];
    const bool firmware = spelling_ == Spelling::firmware;
    switch (node.kind) {
      case Kind::constant:
        if (node.value < 0.0) binds = sign_binds;
        return number_text(node.value, spelling_);
      case Kind::symbol:
        return node.name;
      case Kind::negative:
        binds = sign_binds;
        return "-" + text(node.a, all_binds);
      case Kind::sum:
        binds = sum_binds;
        return two(node, " + ", sum_binds, sum_binds);
      case Kind::difference:
        binds = sum_binds;
        return two(node, " - ", sum_binds, product_binds);
      case Kind::product:
        binds = product_binds;
        return two(node, firmware ? " * " : " ", product_binds, product_binds);
      case Kind::quotient:
        binds = product_binds;
        return two(node, " / ", product_binds, sign_binds);
      case Kind::power:
        if (firmware) return "powf(" + text(node.a, choice_binds) + ", " + text(node.b, choice_binds) + ")";
        return text(node.a, all_binds) + "^" + text(node.b, all_binds);
      case Kind::function:
        if (firmware)
          return (node.name == "abs" ? "fabs" : node.name) + "f(" + text(node.a, choice_binds) + ")";
        if (node.name == "abs") return "|" + text(node.a, choice_binds) + "|";
        return node.name + "(" + text(node.a, choice_binds) + ")";
      case Kind::less:
        binds = comparison_binds;
        return two(node, " < ", sum_binds, sum_binds);
      case Kind::less_or_equal:
        binds = comparison_binds;
        return two(node, " <= ", sum_binds, sum_binds);
      // Equality is written as neither below nor above: compilers warn of == between floating-point numbers.
      case Kind::equal:
        binds = all_binds;
        if (!firmware) return "(" + two(node, " = ", sum_binds, sum_binds) + ")";
        return "(" + two(node, " <= ", sum_binds, sum_binds) + " && " + text(node.b, sum_binds) +
               " <= " + text(node.a, sum_binds) + ")";
      case Kind::choice:
        binds = choice_binds;
        if (firmware)
          return text(node.a, comparison_binds) + " ? " + text(node.b, comparison_binds) + " : " +
                 text(node.c, choice_binds);
        return text(node.b, comparison_binds) + " where " + text(node.a, comparison_binds) + ", else " +
               text(node.c, choice_binds);
      case Kind::curve:
      case Kind::curve_slope:
        return curve(node);
    }
    return "?";
  }

  /// A look-up in a table that the code around it declares under curve_table_name().
  std::string curve(const Trace::Node& node) const {
    const bool slope = node.kind == Kind::curve_slope;
    if (spelling_ == Spelling::formula)
      return (slope ? "slope of " : "") + node.name + " at (" + text(node.a, choice_binds) + ")";
    const plant::WrittenCurve& shape = trace_.curve_of(node.name);
    return std::string("thermopower::curve_") + (slope ? "slope(" : "value(") + curve_table_name(node.name) +
           ", " + std::to_string(shape.values.size()) + "u, " + number_text(shape.from, spelling_) + ", " +
           number_text(shape.to, spelling_) + ", " + text(node.a, choice_binds) + ")";
  }

  const Trace& trace_;
  const std::vector<Trace::Node>& nodes_;
  Spelling spelling_;
  std::map<int, std::string> named_;
};

/// How often each node is used by the results, and by what they use.
std::vector<int> uses(const Trace& trace, const std::vector<Expression>& values) {
  std::vector<int> count(trace.nodes().size(), 0);
  for (const Expression& value : values)
    if (!value.is_constant()) ++count[static_cast<std::size_t>(value.node())];
  for (std::size_t i = count.size(); i-- > 0;) {
    if (count[i] == 0) continue;
    const Trace::Node& node = trace.nodes()[i];
    for (const int argument : {node.a, node.b, node.c})
      if (argument >= 0) ++count[static_cast<std::size_t>(argument)];
  }
  return count;
}

const Trace* trace_of(const std::vector<Expression>& values) {
  for (const Expression& value : values)
    if (!value.is_constant()) return value.trace();
  return nullptr;
}

}  // namespace

std::string curve_table_name(const std::string& id) {
  std::string name;
  for (const char c : id)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
    else if (!name.empty() && name.back() != '_') name += '_';
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name + "_table";
}

std::string number_text(double value, Spelling spelling) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  std::string out = text;
  if (spelling == Spelling::formula) return out;
  if (out.find_first_of(".e") == std::string::npos) out += ".0";
  return out + "f";
}

std::string expression_text(const Expression& value, Spelling spelling) {
  if (value.is_constant()) return number_text(value.constant_value(), spelling);
  return Printer(*value.trace(), spelling).text(value.node(), choice_binds);
}

std::set<std::string> symbols_of(const std::vector<Expression>& values) {
  std::set<std::string> names;
  const Trace* const trace = trace_of(values);
  if (trace == nullptr) return names;
  const std::vector<int> count = uses(*trace, values);
  for (std::size_t i = 0; i < count.size(); ++i)
    if (count[i] > 0 && trace->nodes()[i].kind == Kind::symbol) names.insert(trace->nodes()[i].name);
  return names;
}

std::string code_text(const std::vector<Statement>& statements, int indent) {
  const std::string margin(static_cast<std::size_t>(indent), ' ');
  std::vector<Expression> values;
  for (const Statement& one : statements) values.push_back(one.value);
  std::string out;
  const Trace* const trace = trace_of(values);
  if (trace == nullptr) {
    for (const Statement& one : statements)
      out += margin + one.target + " " + expression_text(one.value, Spelling::firmware) + ";\n";
    return out;
  }
  const std::vector<int> count = uses(*trace, values);
  Printer printer(*trace, Spelling::firmware);
  int step = 0;
  for (std::size_t i = 0; i < count.size(); ++i) {
    const Kind kind = trace->nodes()[i].kind;
    const bool leaf = kind == Kind::constant || kind == Kind::symbol;
    const bool comparison = kind == Kind::less || kind == Kind::less_or_equal || kind == Kind::equal;
    if (count[i] < 2 || leaf) continue;
    const std::string name = "step" + std::to_string(++step);
    out += margin + (comparison ? "const bool " : "const float ") + name + " = " +
           printer.text(static_cast<int>(i), choice_binds) + ";\n";
    printer.name(static_cast<int>(i), name);
  }
  for (const Statement& one : statements)
    out += margin + one.target + " " +
           (one.value.is_constant() ? expression_text(one.value, Spelling::firmware)
                                    : printer.text(one.value.node(), choice_binds)) +
           ";\n";
  return out;
}

}  // namespace thermopower::io
