# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""What an effect in Python costs beside the same one of the catalogue.

Prints the processor time of a diagnosis with each, in turns, and the median of their ratios:

    PYTHONPATH=build/python/python python3 tests/python/own_effect_cost.py [rows]
"""

import statistics
import sys
import time

import numpy as np
import thermopower

rows = int(sys.argv[1]) if len(sys.argv) > 1 else 500
random = np.random.default_rng(7)
t_s = 0.01 * np.arange(rows)
drive_A = np.cumsum(random.normal(0.0, 0.05, rows))
drive_A -= np.linspace(drive_A[0], drive_A[-1], rows)
MODEL = {"format": "thermopower-model/1", "name": "joint",
         "axis": {"law": "rigid", "inertia_kgm2": 2e-3, "viscous_Nms_per_rad": 2e-3, "torque_constant_Nm_per_A": 0.1}}
true = dict(MODEL, effects={"cable_spring": {"Nm_per_rad": 0.05, "centre_rad": 0.0}})
log = {"t_s": t_s, "drive_A": drive_A, "angle_deg": np.zeros(rows), "rate_dps": np.zeros(rows)}
simulated = thermopower.predict(true, {"t_s": t_s, "drive_A": drive_A})
for name, noise in (("angle_deg", 0.05), ("rate_dps", 1.0)):
    log[name] = simulated[name] + random.normal(0.0, noise, rows)


def spring(p, terms):
    """A spring beside the axis."""
    terms.load_Nm -= p.Nm_per_rad * (terms.angle_rad - p.centre_rad)


OWN = thermopower.Effect("own_spring", spring, on="axis", parameters=[
    thermopower.parameter("Nm_per_rad", "N m/rad", 0.0, 1e3, [0.01]), thermopower.parameter("centre_rad", "rad", -3.2, 3.2, [0.0])])


def cost(**options):
    begin = time.process_time()
    thermopower.diagnose(MODEL, log, threads=1, **options)
    return time.process_time() - begin


ratios = []
for turn in range(5):
    known, own = cost(), cost(effects=[OWN], without=["cable_spring"])
    ratios.append(own / known)
    print(f"{rows} rows: {known:.2f} s with the catalogue's effect, {own:.2f} s with one in Python")
print(f"ratio {statistics.median(ratios):.2f} (median of {len(ratios)}; traced: {OWN.is_traced})")
