// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/expression.hpp>
#include <thermopower/io/names.hpp>

#include <set>
#include <string>
#include <vector>

namespace thermopower::io {

/// How an expression is spelt.
enum class Spelling {
  firmware,  ///< C++11 in single precision, with the functions of <math.h>
  formula    ///< for people: no suffixes, |x| for a magnitude, ^ for a power
};

/// A number as code of that spelling: `0.25f` or `0.25`.
std::string number_text(double value, Spelling spelling);

/// What the table of a curve is called in code. @param id  of the curve, such as `unknown.load(angle_deg)`
std::string curve_table_name(const std::string& id);

/// An expression in one line.
std::string expression_text(const plant::Expression& value, Spelling spelling);

/// The names of the symbols that expressions depend on.
std::set<std::string> symbols_of(const std::vector<plant::Expression>& values);

/// One result of a computation, and what becomes of it: `return`, or `float& x =`.
struct Statement {
  std::string target;       ///< what stands before the value: `return`, `terms.duty =`
  plant::Expression value;  ///< its symbols are in scope where the code is pasted
};

/// Firmware code that computes results, each step that several of them use once, as a `const float`.
/// @param indent  spaces before each line
std::string code_text(const std::vector<Statement>& statements, int indent);

}  // namespace thermopower::io
