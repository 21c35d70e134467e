// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Joints creep by films whose shape the catalogue does not have: the friction is found all the same, at its size. The
// joints here share no equation and no integrator with the library.
#include "../../catch.hpp"
#include "../fixture.hpp"

#include <thermopower/gap/fit/attribution.hpp>

#include <cmath>

using namespace engine_fixture;

namespace {

using Film = double (*)(double rate_rad_per_s);

/// A joint of the fixture's constants under slow and fast commands, with friction of this size turning over by `film`:
/// semi-implicit steps of 10 us.
Recording creeping(Film film, double friction_Nm, std::uint64_t seed) {
  constexpr Eigen::Index rows = 3000;
  constexpr double dt_s = 0.01, step_s = 1e-5, angle_noise_deg = 0.02, rate_noise_dps = 0.15;
  Recording recording;
  recording.name = "creeping";
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, dt_s * static_cast<double>(rows - 1));
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  Noise noise(seed);
  double position = 0.0, speed = 0.0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t_s = recording.t_s[i];
    drive[i] = 0.16 * std::sin(1.7 * t_s) * std::sin(0.31 * t_s) + 0.05 * std::sin(5.3 * t_s);
    angle[i] = position * 57.29577951308232 + angle_noise_deg * noise.normal();
    rate[i] = speed * 57.29577951308232 + rate_noise_dps * noise.normal();
    for (int k = 0; k < static_cast<int>(dt_s / step_s + 0.5); ++k) {
      speed += step_s / 1e-3 * (0.1 * drive[i] - 1e-3 * speed - friction_Nm * film(speed));
      position += step_s * speed;
    }
  }
  recording.set("drive_A", drive);
  recording.set("angle_deg", angle);
  recording.set("rate_dps", rate);
  return recording;
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
