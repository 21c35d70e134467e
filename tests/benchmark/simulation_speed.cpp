// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  how fast are batches of simulated axes, against the usual ODE libraries at equal accuracy, against a
//           plain loop over one axis after another, and against what the machine could do?
// Model:    first the rig's axis as it is (board, mechanics, temperatures). Then, for the libraries, the same
//           mechanics under a continuous loop: nothing jumps, so that they may take the steps they like. Then a
//           hinge beside MuJoCo's (speed_hinge.cpp), and the ensemble of others' benchmarks (speed_lorenz.cpp).
// Notation: an axis-step is one cycle of the board of one axis (0.8 ms). What is compared takes turns, nine times;
//           each figure is a median.
#include "speed_timing.hpp"

#include <thermopower/simulation/axis_batch.hpp>
#include <thermopower/simulation/random.hpp>
#include <thermopower/simulation/thesis_gimbal.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
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

using speed::Counted;
using speed::in_turns;
using speed::median;
using speed::median_ratio;

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

// Axes of the rig, and how many steps they make in one run.
template <class Real>
struct RigRun {
  std::vector<AxisCase<Real>> cases;
  double duration_s;

  RigRun(std::size_t count, double duration) : cases(draw_cases<Real>(count)), duration_s(duration) {}
  double steps() const { return static_cast<double>(cases.size()) * duration_s / AxisClock().board_cycle_s; }
  template <int lane_count>
  void on_lanes(unsigned threads) const {
    const auto outcome = run_batch<Real, lane_count>(cases, duration_s, threads);
    if (!(outcome.front().error_rms_deg > Real(0))) std::printf("nothing moved\n");
  }
  void plainly() const {
    Real sum = Real(0);
    for (const auto& one : cases) sum += run_case(one, duration_s).error_rms_deg;
    if (!(sum > Real(0))) std::printf("nothing moved\n");
  }
};

// What one axis-step is: its temperatures share a slow step with a hundred others.
template <class Real>
speed::Operations axis_step_operations() {
  AxisCase<Counted<Real>> counted;
  thermopower::simulation::detail::for_each_number(counted, draw_cases<Real>(1).front(),
                                                   [](Counted<Real>& to, Real from) { to = from; });
  Counted<Real>::done = {};
  run_case(counted, 0.8);
  speed::Operations each = Counted<Real>::done;
  each.sums /= 1000.0, each.products /= 1000.0, each.sums_of_products /= 1000.0,
      each.divisions_and_roots /= 1000.0;
  return each;
}

template <class Real, int lane_count>
void rig_axis(const char* name) {
  const RigRun<Real> batch(static_cast<std::size_t>(lane_count) * 8, 4.0), one_by_one(12, 4.0);
  const auto needed_s =
      in_turns(9, {[] { speed::multiply_adds<Real>(); }, [&] { batch.template on_lanes<lane_count>(1); },
                   [&] { one_by_one.plainly(); }});
  const double both_s = best_wall_s(5, [&] { batch.template on_lanes<lane_count>(2); });
  const double per_step = batch.steps() / one_by_one.steps();
  const speed::Operations each = axis_step_operations<Real>();
  const double operations = each.total() * batch.steps(), peak = speed::multiply_adds_operations<Real>();
  std::printf("  %-8s %12.2f %12.2f %12.2f %15.1fx %14.1f %14.1f %8.0f %%\n", name,
              one_by_one.steps() / median(needed_s[2]) * 1e-6, batch.steps() / median(needed_s[1]) * 1e-6,
              batch.steps() / both_s * 1e-6, median_ratio(needed_s[2], needed_s[1]) * per_step,
              operations / median(needed_s[1]) * 1e-9, peak / median(needed_s[0]) * 1e-9,
              100.0 * median_ratio(needed_s[0], needed_s[1]) * operations / peak);
}

template <class Real>
void print_operations(const char* name) {
  const speed::Operations each = axis_step_operations<Real>();
  std::printf(
      "  In %s an axis-step is %.0f sums, %.0f products and %.1f divisions and roots; %.0f sums are of products. "
      "Multiply-add units alone could reach %.0f %%.\n",
      name, each.sums, each.products, each.divisions_and_roots, each.sums_of_products,
      100.0 * each.ceiling());
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
        available_Nm(one.config.drive.at(one.power, one.supply_V, one.start.winding_C, one.start.body_C)
                         .available_Nm) {}

  // What acts from outside at one time.
  struct Forcing {
    Number sway_sine, sway_cosine, wind_sine;
  };

  static constexpr Real turn = static_cast<Real>(6.283185307179586),
                        quarter = static_cast<Real>(1.5707963267948966);

  Forcing forcing(Real t_s) const {
    const Number sway = (happens.sway_Hz * t_s + happens.sway_turns) * turn;
    return {sine(sway), sine(Number(sway + quarter)),
            sine(Number((happens.wind_Hz * t_s + happens.wind_turns) * turn))};
  }

  State slope(const State& state, const Forcing& outside) const {
    const Real degrees = static_cast<Real>(deg_per_rad);
    const auto& pid = happens.config.pid;
    const Number sway_rad = happens.sway_deg * static_cast<Real>(1.0 / deg_per_rad),
                 omega = happens.sway_Hz * turn;
    const BaseMotion<Number> base = {sway_rad * outside.sway_sine, sway_rad * omega * outside.sway_cosine,
                                     omega * Real(0)};
    const Number error_deg = -state[0] * degrees;
    const Number share = pid.share_per_deg * happens.p_gain * error_deg + state[2] -
                         pid.share_per_deg_per_s * state[1] * degrees;
    const Number wind = happens.wind_Nm * outside.wind_sine;
    return {state[1],
            mechanics.acceleration(state[0], state[1], {Number(share * available_Nm), wind, base}, Real(0)),
            Number(pid.share_per_deg_s * error_deg)};
  }
  State slope(const State& state, Real t_s) const { return slope(state, forcing(t_s)); }
};

// Classical Runge-Kutta in fixed steps: ours on lanes, the plain loop on a number. Several axes are carried
// at once, stage by stage: one of them alone waits for each result before it can go on.
template <class Number, std::size_t count>
std::array<typename ContinuousAxis<Number>::State, count> integrate(
    const std::array<ContinuousAxis<Number>, count>& axes, double duration_s, double step_s) {
  using Axis = ContinuousAxis<Number>;
  using Real = typename Axis::Real;
  using State = typename Axis::State;
  using Forcing = typename Axis::Forcing;
  const long steps = std::lround(duration_s / step_s);
  const Real h = static_cast<Real>(step_s);
  const auto moved = [](const State& from, const State& rate, Real by) {
    return State{Number(from[0] + by * rate[0]), Number(from[1] + by * rate[1]),
                 Number(from[2] + by * rate[2])};
  };
  // Fixed steps know the next times: what acts from outside is turned on by half a step instead of computed
  // anew.
  struct Turning {
    Number sway_s, sway_c, wind_s, wind_c, wind_cosine;
  };
  std::array<State, count> y;
  std::array<Forcing, count> now;
  std::array<Turning, count> turning;
  for (std::size_t a = 0; a < count; ++a) {
    const auto& happens = axes[a].happens;
    const Number zero = happens.sway_deg * Real(0);
    y[a] = {zero, zero, zero};
    now[a] = axes[a].forcing(Real(0));
    const Number sway_half = happens.sway_Hz * (Axis::turn * h / 2);
    const Number wind_half = happens.wind_Hz * (Axis::turn * h / 2);
    turning[a] = {sine(sway_half), sine(Number(sway_half + Axis::quarter)), sine(wind_half),
                  sine(Number(wind_half + Axis::quarter)),
                  sine(Number(happens.wind_turns * Axis::turn + Axis::quarter))};
  }
  const auto turned = [](const Forcing& from, Turning& by) {
    const Forcing to = {from.sway_sine * by.sway_c + from.sway_cosine * by.sway_s,
                        from.sway_cosine * by.sway_c - from.sway_sine * by.sway_s,
                        from.wind_sine * by.wind_c + by.wind_cosine * by.wind_s};
    by.wind_cosine = by.wind_cosine * by.wind_c - from.wind_sine * by.wind_s;
    return to;
  };
  for (long i = 0; i < steps; ++i) {
    std::array<State, count> rate, sum;
    for (std::size_t a = 0; a < count; ++a) sum[a] = rate[a] = axes[a].slope(y[a], now[a]);
    for (std::size_t a = 0; a < count; ++a) {
      now[a] = turned(now[a], turning[a]);
      rate[a] = axes[a].slope(moved(y[a], rate[a], h / 2), now[a]);
      sum[a] = moved(sum[a], rate[a], Real(2));
    }
    for (std::size_t a = 0; a < count; ++a) {
      rate[a] = axes[a].slope(moved(y[a], rate[a], h / 2), now[a]);
      sum[a] = moved(sum[a], rate[a], Real(2));
    }
    for (std::size_t a = 0; a < count; ++a) {
      now[a] = turned(now[a], turning[a]);
      rate[a] = axes[a].slope(moved(y[a], rate[a], h), now[a]);
      y[a] = moved(y[a], moved(sum[a], rate[a], Real(1)), h / 6);
    }
  }
  return y;
}

using Finals = std::vector<double>;  // the angle of every axis at the end, rad

double worst(const Finals& one, const Finals& exact) {
  double largest = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) largest = std::fmax(largest, std::fabs(one[i] - exact[i]));
  return largest;
}

// Blocks of lanes, `together` of them at once.
template <class Real, int lane_count, std::size_t together>
Finals on_lanes(const std::vector<AxisCase<Real>>& cases, double duration_s, double step_s) {
  using Number = thermopower::Lanes<Real, lane_count>;
  const std::size_t width = static_cast<std::size_t>(lane_count);
  Finals finals(cases.size());
  const auto packed = [&](std::size_t from) {
    AxisCase<Number> block;
    for (std::size_t lane = 0; lane < width; ++lane)
      detail::for_each_number(
          block, cases[std::min(from + lane, cases.size() - 1)],
          [lane](Number& to, Real number) { to[static_cast<Eigen::Index>(lane)] = number; });
    return ContinuousAxis<Number>(block);
  };
  for (std::size_t block = 0; block < cases.size(); block += width * together) {
    static_assert(together == 4, "as many as are named here");
    const std::array<ContinuousAxis<Number>, together> axes = {
        packed(block), packed(block + width), packed(block + 2 * width), packed(block + 3 * width)};
    const auto came = integrate(axes, duration_s, step_s);
    for (std::size_t at = 0; at < width * together && block + at < cases.size(); ++at)
      finals[block + at] = static_cast<double>(came[at / width][0][static_cast<Eigen::Index>(at % width)]);
  }
  return finals;
}

Finals plainly(const std::vector<AxisCase<double>>& cases, double duration_s, double step_s) {
  Finals finals;
  for (const auto& one : cases)
    finals.push_back(integrate<double, 1>({ContinuousAxis<double>(one)}, duration_s, step_s)[0][0]);
  return finals;
}

#if defined(THERMOPOWER_HAS_ODEINT)
template <class Integrate>
Finals by_odeint(const std::vector<AxisCase<double>>& cases, Integrate integrate) {
  Finals finals;
  for (const auto& one : cases) {
    const ContinuousAxis<double> axis(one);
    std::array<double, 3> y = {0.0, 0.0, 0.0};
    integrate([&](const std::array<double, 3>& state, std::array<double, 3>& rate,
                  double t_s) { rate = axis.slope(state, t_s); },
              y);
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

// The coarsest setting of a ladder that is accurate enough for each kind of axis, and how many axis-seconds a
// second it then makes.
struct Contender {
  const char* name;
  std::vector<double> ladder;  // from coarse to fine
  std::size_t count;           // axes of each kind in the timed run
  std::function<Finals(std::size_t kind, std::size_t count, double setting)> run;
};

template <class Case>
std::vector<std::vector<Case>> by_kind(const std::vector<Case>& all) {
  std::vector<std::vector<Case>> kinds(3);
  for (std::size_t i = 0; i < all.size(); ++i) kinds[i % 3].push_back(all[i]);
  return kinds;
}

template <class Case>
std::vector<Case> first(const std::vector<Case>& all, std::size_t count) {
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

int main() {
  std::printf("The rig's axis: board, mechanics and temperatures (million axis-steps per second)\n");
  std::printf("  %-8s %12s %12s %12s %16s %14s %14s %10s\n", "", "plain loop", "1 thread", "2 threads",
              "1 thread/plain", "Gflop/s", "peak Gflop/s", "of it");
  rig_axis<float, 64>("float");
  rig_axis<double, 32>("double");
  std::printf("  The peak is what one core does in multiply-adds on registers alone, in the same turns.\n");
  print_operations<float>("float");
  print_operations<double>("double");
  std::printf("  A block's state lies in the first cache: memory is no limit.\n");

  const bool hinges_agree = speed::hinge();
  const bool lorenz_agrees = speed::lorenz();

  // Sorted by kind: roll needs steps a third as long as pitch, and a block of lanes goes at the pace of its
  // slowest. Every contender may choose its step or tolerance for each kind.
  const double duration_s = 10.0, wanted_rad = 0.1 * 6.283185307179586 / 16384.0;
  const std::size_t checked = 16, kinds = 3;
  const auto cases = by_kind(draw_cases<double>(1536));
  const auto cases_f = by_kind(draw_cases<float>(1536));
  std::vector<Finals> exact;
  for (const auto& kind : cases) exact.push_back(plainly(first(kind, checked), duration_s, 2e-5));
  const std::vector<double> steps = {0.04,  0.03125, 0.025,  0.02,  0.016, 0.0125, 0.01,   0.008,
                                     0.005, 0.004,   0.0025, 0.002, 0.001, 0.0005, 0.0002, 0.0001};
  const std::vector<double> tolerances = {1e-2, 5e-3, 3e-3, 2e-3, 1e-3, 7e-4, 5e-4, 3e-4, 1e-4,
                                          3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 1e-8, 1e-9, 1e-10};
  std::vector<Contender> contenders = {
    {"ours, double, 4 x 8 lanes", steps, 512,
     [&](std::size_t kind, std::size_t n, double h) {
       return on_lanes<double, 8, 4>(first(cases[kind], n), duration_s, h);
     }},
    {"ours, float, 4 x 16 lanes", steps, 512,
     [&](std::size_t kind, std::size_t n, double h) {
       return on_lanes<float, 16, 4>(first(cases_f[kind], n), duration_s, h);
     }},
    {"plain loop, double", steps, 32,
     [&](std::size_t kind, std::size_t n, double h) {
       return plainly(first(cases[kind], n), duration_s, h);
     }},
#if defined(THERMOPOWER_HAS_ODEINT)
    {"odeint runge_kutta4", steps, 32,
     [&](std::size_t kind, std::size_t n, double h) {
       return by_odeint(first(cases[kind], n), [&](auto slope, auto& y) {
         using Stepper = boost::numeric::odeint::runge_kutta4<std::array<double, 3>>;
         boost::numeric::odeint::integrate_n_steps(Stepper(), slope, y, 0.0, h,
                                                   static_cast<std::size_t>(std::lround(duration_s / h)));
       });
     }},
    {"odeint dopri5, controlled", tolerances, 32,
     [&](std::size_t kind, std::size_t n, double tolerance) {
       return by_odeint(first(cases[kind], n), [&](auto slope, auto& y) {
         using Stepper = boost::numeric::odeint::runge_kutta_dopri5<std::array<double, 3>>;
         boost::numeric::odeint::integrate_adaptive(
             boost::numeric::odeint::make_controlled(tolerance, tolerance, Stepper()), slope, y, 0.0,
             duration_s, 1e-3);
       });
     }},
#endif
#if defined(THERMOPOWER_HAS_CVODE)
    {"CVODE Adams", tolerances, 16,
     [&](std::size_t kind, std::size_t n, double tolerance) {
       return by_cvode(first(cases[kind], n), duration_s, tolerance, CV_ADAMS);
     }},
    {"CVODE BDF", tolerances, 16,
     [&](std::size_t kind, std::size_t n, double tolerance) {
       return by_cvode(first(cases[kind], n), duration_s, tolerance, CV_BDF);
     }},
#endif
  };
  std::printf(
      "\nThe same mechanics under a continuous loop, angles after %g s right to %.1e rad (a tenth of a "
      "telemetry count), 1 thread\n",
      duration_s, wanted_rad);
  std::printf("  %-28s %26s %12s %16s %16s\n", "integrator", "step or tolerance", "error/rad",
              "axis-seconds/s", "ours, double, is");
  // The coarsest settings that are accurate enough, and then all in turns.
  std::vector<std::string> settings;
  std::vector<double> errors;
  std::vector<std::function<void()>> works;
  std::vector<std::size_t> accurate;
  for (std::size_t at = 0; at < contenders.size(); ++at) {
    const Contender& one = contenders[at];
    double largest = 0.0;
    std::string used;
    std::array<double, 3> chosen = {};
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      double error = 1e300;
      for (const double each : one.ladder) {
        chosen[kind] = each;
        error = worst(one.run(kind, checked, each), exact[kind]);
        if (error < wanted_rad) break;
      }
      largest = std::fmax(largest, error < wanted_rad ? error : 1e300);
      char text[32];
      std::snprintf(text, sizeof text, "%s%g", kind == 0 ? "" : " ", chosen[kind]);
      used += text;
    }
    if (!(largest < wanted_rad)) {
      std::printf("  %-28s never that accurate\n", one.name);
      continue;
    }
    accurate.push_back(at);
    settings.push_back(used);
    errors.push_back(largest);
    works.push_back([&one, chosen] {
      for (std::size_t kind = 0; kind < kinds; ++kind) one.run(kind, one.count, chosen[kind]);
    });
  }
  const auto needed_s = in_turns(9, works);
  for (std::size_t i = 0; i < works.size(); ++i) {
    const Contender& one = contenders[accurate[i]];
    const double share = static_cast<double>(contenders[accurate[0]].count) / static_cast<double>(one.count);
    std::printf("  %-28s %26s %12.1e %16.0f %15.1fx\n", one.name, settings[i].c_str(), errors[i],
                static_cast<double>(kinds * one.count) * duration_s / median(needed_s[i]),
                median_ratio(needed_s[i], needed_s[0]) * share);
  }
  return hinges_agree && lorenz_agrees ? 0 : 1;
}
