// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Joints creep by films whose shape the catalogue does not have: the friction is found all the same, at its size. The
// joints here share no equation and no integrator with the library.
#include "../../catch.hpp"
#include "joint_in_fine_steps.hpp"

#include <thermopower/gap/fit/attribution.hpp>

#include <cmath>

using namespace engine_fixture;

namespace {

using Film = double (*)(double rate_rad_per_s);

/// A joint with friction of this size that turns over by `film`.
Recording creeping(Film film, double friction_Nm, std::uint64_t seed) {
  return joint_in_fine_steps([&](double rate) { return 1e-3 * rate + friction_Nm * film(rate); }, seed);
}

double by_root(double w) { return w / std::sqrt(w * w + 0.03 * 0.03); }
double by_arc_tangent(double w) { return std::atan(w / 0.01) * 0.6366197723675814; }
double by_fraction(double w) { return w / (std::abs(w) + 0.008); }
double by_exponential(double w) { return std::copysign(1.0 - std::exp(-std::abs(w) / 0.02), w); }
double by_limit(double w) { return std::fmax(-1.0, std::fmin(1.0, w / 0.03)); }

}  // namespace

TEST_CASE("friction is found at its size whatever the shape of the film it creeps on") {
  constexpr double friction_Nm = 0.006;
  const Model model = axis_model();
  for (const Film film : {by_root, by_arc_tangent, by_fraction, by_exponential, by_limit}) {
    const std::vector<Inputs> inputs{prepare(model, creeping(film, friction_Nm, 7))};
    const FitProblem problem = problem_of(model, inputs);
    const Candidate fitted =
        Attribution(problem).fit({{standard_catalogue().find("coulomb_friction")}, {}}, {});
    const double level = std::sqrt(fitted.fit.chi2 / static_cast<double>(fitted.fit.samples));
    const std::size_t size = model.calibrated().size();
    INFO("film(0.01 rad/s) = " << film(0.01) << ": " << level << " times the noise, "
                               << fitted.fit.point[static_cast<Eigen::Index>(size)] << " N m");
    CHECK(fitted.list[size].name == "coulomb_friction.Nm");
    CHECK(level < 1.3);
    CHECK(std::abs(fitted.fit.point[static_cast<Eigen::Index>(size)] / friction_Nm - 1.0) < 0.05);
  }
}
