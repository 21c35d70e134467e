// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <cmath>
#include <cstdio>
#include <map>

#include "replay.hpp"

namespace thesis {
namespace {

const char* name_of(Experiment::Kind kind) {
  switch (kind) {
    case Experiment::Kind::current:
      return "current / mA";
    case Experiment::Kind::heating:
      return "heating / K";
    case Experiment::Kind::cooling:
      return "cooling / K";
    case Experiment::Kind::protection:
      return "protected / K";
  }
  return "";
}

std::string number(double value) {
  if (std::isnan(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace

std::string report(const std::vector<Experiment>& experiments) {
  std::string text;
  for (const std::string motor : {"BGM2606-90T", "BGM5208-200-12"}) {
    text += motor + ": model less measurement\n";
    text += "                                           program            corrected\n";
    text += "  quantity       table  power  points     RMSE     max      RMSE     max\n";
    // Totals over every point of a kind, in the order in which the kinds come.
    std::map<Experiment::Kind, Experiment::Distance> program_total, corrected_total;
    for (const auto kind : {Experiment::Kind::current, Experiment::Kind::heating, Experiment::Kind::cooling,
                            Experiment::Kind::protection}) {
      for (const Experiment& experiment : experiments) {
        if (experiment.motor != motor || experiment.kind != kind) continue;
        const auto program = experiment.distance(&Point::program),
                   corrected = experiment.distance(&Point::corrected);
        const std::string power = experiment.power_param > 0 ? std::to_string(experiment.power_param) : "off";
        text += line("  %-13s  %5s  %5s  %6d  %7.2f  %+6.1f   %7.2f  %+6.1f\n", name_of(kind),
                     experiment.table.c_str(), power.c_str(), program.points, program.rmse, program.worst,
                     corrected.rmse, corrected.worst);
        for (auto [total, one] :
             {std::pair(&program_total[kind], &program), std::pair(&corrected_total[kind], &corrected)}) {
          total->points += one->points;
          total->rmse += one->rmse * one->rmse * one->points;
          if (std::abs(one->worst) > std::abs(total->worst)) total->worst = one->worst;
        }
      }
    }
    text += "  -----------------------------------------------------------------------\n";
    for (const auto& [kind, program] : program_total) {
      const auto& corrected = corrected_total[kind];
      if (program.points == 0) continue;
      text += line("  %-13s    all    all  %6d  %7.2f  %+6.1f   %7.2f  %+6.1f\n", name_of(kind),
                   program.points, std::sqrt(program.rmse / program.points), program.worst,
                   std::sqrt(corrected.rmse / corrected.points), corrected.worst);
    }
    text += "\n";
  }
  text +=
      "program: the thesis's program, with its rounded constants, its form of eq 4.18 and Euler steps of 30 "
      "ms\n"
      "corrected: the same laws with the constants that the tables give (the default of motors/)\n";
  return text;
}

std::string traces(const std::vector<Experiment>& experiments) {
  std::string text = "motor,table,power_param,quantity,t_min,T_motor_C,measured,program,corrected\n";
  for (const Experiment& experiment : experiments) {
    for (const Point& point : experiment.curve) {
      const bool is_current = experiment.is_current();
      text += experiment.motor + "," + experiment.table + "," + std::to_string(experiment.power_param) + "," +
              (is_current ? "I_mA" : "T_motor_C") + "," + (is_current ? "" : number(point.x)) + "," +
              (is_current ? number(point.x) : "") + "," + number(point.measured) + "," +
              number(point.program) + "," + number(point.corrected) + "\n";
    }
  }
  return text;
}

}  // namespace thesis
