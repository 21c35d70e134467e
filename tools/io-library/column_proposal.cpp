// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "column_proposal.hpp"

#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/recording_file.hpp>

#include "html_text.hpp"
#include "unit_words.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <set>

namespace thermopower::io {
namespace {

using Words = std::vector<std::string>;

bool has(const Words& words, std::initializer_list<const char*> any) {
  return std::any_of(any.begin(), any.end(), [&](const char* one) {
    return std::find(words.begin(), words.end(), one) != words.end();
  });
}

bool is_one_of(const std::string& word, const std::set<std::string>& any) { return any.count(word) != 0; }

// German writes as one word what English writes as two: "Motorstrom", "Solldrehzahl".
void split_compound(const std::string& word, Words& words) {
  for (const char* stem : {"temperatur", "drehzahl", "spannung", "winkel", "strom", "geschwindigkeit",
                           "drehmoment", "moment", "position", "temp", "zeit"}) {
    const std::string end = stem;
    if (word.size() > end.size() + 2 && word.compare(word.size() - end.size(), end.size(), end) == 0) {
      words.push_back(word.substr(0, word.size() - end.size()));
      words.push_back(end);
      return;
    }
  }
  words.push_back(word);
}

// Lower-case words of a header: "Motor Temp [degC]", "motorTemp_degC" and "motor.temp-degC" are alike.
Words words_of(const std::string& given) {
  const std::string header = plain_header(given);
  Words raw(1), words;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const char c = header[i];
    const bool upper = c >= 'A' && c <= 'Z', lower = c >= 'a' && c <= 'z', digit = c >= '0' && c <= '9';
    const bool after_lower = i > 0 && header[i - 1] >= 'a' && header[i - 1] <= 'z';
    if ((upper && after_lower) || !(upper || lower || digit)) raw.emplace_back();
    if (upper || lower || digit) raw.back() += static_cast<char>(upper ? c - 'A' + 'a' : c);
  }
  for (const std::string& word : raw)
    if (!word.empty()) split_compound(word, words);
  return words;
}

const std::set<std::string> wanted_words = {"cmd",       "command",  "commanded", "commands", "ref",
                                            "reference", "setpoint", "target",    "desired",  "des",
                                            "goal",      "soll",     "sp",        "action"};
const std::set<std::string> supply_words = {"supply",      "battery",    "batt",     "vbus", "vbat",
                                            "vin",         "bus",        "psu",      "akku", "dclink",
                                            "versorgungs", "versorgung", "batterie", "netz", "vsupply"};
const std::set<std::string> air_words = {"ambient", "amb",         "air",      "env",       "room",
                                         "outside", "environment", "umgebung", "umgebungs", "raum",
                                         "luft",    "aussen",      "chamber"};
const std::set<std::string> body_words = {"motor",    "mot",    "motors",   "winding",   "coil",     "case",
                                          "housing",  "stator", "wicklung", "wicklungs", "gehaeuse", "spule",
                                          "extruder", "hotend", "nozzle",   "body"};
const std::set<std::string> electronics_words = {
    "mcu",      "board", "fet", "fets", "mos",        "mosfet", "esc",         "pcb", "driver",    "drv",
    "inverter", "igbt",  "cpu", "chip", "controller", "ctrl",   "electronics", "imu", "raspberry", "pi"};
const std::set<std::string> plain_words = {
    "joint", "joints",      "state", "states",      "data",     "value",    "raw",       "axis",
    "field", "observation", "the",   "of",          "in",       "level",    "actual",    "act",
    "meas",  "measured",    "ist",   "fb",          "feedback", "est",      "estimated", "present",
    "q",     "observed",    "msg",   "drive",       "and",      "filtered", "filt",      "qj",
    "input", "output",      "cycle", "controllers", "dxl",      "servo"};
const std::set<std::string> quantity_words = {"time",        "timestamp", "stamp",
                                              "t",           "elapsed",   "zeit",
                                              "zeitstempel", "ts",        "today",
                                              "temp",        "temps",     "temperature",
                                              "temperatur",  "celsius",   "current",
                                              "curr",        "amps",      "iq",
                                              "i",           "strom",     "voltage",
                                              "volt",        "volts",     "v",
                                              "spannung",    "u",         "rate",
                                              "velocity",    "vel",       "speed",
                                              "omega",       "gyro",      "rpm",
                                              "erpm",        "dq",        "qd",
                                              "qvel",        "drehzahl",  "geschwindigkeit",
                                              "angle",       "position",  "positions",
                                              "velocities",  "efforts",   "pos",
                                              "theta",       "encoder",   "qpos",
                                              "winkel",      "lage",      "torque",
                                              "effort",      "tau",       "drehmoment",
                                              "moment",      "duty",      "pwm",
                                              "heater",      "tastgrad",  "load",
                                              "power",       "airspeed",  "wind",
                                              "tachometer"};

/// What a column may be, before its rivals are asked.
struct Guess {
  std::string name;   // of the format; empty: nothing
  std::string unit;   // as --column takes it; empty: the format's
  std::string why;    // what it rests on, or why it is nothing
  std::string group;  // words of the header that say whose it is: the joint
  int weight = 0;     // of guesses at the same name the heaviest is taken
  bool wanted = false;
  bool has_unit = false;    // the header or the file says it
  bool in_radians = false;  // as robots' programs call it
};

class Proposer {
public:
  Proposer(std::vector<ListedColumn>& list, const std::vector<ColumnHint>& hints, const std::string& joint,
           const CsvTable* table)
      : list_(list), hints_(hints), joint_(joint), table_(table) {}

  void run() {
    marlin_ = std::any_of(list_.begin(), list_.end(),
                          [](const ListedColumn& one) { return one.header == "@" || one.header == "B@"; });
    const auto is_heated = [&](std::initializer_list<const char*> powers) {
      return std::any_of(list_.begin(), list_.end(), [&](const ListedColumn& one) {
        return std::find(powers.begin(), powers.end(), one.header) != powers.end() && one.samples > 0 &&
               one.greatest > 0.0;
      });
    };
    only_bed_ = is_heated({"B@"}) && !is_heated({"@", "@0"});
    for (std::size_t i = 0; i < list_.size(); ++i) guesses_.push_back(guess(i));
    choose_joint();
    choose_drive();
    settle();
    compare_rate_and_angle();
    for (std::size_t i = 0; i < list_.size(); ++i) {
      list_[i].proposed = guesses_[i].name;
      list_[i].unit = guesses_[i].name.empty() ? std::string() : guesses_[i].unit;
      list_[i].why = guesses_[i].why;
    }
  }

private:
  static double range(const ListedColumn& one) { return one.samples > 0 ? one.greatest - one.least : 0.0; }
  static double largest(const ListedColumn& one) {
    return std::max(std::fabs(one.least), std::fabs(one.greatest));
  }

  static Guess nothing(std::string why) {
    Guess guess;
    guess.why = std::move(why);
    return guess;
  }

  // Words that say whose a column is.
  static std::string group_of(const Words& words) {
    std::string group;
    for (const std::string& word : words)
      if (!is_one_of(word, plain_words) && !is_one_of(word, quantity_words) &&
          !is_one_of(word, wanted_words) && !is_one_of(word, supply_words) && !is_one_of(word, air_words) &&
          !is_one_of(word, body_words) && !is_one_of(word, electronics_words))
        group += (group.empty() ? "" : " ") + word;
    return group;
  }

  Guess guess(std::size_t at) const {
    const ListedColumn& column = list_[at];
    const ColumnHint hint = at < hints_.size() ? hints_[at] : ColumnHint();
    if (column.text) return nothing({});
    if (hint.not_meant) return nothing(hint.because);
    UnitWord unit = unit_in_header(column.header);
    const Words words = words_of(unit.name);
    if (!column.file_unit.empty()) unit = unit_word(column.file_unit);
    Guess guess = by_name(column, words, unit);
    if (!hint.name.empty()) {
      guess.name = hint.name;
      guess.weight = 100;
    }
    guess.group = group_of(words);
    if (guess.name.empty()) return guess;
    if (!hint.because.empty()) {
      guess.unit = hint.unit;
      guess.has_unit = true;
      guess.why = hint.because;
      return guess;
    }
    if (!guess.has_unit) ask_the_range(column, guess);
    return guess;
  }

  Guess by_name(const ListedColumn& column, const Words& words, const UnitWord& unit) const {
    Guess guess;
    guess.why = "its name";
    for (const std::string& known : known_columns())
      if (column.header == known) {
        guess.name = known;
        guess.weight = 1000;
        const std::vector<std::string> units = units_of(known);
        // The name holds its unit; only a row of units says another one.
        guess.has_unit =
            !column.file_unit.empty() && std::find(units.begin(), units.end(), unit.unit) != units.end();
        if (guess.has_unit && unit.unit != units.front()) {
          guess.unit = unit.unit;
          guess.why += " and the row of units";
        }
        guess.has_unit = guess.has_unit && unit.unit != units.front();
        return guess;
      }
    guess = by_words(column, words, unit);
    if (guess.name.empty()) return guess;
    if (unit.dimension == Dimension::none) return guess;
    // A unit that the name cannot have: one of the two is wrong, and nobody here can tell which.
    const std::vector<std::string> units = units_of(guess.name);
    if (std::find(units.begin(), units.end(), unit.unit) == units.end())
      return nothing("its name says " + guess.name + ", its unit does not");
    guess.unit = unit.unit;
    guess.has_unit = true;
    guess.why += column.file_unit.empty() ? " and the unit in it" : " and the row of units";
    return guess;
  }

  Guess named(const char* name, int weight, const char* why = "its name") const {
    Guess guess;
    guess.name = name;
    guess.weight = weight;
    guess.why = why;
    return guess;
  }

  Guess by_words(const ListedColumn& column, const Words& words, const UnitWord& unit) const {
    const bool wanted = std::any_of(words.begin(), words.end(),
                                    [](const std::string& word) { return is_one_of(word, wanted_words); });
    const auto any_of = [&](const std::set<std::string>& list) {
      return std::any_of(words.begin(), words.end(),
                         [&](const std::string& word) { return is_one_of(word, list); });
    };
    const bool supply = any_of(supply_words), air = any_of(air_words), body = any_of(body_words);
    const bool moteus = !words.empty() && words[0].size() == 2 && words[0][0] == 'c' && words[0][1] >= '0' &&
                        words[0][1] <= '9';
    const bool electronics = any_of(electronics_words) || moteus;
    const auto measured = [&](Guess guess) {
      guess.wanted = wanted;
      return guess;
    };
    if (has(words, {"layout", "variance", "covariance", "constant", "error", "fault", "status", "mode",
                    "count", "max", "min", "limit", "kp", "kd", "ki"}) &&
        !has(words, {"time"}) && unit.dimension != Dimension::time)
      return electronics && has(words, {"temp"}) ? nothing("temperature of the electronics") : Guess();
    const bool hot_end_power = column.header == "@" || (marlin_ && column.header == "@0"),
               hot_end = marlin_ && (column.header == "T" || column.header == "T0"),
               bed = marlin_ && (column.header == "B" || column.header == "B@");
    if (only_bed_ && (hot_end || hot_end_power))
      return nothing("the hot end's, which is not heated in this log");
    if (!only_bed_ && bed) return nothing("the bed's");
    if (hot_end_power || column.header == "B@")
      return named(
          "power_param", 5,
          hot_end_power ? "the heater's power as Marlin tells it" : "the bed's power as Marlin tells it");
    if (hot_end || bed)
      return named("motor_C", 5,
                   hot_end ? "the hot end's temperature as Marlin tells it"
                           : "the bed's temperature as Marlin tells it");
    if (marlin_ && column.header == "A")
      return named("ambient_C", 3, "the air's temperature as Marlin tells it");
    if (marlin_ && wanted) return nothing("a target temperature");
    // Temperatures whose letter is the clock's, too.
    if (has(words, {"tamb", "tair", "tenv", "troom"}) ||
        (air && has(words, {"t"}) && unit.dimension != Dimension::time))
      return named("ambient_C", 3);
    if (has(words, {"tmotor", "tmot", "twinding", "tcoil", "tcase"}) || (body && has(words, {"t"})))
      return named("motor_C", 4);
    const bool clock =
        has(words, {"time", "timestamp", "stamp", "t", "elapsed", "zeit", "zeitstempel", "ts", "today"});
    if (clock && (unit.dimension == Dimension::none || unit.dimension == Dimension::time) &&
        !has(words, {"step", "dt"})) {
      if (column.rises && range(column) > 0.0) {
        Guess guess = named("t_s", has(words, {"time", "timestamp", "zeit"}) ? 3 : 2);
        if (has(words, {"ms"})) guess.unit = "ms", guess.has_unit = true;
        return guess;
      }
      if (column.rises || unit.dimension == Dimension::time) return named("t_s", 1);
      if (words.size() == 1 && words[0] == "t") return named("motor_C", 2, "a T that falls is a temperature");
      return nothing("its name says time, but its numbers fall");
    }
    // What the unit measures goes before what the name may mean.
    Dimension kind = unit.dimension;
    const bool named_temperature = has(words, {"temp", "temps", "temperature", "temperatur", "celsius"});
    const bool named_current = has(words, {"current", "curr", "amps", "iq", "i", "strom"});
    const bool named_voltage =
        has(words, {"voltage", "volt", "volts", "v", "spannung", "vbus", "vbat", "vin"});
    const bool named_rate = has(words, {"rate", "velocity", "velocities", "vel", "speed", "omega", "gyro",
                                        "rpm", "dq", "qd", "qvel", "drehzahl", "geschwindigkeit"});
    const bool named_angle =
        has(words, {"angle", "position", "positions", "pos", "theta", "encoder", "qpos", "winkel", "lage"}) ||
        (has(words, {"q"}) && !has(words, {"axis"}));
    const bool named_torque = has(words, {"torque", "effort", "efforts", "tau", "drehmoment"});
    const bool named_duty = has(words, {"duty", "pwm", "tastgrad"}) || (has(words, {"heater"}) && !wanted);
    if (kind == Dimension::none || (kind == Dimension::share && named_duty)) {
      kind = has(words, {"airspeed", "windspeed", "wind"}) ? Dimension::speed
             : named_duty && !named_temperature            ? Dimension::share
             : named_temperature                           ? Dimension::temperature
             : named_current                               ? Dimension::current
             : named_torque                                ? Dimension::torque
             : named_rate                                  ? Dimension::rate
             : named_angle                                 ? Dimension::angle
             : named_voltage || supply                     ? Dimension::voltage
             : air && words.size() <= 2                    ? Dimension::temperature
                                                           : Dimension::none;
    } else if ((kind == Dimension::voltage && named_current) ||
               (kind == Dimension::current && named_voltage) ||
               (kind == Dimension::rate && named_temperature) || (kind == Dimension::time)) {
      return nothing("its name says one thing, its unit another");
    }
    const bool robot = has(words, {"joint", "joints", "qpos", "qvel", "dof", "q", "dq", "qd", "trajectory"});
    switch (kind) {
      case Dimension::speed:
        return has(words, {"airspeed", "windspeed", "wind", "air"}) ? named("airspeed_mps", 3) : Guess();
      case Dimension::temperature:
        if (wanted) return named("target_C", 2);
        if (air) return named("ambient_C", 3);
        if (electronics && !has(words, {"motor", "winding", "coil"}))
          return nothing("temperature of the electronics");
        return named("motor_C", body ? 4 : 2);
      case Dimension::current:
        if (supply || (has(words, {"in", "input"}) && !body))
          return nothing("the supply's current, of all motors");
        if ((has(words, {"d"}) && has(words, {"axis"})) || has(words, {"id"}))
          return nothing("current of the d axis: it makes no torque");
        if (column.whole && column.samples >= 16 && column.least >= 0.0 && column.greatest > 1.0 &&
            unit.dimension == Dimension::none)
          return nothing(
              "may be current_A, but whole numbers without a unit: counts of a register; --column current_A=HEADER:A*SIZE says their size");
        return measured(named(wanted ? "drive_A" : "current_A", 3));
      case Dimension::voltage: {
        if (wanted || has(words, {"motor", "applied", "drive", "terminal", "armature"}))
          return measured(named("voltage_V", 3));
        if (supply || has(words, {"input"})) return named("supply_V", 4);
        constexpr double narrow = 0.5;
        if (column.least > 0.0 && column.least > narrow * column.greatest && column.samples > 1)
          return named("supply_V", 2, "it stays near one voltage: the supply's, not the motor's");
        return measured(named("voltage_V", 2));
      }
      case Dimension::share:
        if (unit.dimension == Dimension::share && !named_duty) return Guess();
        return column.least < 0.0
                   ? measured(named("voltage_V", 2, "a duty with a sign: a share of the supply"))
                   : measured(named("power_param", body ? 3 : 2));
      case Dimension::rate: {
        if (has(words, {"erpm"}))
          return nothing("electrical revolutions; --column rate_dps=HEADER:rpm/7 divides by the pole pairs");
        Guess guess =
            named(wanted ? "target_dps" : "rate_dps", has(words, {"angular", "gyro", "imu"}) ? 2 : 3);
        guess.in_radians = robot;
        return measured(guess);
      }
      case Dimension::angle: {
        Guess guess = named(wanted ? "target_deg" : "angle_deg", 3);
        guess.in_radians = robot;
        return measured(guess);
      }
      case Dimension::torque: {
        if (has(words, {"external", "ext", "load", "disturbance"}) && !has(words, {"cell", "motor"}))
          return measured(named("torque_Nm", 3));
        if (unit.dimension == Dimension::none && !named_torque) return Guess();
        const bool sensor = !has(words, {"effort", "efforts", "tau", "cmd", "torque"});
        if (sensor) return Guess();
        Guess guess = named("drive_A", wanted ? 2 : 1,
                            "the drive's own torque, divided by the model's torque constant");
        if (unit.dimension == Dimension::none) guess.unit = "Nm";
        guess.has_unit = true;
        return measured(guess);
      }
      default:
        return Guess();
    }
  }

  // The unit of time in which a column's stamps are those of a log: of a day at most, or counted from 1970.
  static std::string unit_of_time(const ListedColumn& column) {
    constexpr double longest_s = 86400.0, since_1970_s = 1e9;
    struct Unit {
      const char* text;
      double per_s;
    };
    constexpr Unit units[] = {{"s", 1.0}, {"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}};
    for (const Unit& unit : units) {
      const bool dates =
          column.least >= since_1970_s * unit.per_s && column.least < 1e2 * since_1970_s * unit.per_s;
      const bool counts = column.least < since_1970_s && range(column) <= longest_s * unit.per_s;
      if (dates || counts) return unit.text;
    }
    return "s";
  }

  // What the numbers of a column say of its unit, where its name does not; a column with the format's own name is only contradicted.
  static void ask_the_range(const ListedColumn& column, Guess& guess) {
    const bool is_own_name = column.header == guess.name;
    const double most = largest(column);
    const auto tell = [&](const std::string& unit, const std::string& range) {
      guess.unit = unit;
      guess.has_unit = true;
      guess.why += ", and a range " + range;
    };
    const auto ends_with = [&](const std::string& end) {
      return guess.name.size() > end.size() &&
             guess.name.compare(guess.name.size() - end.size(), end.size(), end) == 0;
    };
    constexpr double coldest_K = 200.0, many_A = 100.0, many_V = 1000.0, full_power = 255.0,
                     marlin_power = 127.0;
    constexpr double one_turn_deg = 360.0;
    if (column.samples == 0) return;
    if (guess.name == "t_s") {
      const std::string unit = unit_of_time(column);
      if (unit != "s") tell(unit, "of " + readable(range(column)));
    } else if (guess.name == "power_param") {
      const bool marlin =
          column.header == "@" || column.header == "B@" || (column.whole && column.greatest == marlin_power);
      if (marlin && most <= marlin_power && !is_own_name) {
        tell("127", "up to 127, as Marlin counts");
      } else if (most > full_power) {
        guess = nothing("may be power_param, but goes up to " + readable(most) + ", beyond 255");
      } else if (most <= 1.0 && (!is_own_name || most > 0.0)) {
        tell("1", "up to " + readable(most));
      } else if (most <= 100.0 && !is_own_name) {
        tell("%", "up to " + readable(most));
      }
    } else if (guess.name == "voltage_V" && guess.why.compare(0, 6, "a duty") == 0) {
      if (most <= 1.0) tell("1", "up to " + readable(most));
      else if (most <= 100.0) tell("%", "up to " + readable(most));
      else if (most <= full_power) tell("255", "up to " + readable(most));
      else guess = nothing("a duty with a sign up to " + readable(most) + ": nobody can tell of how much");
    } else if (ends_with("_C") && column.least > coldest_K) {
      tell("K", "from " + readable(column.least));
    } else if (ends_with("_A") && most > many_A) {
      tell("mA", "up to " + readable(most));
    } else if (ends_with("_V") && most > many_V) {
      tell("mV", "up to " + readable(most));
    } else if (ends_with("_deg") && !is_own_name && column.whole && column.least >= 0.0 &&
               column.greatest > one_turn_deg) {
      constexpr double servo_counts = 4096.0;
      if (column.greatest < servo_counts) tell("4096", "of whole numbers below 4096: counts of a servo");
      else
        guess = nothing("may be " + guess.name + ", but whole numbers up to " + readable(most) +
                        ": --column " + guess.name + "=HEADER:N says how many are a turn");
    } else if (ends_with("_dps") && !is_own_name && column.sign_bit > 0) {
      tell("4096/s,sign" + std::to_string(column.sign_bit), "of a servo's register: bit " +
                                                                std::to_string(column.sign_bit) +
                                                                " is the sign, 4096 counts are a turn");
    }
  }

  // How far a joint moves, in degrees and seconds, whatever its column's unit.
  double travel(std::size_t at) const {
    const Guess& guess = guesses_[at];
    if (guess.name != "angle_deg" && guess.name != "rate_dps") return 0.0;
    const std::string unit = !guess.unit.empty() ? guess.unit
                             : guess.in_radians  ? (guess.name == "angle_deg" ? "rad" : "rad/s")
                                                 : "";
    if (unit.empty()) return range(list_[at]);
    const ColumnChoice choice = parse_column_choice(guess.name + "=x:" + unit);
    if (choice.sign_bit > 0) return std::fabs(choice.factor) * std::ldexp(1.0, choice.sign_bit) * 0.01;
    return std::fabs(choice.factor) * range(list_[at]);
  }

  // The joint that moves; of those that do, the one of which most is known.
  void choose_joint() {
    struct Joint {
      double angle = 0.0, rate = 0.0;
      std::set<std::string> names;
      double drive = 0.0;
    };
    std::map<std::string, Joint> joints;
    for (std::size_t i = 0; i < guesses_.size(); ++i) {
      const Guess& guess = guesses_[i];
      if (guess.name != "angle_deg" && guess.name != "rate_dps") continue;
      Joint& joint = joints[guess.group];
      (guess.name == "angle_deg" ? joint.angle : joint.rate) =
          std::max(guess.name == "angle_deg" ? joint.angle : joint.rate, travel(i));
    }
    if (joints.empty()) {
      // A heater is chosen by its name alone.
      has_joint_ = !joint_.empty();
      chosen_ = group_of(words_of(joint_));
      return;
    }
    for (std::size_t i = 0; i < guesses_.size(); ++i) {
      const auto joint = joints.find(guesses_[i].group);
      if (joint == joints.end()) continue;
      if (!guesses_[i].name.empty()) joint->second.names.insert(guesses_[i].name);
      const Words words = words_of(unit_in_header(list_[i].header).name);
      if (std::any_of(words.begin(), words.end(),
                      [](const std::string& one) { return is_one_of(one, wanted_words); }))
        joint->second.names.insert("command");
    }
    double most_angle = 0.0, most_rate = 0.0;
    for (const auto& [group, joint] : joints) {
      most_angle = std::max(most_angle, joint.angle);
      most_rate = std::max(most_rate, joint.rate);
    }
    constexpr double moves = 0.1;  // of how far the one goes that goes farthest
    const Joint* best = nullptr;
    const auto value_of = [](const Joint& joint) {
      int value = 0;
      for (const std::string& name : joint.names)
        value +=
            name == "drive_A" || name == "voltage_V" || name == "target_deg" || name == "command" ? 2 : 1;
      return value;
    };
    for (const auto& [group, joint] : joints) {
      if (!joint_.empty()) {
        const Words wanted = words_of(joint_);
        const Words words = words_of(group);
        const bool is_it =
            !wanted.empty() && std::all_of(wanted.begin(), wanted.end(), [&](const std::string& one) {
              return std::find(words.begin(), words.end(), one) != words.end();
            });
        if (!is_it) continue;
      } else if (joint.angle < moves * most_angle && joint.rate < moves * most_rate) {
        continue;
      }
      const bool better =
          best == nullptr || value_of(joint) > value_of(*best) ||
          (value_of(joint) == value_of(*best) && joint.angle + joint.rate > best->angle + best->rate);
      if (!better) continue;
      best = &joint;
      chosen_ = group;
    }
    has_joint_ = best != nullptr;
  }

  // How near a column is to the joint: of it, of nobody by name, or with the same number in its name.
  int nearness(const Guess& guess) const {
    if (!has_joint_ || guess.group == chosen_) return 3;
    if (guess.group.empty()) return 2;
    const auto number = [](const std::string& text) {
      std::string digits;
      for (const char c : text)
        if (c >= '0' && c <= '9') digits += c;
      return digits;
    };
    const std::string mine = number(chosen_), other = number(guess.group);
    if (!mine.empty() && mine == other) return 1;
    const Words words = words_of(chosen_), others = words_of(guess.group);
    const bool shares = std::any_of(others.begin(), others.end(), [&](const std::string& one) {
      return std::find(words.begin(), words.end(), one) != words.end();
    });
    // Whose it is nobody says, or something else than a joint's name does.
    const bool names_a_joint = std::any_of(guesses_.begin(), guesses_.end(), [&](const Guess& one) {
      return one.group == guess.group && (one.name == "angle_deg" || one.name == "rate_dps");
    });
    const bool is_number = other == guess.group;
    return shares ? 2 : names_a_joint || is_number ? 0 : 1;
  }

  // A joint must have an input: the current beside its motion, where nothing says what was commanded.
  void choose_drive() {
    if (!has_joint_) return;
    const auto of_joint = [&](const char* name) {
      return std::any_of(guesses_.begin(), guesses_.end(), [&](const Guess& one) {
        return one.name == name && one.unit != "Nm" && one.unit != "mNm" && nearness(one) > 0;
      });
    };
    if (of_joint("drive_A") || of_joint("voltage_V") || of_joint("target_deg") || of_joint("target_dps"))
      return;
    for (std::size_t i = 0; i < guesses_.size(); ++i) {
      Guess& guess = guesses_[i];
      if (guess.name != "current_A" || list_[i].header == "current_A" || nearness(guess) == 0) continue;
      if (!(list_[i].least < 0.0)) continue;
      guess.name = "drive_A";
      guess.why =
          "the current beside the motion" + std::string(guess.has_unit ? " and the unit in its name" : "");
    }
  }

  // One column for each name: its own name, then the joint's, then the likeliest.
  void settle() {
    std::set<std::string> names;
    for (const Guess& guess : guesses_)
      if (!guess.name.empty()) names.insert(guess.name);
    const std::set<std::string> of_a_joint = {"angle_deg",  "rate_dps",  "drive_A",
                                              "current_A",  "voltage_V", "target_deg",
                                              "target_dps", "torque_Nm", "motor_C"};
    names.erase("target_C");  // goes with the temperature that is chosen
    for (const std::string& name : names) {
      std::vector<std::size_t> rivals;
      for (std::size_t i = 0; i < guesses_.size(); ++i)
        if (guesses_[i].name == name) rivals.push_back(i);
      const auto value = [&](std::size_t i) {
        const Guess& guess = guesses_[i];
        const int near = nearness(guess);
        return guess.weight * 100 +
               (name != "drive_A" ? near * 1000
                : near > 0        ? near * 60
                                  : -1000) +
               (range(list_[i]) > 0.0 ? 250 : 0);
      };
      std::size_t best = rivals.front();
      for (const std::size_t i : rivals)
        if (value(i) > value(best)) best = i;
      const bool others_joint = has_joint_ && of_a_joint.count(name) != 0 && nearness(guesses_[best]) == 0;
      if (others_joint) {
        for (const std::size_t i : rivals)
          guesses_[i].why = "of another joint, or of none by its name", guesses_[i].name.clear();
        continue;
      }
      // Two that nothing tells apart: no proposal is better than a guess.
      for (const std::size_t i : rivals) {
        if (i == best) continue;
        guesses_[i].why = "may be " + name + ", as '" + list_[best].header + "' is";
        guesses_[i].name.clear();
      }
      const bool is_temperature_of_many =
          name == "motor_C" && rivals.size() > 1 && guesses_[best].weight <= 2 && !marlin_;
      if (!is_temperature_of_many) continue;
      bool alone = true;
      for (const std::size_t i : rivals) alone = alone && (i == best || value(i) < value(best));
      std::size_t widest = best;
      for (const std::size_t i : rivals)
        if (range(list_[i]) > range(list_[widest])) widest = i;
      constexpr double clearly = 3.0;
      const bool clear = std::all_of(rivals.begin(), rivals.end(), [&](std::size_t i) {
        return i == widest || range(list_[widest]) > clearly * range(list_[i]);
      });
      if (alone) continue;
      guesses_[best].name.clear();
      guesses_[best].why = "may be motor_C, as others may";
      if (!clear) continue;
      guesses_[widest].name = "motor_C";
      guesses_[widest].why = "of several temperatures the one that changes most";
    }
    prefer_one_torque();
    choose_target();
  }

  // A heater's target is asked for where its power is not recorded: then a loop of the model makes the power of it.
  void choose_target() {
    const std::size_t body = index_of("motor_C");
    bool wanted = body != guesses_.size() && index_of("power_param") == guesses_.size();
    // Klipper's `extruder.temp` has `extruder.target` beside it, Marlin's `B` has `B_target`.
    const std::string shown = wanted ? list_[body].header : std::string(),
                      heater = shown.substr(0, shown.rfind('.') + 1);
    for (std::size_t i = 0; i < guesses_.size(); ++i) {
      if (list_[i].header == "target_C") continue;
      const bool beside =
          list_[i].header == shown + "_target" || (!heater.empty() && list_[i].header == heater + "target");
      const Words words = words_of(unit_in_header(list_[i].header).name);
      const bool is_target =
          guesses_[i].name == "target_C" ||
          (guesses_[i].name.empty() && std::any_of(words.begin(), words.end(), [](const std::string& one) {
             return is_one_of(one, wanted_words);
           }));
      const bool alike = wanted && is_target && !list_[i].text && group_of(words) == guesses_[body].group;
      if (wanted && (beside || alike)) {
        guesses_[i] = named("target_C", 2, "the target beside the temperature");
        wanted = false;
      } else if (guesses_[i].name == "target_C") {
        guesses_[i] = nothing("a target temperature");
      }
    }
  }

  // A current that is the drive's makes its own torque one number too many.
  void prefer_one_torque() {
    for (Guess& guess : guesses_)
      if (guess.name.empty() && guess.why.compare(0, 15, "may be drive_A,") == 0 &&
          (guess.unit == "Nm" || guess.unit == "mNm"))
        guess.why = "torque of the drive; drive_A times the torque constant";
  }

  std::size_t index_of(const char* name) const {
    for (std::size_t i = 0; i < guesses_.size(); ++i)
      if (guesses_[i].name == name) return i;
    return guesses_.size();
  }

  const std::vector<double>* values_of(std::size_t at) const {
    if (table_ == nullptr || at >= list_.size()) return nullptr;
    for (const CsvTable::Column& column : table_->columns)
      if (column.name == list_[at].header) return &column.values;
    return nullptr;
  }

  // How many of the rate's units are one of the angle's a second: the rate against what the angle does, over the whole file.
  double rate_per_angle(std::size_t angle, std::size_t rate, std::size_t time) const {
    const std::vector<double>*a = values_of(angle), *r = values_of(rate), *t = values_of(time);
    if (a == nullptr || r == nullptr || t == nullptr) return 0.0;
    const std::string unit = guesses_[time].unit;
    const double second = unit.empty() ? 1.0 : parse_column_choice("t_s=x:" + unit).factor;
    double both = 0.0, square = 0.0;
    for (std::size_t i = 1; i < a->size(); ++i) {
      const double step = ((*t)[i] - (*t)[i - 1]) * second, slope = ((*a)[i] - (*a)[i - 1]) / step;
      const double mean = 0.5 * ((*r)[i] + (*r)[i - 1]);
      if (!(step > 0.0) || !std::isfinite(slope) || !std::isfinite(mean)) continue;
      both += slope * mean;
      square += mean * mean;
    }
    // Noise makes the slope larger, and not the product: the rate is what it is held against.
    return square > 0.0 && both > 0.0 ? square / both : 0.0;
  }

  // An angle and its own rate say whether one of them is in radians, turns or degrees.
  void compare_rate_and_angle() {
    const std::size_t angle = index_of("angle_deg"), rate = index_of("rate_dps"), time = index_of("t_s");
    if (angle == guesses_.size() || rate == guesses_.size()) {
      for (Guess& guess : guesses_) assume_unit(guess);
      return;
    }
    Guess &a = guesses_[angle], &r = guesses_[rate];
    const bool own_names = list_[angle].header == "angle_deg" || list_[rate].header == "rate_dps";
    if (!own_names && (!a.has_unit || !r.has_unit) && time != guesses_.size()) {
      const double ratio = rate_per_angle(angle, rate, time);
      struct Pair {
        const char *angle, *rate;
        double ratio;
      };
      constexpr double deg_per_rad = 57.29577951308232;
      // Likeliest first: what goes together, then what programs mix.
      const Pair pairs[] = {{a.in_radians || r.in_radians ? "rad" : "deg",
                             a.in_radians || r.in_radians ? "rad/s" : "deg/s", 1.0},
                            {"deg", "deg/s", 1.0},
                            {"rad", "rad/s", 1.0},
                            {"rad", "deg/s", deg_per_rad},
                            {"deg", "rad/s", 1.0 / deg_per_rad},
                            {"deg", "rpm", 1.0 / 6.0},
                            {"rad", "rpm", deg_per_rad / 6.0},
                            {"rev", "rpm", 60.0},
                            {"rev", "rev/s", 1.0},
                            {"rev", "rad/s", 360.0 / deg_per_rad},
                            {"rev", "deg/s", 360.0}};
      constexpr double near = 0.12;
      for (const Pair& pair : pairs) {
        if (a.has_unit && (a.unit.empty() ? "deg" : a.unit) != pair.angle) continue;
        if (r.has_unit && (r.unit.empty() ? "deg/s" : r.unit) != pair.rate) continue;
        if (!(std::fabs(ratio / pair.ratio - 1.0) < near)) continue;
        const std::string because = ", and the rate goes with the angle";
        if (!a.has_unit && (pair.ratio != 1.0 || r.has_unit))
          a.unit = pair.angle, a.has_unit = true, a.why += because;
        if (!r.has_unit && (pair.ratio != 1.0 || a.has_unit))
          r.unit = pair.rate, r.has_unit = true, r.why += because;
        break;
      }
    }
    for (Guess& guess : guesses_) assume_unit(guess);
  }

  // Nothing says in which unit a motion is: robots' programs use radians.
  static void assume_unit(Guess& guess) {
    const bool is_angle = guess.name == "angle_deg" || guess.name == "target_deg";
    const bool is_rate = guess.name == "rate_dps" || guess.name == "target_dps";
    if ((!is_angle && !is_rate) || guess.has_unit || guess.weight >= 1000) return;
    if (guess.in_radians) {
      guess.unit = is_angle ? "rad" : "rad/s";
      guess.why += ", in radians as joints' states are";
    } else {
      guess.why += "; no unit: taken for degrees";
    }
  }

  std::vector<ListedColumn>& list_;
  const std::vector<ColumnHint>& hints_;
  const std::string& joint_;
  const CsvTable* table_;
  std::vector<Guess> guesses_;
  std::string chosen_;
  bool has_joint_ = false, marlin_ = false, only_bed_ = false;
};

}  // namespace

void propose(std::vector<ListedColumn>& list, const std::vector<ColumnHint>& hints, const std::string& joint,
             const CsvTable* table) {
  Proposer(list, hints, joint, table).run();
}

}  // namespace thermopower::io
