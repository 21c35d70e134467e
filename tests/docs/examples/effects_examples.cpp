// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The examples on the pages of the catalogue's effects: each, put into a model, changes what the model simulates, and an
// effect of no size changes nothing.

#include "../../catch.hpp"

#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/effects/actuation_delay.hpp>
#include <thermopower/plant/effects/ambient_bias.hpp>
#include <thermopower/plant/effects/angle_bias_drift.hpp>
#include <thermopower/plant/effects/angle_scale.hpp>
#include <thermopower/plant/effects/asymmetric_friction.hpp>
#include <thermopower/plant/effects/asymmetric_viscous.hpp>
#include <thermopower/plant/effects/back_emf.hpp>
#include <thermopower/plant/effects/backlash.hpp>
#include <thermopower/plant/effects/cable_spring.hpp>
#include <thermopower/plant/effects/cogging.hpp>
#include <thermopower/plant/effects/compliance.hpp>
#include <thermopower/plant/effects/constant_torque.hpp>
#include <thermopower/plant/effects/contact_resistance.hpp>
#include <thermopower/plant/effects/coulomb_friction.hpp>
#include <thermopower/plant/effects/current_sensor_gain.hpp>
#include <thermopower/plant/effects/current_sensor_offset.hpp>
#include <thermopower/plant/effects/dead_time.hpp>
#include <thermopower/plant/effects/drive_deadband.hpp>
#include <thermopower/plant/effects/drive_efficiency.hpp>
#include <thermopower/plant/effects/drive_lag.hpp>
#include <thermopower/plant/effects/enclosure.hpp>
#include <thermopower/plant/effects/encoder_eccentricity.hpp>
#include <thermopower/plant/effects/exchanged_heating_law.hpp>
#include <thermopower/plant/effects/forced_airflow.hpp>
#include <thermopower/plant/effects/idle_heat.hpp>
#include <thermopower/plant/effects/imbalance.hpp>
#include <thermopower/plant/effects/iron_loss.hpp>
#include <thermopower/plant/effects/load_friction.hpp>
#include <thermopower/plant/effects/motion_heating.hpp>
#include <thermopower/plant/effects/natural_convection.hpp>
#include <thermopower/plant/effects/neighbour_heating.hpp>
#include <thermopower/plant/effects/presliding_friction.hpp>
#include <thermopower/plant/effects/quadratic_drag.hpp>
#include <thermopower/plant/effects/radiation.hpp>
#include <thermopower/plant/effects/rate_bias.hpp>
#include <thermopower/plant/effects/second_thermal_mass.hpp>
#include <thermopower/plant/effects/series_resistance.hpp>
#include <thermopower/plant/effects/servo_delay.hpp>
#include <thermopower/plant/effects/stribeck_friction.hpp>
#include <thermopower/plant/effects/supply_power_heating.hpp>
#include <thermopower/plant/effects/supply_sag.hpp>
#include <thermopower/plant/effects/target_delay.hpp>
#include <thermopower/plant/effects/thermometer_gain.hpp>
#include <thermopower/plant/effects/thermometer_lag.hpp>
#include <thermopower/plant/effects/third_thermal_mass.hpp>
#include <thermopower/plant/effects/torque_fade.hpp>
#include <thermopower/plant/effects/torque_ripple.hpp>
#include <thermopower/plant/effects/torque_saturation.hpp>
#include <thermopower/plant/effects/unknown_drive.hpp>
#include <thermopower/plant/effects/unknown_friction.hpp>
#include <thermopower/plant/effects/unknown_heat.hpp>
#include <thermopower/plant/effects/unknown_load.hpp>
#include <thermopower/plant/effects/unknown_loss.hpp>
#include <thermopower/plant/effects/unknown_voltage.hpp>
#include <thermopower/plant/effects/warm_friction.hpp>
#include <thermopower/plant/effects/winding_tempco.hpp>

#include <cmath>

using namespace thermopower::gap;
using namespace thermopower::plant;

namespace {

Model bench() {
  Model model;
  model.name = "bench";
  model.supply = SupplyModel{12.0};
  model.current = OhmicCurrentModel{6.0, 0.00393, 25.0};
  model.thermal = LumpedThermalModel{60.0, 0.2};
  return model;
}
Model axis() {
  Model model;
  model.name = "axis";
  model.axis = RigidAxisModel{1e-3, 1e-3, 0.1};
  return model;
}

/// Everything that an effect may ask for; of the outputs a simulation takes the start.
Recording recording_of(const Model& model) {
  const Eigen::Index rows = 400;
  const bool moves = model.has_axis();
  Recording recording;
  recording.name = "inputs";
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, moves ? 3.99 : 798.0);
  const auto wave = [&](double size, double rad_per_s) {
    return Eigen::VectorXd((rad_per_s * recording.t_s.array()).sin() * size);
  };
  const auto level = [&](double value) { return Eigen::VectorXd(Eigen::VectorXd::Constant(rows, value)); };
  if (moves) {
    if (model.has_servo()) recording.set("target_deg", wave(20.0, 2.9));
    else recording.set("drive_A", wave(0.4, 2.9));
    recording.set("motor_C", Eigen::VectorXd::LinSpaced(rows, 28.0, 53.0));
    recording.set("angle_deg", level(0.0));
    recording.set("rate_dps", level(0.0));
  } else {
    recording.set("power_param", Eigen::VectorXd((recording.t_s.array() / 100.0).sin() * 100.0 + 120.0));
    recording.set("ambient_C", level(24.0));
    recording.set("airspeed_mps", level(3.0));
    recording.set("neighbour_C", level(60.0));
    recording.set("rate_dps", level(200.0));
    recording.set("motor_C", level(25.0));
    recording.set("current_A", level(0.5));
  }
  return recording;
}

/// Whether two models simulate something else.
bool acts(const Model& one, const Model& other) {
  const SimulationOptions whole = {SimulationMode::free_running, 0.0};
  const auto a = simulate(one, recording_of(one), whole), b = simulate(other, recording_of(other), whole);
  REQUIRE_FALSE(a.empty());
  REQUIRE(a.size() == b.size());
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::fmax(most, (a[i].values - b[i].values).cwiseAbs().maxCoeff());
  return most > 1e-6;
}

}  // namespace

TEST_CASE("an effect of no size changes nothing") {
  Model model = axis();
  const Model without = model;
  model.effects[ConstantTorque::info().id] = {{"Nm", 0.0}};
  CHECK_FALSE(acts(model, without));
}

TEST_CASE("second_thermal_mass acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [SecondThermalMass]
  model.effects[SecondThermalMass::info().id] = {{"winding_share", 0.25}, {"coupling", 0.6}};
  //! [SecondThermalMass]
  CHECK(acts(model, without));
}

TEST_CASE("third_thermal_mass acts in a simulation") {
  Model model = bench();
  model.effects[SecondThermalMass::info().id] = {{"winding_share", 0.25}, {"coupling", 0.6}};
  const Model without = model;
  //! [ThirdThermalMass]
  model.effects[ThirdThermalMass::info().id] = {{"share", 0.4}, {"coupling", 0.1}};
  //! [ThirdThermalMass]
  CHECK(acts(model, without));
}

TEST_CASE("enclosure acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [Enclosure]
  model.effects[Enclosure::info().id] = {{"share", 0.8}, {"W_per_K", 0.25}};
  //! [Enclosure]
  CHECK(acts(model, without));
}

TEST_CASE("law.exchanged_heating acts in a simulation") {
  Model model = bench();
  model.current = ThesisCurrentModel{0.0, 0.0, -0.5, 10.0, 1.9, 1.0};
  model.thermal = ThesisThermalModel{0.15, 0.0, 0.02, 0.05, 0.3, 1.0};
  const Model without = model;
  //! [ExchangedHeatingLaw]
  model.effects[ExchangedHeatingLaw::info().id] = {};
  //! [ExchangedHeatingLaw]
  CHECK(acts(model, without));
}

TEST_CASE("radiation acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [Radiation]
  model.effects[Radiation::info().id] = {{"emissive_area_m2", 0.02}};
  //! [Radiation]
  CHECK(acts(model, without));
}

TEST_CASE("natural_convection acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [NaturalConvectionEffect]
  model.effects[NaturalConvectionEffect::info().id] = {{"exponent", 0.3}, {"reference_K", 20.0}};
  //! [NaturalConvectionEffect]
  CHECK(acts(model, without));
}

TEST_CASE("forced_airflow acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [ForcedAirflowEffect]
  model.effects[ForcedAirflowEffect::info().id] = {{"gain", 0.2}, {"exponent", 0.7}};
  //! [ForcedAirflowEffect]
  CHECK(acts(model, without));
}

TEST_CASE("ambient_bias acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [AmbientBias]
  model.effects[AmbientBias::info().id] = {{"bias_K", 4.0}};
  //! [AmbientBias]
  CHECK(acts(model, without));
}

TEST_CASE("neighbour_heating acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [NeighbourHeating]
  model.effects[NeighbourHeating::info().id] = {{"coupling", 0.03}};
  //! [NeighbourHeating]
  CHECK(acts(model, without));
}

TEST_CASE("motion_heating acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [MotionHeating]
  model.effects[MotionHeating::info().id] = {{"W_s2_per_rad2", 0.02}};
  //! [MotionHeating]
  CHECK(acts(model, without));
}

TEST_CASE("thermometer_lag acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [ThermometerLag]
  model.effects[ThermometerLag::info().id] = {{"lag_s", 25.0}};
  //! [ThermometerLag]
  CHECK(acts(model, without));
}

TEST_CASE("thermometer_gain acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [ThermometerGain]
  model.effects[ThermometerGain::info().id] = {{"gain", 0.85}};
  //! [ThermometerGain]
  CHECK(acts(model, without));
}

TEST_CASE("supply_power_heating acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [SupplyPowerHeating]
  model.effects[SupplyPowerHeating::info().id] = {{"share", 1.0}};
  //! [SupplyPowerHeating]
  CHECK(acts(model, without));
}

TEST_CASE("supply_sag acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [SupplySag]
  model.effects[SupplySag::info().id] = {{"internal_ohm", 0.4}, {"V_per_Ah", 0.8}};
  //! [SupplySag]
  CHECK(acts(model, without));
}

TEST_CASE("series_resistance acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [SeriesResistance]
  model.effects[SeriesResistance::info().id] = {{"ohm", 1.2}};
  //! [SeriesResistance]
  CHECK(acts(model, without));
}

TEST_CASE("dead_time acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [DeadTime]
  model.effects[DeadTime::info().id] = {{"duty_lost", 0.03}};
  //! [DeadTime]
  CHECK(acts(model, without));
}

TEST_CASE("back_emf acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [BackEmf]
  model.effects[BackEmf::info().id] = {{"V_s_per_rad", 0.15}};
  //! [BackEmf]
  CHECK(acts(model, without));
}

TEST_CASE("current_sensor_offset acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [CurrentSensorOffset]
  model.effects[CurrentSensorOffset::info().id] = {{"A", 0.05}};
  //! [CurrentSensorOffset]
  CHECK(acts(model, without));
}

TEST_CASE("current_sensor_gain acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [CurrentSensorGain]
  model.effects[CurrentSensorGain::info().id] = {{"gain", 1.2}};
  //! [CurrentSensorGain]
  CHECK(acts(model, without));
}

TEST_CASE("winding_tempco acts in a simulation") {
  Model model = bench();
  model.set("tempco_per_K", 0.0);
  const Model without = model;
  //! [WindingTempco]
  model.effects[WindingTempco::info().id] = {{"tempco_per_K", 0.0039}};
  //! [WindingTempco]
  CHECK(acts(model, without));
}

TEST_CASE("coulomb_friction acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [CoulombFriction]
  model.effects[CoulombFriction::info().id] = {{"Nm", 0.008}, {"transition_rad_per_s", 0.01}, {"tail", 0.5}};
  //! [CoulombFriction]
  CHECK(acts(model, without));
}

TEST_CASE("asymmetric_friction acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [AsymmetricFriction]
  model.effects[AsymmetricFriction::info().id] = {
      {"forward_Nm", 0.009}, {"backward_Nm", 0.004}, {"transition_rad_per_s", 0.03}, {"tail", 0.3}};
  //! [AsymmetricFriction]
  CHECK(acts(model, without));
}

TEST_CASE("stribeck_friction acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [StribeckFriction]
  model.effects[StribeckFriction::info().id] = {{"Nm", 0.004},           {"rise_Nm", 0.006},
                                                {"knee_rad_per_s", 0.6}, {"transition_rad_per_s", 0.01},
                                                {"tail", 0.2},           {"exponent", 1.6}};
  //! [StribeckFriction]
  CHECK(acts(model, without));
}

TEST_CASE("load_friction acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [LoadFriction]
  model.effects[LoadFriction::info().id] = {{"share", 0.3}, {"transition_rad_per_s", 0.02}, {"tail", 0.7}};
  //! [LoadFriction]
  CHECK(acts(model, without));
}

TEST_CASE("drive_deadband acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [DriveDeadband]
  model.effects[DriveDeadband::info().id] = {{"A", 0.05}};
  //! [DriveDeadband]
  CHECK(acts(model, without));
}

TEST_CASE("imbalance acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [Imbalance]
  model.effects[Imbalance::info().id] = {{"Nm", 0.006}, {"phase_rad", 0.5}};
  //! [Imbalance]
  CHECK(acts(model, without));
}

TEST_CASE("cogging acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [Cogging]
  model.effects[Cogging::info().id] = {{"sin_Nm", 0.003}, {"cos_Nm", -0.002}, {"cycles_per_turn", 7.0}};
  //! [Cogging]
  CHECK(acts(model, without));
}

TEST_CASE("cable_spring acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [CableSpring]
  model.effects[CableSpring::info().id] = {{"Nm_per_rad", 0.01}, {"centre_rad", 0.4}};
  //! [CableSpring]
  CHECK(acts(model, without));
}

TEST_CASE("compliance acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [Compliance]
  model.effects[Compliance::info().id] = {{"far_share", 0.4}, {"frequency_Hz", 8.0}, {"damping", 0.05}};
  //! [Compliance]
  CHECK(acts(model, without));
}

TEST_CASE("backlash acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [Backlash]
  model.effects[Backlash::info().id] = {
      {"gap_rad", 0.05}, {"far_share", 0.4}, {"contact_Hz", 18.0}, {"damping", 0.2}};
  //! [Backlash]
  CHECK(acts(model, without));
}

TEST_CASE("presliding_friction acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [PreslidingFriction]
  model.effects[PreslidingFriction::info().id] = {{"Nm", 0.003}, {"bend_rad", 0.03}, {"damping_s", 0.002}};
  //! [PreslidingFriction]
  CHECK(acts(model, without));
}

TEST_CASE("actuation_delay acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [ActuationDelay]
  model.effects[ActuationDelay::info().id] = {{"s", 0.0173}};
  //! [ActuationDelay]
  CHECK(acts(model, without));
}

TEST_CASE("servo_delay acts in a simulation") {
  Model model = axis();
  model.servo = PositionPidServo{0.02, 0.002, 0.0, 2.0, 0.005, 0.0};
  const Model without = model;
  //! [ServoDelay]
  model.effects[ServoDelay::info().id] = {{"s", 0.0173}};
  //! [ServoDelay]
  CHECK(acts(model, without));
}

TEST_CASE("torque_saturation acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [TorqueSaturation]
  model.effects[TorqueSaturation::info().id] = {{"A", 0.2}};
  //! [TorqueSaturation]
  CHECK(acts(model, without));
}

TEST_CASE("torque_fade acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [TorqueFade]
  model.effects[TorqueFade::info().id] = {{"per_K", 0.006}};
  //! [TorqueFade]
  CHECK(acts(model, without));
}

TEST_CASE("constant_torque acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [ConstantTorque]
  model.effects[ConstantTorque::info().id] = {{"Nm", 0.004}};
  //! [ConstantTorque]
  CHECK(acts(model, without));
}

TEST_CASE("asymmetric_viscous acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [AsymmetricViscous]
  model.effects[AsymmetricViscous::info().id] = {{"forward_Nms_per_rad", 4e-4},
                                                 {"backward_Nms_per_rad", 1.2e-3}};
  //! [AsymmetricViscous]
  CHECK(acts(model, without));
}

TEST_CASE("torque_ripple acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [TorqueRipple]
  model.effects[TorqueRipple::info().id] = {
      {"sin_share", 0.2}, {"cos_share", -0.1}, {"cycles_per_turn", 6.0}};
  //! [TorqueRipple]
  CHECK(acts(model, without));
}

TEST_CASE("warm_friction acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [WarmFriction]
  model.effects[WarmFriction::info().id] = {{"per_K", 0.02}};
  //! [WarmFriction]
  CHECK(acts(model, without));
}

TEST_CASE("drive_lag acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [DriveLag]
  model.effects[DriveLag::info().id] = {{"lag_s", 0.03}};
  //! [DriveLag]
  CHECK(acts(model, without));
}

TEST_CASE("angle_scale acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [AngleScale]
  model.effects[AngleScale::info().id] = {{"gain", 57.29578}};
  //! [AngleScale]
  CHECK(acts(model, without));
}

TEST_CASE("angle_bias_drift acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [AngleBiasDrift]
  model.effects[AngleBiasDrift::info().id] = {{"deg_per_s", 0.4}};
  //! [AngleBiasDrift]
  CHECK(acts(model, without));
}

TEST_CASE("encoder_eccentricity acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [EncoderEccentricity]
  model.effects[EncoderEccentricity::info().id] = {
      {"sin_deg", 0.8}, {"cos_deg", -0.5}, {"cycles_per_turn", 3.0}};
  //! [EncoderEccentricity]
  CHECK(acts(model, without));
}

TEST_CASE("rate_bias acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [RateBias]
  model.effects[RateBias::info().id] = {{"dps", 1.5}};
  //! [RateBias]
  CHECK(acts(model, without));
}

TEST_CASE("drive_efficiency acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [DriveEfficiency]
  model.effects[DriveEfficiency::info().id] = {{"efficiency", 0.8}, {"back_efficiency", 0.6}};
  //! [DriveEfficiency]
  CHECK(acts(model, without));
}

TEST_CASE("contact_resistance acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [ContactResistance]
  model.effects[ContactResistance::info().id] = {{"J_per_K", 80.0}, {"K_per_W", 10.0}, {"W_per_K", 0.2}};
  //! [ContactResistance]
  CHECK(acts(model, without));
}

TEST_CASE("iron_loss acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [IronLoss]
  model.effects[IronLoss::info().id] = {{"hysteresis_W_s_per_rad", 0.01}, {"eddy_W_s2_per_rad2", 1e-4}};
  //! [IronLoss]
  CHECK(acts(model, without));
}

TEST_CASE("quadratic_drag acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [QuadraticDrag]
  model.effects[QuadraticDrag::info().id] = {{"Nm_s2_per_rad2", 2e-4}};
  //! [QuadraticDrag]
  CHECK(acts(model, without));
}

TEST_CASE("target_delay acts in a simulation") {
  Model model = axis();
  model.servo = PositionPidServo{0.02, 0.002, 0.0, 2.0, 0.005, 0.0};
  const Model without = model;
  //! [TargetDelay]
  model.effects[TargetDelay::info().id] = {{"s", 0.04}};
  //! [TargetDelay]
  CHECK(acts(model, without));
}

TEST_CASE("idle_heat acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [IdleHeat]
  model.effects[IdleHeat::info().id] = {{"W", 1.5}};
  //! [IdleHeat]
  CHECK(acts(model, without));
}

TEST_CASE("UnknownLoad acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [UnknownLoad]
  model.effects[UnknownLoad::info().id] = {{"from_deg", -90.0}, {"to_deg", 90.0}, {"Nm_1", 0.05},
                                           {"Nm_2", 0.02},      {"Nm_3", 0.01},   {"Nm_4", 0.004},
                                           {"Nm_5", 0.001},     {"Nm_6", -0.001}, {"Nm_7", -0.004},
                                           {"Nm_8", -0.01},     {"Nm_9", -0.02},  {"Nm_10", -0.05}};
  //! [UnknownLoad]
  CHECK(acts(model, without));
}

TEST_CASE("UnknownFriction acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [UnknownFriction]
  model.effects[UnknownFriction::info().id] = {{"from_dps", -900.0}, {"to_dps", 900.0}, {"Nm_1", -0.02},
                                               {"Nm_2", -0.01},      {"Nm_3", -0.006},  {"Nm_4", -0.004},
                                               {"Nm_5", -0.002},     {"Nm_6", 0.002},   {"Nm_7", 0.004},
                                               {"Nm_8", 0.006},      {"Nm_9", 0.01},    {"Nm_10", 0.02}};
  //! [UnknownFriction]
  CHECK(acts(model, without));
}

TEST_CASE("UnknownDrive acts in a simulation") {
  Model model = axis();
  const Model without = model;
  //! [UnknownDrive]
  model.effects[UnknownDrive::info().id] = {{"from_A", -0.4}, {"to_A", 0.4},  {"A_1", 0.1},   {"A_2", 0.06},
                                            {"A_3", 0.03},    {"A_4", 0.01},  {"A_5", 0.0},   {"A_6", 0.0},
                                            {"A_7", -0.01},   {"A_8", -0.03}, {"A_9", -0.06}, {"A_10", -0.1}};
  //! [UnknownDrive]
  CHECK(acts(model, without));
}

TEST_CASE("UnknownLoss acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [UnknownLoss]
  model.effects[UnknownLoss::info().id] = {{"from_K", 0.0}, {"to_K", 60.0}, {"W_1", 0.0}, {"W_2", 0.1},
                                           {"W_3", 0.2},    {"W_4", 0.4},   {"W_5", 0.7}, {"W_6", 1.0},
                                           {"W_7", 1.4},    {"W_8", 1.9},   {"W_9", 2.5}, {"W_10", 3.0}};
  //! [UnknownLoss]
  CHECK(acts(model, without));
}

TEST_CASE("UnknownHeat acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [UnknownHeat]
  model.effects[UnknownHeat::info().id] = {{"from_A", 0.0}, {"to_A", 2.0}, {"W_1", 0.5}, {"W_2", 0.5},
                                           {"W_3", 0.6},    {"W_4", 0.8},  {"W_5", 1.0}, {"W_6", 1.3},
                                           {"W_7", 1.7},    {"W_8", 2.2},  {"W_9", 2.8}, {"W_10", 3.5}};
  //! [UnknownHeat]
  CHECK(acts(model, without));
}

TEST_CASE("UnknownVoltage acts in a simulation") {
  Model model = bench();
  const Model without = model;
  //! [UnknownVoltage]
  model.effects[UnknownVoltage::info().id] = {{"from_C", 20.0}, {"to_C", 80.0}, {"V_1", 0.0}, {"V_2", 0.1},
                                              {"V_3", 0.2},     {"V_4", 0.2},   {"V_5", 0.3}, {"V_6", 0.3},
                                              {"V_7", 0.4},     {"V_8", 0.4},   {"V_9", 0.5}, {"V_10", 0.5}};
  //! [UnknownVoltage]
  CHECK(acts(model, without));
}
