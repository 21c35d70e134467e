// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  logs of heaters for heater_calibrate and heater_replay where there is no printer at hand.
// Model:    printer_plant.hpp: three masses and a thermometer that lags, which the constants do not have; a hotend and a bed, each
//           printing twice. A row a second, with the duty of that moment, as hosts log it; the first readings are 0.
// Usage:    heater_record <folder>
#include "heater.hpp"
#include "printer_plant.hpp"

#include <fstream>
#include <string>

namespace {

/// Sheets of a print job: from a time on a target. The last one ends the log.
struct Stage {
  double from_s, target_C;
};

bool record(const std::string& file, printer::Plant plant, const heater::Pid::Config& gains,
            const Stage* stages, int count, double air_C, std::uint32_t seed) {
  std::ofstream log(file);
  log << "t_s,power_param,ambient_C,motor_C,fan,target_C\n";
  printer::Heater real(plant, air_C, seed);
  heater::Pid pid(gains);
  std::mt19937 random(seed);
  double duty = 0.0, fan = 0.0;
  int stage = 0;
  for (long tick = 0; stage < count; ++tick) {
    const double now_s = 0.1 * static_cast<double>(tick);
    if (stage + 1 < count && now_s >= stages[stage + 1].from_s) ++stage;
    if (stage + 1 == count && now_s >= stages[stage].from_s) break;
    const double target_C = stages[stage].target_C;
    if (tick % 600 == 0)
      fan = plant.fan_W_per_K < 0.5 && target_C > 0.0 ? static_cast<double>(random() % 5) / 4.0 : 0.0;
    const double volt = plant.supply_V * (1.0 - 0.02 * duty);  // the host does not know that it sags
    real.pass(duty, fan, air_C, volt, 0.1);
    if (tick % 10 == 0) {
      const double read_C = tick < 20 ? 0.0 : std::round(real.reading_C() * 10.0) / 10.0;
      log << now_s << ',' << 255.0 * duty << ',' << std::round(air_C * 10.0) / 10.0 << ',' << read_C << ','
          << fan << ',' << target_C << '\n';
    }
    duty = target_C > 0.0 ? static_cast<double>(pid.step(static_cast<float>(target_C),
                                                         static_cast<float>(real.reading_C()), 0.1f))
                          : 0.0;
  }
  return static_cast<bool>(log);
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fprintf(stderr, "usage: heater_record <folder>\n");
    return 2;
  }
  const std::string folder = std::string(arguments[1]) + "/";
  const Stage hot_train[] = {{0.0, 0.0},      {60.0, 200.0},   {900.0, 220.0}, {1500.0, 0.0},
                             {1900.0, 170.0}, {2400.0, 210.0}, {3000.0, 0.0},  {3600.0, 0.0}},
              hot_heldout[] = {{0.0, 0.0},      {30.0, 215.0}, {1200.0, 0.0},
                               {1500.0, 190.0}, {2700.0, 0.0}, {3300.0, 0.0}},
              bed_train[] = {{0.0, 0.0},     {60.0, 60.0},  {1500.0, 70.0}, {2700.0, 0.0},
                             {3600.0, 55.0}, {4800.0, 0.0}, {5400.0, 0.0}},
              bed_heldout[] = {{0.0, 0.0},     {30.0, 65.0},  {2400.0, 0.0},
                               {3000.0, 60.0}, {4500.0, 0.0}, {5000.0, 0.0}};
  const heater::Pid::Config hot = heater::Pid::Config::hotend(), bed = heater::Pid::Config::bed();
  const auto all = [&](const char* name, const printer::Plant& plant, const heater::Pid::Config& gains,
                       const Stage* train, int train_count, const Stage* heldout, int heldout_count) {
    return record(folder + name + "_train.csv", plant, gains, train, train_count, 21.4, 3) &&
           record(folder + name + "_heldout.csv", plant, gains, heldout, heldout_count, 23.1, 4);
  };
  const bool is_written = all("hotend", printer::hotend(), hot, hot_train, 8, hot_heldout, 6) &&
                          all("bed", printer::bed(), bed, bed_train, 7, bed_heldout, 6);
  if (!is_written) std::fprintf(stderr, "heater_record: %s: cannot be written\n", folder.c_str());
  return is_written ? 0 : 1;
}
