// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  an axis bends a hose, and its simulation is wrong in a way that the catalogue has no name for.
// Model:    J dw/dt = Kt i - b w under test; the real axis has a torque - k theta^3 besides.
// Notation: theta angle in rad, w rate in rad/s, i current in A, k stiffness in N m/rad^3; angles in recordings in degrees.
//
// The effect is one type in one file, stiffening_hose.hpp. Because it exists it is simulated, fitted (derivatives by
// automatic differentiation), weighed against all others, and reported. With a folder as argument it writes what
// the program thermopower-gap would: report, page, augmented model and a header for firmware, with the equation
// of stiffening_hose.hpp in it.
#include "stiffening_hose.hpp"

#include <thermopower/gap/diagnose.hpp>

#ifdef OWN_EFFECT_WRITES_FILES
#include <thermopower/io.hpp>
#endif

#include <cmath>
#include <cstdio>
#include <random>
#include <string>

namespace gap = thermopower::gap;

namespace {

constexpr double stiffness = 4.0e-3;  // what the diagnosis does not know

// The "real" axis, integrated in steps of 0.1 ms and logged at 100 Hz with sensor noise.
gap::Recording record(double seconds, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> angle_noise(0.0, 0.02), rate_noise(0.0, 0.15);
  const Eigen::Index rows = static_cast<Eigen::Index>(seconds * 100.0);
  gap::Recording recording;
  recording.name = "axis " + std::to_string(seed);
  recording.t_s.resize(rows);
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  double theta = 0.0, w = 0.0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t = 0.01 * static_cast<double>(i), phase = static_cast<double>(seed);
    recording.t_s[i] = t;
    drive[i] =
        0.12 * std::sin(1.9 * t + phase) + 0.10 * std::sin(0.6 * t) + 0.06 * std::sin(7.3 * t + 2.0 * phase);
    angle[i] = theta * 57.29577951308232 + angle_noise(random);
    rate[i] = w * 57.29577951308232 + rate_noise(random);
    for (int k = 0; k < 100; ++k) {
      w += 1e-4 * (0.2 * drive[i] - 1e-3 * w - stiffness * theta * theta * theta) / 1e-3;
      theta += 1e-4 * w;
    }
  }
  recording.set("drive_A", drive);
  recording.set("angle_deg", angle);
  recording.set("rate_dps", rate);
  return recording;
}

}  // namespace

int main(int count, char** values) {
  gap::Model model;
  model.name = "axis with a hose";
  model.axis = gap::RigidAxisModel{1.02e-3, 1e-3, 0.2};  // the inertia is 2 % off, as constants are
  const std::vector<gap::Recording> train = {record(40.0, 1)}, held_out = {record(25.0, 2)};

  gap::Catalogue catalogue = gap::standard_catalogue();
  catalogue.add<StiffeningHose>();

  const gap::Diagnosis diagnosis = gap::diagnose(model, train, held_out, {}, catalogue);

  std::printf("verdict: %s\n", gap::to_string(diagnosis.verdict));
  for (const gap::Location& where : diagnosis.where) {
    std::printf("where:   %s, %s: %s\n", to_string(where.signal).c_str(), to_string(where.submodel).c_str(),
                where.evidence.c_str());
  }
  bool found = false;
  for (const gap::Cause& cause : diagnosis.cause) {
    for (const gap::ParameterEstimate& one : cause.parameters) {
      std::printf("which:   %s, %.0f %%: %s = %.3g [%.3g, %.3g] %s (true: %.3g)\n", cause.effect.c_str(),
                  100.0 * cause.probability, one.name.c_str(), one.value, one.ci95.low, one.ci95.high,
                  one.unit.c_str(), stiffness);
      found =
          found || (cause.effect == "stiffening_hose" && std::fabs(one.value - stiffness) < 0.05 * stiffness);
    }
  }
  for (const gap::GapScore& score : diagnosis.gap) {
    std::printf("gap:     %-10s %.3g -> %.3g %s (noise floor %.3g)\n", to_string(score.signal).c_str(),
                score.before, score.after, score.unit.c_str(), score.noise_floor);
  }
#ifdef OWN_EFFECT_WRITES_FILES
  if (count > 1) {
    //! [writing files]
    namespace io = thermopower::io;
    const std::string folder = values[1];
    io::OutputFiles files;
    files.put(folder + "/report.json", io::report_json(diagnosis));
    files.put(folder + "/report.html", io::report_html(diagnosis, model.name, catalogue.list(), held_out));
    files.put(folder + "/augmented.json", io::to_json(diagnosis.augmented));
    files.put(folder + "/motor_model.hpp",
              io::motor_model_header(diagnosis.augmented, io::one_sentence(diagnosis), catalogue).text);
    files.commit();  // all of them, or none
    //! [writing files]
  }
#else
  static_cast<void>(count);
  static_cast<void>(values);
#endif
  return found ? 0 : 1;
}
