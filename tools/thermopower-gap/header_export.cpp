// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "header_export.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>
#include <vector>

namespace thermopower::gap::files {
namespace {

std::string literal(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  std::string out = text;
  if (out.find_first_of(".e") == std::string::npos) out += ".0";
  return out + "f";
}

// Names of files and effects end up in comments and identifiers: neither may break the code.
std::string one_line(const std::string& text) {
  std::string out;
  for (const char c : text) out += static_cast<unsigned char>(c) < 0x20 || c == '\\' ? ' ' : c;
  return out;
}

std::string identifier(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (out.empty() || std::isdigit(static_cast<unsigned char>(out[0])) != 0) out.insert(0, "p_");
  return out;
}

class Writer {
public:
  Writer(const Model& model, const std::string& origin) : m_(model), origin_(origin) {}

  std::string write() {
    out_ = "// Written by thermopower-gap: " + one_line(origin_) + "\n#pragma once\n\n";
    if (m_.has_current() || m_.has_thermal()) out_ += "#include <thermopower/thermopower.hpp>\n\n";
    out_ += "namespace motor_model {\n\n";
    out_ += "/// " + one_line(m_.name.empty() ? "The motor" : m_.name) +
            ", with what the diagnosis found.\nstruct Motor {\n";
    current();
    thermal();
    axis();
    leftovers();
    out_ += "};\n\n}  // namespace motor_model\n";
    return std::move(out_);
  }

private:
  double parameter(const char* effect, const char* name, double otherwise = 0.0) {
    const auto found = m_.effects.find(effect);
    if (found == m_.effects.end()) return otherwise;
    used_.insert(effect);
    const auto value = found->second.find(name);
    return value == found->second.end() ? otherwise : value->second;
  }
  bool has(const char* effect) const { return m_.effects.count(effect) != 0; }

  void function(const char* comment, const std::string& name, double value) {
    out_ += std::string("  /// ") + comment + "\n  static float " + name + "() { return " + literal(value) +
            "; }\n";
  }

  void current() {
    if (!m_.has_current()) return;
    const double series = parameter("series_resistance", "ohm");
    if (const auto* ohmic = std::get_if<OhmicCurrentModel>(&m_.current)) {
      // A resistance in series and R(T) are together a resistance with a smaller temperature coefficient,
      // exactly.
      const double total = ohmic->resistance_ohm + series;
      const double tempco =
          (ohmic->tempco_per_K + parameter("winding_tempco", "tempco_per_K")) * ohmic->resistance_ohm / total;
      out_ +=
          "  typedef thermopower::CurrentModel<thermopower::OhmicCurrent<float> > Current;  ///< Current law.\n";
      out_ += "  /// Constants for `Current`" +
              std::string(series > 0.0 ? ", the resistance in series included.\n" : ".\n");
      out_ += "  static Current::Config current() {\n    Current::Config law = {" + literal(total) + ", " +
              literal(tempco) + ", " + literal(ohmic->reference_C) + "};\n    return law;\n  }\n";
    } else {
      const auto& thesis = std::get<ThesisCurrentModel>(m_.current);
      out_ +=
          "  typedef thermopower::CurrentModel<thermopower::ThesisCurrent<float> > Current;  ///< Current law.\n";
      out_ +=
          "  /// Constants for `Current`.\n  static Current::Config current() {\n    return thermopower::ThesisCurrent<float>::from_milliampere(" +
          literal(thesis.slope_V2_mA_per_K) + ", " + literal(thesis.slope_V1_mA_per_K) + ", " +
          literal(thesis.slope_V0_mA_per_K) + ", " + literal(thesis.base_mA) + ", " +
          literal(thesis.exponent) + ", " + literal(thesis.minimum_V_rms) + ");\n  }\n";
    }
    voltage();
    function("Resistance outside of the motor's body: it drops volts and heats nothing, ohm.", "series_ohm",
             series);
    if (has("current_sensor_gain") || has("current_sensor_offset")) {
      out_ +=
          "  /// The true current behind a sensor's reading, A.\n  static float true_current_A(float reading_A) { return (reading_A - " +
          literal(parameter("current_sensor_offset", "A")) + ") / " +
          literal(parameter("current_sensor_gain", "gain", 1.0)) + "; }\n";
    }
  }

  // The voltage that, given to the current law, yields the current that flows.
  void voltage() {
    const double lost = parameter("dead_time", "duty_lost"), emf = parameter("back_emf", "V_s_per_rad");
    const double internal = parameter("supply_sag", "internal_ohm"),
                 slope = parameter("supply_sag", "V_per_Ah");
    out_ +=
        "  /// Voltage for the current law and the heating, V: after dead time, sag, discharge and back-EMF as far as they were found.\n"
        "  /// @param duty        commanded, 0 .. 1\n"
        "  /// @param charge_Ah   drawn from the supply since it was full\n"
        "  /// @param rate_rad_s  of the motor\n"
        "  static float v_rms_V(float duty, float supply_V, float winding_C, float charge_Ah, float rate_rad_s) {\n";
    out_ +=
        lost != 0.0 ? "    duty = duty > " + literal(lost) + " ? duty - " + literal(lost) + " : 0.0f;\n" : "";
    if (slope != 0.0) {
      out_ += "    supply_V -= " + literal(slope) + " * charge_Ah;\n";
    } else {
      out_ += "    (void)charge_Ah;\n";
    }
    out_ += "    float v_rms = supply_V * sqrtf(duty);\n";
    if (emf != 0.0) {
      out_ += "    v_rms -= " + literal(emf) + " * (rate_rad_s < 0.0f ? -rate_rad_s : rate_rad_s);\n";
    } else {
      out_ += "    (void)rate_rad_s;\n";
    }
    if (internal != 0.0 && std::holds_alternative<OhmicCurrentModel>(m_.current)) {
      out_ += "    const float ohm = current().resistance_at(winding_C);\n    v_rms *= ohm / (ohm + " +
              literal(internal) + " * duty);\n";
    } else {
      out_ += "    (void)winding_C;\n";
    }
    out_ += "    return v_rms > 0.0f ? v_rms : 0.0f;\n  }\n";
  }

  void thermal() {
    if (const auto* lumped = std::get_if<LumpedThermalModel>(&m_.thermal)) {
      lumped_thermal(*lumped);
    } else if (const auto* thesis = std::get_if<ThesisThermalModel>(&m_.thermal)) {
      out_ +=
          "  typedef thermopower::ThermalModel<thermopower::ThesisHeating<float>, thermopower::RateCooling<float>,\n"
          "                                    thermopower::LinearizedStep> Thermal;  ///< Thermal model.\n"
          "  /// Constants for `Thermal`.\n  static Thermal::Config thermal() {\n    Thermal::Config config = {\n"
          "        thermopower::ThesisHeating<float>::per_minute(" +
          literal(thesis->rinv_slope_V1) + ", " + literal(thesis->rinv_slope_V0) + ", " +
          literal(thesis->rinv_offset_V1) + ", " + literal(thesis->rinv_offset_V0) + ", " +
          literal(thesis->minimum_V_rms) + "),\n        thermopower::RateCooling<float>::per_minute(" +
          literal(thesis->cooling_per_min) + ")};\n    return config;\n  }\n";
    } else {
      return;
    }
    heat();
    out_ +=
        "  /// Temperature of the air that the motor feels, degC, from what its sensor says.\n  static float air_C(float measured_C) { return measured_C + " +
        literal(parameter("ambient_bias", "bias_K")) + "; }\n";
    if (has("thermometer_gain")) {
      out_ +=
          "  /// The true temperature behind a thermometer's reading, degC.\n  static float true_motor_C(float reading_C, float measured_air_C) {\n"
          "    return measured_air_C + (reading_C - measured_air_C) / " +
          literal(parameter("thermometer_gain", "gain", 1.0)) + ";\n  }\n";
    }
    if (has("thermometer_lag"))
      function("Time constant of the thermometer, s: its reading follows the motor that much later.",
               "thermometer_lag_s", parameter("thermometer_lag", "lag_s"));
  }

  void lumped_thermal(const LumpedThermalModel& lumped) {
    const std::string g = literal(lumped.conductance_W_per_K);
    if (has("second_thermal_mass")) {
      const double share = parameter("second_thermal_mass", "winding_share");
      out_ +=
          "  typedef thermopower::TwoNodeThermalModel<float> Thermal;  ///< Thermal model: winding and body.\n"
          "  /// Constants for `Thermal`.\n  static Thermal::Config thermal() {\n    Thermal::Config config = {" +
          literal(share * lumped.heat_capacity_J_per_K) + ", " +
          literal((1.0 - share) * lumped.heat_capacity_J_per_K) + ", " +
          literal(parameter("second_thermal_mass", "coupling")) + ", {" + g +
          "}};\n    return config;\n  }\n";
      return;
    }
    std::string type = "thermopower::NewtonCooling<float>", value = "{" + g + "}";
    if (has("natural_convection")) {
      type = "thermopower::NaturalConvection<float>";
      value = "{" + g + ", " + literal(parameter("natural_convection", "exponent")) + ", " +
              literal(parameter("natural_convection", "reference_K")) + "}";
    } else if (has("forced_airflow")) {
      type = "thermopower::ForcedAirflow<float>";
      value = "{" + g + ", " + literal(parameter("forced_airflow", "gain")) + ", " +
              literal(parameter("forced_airflow", "exponent")) + "}";
    }
    if (has("radiation")) {
      type = "thermopower::SumOfCooling<" + type + ", thermopower::RadiationCooling<float> >";
      value = "{" + value + ", {" + literal(parameter("radiation", "emissive_area_m2")) + ", 1.0f}}";
    }
    out_ +=
        "  typedef " + type +
        " Cooling;  ///< How the heat leaves.\n"
        "  typedef thermopower::ThermalModel<thermopower::HeatCapacityHeating<float>, Cooling, thermopower::LinearizedStep> Thermal;  ///< Thermal model.\n"
        "  /// Constants for `Thermal`.\n  static Thermal::Config thermal() {\n    Thermal::Config config = {{" +
        literal(lumped.heat_capacity_J_per_K) + "}, " + value + "};\n    return config;\n  }\n";
  }

  void heat() {
    const double series = has("series_resistance") ? m_.effects.at("series_resistance").at("ohm") : 0.0;
    const double share = parameter("supply_power_heating", "share"),
                 motion = parameter("motion_heating", "W_s2_per_rad2");
    const double coupling = parameter("neighbour_heating", "coupling");
    out_ +=
        "  /// Heat into the motor for `Thermal::step`, W: what the winding turns into heat, and what was found besides.\n"
        "  static float heat_W(float v_rms, float current_A, float supply_V, float motor_C, float neighbour_C, float rate_rad_s) {\n"
        "    float heat = v_rms * current_A;\n";
    if (series != 0.0) out_ += "    heat -= " + literal(series) + " * current_A * current_A;\n";
    if (share != 0.0) {
      out_ += "    heat += " + literal(share) + " * (supply_V - v_rms) * current_A;\n";
    } else {
      out_ += "    (void)supply_V;\n";
    }
    if (motion != 0.0) {
      out_ += "    heat += " + literal(motion) + " * rate_rad_s * rate_rad_s;\n";
    } else {
      out_ += "    (void)rate_rad_s;\n";
    }
    if (coupling != 0.0) {
      out_ += "    heat += " + literal(coupling) + " * (neighbour_C - motor_C);\n";
    } else {
      out_ += "    (void)neighbour_C;\n    (void)motor_C;\n";
    }
    out_ += "    return heat;\n  }\n";
  }

  void axis() {
    if (!m_.axis) return;
    function("Inertia of the axis, kg m^2.", "inertia_kgm2", m_.axis->inertia_kgm2);
    function("Viscous friction, N m s/rad.", "viscous_Nms_per_rad", m_.axis->viscous_Nms_per_rad);
    function("Torque per ampere, N m/A.", "torque_constant_Nm_per_A", m_.axis->torque_constant_Nm_per_A);
  }

  void leftovers() {
    static const std::set<std::string> exclusive = {"natural_convection", "forced_airflow", "radiation"};
    for (const auto& [id, parameters] : m_.effects) {
      if (used_.count(id) != 0) continue;
      out_ += std::string("  // ") +
              (exclusive.count(id) != 0 ? "No policy combines this one with the others found; its constants:"
                                        : "No policy of the library; its constants:") +
              " " + one_line(id) + "\n";
      for (const auto& [name, value] : parameters) {
        out_ += "  static float " + identifier(id) + "_" + identifier(name) + "() { return " +
                literal(value) + "; }\n";
      }
    }
  }

  const Model& m_;
  const std::string& origin_;
  std::set<std::string> used_;
  std::string out_;
};

}  // namespace

std::string motor_model_header(const Model& model, const std::string& origin) {
  return Writer(model, origin).write();
}

}  // namespace thermopower::gap::files
