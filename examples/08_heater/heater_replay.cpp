// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  would the watch have cried wolf on the heaters that one has logs of, and what would it have seen of a fault?
// Model:    the log as it is; with a fault the log plus what the fault changes by the declared constants, behind a loop that answers
//           the change as a PI controller does.
// Notation: hours; times from the fault on, s; "-" where a check never fails.
// Usage:    heater_replay <log.csv>..., built with the constants of a header: -DHEATER_CONSTANTS='"constants.hpp"', which
//           declares `Calibrated`. Without, the example's own hotend.
#include "heater.hpp"
#include "recording.hpp"

#ifdef HEATER_CONSTANTS
#include HEATER_CONSTANTS
#else
typedef heater::Hotend Calibrated;
#endif

namespace {

namespace tp = thermopower;

enum class Fault {
  none,
  thermistor_loose,
  thermistor_stuck,
  heater_weak,
  heater_weak_on_start,  ///< From a heat-up on, as after a night.
  fan_lost,
  fan_lost_unlogged,  ///< A third of the loss is gone: a fan that no column shows, such as a hotend's own.
  room_warmer
};
const char* name(Fault fault) {
  static const char* const names[] = {
      "none",     "thermistor loose",   "thermistor stuck", "heater 20 % weaker", "same, from heat-up",
      "fan lost", "fan lost, unlogged", "room 15 K warmer"};
  return names[static_cast<int>(fault)];
}
uint8_t truth(Fault fault) {
  switch (fault) {
    case Fault::none:
      return 0;
    case Fault::thermistor_loose:
    case Fault::thermistor_stuck:
      return static_cast<uint8_t>(tp::Suspect::thermometer);
    case Fault::heater_weak:
    case Fault::heater_weak_on_start:
      return static_cast<uint8_t>(tp::Suspect::heater);
    case Fault::fan_lost:
      return static_cast<uint8_t>(tp::Suspect::fan);
    case Fault::fan_lost_unlogged:
      return static_cast<uint8_t>(tp::Suspect::loss);
    case Fault::room_warmer:
      return static_cast<uint8_t>(tp::Suspect::air);
  }
  return 0;
}

constexpr tp::HeatBalanceConfig body() { return Calibrated::heat_balance(); }
// A heater as slow as a bed has a bed's checks.
constexpr bool is_bed() { return body().capacity_J_per_K / body().full_W > 1.0; }
constexpr double longest_step_s = 8.0;
bool is_read(double celsius) {
  return celsius > 2.0 && celsius < static_cast<double>(Calibrated::highest_C());
}

/// Rows at which faults begin.
struct Begins {
  std::vector<std::size_t> holds;     ///< A minute into each hold.
  std::vector<std::size_t> heat_ups;  ///< Heating begins, to a hold 15 K and more above.
};

/// The target that the log has, or else the level of the hold that the heater is in or goes to: of a minute within 3 K.
std::vector<double> targets_of(const recorded::Recording& log, Begins& begins) {
  std::vector<std::size_t>& holds = begins.holds;
  const std::vector<recorded::Row>& rows = log.rows;
  std::vector<double> level(rows.size(), std::nan(""));
  for (std::size_t i = 0, j = 0; i < rows.size(); ++i) {
    double lowest_C = 1e9, highest_C = -1e9, duty = 0.0;
    for (j = i; j < rows.size() && rows[j].t_s < rows[i].t_s + 60.0 && is_read(rows[j].measured_C); ++j) {
      lowest_C = std::min(lowest_C, rows[j].measured_C);
      highest_C = std::max(highest_C, rows[j].measured_C);
      duty += rows[j].duty;
    }
    const bool is_hold = j < rows.size() && rows[j].t_s >= rows[i].t_s + 60.0 && highest_C - lowest_C < 3.0 &&
                         lowest_C > rows[i].air_C + 10.0 && duty > 0.0;
    if (!is_hold) continue;
    for (std::size_t k = i; k < j; ++k) level[k] = 0.5 * (lowest_C + highest_C);
    if (holds.empty() || rows[i].t_s > rows[holds.back()].t_s + 300.0)
      holds.push_back(j);  // a minute into it
  }
  // Off where the power stays off for ten seconds; on the way up what comes next.
  std::vector<double> target(rows.size(), 0.0);
  double next_C = std::nan(""), on_s = -1e9;
  for (std::size_t i = rows.size(); i-- > 0;) {
    if (rows[i].duty > 0.0) on_s = rows[i].t_s;
    if (on_s - rows[i].t_s > 10.0) next_C = std::nan("");
    if (level[i] == level[i]) next_C = level[i];
    target[i] = log.has_target ? rows[i].target_C : (next_C == next_C ? next_C : 0.0);
  }
  for (std::size_t i = 1; i < rows.size(); ++i)
    if ((i == 1 || target[i] != target[i - 1]) && is_read(rows[i].measured_C) &&
        target[i] > rows[i].measured_C + 15.0)
      begins.heat_ups.push_back(i);
  return target;
}

/// What each check said of a run, and when.
struct Outcome {
  double alarm_s = -1.0;  // the watch's, from the log's start on
  double watch_s = -1.0, usual_s[3] = {-1.0, -1.0, -1.0};
  uint8_t suspects = 0;
  long refused = 0;       // readings that the guard refused
  double judged_s = 0.0;  // while the monitor judged
  tp::LimitReason reason = tp::LimitReason::none;
};

/// What a fault changes of the heater, by the declared constants, and what the loop makes of it.
class Change {
public:
  explicit Change(Fault fault) : fault_(fault) {}
  /// @param duty  of the log  @return the duty now
  double step(const recorded::Row& before, double measured_C, double dt_s) {
    if (!has_begun_) stuck_C_ = loose_C_ = measured_C;
    has_begun_ = true;
    // The loop answers only where the logged one was at work.
    off_s_ = before.duty > 0.0 ? 0.0 : off_s_ + dt_s;
    const double gain = body().capacity_J_per_K / (body().full_W * 2.0 * (body().lag_s + dt_s));
    double duty = before.duty;
    if (off_s_ < 10.0) {
      const double wanted = before.duty - gain * read_K_ - sum_;
      duty = std::min(1.0, std::max(0.0, wanted));
      if (wanted == duty || (wanted - duty) * read_K_ > 0.0)
        sum_ += gain * read_K_ * dt_s / (8.0 * (body().lag_s + dt_s));
    }
    const bool is_weak = fault_ == Fault::heater_weak || fault_ == Fault::heater_weak_on_start;
    const double heat_W = body().full_W * ((is_weak ? 0.8 : 1.0) * duty - before.duty);
    late_W_ += dt_s / (body().lag_s + dt_s) * (heat_W - late_W_);
    const double lost = fault_ == Fault::fan_lost            ? body().fan_W_per_K * before.fan
                        : fault_ == Fault::fan_lost_unlogged ? body().loss_W_per_K / 3.0
                                                             : 0.0;
    const double loss = body().loss_W_per_K + body().fan_W_per_K * before.fan - lost;
    double gained_W = late_W_ - loss * body_K_ + lost * (measured_C - before.air_C);
    if (fault_ == Fault::room_warmer) gained_W += loss * 15.0;
    const double warmer_K =
        body().second_J_per_K > 0.0 ? dt_s / (body().second_s + dt_s) * (body_K_ - second_K_) : 0.0;
    second_K_ += warmer_K;
    body_K_ += (dt_s * gained_W - body().second_J_per_K * warmer_K) / body().capacity_J_per_K;
    const double real_C = measured_C + body_K_;
    loose_C_ += dt_s / (15.0 + dt_s) * (0.6 * real_C + 0.4 * before.air_C - loose_C_);
    read_K_ = reading_C(measured_C) - measured_C;
    return duty;
  }
  double reading_C(double measured_C) const {
    if (!has_begun_) return measured_C;
    const double read_C = fault_ == Fault::thermistor_stuck   ? stuck_C_
                          : fault_ == Fault::thermistor_loose ? loose_C_
                                                              : measured_C + body_K_;
    return std::round(read_C / body().resolution_K) * body().resolution_K;
  }

private:
  Fault fault_;
  double stuck_C_ = 0.0, loose_C_ = 0.0, late_W_ = 0.0, body_K_ = 0.0, second_K_ = 0.0, read_K_ = 0.0,
         sum_ = 0.0, off_s_ = 0.0;
  bool has_begun_ = false;
};

Outcome run(const recorded::Recording& log, const std::vector<double>& target, Fault fault, double fault_s) {
  heater::Watch<Calibrated> watch;
  heater::RunawayCheck runaway(is_bed() ? heater::RunawayCheck::Config::bed()
                                        : heater::RunawayCheck::Config::hotend());
  heater::KelvinSumCheck sum(is_bed() ? heater::KelvinSumCheck::Config::bed()
                                      : heater::KelvinSumCheck::Config::hotend());
  heater::RateCheck rate(is_bed() ? heater::RateCheck::Config::bed() : heater::RateCheck::Config::hotend());
  Change change(fault);
  Outcome outcome;
  bool has_started = false;
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    const recorded::Row &before = log.rows[i - 1], &row = log.rows[i];
    const double dt_s = row.t_s - before.t_s, after_s = row.t_s - fault_s;
    if (dt_s > longest_step_s) {  // the firmware was off: everything starts anew
      watch = heater::Watch<Calibrated>();
      has_started = false;
      continue;
    }
    double duty = before.duty, measured_C = row.measured_C;
    if (fault != Fault::none && after_s >= 0.0 && is_read(measured_C)) {
      duty = change.step(before, measured_C, dt_s);
      measured_C = change.reading_C(measured_C);
    }
    const float read_C = static_cast<float>(measured_C), goal_C = static_cast<float>(target[i]),
                step_s = static_cast<float>(dt_s);
    const tp::LimitReason found =
        watch.step(static_cast<float>(duty * body().full_W), read_C, static_cast<float>(row.air_C),
                   static_cast<uint8_t>(before.fan * 255.0 + 0.5), step_s);
    has_started =
        has_started || found == tp::LimitReason::none;  // before the first reading there is nothing to watch
    if (watch.guard().state().reason != tp::LimitReason::none) ++outcome.refused;
    if (watch.monitor().is_watching_heat()) outcome.judged_s += dt_s;
    const auto note = [&](double& time_s, bool is_alarm) {
      if (is_alarm && time_s < 0.0 && after_s >= 0.0) time_s = after_s;
    };
    if (has_started && found != tp::LimitReason::none && outcome.reason == tp::LimitReason::none) {
      outcome.reason = found;
      outcome.suspects = watch.suspects();  // a log cannot show how a heater cools that was cut
      outcome.alarm_s = row.t_s - log.rows.front().t_s;
    }
    note(outcome.watch_s, has_started && found != tp::LimitReason::none);
    if (!is_read(measured_C)) continue;
    note(outcome.usual_s[0], !runaway.step(goal_C, read_C, step_s));
    note(outcome.usual_s[1], !sum.step(goal_C, read_C, step_s));
    note(outcome.usual_s[2], !rate.step(goal_C, read_C, step_s));
  }
  return outcome;
}

/// `52 s (3 of 4)`: the median of those found.
void print_times(const std::vector<double>& times_s) {
  std::vector<double> found_s;
  for (const double time_s : times_s)
    if (time_s >= 0.0) found_s.push_back(time_s);
  char text[40];
  if (found_s.empty()) std::snprintf(text, sizeof text, "-");
  else
    std::snprintf(text, sizeof text, "%.0f s (%zu of %zu)", recorded::median(found_s), found_s.size(),
                  times_s.size());
  std::printf(" %-17s", text);
}

int replay(int count, char** files) {
  long alarms = 0, behind = 0;
  std::vector<recorded::Recording> logs;
  std::vector<std::vector<double>> targets;
  std::vector<Begins> begins;
  std::printf("%-40s %6s %6s %8s %6s %s\n", "log", "hours", "judged", "refused", "alarms", "usual checks");
  for (int i = 0; i < count; ++i) {
    logs.push_back(recorded::read(files[i]));
    begins.emplace_back();
    targets.push_back(targets_of(logs.back(), begins.back()));
    const Outcome healthy = run(logs.back(), targets.back(), Fault::none, -1e12);
    const bool is_alarm = healthy.alarm_s >= 0.0;
    alarms += is_alarm ? 1 : 0;
    std::printf("%-40s %6.2f %6.2f %8ld %6d", files[i], logs.back().hours(), healthy.judged_s / 3600.0,
                healthy.refused, is_alarm ? 1 : 0);
    static const char* const usual[] = {" runaway", " sum of kelvins", " rate"};
    for (int k = 0; k < 3; ++k)
      if (healthy.usual_s[k] >= 0.0) std::printf("%s", usual[k]);
    if (is_alarm)
      std::printf("  reason %d after %.0f s, suspects %d", static_cast<int>(healthy.reason), healthy.alarm_s,
                  healthy.suspects);
    std::printf("\n");
  }
  std::printf("\n%-20s %-17s %-17s %-17s %-17s named\n", "fault", "watch", "runaway", "sum of kelvins",
              "rate");
  for (int i = 1; i <= static_cast<int>(Fault::room_warmer); ++i) {
    const Fault fault = static_cast<Fault>(i);
    std::vector<double> watch_s, usual_s[3];
    long named = 0, found = 0;
    for (std::size_t log = 0; log < logs.size(); ++log)
      for (const std::size_t at :
           fault == Fault::heater_weak_on_start ? begins[log].heat_ups : begins[log].holds) {
        const recorded::Row& row = logs[log].rows[at];
        if (fault == Fault::fan_lost && !(row.fan > 0.0)) continue;
        const Outcome outcome = run(logs[log], targets[log], fault, row.t_s);
        watch_s.push_back(outcome.watch_s);
        for (int k = 0; k < 3; ++k) usual_s[k].push_back(outcome.usual_s[k]);
        if (outcome.watch_s < 0.0) continue;
        ++found;
        named += (outcome.suspects & truth(fault)) != 0 ? 1 : 0;
      }
    std::printf("%-20s", name(fault));
    if (watch_s.empty()) {
      std::printf(" nothing in the logs to put it in\n");
      continue;
    }
    print_times(watch_s);
    bool is_behind = false;
    for (const std::vector<double>& times_s : usual_s) {
      print_times(times_s);
      const long others =
          std::count_if(times_s.begin(), times_s.end(), [](double time_s) { return time_s >= 0.0; });
      is_behind = is_behind || others > found;
    }
    std::printf(" %ld of %ld%s\n", named, found, is_behind ? "  a usual check finds more" : "");
    behind += is_behind ? 1 : 0;
  }
  return alarms == 0 && behind == 0 ? 0 : 1;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count < 2) {
    std::fprintf(stderr, "usage: heater_replay <log.csv>...\n");
    return 2;
  }
  try {
    return replay(argument_count - 1, arguments + 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heater_replay: %s\n", error.what());
    return 3;
  }
}
