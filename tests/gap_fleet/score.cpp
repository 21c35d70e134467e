// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Holds what `thermopower-gap fleet` said against the sealed labels of a simulated fleet.

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace {

using Json = nlohmann::json;

Json read(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    std::cerr << "gap_fleet_score: cannot read " << path << "\n";
    std::exit(2);
  }
  return Json::parse(file);
}

constexpr const char* usage = "usage: gap_fleet_score --labels FILE --fleet FILE [--require WHAT=LEAST]...\n";

}  // namespace

int main(int argc, char** argv) {
  std::string labels_path, fleet_path;
  std::map<std::string, double> required;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const bool more = i + 1 < argc;
    if (option == "--labels" && more) labels_path = argv[++i];
    else if (option == "--fleet" && more) fleet_path = argv[++i];
    else if (option == "--require" && more) {
      const std::string text = argv[++i];
      required[text.substr(0, text.find('='))] = std::atof(text.c_str() + text.find('=') + 1);
    } else {
      return std::fputs(usage, stderr), 2;
    }
  }
  if (labels_path.empty() || fleet_path.empty()) return std::fputs(usage, stderr), 2;
  const Json labels = read(labels_path), fleet = read(fleet_path);
  std::map<std::string, double> share;
  struct Count {
    double right = 0.0, all = 0.0;
    double of() const { return all > 0.0 ? right / all : 1.0; }
  };
  Count family, odd_found, drift_found, moment, broken_found, held, unshifted;
  std::map<std::string, std::vector<std::pair<double, double>>> intervals;
  int false_odd = 0, false_drift = 0, false_broken = 0, sound = 0, steady_units = 0;
  std::map<std::string, int> confused;
  std::set<std::string> seen;
  std::set<std::string> broken;
  for (const Json& one : labels.value("broken", Json::array())) broken.insert(one.get<std::string>());
  // The only unit of its kind is unlike all others: to call it odd is no mistake, nor is it one to call it sound.
  std::map<std::string, int> kin;
  for (const Json& unit : fleet.at("units"))
    ++kin[labels.at("units").at(unit.at("unit").get<std::string>()).at("family").get<std::string>()];
  for (const Json& unit : fleet.at("units")) {
    const std::string name = unit.at("unit");
    // Only units with a single log have a broken one: what is left of such a unit is neither sound nor odd.
    if (broken.count("logs/" + name + "_1.csv") > 0) continue;
    const Json& label = labels.at("units").at(name);
    seen.insert(name);
    const bool odd = label.at("odd"), drifts = label.at("drift").get<double>() != 0.0;
    const bool called_odd = unit.at("odd") != "none";
    if (odd) {
      odd_found.all += 1.0;
      odd_found.right += called_odd;
    } else {
      if (kin[label.at("family").get<std::string>()] > 1) {
        ++sound;
        false_odd += called_odd && !drifts;
      }
      const int index = unit.at("family");
      const std::string found =
          index < 0 ? "nothing"
                    : fleet.at("families")[static_cast<std::size_t>(index)].at("cause").get<std::string>();
      family.all += 1.0;
      family.right += found == label.at("family");
      if (found != label.at("family"))
        ++confused[label.at("family").get<std::string>() + " taken for " + found];
    }
    bool found_drift = false;
    for (const Json& drift : unit.value("drifts", Json::array())) {
      if (!drifts) {
        ++false_drift;
        continue;
      }
      if (drift.at("parameter") != "conductance") continue;
      found_drift = drift.at("size").get<double>() * label.at("drift").get<double>() > 0.0;
      if (!label.at("steady").get<bool>()) {
        const double after = 20000.0 + label.at("drift_after_day").get<double>();
        moment.all += 1.0;
        moment.right += drift.at("since_days").get<double>() <= after &&
                        drift.at("until_days").get<double>() >= after + 30.0;
      }
    }
    if (drifts) {
      drift_found.all += 1.0;
      drift_found.right += found_drift;
    } else {
      ++steady_units;
    }
    if (odd || drifts || !unit.contains("parameters")) continue;
    for (const char* constant : {"resistance", "conductance", "heat_capacity"}) {
      if (!unit.at("parameters").contains(constant)) continue;
      const Json& ci = unit.at("parameters").at(constant).at("ci95");
      const double truth = label.at(constant);
      held.all += 1.0;
      held.right += ci[0].get<double>() <= truth && truth <= ci[1].get<double>();
      intervals[std::string(constant) + unit.at("family").dump()].push_back(
          {std::log(ci[0].get<double>() / truth), std::log(ci[1].get<double>() / truth)});
    }
  }
  // What is common to all, such as the weak effect that no unit's model has, shifts all alike: what is left between
  // units is what their intervals are about.
  for (const auto& [what, list] : intervals) {
    double shift = 0.0;
    for (const auto& [low, high] : list) shift += 0.5 * (low + high) / static_cast<double>(list.size());
    for (const auto& [low, high] : list) {
      unshifted.all += 1.0;
      unshifted.right += low <= shift && shift <= high;
    }
  }
  std::set<std::string> bad;
  for (const Json& one : fleet.at("bad_logs")) bad.insert(one.at("log").get<std::string>());
  for (const std::string& one : broken)
    broken_found.all += 1.0, broken_found.right += bad.count(one) > 0 ? 1.0 : 0.0;
  for (const std::string& one : bad) false_broken += broken.count(one) == 0;
  bool weak = false;
  std::string named = "nothing";
  for (const Json& one : fleet.at("weak_effects")) {
    if (!one.at("stands").get<bool>()) continue;
    if (named == "nothing") named = one.at("cause");
    weak = named == labels.at("weak");
    break;
  }
  std::set<std::string> families, wanted;
  for (const Json& one : fleet.at("families")) families.insert(one.at("cause").get<std::string>());
  for (const auto& [name, one] : labels.at("units").items())
    wanted.insert(one.at("family").get<std::string>());

  share["families"] = families == wanted ? 1.0 : 0.0;
  share["family"] = family.of();
  share["odd"] = odd_found.of();
  share["sound_not_odd"] = 1.0 - false_odd / std::max(1.0, static_cast<double>(sound));
  share["broken"] = broken_found.of();
  share["drift"] = drift_found.of();
  share["moment"] = moment.of();
  share["steady_not_drifting"] = 1.0 - false_drift / std::max(1.0, static_cast<double>(steady_units));
  share["weak"] = weak ? 1.0 : 0.0;
  share["held"] = held.of();
  share["held_unshifted"] = unshifted.of();
  std::printf("| what | right | of |\n| --- | --- | --- |\n");
  const auto row = [](const char* what, double right, double all) {
    std::printf("| %s | %.0f | %.0f |\n", what, right, all);
  };
  row("hidden families found as a whole", share["families"], 1.0);
  row("units in their family", family.right, family.all);
  row("odd units found", odd_found.right, odd_found.all);
  row("sound units called odd", false_odd, sound);
  row("broken logs found", broken_found.right, broken_found.all);
  row("sound logs called broken", false_broken,
      static_cast<double>(fleet.at("logs").get<int>()) - broken_found.all);
  row("drifts found, sign right", drift_found.right, drift_found.all);
  row("moment of the change within the interval told", moment.right, moment.all);
  row("drifts where there is none", false_drift, steady_units);
  row("the weak common effect named", share["weak"], 1.0);
  row("true constants within a unit's 95 % interval", held.right, held.all);
  row("the same, what all units have in common taken out", unshifted.right, unshifted.all);
  for (const auto& [what, times] : confused) std::printf("\n%s: %d", what.c_str(), times);
  std::printf("\nthe weak effect named: %s\n", named.c_str());
  int status = 0;
  for (const auto& [what, least] : required) {
    if (share.count(what) == 0) {
      std::cerr << "gap_fleet_score: nothing is called " << what << "\n";
      return 2;
    }
    if (share[what] >= least) continue;
    std::cerr << "gap_fleet_score: " << what << " is " << share[what] << "; expected at least " << least
              << "\n";
    status = 1;
  }
  return status;
}
