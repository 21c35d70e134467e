# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""A small faulty log for every finding of the check: what raises it, and nothing else if possible.

The logs have names and units of their own, so that options are in force when they are read. A case is (finding, files,
training logs, held-out logs, options); files are texts by name, `joint.json` and `bench.json` are the models.
"""

import math
import random

JOINT = """{"format": "thermopower-model/1", "axis": {"law": "rigid", "inertia_kgm2": 0.012, "viscous_Nms_per_rad": 0.03,
  "torque_constant_Nm_per_A": 0.9}}"""
BENCH = """{"format": "thermopower-model/1", "supply": {"nominal_V": 12}, "current": {"law": "ohmic", "resistance_ohm": 8,
  "tempco_per_K": 0.00393}, "thermal": {"law": "lumped", "heat_capacity_J_per_K": 40, "conductance_W_per_K": 0.12}}"""
MODELS = {"joint.json": JOINT, "bench.json": BENCH}

JOINT_OPTIONS = ["--column", "t_s=stamp_ms:ms", "--column", "drive_A=cmd", "--column", "angle_deg=pos:rad", "--column", "rate_dps=vel:rad/s"]
BENCH_OPTIONS = ["--column", "t_s=clock:ms", "--column", "power_param=duty:1", "--column", "motor_C=Winding temp",
                 "--column", "current_A=amps", "--ambient", "22"]


class Log:
    """Columns by name; nan is an empty cell."""

    def __init__(self, columns):
        self.columns = columns

    def rows(self):
        return len(next(iter(self.columns.values())))

    def changed(self, name, function):
        """The same with a column that a function of row and value makes."""
        return Log({**self.columns, name: [function(row, value) for row, value in enumerate(self.columns[name])]})

    def only(self, keeps):
        return Log({name: [value for row, value in enumerate(values) if keeps(row)] for name, values in self.columns.items()})

    def csv(self):
        def cell(value):
            if isinstance(value, str):
                return value
            return "" if math.isnan(value) else f"{value:.9g}"

        lines = [",".join(self.columns)]
        lines += [",".join(cell(values[row]) for values in self.columns.values()) for row in range(self.rows())]
        return "\n".join(lines) + "\n"


def joint(seed=1, rows=2000, steps=lambda row, draw: 0.005, hold=40, goes_on=False, gain=1.0, level=2.0):
    """A joint under steps of current. steps: seconds to the next row. goes_on: the command moves on between the rows."""
    draw = random.Random(seed)
    angle = rate = t = current = coming = 0.0
    table = {"stamp_ms": [], "cmd": [], "pos": [], "vel": []}
    for row in range(rows):
        current = coming
        if (row + 1) % hold == 0:
            coming = round(draw.uniform(-level, level) - 0.3 * angle, 2)
        dt = steps(row, draw)
        for name, value in zip(table, (1000.0 * t, current, angle + draw.gauss(0.0, 3e-4), rate + draw.gauss(0.0, 5e-3))):
            table[name].append(value)
        for part in range(10):
            acting = current + ((part + 0.5) * 0.1 * (coming - current) if goes_on else 0.0)
            before = rate
            rate += 0.1 * dt * (gain * 0.9 * acting - 0.03 * rate) / 0.012
            angle += 0.1 * dt * 0.5 * (before + rate)
        t += dt
    return Log(table)


def bench(seed=1, rows=900, noise_K=0.05, hold=60):
    """A motor under steps of power, a row a second."""
    draw = random.Random(seed)
    motor, duty = 22.0, 0.0
    table = {"clock": [], "duty": [], "Winding temp": [], "amps": []}
    for row in range(rows):
        if row % hold == 0:
            duty = draw.choice((0.0, 0.25, 0.5, 1.0))
        ohm = 8.0 * (1.0 + 0.00393 * (motor - 25.0))
        current = 12.0 * math.sqrt(duty) / ohm
        for name, value in zip(table, (1000.0 * row, duty, motor + draw.gauss(0.0, noise_K), current + draw.gauss(0.0, 2e-3))):
            table[name].append(value)
        for _ in range(10):
            motor += 0.1 * (current * current * ohm - 0.12 * (motor - 22.0)) / 40.0
    return Log(table)


def filtered(values, share):
    out, state = [], values[0]
    for value in values:
        state += share * (value - state)
        out.append(state)
    return out


def straight(values, apart):
    """Straight lines between every so many values."""
    out = []
    for row, _ in enumerate(values):
        low = row - row % apart
        high = min(low + apart, len(values) - 1)
        out.append(values[low] + (values[high] - values[low]) * (row - low) / max(high - low, 1))
    return out


def klippy(log):
    """klippy.log of the same as a hotend, whose thermometer reads degrees Fahrenheit."""
    text = "Start printer at Sun Nov 29 10:00:00 2026\n===== Config file =====\n[extruder]\ncontrol = pid\n=======================\n"
    for row in range(log.rows()):
        text += (f"Stats {1000.0 + row:.1f}: gcodein=0 mcu: mcu_awake=0.001 freq=72000000 sysload=0.10 extruder: target=0 "
                 f"temp={1.8 * log.columns['Winding temp'][row] + 32.0:.1f} pwm={log.columns['duty'][row]:.3f}\n")
    return text


def cases():
    nan = math.nan
    j, b = joint(), bench()

    def with_column(log, name, values):
        return Log({**log.columns, name: values})

    def column(log, name, function):
        return Log({**log.columns, name: function(log.columns[name])})

    def case(kind, log, options=None, held=None, more=(), text=None):
        is_joint = "pos" in log.columns
        options = options or (JOINT_OPTIONS if is_joint else BENCH_OPTIONS)
        files = {**MODELS, "log.csv": text or log.csv()}
        train, held_out = ["log.csv"], []
        for number, other in enumerate(more):
            files[f"more{number}.csv"] = other
            train.append(f"more{number}.csv")
        if held is not None:
            files["held.csv"] = held
            held_out.append("held.csv")
        return kind, files, "joint.json" if is_joint else "bench.json", train, held_out, options

    yield case("irregular_stamps", joint(steps=lambda row, draw: 0.003 + 0.01 * draw.random() ** 3))
    jitter = random.Random(5)
    yield case("jittering_stamps", j.changed("stamp_ms", lambda row, value: value + jitter.uniform(-0.5, 0.5)))
    yield case("gap_in_stamps", j.only(lambda row: not 800 <= row < 900))
    yield case("empty_column", with_column(j, "motor_C", [nan] * j.rows()))
    yield case("constant_column", j.changed("vel", lambda row, value: 0.0))
    yield case("missing_samples", j.changed("pos", lambda row, value: nan if row % 37 == 0 else value))
    yield case("unknown_input", j.changed("cmd", lambda row, value: nan if row % 40 in (38, 39, 0, 1) and row // 40 % 5 == 0 and row else value))
    yield case("spiked_samples", j.changed("pos", lambda row, value: value + 9.0 if row % 301 == 300 else value))
    yield case("glitched_samples", b.changed("Winding temp", lambda row, value: 85.0 if 400 <= row < 404 else value))
    again = j.only(lambda row: True)
    for row in range(3, again.rows(), 7):
        for name in ("pos", "vel"):
            again.columns[name][row] = again.columns[name][row - 1]
    yield case("repeated_frames", again)
    yield case("held_samples", b.changed("Winding temp", lambda row, value: b.columns["Winding temp"][row - row % 10]))
    yield case("interpolated_samples", column(b, "Winding temp", lambda values: straight(values, 10)))
    yield case("separate_samples", j.changed("pos", lambda row, value: nan if row % 2 else value).changed(
        "vel", lambda row, value: value if row % 2 else nan))
    yield case("frozen_samples", j.changed("pos", lambda row, value: j.columns["pos"][600] if 600 <= row < 900 else value))
    yield case("clipped_samples", j.changed("vel", lambda row, value: max(min(value, 10.0), -10.0)))
    yield case("impossible_samples", b.changed("Winding temp", lambda row, value: -300.0 if row % 100 == 50 else value))
    yield case("position_reset", j.changed("pos", lambda row, value: value + (40.0 if row >= 1000 else 0.0)))
    yield case("wrapped_angle", j.changed("pos", lambda row, value: value % (2.0 * math.pi)))
    yield case("coarse_quantum", j.changed("pos", lambda row, value: 0.2 * round(value / 0.2)))
    # Radians that are taken for degrees, milliamperes for amperes, milliseconds for seconds.
    as_degrees = ["--column", "t_s=stamp_ms:ms", "--column", "drive_A=cmd", "--column", "angle_deg=pos", "--column", "rate_dps=vel"]
    yield case("wrong_unit", j, as_degrees)
    yield case("wrong_unit", j.changed("cmd", lambda row, value: 1000.0 * value))
    yield case("wrong_unit", j, ["--column", "t_s=stamp_ms"] + JOINT_OPTIONS[2:])
    no_stamps = Log({name: values for name, values in j.columns.items() if name != "stamp_ms"})
    yield case("wrong_unit", no_stamps, JOINT_OPTIONS[2:] + ["--rate", "0.2"])
    yield case("wrong_unit", b.changed("Winding temp", lambda row, value: 1.8 * value + 32.0), BENCH_OPTIONS[:-1] + ["71.6"])
    yield case("wrong_unit", b, BENCH_OPTIONS + ["--supply", "12000"])
    yield case("wrong_unit", b.changed("amps", lambda row, value: 1000.0 * value))
    yield case("wrong_unit", b, ["--column", "motor_C=extruder.temp", "--column", "power_param=extruder.pwm:1", "--ambient", "71.6"], text=klippy(b))
    yield case("wrong_sign", j.changed("cmd", lambda row, value: -value))
    exchanged = [one.replace("Winding temp", "amps") if one.startswith("motor_C") else one.replace("amps", "Winding temp") for one in BENCH_OPTIONS]
    yield case("swapped_columns", b, exchanged)
    yield case("clock_shift", b.changed("amps", lambda row, value: b.columns["amps"][max(row - 6, 0)]))
    yield case("lagging_output", column(j, "vel", lambda values: filtered(values, 0.1)))
    yield case("sampled_command", joint(steps=lambda row, draw: 0.02, hold=1, goes_on=True))
    noise = random.Random(6)
    by_current = Log({name: values for name, values in b.columns.items() if name != "duty"})
    yield case("noisy_command", by_current.changed("amps", lambda row, value: value + noise.gauss(0.0, 0.08)),
              BENCH_OPTIONS[:2] + BENCH_OPTIONS[4:])
    slow = joint(steps=lambda row, draw: 0.4, rows=600, hold=2, level=0.2)
    yield case("sampled_too_slowly", slow)
    yield case("never_driven", j.changed("cmd", lambda row, value: 0.0))
    still = joint(seed=3, rows=600).changed("cmd", lambda row, value: 0.0).changed("pos", lambda row, value: 1e-4 * (row % 3)).changed(
        "vel", lambda row, value: 1e-3 * (row % 2))
    yield case("held_out_not_excited", j, held=still.csv())
    yield case("held_out_in_training", j, held=j.only(lambda row: 500 <= row < 1500).csv())
    yield case("recording_given_twice", j, more=[j.csv()])
    yield case("text_column_ignored", with_column(j, "mode", ["idle"] * j.rows()))
    yield case("no_final_line_break", j, text=j.csv()[:-1])
    yield case("common_factor", joint(gain=2.0))
    yield case("detached_sensor", b.changed("Winding temp", lambda row, value: 22.0 + 0.05 * math.sin(row) + 0.05 * math.cos(7.0 * row * row)))
