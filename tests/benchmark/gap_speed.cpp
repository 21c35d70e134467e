// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Time and memory of a whole diagnosis: gap_speed [rows ...], 100000 and 1000000 without arguments. Each
// length is generated in place as a motor in one run, in runs of 3000 rows, and with what dirties a log, as a moving axis, and as one
// that lacks two causes: in one run, in runs of 1000 rows, and dirty; written as CSV, read, and diagnosed with the whole
// catalogue on one thread and on two. Then one least-squares fit of the same residuals, with the same derivatives, by this library and by Ceres.

#include "../../tools/thermopower-gap/keep_memory.hpp"

#include <thermopower/gap/diagnose.hpp>
#include <thermopower/io/recording_file.hpp>

#include <thermopower/gap/fit/fitter.hpp>
#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/data/splitting.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#ifdef THERMOPOWER_HAS_CERES
#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#endif

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
namespace io = thermopower::io;

namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

long peak_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

Model motor() {
  Model model;
  model.name = "generated motor";
  model.supply = SupplyModel{12.0};
  model.current = OhmicCurrentModel{8.0, 0.00393, 25.0};
  model.thermal = LumpedThermalModel{60.0, 0.15};
  return model;
}

/// A motor that radiates, under power steps, logged at 10 Hz with noise, a 0.1 degC quantum and columns that
/// mean nothing. Every run of `run_rows` begins cold.
Recording motor_recording(Eigen::Index rows, Eigen::Index run_rows) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  Recording r;
  r.name = "generated";
  r.t_s.resize(rows);
  Eigen::VectorXd power(rows), current(rows), motor_C(rows), ambient(rows), supply(rows), airspeed(rows),
      neighbour(rows);
  double temperature = 24.0, level = 200.0;
  const double interval = 0.1;
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (i % run_rows == 0) {
      temperature = 24.0;
      r.runs.push_back({i, std::min(rows, i + run_rows), "r" + std::to_string(i / run_rows)});
    }
    if (i % 500 == 0) level = random() % 4 == 0 ? 0.0 : 25.0 * static_cast<double>(1 + random() % 10);
    const double air = 23.0 + std::sin(1e-4 * static_cast<double>(i));
    const double v = 12.0 * std::sqrt(level / 255.0), ohm = 8.0 * (1.0 + 0.00393 * (temperature - 25.0)),
                 amps = v / ohm;
    r.t_s[i] = interval * static_cast<double>(i);
    power[i] = level;
    current[i] = std::round(1e3 * (amps + 0.003 * noise(random))) / 1e3;
    motor_C[i] = std::round(10.0 * (temperature + 0.1 * noise(random))) / 10.0;
    ambient[i] = std::round(100.0 * (air + 0.05 * noise(random))) / 100.0;
    supply[i] = 12.0;
    airspeed[i] = std::fabs(std::sin(3e-4 * static_cast<double>(i)));
    neighbour[i] = 30.0 + 5.0 * std::sin(2e-4 * static_cast<double>(i));
    const double hot = temperature + 273.15, cold = air + 273.15;
    const double loss = 0.15 * (temperature - air) + 8e-10 * (std::pow(hot, 4.0) - std::pow(cold, 4.0));
    temperature += interval * (amps * amps * ohm - loss) / 60.0;
  }
  r.set("power_param", power);
  r.set("current_A", current);
  r.set("motor_C", motor_C);
  r.set("ambient_C", ambient);
  r.set("supply_V", supply);
  r.set("airspeed_mps", airspeed);
  r.set("neighbour_C", neighbour);
  return r;
}

Model axis() {
  Model model;
  model.name = "generated axis";
  model.axis = RigidAxisModel{1e-3, 2e-3, 0.1};
  return model;
}

/// An axis with dry friction, driven by a few frequencies, logged at 100 Hz with noise. Every run of `run_rows` begins at rest.
/// @param weight_Nm  of a load off the axis: a second cause
Recording axis_recording(Eigen::Index rows, double weight_Nm, Eigen::Index run_rows) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise;
  Recording r;
  r.name = "generated";
  r.t_s.resize(rows);
  Eigen::VectorXd drive(rows), angle(rows), rate(rows), motor_C(rows);
  double angle_rad = 0.0, rate_rad_per_s = 0.0;
  const double interval = 0.01, degrees = 57.29577951308232;
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (i % run_rows == 0) {
      angle_rad = rate_rad_per_s = 0.0;
      r.runs.push_back({i, std::min(rows, i + run_rows), "r" + std::to_string(i / run_rows)});
    }
    const double t_s = r.t_s[i] = interval * static_cast<double>(i);
    drive[i] = 0.1 * (std::sin(1.1 * t_s) + std::sin(2.9 * t_s + 1.0) + std::sin(7.3 * t_s + 2.0)) -
               0.05 * angle_rad;
    drive[i] = std::round(1e5 * drive[i]) / 1e5;
    angle[i] = angle_rad * degrees + 0.02 * noise(random);
    rate[i] = rate_rad_per_s * degrees + 0.15 * noise(random);
    motor_C[i] = 30.0 + 5.0 * std::sin(1e-3 * t_s);
    for (int step = 0; step < 50; ++step) {
      const double torque = 0.1 * drive[i] - 2e-3 * rate_rad_per_s - 4e-3 * std::tanh(rate_rad_per_s / 0.01) -
                            weight_Nm * std::sin(angle_rad + 0.5);
      rate_rad_per_s += interval / 50.0 * torque / 1e-3;
      angle_rad += interval / 50.0 * rate_rad_per_s;
    }
  }
  r.set("drive_A", drive);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  r.set("motor_C", motor_C);
  return r;
}

/// A recording with a hundredth of the samples of some columns far off, a few missing, frames that repeat the one before them,
/// and rows that were lost.
/// @param columns  with how far off a sample is at least, in their units; at most 21 times as far
Recording soiled(const Recording& clean, const std::vector<std::pair<const char*, double>>& columns) {
  std::mt19937 random(3);
  const auto one_in = [&](unsigned count) { return random() % count == 0; };
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < clean.rows(); ++i) {
    if (i > 0 && one_in(30000)) i += 300;
    if (i < clean.rows()) kept.push_back(i);
  }
  Recording r;
  r.name = clean.name;
  r.t_s = clean.t_s(kept);
  for (const auto& column : clean.columns) r.set(column.name, column.values(kept));
  r.runs.push_back({0, r.rows(), "r0"});
  for (const auto& [name, least] : columns) {
    Eigen::VectorXd values = *r.find(name);
    for (double& value : values) {
      if (one_in(100))
        value += (one_in(2) ? 1.0 : -1.0) * (1.0 + 0.05 * static_cast<double>(random() % 400)) * least;
      if (one_in(300)) value = std::nan("");
    }
    r.set(name, values);
  }
  std::vector<Eigen::VectorXd> outputs;
  for (const auto& column : columns) outputs.push_back(*r.find(column.first));
  for (Eigen::Index i = 1; i < r.rows(); ++i)
    if (one_in(2000))
      for (auto k = 2 + random() % 20; k > 0 && i < r.rows(); --k, ++i)
        for (Eigen::VectorXd& output : outputs) output[i] = output[i - 1];
  for (std::size_t c = 0; c < columns.size(); ++c) r.set(columns[c].first, outputs[c]);
  return r;
}

void write_csv(const Recording& r, const std::string& path) {
  std::FILE* const file = std::fopen(path.c_str(), "w");
  if (file == nullptr) std::exit(1);
  std::fputs(r.runs.size() > 1 ? "run,t_s" : "t_s", file);
  for (const auto& column : r.columns) std::fprintf(file, ",%s", column.name.c_str());
  std::size_t run = 0;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    if (run + 1 < r.runs.size() && i == r.runs[run].end) ++run;
    std::fputc('\n', file);
    if (r.runs.size() > 1) std::fprintf(file, "%s,", r.runs[run].label.c_str());
    std::fprintf(file, "%.10g", r.t_s[i]);
    for (const auto& column : r.columns) std::fprintf(file, ",%.6g", column.values[i]);
  }
  std::fputs("\n", file);
  std::fclose(file);
}

/// Does something in a process of its own, whose memory nothing else has filled.
template <class Work>
void apart(Work&& work) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child != 0) {
    waitpid(child, nullptr, 0);
    return;
  }
  work();
  std::fflush(stdout);
  _exit(0);
}

/// One recording.
void measure(const char* what, const Model& model, const std::string& path, Eigen::Index rows,
             unsigned threads) {
  const double begin = now_s();
  Recording recording = io::read_recording(path).recording;
  const double read = now_s();
  std::vector<Recording> train(1), held_out(1);
  std::tie(train.front(), held_out.front()) = split(recording, 0.3);
  recording = Recording();
  Options options;
  options.threads = threads;
  const Diagnosis diagnosis = diagnose(model, train, held_out, options);
  const double end = now_s();
  std::printf("%-15s %8td rows, %u thread%s: %6.2f s, %4ld MB; reading %.2f", what,
              static_cast<std::ptrdiff_t>(rows), threads, threads == 1 ? " " : "s", end - begin, peak_MB(),
              read - begin);
  for (const auto& stage : diagnosis.timings) std::printf(", %s %.2f", stage.stage.c_str(), stage.seconds);
  std::printf(" (%s", to_string(diagnosis.verdict));
  for (const auto& cause : diagnosis.cause) std::printf(" %s", cause.effect.c_str());
  std::printf(")\n");
}

#ifdef THERMOPOWER_HAS_CERES
/// The start of a motor: two states.
Start start_at(const double* states) {
  Start start(2);
  start << states[0], states[1];
  return start;
}

/// The residuals of a fit problem and their derivatives, as Ceres asks for them: explanation's coordinates,
/// then the start.
class SameResiduals : public ceres::CostFunction {
public:
  SameResiduals(const FitProblem& problem, const Explanation& explanation,
                const std::vector<Coordinate>& list, int count)
      : problem_(problem), explanation_(explanation), list_(list) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(list.size()));
    mutable_parameter_block_sizes()->push_back(2);
    set_num_residuals(count);
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index n = static_cast<Eigen::Index>(list_.size());
    const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(parameters[0], n);
    const std::vector<Start> starts{start_at(parameters[1])};
    problem_.evaluate(explanation_, list_, at, starts, jacobians != nullptr,
                      [&](std::size_t, const FitProblem::Residuals& r) {
                        Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = r.value;
                        using RowMajor =
                            Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
                        if (jacobians != nullptr && jacobians[0] != nullptr)
                          Eigen::Map<RowMajor>(jacobians[0], num_residuals(), n) = r.jacobian.leftCols(n);
                        if (jacobians != nullptr && jacobians[1] != nullptr)
                          Eigen::Map<RowMajor>(jacobians[1], num_residuals(), 2) = r.jacobian.rightCols(2);
                      });
    return true;
  }

private:
  const FitProblem& problem_;
  const Explanation& explanation_;
  const std::vector<Coordinate>& list_;
};
#endif

void compare_solvers() {
  const Model model = motor();
  const Inputs inputs = prepare(model, motor_recording(20000, 20000));
  FitProblem problem;
  problem.model = &model;
  problem.catalogue = &standard_catalogue();
  problem.sigma = {0.003, 0.11, 1.0, 1.0};
  Segment segment;
  segment.inputs = &inputs;
  segment.run = RunSpan{0, inputs.rows(), ""};
  segment.begin = 0;
  segment.end = inputs.rows();
  problem.segments = {segment};
  Explanation explanation;
  explanation.effects = {standard_catalogue().find("radiation")};
  const std::vector<Coordinate> list = coordinates(model, explanation, standard_catalogue());
  Eigen::VectorXd from(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) from[static_cast<Eigen::Index>(i)] = list[i].start;

  double begin = now_s();
  Fitter fitter(problem, explanation, list);
  const FitResult ours = fitter.minimise(from);
  const double ours_s = now_s() - begin;
  std::printf("\none fit, %td residuals, %zu coordinates and a start:\n",
              static_cast<std::ptrdiff_t>(ours.samples), list.size());
  std::printf("  ours   %.3f s, %d iterations, chi^2 %.3f, radiation %.4g m^2\n", ours_s, ours.iterations,
              ours.chi2, ours.point[ours.point.size() - 1]);
#ifdef THERMOPOWER_HAS_CERES
  begin = now_s();
  std::vector<double> at(from.data(), from.data() + from.size());
  double start[2] = {0.0, 0.0};
  ceres::Problem same;
  same.AddResidualBlock(new SameResiduals(problem, explanation, list, static_cast<int>(ours.samples)),
                        nullptr, at.data(), start);
  const Start weight = problem.start_weight(segment);
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(from.size(), from.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Eigen::Index k = static_cast<Eigen::Index>(i);
    prior(k, k) = std::sqrt(list[i].prior.weight(0.0));  // near the centre
    same.SetParameterLowerBound(at.data(), static_cast<int>(i), list[i].lower);
    same.SetParameterUpperBound(at.data(), static_cast<int>(i), list[i].upper);
  }
  same.AddResidualBlock(new ceres::NormalPrior(prior, Eigen::VectorXd::Zero(from.size())), nullptr,
                        at.data());
  Eigen::MatrixXd start_prior = weight.asDiagonal();
  same.AddResidualBlock(new ceres::NormalPrior(start_prior, Eigen::VectorXd::Zero(2)), nullptr, start);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.function_tolerance = 1e-5;
  options.max_num_iterations = 25;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &same, &summary);
  const double theirs_s = now_s() - begin;
  const std::vector<Start> starts{start_at(start)};
  double chi2 = 0.0;
  problem.evaluate(explanation, list, Eigen::Map<const Eigen::VectorXd>(at.data(), from.size()), starts,
                   false,
                   [&](std::size_t, const FitProblem::Residuals& r) { chi2 += r.value.squaredNorm(); });
  std::printf("  Ceres  %.3f s, %zu iterations, chi^2 %.3f, radiation %.4g m^2\n", theirs_s,
              summary.iterations.size(), chi2, at.back());
  std::printf("  Ceres takes %.2f times as long\n", theirs_s / ours_s);
#else
  std::printf("  Ceres  not found, not compared\n");
#endif
}

}  // namespace

int main(int count, char** values) {
  keep_memory();  // as the program does
  std::vector<Eigen::Index> lengths;
  for (int i = 1; i < count; ++i) lengths.push_back(std::atol(values[i]));
  if (lengths.empty()) lengths = {100000, 1000000};
  const std::string path = (std::filesystem::temp_directory_path() / "thermopower_gap_speed.csv").string();
  for (const Eigen::Index rows : lengths) {
    const auto both = [&](const char* what, const Model& model, const auto& recording) {
      apart([&] { write_csv(recording(), path); });
      for (const unsigned threads : {1u, 2u}) apart([&] { measure(what, model, path, rows, threads); });
    };
    both("motor", motor(), [&] { return motor_recording(rows, rows); });
    both("motor in runs", motor(), [&] { return motor_recording(rows, 3000); });
    both("axis", axis(), [&] { return axis_recording(rows, 0.0, rows); });
    both("axis, 2 causes", axis(), [&] { return axis_recording(rows, 0.03, rows); });
    both("2 causes, runs", axis(), [&] { return axis_recording(rows, 0.03, 1000); });
    both("motor, dirty", motor(), [&] {
      return soiled(motor_recording(rows, rows), {{"current_A", 0.1}, {"motor_C", 2.0}});
    });
    both("2 causes, dirty", axis(), [&] {
      return soiled(axis_recording(rows, 0.03, rows), {{"angle_deg", 20.0}, {"rate_dps", 20.0}});
    });
  }
  std::filesystem::remove(path);
  compare_solvers();
  return 0;
}
