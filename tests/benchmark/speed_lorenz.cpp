// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  the Lorenz ensemble, on which libraries for many small systems compare themselves.
// Source:   D. Nagy, L. Plavecz, F. Hegedus, Solving large number of non-stiff, low-dimensional ordinary
//           differential equation systems on GPUs and CPUs, arXiv:2011.01740; programs in
//           github.com/nnagyd/ode_solver_tests, Lorenz_RK4. Theirs is in double; both are measured here.
// Model:    dx = 10 (y - x), dy = rho x - y - x z, dz = x y - 8/3 z; 46080 systems, rho evenly from 0 to 21,
//           each from (10, 10, 10), 1000 classical Runge-Kutta steps of 0.01.
#include "speed_timing.hpp"

#include <thermopower/simulation/lanes.hpp>

#include <array>
#include <cstdio>

#if defined(THERMOPOWER_HAS_ODEINT)
#include <boost/numeric/odeint.hpp>
#endif

namespace speed {
namespace {

constexpr std::size_t system_count = 46080;
constexpr int step_count = 1000;
constexpr double step = 0.01, start = 10.0;

double rho_of(std::size_t system) {
  return 21.0 * static_cast<double>(system) / static_cast<double>(system_count - 1);
}

template <class Number>
struct Lorenz {
  using Real = typename thermopower::detail::Numeric<Number>::Real;
  using State = std::array<Number, 3>;
  Number rho;
  State operator()(const State& s) const {
    return {Number(Real(10) * (s[1] - s[0])), Number(rho * s[0] - s[1] - s[0] * s[2]),
            Number(s[0] * s[1] - static_cast<Real>(8.0 / 3.0) * s[2])};
  }
};

template <class Number>
std::array<Number, 3> run(const Lorenz<Number>& system, int steps) {
  using Math = thermopower::detail::Numeric<Number>;
  using Real = typename Math::Real;
  const Number from = Math::constant(static_cast<Real>(start));
  std::array<Number, 3> state = {from, from, from};
  for (int i = 0; i < steps; ++i) state = runge_kutta_step(state, static_cast<Real>(step), system);
  return state;
}

// Where x ends.
template <class Real>
using Finals = std::vector<Real>;

template <class Real, int lane_count>
void on_lanes(Finals<Real>& finals) {
  using Number = thermopower::Lanes<Real, lane_count>;
  static_assert(system_count % static_cast<std::size_t>(lane_count) == 0, "blocks are full");
  for (std::size_t block = 0; block < system_count; block += static_cast<std::size_t>(lane_count)) {
    Lorenz<Number> systems;
    for (int lane = 0; lane < lane_count; ++lane)
      systems.rho[lane] = static_cast<Real>(rho_of(block + static_cast<std::size_t>(lane)));
    const auto end = run(systems, step_count);
    for (int lane = 0; lane < lane_count; ++lane)
      finals[block + static_cast<std::size_t>(lane)] = end[0][lane];
  }
}

// The same one after another, for every `each`th system.
template <class Real>
void plainly(Finals<Real>& finals, std::size_t each) {
  for (std::size_t i = 0; i < system_count; i += each)
    finals[i] = run(Lorenz<Real>{static_cast<Real>(rho_of(i))}, step_count)[0];
}

#if defined(THERMOPOWER_HAS_ODEINT)
template <class Real>
void by_odeint(Finals<Real>& finals, std::size_t each) {
  using State = std::array<Real, 3>;
  using Stepper = boost::numeric::odeint::runge_kutta4<State, Real, State, Real>;
  for (std::size_t i = 0; i < system_count; i += each) {
    const Lorenz<Real> system{static_cast<Real>(rho_of(i))};
    State state = {static_cast<Real>(start), static_cast<Real>(start), static_cast<Real>(start)};
    boost::numeric::odeint::integrate_n_steps(
        Stepper(), [&](const State& at, State& rate, Real) { rate = system(at); }, state, Real(0),
        static_cast<Real>(step), static_cast<std::size_t>(step_count));
    finals[i] = state[0];
  }
}
#endif

// The same equations by another method, from nothing that is above: a power series in time, each step as far
// as it matters in double.
double by_taylor(double rho, double duration) {
  constexpr std::size_t order = 24;
  const double h = 0.005;
  std::array<double, order + 1> x = {start}, y = {start}, z = {start};
  for (long i = 0, steps = std::lround(duration / h); i < steps; ++i) {
    for (std::size_t n = 0; n < order; ++n) {
      double xz = 0.0, xy = 0.0;
      for (std::size_t k = 0; k <= n; ++k) xz += x[k] * z[n - k], xy += x[k] * y[n - k];
      const double per = 1.0 / static_cast<double>(n + 1);
      x[n + 1] = 10.0 * (y[n] - x[n]) * per;
      y[n + 1] = (rho * x[n] - y[n] - xz) * per;
      z[n + 1] = (xy - 8.0 / 3.0 * z[n]) * per;
    }
    double ends[3] = {0.0, 0.0, 0.0};
    for (std::size_t n = order + 1; n-- > 0;)
      ends[0] = ends[0] * h + x[n], ends[1] = ends[1] * h + y[n], ends[2] = ends[2] * h + z[n];
    x[0] = ends[0], y[0] = ends[1], z[0] = ends[2];
  }
  return x[0];
}

// Of x, whose magnitude at the end is up to 8.
constexpr double allowed = 1e-5, allowed_worst = 0.2;

struct Errors {
  double median, worst;
};

template <class Real>
Errors errors(const Finals<Real>& finals, const std::vector<double>& exact, std::size_t each) {
  std::vector<double> all;
  for (std::size_t i = 0; i < exact.size(); ++i)
    all.push_back(std::fabs(static_cast<double>(finals[i * each]) - exact[i]));
  return {median(all), *std::max_element(all.begin(), all.end())};
}

template <class Real>
Operations operations() {
  Counted<Real>::done = {};
  run(Lorenz<Counted<Real>>{Counted<Real>(Real(20))}, 1);
  return Counted<Real>::done;
}

}  // namespace

bool lorenz() {
  const std::size_t sparse = 64, checked = 96;
  std::printf(
      "\nThe Lorenz ensemble of arXiv:2011.01740: %zu systems, rho 0 to 21, %d Runge-Kutta steps of %g, 1 "
      "thread\n",
      system_count, step_count, step);
  std::vector<double> exact;
  for (std::size_t i = 0; i < system_count; i += checked)
    exact.push_back(by_taylor(rho_of(i), step_count * step));

  Finals<float> lanes_f(system_count), plain_f(system_count), peer_f(system_count);
  Finals<double> lanes_d(system_count), plain_d(system_count), peer_d(system_count);
  std::vector<std::function<void()>> works = {
    [] { multiply_adds<float>(); },
    [] { multiply_adds<double>(); },
    [&] { on_lanes<float, 64>(lanes_f); },
    [&] { on_lanes<double, 32>(lanes_d); },
    [&] { plainly<float>(plain_f, sparse); },
    [&] { plainly<double>(plain_d, sparse); },
#if defined(THERMOPOWER_HAS_ODEINT)
    [&] { by_odeint<float>(peer_f, sparse); },
    [&] { by_odeint<double>(peer_d, sparse); },
#endif
  };
  const auto needed_s = in_turns(9, works);

  // The method's own error; rounding matters only near rho = 21, where neighbours part.
  const Errors error_d = errors(lanes_d, exact, checked), error_f = errors(lanes_f, exact, checked);
  std::printf(
      "  x at the end is off that of a power series by %.1e in double and %.1e in float (median of %zu systems; "
      "worst %.1e and %.1e)\n",
      error_d.median, error_f.median, exact.size(), error_d.worst, error_f.worst);
  if (!(error_d.median < allowed && error_f.median < allowed && error_d.worst < allowed_worst &&
        error_f.worst < allowed_worst)) {
    std::printf("  That is too much, and no speed is quoted.\n");
    return false;
  }

  const double steps = static_cast<double>(system_count) * step_count;
  const double sparse_steps = steps / static_cast<double>(sparse);
  std::printf("  %-8s %18s %12s %12s %14s %16s\n", "", "lanes, steps/s", "plain loop", "odeint",
              "lanes/odeint", "of the peak");
  const auto row = [&](const char* name, std::size_t at, const Operations& counted, double peak_operations) {
    const double rate = steps / median(needed_s[at + 2]);
    const double share =
        median_ratio(needed_s[at], needed_s[at + 2]) * counted.total() * steps / peak_operations;
    std::printf("  %-8s %18.2e %12.2e", name, rate, sparse_steps / median(needed_s[at + 4]));
    if (needed_s.size() > 6)
      std::printf(" %12.2e %13.1fx", sparse_steps / median(needed_s[at + 6]),
                  median_ratio(needed_s[at + 6], needed_s[at + 2]) * static_cast<double>(sparse));
    else std::printf(" %12s %14s", "-", "-");
    std::printf(" %14.0f %%\n", 100.0 * share);
  };
  row("float", 0, operations<float>(), multiply_adds_operations<float>());
  row("double", 1, operations<double>(), multiply_adds_operations<double>());
  const Operations counted = operations<float>();
  std::printf(
      "  A step is %.0f sums and %.0f products; %.0f sums are of products: multiply-add units alone could reach %.0f "
      "%%.\n",
      counted.sums, counted.products, counted.sums_of_products, 100.0 * counted.ceiling());
  return true;
}

}  // namespace speed
