// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/catalogue.hpp>
#include <thermopower/gap/effects/actuation_delay.hpp>
#include <thermopower/gap/effects/ambient_bias.hpp>
#include <thermopower/gap/effects/angle_bias_drift.hpp>
#include <thermopower/gap/effects/angle_scale.hpp>
#include <thermopower/gap/effects/asymmetric_friction.hpp>
#include <thermopower/gap/effects/back_emf.hpp>
#include <thermopower/gap/effects/cable_spring.hpp>
#include <thermopower/gap/effects/cogging.hpp>
#include <thermopower/gap/effects/compliance.hpp>
#include <thermopower/gap/effects/coulomb_friction.hpp>
#include <thermopower/gap/effects/current_sensor_gain.hpp>
#include <thermopower/gap/effects/current_sensor_offset.hpp>
#include <thermopower/gap/effects/dead_time.hpp>
#include <thermopower/gap/effects/drive_deadband.hpp>
#include <thermopower/gap/effects/forced_airflow.hpp>
#include <thermopower/gap/effects/imbalance.hpp>
#include <thermopower/gap/effects/load_friction.hpp>
#include <thermopower/gap/effects/motion_heating.hpp>
#include <thermopower/gap/effects/natural_convection.hpp>
#include <thermopower/gap/effects/neighbour_heating.hpp>
#include <thermopower/gap/effects/radiation.hpp>
#include <thermopower/gap/effects/rate_bias.hpp>
#include <thermopower/gap/effects/second_thermal_mass.hpp>
#include <thermopower/gap/effects/series_resistance.hpp>
#include <thermopower/gap/effects/stribeck_friction.hpp>
#include <thermopower/gap/effects/supply_power_heating.hpp>
#include <thermopower/gap/effects/supply_sag.hpp>
#include <thermopower/gap/effects/thermometer_gain.hpp>
#include <thermopower/gap/effects/thermometer_lag.hpp>
#include <thermopower/gap/effects/torque_fade.hpp>
#include <thermopower/gap/effects/torque_saturation.hpp>
#include <thermopower/gap/effects/winding_tempco.hpp>

namespace thermopower::gap {

/// The catalogue that comes with the library; copy it and add() to the copy to extend it.
inline const Catalogue& standard_catalogue() {
  static const Catalogue catalogue = [] {
    Catalogue all;
    all.add<SecondThermalMass>();
    all.add<Radiation>();
    all.add<NaturalConvectionEffect>();
    all.add<ForcedAirflowEffect>();
    all.add<AmbientBias>();
    all.add<NeighbourHeating>();
    all.add<MotionHeating>();
    all.add<ThermometerLag>();
    all.add<ThermometerGain>();
    all.add<SupplyPowerHeating>();
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
    all.add<DriveDeadband>();
    all.add<Imbalance>();
    all.add<CableSpring>();
    all.add<Cogging>();
    all.add<Compliance>();
    all.add<ActuationDelay>();
    all.add<TorqueSaturation>();
    all.add<TorqueFade>();
    all.add<AngleScale>();
    all.add<AngleBiasDrift>();
    all.add<RateBias>();
    return all;
  }();
  return catalogue;
}

}  // namespace thermopower::gap
