// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/propose/effort_fit.hpp>
#include <thermopower/gap/propose/effort_residual.hpp>
#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/instance.hpp>
#include <thermopower/plant/radians.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// @file effort_starts.hpp
/// An effect in the inverse problem: where fits of it begin, and when its name does not fit.

namespace thermopower::gap::engine {

/// Whether a parameter counts cycles of the angle in a turn.
inline bool counts_cycles(const plant::Parameter& parameter) { return parameter.name == "cycles_per_turn"; }

/// Whether an effect has such a parameter.
inline bool counts_cycles(const plant::CatalogueEntry& entry) {
  const auto& all = entry.info.parameters;
  return std::any_of(all.begin(), all.end(), [](const plant::Parameter& one) { return counts_cycles(one); });
}

/// Whether effort may tell a parameter, so that a fit moves it. How a friction turns over near rest, and details of a shape, it
/// does not: they stand at their standard. The range of a curve comes from the data.
inline bool is_fitted(const plant::Parameter& parameter) {
  return !parameter.standard && !parameter.given_by_data;
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
  std::vector<double> first;
  for (const plant::Parameter& one : entry.info.parameters) {
    assert(one.standard || !one.starts.empty());
    first.push_back(one.standard ? *one.standard : one.starts.front());
  }
  return structure_of(entry, first);
}

/// Whether it hangs part of the inertia on a spring.
inline bool makes_a_spring(const plant::CatalogueEntry& entry) { return structure_of(entry).compliant; }

/// The longest delay from effort to torque that is looked for, s. @param interval_s  between rows
inline double longest_delay_s(double interval_s) {
  return std::max(propose_thresholds.longest_delay_rows * interval_s, propose_thresholds.longest_delay_s);
}

/// Constants of the axis and of the model's own effects on it, with their priors.
inline std::vector<EffortCoordinate> constants_of(const Model& model, const Catalogue& catalogue) {
  constexpr double farthest = 1e6;  // real inertias were off by 27 000
  // Inertia and drag take in what a fit lacked; a winding's constants are read from a sheet.
  constexpr double fitted_by_users = 5.0, stated = 0.5;  // logarithms
  std::vector<EffortCoordinate> list;
  const std::vector<CalibratedConstant> all = model.calibrated();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const CalibratedConstant& constant = all[k];
    bool acts = constant.block == "axis" && constant.has_slack;
    if (const plant::CatalogueEntry* effect = catalogue.find(constant.effect()))
      for (const plant::Parameter& parameter : effect->info.parameters)
        acts = acts || (effect->hooks.any_axis() && parameter.name == constant.fields.front() &&
                        is_fitted(parameter));
    if (!acts) continue;
    EffortCoordinate& one = list.emplace_back();
    one.is_constant = true;
    one.constant = k;
    one.is_place = constant.is_place;
    one.upper = constant.is_place ? known_constants.farthest_place_rad : farthest;
    one.lower = constant.is_place ? -one.upper : 1.0 / farthest;
    const bool is_stated = constant.block == "axis" && constant.id != "inertia" && constant.id != "viscous";
    one.first_reach = constant.is_place ? one.upper : is_stated ? stated : fitted_by_users;
    one.prior.sd = model.uncertainty_of(constant, known_constants.uncertainty);
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
                          std::vector<EffortCoordinate>& constants) {
  constexpr double seen = 0.002;  // of the effort's RMS
  const EffortPoint point = unmoved_point(model);
  const std::vector<CalibratedConstant> all = model.calibrated();
  for (EffortCoordinate& one : constants) {
    if (all[one.constant].id != "inertia") continue;
    const Eigen::MatrixXd by = data.evaluate(point, {one}).jacobian;
    const double needs = std::sqrt(by.squaredNorm() / static_cast<double>(by.rows()));
    if (needs > 0.0) one.lower = std::clamp(seen * data.compared().effort_rms / needs, one.lower, 1.0);
  }
}

/// The whole numbers of cycles in a turn that values go with most, best first.
/// @param angle_rad  one per value
/// @return a few; those beside a better one are left out
inline std::vector<double> cycles_in_turn(const Eigen::VectorXd& angle_rad, const Eigen::VectorXd& values) {
  constexpr int most = 150;
  constexpr double periods = 2.0;  // that must lie within the travel
  constexpr std::size_t count = 3;
  assert(values.size() > 0 && angle_rad.size() == values.size());
  const double travel = angle_rad.maxCoeff() - angle_rad.minCoeff();
  const int first =
      std::max(2, static_cast<int>(std::ceil(periods * plant::rad_per_turn / std::max(travel, 1e-3))));
  std::vector<std::pair<double, int>> power;
  Eigen::ArrayXd sine = (angle_rad.array() * static_cast<double>(first)).sin(),
                 cosine = (angle_rad.array() * static_cast<double>(first)).cos();
  const Eigen::ArrayXd step_sine = angle_rad.array().sin(), step_cosine = angle_rad.array().cos();
  for (int cycles = first; cycles <= most; ++cycles) {
    const double with_sine = (values.array() * sine).sum(), with_cosine = (values.array() * cosine).sum();
    power.emplace_back(-(with_sine * with_sine + with_cosine * with_cosine), cycles);
    const Eigen::ArrayXd next = cosine * step_cosine - sine * step_sine;
    sine = sine * step_cosine + cosine * step_sine;
    cosine = next;
  }
  std::sort(power.begin(), power.end());
  std::vector<double> best;
  for (const auto& [ignored, cycles] : power) {
    if (best.size() == count) break;
    const double at = static_cast<double>(cycles);
    const bool beside =
        std::any_of(best.begin(), best.end(), [&](double one) { return std::abs(one - at) < 1.5; });
    if (!beside) best.push_back(at);
  }
  return best;
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
        angle[i] = data.rows().angle_rad[compared.rows[static_cast<std::size_t>(i)].row];
      starts = cycles_in_turn(angle, left);
      for (const double one : cycles_in_turn(angle, left.cwiseProduct(compared.effort)))
        starts.push_back(one);
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

/// Whether an effect with these parameters still is what its name says: it has a size, and stands on no bound where it is
/// something else.
/// @param rate_rad_per_s  of the motion
inline bool is_itself(const plant::CatalogueEntry& entry, const std::vector<double>& parameters,
                      const Model& model, const Eigen::VectorXd& rate_rad_per_s) {
  constexpr double near = 1e-9;
  bool has_size = false, is_absent = true;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const plant::Parameter& one = entry.info.parameters[p];
    if (!is_fitted(one)) continue;
    const double range = one.upper - one.lower, at = parameters[p];
    const bool low = at <= one.lower + near * range, high = at >= one.upper - near * range;
    if ((one.degenerate_at_bounds && (low || high)) || (one.degenerate_at_upper && high)) return false;
    if (one.within_the_motion && at > rate_rad_per_s.cwiseAbs().maxCoeff()) return false;
    if (one.absent_at != one.lower && one.absent_at != one.upper) continue;
    has_size = true;
    is_absent = is_absent && (one.absent_at == one.lower ? at <= one.lower + 1e-12 : at >= one.upper - 1e-12);
  }
  const bool alone = model.effects.empty();
  return !(has_size && is_absent) &&
         (entry.info.is_itself == nullptr || entry.info.is_itself(parameters.data())) &&
         (entry.info.is_itself_alone == nullptr || !alone || entry.info.is_itself_alone(parameters.data()));
}

}  // namespace thermopower::gap::engine
