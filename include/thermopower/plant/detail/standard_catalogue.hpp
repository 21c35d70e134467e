// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

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
#include <thermopower/plant/standard_catalogue.hpp>

namespace thermopower::plant {

THERMOPOWER_GAP_INLINE const Catalogue& standard_catalogue() {
  static const Catalogue catalogue = [] {
    Catalogue all;
    all.add<SecondThermalMass>();
    all.add<ThirdThermalMass>();
    all.add<Enclosure>();
    all.add<ContactResistance>();
    all.add<Radiation>();
    all.add<NaturalConvectionEffect>();
    all.add<ForcedAirflowEffect>();
    all.add<AmbientBias>();
    all.add<NeighbourHeating>();
    all.add<MotionHeating>();
    all.add<IronLoss>();
    all.add<IdleHeat>();
    all.add<ThermometerLag>();
    all.add<ThermometerGain>();
    all.add<SupplyPowerHeating>();
    all.add<ExchangedHeatingLaw>();
    all.add<SupplySag>();
    all.add<SeriesResistance>();
    all.add<DeadTime>();
    all.add<BackEmf>();
    all.add<CurrentSensorOffset>();
    all.add<CurrentSensorGain>();
    all.add<WindingTempco>();
    all.add<CoulombFriction>();
    all.add<AsymmetricFriction>();
    all.add<StribeckFriction>();
    all.add<LoadFriction>();
    all.add<DriveEfficiency>();
    all.add<PreslidingFriction>();
    all.add<DriveDeadband>();
    all.add<Imbalance>();
    all.add<CableSpring>();
    all.add<Cogging>();
    all.add<Compliance>();
    all.add<Backlash>();
    all.add<ActuationDelay>();
    all.add<ServoDelay>();
    all.add<TargetDelay>();
    all.add<TorqueSaturation>();
    all.add<TorqueFade>();
    all.add<ConstantTorque>();
    all.add<AsymmetricViscous>();
    all.add<TorqueRipple>();
    all.add<WarmFriction>();
    all.add<QuadraticDrag>();
    all.add<DriveLag>();
    all.add<AngleScale>();
    all.add<AngleBiasDrift>();
    all.add<EncoderEccentricity>();
    all.add<RateBias>();
    all.add<UnknownLoad>();
    all.add<UnknownFriction>();
    all.add<UnknownDrive>();
    all.add<UnknownLoss>();
    all.add<UnknownHeat>();
    all.add<UnknownVoltage>();
    return all;
  }();
  return catalogue;
}

}  // namespace thermopower::plant
