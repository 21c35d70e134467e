// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  how fast are batches of simulated axes, against the usual ODE libraries at equal accuracy, against a plain loop over one
//           axis after another, and against what the machine could do?
// Model:    first the rig's axis as it is (board, mechanics, temperatures). Then, for the libraries, the same mechanics under a
//           continuous loop: nothing jumps, so that they may take the steps they like.
// Notation: an axis-step is one cycle of the board of one axis (0.8 ms). Each figure is the best of several runs.
#include <thermopower/simulation/axis_batch.hpp>
#include <thermopower/simulation/random.hpp>
#include <thermopower/simulation/thesis_gimbal.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <thread>
#include <vector>

#if defined(THERMOPOWER_HAS_ODEINT)
#include <boost/numeric/odeint.hpp>
#endif
#if defined(THERMOPOWER_HAS_CVODE)
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#endif

namespace {

using namespace thermopower::simulation;

// What one thread needs, in processor time: a busy machine must not count. Best of several.
double best_s(int repeats, const std::function<void()>& work) {
  double best = 1e300;
  for (int i = 0; i < repeats; ++i) {
    const std::clock_t begin = std::clock();
    work();
    best = std::fmin(best, static_cast<double>(std::clock() - begin) / static_cast<double>(CLOCKS_PER_SEC));
  }
  return best;
}

// What several threads need, by the wall's clock: only an idle machine gives a fair figure.
double best_wall_s(int repeats, const std::function<void()>& work) {
  double best = 1e300;
  for (int i = 0; i < repeats; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    best = std::fmin(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return best;
}

template <class Real>
std::vector<AxisCase<Real>> draw_cases(std::size_t count) {
  Random random(3);
  const auto draw = [&](double from, double to) { return static_cast<Real>(random.between(from, to)); };
  std::vector<AxisCase<Real>> cases;
  for (std::size_t i = 0; i < count; ++i) {
    AxisCase<Real> one;
    one.config = i % 3 == 0 ? thesis_roll<Real>() : i % 3 == 1 ? thesis_pitch<Real>() : thesis_yaw<Real>();
    one.start = {Real(0), draw(20.0, 50.0), draw(20.0, 50.0)};
    one.power = draw(60.0, 200.0);
    one.p_gain = i % 3 == 1 ? draw(80.0, 120.0) : draw(8.0, 16.0);
    one.supply_V = Real(13);
    one.around = {Real(26), Real(0)};
    one.sway_deg = draw(1.0, 10.0), one.sway_Hz = draw(0.1, 0.5), one.sway_turns = draw(0.0, 1.0);
    one.wind_Nm = draw(0.0, 0.002), one.wind_Hz = draw(0.1, 2.0), one.wind_turns = draw(0.0, 1.0);
    cases.push_back(one);
  }
  return cases;
}

// A number that counts what is done with it.
struct Counted {
  using Scalar = double;
  double value = 0.0;
  static inline long simple = 0, dear = 0;   // additions and multiplications; divisions, roots and functions
  Counted() = default;
  Counted(double number) : value(number) {}   // NOLINT: numbers convert
  Counted& operator+=(Counted other) { return ++simple, value += other.value, *this; }
};
Counted operator+(Counted a, Counted b) { return ++Counted::simple, Counted(a.value + b.value); }
Counted operator-(Counted a, Counted b) { return ++Counted::simple, Counted(a.value - b.value); }
Counted operator-(Counted a) { return ++Counted::simple, Counted(-a.value); }
Counted operator*(Counted a, Counted b) { return ++Counted::simple, Counted(a.value * b.value); }
Counted operator/(Counted a, Counted b) { return ++Counted::dear, Counted(a.value / b.value); }
bool operator>(Counted a, Counted b) { return ++Counted::simple, a.value > b.value; }
Counted sqrt(Counted a) { return ++Counted::dear, Counted(std::sqrt(a.value)); }
Counted exp(Counted a) { return ++Counted::dear, Counted(std::exp(a.value)); }
Counted log(Counted a) { return ++Counted::dear, Counted(std::log(a.value)); }

// Multiply-adds per second that one core really does, on registers only.
template <class Real, int width>
double peak_flops() {
  typedef Real Vector __attribute__((vector_size(width * sizeof(Real))));
  const long rounds = 20000000;
  volatile Real keep = Real(0);
  const double seconds = best_s(3, [&keep] {
    // Twelve independent chains cover the latency of two units.
    const Vector factor = Vector{} + static_cast<Real>(0.999);
    Vector a = factor, b = a + a, c = b + a, d = c + a, e = d + a, f = e + a, g = f + a, h = g + a, i = h + a, j = i + a, k = j + a, l = k + a;
    for (long round = 0; round < rounds; ++round) {
      a = a * factor + factor, b = b * factor + factor, c = c * factor + factor, d = d * factor + factor;
      e = e * factor + factor, f = f * factor + factor, g = g * factor + factor, h = h * factor + factor;
      i = i * factor + factor, j = j * factor + factor, k = k * factor + factor, l = l * factor + factor;
    }
    keep = (a + b + c + d + e + f + g + h + i + j + k + l)[0];
  });
  return 2.0 * 12 * width * static_cast<double>(rounds) / seconds;
}

template <class Real, int lane_count>
double batch_rate(std::size_t count, double duration_s, unsigned threads) {
  const auto cases = draw_cases<Real>(count);
  const double steps = static_cast<double>(count) * duration_s / AxisClock().board_cycle_s;
  const auto work = [&] {
    const auto outcome = run_batch<Real, lane_count>(cases, duration_s, threads);
    if (!(outcome.front().error_rms_deg > Real(0))) std::printf("nothing moved\n");
  };
  return steps / (threads == 1 ? best_s(5, work) : best_wall_s(5, work));
}

template <class Real>
double plain_rate(std::size_t count, double duration_s) {
  const auto cases = draw_cases<Real>(count);
  const double steps = static_cast<double>(count) * duration_s / AxisClock().board_cycle_s;
  Real sum = Real(0);
  const double seconds = best_s(3, [&] {
    for (const auto& one : cases) sum += run_case(one, duration_s).error_rms_deg;
  });
  if (!(sum > Real(0))) std::printf("nothing moved\n");
  return steps / seconds;
}

// The mechanics under a continuous loop: angle, rate, and the integral of the error.
template <class Number>
struct ContinuousAxis {
  using Real = typename thermopower::detail::Numeric<Number>::Real;
  using State = std::array<Number, 3>;
  GimbalAxis<Number> mechanics;
  AxisCase<Number> happens;
  Number available_Nm;

  explicit ContinuousAxis(const AxisCase<Number>& one)
      : mechanics(one.config.mechanics, {one.start.angle_deg, one.start.angle_deg}),
        happens(one),
        available_Nm(one.config.drive.at(one.power, one.supply_V, one.start.winding_C, one.start.body_C).available_Nm) {}

  // What acts from outside at one time.
  struct Forcing {
    Number sway_sine, sway_cosine, wind_sine;
  };

  static constexpr Real turn = static_cast<Real>(6.283185307179586), quarter = static_cast<Real>(1.5707963267948966);

  Forcing forcing(Real t_s) const {
    const Number sway = (happens.sway_Hz * t_s + happens.sway_turns) * turn;
    return {sine(sway), sine(Number(sway + quarter)), sine(Number((happens.wind_Hz * t_s + happens.wind_turns) * turn))};
  }

  State slope(const State& state, const Forcing& outside) const {
    const Real degrees = static_cast<Real>(deg_per_rad);
    const auto& pid = happens.config.pid;
    const Number sway_rad = happens.sway_deg * static_cast<Real>(1.0 / deg_per_rad), omega = happens.sway_Hz * turn;
    const BaseMotion<Number> base = {sway_rad * outside.sway_sine, sway_rad * omega * outside.sway_cosine, omega * Real(0)};
    const Number error_deg = -state[0] * degrees;
    const Number share =
        pid.share_per_deg * happens.p_gain * error_deg + state[2] - pid.share_per_deg_per_s * state[1] * degrees;
    const Number wind = happens.wind_Nm * outside.wind_sine;
    return {state[1], mechanics.acceleration(state[0], state[1], {Number(share * available_Nm), wind, base}, Real(0)),
            Number(pid.share_per_deg_s * error_deg)};
  }
  State slope(const State& state, Real t_s) const { return slope(state, forcing(t_s)); }

  // Classical Runge-Kutta in fixed steps: ours on lanes, the plain loop on a number.
  State integrate(double duration_s, double step_s) const {
    const long steps = std::lround(duration_s / step_s);
    const Real h = static_cast<Real>(step_s);
    const Number zero = happens.sway_deg * Real(0);
    State y = {zero, zero, zero};
    const auto moved = [](const State& from, const State& rate, Real by) {
      return State{Number(from[0] + by * rate[0]), Number(from[1] + by * rate[1]), Number(from[2] + by * rate[2])};
    };
    // Fixed steps know the next times: what acts from outside is turned on by half a step instead of computed anew.
    const Number sway_half = happens.sway_Hz * (turn * h / 2), wind_half = happens.wind_Hz * (turn * h / 2);
    const Number sway_s = sine(sway_half), sway_c = sine(Number(sway_half + quarter));
    const Number wind_s = sine(wind_half), wind_c = sine(Number(wind_half + quarter));
    Forcing now = forcing(Real(0));
    Number wind_cosine = sine(Number(happens.wind_turns * turn + quarter));
    const auto turned = [&](const Forcing& from) {
      const Forcing to = {from.sway_sine * sway_c + from.sway_cosine * sway_s, from.sway_cosine * sway_c - from.sway_sine * sway_s,
                          from.wind_sine * wind_c + wind_cosine * wind_s};
      wind_cosine = wind_cosine * wind_c - from.wind_sine * wind_s;
      return to;
    };
    for (long i = 0; i < steps; ++i) {
      const Forcing middle = turned(now), next = turned(middle);
      const State k1 = slope(y, now), k2 = slope(moved(y, k1, h / 2), middle);
      const State k3 = slope(moved(y, k2, h / 2), middle), k4 = slope(moved(y, k3, h), next);
      now = next;
      for (std::size_t j = 0; j < 3; ++j) y[j] = y[j] + (h / 6) * (k1[j] + Real(2) * (k2[j] + k3[j]) + k4[j]);
    }
    return y;
  }
};

using Finals = std::vector<double>;   // the angle of every axis at the end, rad

double worst(const Finals& one, const Finals& exact) {
  double largest = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) largest = std::fmax(largest, std::fabs(one[i] - exact[i]));
  return largest;
}

template <class Real, int lane_count>
Finals on_lanes(const std::vector<AxisCase<Real>>& cases, double duration_s, double step_s) {
  using Number = thermopower::Lanes<Real, lane_count>;
  Finals finals(cases.size());
  for (std::size_t block = 0; block < cases.size(); block += static_cast<std::size_t>(lane_count)) {
    AxisCase<Number> packed;
    for (int lane = 0; lane < lane_count; ++lane)
      detail::for_each_number(packed, cases[std::min(block + static_cast<std::size_t>(lane), cases.size() - 1)],
                              [lane](Number& to, Real from) { to[lane] = from; });
    const auto came = ContinuousAxis<Number>(packed).integrate(duration_s, step_s);
    for (int lane = 0; lane < lane_count && block + static_cast<std::size_t>(lane) < cases.size(); ++lane)
      finals[block + static_cast<std::size_t>(lane)] = static_cast<double>(came[0][lane]);
  }
  return finals;
}

Finals plainly(const std::vector<AxisCase<double>>& cases, double duration_s, double step_s) {
  Finals finals;
  for (const auto& one : cases) finals.push_back(ContinuousAxis<double>(one).integrate(duration_s, step_s)[0]);
  return finals;
}

#if defined(THERMOPOWER_HAS_ODEINT)
template <class Integrate>
Finals by_odeint(const std::vector<AxisCase<double>>& cases, Integrate integrate) {
  Finals finals;
  for (const auto& one : cases) {
    const ContinuousAxis<double> axis(one);
    std::array<double, 3> y = {0.0, 0.0, 0.0};
    integrate([&](const std::array<double, 3>& state, std::array<double, 3>& rate, double t_s) { rate = axis.slope(state, t_s); }, y);
    finals.push_back(y[0]);
  }
  return finals;
}
#endif

#if defined(THERMOPOWER_HAS_CVODE)
int cvode_slope(realtype t_s, N_Vector state, N_Vector rate, void* axis) {
  const realtype* y = NV_DATA_S(state);
  const auto slope = static_cast<const ContinuousAxis<double>*>(axis)->slope({y[0], y[1], y[2]}, t_s);
  for (std::size_t i = 0; i < 3; ++i) NV_DATA_S(rate)[i] = slope[i];
  return 0;
}

Finals by_cvode(const std::vector<AxisCase<double>>& cases, double duration_s, double tolerance, int method) {
  Finals finals;
  SUNContext context;
  SUNContext_Create(nullptr, &context);
  for (const auto& one : cases) {
    ContinuousAxis<double> axis(one);
    N_Vector y = N_VNew_Serial(3, context);
    N_VConst(0.0, y);
    void* solver = CVodeCreate(method, context);
    CVodeInit(solver, cvode_slope, 0.0, y);
    CVodeSStolerances(solver, tolerance, tolerance);
    CVodeSetUserData(solver, &axis);
    CVodeSetMaxNumSteps(solver, 100000000);
    SUNMatrix matrix = nullptr;
    SUNLinearSolver linear = nullptr;
    SUNNonlinearSolver nonlinear = nullptr;
    if (method == CV_BDF) {
      matrix = SUNDenseMatrix(3, 3, context);
      linear = SUNLinSol_Dense(y, matrix, context);
      CVodeSetLinearSolver(solver, linear, matrix);
    } else {
      nonlinear = SUNNonlinSol_FixedPoint(y, 0, context);
      CVodeSetNonlinearSolver(solver, nonlinear);
    }
    realtype reached = 0.0;
    CVodeSetStopTime(solver, duration_s);
    CVode(solver, duration_s, y, &reached, CV_NORMAL);
    finals.push_back(NV_DATA_S(y)[0]);
    CVodeFree(&solver);
    if (linear != nullptr) SUNLinSolFree(linear);
    if (nonlinear != nullptr) SUNNonlinSolFree(nonlinear);
    if (matrix != nullptr) SUNMatDestroy(matrix);
    N_VDestroy(y);
  }
  SUNContext_Free(&context);
  return finals;
}
#endif

// The coarsest setting of a ladder that is accurate enough, and how many axis-seconds a second it then makes.
struct Contender {
  const char* name;
  std::vector<double> ladder;   // from coarse to fine
  std::size_t count;            // axes in the timed run
  std::function<Finals(std::size_t count, double setting)> run;
};

}  // namespace

int main() {
  const unsigned both = 2;
  std::printf("The rig's axis: board, mechanics and temperatures (million axis-steps per second)\n");
  const double lanes_f1 = batch_rate<float, 16>(512, 2.0, 1), lanes_f2 = batch_rate<float, 16>(1024, 4.0, both);
  const double lanes_d1 = batch_rate<double, 8>(256, 2.0, 1), lanes_d2 = batch_rate<double, 8>(512, 4.0, both);
  const double plain_f = plain_rate<float>(48, 4.0), plain_d = plain_rate<double>(48, 4.0);
  std::printf("  %-8s %12s %12s %12s %16s\n", "", "plain loop", "1 thread", "2 threads", "1 thread/plain");
  std::printf("  %-8s %12.2f %12.2f %12.2f %15.1fx\n", "float", plain_f * 1e-6, lanes_f1 * 1e-6, lanes_f2 * 1e-6, lanes_f1 / plain_f);
  std::printf("  %-8s %12.2f %12.2f %12.2f %15.1fx\n", "double", plain_d * 1e-6, lanes_d1 * 1e-6, lanes_d2 * 1e-6, lanes_d1 / plain_d);

  AxisCase<Counted> counted;
  detail::for_each_number(counted, draw_cases<double>(1).front(), [](Counted& to, double from) { to = from; });
  Counted::simple = Counted::dear = 0;
  run_case(counted, 0.8);
  const double simple = static_cast<double>(Counted::simple) / 1000.0, dear = static_cast<double>(Counted::dear) / 1000.0;
  const double peak_d = peak_flops<double, 8>(), peak_f = peak_flops<float, 16>();
  std::printf("  One axis-step is %.0f additions and multiplications and %.1f divisions and roots.\n", simple, dear);
  std::printf("  That is %.1f Gflop/s of the %.1f that one core does in multiply-adds alone: %.0f %% (float: %.1f of %.1f, %.0f %%).\n",
              lanes_d1 * (simple + dear) * 1e-9, peak_d * 1e-9, 100.0 * lanes_d1 * (simple + dear) / peak_d,
              lanes_f1 * (simple + dear) * 1e-9, peak_f * 1e-9, 100.0 * lanes_f1 * (simple + dear) / peak_f);
  std::printf("  A block's state lies in the first cache: memory is no limit.\n");

  const double duration_s = 10.0, wanted_rad = 0.1 * 6.283185307179586 / 16384.0;
  const auto cases = draw_cases<double>(512);
  const auto cases_f = draw_cases<float>(512);
  const auto first = [](const auto& all, std::size_t count) {
    return std::vector<typename std::decay_t<decltype(all)>::value_type>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  };
  const std::size_t checked = 48;
  const Finals exact = plainly(first(cases, checked), duration_s, 2e-5);
  const std::vector<double> steps = {0.0125, 0.01, 0.008, 0.005, 0.004, 0.0025, 0.002, 0.00125, 0.001, 0.0008, 0.0005, 0.0004, 0.0002, 0.0001};
  const std::vector<double> tolerances = {1e-3, 7e-4, 5e-4, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 1e-8, 1e-9, 1e-10};
  std::vector<Contender> contenders = {
      {"ours, double, 8 lanes", steps, 512, [&](std::size_t n, double h) { return on_lanes<double, 8>(first(cases, n), duration_s, h); }},
      {"ours, float, 16 lanes", steps, 512, [&](std::size_t n, double h) { return on_lanes<float, 16>(first(cases_f, n), duration_s, h); }},
      {"plain loop, double", steps, 48, [&](std::size_t n, double h) { return plainly(first(cases, n), duration_s, h); }},
#if defined(THERMOPOWER_HAS_ODEINT)
      {"odeint runge_kutta4", steps, 48,
       [&](std::size_t n, double h) {
         return by_odeint(first(cases, n), [&](auto slope, auto& y) {
           boost::numeric::odeint::integrate_n_steps(boost::numeric::odeint::runge_kutta4<std::array<double, 3>>(), slope, y, 0.0, h,
                                                     static_cast<std::size_t>(std::lround(duration_s / h)));
         });
       }},
      {"odeint dopri5, controlled", tolerances, 48,
       [&](std::size_t n, double tolerance) {
         return by_odeint(first(cases, n), [&](auto slope, auto& y) {
           using Stepper = boost::numeric::odeint::runge_kutta_dopri5<std::array<double, 3>>;
           boost::numeric::odeint::integrate_adaptive(boost::numeric::odeint::make_controlled(tolerance, tolerance, Stepper()), slope, y,
                                                      0.0, duration_s, 1e-3);
         });
       }},
#endif
#if defined(THERMOPOWER_HAS_CVODE)
      {"CVODE Adams", tolerances, 48, [&](std::size_t n, double tolerance) { return by_cvode(first(cases, n), duration_s, tolerance, CV_ADAMS); }},
      {"CVODE BDF", tolerances, 48, [&](std::size_t n, double tolerance) { return by_cvode(first(cases, n), duration_s, tolerance, CV_BDF); }},
#endif
  };
  std::printf("\nThe same mechanics under a continuous loop, angles after %g s right to %.1e rad (a tenth of a telemetry count), 1 thread\n",
              duration_s, wanted_rad);
  std::printf("  %-28s %12s %12s %18s %12s\n", "integrator", "step or tol", "error/rad", "axis-seconds/s", "ours is");
  double ours = 0.0;
  for (const Contender& one : contenders) {
    double setting = 0.0, error = 1e300;
    for (const double each : one.ladder) {
      setting = each;
      error = worst(one.run(checked, each), exact);
      if (error < wanted_rad) break;
    }
    if (!(error < wanted_rad)) {
      std::printf("  %-28s never that accurate\n", one.name);
      continue;
    }
    const double rate = static_cast<double>(one.count) * duration_s / best_s(3, [&] { one.run(one.count, setting); });
    if (ours <= 0.0) ours = rate;
    std::printf("  %-28s %12.2g %12.1e %18.0f %11.1fx\n", one.name, setting, error, rate, ours / rate);
  }
}
