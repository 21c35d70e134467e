// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/model_file.hpp>

#include <thermopower/io/input_error.hpp>
#include <thermopower/plant/network_plant.hpp>

#include "file_source.hpp"
#include "json_place.hpp"
#include "nearest_name.hpp"
#include "report_format.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <set>
#include <vector>

namespace thermopower::io {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t largest_file = 1 << 20;
constexpr const char* format_id = "thermopower-model/1";

std::string number_text(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

std::string line_and_column(const std::string& text, std::size_t byte) {
  std::size_t line = 1, column = 1;
  for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
    if (text[i] == '\n') {
      ++line;
      column = 1;
    } else {
      ++column;
    }
  }
  return std::to_string(line) + ":" + std::to_string(column);
}

/// What a constant may be.
enum class Allowed { any, positive, not_negative, not_zero };

/// What a constant that may have either sign can be at all: far beyond any material and any machine.
struct AllowedRange {
  double low, high;
  const char* unit;
};
constexpr AllowedRange temperature_C{-273.15, 5000.0, "degC"};
constexpr AllowedRange tempco_per_K{-1.0, 1.0, "1/K"};

class ModelReader {
public:
  ModelReader(const std::string& file, const Catalogue& catalogue) : file_(file), catalogue_(catalogue) {}

  Model read(const std::string& given) {
    const std::string text = without_comments(given);
    const Json root = parse(text);
    text_ = text;
    if (!root.is_object())
      fail("", std::string(root.type_name()) + " at the top; expected an object with \"format\": \"" +
                   format_id + "\"");
    if (!root.contains("format")) fail("/format", std::string("is missing; expected \"") + format_id + "\"");
    if (!root["format"].is_string() || root["format"].get<std::string>() != format_id) {
      const bool is_report = root["format"] == report_format;
      fail("/format", "is " + shown(root["format"]) + "; expected \"" + format_id + "\"" +
                          (is_report ? ", which 'diagnose --augmented' writes" : ""));
    }
    only(root, "",
         {"format", "name", "supply", "current", "thermal", "axis", "servo", "heater", "network", "effects"});
    Model model;
    if (root.contains("name")) {
      if (!root["name"].is_string()) fail("/name", "is " + shown(root["name"]) + "; expected text");
      model.name = root["name"].get<std::string>();
    }
    if (root.contains("supply")) read_supply(root["supply"], model);
    if (root.contains("current")) read_current(root["current"], model);
    if (root.contains("thermal")) read_thermal(root["thermal"], model);
    if (root.contains("axis")) read_axis(root["axis"], model);
    if (root.contains("servo")) read_servo(root["servo"], model);
    if (root.contains("heater")) read_heater(root["heater"], model);
    if (root.contains("network")) read_network(root, model);
    if (root.contains("effects")) read_effects(root["effects"], model);
    for (const char* block : {"supply", "current", "thermal", "axis", "servo"})
      if (root.contains(block)) read_uncertainty(root[block], std::string("/") + block, block, model);
    if (const auto problem = model.validate()) throw InputError(file_ + ": " + *problem);
    return model;
  }

private:
  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const {
    if (pointer.empty()) throw InputError(file_ + ": " + what);
    throw InputError(file_ + ": " + pointer + ": " + what + " (line " +
                     std::to_string(line_of_pointer(text_, pointer)) + ")");
  }

  static std::string shown(const Json& value) {
    const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    return text.size() > 40 ? text.substr(0, 40) + "..." : text;
  }

  static std::string below(const std::string& pointer, const std::string& key) {
    std::string safe;  // RFC 6901
    for (const char c : key) safe += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return pointer + "/" + safe;
  }

  // Comments become blanks, so that places in the text stay what they are.
  static std::string without_comments(std::string text) {
    bool quoted = false;
    for (std::size_t at = 0; at + 1 < text.size(); ++at) {
      if (quoted && text[at] == '\\') {
        ++at;
      } else if (text[at] == '"') {
        quoted = !quoted;
      } else if (!quoted && text[at] == '/' && (text[at + 1] == '/' || text[at + 1] == '*')) {
        const bool line = text[at + 1] == '/';
        const std::size_t found = line ? text.find('\n', at) : text.find("*/", at + 2);
        if (found == std::string::npos && !line) break;  // the parser says where it is
        const std::size_t end = found == std::string::npos ? text.size() : line ? found : found + 2;
        for (; at < end; ++at)
          if (text[at] != '\n') text[at] = ' ';
        --at;
      }
    }
    return text;
  }

  Json parse(const std::string& text) const {
    // The parser takes it for the end, whatever follows.
    if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
      throw InputError(file_ + ":" + line_and_column(text, zero + 1) +
                       ": not JSON: a byte 0x00; expected text, and nothing after the last brace");
    Watch watch(file_, text);
    Json::sax_parse(text, &watch);
    return Json::parse(text);
  }

  /// Reads along and stops at what the parser would take without a word, or refuse without saying where.
  class Watch : public nlohmann::json_sax<Json> {
  public:
    Watch(const std::string& file, const std::string& text) : file_(file), text_(text) {}

    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(number_integer_t) override { return value(); }
    bool number_unsigned(number_unsigned_t) override { return value(); }
    bool number_float(number_float_t, const string_t&) override { return value(); }
    bool string(string_t&) override { return value(); }
    bool binary(binary_t&) override { return value(); }
    bool start_object(std::size_t) override { return open(false); }
    bool start_array(std::size_t) override { return open(true); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
      Level& level = levels_.back();
      level.at = name;
      // The parser keeps the last of two equal keys; which of them the author meant nobody knows.
      if (!level.keys.insert(name).second)
        throw InputError(file_ + ": " + pointer() +
                         ": this key appears twice in one object; expected it once (line " +
                         std::to_string(line_of_pointer(text_, pointer())) + " is the first)");
      return true;
    }
    bool parse_error(std::size_t position, const std::string& token, const Json::exception& error) override {
      const std::string where = file_ + ":" + line_and_column(text_, position) + ": ";
      if (dynamic_cast<const Json::out_of_range*>(&error) != nullptr)
        throw InputError(where + pointer() + ": " + excerpt(token) +
                         " is too large for a number; expected a finite number");
      std::string what = error.what();
      const auto colon = what.find(": ", what.find("column"));
      if (colon != std::string::npos) what = what.substr(colon + 2);
      const std::size_t first = text_.find_first_not_of(" \t\r\n");
      const bool is_other = first == std::string::npos || text_[first] != '{';
      throw InputError(where + "not JSON: " + what +
                       (is_other ? "; expected a model file, as 'thermopower-gap init' writes it" : ""));
    }

  private:
    struct Level {
      bool array = false;
      std::size_t index = 0;
      std::string at;
      std::set<std::string> keys;
    };
    bool value() {
      if (!levels_.empty() && levels_.back().array) ++levels_.back().index;
      return true;
    }
    bool open(bool array) {
      if (levels_.size() >= deepest)
        throw InputError(file_ + ": " + pointer() + ": nested more than " + std::to_string(deepest) +
                         " levels deep; expected a model");
      levels_.push_back({array, 0, {}, {}});
      return true;
    }
    bool close() {
      levels_.pop_back();
      return value();
    }
    std::string pointer() const {
      std::string text;
      for (const Level& level : levels_)
        text = below(text, level.array ? std::to_string(level.index) : level.at);
      return text;
    }

    static constexpr std::size_t deepest = 64;
    const std::string& file_;
    const std::string& text_;
    std::vector<Level> levels_;
  };

  void object(const Json& value, const std::string& pointer) const {
    if (!value.is_object()) fail(pointer, "is " + shown(value) + "; expected an object");
  }

  void only(const Json& value, const std::string& pointer, std::initializer_list<const char*> keys) const {
    only(value, pointer, std::vector<std::string>(keys.begin(), keys.end()));
  }

  void only(const Json& value, const std::string& pointer, const std::vector<std::string>& keys) const {
    for (const auto& item : value.items()) {
      if (std::find(keys.begin(), keys.end(), item.key()) != keys.end()) continue;
      std::string known;
      for (const auto& key : keys) known += (known.empty() ? "" : ", ") + key;
      fail(below(pointer, item.key()), "unknown key; expected one of " + known);
    }
  }

  double number(const Json& block, const std::string& pointer, const char* key, Allowed allowed) const {
    const std::string here = below(pointer, key);
    const char* const expected = allowed == Allowed::positive       ? "a number above 0"
                                 : allowed == Allowed::not_negative ? "a number, 0 or more"
                                 : allowed == Allowed::not_zero     ? "a number other than 0"
                                                                    : "a number";
    if (!block.contains(key)) fail(here, std::string("is missing; expected ") + expected);
    const Json& value = block[key];
    if (!value.is_number()) fail(here, "is " + shown(value) + "; expected " + expected);
    const double x = value.get<double>();
    const bool fine =
        std::isfinite(x) &&
        (allowed == Allowed::any || (allowed == Allowed::positive && x > 0.0) ||
         (allowed == Allowed::not_negative && x >= 0.0) || (allowed == Allowed::not_zero && x != 0.0));
    if (!fine) fail(here, "is " + shown(value) + "; expected " + expected);
    return x;
  }

  double number_or(const Json& block, const std::string& pointer, const char* key, Allowed allowed,
                   double otherwise) const {
    return block.contains(key) ? number(block, pointer, key, allowed) : otherwise;
  }

  double within(const Json& block, const std::string& pointer, const char* key, const AllowedRange& range,
                double otherwise) const {
    const double x = number_or(block, pointer, key, Allowed::any, otherwise);
    if (!(x >= range.low && x <= range.high))
      fail(below(pointer, key), "is " + shown(block[key]) + "; expected " + number_text(range.low) + " to " +
                                    number_text(range.high) + " " + range.unit);
    return x;
  }

  std::string law(const Json& block, const std::string& pointer,
                  std::initializer_list<const char*> laws) const {
    std::string expected;
    for (const char* name : laws) expected += (expected.empty() ? "\"" : " or \"") + std::string(name) + "\"";
    if (!block.contains("law")) fail(pointer + "/law", "is missing; expected " + expected);
    for (const char* name : laws) {
      if (block["law"].is_string() && block["law"].get<std::string>() == name) return name;
    }
    fail(pointer + "/law", "is " + shown(block["law"]) + "; expected " + expected);
  }

  void read_supply(const Json& block, Model& model) const {
    object(block, "/supply");
    only(block, "/supply", {"nominal_V", "uncertainty"});
    SupplyModel supply;
    supply.nominal_V = number(block, "/supply", "nominal_V", Allowed::positive);
    model.supply = supply;
  }

  void read_current(const Json& block, Model& model) const {
    const std::string here = "/current";
    object(block, here);
    if (law(block, here, {"ohmic", "thesis"}) == "ohmic") {
      only(block, here, {"law", "resistance_ohm", "tempco_per_K", "reference_C", "uncertainty"});
      OhmicCurrentModel ohmic;
      ohmic.resistance_ohm = number(block, here, "resistance_ohm", Allowed::positive);
      ohmic.tempco_per_K = within(block, here, "tempco_per_K", tempco_per_K, 0.0);
      ohmic.reference_C = within(block, here, "reference_C", temperature_C, 25.0);
      model.current = ohmic;
      return;
    }
    only(block, here,
         {"law", "slope_V2_mA_per_K", "slope_V1_mA_per_K", "slope_V0_mA_per_K", "base_mA", "exponent",
          "minimum_V_rms", "uncertainty"});
    ThesisCurrentModel thesis;
    thesis.slope_V2_mA_per_K = number(block, here, "slope_V2_mA_per_K", Allowed::any);
    thesis.slope_V1_mA_per_K = number(block, here, "slope_V1_mA_per_K", Allowed::any);
    thesis.slope_V0_mA_per_K = number(block, here, "slope_V0_mA_per_K", Allowed::any);
    thesis.base_mA = number(block, here, "base_mA", Allowed::any);
    thesis.exponent = number(block, here, "exponent", Allowed::any);
    thesis.minimum_V_rms =
        number_or(block, here, "minimum_V_rms", Allowed::not_negative, thesis.minimum_V_rms);
    model.current = thesis;
  }

  void read_thermal(const Json& block, Model& model) const {
    const std::string here = "/thermal";
    object(block, here);
    if (law(block, here, {"lumped", "thesis"}) == "lumped") {
      only(block, here, {"law", "heat_capacity_J_per_K", "conductance_W_per_K", "uncertainty"});
      LumpedThermalModel lumped;
      lumped.heat_capacity_J_per_K = number(block, here, "heat_capacity_J_per_K", Allowed::positive);
      lumped.conductance_W_per_K = number(block, here, "conductance_W_per_K", Allowed::positive);
      model.thermal = lumped;
      return;
    }
    only(block, here,
         {"law", "cooling_per_min", "rinv_slope_V1", "rinv_slope_V0", "rinv_offset_V1", "rinv_offset_V0",
          "minimum_V_rms", "uncertainty"});
    ThesisThermalModel thesis;
    thesis.cooling_per_min = number(block, here, "cooling_per_min", Allowed::positive);
    thesis.rinv_slope_V1 = number(block, here, "rinv_slope_V1", Allowed::any);
    thesis.rinv_slope_V0 = number(block, here, "rinv_slope_V0", Allowed::any);
    thesis.rinv_offset_V1 = number(block, here, "rinv_offset_V1", Allowed::any);
    thesis.rinv_offset_V0 = number(block, here, "rinv_offset_V0", Allowed::any);
    thesis.minimum_V_rms =
        number_or(block, here, "minimum_V_rms", Allowed::not_negative, thesis.minimum_V_rms);
    model.thermal = thesis;
  }

  void read_axis(const Json& block, Model& model) const {
    const std::string here = "/axis";
    object(block, here);
    const bool voltage_driven = law(block, here, {"rigid", "voltage"}) == "voltage";
    std::vector<std::string> keys{"law", "inertia_kgm2", "viscous_Nms_per_rad", "torque_constant_Nm_per_A"};
    if (voltage_driven) keys.emplace_back("resistance_ohm");
    keys.emplace_back("uncertainty");
    only(block, here, keys);
    RigidAxisModel axis;
    axis.inertia_kgm2 = number(block, here, "inertia_kgm2", Allowed::positive);
    axis.viscous_Nms_per_rad = number(block, here, "viscous_Nms_per_rad", Allowed::not_negative);
    axis.torque_constant_Nm_per_A = number(block, here, "torque_constant_Nm_per_A", Allowed::not_zero);
    if (voltage_driven) axis.resistance_ohm = number(block, here, "resistance_ohm", Allowed::positive);
    model.axis = axis;
  }

  void read_servo(const Json& block, Model& model) const {
    const std::string here = "/servo";
    object(block, here);
    const auto common = [&](auto& servo) {
      servo.limit_A = number(block, here, "limit_A", Allowed::positive);
      servo.period_s = number(block, here, "period_s", Allowed::positive);
      servo.delay_s = number_or(block, here, "delay_s", Allowed::not_negative, 0.0);
      servo.slew_A_per_s = number_or(block, here, "slew_A_per_s", Allowed::not_negative, 0.0);
    };
    if (law(block, here, {"position_pid", "velocity_pi"}) == "position_pid") {
      only(block, here,
           {"law", "kp_A_per_deg", "kd_A_s_per_deg", "ki_A_per_deg_s", "limit_A", "period_s", "delay_s",
            "slew_A_per_s", "dead_zone_deg", "profile_dps", "profile_dps2", "uncertainty"});
      PositionPidServo servo;
      servo.kp_A_per_deg = number(block, here, "kp_A_per_deg", Allowed::not_zero);
      servo.kd_A_s_per_deg = number_or(block, here, "kd_A_s_per_deg", Allowed::any, 0.0);
      servo.ki_A_per_deg_s = number_or(block, here, "ki_A_per_deg_s", Allowed::any, 0.0);
      servo.dead_zone_deg = number_or(block, here, "dead_zone_deg", Allowed::not_negative, 0.0);
      servo.profile_dps = number_or(block, here, "profile_dps", Allowed::not_negative, 0.0);
      servo.profile_dps2 = number_or(block, here, "profile_dps2", Allowed::not_negative, 0.0);
      common(servo);
      model.servo = servo;
      return;
    }
    only(block, here,
         {"law", "kp_A_s_per_deg", "ki_A_per_deg", "limit_A", "period_s", "delay_s", "slew_A_per_s",
          "uncertainty"});
    VelocityPiServo servo;
    servo.kp_A_s_per_deg = number(block, here, "kp_A_s_per_deg", Allowed::not_zero);
    servo.ki_A_per_deg = number_or(block, here, "ki_A_per_deg", Allowed::any, 0.0);
    common(servo);
    model.servo = servo;
  }

  void read_heater(const Json& block, Model& model) const {
    const std::string here = "/heater";
    object(block, here);
    const std::string name = law(block, here, {"klipper_pid", "marlin_pid", "bang_bang"});
    const auto common = [&](auto& heater) {
      heater.max_power = number_or(block, here, "max_power", Allowed::positive, heater.max_power);
      heater.period_s = number_or(block, here, "period_s", Allowed::positive, heater.period_s);
      model.heater = heater;
    };
    const auto gains = [&](auto& pid) {
      pid.kp_per_K = number(block, here, "kp_per_K", Allowed::positive);
      pid.ki_per_K_s = number_or(block, here, "ki_per_K_s", Allowed::not_negative, 0.0);
      pid.kd_s_per_K = number_or(block, here, "kd_s_per_K", Allowed::not_negative, 0.0);
    };
    std::vector<std::string> keys{"law", "acts_on", "max_power", "period_s"};
    const auto also = [&](std::initializer_list<const char*> more) {
      keys.insert(keys.end(), more.begin(), more.end());
      only(block, here, keys);
    };
    if (name == "bang_bang") {
      also({"max_delta_K"});
      BangBangHeater heater;
      heater.max_delta_K = number_or(block, here, "max_delta_K", Allowed::not_negative, heater.max_delta_K);
      common(heater);
    } else if (name == "klipper_pid") {
      also({"kp_per_K", "ki_per_K_s", "kd_s_per_K", "smooth_time_s"});
      KlipperPidHeater heater;
      gains(heater);
      heater.smooth_time_s =
          number_or(block, here, "smooth_time_s", Allowed::not_negative, heater.smooth_time_s);
      common(heater);
    } else {
      also({"kp_per_K", "ki_per_K_s", "kd_s_per_K", "functional_range_K"});
      MarlinPidHeater heater;
      gains(heater);
      heater.functional_range_K =
          number_or(block, here, "functional_range_K", Allowed::positive, heater.functional_range_K);
      common(heater);
    }
    if (!block.contains("acts_on")) return;
    if (block["acts_on"] != "recorded" && block["acts_on"] != "simulated")
      fail("/heater/acts_on", "is " + shown(block["acts_on"]) + "; expected \"recorded\" or \"simulated\"");
    model.heater_acts_on =
        block["acts_on"] == "simulated" ? plant::HeaterActsOn::simulated : plant::HeaterActsOn::recorded;
  }

  /// How well the constants of a block are known, as shares of their values.
  void read_uncertainty(const Json& block, const std::string& pointer, const std::string& name,
                        Model& model) const {
    if (!block.contains("uncertainty")) return;
    const Json& list = block["uncertainty"];
    const std::string here = below(pointer, "uncertainty");
    object(list, here);
    std::vector<std::string> constants;
    for (const auto& item : block.items())
      if (item.key() != "law" && item.key() != "uncertainty") constants.push_back(item.key());
    only(list, here, constants);
    for (const auto& item : list.items()) {
      const double share = number(list, here, item.key().c_str(), Allowed::positive);
      if (!(share <= 1.0))
        fail(below(here, item.key()), "is " + number_text(share) + "; expected a share, above 0 to 1");
      model.uncertainty[name + "." + item.key()] = share;
    }
  }

  std::string text(const Json& block, const std::string& pointer, const char* key) const {
    const std::string here = below(pointer, key);
    if (!block.contains(key)) fail(here, "is missing; expected text");
    if (!block[key].is_string()) fail(here, "is " + shown(block[key]) + "; expected text");
    return block[key].get<std::string>();
  }

  /// Calls read(item, pointer, key) for every item of a list, which may be left out.
  template <class Read>
  void each(const Json& block, const std::string& pointer, const char* key, bool named, Read&& read) const {
    if (!block.contains(key)) return;
    const std::string here = below(pointer, key);
    const Json& list = block[key];
    if (named) object(list, here);
    else if (!list.is_array()) fail(here, "is " + shown(list) + "; expected an array");
    for (const auto& item : list.items()) {
      object(item.value(), below(here, item.key()));
      read(item.value(), below(here, item.key()), item.key());
    }
  }

  /// A thermal network. What is no network is said with the pointer to what is wrong in it.
  void read_network(const Json& root, Model& model) const {
    const std::string here = "/network";
    for (const char* other : {"supply", "current", "thermal", "axis", "servo", "heater"})
      if (root.contains(other)) fail(below("", other), "stands beside a network; expected one or the other");
    const Json& block = root["network"];
    object(block, here);
    only(block, here, {"nodes", "given", "links", "heat"});
    plant::ThermalNetwork network;
    each(block, here, "nodes", true, [&](const Json& one, const std::string& at, const std::string& name) {
      only(one, at, {"heat_capacity_J_per_K", "column", "initial_C", "uncertainty"});
      plant::NetworkNode node{name, number(one, at, "heat_capacity_J_per_K", Allowed::positive)};
      if (one.contains("column")) node.column = text(one, at, "column");
      if (one.contains("initial_C")) node.initial_C = within(one, at, "initial_C", temperature_C, 0.0);
      network.nodes.push_back(std::move(node));
    });
    each(block, here, "given", true, [&](const Json& one, const std::string& at, const std::string& name) {
      only(one, at, {"column", "otherwise_C"});
      plant::GivenTemperature given{name, text(one, at, "column")};
      if (one.contains("otherwise_C")) given.otherwise_C = within(one, at, "otherwise_C", temperature_C, 0.0);
      network.given.push_back(std::move(given));
    });
    each(block, here, "links", false, [&](const Json& one, const std::string& at, const std::string&) {
      only(one, at, {"from", "to", "conductance_W_per_K", "uncertainty"});
      network.links.push_back({text(one, at, "from"), text(one, at, "to"),
                               number(one, at, "conductance_W_per_K", Allowed::positive)});
    });
    each(block, here, "heat", false, [&](const Json& one, const std::string& at, const std::string&) {
      const bool wound = one.contains("resistance_ohm") || one.contains("node");
      std::vector<std::string> keys{"column", "shares"};
      if (wound)
        keys.insert(keys.end(), {"node", "resistance_ohm", "tempco_per_K", "reference_C", "uncertainty"});
      only(one, at, keys);
      plant::NetworkHeat heat{text(one, at, "column"), {}};
      if (wound) {
        plant::NetworkWinding winding{text(one, at, "node"),
                                      number(one, at, "resistance_ohm", Allowed::positive)};
        winding.tempco_per_K = within(one, at, "tempco_per_K", tempco_per_K, 0.0);
        winding.reference_C = within(one, at, "reference_C", temperature_C, 25.0);
        heat.winding = winding;
      }
      if (one.contains("shares")) {
        object(one["shares"], below(at, "shares"));
        for (const auto& share : one["shares"].items())
          heat.shares[share.key()] =
              number(one["shares"], below(at, "shares"), share.key().c_str(), Allowed::not_negative);
      } else if (wound) {
        heat.shares[heat.winding->node] = 1.0;
      } else {
        fail(below(at, "shares"), "is missing; expected the nodes that the heat warms, and their shares");
      }
      network.heat.push_back(std::move(heat));
    });
    // Two given temperatures may drive it; one alone is where it rests.
    if (network.heat.empty() && network.given.size() < 2)
      fail(below(here, "heat"),
           "is missing; expected at least one source of heat: nothing heats this network");
    if (const auto problem = network.validate()) fail(here + "/" + problem->where, problem->what);
    std::string name = std::move(model.name);
    model = plant::network_model(network, std::move(name));
    read_network_uncertainty(block, network, model);
  }

  /// How well its constants are known: each is called after its node or link in the model.
  void read_network_uncertainty(const Json& block, const plant::ThermalNetwork& network, Model& model) const {
    const auto take = [&](const Json& one, const std::string& at, const std::string& field,
                          const std::string& constant) {
      Model read;
      read_uncertainty(one, at, "", read);
      const auto found = read.uncertainty.find("." + field);
      if (found != read.uncertainty.end()) model.uncertainty[constant] = found->second;
      for (const auto& other : read.uncertainty)
        if (other.first != "." + field && field != "resistance_ohm" && field != "tempco_per_K")
          fail(below(below(at, "uncertainty"), other.first.substr(1)),
               "is not a constant; expected " + field);
    };
    each(block, "/network", "nodes", true,
         [&](const Json& one, const std::string& at, const std::string& name) {
           take(one, at, "heat_capacity_J_per_K", "nodes." + name + "_J_per_K");
         });
    std::size_t next = 0;
    each(block, "/network", "links", false, [&](const Json& one, const std::string& at, const std::string&) {
      const plant::NetworkLink& link = network.links[next++];
      take(one, at, "conductance_W_per_K", "links." + link.from + "_to_" + link.to + "_W_per_K");
    });
    each(block, "/network", "heat", false, [&](const Json& one, const std::string& at, const std::string&) {
      for (const char* field : {"resistance_ohm", "tempco_per_K"})
        take(one, at, field, std::string("heat.") + field);
    });
  }

  void read_effects(const Json& block, Model& model) const {
    object(block, "/effects");
    const Catalogue* own = model.own ? model.own->equations->effects() : nullptr;
    for (const auto& item : block.items()) {
      const std::string here = below("/effects", item.key());
      const auto& list = own != nullptr ? own->list() : catalogue_.list();
      const auto info =
          std::find_if(list.begin(), list.end(), [&](const EffectInfo& one) { return one.id == item.key(); });
      if (info == list.end()) {
        std::vector<std::string> ids;
        for (const EffectInfo& one : list) ids.push_back(one.id);
        const std::string nearest = nearest_name(item.key(), ids);
        fail(here,
             "no such effect in the catalogue; " +
                 (nearest.empty() ? std::string("expected") : "did you mean " + nearest + "? Expected") +
                 " an id that 'thermopower-gap effects" + (own != nullptr ? " --model' lists" : "' lists"));
      }
      object(item.value(), here);
      std::vector<std::string> names;
      for (const auto& parameter : info->parameters) names.push_back(parameter.name);
      names.push_back("uncertainty");
      only(item.value(), here, names);
      read_uncertainty(item.value(), here, "effects." + item.key(), model);
      EffectParameters& parameters = model.effects[item.key()];
      for (const auto& parameter : info->parameters) {
        const bool left_out = parameter.standard && !item.value().contains(parameter.name);
        const double value =
            left_out ? *parameter.standard : number(item.value(), here, parameter.name.c_str(), Allowed::any);
        if (!(value >= parameter.lower && value <= parameter.upper)) {
          fail(below(here, parameter.name),
               "is " + number_text(value) + "; expected " + number_text(parameter.lower) + " to " +
                   number_text(parameter.upper) + (parameter.unit == "1" ? "" : " " + parameter.unit));
        }
        parameters[parameter.name] = value;
      }
    }
  }

  std::string file_;
  std::string text_;  ///< all of it, once it is known to be JSON
  const Catalogue& catalogue_;
};

/// The block of a thermal network, with a model's constants.
Json network_block(const plant::ThermalNetwork& network, const std::map<std::string, double>& uncertainty) {
  const auto known = [&](Json& block, const char* field, const std::string& constant) {
    const auto found = uncertainty.find(constant);
    if (found != uncertainty.end()) block["uncertainty"][field] = found->second;
  };
  Json block = Json::object();
  for (const plant::NetworkNode& node : network.nodes) {
    Json one{{"heat_capacity_J_per_K", node.heat_capacity_J_per_K}};
    if (!node.column.empty()) one["column"] = node.column;
    if (node.initial_C) one["initial_C"] = *node.initial_C;
    known(one, "heat_capacity_J_per_K", "nodes." + node.name + "_J_per_K");
    block["nodes"][node.name] = std::move(one);
  }
  for (const plant::GivenTemperature& given : network.given) {
    block["given"][given.name]["column"] = given.column;
    if (given.otherwise_C) block["given"][given.name]["otherwise_C"] = *given.otherwise_C;
  }
  for (const plant::NetworkLink& link : network.links) {
    Json one{{"from", link.from}, {"to", link.to}, {"conductance_W_per_K", link.conductance_W_per_K}};
    known(one, "conductance_W_per_K", "links." + link.from + "_to_" + link.to + "_W_per_K");
    block["links"].push_back(std::move(one));
  }
  for (const plant::NetworkHeat& heat : network.heat) {
    Json one{{"column", heat.column}};
    for (const auto& [node, share] : heat.shares) one["shares"][node] = share;
    if (heat.winding) {
      one["node"] = heat.winding->node;
      one["resistance_ohm"] = heat.winding->resistance_ohm;
      one["tempco_per_K"] = heat.winding->tempco_per_K;
      one["reference_C"] = heat.winding->reference_C;
      known(one, "resistance_ohm", "heat.resistance_ohm");
      known(one, "tempco_per_K", "heat.tempco_per_K");
    }
    block["heat"].push_back(std::move(one));
  }
  return block;
}

}  // namespace

Model parse_model(const std::string& name, const std::string& text, const Catalogue& catalogue) {
  return ModelReader(name, catalogue).read(text);
}

Model read_model(const std::string& path, const Catalogue& catalogue) {
  if (path == "-")
    throw InputError(path + ": a model is not read from standard input; expected a model file (JSON)");
  const OpenFile file = open_input(path, "a model file (JSON)");
  std::string text(largest_file + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  if (std::ferror(file.get())) throw InputError(path + ": cannot be read: " + std::strerror(errno));
  if (text.size() > largest_file)
    throw InputError(path + ": larger than 1 MiB; expected a model file (JSON)");
  if (text.empty()) throw InputError(path + ": the file is empty; expected a model file (JSON)");
  return parse_model(path, text, catalogue);
}

std::string to_json(const Model& model) {
  Json root;
  root["format"] = format_id;
  root["name"] = model.name;
  if (std::holds_alternative<OhmicCurrentModel>(model.current)) root["current"]["law"] = "ohmic";
  if (std::holds_alternative<ThesisCurrentModel>(model.current)) root["current"]["law"] = "thesis";
  if (std::holds_alternative<LumpedThermalModel>(model.thermal)) root["thermal"]["law"] = "lumped";
  if (std::holds_alternative<ThesisThermalModel>(model.thermal)) root["thermal"]["law"] = "thesis";
  if (model.axis) root["axis"]["law"] = model.axis->voltage_driven() ? "voltage" : "rigid";
  if (std::holds_alternative<PositionPidServo>(model.servo)) root["servo"]["law"] = "position_pid";
  if (std::holds_alternative<VelocityPiServo>(model.servo)) root["servo"]["law"] = "velocity_pi";
  if (std::holds_alternative<KlipperPidHeater>(model.heater)) root["heater"]["law"] = "klipper_pid";
  if (std::holds_alternative<MarlinPidHeater>(model.heater)) root["heater"]["law"] = "marlin_pid";
  if (std::holds_alternative<BangBangHeater>(model.heater)) root["heater"]["law"] = "bang_bang";
  if (model.heater_acts_on != plant::HeaterActsOn::usual)
    root["heater"]["acts_on"] =
        model.heater_acts_on == plant::HeaterActsOn::simulated ? "simulated" : "recorded";
  const auto* network =
      model.own ? dynamic_cast<const plant::NetworkPlant*>(model.own->equations.get()) : nullptr;
  if (network != nullptr) root["network"] = network_block(network->network_of(model), model.uncertainty);
  else
    for (const auto& constant : model.constants()) root[constant.block][constant.name] = constant.value;
  for (const auto& [id, parameters] : model.effects) {
    root["effects"][id] = Json::object();
    for (const auto& [name, value] : parameters) root["effects"][id][name] = value;
  }
  for (const auto& [name, share] : model.uncertainty) {
    const std::size_t dot = name.rfind('.');
    const std::string block = name.substr(0, dot), constant = name.substr(dot + 1);
    if (block.rfind("effects.", 0) == 0) root["effects"][block.substr(8)]["uncertainty"][constant] = share;
    else if (network == nullptr) root[block]["uncertainty"][constant] = share;
  }
  return root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace thermopower::io
