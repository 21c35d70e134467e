// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/propose/effort_fit.hpp>
#include <thermopower/gap/propose/effort_residual.hpp>
#include <thermopower/gap/propose/inverse_score.hpp>
#include <thermopower/gap/propose/periods.hpp>
#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/instance.hpp>
#include <thermopower/plant/submodel.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file effort_starts.hpp
/// An effect in the inverse problem: where fits of it begin, and when its name does not fit.

namespace thermopower::gap::engine {

/// Whether a parameter counts cycles of the angle in a turn.
inline bool counts_cycles(const plant::Parameter& parameter) { return parameter.name == "cycles_per_turn"; }

/// Whether effort may tell a parameter, so that a fit moves it. How a friction turns over near rest, and details of a shape, it
/// does not: they stand at their standard. The range of a curve comes from the data.
inline bool is_fitted(const plant::Parameter& parameter) {
  return !parameter.standard && !parameter.given_by_data;
}

/// Whether an effect has such a parameter.
inline bool counts_cycles(const plant::CatalogueEntry& entry) {
  const auto& all = entry.info.parameters;
  return std::any_of(all.begin(), all.end(), [](const plant::Parameter& one) { return counts_cycles(one); });
}

/// The first start of each parameter, or its standard.
inline std::vector<double> first_starts(const plant::CatalogueEntry& entry) {
  std::vector<double> values;
  for (const plant::Parameter& one : entry.info.parameters) {
    assert(one.standard || !one.starts.empty());
    values.push_back(one.standard ? *one.standard : one.starts.front());
  }
  return values;
}

/// The structure of an axis with an effect.
inline plant::AxisStructure<double> structure_of(const plant::CatalogueEntry& entry,
                                                 const std::vector<double>& parameters) {
  plant::AxisStructure<double> shape = {};
  if (entry.hooks.axis_structure) entry.of<double>().call(parameters.data(), shape);
  return shape;
}

/// The same where a fit begins.
inline plant::AxisStructure<double> structure_of(const plant::CatalogueEntry& entry) {
  return structure_of(entry, first_starts(entry));
}

/// Whether it hangs part of the inertia on a spring.
inline bool makes_a_spring(const plant::CatalogueEntry& entry) { return structure_of(entry).compliant; }

/// The longest delay from effort to torque that is looked for, s. @param interval_s  between rows
inline double longest_delay_s(double interval_s) {
  return std::max(propose_thresholds.longest_delay_rows * interval_s, propose_thresholds.longest_delay_s);
}

/// Constants of the axis and of the model's own effects on it, with their priors.
inline std::vector<BoundedCoordinate> constants_of(const Model& model, const Catalogue& catalogue) {
  constexpr double farthest = 1e6;  // real inertias were off by 27 000
  std::vector<BoundedCoordinate> list;
  const std::vector<CalibratedConstant> all = model.calibrated();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const CalibratedConstant& constant = all[k];
    bool acts = constant.block == "axis" && constant.has_slack;
    if (const plant::CatalogueEntry* effect = catalogue.find(constant.effect()))
      for (const plant::Parameter& parameter : effect->info.parameters)
        acts = acts || (effect->hooks.any_axis() && parameter.name == constant.fields.front() &&
                        is_fitted(parameter));
    if (!acts) continue;
    BoundedCoordinate one;
    one.at.is_constant = true;
    one.at.constant = k;
    one.is_place = constant.is_place;
    one.lower = constant.is_place ? -known_constants.farthest_place_rad : 1.0 / farthest;
    one.upper = constant.is_place ? known_constants.farthest_place_rad : farthest;
    // Inertia and drag take in what a fit lacked; a winding's constants are read from a sheet.
    constexpr double fitted_by_users = 5.0, stated = 0.5;  // logarithms
    const bool is_fitted = constant.id == "inertia" || constant.id == "viscous" || constant.block != "axis";
    one.first_reach = constant.is_place ? known_constants.farthest_place_rad
                      : is_fitted       ? fitted_by_users
                                        : stated;
    one.prior.sd = model.uncertainty_of(constant, known_constants.uncertainty);
    list.push_back(one);
  }
  return list;
}

/// The model as configured.
inline EffortPoint unmoved_point(const Model& model) {
  EffortPoint point;
  for (const CalibratedConstant& one : model.calibrated()) point.factors.push_back(one.unmoved());
  return point;
}

/// Lets an inertia fall no further than to what a 500th of the effort needs. Less is not seen, and next to none moves at once.
inline void bound_inertia(const Model& model, const EffortResidual& data,
                          std::vector<BoundedCoordinate>& constants) {
  constexpr double seen = 0.002;  // of the effort's RMS
  const EffortPoint point = unmoved_point(model);
  const std::vector<CalibratedConstant> all = model.calibrated();
  for (BoundedCoordinate& one : constants) {
    if (all[one.at.constant].id != "inertia") continue;
    const Eigen::MatrixXd by = data.evaluate(point, {one.at}).jacobian;
    const double needs =
        std::sqrt(by.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, by.rows())));
    if (needs > 0.0) one.lower = std::clamp(seen * data.compared().effort_rms / needs, one.lower, 1.0);
  }
}

/// Where fits of an effect begin: the products of its parameters' starts. Cycles in a turn come from the residuals, delays
/// from the rows.
/// @param left  residuals of effort without the effect, at the compared rows
inline std::vector<std::vector<double>> starts_of(const plant::CatalogueEntry& entry,
                                                  const EffortResidual& data, const Eigen::VectorXd& left) {
  const ComparedRows& compared = data.compared();
  assert(left.size() == compared.size());
  std::vector<std::vector<double>> all = {{}};
  for (const plant::Parameter& parameter : entry.info.parameters) {
    assert(parameter.lower <= parameter.upper);
    std::vector<double> starts = parameter.starts;
    if (!is_fitted(parameter)) {
      starts = {parameter.standard.value_or(starts.front())};
    } else if (counts_cycles(parameter)) {
      Eigen::VectorXd angle(compared.size());
      for (Eigen::Index i = 0; i < angle.size(); ++i)
        angle[i] = data.rows().angle_rad[compared.rows[static_cast<std::size_t>(i)]];
      constexpr int most = 150;
      constexpr double periods = 2.0;
      constexpr std::size_t count = 3;
      starts = cycles_in_turn(angle, left, periods, most, count);
      const Eigen::VectorXd with_effort = left.cwiseProduct(compared.effort);
      for (const double one : cycles_in_turn(angle, with_effort, periods, most, count)) starts.push_back(one);
    } else if (structure_of(entry).delayed) {
      const double interval_s = data.rows().pieces.front().interval_s;
      const double longest_s = longest_delay_s(interval_s);
      const double step_s = std::max(0.5 * interval_s, longest_s / 40.0);
      starts.clear();
      for (double at = step_s; at <= longest_s * 1.001; at += step_s) starts.push_back(at);
    } else if (parameter.starts_relative_to == plant::Input::drive_A) {
      const double largest = compared.effort.cwiseAbs().maxCoeff() * data.ampere_per_effort();
      for (double& one : starts) one *= largest;
    }
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& one : all)
      for (const double value : starts) {
        longer.push_back(one);
        longer.back().push_back(std::clamp(value, parameter.lower, parameter.upper));
      }
    all = std::move(longer);
  }
  return all;
}

/// Why an effect with these parameters does not count.
/// @param rate_rad_per_s  of the motion
inline InverseRefusal why_not_with(const plant::CatalogueEntry& entry, const std::vector<double>& parameters,
                                   const Model& model, const Eigen::VectorXd& rate_rad_per_s) {
  constexpr double near = 1e-9;
  bool has_size = false, is_absent = true;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const plant::Parameter& one = entry.info.parameters[p];
    if (!is_fitted(one)) continue;
    const double range = one.upper - one.lower, at = parameters[p];
    const bool low = at <= one.lower + near * range, high = at >= one.upper - near * range;
    if ((one.degenerate_at_bounds && (low || high)) || (one.degenerate_at_upper && high))
      return InverseRefusal::not_itself;
    if (one.within_the_motion && at > rate_rad_per_s.cwiseAbs().maxCoeff()) return InverseRefusal::not_itself;
    if (one.absent_at != one.lower && one.absent_at != one.upper) continue;
    has_size = true;
    is_absent = is_absent && (one.absent_at == one.lower ? at <= one.lower + 1e-12 : at >= one.upper - 1e-12);
  }
  if (has_size && is_absent)
    return entry.info.submodel == plant::Submodel::mechanical_friction ? InverseRefusal::drives_the_motion
                                                                       : InverseRefusal::vanishes;
  if (entry.info.is_itself != nullptr && !entry.info.is_itself(parameters.data()))
    return InverseRefusal::not_itself;
  if (entry.info.is_itself_alone != nullptr && model.effects.empty() &&
      !entry.info.is_itself_alone(parameters.data()))
    return InverseRefusal::not_itself;
  return InverseRefusal::none;
}

}  // namespace thermopower::gap::engine
