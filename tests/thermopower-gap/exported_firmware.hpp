// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Firmware around an exported motor model, C++11: reads rows of inputs, steps the model and prints what it
// computes. It knows the library's firmware types and the names of the header's functions, nothing else.
#pragma once

#include <math.h>
#include <stdio.h>

struct Row {
  double t_s, power, supply_V, ambient_C, airspeed_mps, neighbour_C, rate_dps, drive_A, motor_C;
};

template <class M>
struct Has {
  template <class T>
  static char lag(decltype(&T::thermometer_lag_s));
  template <class T>
  static long lag(...);
  template <class T>
  static char delay(decltype(&T::delay_s));
  template <class T>
  static long delay(...);
  template <class T>
  static char spring(decltype(&T::spring_rad_per_s));
  template <class T>
  static long spring(...);
  template <class T>
  static char lagged(decltype(&T::lagged_Nm_per_s));
  template <class T>
  static long lagged(...);
  template <class T>
  static char gap(decltype(&T::gap_rad));
  template <class T>
  static long gap(...);
  template <class T>
  static char bend(decltype(&T::bent_rad_per_s));
  template <class T>
  static long bend(...);
  template <class T>
  static char current(decltype(&T::true_current_A));
  template <class T>
  static long current(...);
  template <class T>
  static char motor(decltype(&T::true_motor_C));
  template <class T>
  static long motor(...);
  template <class T>
  static char angle(decltype(&T::true_angle_deg));
  template <class T>
  static long angle(...);
  template <class T>
  static char rate(decltype(&T::true_rate_dps));
  template <class T>
  static long rate(...);
};

template <bool>
struct If {};
template <class M>
double lag_of(If<true>) {
  return M::thermometer_lag_s();
}
template <class M>
double lag_of(If<false>) {
  return 0.0;
}
template <class M>
double delay_of(If<true>) {
  return M::delay_s();
}
template <class M>
double delay_of(If<false>) {
  return 0.0;
}
template <class M>
double far_of(If<true>) {
  return M::far_share();
}
template <class M>
double far_of(If<false>) {
  return 0.0;
}
template <class M>
double frequency_of(If<true>) {
  return M::spring_rad_per_s();
}
template <class M>
double frequency_of(If<false>) {
  return 0.0;
}
template <class M>
double damping_of(If<true>) {
  return M::spring_damping();
}
template <class M>
double damping_of(If<false>) {
  return 0.0;
}

// A reading is undone by the header's function, where it has one; time is the last argument where it is taken.
inline double undone(float (*f)(float), double x, double, double) { return f(static_cast<float>(x)); }
inline double undone(float (*f)(float, float), double x, double air_C, double) {
  return f(static_cast<float>(x), static_cast<float>(air_C));
}
template <class M>
double current_of(If<true>, double x) {
  return undone(&M::true_current_A, x, 0.0, 0.0);
}
template <class M>
double current_of(If<false>, double x) {
  return x;
}
template <class M>
double motor_of(If<true>, double x, double air_C) {
  return M::true_motor_C(static_cast<float>(x), static_cast<float>(air_C));
}
template <class M>
double motor_of(If<false>, double x, double) {
  return x;
}
inline double timed(float (*f)(float), double x, double) { return f(static_cast<float>(x)); }
inline double timed(float (*f)(float, float), double x, double t_s) {
  return f(static_cast<float>(x), static_cast<float>(t_s));
}
template <class M>
double angle_of(If<true>, double x, double t_s) {
  return timed(&M::true_angle_deg, x, t_s);
}
template <class M>
double angle_of(If<false>, double x, double) {
  return x;
}
template <class M>
double rate_of(If<true>, double x, double t_s) {
  return timed(&M::true_rate_dps, x, t_s);
}
template <class M>
double rate_of(If<false>, double x, double) {
  return x;
}

template <class Heating, class Cooling, class Step>
double winding_C(const thermopower::ThermalModel<Heating, Cooling, Step>& model) {
  return model.hottest_C();
}
inline double winding_C(const thermopower::TwoNodeThermalModel<float>& model) {
  return model.state().winding_C;
}

/// Current and temperature over rows from the first reading. Prints for each row the current, what the
/// simulation's reading of it says with the sensor's errors undone, and the same of the temperature.
template <class M>
void run_bench(const Row* rows, int count, const double* current_readings, const double* motor_readings) {
  const typename M::Current::Config law = M::current();
  const double start_C =
      motor_of<M>(If<sizeof(Has<M>::template motor<M>(0)) == 1>(), motor_readings[0], rows[0].ambient_C);
  typename M::Thermal thermal(M::thermal(), static_cast<float>(start_C));
  const double lag_s = lag_of<M>(If<sizeof(Has<M>::template lag<M>(0)) == 1>());
  double charge_Ah = 0.0, thermometer_C = start_C;
  for (int i = 0; i < count; ++i) {
    const Row& at = rows[i];
    const float duty = static_cast<float>(at.power / 255.0), supply = static_cast<float>(at.supply_V),
                rate = static_cast<float>(at.rate_dps * 0.017453292519943295);
    const double shown_C = lag_s > 0.0 ? thermometer_C : winding_C(thermal);
    {
      const float motor = static_cast<float>(winding_C(thermal));
      const float v = M::v_rms_V(duty, supply, motor, static_cast<float>(charge_Ah), rate);
      const double amperes = law.current_A(v, motor);
      printf("%.9g %.9g %.9g %.9g\n", amperes,
             current_of<M>(If<sizeof(Has<M>::template current<M>(0)) == 1>(), current_readings[i]), shown_C,
             motor_of<M>(If<sizeof(Has<M>::template motor<M>(0)) == 1>(), motor_readings[i], at.ambient_C));
    }
    if (i + 1 == count) break;
    const int steps = 40;
    const double h_s = (rows[i + 1].t_s - at.t_s) / steps;
    for (int k = 0; k < steps; ++k) {
      const double before_C = winding_C(thermal);
      const float motor = static_cast<float>(before_C);
      const float v = M::v_rms_V(duty, supply, motor, static_cast<float>(charge_Ah), rate);
      const float amperes = law.current_A(v, motor);
      const float bridge = M::bridge_V(duty, supply, amperes, motor, static_cast<float>(charge_Ah), rate);
      const float air = M::air_C(static_cast<float>(at.ambient_C));
      typename M::Thermal::Inputs inputs;
      inputs.power_W = M::heat_W(v, amperes, bridge, motor, static_cast<float>(at.neighbour_C), rate, air);
      inputs.v_rms_V = v;
      inputs.around.air_C = air;
      inputs.around.airspeed_mps = static_cast<float>(at.airspeed_mps);
      thermal.step(inputs, static_cast<float>(h_s));
      charge_Ah += amperes * sqrt(static_cast<double>(duty)) * h_s / 3600.0;
      if (lag_s > 0.0)
        thermometer_C += (0.5 * (before_C + winding_C(thermal)) - thermometer_C) * (1.0 - exp(-h_s / lag_s));
    }
  }
}

// The axis' functions take the effects' own states, where there are some, in the catalogue's order.
template <class M, bool lagged, bool bent>
struct Axis {  // none
  static double load(float a, float w, float d, const double*) { return M::load_Nm(a, w, d); }
  static double dry(float a, float w, float d, float C, const double*) {
    return M::dry_friction_Nm(a, w, d, C);
  }
  static void slopes(float, float, float, float, const double*, double* out) { out[0] = out[1] = 0.0; }
};
template <class M>
struct Axis<M, true, false> {
  static double load(float a, float w, float d, const double* z) {
    return M::load_Nm(a, w, d, static_cast<float>(z[0]));
  }
  static double dry(float a, float w, float d, float C, const double* z) {
    return M::dry_friction_Nm(a, w, d, C, static_cast<float>(z[0]));
  }
  static void slopes(float a, float w, float d, float C, const double* z, double* out) {
    out[0] = M::lagged_Nm_per_s(a, w, d, C, static_cast<float>(z[0]));
    out[1] = 0.0;
  }
};
template <class M>
struct Axis<M, false, true> {
  static double load(float a, float w, float d, const double* z) {
    return M::load_Nm(a, w, d, static_cast<float>(z[1]));
  }
  static double dry(float a, float w, float d, float C, const double* z) {
    return M::dry_friction_Nm(a, w, d, C, static_cast<float>(z[1]));
  }
  static void slopes(float a, float w, float d, float C, const double* z, double* out) {
    out[0] = 0.0;
    out[1] = M::bent_rad_per_s(a, w, d, C, static_cast<float>(z[1]));
  }
};
template <class M>
struct Axis<M, true, true> {
  static double load(float a, float w, float d, const double* z) {
    return M::load_Nm(a, w, d, static_cast<float>(z[1]), static_cast<float>(z[0]));
  }
  static double dry(float a, float w, float d, float C, const double* z) {
    return M::dry_friction_Nm(a, w, d, C, static_cast<float>(z[1]), static_cast<float>(z[0]));
  }
  static void slopes(float a, float w, float d, float C, const double* z, double* out) {
    out[0] = M::lagged_Nm_per_s(a, w, d, C, static_cast<float>(z[1]), static_cast<float>(z[0]));
    out[1] = M::bent_rad_per_s(a, w, d, C, static_cast<float>(z[1]), static_cast<float>(z[0]));
  }
};

template <class M>
double gap_of(If<true>) {
  return M::gap_rad();
}
template <class M>
double gap_of(If<false>) {
  return 0.0;
}

// What a spring and a damper transmit, with a gap or without: inside the gap nothing, and beyond it never a pull.
inline double transmitted(double twist, double rate, double gap, double spring, double damper) {
  if (!(gap > 0.0)) return spring * twist + damper * rate;
  const double side = twist < 0.0 ? -1.0 : 1.0, past = side * twist - 0.5 * gap;
  return past > 0.0 ? side * fmax(0.0, spring * past + damper * side * rate) : 0.0;
}

// A motor at a voltage has a torque that depends on its rate.
inline float drive_at(float (*torque_Nm)(float, float), float command, float motor_C, double) {
  return torque_Nm(command, motor_C);
}
inline float drive_at(float (*torque_Nm)(float, float, float), float command, float motor_C, double rate) {
  return torque_Nm(command, motor_C, static_cast<float>(rate));
}

/// Angle and rate over rows from the first readings, printed as run_bench() prints.
template <class M>
void run_axis(const Row* rows, int count, const double* angle_readings, const double* rate_readings) {
  const bool springy = sizeof(Has<M>::template spring<M>(0)) == 1;
  const double delay_s = delay_of<M>(If<sizeof(Has<M>::template delay<M>(0)) == 1>());
  const double far = far_of<M>(If<sizeof(Has<M>::template spring<M>(0)) == 1>());
  const double frequency = frequency_of<M>(If<sizeof(Has<M>::template spring<M>(0)) == 1>());
  const double damping = damping_of<M>(If<sizeof(Has<M>::template spring<M>(0)) == 1>());
  const double gap = gap_of<M>(If<sizeof(Has<M>::template gap<M>(0)) == 1>());
  const double inertia = M::inertia_kgm2(), near = inertia * (1.0 - far);
  const double spring = near * far * frequency * frequency, damper = 2.0 * near * far * frequency * damping;
  const double rad = 0.017453292519943295;
  double angle = rad * angle_of<M>(If<sizeof(Has<M>::template angle<M>(0)) == 1>(), angle_readings[0], 0.0);
  double rate = rad * rate_of<M>(If<sizeof(Has<M>::template rate<M>(0)) == 1>(), rate_readings[0], 0.0);
  double twist = 0.0, twist_rate = 0.0, own[2] = {0.0, 0.0};
  typedef Axis<M, sizeof(Has<M>::template lagged<M>(0)) == 1, sizeof(Has<M>::template bend<M>(0)) == 1> Joint;
  for (int i = 0; i < count; ++i) {
    printf("%.12g %.12g %.12g %.12g\n", angle / rad,
           angle_of<M>(If<sizeof(Has<M>::template angle<M>(0)) == 1>(), angle_readings[i], rows[i].t_s),
           rate / rad,
           rate_of<M>(If<sizeof(Has<M>::template rate<M>(0)) == 1>(), rate_readings[i], rows[i].t_s));
    if (i + 1 == count) break;
    const int steps = gap > 0.0 ? 2000 : 200;  // a blow inside a step costs as much as the step is long
    const double h = (rows[i + 1].t_s - rows[i].t_s) / steps;
    for (int k = 0; k < steps; ++k) {
      const double now_s = rows[i].t_s + h * (k + 0.5) - delay_s;
      int from = i;
      while (from >= 0 && rows[from].t_s > now_s) --from;
      const float motor = static_cast<float>(rows[i].motor_C);
      const float command = static_cast<float>(from >= 0 ? rows[from].drive_A : 0.0);
      const float drive = drive_at(&M::drive_Nm, command, motor, rate);
      const auto slope = [&](double a, double w, double s, double u, double& dw, double& du) {
        const float fa = static_cast<float>(a), fw = static_cast<float>(w);
        const float now = drive_at(&M::drive_Nm, command, motor, w);
        const double pull = springy ? transmitted(s, u, gap, spring, damper) : 0.0;
        const double torque = static_cast<double>(now) + Joint::load(fa, fw, now, own) -
                              static_cast<double>(M::viscous_Nms_per_rad()) * w -
                              Joint::dry(fa, fw, now, motor, own) + pull;
        dw = torque / near;
        du = springy ? -pull / (inertia * far) - dw : 0.0;
      };
      double z1[2], z2[2];
      const double at_start[2] = {own[0], own[1]};
      Joint::slopes(static_cast<float>(angle), static_cast<float>(rate), drive, motor, own, z1);
      for (int s = 0; s < 2; ++s)
        own[s] = at_start[s] + 0.5 * h * z1[s];  // held there for the torques of this step
      Joint::slopes(static_cast<float>(angle + 0.5 * h * rate), static_cast<float>(rate), drive, motor, own,
                    z2);
      double w1, u1, w2, u2, w3, u3, w4, u4;
      slope(angle, rate, twist, twist_rate, w1, u1);
      slope(angle + 0.5 * h * rate, rate + 0.5 * h * w1, twist + 0.5 * h * twist_rate,
            twist_rate + 0.5 * h * u1, w2, u2);
      slope(angle + 0.5 * h * (rate + 0.5 * h * w1), rate + 0.5 * h * w2,
            twist + 0.5 * h * (twist_rate + 0.5 * h * u1), twist_rate + 0.5 * h * u2, w3, u3);
      slope(angle + h * (rate + 0.5 * h * w2), rate + h * w3, twist + h * (twist_rate + 0.5 * h * u2),
            twist_rate + h * u3, w4, u4);
      angle += h * (rate + h * (w1 + w2 + w3) / 6.0);
      twist += h * (twist_rate + h * (u1 + u2 + u3) / 6.0);
      rate += h * (w1 + 2.0 * (w2 + w3) + w4) / 6.0;
      for (int s = 0; s < 2; ++s) own[s] = at_start[s] + h * z2[s];
      twist_rate += h * (u1 + 2.0 * (u2 + u3) + u4) / 6.0;
    }
  }
}
