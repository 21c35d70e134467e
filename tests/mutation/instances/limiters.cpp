// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// All of the limiters as object code, with nothing known of what they are called with: what mutation.py compares.
#include <thermopower/control/limiter_chain.hpp>
#include <thermopower/control/node_limiter.hpp>
#include <thermopower/control/safety_limiter.hpp>
#include <thermopower/control/sensor_limiter.hpp>

using namespace thermopower;

typedef LimiterChain<SensorLimiter, NodeLimiter, SafetyLimiter<>> Three;
typedef LimiterChain<SafetyLimiter<PerCycle>> One;

template class thermopower::SafetyLimiter<PerSecond>;
template class thermopower::SafetyLimiter<PerCycle>;
template struct thermopower::LimiterChainConfig<>;
template struct thermopower::LimiterChainConfig<NodeLimiter>;
template struct thermopower::LimiterChainConfig<SensorLimiter, NodeLimiter, SafetyLimiter<>>;
template class thermopower::LimiterChain<SensorLimiter, NodeLimiter, SafetyLimiter<>>;
template class thermopower::LimiterChain<SafetyLimiter<PerCycle>>;

struct Archive {
  template <class... Fields>
  void operator()(Fields&... fields) {
    take({static_cast<const void*>(&fields)...});
  }
  template <class Number>
  void take(const Number (&fields)[1]);
  void take(const void* const (&fields)[1]);
  void take(const void* const (&fields)[2]);
  void take(const void* const (&fields)[3]);
};
template <class Config>
void archived(Config& config, Archive& archive) {
  Config::each_field(config, archive);
}
template void archived(SafetyLimiterConfig&, Archive&);
template void archived(NodeLimit&, Archive&);
template void archived(NodeLimiter::Config&, Archive&);
template void archived(SensorLimiter::Config&, Archive&);
template void archived(One::Config&, Archive&);
template void archived(Three::Config&, Archive&);

void* at(Three& chain, uint8_t which) {
  if (which == 0) return &chain.limiter<0>();
  if (which == 1) return &chain.limiter<1>();
  return &chain.limiter<2>();
}
const void* at(const Three& chain, uint8_t which) {
  if (which == 0) return &chain.limiter<0>();
  if (which == 1) return &chain.limiter<1>();
  return &chain.limiter<2>();
}

// Constants that no function above needs, and what a limiter is before its first step.
extern const int reasons[] = {int(LimitReason::none),
                              int(LimitReason::safety_temperature),
                              int(LimitReason::over_temperature),
                              int(LimitReason::recovering),
                              int(LimitReason::winding_limit),
                              int(LimitReason::body_limit),
                              int(LimitReason::node_limit),
                              int(LimitReason::no_telemetry_yet),
                              int(LimitReason::link_silent),
                              int(LimitReason::error_not_finite),
                              int(LimitReason::air_implausible),
                              int(LimitReason::supply_low),
                              int(LimitReason::supply_not_finite),
                              int(LimitReason::temperature_not_finite),
                              int(LimitReason::time_invalid),
                              int(LimitReason::config_invalid),
                              int(LimitReason::not_obeyed),
                              int(LimitReason::supply_implausible),
                              int(LimitReason::sensor_missing),
                              int(LimitReason::sensor_out_of_range),
                              int(LimitReason::sensor_too_fast),
                              int(LimitReason::sensor_stuck),
                              int(LimitReason::sensor_disagrees),
                              int(LimitReason::sensors_exchanged),
                              int(LimitReason::time_stands_still),
                              NodeLimiter::bracket,
                              NodeLimiter::body,
                              NodeLimiter::magnets,
                              NodeLimiter::winding,
                              NodeLimiter::count,
                              NodeLimiter::none};
uint8_t decided(LimitReason reason) { return is_fault(reason) ? least_power() : 0; }
void fresh(SafetyLimiter<>& limiter) { limiter = SafetyLimiter<>(); }
void fresh(SafetyLimiter<PerCycle>& limiter) { limiter = SafetyLimiter<PerCycle>(); }
void fresh(NodeLimiter& limiter) { limiter = NodeLimiter(); }
void fresh(SensorLimiter& limiter) { limiter = SensorLimiter(); }
void fresh(Three& limiter) { limiter = Three(); }
