// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A thermal network as a file: read, written, refused, and written down as firmware.
#include "../catch.hpp"
#include "input_error_of.hpp"

#include <thermopower/gap/simulate.hpp>
#include <thermopower/io/header_export.hpp>
#include <thermopower/io/model_file.hpp>
#include <thermopower/io/predictions_file.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace thermopower::gap;
namespace io = thermopower::io;

namespace {

/// Lines are counted below: the first is 1.
const std::string file = R"({"format": "thermopower-model/1", "name": "motor on a frame",
 "network": {
  "nodes": {
   "winding": {"heat_capacity_J_per_K": 22, "column": "winding_C"},
   "stator": {"heat_capacity_J_per_K": 95, "initial_C": 31.5},
   "frame": {"heat_capacity_J_per_K": 420, "column": "frame_C", "uncertainty": {"heat_capacity_J_per_K": 0.2}}},
  "given": {
   "air": {"column": "ambient_C", "otherwise_C": 22.5}},
  "links": [
   {"from": "winding", "to": "stator", "conductance_W_per_K": 0.9},
   {"from": "stator", "to": "frame", "conductance_W_per_K": 1.6, "uncertainty": {"conductance_W_per_K": 0.3}},
   {"from": "frame", "to": "air", "conductance_W_per_K": 0.35}],
  "heat": [
   {"column": "current_A", "node": "winding", "resistance_ohm": 0.8, "tempco_per_K": 0.00393,
    "uncertainty": {"resistance_ohm": 0.1}},
   {"column": "iron_W", "shares": {"stator": 0.75, "frame": 0.25}}]},
 "effects": {
  "frame_radiation": {"emissive_area_m2": 0.05}}})";

std::string with(const std::string& part, const std::string& by) {
  const auto at = file.find(part);
  REQUIRE(at != std::string::npos);
  return std::string(file).replace(at, part.size(), by);
}

Model parse(const std::string& text) { return io::parse_model("model.json", text, standard_catalogue()); }

std::string error_of(const std::string& text) {
  return test::input_error_of([&] { parse(text); });
}

}  // namespace

TEST_CASE("a file of a network gives the network it says") {
  const Model model = parse(file);
  CHECK(model.name == "motor on a frame");
  REQUIRE(model.own);
  CHECK(model.get("winding_J_per_K") == 22.0);
  CHECK(model.get("links.winding_to_stator_W_per_K") == 0.9);
  CHECK(model.get("frame_to_air_W_per_K") == 0.35);
  CHECK(model.get("resistance_ohm") == 0.8);
  CHECK(model.get("tempco_per_K") == 0.00393);
  CHECK(model.effects.at("frame_radiation").at("emissive_area_m2") == 0.05);
  double known = 0.0;
  for (const auto& constant : model.calibrated()) {
    const double share = model.uncertainty_of(constant);
    known += share == 0.05 ? 1.0 : 0.0;
    if (constant.id == "frame_J_per_K") CHECK(share == 0.2);
    if (constant.id == "stator_to_frame_W_per_K") CHECK(share == 0.3);
    if (constant.id == "resistance_ohm") CHECK(share == 0.1);
  }
  CHECK(known == 5.0);  // two capacities, two conductances and the tempco
}

TEST_CASE(
    "a network that is written is the one that was read, bit by bit, with the constants it has by then") {
  Model model = parse(file);
  model.set("winding_to_stator_W_per_K", 0.1 + 0.2);
  model.set("tempco_per_K", 1.0 / 3.0);
  const Model again = parse(io::to_json(model));
  REQUIRE(again.constants().size() == model.constants().size());
  for (std::size_t i = 0; i < model.constants().size(); ++i) {
    CHECK(again.constants()[i].name == model.constants()[i].name);
    CHECK(again.constants()[i].value == model.constants()[i].value);
  }
  CHECK(again.uncertainty == model.uncertainty);
  CHECK(again.effects == model.effects);
  CHECK(io::to_json(again) == io::to_json(model));
  CHECK(io::to_json(again).find("\"initial_C\": 31.5") != std::string::npos);
  CHECK(io::to_json(again).find("\"otherwise_C\": 22.5") != std::string::npos);
}

TEST_CASE("what is wrong with a network's file is told with its place and its line") {
  struct Case {
    std::string text, place;
    std::string line;
    std::string says;
  };
  const std::vector<Case> cases = {
      {with("\"nodes\"", "\"node\""), "/network/node:", "(line 3)",
       "unknown key; expected one of nodes, given, links, heat"},
      {with("95", "-95"), "/network/nodes/stator/heat_capacity_J_per_K:", "(line 5)",
       "is -95; expected a number above 0"},
      {with("95", "\"95\""), "/network/nodes/stator/heat_capacity_J_per_K:", "(line 5)",
       "expected a number above 0"},
      {with("\"heat_capacity_J_per_K\": 95, ", ""),
       "/network/nodes/stator/heat_capacity_J_per_K:", "(line 5)", "is missing"},
      {with("\"column\": \"frame_C\"", "\"column\": 3"), "/network/nodes/frame/column:", "(line 6)",
       "is 3; expected text"},
      {with("\"frame_C\"", "\"winding_C\""), "/network/nodes/frame/column:", "(line 6)",
       "'winding_C' is there twice"},
      {with("{\"column\": \"ambient_C\", \"otherwise_C\": 22.5}", "{}"),
       "/network/given/air/column:", "(line 8)", "is missing; expected text"},
      {with("\"links\": [", "\"links\": [3, "), "/network/links/0:", "(line 9)", "is 3; expected an object"},
      {with("\"to\": \"stator\"", "\"to\": \"gear\""), "/network/links/0/to:", "(line 10)",
       "'gear' is neither a node nor a given"},
      {with("1.6", "0"), "/network/links/1/conductance_W_per_K:", "(line 11)",
       "is 0; expected a number above 0"},
      {with("\"to\": \"air\"", "\"to\": \"stator\""), "/network/links/2:", "(line 12)", "linked already"},
      {with("{\"conductance_W_per_K\": 0.3}", "{\"from\": 0.3}"),
       "/network/links/1/uncertainty/from:", "(line 11)", "is not a constant"},
      {with("{\"conductance_W_per_K\": 0.3}", "{\"conductance_W_per_K\": 3}"),
       "/network/links/1/uncertainty/", "(line 11)", "is 3; expected a share"},
      {with("\"node\": \"winding\"", "\"node\": \"rotor\""), "/network/heat/0/shares/rotor:", "(line 14)",
       "is no node; expected one of winding, stator, frame"},
      {with("0.75", "0.65"), "/network/heat/1/shares:", "(line 16)", "are 0.9 together; expected 1"},
      {with(", \"shares\": {\"stator\": 0.75, \"frame\": 0.25}", ""), "/network/heat/1/shares:", "(line 16)",
       "is missing"},
      {with("frame_radiation", "mount_radiation"), "/effects/mount_radiation:", "(line 18)",
       "no such effect"},
      {with(" \"network\"", " \"supply\": {\"nominal_V\": 12}, \"network\""), "/supply:", "(line 2)",
       "stands beside a network"},
      {with("\"frame\": {", "\"mount\": {\"heat_capacity_J_per_K\": 9}, \"frame\": {"),
       "/network/nodes/mount:", "(line 6)", "has no link"},
  };
  for (const Case& one : cases) {
    const std::string message = error_of(one.text);
    CAPTURE(one.place, message);
    CHECK(message.find("model.json: " + one.place) == 0);
    CHECK(message.find(one.line) != std::string::npos);
    CHECK(message.find(one.says) != std::string::npos);
  }
}

TEST_CASE("a network that nothing heats is an error that names the missing field") {
  const std::string message = error_of(
      R"({"format": "thermopower-model/1", "network": {"nodes": {"w": {"heat_capacity_J_per_K": 22, "column": "motor_C"}},)"
      R"( "given": {"air": {"column": "ambient_C"}}, "links": [{"from": "w", "to": "air", "conductance_W_per_K": 0.9}]}})");
  CHECK(message.find("/network/heat:") != std::string::npos);
  CHECK(message.find("nothing heats this network") != std::string::npos);
}

TEST_CASE("inputs alone are enough to predict a network, from the air's temperature or where one says") {
  const Model model = parse(file);
  Recording r;
  r.t_s = Eigen::VectorXd::LinSpaced(50, 0.0, 490.0);
  r.set("ambient_C", Eigen::VectorXd::Constant(50, 27.0));
  r.set("current_A", Eigen::VectorXd::Constant(50, 3.0));
  r.set("iron_W", Eigen::VectorXd::Constant(50, 0.0));
  const auto first = [&](const Recording& recording, const std::string& column) {
    for (const auto& one : simulate(model, recording))
      if (to_string(one.signal) == column) return one.values[0];
    return std::nan("");
  };
  CHECK(first(io::with_starts(r, model, {}), "winding_C") == 27.0);
  CHECK(first(io::with_starts(r, model, {}), "frame_C") == 27.0);
  CHECK(first(io::with_starts(r, model, {{"frame_C", 33.0}}), "frame_C") == 33.0);
}

TEST_CASE("the header of a network has its equations, effects and all") {
  Model model = parse(file);
  model.effects = {{"frame_radiation", {{"emissive_area_m2", 0.05}}},
                   {"frame_natural_convection", {{"exponent", 0.25}, {"reference_K", 20.0}}},
                   {"winding_to_frame_link", {{"W_per_K", 0.2}}},
                   {"winding_hidden_mass", {{"J_per_K", 8.0}, {"W_per_K", 0.4}}},
                   {"stator_share_of_current_A", {{"share", 0.1}}},
                   {"air_bias", {{"bias_K", 1.5}}},
                   {"air_drift", {{"K_per_h", 6.0}}},
                   {"frame_thermometer_bias", {{"bias_K", -0.75}}}};
  const io::MotorModelHeader header = io::motor_model_header(model, "a test", standard_catalogue());
  CHECK(header.left_out.empty());
  const auto folder = std::filesystem::temp_directory_path() / "thermopower_network_header";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "motor.hpp") << header.text;
  std::ofstream(folder / "main.cpp") << R"(#include "motor.hpp"
#include <stdio.h>
int main() {
  typedef motor_model::Motor M;
  printf("%.9g %.9g %.9g %.9g %.9g\n", (double)M::winding_K_per_s(80, 60, 45, 70, 25, 4, 5, 1800),
         (double)M::stator_K_per_s(80, 60, 45, 70, 25, 4, 5, 1800), (double)M::frame_K_per_s(80, 60, 45, 70, 25, 4, 5, 1800),
         (double)M::behind_K_per_s(80, 60, 45, 70, 25, 4, 5, 1800), (double)M::frame_reading_C(45));
}
)";
  const std::string quoted = "'" + folder.string() + "'";
  REQUIRE(std::system(("cd " + quoted +
                       " && c++ -std=c++11 -Wall -Wextra -Werror main.cpp -o main && ./main > out.txt")
                          .c_str()) == 0);
  double winding = 0.0, stator = 0.0, frame = 0.0, behind = 0.0, reading = 0.0;
  std::ifstream(folder / "out.txt") >> winding >> stator >> frame >> behind >> reading;
  // The same by hand: 80, 60, 45 and 70 degC, the air recorded with 25 degC, 4 A, 5 W of iron loss, after half an hour.
  const double copper = 16.0 * 0.8 * (1.0 + 0.00393 * 55.0), air = 25.0 + 1.5 + 3.0;
  const double to_stator = 0.9 * 20.0, to_frame = 1.6 * 15.0, past = 0.2 * 35.0, back = 0.4 * 10.0;
  const double convected = 0.35 * (45.0 - air) * std::pow((45.0 - air) / 20.0, 0.25);
  const double radiated = 5.670374419e-8 * 0.05 * (std::pow(318.15, 4.0) - std::pow(air + 273.15, 4.0));
  CHECK(winding == Approx((0.9 * copper - to_stator - past - back) / 22.0).epsilon(1e-5));
  CHECK(stator == Approx((0.1 * copper + 0.75 * 5.0 + to_stator - to_frame) / 95.0).epsilon(1e-5));
  CHECK(frame == Approx((0.25 * 5.0 + to_frame + past - convected - radiated) / 420.0).epsilon(1e-5));
  CHECK(behind == Approx(back / 8.0).epsilon(1e-5));
  CHECK(reading == Approx(44.25));
}
