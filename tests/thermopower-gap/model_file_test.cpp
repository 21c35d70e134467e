// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"
#include "input_error_of.hpp"

#include <thermopower/io/model_file.hpp>

#include <thermopower/plant/standard_catalogue.hpp>

using namespace thermopower::gap;
namespace io = thermopower::io;

namespace {

const std::string ohmic =
    R"("current": {"law": "ohmic", "resistance_ohm": 8.2, "tempco_per_K": 0.00393, "reference_C": 25.0})";
const std::string lumped =
    R"("thermal": {"law": "lumped", "heat_capacity_J_per_K": 60.0, "conductance_W_per_K": 0.11})";

std::string model_text(const std::string& body) {
  return "{\"format\": \"thermopower-model/1\", " + body + "}";
}
Model parse(const std::string& text) { return io::parse_model("model.json", text, standard_catalogue()); }

std::string error_of(const std::string& text) {
  return test::input_error_of([&] { parse(text); });
}

}  // namespace

TEST_CASE("a model file gives the model it says") {
  const Model model = parse(
      model_text("\"name\": \"m\", \"supply\": {\"nominal_V\": 13}, " + ohmic + ", " + lumped +
                 ", \"axis\": {\"law\": \"rigid\", \"inertia_kgm2\": 1e-3, \"viscous_Nms_per_rad\": 0, "
                 "\"torque_constant_Nm_per_A\": -0.2}, \"effects\": {\"coulomb_friction\": {\"Nm\": 0.01}}"));
  CHECK(model.name == "m");
  CHECK(model.get("nominal_V") == 13.0);
  CHECK(model.get("resistance_ohm") == 8.2);
  CHECK(model.get("conductance_W_per_K") == 0.11);
  CHECK(model.get("torque_constant_Nm_per_A") == -0.2);
  CHECK(model.effects.at("coulomb_friction").at("Nm") == 0.01);
  CHECK(model.effects.at("coulomb_friction").at("transition_rad_per_s") ==
        0.01);  // its standard value: it was left out
}

TEST_CASE("the thesis's laws are read for current and temperature") {
  const Model model = parse(model_text(
      R"("current": {"law": "thesis", "slope_V2_mA_per_K": -0.0134, "slope_V1_mA_per_K": 0.0156, "slope_V0_mA_per_K": 0.0167,
          "base_mA": 0.1551, "exponent": 3.4591},
         "thermal": {"law": "thesis", "cooling_per_min": 0.11, "rinv_slope_V1": -0.0002, "rinv_slope_V0": 0.0062,
          "rinv_offset_V1": 0.0255, "rinv_offset_V0": -0.105, "minimum_V_rms": 1.0})"));
  CHECK(model.get("current.minimum_V_rms") == 1.0);
  CHECK(model.get("slope_V2_mA_per_K") == -0.0134);
  CHECK(model.get("rinv_offset_V0") == -0.105);
}

TEST_CASE("the loop of a heater is read, and written as it was") {
  const std::string body = "\"supply\": {\"nominal_V\": 24}, " + ohmic + ", " + lumped;
  const auto with = [&](const std::string& heater) { return model_text(body + ", \"heater\": " + heater); };
  const Model klipper =
      parse(with(R"({"law": "klipper_pid", "kp_per_K": 20, "ki_per_K_s": 0.4, "max_power": 0.8})"));
  CHECK(klipper.get("heater.kp_per_K") == 20.0);
  CHECK(klipper.get("heater.kd_s_per_K") == 0.0);
  CHECK(klipper.get("heater.period_s") == 0.3);
  CHECK(klipper.simulates_heater_loop());
  const Model marlin = parse(with(R"({"law": "marlin_pid", "kp_per_K": 20, "acts_on": "recorded"})"));
  CHECK(marlin.get("heater.functional_range_K") == 10.0);
  CHECK_FALSE(marlin.simulates_heater_loop());
  const Model bang = parse(with(R"({"law": "bang_bang", "max_delta_K": 0.5, "period_s": 5})"));
  CHECK(bang.get("heater.max_delta_K") == 0.5);
  CHECK_FALSE(bang.simulates_heater_loop());
  for (const Model& one : {klipper, marlin, bang})
    CHECK(io::to_json(parse(io::to_json(one))) == io::to_json(one));
  CHECK_THAT(error_of(with(R"({"law": "pid"})")),
             ContainsSubstring(
                 "/heater/law: is \"pid\"; expected \"klipper_pid\" or \"marlin_pid\" or \"bang_bang\""));
  CHECK_THAT(error_of(with(R"({"law": "bang_bang", "kp_per_K": 1})")),
             ContainsSubstring("/heater/kp_per_K: unknown key"));
  CHECK_THAT(error_of(with(R"({"law": "bang_bang", "max_power": 2})")),
             ContainsSubstring("heater.max_power is above 1"));
  CHECK_THAT(error_of(with(R"({"law": "bang_bang", "acts_on": "both"})")),
             ContainsSubstring("/heater/acts_on: is \"both\"; expected \"recorded\" or \"simulated\""));
}

TEST_CASE("an axis at a voltage and the servos are read, and written as they were") {
  const std::string axis =
      R"("axis": {"law": "voltage", "inertia_kgm2": 1e-3, "viscous_Nms_per_rad": 0, "torque_constant_Nm_per_A": 0.2,
          "resistance_ohm": 2.5})";
  const std::string position =
      R"("servo": {"law": "position_pid", "kp_A_per_deg": 0.04, "ki_A_per_deg_s": 0.1, "limit_A": 2, "period_s": 0.005})";
  const std::string velocity =
      R"("servo": {"law": "velocity_pi", "kp_A_s_per_deg": 0.01, "ki_A_per_deg": 0.1, "limit_A": 2, "period_s": 0.005,
          "delay_s": 0.003, "uncertainty": {"kp_A_s_per_deg": 0.2}})";
  const Model pid = parse(model_text(axis + ", " + position));
  CHECK(pid.axis->voltage_driven());
  CHECK(pid.get("axis.resistance_ohm") == 2.5);
  CHECK(pid.get("servo.kp_A_per_deg") == 0.04);
  CHECK(pid.get("servo.kd_A_s_per_deg") == 0.0);
  CHECK(pid.get("servo.period_s") == 0.005);
  const Model pi = parse(model_text(axis + ", " + velocity));
  CHECK(pi.get("servo.delay_s") == 0.003);
  CHECK(pi.uncertainty.at("servo.kp_A_s_per_deg") == 0.2);
  for (const Model& model : {pid, pi}) CHECK(io::to_json(parse(io::to_json(model))) == io::to_json(model));
  CHECK_THAT(error_of(model_text(axis + R"(, "servo": {"law": "pid"})")),
             ContainsSubstring("/servo/law: is \"pid\"; expected \"position_pid\" or \"velocity_pi\""));
  CHECK_THAT(error_of(model_text(position)), ContainsSubstring("expected both"));
}

TEST_CASE("writing and reading gives back the same numbers, bit by bit") {
  Model model = parse(model_text(ohmic + ", " + lumped));
  model.set("resistance_ohm", 8.2000000000000028);
  model.effects["second_thermal_mass"] = {{"winding_share", 0.1 + 0.2}, {"coupling", 1.0 / 3.0}};
  model.uncertainty = {{"current.resistance_ohm", 0.02}, {"effects.second_thermal_mass.coupling", 0.3}};
  const Model again = parse(io::to_json(model));
  CHECK(again.uncertainty == model.uncertainty);
  CHECK(again.get("resistance_ohm") == 8.2000000000000028);
  CHECK(again.effects == model.effects);
  CHECK(io::to_json(again) == io::to_json(model));
}

TEST_CASE("what a model file may not hold is named by its JSON pointer") {
  struct Case {
    std::string text;
    std::vector<std::string> parts;
  };
  const std::vector<Case> cases = {
      {"", {"model.json:1:1: not JSON"}},
      {"{\n \"format\": 1,,\n}", {"model.json:2:14: not JSON"}},
      {"[]", {"model.json: ", "array at the top", "expected an object"}},
      {"{}", {"/format: is missing", "\"thermopower-model/1\""}},
      {R"({"format": "thermopower-model/2"})",
       {"/format: is \"thermopower-model/2\"", "expected \"thermopower-model/1\""}},
      {model_text(ohmic + ", \"thermals\": {}"), {"/thermals: unknown key", "expected one of", "thermal"}},
      {model_text("\"name\": 3, " + ohmic), {"/name: is 3; expected text"}},
      {model_text("\"supply\": 12, " + ohmic), {"/supply: is 12; expected an object"}},
      {model_text("\"supply\": {\"nominal_V\": 0}, " + ohmic),
       {"/supply/nominal_V: is 0; expected a number above 0"}},
      {model_text(R"("current": {"law": "cubic"})"),
       {"/current/law: is \"cubic\"", "\"ohmic\" or \"thesis\""}},
      {model_text(R"("current": {"resistance_ohm": 8})"), {"/current/law: is missing"}},
      {model_text(R"("current": {"law": "ohmic", "resistance_ohm": -3})"),
       {"/current/resistance_ohm: is -3; expected a number above 0"}},
      {model_text(R"("current": {"law": "ohmic", "resistance_ohm": "8"})"),
       {"/current/resistance_ohm: is \"8\"; expected a number above 0"}},
      {model_text(R"("current": {"law": "ohmic"})"), {"/current/resistance_ohm: is missing"}},
      {model_text(R"("current": {"law": "ohmic", "resistance_ohm": 8, "resistanse": 8})"),
       {"/current/resistanse: unknown key"}},
      {model_text(R"("current": {"law": "ohmic", "resistance_ohm": 8, "resistance_ohm": 9})"),
       {"/current/resistance_ohm: this key appears twice"}},
      {model_text(R"("thermal": {"law": "lumped", "heat_capacity_J_per_K": 60, "conductance_W_per_K": 0})"),
       {"/thermal/conductance_W_per_K: is 0; expected a number above 0"}},
      {model_text(
           R"("axis": {"law": "rigid", "inertia_kgm2": 1, "viscous_Nms_per_rad": -1, "torque_constant_Nm_per_A": 1})"),
       {"/axis/viscous_Nms_per_rad: is -1; expected a number, 0 or more"}},
      {model_text(
           R"("axis": {"law": "rigid", "inertia_kgm2": 1, "viscous_Nms_per_rad": 1, "torque_constant_Nm_per_A": 0})"),
       {"/axis/torque_constant_Nm_per_A: is 0; expected a number other than 0"}},
      {model_text(
           R"("axis": {"law": "voltage", "inertia_kgm2": 1, "viscous_Nms_per_rad": 1, "torque_constant_Nm_per_A": 1})"),
       {"/axis/resistance_ohm: is missing; expected a number above 0"}},
      {model_text(
           R"("axis": {"law": "rigid", "inertia_kgm2": 1, "viscous_Nms_per_rad": 1, "torque_constant_Nm_per_A": 1, "resistance_ohm": 1})"),
       {"/axis/resistance_ohm: unknown key"}},
      {model_text(ohmic + R"(, "effects": {"gremlins": {}})"),
       {"/effects/gremlins: no such effect", "thermopower-gap effects"}},
      {model_text(ohmic + R"(, "effects": {"a/b": {}})"), {"/effects/a~1b: no such effect"}},
      {model_text(ohmic + R"(, "effects": {"coulomb_friction": {}})"),
       {"/effects/coulomb_friction/Nm: is missing"}},
      {model_text(ohmic + R"(, "effects": {"coulomb_friction": {"Nm": 1e9}})"),
       {"/effects/coulomb_friction/Nm: is 1e+09; expected 0 to"}},
      {model_text(ohmic + R"(, "effects": {"coulomb_friction": {"Nm": 0.1, "nm": 0.1}})"),
       {"/effects/coulomb_friction/nm: unknown key"}},
      {model_text(R"("current": {"law": "ohmic", "resistance_ohm": 1e999})"),
       {"model.json:1:85: /current/resistance_ohm: '1e999' is too large", "expected a finite number"}},
      {model_text(
           R"("current": {"law": "ohmic", "resistance_ohm": 8, "uncertainty": {"resistance_ohm": 2}})"),
       {"/current/uncertainty/resistance_ohm: is 2; expected a share"}},
      {model_text(
           R"("current": {"law": "ohmic", "resistance_ohm": 8, "uncertainty": {"tempco_per_K": 0.1}})"),
       {"/current/uncertainty/tempco_per_K: unknown key"}},
      {model_text("\"name\": \"nothing in it\""), {"model.json: ", "none of the blocks"}},
  };
  for (const auto& one : cases) {
    const std::string message = error_of(one.text);
    CAPTURE(one.text, message);
    CHECK_THAT(message, ContainsSubstring("model.json"));
    for (const auto& part : one.parts) CHECK_THAT(message, ContainsSubstring(part));
  }
}

TEST_CASE("what is no readable model file is told apart") {
  CHECK_THROWS_WITH(io::read_model("/", standard_catalogue()),
                    ContainsSubstring("is a directory; expected a model file"));
  CHECK_THROWS_WITH(io::read_model("/no such file", standard_catalogue()),
                    ContainsSubstring("cannot be read"));
}
