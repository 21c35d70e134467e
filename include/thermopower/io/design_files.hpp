// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/diagnosed.hpp>
#include <thermopower/design/limits.hpp>
#include <thermopower/design/outcome.hpp>
#include <thermopower/io/names.hpp>
#include <thermopower/plant/catalogue.hpp>

#include <string>

namespace thermopower::io {

/// @brief Reads what the next experiment may do ("thermopower-limits/1", @ref gap_files). Strict, as read_model() is.
/// @throws InputError that names file, field and what was expected
design::Limits read_limits(const std::string& path);

/// @brief The same on text in memory; `name` stands in messages where a path would.
design::Limits parse_limits(const std::string& name, const std::string& text);

/// @brief Reads of a report ("thermopower-gap-report/1") what a design needs: model, verdict, explanations with their numbers,
/// signals with their noise.
/// @param catalogue  knows the effects of the model
/// @throws InputError where it is no report, or one that a version without `design` wrote
design::DiagnosedGap read_report(const std::string& path, const Catalogue& catalogue);

/// @brief The same on text in memory.
design::DiagnosedGap parse_report(const std::string& name, const std::string& text,
                                  const Catalogue& catalogue);

/// @brief The schedule as CSV: `t_s` and a column for each input, which holds until the next row.
std::string schedule_csv(const design::Design& design);

/// @brief The schedule as a header for C and C++: whole numbers of 16 bits in program memory, with the unit of each input.
/// @param limits  tell which inputs are played; those that are held are left out
std::string schedule_header(const design::Design& design, const design::Limits& limits);

/// @brief A page that shows the inputs, and for each class the predicted curve of each signal with its band.
/// @param title  of the page, as the model's name
std::string design_html(const design::Design& design, const design::Limits& limits, const std::string& title);

/// @brief What a person reads on the screen.
std::string design_summary(const design::Design& design, const design::Limits& limits);

}  // namespace thermopower::io
