// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "wiring_evidence.hpp"

#include <thermopower/robot/series.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thermopower::robot {
namespace {

constexpr double longest_step_s = 0.02;  // of the rows looked at: joints move slower than 10 Hz
constexpr Eigen::Index pieces = 8;       // of a long log
constexpr double rest_share = 0.15;      // of the usual rate: a turn that is smaller is noise

struct Picked {
  Eigen::Index begin, end, block;
};

// Means of several rows where the log is fast, and pieces of it where it is long.
std::vector<std::vector<Picked>> pick(const Log& log, Eigen::Index most_rows) {
  const double step = detail::median_step(log);
  const Eigen::Index wanted = (log.rows() + most_rows - 1) / std::max<Eigen::Index>(1, most_rows);
  const Eigen::Index slowest =
      step > 0.0 ? std::max<Eigen::Index>(1, static_cast<Eigen::Index>(longest_step_s / step + 1e-9)) : 1;
  const Eigen::Index block = std::clamp<Eigen::Index>(wanted, 1, slowest);
  std::vector<std::vector<Picked>> out;
  for (std::size_t run = 0; run < log.begin.size(); ++run) {
    const Eigen::Index begin = log.begin[run], end = log.end(run);
    const double share =
        static_cast<double>(most_rows) * static_cast<double>(block) / static_cast<double>(log.rows());
    const Eigen::Index count = share < 1.0 ? pieces : 1;
    for (Eigen::Index piece = 0; piece < count; ++piece) {
      const Eigen::Index from = begin + (end - begin) * piece / count;
      const auto length =
          static_cast<Eigen::Index>(std::min(1.0, share) * static_cast<double>((end - begin) / count));
      std::vector<Picked> rows;
      for (Eigen::Index at = from; at + block <= from + length; at += block)
        rows.push_back({at, at + block, block});
      if (!rows.empty()) out.push_back(rows);
    }
  }
  return out;
}

Eigen::MatrixXd means(const Eigen::MatrixXd& of, const std::vector<std::vector<Picked>>& picked,
                      Eigen::Index rows) {
  if (of.rows() == 0) return {};
  Eigen::MatrixXd out(rows, of.cols());
  Eigen::Index row = 0;
  for (const auto& piece : picked)
    for (const Picked& one : piece) {
      for (Eigen::Index column = 0; column < of.cols(); ++column) {
        double sum = 0.0, count = 0.0;
        for (Eigen::Index i = one.begin; i < one.end; ++i)
          if (std::isfinite(of(i, column))) sum += of(i, column), count += 1.0;
        out(row, column) = count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
      }
      ++row;
    }
  return out;
}

Log coarse(const Log& log, Eigen::Index most_rows) {
  const auto picked = pick(log, most_rows);
  Log out;
  Eigen::Index rows = 0;
  for (const auto& piece : picked) {
    out.begin.push_back(rows);
    rows += static_cast<Eigen::Index>(piece.size());
  }
  out.t_s = means(log.t_s, picked, rows);
  out.position = means(log.position, picked, rows);
  out.effort = means(log.effort, picked, rows);
  out.target = means(log.target, picked, rows);
  out.velocity = means(log.velocity, picked, rows);
  out.base_pose = means(log.base_pose, picked, rows);
  return out;
}

// How often a joint turns round.
double turns(const Eigen::VectorXd& slope, double rest) {
  double count = 0.0;
  int sign = 0;
  for (const double one : slope) {
    const int now = one > rest ? 1 : one < -rest ? -1 : 0;
    if (now == 0 || now == sign) continue;
    if (sign != 0) count += 1.0;
    sign = now;
  }
  return count;
}

}  // namespace

double spread(const Eigen::VectorXd& values) {
  if (values.size() == 0) return 0.0;
  return std::sqrt((values.array() - values.mean()).square().mean());
}

WiringRows wiring_rows(const Log& log, Eigen::Index most_rows) {
  Log few = coarse(log, most_rows);
  const Eigen::MatrixXd velocity = few.velocity;
  few.velocity.resize(0, 0);
  Series series = make_series(few);
  WiringRows out;
  out.step_s = series.step_s;
  if (series.rows() == 0) return out;
  for (const Stretch& one : series.stretches) out.begins.push_back(static_cast<std::size_t>(one.begin));
  out.position = series.motion.position;
  out.slope = series.motion.velocity;
  out.acceleration = series.motion.acceleration;
  if (log.target.rows() > 0) out.target = series.smooth_target;
  out.effort = series.effort;
  out.base.base_pose = series.motion.base_pose;
  out.base.base_velocity = series.motion.base_velocity;
  out.base.base_acceleration = series.motion.base_acceleration;
  if (velocity.rows() > 0) {
    few.effort = velocity;
    out.velocity = make_series(few).effort;
  }
  const Eigen::Index joints = log.position.cols();
  out.moves.assign(static_cast<std::size_t>(joints), 0);
  out.independent = Eigen::VectorXd::Zero(joints);
  for (Eigen::Index j = 0; j < joints; ++j) {
    if (!out.position.col(j).allFinite()) continue;
    const double rate = spread(out.slope.col(j));
    const double rest = std::max(rest_share * rate, 3.0 * series.rate_noise[j]);
    out.independent[j] = turns(out.slope.col(j), rest);
    out.moves[static_cast<std::size_t>(j)] = out.independent[j] >= 3.0 && rate > 2.0 * series.rate_noise[j];
  }
  return out;
}

WiringRows put_right(const WiringRows& rows, const Wiring& wiring) {
  WiringRows out = rows;
  const auto put = [](const Eigen::MatrixXd& from, Eigen::MatrixXd& to, const Wires& wires, bool has_zero) {
    if (from.rows() == 0) return;
    for (Eigen::Index j = 0; j < from.cols(); ++j) {
      const auto k = static_cast<std::size_t>(j);
      to.col(j) = from.col(wires.source[k]) / wires.factor[k];
      if (has_zero) to.col(j).array() -= wires.offset[k];
    }
  };
  put(rows.position, out.position, wiring.position, true);
  put(rows.slope, out.slope, wiring.position, false);
  put(rows.acceleration, out.acceleration, wiring.position, false);
  put(rows.velocity, out.velocity, wiring.velocity, true);
  put(rows.effort, out.effort, wiring.effort, true);
  put(rows.target, out.target, wiring.target, true);
  for (Eigen::Index j = 0; j < rows.position.cols(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    const int source = wiring.position.source[k];
    out.moves[k] = rows.moves[static_cast<std::size_t>(source)];
    out.independent[j] = rows.independent[source];
  }
  return out;
}

BoundedFit fit_bounded(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment, double square, int free) {
  BoundedFit out;
  out.value = Eigen::VectorXd::Zero(gram.cols());
  out.square = square;
  std::vector<Eigen::Index> open;
  for (Eigen::Index i = 0; i < gram.cols(); ++i)
    if (gram(i, i) > 0.0) open.push_back(i);
  while (!open.empty()) {
    Eigen::MatrixXd a = gram(open, open);
    const Eigen::VectorXd unit = a.diagonal().cwiseSqrt().cwiseInverse();
    a = (unit.asDiagonal() * a * unit.asDiagonal()).eval();
    a.diagonal().array() += 1e-6;
    const Eigen::VectorXd value = unit.asDiagonal() * a.ldlt().solve(unit.asDiagonal() * moment(open));
    Eigen::Index worst = -1;
    double least = 0.0;
    for (Eigen::Index i = 0; i < value.size(); ++i) {
      if (open[static_cast<std::size_t>(i)] < free) continue;
      const double weight = value[i] / unit[i];
      if (weight < least) least = weight, worst = i;
    }
    if (worst >= 0) {
      open.erase(open.begin() + worst);
      continue;
    }
    for (Eigen::Index i = 0; i < value.size(); ++i) out.value[open[static_cast<std::size_t>(i)]] = value[i];
    out.square = std::max(0.0, square + value.dot(gram(open, open) * value) - 2.0 * value.dot(moment(open)));
    break;
  }
  return out;
}

Misfit fit_columns(const Eigen::VectorXd& signal, const Eigen::MatrixXd& columns, int free) {
  const Eigen::RowVectorXd mean = columns.colwise().mean();
  const double signal_mean = signal.mean();
  const Eigen::MatrixXd about = columns.rowwise() - mean;
  const Eigen::VectorXd wanted = signal.array() - signal_mean;
  const double square = wanted.squaredNorm();
  const BoundedFit fit = fit_bounded(about.transpose() * about, about.transpose() * wanted, square, free);
  Misfit out;
  out.coefficient = fit.value;
  out.constant = signal_mean - mean.dot(fit.value);
  out.left = square > 0.0 ? std::sqrt(fit.square / square) : 1.0;
  return out;
}

}  // namespace thermopower::robot
