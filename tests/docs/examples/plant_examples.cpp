// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The examples on the pages of models, plants, effects and their scalars, and what each of them must give.

#include "../../catch.hpp"

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/finding.hpp>
#include <thermopower/gap/pool/log_result.hpp>
#include <thermopower/gap/pool/mixed_effects.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/goal_profile.hpp>
#include <thermopower/plant/heater_loop.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/bench_rollout.hpp>
#include <thermopower/plant/exchange_step.hpp>
#include <thermopower/plant/free_play.hpp>
#include <thermopower/plant/gimbal_joints.hpp>
#include <thermopower/plant/network_plant.hpp>
#include <thermopower/plant/network_step.hpp>
#include <thermopower/plant/servo_loop.hpp>
#include <thermopower/plant/state_plant.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace gap = thermopower::gap;
namespace plant = thermopower::plant;

namespace {

//! [effect of one's own]
/// Friction that a seal makes while it is cold.
struct ColdSeal {
  enum Parameters { Nm, fades_at_C };
  static plant::EffectInfo info() {
    using namespace thermopower::plant;
    return {"cold_seal",
            Submodel::mechanical_friction,
            "friction += Nm exp(-(T / fades_at_C))",
            "A seal is stiff while it is cold.",
            // Each a Parameter, made by a ParameterBuilder: its unit, its bounds, where a fit starts.
            {parameter(Nm, "Nm").unit("N m").within(0.0, 1.0).starts({0.0}),
             parameter(fades_at_C, "fades_at_C").unit("degC").within(1.0, 200.0).starts({30.0})},
            {Need::axis_model},
            "reversals from cold to warm"};
  }
  template <class Scalar>
  static void act(const Scalar* p, plant::FrictionTerms<Scalar>& terms) {
    using std::exp;
    const Scalar size_Nm = p[Nm] * exp(-terms.motor_C / p[fades_at_C]);
    terms.add_friction(size_Nm, size_Nm, plant::constant<Scalar>(0.01));
  }
};
//! [effect of one's own]

//! [joint]
/// A seal to simulators of bodies, which know no temperature: the friction that it has in the cold.
void in_a_joint(const double* p, plant::JointDescription& joint) {
  joint.friction_Nm += p[ColdSeal::Nm];
  joint.remarks.push_back({{ColdSeal::fades_at_C}, "here it is always cold"});
}
//! [joint]

/// A share of the heat capacity behind the surface, as the catalogue's second and third mass have it.
struct Mount {
  static plant::EffectInfo info() {
    return {"mount",
            plant::Submodel::thermal_storage,
            "a node behind the surface",
            "A mount soaks up heat.",
            {},
            {},
            "heat"};
  }
  //! [thermal structure]
  template <class Scalar>
  static void act(const Scalar*, plant::ThermalStructure<Scalar>& structure) {
    structure.soaking_share = plant::constant<Scalar>(0.3);    // of the heat capacity
    structure.soaking_W_per_K = plant::constant<Scalar>(0.1);  // to the surface
  }
  //! [thermal structure]
};

gap::Recording heated(const gap::Model&) {
  //! [recording]
  gap::Recording recording;
  recording.name = "bench";
  recording.t_s = Eigen::VectorXd::LinSpaced(601, 0.0, 600.0);
  recording.set("power_param", Eigen::VectorXd::Constant(601, 150.0));
  recording.set("ambient_C", Eigen::VectorXd::Constant(601, 24.0));
  recording.set("motor_C", Eigen::VectorXd::Constant(601, 25.0));
  recording.set("current_A", Eigen::VectorXd::Constant(601, 1.0));
  const bool has_supply = recording.has("supply_V");  // it has not: the model's nominal one counts
  //! [recording]
  REQUIRE_FALSE(has_supply);
  return recording;
}

gap::Model motor() {
  //! [model]
  plant::Model model;
  model.name = "motor";
  model.supply = plant::SupplyModel{12.0};                       // V
  model.current = plant::OhmicCurrentModel{6.0, 0.00393, 25.0};  // ohm, 1/K, degC
  model.thermal = plant::LumpedThermalModel{60.0, 0.2};          // J/K, W/K
  model.set("thermal.conductance_W_per_K", 0.25);                // any constant by its name
  for (const plant::CalibratedConstant& constant : model.calibrated()) (void)constant;  // what a fit may move
  //! [model]
  REQUIRE_FALSE(model.validate().has_value());
  return model;
}

}  // namespace

TEST_CASE("a model, a recording, a simulation") {
  const gap::Model model = motor();
  CHECK(model.get("conductance_W_per_K") == 0.25);
  CHECK(model.calibrated().size() == 4);  // resistance and its rise, heat capacity, conductance
  const gap::Recording recording = heated(model);
  //! [simulate]
  const gap::SimulationOptions whole_runs = {gap::SimulationMode::free_running, 0.0};
  for (const gap::SimulatedSignal& signal : gap::simulate(model, recording, whole_runs))
    if (signal.signal == plant::Signal::motor_C) CHECK(signal.values[600] > 30.0);
  //! [simulate]

  //! [axis model]
  plant::Model axis;
  axis.name = "axis";
  axis.axis = plant::RigidAxisModel{1e-3, 1e-3, 0.1};  // kg m^2, N m s/rad, N m/A
  //! [axis model]
  CHECK_FALSE(axis.axis->voltage_driven());
  CHECK(axis.has_axis());
}

TEST_CASE("what an effect is to simulators of bodies") {
  const double parameters[] = {0.3, 40.0};
  plant::JointDescription joint;
  in_a_joint(parameters, joint);
  CHECK(joint.friction_Nm == 0.3);
  REQUIRE(joint.remarks.size() == 1);
  CHECK(joint.remarks[0].parameters == std::vector<int>{1});
}

TEST_CASE("a catalogue of one's own") {
  //! [catalogue]
  plant::Catalogue catalogue = plant::standard_catalogue();  // or an empty one: only these are suspected
  catalogue.add<ColdSeal>();
  const plant::CatalogueEntry* entry = catalogue.find("cold_seal");
  const plant::HookSet& hooks = entry->hooks;  // where it acts
  //! [catalogue]
  REQUIRE(entry != nullptr);
  CHECK(hooks.friction);
  CHECK(hooks.any_axis());
  CHECK_FALSE(hooks.any_bench());
  CHECK(catalogue.list().size() == plant::standard_catalogue().list().size() + 1);
  catalogue.add<Mount>();
  CHECK(catalogue.find("mount")->hooks.thermal_structure);
}

TEST_CASE("a plant, as a fit sees it: rows, segments, a rollout, readings") {
  const gap::Model model = motor();
  const gap::Recording recording = heated(model);
  //! [rollout]
  const plant::Inputs inputs = gap::engine::prepare(model, recording);  // rows, cut into runs: each a RunSpan
  const plant::Plant& its_plant =
      plant::plant_of(model);  // ActuatorPlant; OwnPlant where the model has one of its own
  std::vector<plant::Segment> segments;
  its_plant.cut(inputs, 0.0, segments);  // whole runs
  const plant::ParameterPoint as_it_is;  // no factor on any constant, no further effect
  const std::unique_ptr<plant::Rollout> rollout = its_plant.rollout(
      model, plant::standard_catalogue(), as_it_is, plant::Directions(), plant::SimulationMode::free_running);
  plant::Readings readings;
  const int signals = static_cast<int>(its_plant.signals(segments[0]).size());
  readings.reset(segments[0].begin, segments[0].end, signals, 0);
  rollout->roll(segments[0], plant::Start::Zero(its_plant.start_size(segments[0])), readings);
  //! [rollout]
  REQUIRE(segments.size() == 1);
  CHECK(inputs.runs[0].size() == 601);

  //! [charge]
  // Half an ampere for an hour, at full power, in two runs of one recording: the second one goes on from the first.
  const Eigen::VectorXd t_s = Eigen::VectorXd::LinSpaced(61, 0.0, 3600.0),
                        current_A = Eigen::VectorXd::Constant(61, 0.5),
                        power_param = Eigen::VectorXd::Constant(61, 255.0);
  std::vector<plant::RunSpan> runs{{0, 40, "day"}, {40, 61, "day", true}};
  plant::RecordedCharge(t_s, current_A, power_param).tell(runs);
  //! [charge]
  CHECK(runs[0].drawn_Ah == 0.0);
  CHECK(runs[1].drawn_Ah == Approx(0.5 * 40.0 / 60.0));

  //! [unknown command]
  // A command that switched at some time between its second row and the third, and may be early or late by a tenth of a row.
  plant::UnknownCommand unknown;
  unknown.between = Eigen::Vector3d(0.0, 0.029, 0.0);
  unknown.shift = Eigen::Vector3d(0.0, 0.01, 0.0);
  const double off_A = unknown.error(1, -1.0);  // where it switched a standard deviation late
  //! [unknown command]
  CHECK(unknown.any());
  CHECK(off_A == Approx(-0.019));
  CHECK_FALSE(plant::UnknownCommand().any());
  bool is_warm = false;
  for (int signal = 0; signal < signals; ++signal) is_warm = is_warm || readings.value(600, signal) > 30.0;
  CHECK(is_warm);

  //! [bench rollout]
  // The equations of a motor on a bench, stepped from row to row; AxisRollout is the same of an axis, by an AxisStep,
  // with a ServoLoop where the model has a servo, and a LateTarget where its target comes late.
  const plant::Instance<double> instance(model, {}, {}, plant::standard_catalogue());
  const plant::BenchRollout<double> bench(instance, inputs);
  plant::BenchState<double> state = bench.start(0, 25.0);  // all nodes at 25 degC
  double motor_C = 0.0;
  bench.run(0, inputs.rows(), 0.0, state,
            [&](Eigen::Index, const plant::BenchReadings<double>& read) { motor_C = read.motor_C; });
  //! [bench rollout]
  CHECK(motor_C > 30.0);
}

TEST_CASE("a servo's gains") {
  //! [servo gains]
  plant::ServoGains<double> gains{true, 0.02,  0.002, 0.0,
                                  2.0,  0.005, 0.0};                   // A/deg, A s/deg; limit, period, delay
  const double command_A = gains.command_A(9.0, 0.0, 10.0, 0.0, 0.0);  // a degree short of the target
  //! [servo gains]
  CHECK(command_A == Approx(0.02));
}

TEST_CASE("a heater's loop") {
  //! [heater loop]
  plant::HeaterLoop<double> loop(plant::BangBangHeater{2.0, 1.0, 0.3});  // on and off 2 K around the target
  loop.start(24.0, 60.0, 0.0);                                           // cold, target 60 degC
  loop.sample(57.0, 60.0);
  const double below = loop.duty();
  loop.sample(62.5, 60.0);
  const double above = loop.duty();
  //! [heater loop]
  CHECK(below == 1.0);
  CHECK(above == 0.0);
}

TEST_CASE("the set point of a servo") {
  //! [goal profile]
  plant::GoalProfile profile(90.0, 300.0, 0.0);  // deg/s, deg/s^2, at rest at 0 deg
  profile.go(45.0, 0.2, 0.005);                  // 0.2 s towards 45 deg, in steps of 5 ms
  const double speeding_up_deg = profile.deg(), dps = profile.dps();
  profile.go(45.0, 2.0, 0.005);
  //! [goal profile]
  CHECK(speeding_up_deg == Approx(0.5 * 300.0 * 0.2 * 0.2).margin(0.5));
  CHECK(dps == Approx(60.0).margin(0.1));
  CHECK(profile.deg() == Approx(45.0));
}

TEST_CASE("scalars: one that carries derivatives, one that writes itself down") {
  //! [dual]
  static_assert(std::is_same_v<plant::Dual, plant::DualOf<12>>);  // derivatives in twelve directions
  plant::Dual volt(6.0);
  volt.seed(0);                                   // varies with direction 0
  const plant::Dual heat_W = volt * volt / 12.0;  // of 12 ohm
  const double per_volt = heat_W.slope(0);        // d heat / d volt
  //! [dual]
  CHECK(heat_W.value() == 3.0);
  CHECK(per_volt == Approx(2.0 * 6.0 / 12.0));

  //! [expression]
  plant::Trace trace;
  const plant::Expression current = trace.symbol("current_A");
  const plant::Expression loss = current * current * 12.0;  // nodes of the trace: an equation
  const plant::Condition is_high = current > plant::Expression(2.0);
  //! [expression]
  CHECK_FALSE(loss.is_constant());
  CHECK(loss.trace() == &trace);
  CHECK(is_high.trace() == &trace);
  CHECK(plant::Expression(2.0).is_constant());
}

TEST_CASE("names that others may add to, and a value per signal") {
  //! [open name]
  const plant::SubmodelName known = plant::Submodel::electrical;  // an OpenName<Submodel>
  const plant::SubmodelName own("tank.outflow");                  // of a plant of one's own
  //! [open name]
  CHECK(known.known());
  CHECK_FALSE(own.known());

  //! [per signal]
  plant::PerSignal<double> noise(2, 0.1);  // of two signals
  noise[static_cast<plant::Signal>(1)] = 0.5;
  //! [per signal]
  CHECK(noise.count() == 2);
  CHECK(noise[static_cast<plant::Signal>(0)] == 0.1);
}

TEST_CASE("steps of exchanging nodes, and the matrix of three joints") {
  //! [exchange step]
  // Two nodes that exchange 0.1 and 0.02 of their difference a second, without loss: over 1000 s they are alike.
  plant::ExchangeStep<double> step(0.1, 0.02, 0.0);
  step.set_length(1000.0);
  const auto moved = step.moved(step.exchanged({60.0, 30.0}));  // from 60 and 30 degC
  //! [exchange step]
  CHECK(60.0 + moved.winding == Approx(30.0 + moved.surface));
  CHECK(moved.winding * 0.02 + moved.surface * 0.1 ==
        Approx(0.0).margin(1e-9));  // what one loses the other has

  //! [network step]
  plant::NetworkStep<double, 5> network(2);
  network.link(0, 1, 0.1, 0.02);
  network.set_length(1.0);
  const auto slopes = network.solved({-3.0, 0.6});
  //! [network step]
  const double gamma = 1.0 - 1.0 / std::sqrt(2.0);
  CHECK(slopes[0] * (1.0 + gamma * 0.1) - slopes[1] * gamma * 0.1 == Approx(-3.0));

  //! [joint matrix]
  plant::JointMatrix<double> inertia;
  inertia.yaw = 3.0;
  inertia.roll = 2.0;
  inertia.pitch = 1.0;
  inertia.roll_pitch = 0.5;
  const auto accelerations = inertia.solve(inertia.times({1.0, -2.0, 3.0}));  // yaw, roll, pitch
  //! [joint matrix]
  CHECK(accelerations[0] == Approx(1.0));
  CHECK(accelerations[1] == Approx(-2.0));
  CHECK(accelerations[2] == Approx(3.0));
}

TEST_CASE("a motor on a frame as a network of its parts") {
  //! [thermal network]
  plant::ThermalNetwork body;
  body.nodes = {{"winding", 22.0, "winding_C"},  // J/K, and the column of its thermometer
                {"stator", 95.0},                // nobody measures it
                {"frame", 420.0, "frame_C"},
                {"mount", 1500.0}};
  body.given = {{"air", "ambient_C"}};       // what the body does not change
  body.links = {{"winding", "stator", 0.9},  // W/K
                {"stator", "frame", 1.6},
                {"frame", "mount", 1.1},
                {"frame", "air", 0.35},
                {"mount", "air", 1.3}};
  // I^2 R of the winding's temperature: 90 % where the wire is, the rest in the teeth.
  body.heat = {
      {"current_A", {{"winding", 0.9}, {"stator", 0.1}}, plant::NetworkWinding{"winding", 0.8, 0.00393}}};
  const plant::Model model =
      plant::network_model(body, "motor on a frame");  // of a NetworkPlant; throws where it is no network
  //! [thermal network]
  CHECK(model.get("stator_to_frame_W_per_K") == 1.6);
  CHECK_FALSE(body.validate());

  //! [network effects]
  std::vector<std::string> ids;
  for (const plant::NetworkEffect& effect : plant::network_effects(body)) ids.push_back(effect.info.id);
  //! [network effects]
  for (const char* id :
       {"winding_to_frame_link", "stator_to_air_link", "frame_radiation", "frame_natural_convection",
        "frame_hidden_mass", "winding_thermometer_bias", "air_bias", "air_drift", "frame_share_of_current_A"})
    CHECK(std::count(ids.begin(), ids.end(), id) == 1);
  CHECK(std::count(ids.begin(), ids.end(), "winding_to_stator_link") == 0);  // the network has it

  // The equations by themselves: 5 A for a second, from 25 degC everywhere.
  //! [network equations]
  const std::vector<double> constants{22.0, 95.0, 420.0, 1500.0, 0.9, 1.6, 1.1, 0.35, 1.3, 0.8, 0.00393};
  const plant::NetworkTerms<double> terms = plant::network_terms(body, constants);
  plant::NetworkIntegrator<double> integrator(terms);
  plant::NetworkIntegrator<double>::Nodes node_C{25.0, 25.0, 25.0, 25.0};
  const double inputs[] = {25.0, 5.0};  // air, current
  integrator.advance(node_C, inputs, 0.0, 1.0);
  //! [network equations]
  CHECK(node_C[0] == Approx(25.0 + 0.9 * 20.0 / 22.0).epsilon(2e-3));
}

TEST_CASE("a gimbal's joints, and what its simulation may lack") {
  //! [gimbal]
  plant::Model model = plant::gimbal_model("gimbal");  // the plant is GimbalJoints
  model.set("pitch_inertia_kgm2", 1.171e-3);
  // Effects of that plant: GimbalCoupling, GimbalProducts<body>, CameraImbalance, ArmImbalance, YawImbalance, and of each joint
  // JointFriction<joint> and JointCable<joint>.
  model.effects[plant::GimbalCoupling::info().id] = {{"camera_z_less_x_kgm2", 8.77e-4}};
  //! [gimbal]
  const plant::Catalogue* effects = plant::plant_of(model).effects();
  REQUIRE(effects != nullptr);
  for (const std::string& id :
       {plant::GimbalCoupling::info().id, plant::GimbalProducts<plant::GimbalBody::camera>::info().id,
        plant::CameraImbalance::info().id, plant::ArmImbalance::info().id, plant::YawImbalance::info().id})
    CHECK(effects->find(id) != nullptr);
}

TEST_CASE("what a fleet's reports say together") {
  //! [fleet]
  namespace pool = thermopower::gap::pool;
  // Three units, each with its own estimate of one coordinate and how sure it is of it.
  const pool::MixedEffects fleet =
      pool::fit_mixed_effects({{Eigen::VectorXd::Constant(1, 1.0), Eigen::MatrixXd::Constant(1, 1, 0.01)},
                               {Eigen::VectorXd::Constant(1, 1.2), Eigen::MatrixXd::Constant(1, 1, 0.01)},
                               {Eigen::VectorXd::Constant(1, 0.8), Eigen::MatrixXd::Constant(1, 1, 0.01)}});
  // fleet.mean, and fleet.between: how much units differ
  pool::LogResult log;  // a report, as the pool keeps it
  pool::FittedExplanation weighed;
  weighed.name = "backlash";
  log.ranking.push_back(weighed);
  const pool::FittedExplanation* backlash = log.find("backlash");
  //! [fleet]
  CHECK(fleet.mean[0] == Approx(1.0));
  CHECK(fleet.between(0, 0) >= 0.0);
  CHECK(backlash == &log.ranking[0]);
}

TEST_CASE("a finding says which rows it is about") {
  //! [finding]
  gap::Finding
      finding;  // in Diagnosis::findings: what is wrong with the data, before anything is said of the model
  finding.rows = {{10, 20}, {50, 55}};
  const Eigen::Index rows = finding.row_count();
  //! [finding]
  CHECK(rows == 15);
}

TEST_CASE("teeth transmit at the ends of their play, and never pull") {
  //! [free play]
  const plant::FreePlay<double> teeth{0.02, 50.0, 0.1};  // rad, N m per rad, N m s per rad
  const double twist_rad = 0.012, closing_rad_per_s = 0.5;
  const int end = teeth.touching(twist_rad, closing_rad_per_s);              // 1
  const double torque_Nm = teeth.torque(end, twist_rad, closing_rad_per_s);  // 50 * 0.002 + 0.1 * 0.5
  const int parting = teeth.touching(twist_rad, -2.0);                       // 0: they would have to pull
  //! [free play]
  CHECK(end == 1);
  CHECK(torque_Nm == Approx(0.15));
  CHECK(parting == 0);
  CHECK(teeth.touching(-0.012, -0.5) == -1);
  CHECK(teeth.torque(-1, -0.012, -0.5) == Approx(-0.15));
  CHECK(teeth.touching(0.009, 3.0) == 0);
}
