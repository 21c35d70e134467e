# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""The Python module against a motor that is integrated here, in NumPy, and knows nothing of the library."""

import ast
import copy
import datetime
import doctest
import importlib.util
import inspect
import json
import os
import pickle
import re
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

import numpy as np

import thermopower

MODEL = {
    "format": "thermopower-model/1",
    "name": "motor whose winding never warms",
    "supply": {"nominal_V": 12.0},
    "current": {"law": "ohmic", "resistance_ohm": 8.0, "tempco_per_K": 0.0, "reference_C": 25.0},
    "thermal": {"law": "lumped", "heat_capacity_J_per_K": 40.0, "conductance_W_per_K": 0.12},
}
TEMPCO = 0.00393


def motor(seconds, seed):
    """Copper at 8 ohm and 25 degC, 40 J/K, 0.12 W/K, in steps of 10 ms; read every second with noise."""
    random = np.random.default_rng(seed)
    t = np.arange(0.0, seconds, 1.0)
    power = np.repeat(random.choice([0.0, 80.0, 140.0, 200.0, 255.0], size=seconds // 60 + 1), 60)[: len(t)]
    body, warm, amps = 24.0, [], []
    for level in power:
        ohm = 8.0 * (1.0 + TEMPCO * (body - 25.0))
        amps.append(12.0 * np.sqrt(level / 255.0) / ohm)
        warm.append(body)
        for _ in range(100):
            ohm = 8.0 * (1.0 + TEMPCO * (body - 25.0))
            heat = 144.0 * level / 255.0 / ohm
            body += 0.01 * (heat - 0.12 * (body - 24.0)) / 40.0
    return {
        "t_s": t,
        "power_param": power,
        "ambient_C": np.full(len(t), 24.0),
        "current_A": np.array(amps) + random.normal(0.0, 0.004, len(t)),
        "motor_C": np.array(warm) + random.normal(0.0, 0.1, len(t)),
    }


class Diagnosing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.train, cls.held_out = motor(1800, 1), motor(1200, 2)
        cls.found = thermopower.diagnose(MODEL, cls.train, cls.held_out)

    def test_names_the_cause(self):
        self.assertEqual(self.found.verdict, "explained")
        self.assertEqual([one.effect for one in self.found.cause], ["winding_tempco"])
        tempco = self.found.cause[0].parameters.tempco_per_K
        self.assertAlmostEqual(tempco.value, TEMPCO, delta=0.05 * TEMPCO)
        self.assertLess(tempco.ci95[0], tempco.value)
        self.assertGreater(self.found.gap.motor_C.shrunk_by, 0.8)
        self.assertEqual(self.found["verdict"], self.found.as_dict()["verdict"])

    def test_augmented_model_simulates_the_rest(self):
        augmented = self.found.augmented
        self.assertIn("winding_tempco", augmented["effects"])
        old, new = thermopower.simulate([MODEL, augmented], self.held_out)
        error = lambda signals: np.sqrt(np.nanmean((signals["motor_C"] - self.held_out["motor_C"]) ** 2))
        self.assertLess(error(new), 0.15)
        self.assertGreater(error(old), 1.0)

    def test_pages_headers_and_curves(self):
        self.assertTrue(self.found.html().endswith("</html>\n"))
        text, left_out = self.found.header()
        self.assertIn("struct Motor", text)
        self.assertEqual(left_out, [])
        self.assertIn("EXPLAINED", repr(self.found))
        temperature = next(one for one in self.found.series if one["signal"] == "motor_C")
        self.assertEqual(len(temperature["augmented"]), len(self.held_out["t_s"]))
        np.testing.assert_array_equal(temperature["measured"], self.held_out["motor_C"])

    def test_frames_and_files_give_the_same_bytes(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("no pandas (Debian: python3-pandas)")
        frames = [pandas.DataFrame(one) for one in (self.train, self.held_out)]
        again = thermopower.diagnose(MODEL, *frames, threads=1)
        self.assertEqual(again.as_dict(), self.found.as_dict())
        self.assertEqual(list(again.table().index), ["current_A", "motor_C"])
        with tempfile.TemporaryDirectory() as folder:
            paths = [os.path.join(folder, name) for name in ("train.csv", "heldout.csv")]
            for frame, path in zip(frames, paths):
                frame.to_csv(path, index=False, float_format="%.17g")
            third = thermopower.diagnose(MODEL, *paths, threads=1).as_dict()
        for one in ("verdict", "gap", "cause", "alternatives"):
            self.assertEqual(third[one], again.as_dict()[one])

    def test_the_program_says_the_same(self):
        program = os.environ.get("THERMOPOWER_GAP_PROGRAM")
        if not program:
            self.skipTest("the program was not built")
        with tempfile.TemporaryDirectory() as folder:
            for name, one in (("train", self.train), ("heldout", self.held_out)):
                np.savetxt(os.path.join(folder, name + ".csv"), np.column_stack(list(one.values())), "%.17g", ",",
                           header=",".join(one), comments="")
            with open(os.path.join(folder, "model.json"), "w", encoding="utf-8") as file:
                json.dump(MODEL, file)
            subprocess.run([program, "diagnose", "--model", "model.json", "--recording", "train.csv", "--heldout",
                            "heldout.csv", "--report", "report.json"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
                report = json.load(file)
        self.assertEqual(report["gap"], self.found.as_dict()["gap"])
        self.assertEqual(report["cause"], self.found.as_dict()["cause"])

    def test_a_wrong_unit_is_a_finding(self):
        hot = dict(self.train, motor_C=1.8 * self.train["motor_C"] + 32.0)
        knowing = dict(MODEL, current=dict(MODEL["current"], tempco_per_K=TEMPCO))
        report = thermopower.check(knowing, hot)
        self.assertFalse(report.believable)
        self.assertIn("motor_C=motor_C:degF", report.findings[0].mend)


    def test_what_is_misspelt_is_refused(self):
        with self.assertRaisesRegex(thermopower.InputError, "no effect 'winding_tempc'; did you mean winding_tempco"):
            thermopower.diagnose(MODEL, self.train, without=["winding_tempc"])
        with self.assertRaisesRegex(thermopower.InputError, "there is no 'angle'; expected motor_C"):
            thermopower.predict(MODEL, self.train, start={"angle": 1.0})
        with self.assertRaisesRegex(TypeError, "no option 'horizon'"):
            thermopower.diagnose(MODEL, self.train, horizon=1.0)

    def test_is_kept_and_copied(self):
        again = pickle.loads(pickle.dumps(self.found))
        self.assertEqual(again.as_dict(), self.found.as_dict())
        for one in ("html", "header", "markdown"):
            self.assertEqual(getattr(again, one)(), getattr(self.found, one)())
        self.assertEqual(again.augmented, self.found.augmented)
        self.assertEqual(str(again), str(self.found))
        self.assertEqual(len(again.series), len(self.found.series))
        self.assertEqual(copy.copy(self.found).verdict, "explained")
        self.assertEqual(copy.deepcopy(self.found).verdict, "explained")
        with self.assertRaisesRegex(ValueError, "axis"):
            again.mjcf()  # a motor without a joint

    def test_says_it_in_words(self):
        self.assertIn("The winding's resistance rises with temperature (0.3", self.found.words[0])
        self.assertIn("| motor temperature / degC |", self.found.markdown())
        self.assertIn("Both say the same", thermopower.compare(self.found, self.found))
        self.assertIn("At the same voltage the current falls", thermopower.explain("winding_tempco"))
        with self.assertRaisesRegex(thermopower.InputError, "did you mean winding_tempco"):
            thermopower.explain("winding_tempc")
        self.assertIn("\n", repr(thermopower.effects()))
        self.assertIn("motor temperature", str(thermopower.check(MODEL, self.train)))
        self.assertRegex(thermopower.__version__, r"^\d+\.\d+\.\d+$")
        self.assertEqual(sorted(thermopower.__all__), thermopower.__all__)

    def test_dates_indexes_and_float32_are_read(self):
        expected = thermopower.simulate(MODEL, self.train)["motor_C"]
        dates = np.datetime64("2026-03-01T12:00:00") + (1000 * self.train["t_s"]).astype("timedelta64[ms]")
        dated = dict(self.train, t_s=dates)
        found = thermopower.simulate(MODEL, dated)
        np.testing.assert_array_equal(found["motor_C"], expected)
        np.testing.assert_array_equal(found["t_s"], self.train["t_s"])
        utc = [datetime.datetime(2026, 3, 1, tzinfo=datetime.timezone.utc) + datetime.timedelta(seconds=float(one)) for one in self.train["t_s"]]
        np.testing.assert_allclose(thermopower.simulate(MODEL, dict(self.train, t_s=utc))["motor_C"], expected)
        single = {name: values.astype(np.float32) for name, values in self.train.items()}
        np.testing.assert_allclose(thermopower.simulate(MODEL, single)["motor_C"], expected, atol=1e-3)
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is not here")
        frame = pandas.DataFrame(self.train)
        np.testing.assert_array_equal(thermopower.simulate(MODEL, frame.set_index("t_s"))["motor_C"], expected)
        frame.index = pandas.DatetimeIndex(dates)
        np.testing.assert_array_equal(thermopower.simulate(MODEL, frame.drop(columns="t_s"))["motor_C"], expected)

    def test_columns_of_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "log.csv")
            with open(path, "w", encoding="utf-8") as file:
                file.write("time [s],motor_temp [degC],ambient_temp [degC]\n")
                file.writelines(f"{i},{20 + 0.5 * i},20\n" for i in range(50))
            found = thermopower.columns(path)
        self.assertIn("motor_C", found)
        self.assertTrue(any(one.startswith("motor_C=motor_temp") for one in found.choices), found.choices)
        self.assertIn("motor_temp", repr(found))


class Remedies(unittest.TestCase):
    """What a finding says to pass works beside the arguments in force; the logs are those of the program's test."""

    @staticmethod
    def arguments_of(options):
        given = {"columns": [], "constants": {}}
        for name, value in zip(options[::2], options[1::2]):
            if name == "--column":
                given["columns"].append(value)
            elif name == "--rate":
                given["rows_per_s"] = float(value)
            else:
                given["constants"][{"--ambient": "ambient_C", "--supply": "supply_V"}[name]] = float(value)
        return given

    def test_of_every_finding_can_be_pasted(self):
        spec = importlib.util.spec_from_file_location("faulty_logs", os.path.join(Package.ROOT, "tests", "thermopower-gap", "faulty_logs.py"))
        faulty_logs = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(faulty_logs)
        argument = r"(?:columns=\[[^]]*\]|constants=\{[^}]*\}|(?:rows_per_s|horizon_s)=[-+.e\d]+)"
        pasted = 0
        for kind, files, model, train, held_out, options in faulty_logs.cases():
            with self.subTest(kind), tempfile.TemporaryDirectory() as folder:
                for name, content in files.items():
                    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                        file.write(content)

                def check(given):
                    path = lambda names: [os.path.join(folder, one) for one in names]
                    return thermopower.check(os.path.join(folder, model), path(train), path(held_out) or None, **given)

                given = self.arguments_of(options)
                found = check(given)
                self.assertIn(kind, [one.kind for one in found.findings])
                self.assertNotRegex(str(found), r"--[a-z]")
                for one in found.findings:
                    for words in re.findall(f"{argument}(?:, {argument})*", one.mend):
                        pasted += 1
                        left = check({**given, **eval(f"dict({words})")})
                        self.assertNotIn((one.kind, one.column), [(other.kind, other.column) for other in left.findings], words)
        self.assertGreater(pasted, 10)

    def test_of_a_diagnosis_are_those_of_its_texts(self):
        knowing = dict(MODEL, current=dict(MODEL["current"], tempco_per_K=TEMPCO))
        run = motor(600, 1)
        frame = {"stamp": 1000.0 * run["t_s"], "warm": 1.8 * run["motor_C"] + 32.0, "level": run["power_param"]}
        given = dict(columns=["t_s=stamp:ms", "motor_C=warm", "power_param=level"], constants={"ambient_C": 75.2})
        found = thermopower.diagnose(knowing, frame, **given)
        self.assertEqual(found.verdict, "insufficient")
        words = found.findings[0].mend
        self.assertEqual(words, "columns=['motor_C=warm:degF', 't_s=stamp:ms', 'power_param=level'], constants={'ambient_C': 24}")
        self.assertIn(words, found.next_experiment)
        for text in (found.html(), str(found), found.markdown()):
            self.assertIn("warm:degF", text)
            self.assertNotIn("--column", text)
        self.assertNotEqual(thermopower.diagnose(knowing, frame, **eval(f"dict({words})")).verdict, "insufficient")

    def test_a_frame_may_lack_its_time_and_hold_torques(self):
        t = np.arange(400) * 0.01
        drive = np.sign(np.sin(3.0 * t))
        inputs = {"torque": 0.1 * drive, "angle_deg": np.zeros(400), "rate_dps": np.zeros(400)}
        found = thermopower.check(AXIS, inputs, columns=["drive_A=torque:Nm"], rows_per_s=100.0)
        self.assertIn("constant_column", [one.kind for one in found.findings])
        expected = thermopower.predict(AXIS, {"t_s": t, "drive_A": drive})
        # The torque over the model's constant is the current.
        got = thermopower.predict(AXIS, {"t_s": t, "torque": 0.1 * drive}, columns=["drive_A=torque:Nm"])
        np.testing.assert_allclose(got["angle_deg"], expected["angle_deg"])


class Designing(unittest.TestCase):
    def test_writes_the_experiment_that_tells_two_causes_apart(self):
        # A drum that turns one way only: dry friction and a constant torque look the same.
        def drum(seed):
            random = np.random.default_rng(seed)
            t = np.arange(0.0, 6.0, 0.01)
            drive = 0.4 + 0.2 * np.sign(np.sin(2.0 * t))
            angle, rate, table = 0.0, 20.0, []
            for level in drive:
                table.append((angle, rate))
                for _ in range(10):
                    rate += 0.001 * (0.1 * level - 2e-3 * rate - 0.004 * np.sign(rate)) / 2e-3
                    angle += 0.001 * rate
            angle, rate = np.array(table).T
            return {"t_s": t, "drive_A": drive, "angle_deg": np.degrees(angle) + random.normal(0.0, 0.02, len(t)),
                    "rate_dps": np.degrees(rate) + random.normal(0.0, 0.2, len(t))}

        found = thermopower.diagnose(AXIS, drum(3), drum(103))
        self.assertIn(found.verdict, ("ambiguous", "partial"), str(found))
        limits = {"format": "thermopower-limits/1", "duration_s": 6, "row_s": 0.02, "vary": {"drive_A": {"from": -1, "to": 1}},
                  "angle_deg": [-36000, 36000], "rate_dps": 4000}
        design = found.design(limits)
        self.assertEqual(design.ending, "schedule", str(design))
        self.assertLess(design.schedule["drive_A"].min(), 0.0)  # it turns back
        self.assertGreater(len(design.schedule["t_s"]), 10)
        self.assertIn("#pragma once", design.header)
        self.assertIn("</html>", design.html())
        self.assertEqual(pickle.loads(pickle.dumps(found)).design(limits).csv, design.csv)
        with self.assertRaisesRegex(thermopower.InputError, "limits"):
            found.design({"format": "thermopower-limits/1"})


class Fleets(unittest.TestCase):
    @staticmethod
    def write(folder, name, columns):
        path = os.path.join(folder, name)
        np.savetxt(path, np.column_stack(list(columns.values())), "%.9g", ",", header=",".join(columns), comments="")
        return path

    def test_rows_and_tables_give_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            logs = [self.write(folder, f"u{i}.csv", motor(900, i)) for i in range(4)]
            model = os.path.join(folder, "model.json")
            with open(model, "w", encoding="utf-8") as file:
                json.dump(MODEL, file)
            day = datetime.date(2026, 3, 1)
            rows = [{"log": path, "model": model, "unit": f"U{i}", "time": day if i else None} for i, path in enumerate(logs)]
            rows.append({"log": os.path.join(folder, "absent.csv"), "model": model, "unit": "U9"})
            found = thermopower.fleet(rows, os.path.join(folder, "out"), workers=2)
            self.assertFalse(found.complete)  # one log is not there
            self.assertEqual(len(found.units), 4)
            self.assertEqual([one.own_cause for one in found.units], ["winding_tempco"] * 4)
            self.assertIn("4 units", str(found))
            self.assertIn("drift not judged (no unit has four dated logs)", str(found))
            self.assertIn("1 log without a statement", str(found))
            with open(found.page, encoding="utf-8") as file:
                self.assertIn("</html>", file.read())
            self.assertEqual(pickle.loads(pickle.dumps(found)).as_dict(), found.as_dict())
            # The same rows as a table of one's own, in one process and without pages.
            with open(os.path.join(folder, "manifest.csv"), "w", encoding="utf-8") as file:
                file.write("log,model,unit,time\n")
                for row in rows:
                    file.write(f"{os.path.basename(row['log'])},model.json,{row['unit']},{row.get('time') or ''}\n")
            again = thermopower.fleet(os.path.join(folder, "manifest.csv"), os.path.join(folder, "again"), workers=1, pages=False)
            self.assertEqual(again.as_dict()["units"], found.as_dict()["units"])
            with self.assertRaisesRegex(thermopower.InputError, "did you mean winding_tempco"):
                thermopower.fleet(rows, os.path.join(folder, "out"), without=["winding_tempc"])

    def test_ctrl_c_ends_it_and_the_same_call_resumes(self):
        with tempfile.TemporaryDirectory() as folder:
            logs = [self.write(folder, f"u{i}.csv", motor(1800, i)) for i in range(40)]
            with open(os.path.join(folder, "model.json"), "w", encoding="utf-8") as file:
                json.dump(MODEL, file)
            script = textwrap.dedent("""
                import os, sys, thermopower
                print("begun", flush=True)
                rows = [{"log": os.path.join(sys.argv[1], f"u{i}.csv"), "model": os.path.join(sys.argv[1], "model.json")} for i in range(40)]
                try:
                    thermopower.fleet(rows, os.path.join(sys.argv[1], "out"), workers=1, pages=False)
                except KeyboardInterrupt:
                    print("interrupted", flush=True)
            """)
            child = subprocess.Popen([sys.executable, "-B", "-c", script, folder], stdout=subprocess.PIPE, text=True)
            self.assertEqual(child.stdout.readline(), "begun\n")
            reports = os.path.join(folder, "out", "reports")
            while child.poll() is None and not (os.path.isdir(reports) and any(one.endswith(".json") for one in os.listdir(reports))):
                time.sleep(0.05)
            child.send_signal(signal.SIGINT)
            self.assertIn("interrupted", child.communicate(timeout=60)[0])
            done = [one for one in os.listdir(reports) if one.endswith(".json")]
            self.assertGreater(len(done), 0)
            self.assertLess(len(done), len(logs))


class Predicting(unittest.TestCase):
    def test_from_inputs_alone(self):
        t = np.arange(0.0, 3000.0, 1.0)
        inputs = {"t_s": t, "power_param": np.full(len(t), 100.0), "ambient_C": np.full(len(t), 20.0)}
        found = thermopower.predict(MODEL, inputs)
        # 12^2 100/255 / 8 W over 0.12 W/K, approached with 40/0.12 s.
        rise = 144.0 * 100.0 / 255.0 / 8.0 / 0.12
        np.testing.assert_allclose(found["motor_C"], 20.0 + rise * (1.0 - np.exp(-t * 0.12 / 40.0)), atol=0.01)
        warm = thermopower.predict(MODEL, inputs, start={"motor_C": 60.0})
        self.assertEqual(warm["motor_C"][0], 60.0)

    def test_batches_have_the_shape_of_their_arguments(self):
        inputs = [{"t_s": np.arange(5.0), "power_param": np.full(5, level), "ambient_C": np.full(5, 20.0)} for level in (50, 255)]
        stiff = dict(MODEL, current=dict(MODEL["current"], resistance_ohm=4.0))
        rows = thermopower.predict([MODEL, stiff], inputs, threads=2)
        self.assertEqual([len(row) for row in rows], [2, 2])
        self.assertAlmostEqual(rows[1][1]["current_A"][0], 3.0, places=9)
        self.assertAlmostEqual(rows[0][0]["current_A"][0], 1.5 * np.sqrt(50 / 255), places=9)

    def test_runs_start_anew(self):
        inputs = {"t_s": np.tile(np.arange(100.0), 2), "run": np.repeat(["a", "b"], 100),
                  "power_param": np.full(200, 255.0), "ambient_C": np.full(200, 20.0)}
        found = thermopower.predict(MODEL, inputs)["motor_C"]
        np.testing.assert_array_equal(found[:100], found[100:])


class Refusing(unittest.TestCase):
    def refuses(self, words, call, *arguments, error=thermopower.InputError, **named):
        with self.assertRaises(error) as caught:
            call(*arguments, **named)
        self.assertIn(words, str(caught.exception))

    def test_in_the_words_of_the_program(self):
        good = motor(120, 3)
        wrong = json.loads(json.dumps(MODEL))
        wrong["current"]["resistance_ohm"] = -1
        self.refuses("/current/resistance_ohm", thermopower.diagnose, wrong, good)
        self.refuses("expected \"thermopower-model/1\"", thermopower.check, {"format": "other"}, good)
        self.refuses("there is no column 't_s'", thermopower.check, MODEL, {"motor_C": [1.0, 2.0]})
        self.refuses("recordings[1]: column 'motor_C' has the shape (3,)", thermopower.check, MODEL,
                     [good, {"t_s": [0.0, 1.0], "motor_C": [1.0, 2.0, 3.0]}])
        self.refuses("t_s does not increase", thermopower.check, MODEL, {"t_s": [0.0, 0.0], "motor_C": [1.0, 2.0]})
        self.refuses("is infinite in row 1", thermopower.check, MODEL, {"t_s": [0.0, 1.0], "motor_C": [1.0, np.inf]})
        self.refuses("holds <U3; expected numbers", thermopower.check, MODEL, {"t_s": [0.0, 1.0], "motor_C": ["hot", "1"]})
        self.refuses("No such file", thermopower.check, MODEL, "no_such.csv")
        self.refuses("is a int; expected a dict", thermopower.check, MODEL, 7)
        self.refuses("tolerance is 2", thermopower.diagnose, MODEL, good, tolerance=2.0, error=thermopower.InvalidInput)
        self.refuses("no option 'horizon'", thermopower.diagnose, MODEL, good, horizon=1.0, error=TypeError)
        self.refuses("there is no 'verdikt'", getattr, thermopower.check(MODEL, good), "verdikt", error=AttributeError)


class OwnEffects(unittest.TestCase):
    """A catalogue's effect written once more, in Python: it must be the same effect."""

    @classmethod
    def setUpClass(cls):
        cls.train, cls.held_out = motor(900, 1), motor(600, 2)

        def copper(p, terms):
            """Copper's resistance grows as it warms."""
            terms.tempco_per_K += p.per_K

        cls.copper = thermopower.Effect("copper", copper, on="electrical", experiment="long heating and cooling",
                                        parameters=[thermopower.parameter("per_K", "1/K", 0.0, 0.02, [0.0])])

    def test_is_found_as_the_catalogues_own_is(self):
        known = thermopower.diagnose(MODEL, self.train, self.held_out)
        found = thermopower.diagnose(MODEL, self.train, self.held_out, effects=[self.copper], without=["winding_tempco"])
        self.assertEqual([one.effect for one in found.cause], ["copper"])
        value, expected = found.cause[0].parameters.per_K, known.cause[0].parameters.tempco_per_K
        self.assertAlmostEqual(value.value, expected.value, delta=0.01 * (expected.ci95[1] - expected.ci95[0]))
        self.assertAlmostEqual(found.gap.motor_C.shrunk_by, known.gap.motor_C.shrunk_by, places=3)
        self.assertIn("copper", found.html())
        new, = thermopower.simulate([found.augmented], [self.held_out], effects=[self.copper])
        old, = thermopower.simulate([known.augmented], [self.held_out])
        np.testing.assert_allclose(new[0]["motor_C"], old[0]["motor_C"], atol=0.01)
        with self.assertRaises(thermopower.InputError):
            thermopower.simulate(found.augmented, self.held_out)  # nobody says what copper is

    def test_functions_of_numpy_and_branches_carry_derivatives(self):
        def odd(p, terms):
            x = terms.winding_C / 100.0
            terms.extra_loss_W += p.a * (np.tanh(x) + np.exp(-x) - np.sqrt(abs(x)) + x**2 - 1.0 / (2.0 + x))
            if terms.winding_C > 40.0:
                terms.extra_loss_W = terms.extra_loss_W + 0.0

        effect = thermopower.Effect("odd", odd, on="thermal", parameters=[thermopower.parameter("a", "W", -5.0, 5.0, [0.1])])
        model = dict(MODEL, effects={"odd": {"a": 0.3}})
        other = dict(MODEL, effects={"odd": {"a": 0.31}})
        one, two = thermopower.predict([model, other], self.train, effects=[effect])
        self.assertTrue(np.all(one["motor_C"][50:] != two["motor_C"][50:]))
        thermopower.check(model, self.train, effects=[effect])

    def test_what_goes_wrong_in_python_is_told(self):
        def broken(p, terms):
            terms.no_such_term += p.per_K

        def words(p, terms):
            terms.tempco_per_K = "warm"

        given = [thermopower.parameter("per_K", "1/K", 0.0, 0.01, [0.002])]
        for act, error, told in ((broken, AttributeError, "no_such_term"), (words, thermopower.InvalidInput, "expected a number")):
            effect = thermopower.Effect("broken", act, on="electrical", parameters=given)
            with self.assertRaises(error) as caught:
                thermopower.predict(dict(MODEL, effects={"broken": {"per_K": 0.001}}), self.train, effects=[effect])
            self.assertIn(told, str(caught.exception))
        with self.assertRaises(thermopower.InvalidInput):
            thermopower.Effect("nowhere", broken, on="everywhere", parameters=given)
        with self.assertRaises(thermopower.InvalidInput):  # an id that there is
            thermopower.check(MODEL, self.train, effects=[thermopower.Effect("radiation", words, on="electrical", parameters=given)])


def film(x, tail):
    """Share of dry friction at a rate over its transition, as plant::film_share has it."""
    steep, gentle, abrupt = np.tanh(x), x / (abs(x) + 1.0), (abs(x + 1.0) - abs(x - 1.0)) * 0.5
    size = abs(tail)
    return steep + (size + tail) * 0.5 * (gentle - steep) + (size - tail) * 0.5 * (abrupt - steep)


def sweep(seconds, seed=1):
    """A command that swings an axis at rising frequency, and where the axis starts; what is not judged is left out."""
    t = np.arange(0.0, seconds, 0.01)
    drive = 0.8 * np.sin(2.0 * np.pi * (0.3 + 0.05 * t) * t + seed) + 0.3 * np.sign(np.sin(1.1 * t))
    return {"t_s": t, "drive_A": drive, "angle_deg": np.zeros(len(t)), "rate_dps": np.zeros(len(t)), "motor_C": np.full(len(t), 40.0)}


AXIS = {
    "format": "thermopower-model/1",
    "name": "joint",
    "axis": {"law": "rigid", "inertia_kgm2": 2e-3, "viscous_Nms_per_rad": 2e-3, "torque_constant_Nm_per_A": 0.1},
}


class Twins(unittest.TestCase):
    """Effects of the catalogue, each written once more in Python with whatever such effects can have."""

    def same(self, model, recording, effect, own, known):
        """The effect in Python does what the catalogue's effects do, and it does something."""
        mine = thermopower.predict(dict(model, effects={effect.id: own}), recording, effects=[effect])
        theirs, bare = thermopower.predict([dict(model, effects=known), model], recording)
        for name, values in theirs.items():
            np.testing.assert_allclose(mine[name], values, rtol=1e-9, atol=1e-9, err_msg=name)
        self.assertTrue(any(np.nanmax(abs(bare[name] - theirs[name])) > 1e-3 for name in theirs if name != "t_s"))

    def test_a_second_mass(self):
        def housing(p, shape):
            shape.two_nodes = True
            shape.winding_share, shape.coupling_W_per_K = p.share, p.W_per_K

        effect = thermopower.Effect("housing", housing, on="thermal_structure",
                                    parameters=[thermopower.parameter("share", "1", 0.01, 0.97, [0.12, 0.4]),
                                                thermopower.parameter("W_per_K", "W/K", 1e-3, 1e3, [0.1, 1.0, 8.0], logarithmic=True)])
        truth = {"second_thermal_mass": {"winding_share": 0.3, "coupling": 0.5}}
        self.same(MODEL, motor(900, 1), effect, {"share": 0.3, "W_per_K": 0.5}, truth)

        def measured(seed):
            run, noise = motor(1200, seed), np.random.default_rng(seed)
            seen = thermopower.predict(dict(MODEL, effects=truth), run)
            return dict(run, **{name: seen[name] + noise.normal(0.0, sd, len(run["t_s"])) for name, sd in (("current_A", 0.004), ("motor_C", 0.1))})

        found = thermopower.diagnose(MODEL, measured(1), measured(2), effects=[effect], without=["second_thermal_mass"], effects_at_once=1)
        self.assertEqual([one.effect for one in found.cause], ["housing"])
        for name, value in (("share", 0.3), ("W_per_K", 0.5)):
            told = found.cause[0].parameters[name]
            self.assertAlmostEqual(told.value, value, delta=told.ci95[1] - told.ci95[0])

    def test_a_spring_and_a_delay(self):
        def spring(p, shape):
            shape.compliant, shape.delayed = True, True
            shape.far_share, shape.spring_rad_per_s, shape.spring_damping = p.share, 2.0 * np.pi * p.Hz, p.damping
            shape.delay_s = shape.delay_s + p.delay_s

        effect = thermopower.Effect("spring", spring, on="axis_structure", parameters=[
            thermopower.parameter("share", "1", 0.01, 0.97, [0.2]), thermopower.parameter("Hz", "Hz", 0.2, 300.0, [3.0], logarithmic=True),
            thermopower.parameter("damping", "1", 1e-4, 2.0, [0.03], logarithmic=True), thermopower.parameter("delay_s", "s", 0.0, 0.5, [0.01])])
        self.same(AXIS, sweep(4.0), effect, {"share": 0.4, "Hz": 4.0, "damping": 0.05, "delay_s": 0.02},
                  {"compliance": {"far_share": 0.4, "frequency_Hz": 4.0, "damping": 0.05}, "actuation_delay": {"s": 0.02}})

    def test_a_state_of_the_drive(self):
        self.same(AXIS, sweep(4.0), LAG, {"lag_s": 0.05}, {"drive_lag": {"lag_s": 0.05}})

    def test_a_state_of_the_friction(self):
        def bristles(p, terms):
            z = terms.own.bent_rad
            z.slope, z.per_s = terms.rate_rad_per_s, abs(terms.rate_rad_per_s) / p.bend_rad
            terms.torque_Nm += p.Nm / p.bend_rad * (z.value + p.damping_s * (z.slope - z.per_s * z.value))

        effect = thermopower.Effect("bristles", bristles, on="friction", states={"bent_rad": "rad"}, parameters=[
            thermopower.parameter("Nm", "N m", 0.0, 1e3, [0.005]), thermopower.parameter("bend_rad", "rad", 2e-3, 1.0, [0.01], logarithmic=True),
            thermopower.parameter("damping_s", "s", 0.0, 0.02, [0.0], standard=0.0)])
        self.same(AXIS, sweep(4.0), effect, {"Nm": 0.02, "bend_rad": 0.05, "damping_s": 0.002},
                  {"presliding_friction": {"Nm": 0.02, "bend_rad": 0.05, "damping_s": 0.002}})
        # A model may leave out what has a standard value.
        self.same(AXIS, sweep(2.0), effect, {"Nm": 0.02, "bend_rad": 0.05}, {"presliding_friction": {"Nm": 0.02, "bend_rad": 0.05}})

    def test_dry_friction(self):
        def rubbing(p, terms):
            terms.add_friction(p.Nm, 1.0 * p.Nm, 0.02, tail=0.3)

        effect = thermopower.Effect("rubbing", rubbing, on="friction", parameters=[thermopower.parameter("Nm", "N m", 0.0, 1e3, [0.005])])
        self.same(AXIS, sweep(4.0), effect, {"Nm": 0.02}, {"coulomb_friction": {"Nm": 0.02, "transition_rad_per_s": 0.02, "tail": 0.3}})

    def test_two_places(self):
        def copper(p, terms):
            terms.tempco_per_K += p.per_K

        def ammeter(p, read):
            """The ammeter shows too much."""
            read.current_A *= p.factor

        effect = thermopower.Effect("both", {"electrical": copper, "bench_readings": ammeter}, parameters=[
            thermopower.parameter("per_K", "1/K", 0.0, 0.02, [0.0]), thermopower.parameter("factor", "1", 0.5, 2.0, [1.0])])
        self.same(MODEL, motor(900, 1), effect, {"per_K": 0.004, "factor": 1.1},
                  {"winding_tempco": {"tempco_per_K": 0.004}, "current_sensor_gain": {"gain": 1.1}})

    def test_a_curve(self):
        def cable(p, terms):
            terms.load_Nm += thermopower.curve(terms.angle_rad, [-100.0, 0.3, 100.0], [100.3 * p.k, 0.0 * p.k, -99.7 * p.k])

        effect = thermopower.Effect("cable", cable, on="axis", parameters=[thermopower.parameter("k", "N m/rad", 0.0, 1e3, [0.01])])
        self.same(AXIS, sweep(4.0), effect, {"k": 0.05}, {"cable_spring": {"Nm_per_rad": 0.05, "centre_rad": 0.3}})

    def test_a_state_is_found_and_fitted(self):
        """A drive that follows late, integrated here in steps of a tenth of a millisecond."""
        def late(seed):
            run = sweep(12.0, seed)
            random, omega, theta, torque = np.random.default_rng(seed), 0.0, 0.0, 0.0
            for i, amps in enumerate(run["drive_A"]):
                run["angle_deg"][i], run["rate_dps"][i] = np.degrees(theta), np.degrees(omega)
                for _ in range(100):
                    torque += 1e-4 * (0.1 * amps - torque) / 0.06
                    omega += 1e-4 * (torque - 2e-3 * omega) / 2e-3
                    theta += 1e-4 * omega
            for name, noise in (("angle_deg", 0.02), ("rate_dps", 0.5)):
                run[name] = run[name] + random.normal(0.0, noise, len(run["t_s"]))
            return run

        others = [line.split()[0] for line in thermopower.effects().splitlines() if line and not line[0].isspace()]
        found = thermopower.diagnose(AXIS, late(1), late(2), effects=[LAG], effects_at_once=1,
                                     without=[one for one in others if one not in ("cogging", "cable_spring")])
        self.assertEqual([one.effect for one in found.cause], ["late_drive"])
        self.assertAlmostEqual(found.cause[0].parameters.lag_s.value, 0.06, delta=0.003)
        text, left_out = found.header()  # its function was traced, so that it is written, too
        self.assertIn("static float late_Nm_per_s(", text)
        self.assertFalse(any("late_drive" in one for one in left_out), left_out)

    def test_an_equation_is_traced(self):
        """It is computed without Python: its function is called while it is traced, and never again."""
        calls = []

        def hose(p, terms):
            calls.append(p)
            bend = terms.angle_rad if terms.angle_rad > -0.2 else np.sqrt(abs(terms.angle_rad)) * 0.5
            terms.load_Nm -= p.k * bend**3 + 0.01 * p.k * np.tanh(terms.rate_rad_per_s)

        effect = thermopower.Effect("hose", hose, on="axis", parameters=[thermopower.parameter("k", "N m/rad^3", 0.0, 10.0, [1e-3])])
        self.assertTrue(effect.is_traced)
        calls.clear()
        model = dict(AXIS, effects={"hose": {"k": 0.05}})
        thermopower.predict(model, sweep(0.1), effects=[effect])
        few = len(calls)
        calls.clear()
        thermopower.predict(model, sweep(4.0), effects=[effect])
        self.assertEqual(len(calls), few)

    def test_what_cannot_be_traced_is_called(self):
        count = [0]

        def bent(p, terms):
            terms.load_Nm -= p.k * np.arctan(terms.angle_rad)

        def halved(p, terms):
            rest, scale = terms.angle_rad, 1.0
            while abs(rest) > 1.0:
                rest, scale = rest / 2.0, scale * 2.0
            terms.load_Nm -= p.k * rest * scale

        def counted(p, terms):
            count[0] += 1
            terms.load_Nm -= p.k * count[0]

        given = [thermopower.parameter("k", "N m/rad", 0.0, 10.0, [1e-3])]
        for act in (bent, halved, counted):
            effect = thermopower.Effect("x", act, on="axis", parameters=given)
            self.assertFalse(effect.is_traced, act.__name__)
        effect = thermopower.Effect("x", halved, on="axis", parameters=given)
        self.same(AXIS, sweep(2.0), effect, {"k": 0.05}, {"cable_spring": {"Nm_per_rad": 0.05, "centre_rad": 0.0}})

    def test_what_cannot_be_is_told(self):
        def nothing(p, terms):
            pass

        def half(p, shape):
            shape.two_nodes = "yes"

        given = [thermopower.parameter("k", "1", 0.0, 1.0, [0.5])]
        made = lambda *arguments, **named: thermopower.check(MODEL, motor(60, 1), effects=[thermopower.Effect("x", *arguments, parameters=given, **named)])
        for call, told in (
                (lambda: made(nothing, on="thermal", states={"z_K": "K"}), "has states, but no hook"),
                (lambda: made(nothing, on="axis", states={"a": "1", "b": "1", "c": "1"}), "more than 2 states"),
                (lambda: made(nothing, on="axis", needs=["wind"]), "needs 'wind', expected one of"),
                (lambda: made({"axis": nothing, "elsewhere": nothing}), "on is 'elsewhere'"),
                (lambda: made({"axis": nothing}, on="axis"), "says itself on what"),
                (lambda: made({}), "says itself on what"),
                (lambda: thermopower.check(MODEL, motor(60, 1), effects=[thermopower.Effect("x", nothing, on="axis", parameters=[
                    thermopower.parameter("k", "1", 0.0, 1.0, [0.5], starts_as_shares_of="torque")])]), "expected drive_A"),
                (lambda: thermopower.predict(dict(MODEL, effects={"x": {"k": 0.5}}), motor(60, 1),
                                             effects=[thermopower.Effect("x", half, on="thermal_structure", parameters=given)]), "expected True or False"),
                (lambda: thermopower.curve(1.0, [0.0, 1.0], [1.0]), "2 points and 1 values"),
                (lambda: thermopower.curve(1.0, [0.0, 0.0], [1.0, 2.0]), "expected numbers that increase")):
            with self.assertRaises(thermopower.InvalidInput) as caught:
                call()
            self.assertIn(told, str(caught.exception))


class Derivatives(unittest.TestCase):
    def test_against_differences(self):
        """Of every function that numbers with derivatives know."""
        variable = thermopower._thermopower.Dual.variable
        points, values = [-1.0, 0.2, 0.7, 3.0], [2.0, -1.0, 0.5, 4.0]
        functions = [np.exp, np.log, np.sin, np.cos, np.tan, np.tanh, np.sqrt, np.square, np.expm1, np.log1p, np.sinh, np.cosh, np.arcsin,
                     np.arccos, np.arctan, abs, lambda x: x**3, lambda x: x**-2, lambda x: x**0.7, lambda x: x**x, lambda x: 2.0**x,
                     lambda x: 1.0 / x - x / 2.0 + (3.0 - x) * -x, lambda x: film(x, 0.4), lambda x: film(-3.0 * x, -0.7),
                     lambda x: np.maximum(x, 0.4) * np.minimum(x, 0.4) * np.sign(x - 0.5), lambda x: thermopower.curve(x, points, values),
                     lambda x: thermopower.curve(0.6, points, [x, 2.0 * x, x * x, 1.0])]
        for number, function in enumerate(functions):
            for x in (0.15, 0.33, 0.81):
                told = function(variable(x))
                self.assertAlmostEqual(told.value, function(x), places=12, msg=f"{number} at {x}")
                self.assertAlmostEqual(told.slope, (function(x + 1e-6) - function(x - 1e-6)) / 2e-6, delta=1e-6 * (1.0 + abs(told.slope)), msg=f"{number} at {x}")

    def test_curves_are_numpys(self):
        at, values = [-1.0, 0.2, 0.7, 3.0], [2.0, -1.0, 0.5, 4.0]
        for x in np.linspace(-2.0, 4.0, 61):
            self.assertAlmostEqual(thermopower.curve(x, at, values), np.interp(x, at, values), places=12)


def follow(p, terms):
    """The torque follows its command late."""
    late = terms.own.late_Nm
    late.per_s = 1.0 / p.lag_s
    late.slope = terms.drive_Nm * late.per_s
    terms.delivered_Nm += late.value - terms.drive_Nm


LAG = thermopower.Effect("late_drive", follow, on="axis", states={"late_Nm": "N m"}, experiment="steps of the command",
                         parameters=[thermopower.parameter("lag_s", "s", 5e-4, 3.0, [0.005, 0.02, 0.08], logarithmic=True)])


def kettle(constants, start, t_s, inputs, effects):
    """Warms with the power, and loses to the room; exact between rows. Its effect is a lid that is open."""
    loss = constants["loss_W_per_K"] + effects.get("open_lid", {"W_per_K": 0.0})["W_per_K"]
    water = np.empty(len(t_s))
    water[0] = start["water"]
    for i in range(len(t_s) - 1):
        end = inputs["room_C"][i] + inputs["power_W"][i] / loss
        water[i + 1] = end + (water[i] - end) * np.exp(-(t_s[i + 1] - t_s[i]) * loss / constants["water_J_per_K"])
    return {"water_C": water, "end": {"water": water[-1]}}


def kettle_plant(simulate=kettle):
    return thermopower.Plant(
        "kettle", simulate, constants={"water_J_per_K": (4200.0, "J/K"), "loss_W_per_K": (2.0, "W/K")},
        inputs={"power_W": "W", "room_C": "degC"}, states={"water": {"measured_by": "water_C", "initial": 20.0, "spread": 30.0}},
        signals={"water_C": {"unit": "degC", "submodel": "kettle.loss"}},
        effects=[thermopower.Effect("open_lid", submodel="kettle.loss", equation="loss += k (T - T_room)",
                                    parameters=[thermopower.parameter("W_per_K", "W/K", 0.0, 50.0, [0.5, 5.0])])])


def boiled(seed, lid):
    """Two hours of a kettle that is switched every ten minutes."""
    random = np.random.default_rng(seed)
    t = np.arange(0.0, 7200.0, 20.0)
    power = np.where((t // 600.0) % 2 == seed % 2, 300.0, 0.0)
    inputs = {"power_W": power, "room_C": np.full(len(t), 20.0)}
    water = kettle({"water_J_per_K": 4200.0, "loss_W_per_K": 2.0}, {"water": 20.0}, t, inputs, {"open_lid": {"W_per_K": lid}})["water_C"]
    return {"t_s": t, **inputs, "water_C": water + random.normal(0.0, 0.1, len(t))}


class OwnPlants(unittest.TestCase):
    def test_diagnosed_simulated_and_changed(self):
        plant = kettle_plant()
        self.assertEqual(plant.constants, {"water_J_per_K": 4200.0, "loss_W_per_K": 2.0})
        held_out = boiled(2, 1.5)
        found = thermopower.diagnose(plant, boiled(1, 1.5), held_out)
        self.assertEqual([one.effect for one in found.cause], ["open_lid"])
        self.assertAlmostEqual(found.cause[0].parameters.W_per_K.value + found.augmented.constants["loss_W_per_K"], 3.5, delta=0.05)
        self.assertIn("open_lid", found.augmented.acting)
        error = lambda model: np.sqrt(np.mean((thermopower.simulate(model, held_out)["water_C"] - held_out["water_C"]) ** 2))
        self.assertLess(error(found.augmented), 0.15)
        self.assertGreater(error(plant), 1.0)
        self.assertLess(error(plant.changed(effects={"open_lid": {"W_per_K": 1.5}})), 0.15)
        self.assertTrue(found.html().endswith("</html>\n"))

    def test_a_state_that_nobody_measures(self):
        """An element between power and water, which is hot when the log begins; nobody measures it, nor says so."""
        def element(constants, start, t_s, inputs, effects):
            loss = 2.0 + effects.get("open_lid", {"W_per_K": 0.0})["W_per_K"]
            water, hot, read = start["water"], start["element"], np.empty(len(t_s))
            for i in range(len(t_s)):
                read[i] = water
                if i + 1 == len(t_s):
                    break
                for _ in range(10):
                    step, flow = 0.1 * (t_s[i + 1] - t_s[i]), constants["flow_W_per_K"] * (hot - water)
                    hot += step * (inputs["power_W"][i] - flow) / 3000.0
                    water += step * (flow - loss * (water - inputs["room_C"][i])) / constants["water_J_per_K"]
            return {"water_C": read, "end": {"water": water, "element": hot}}

        plant = thermopower.Plant(
            "kettle", element, inputs={"power_W": "W", "room_C": {"unit": "degC", "otherwise": 20.0}},
            constants={"water_J_per_K": {"value": 4200.0, "unit": "J/K", "may_be_cause": False}, "flow_W_per_K": (20.0, "W/K")},
            states={"water": {"measured_by": "water_C", "initial": 20.0, "spread": 30.0, "unit": "degC"},
                    "element": {"shows_in": "water_C", "initial": 20.0, "spread": 100.0, "unit": "degC"}},
            signals={"water_C": {"unit": "degC", "submodel": "kettle.loss",
                                 "balance": {"constant": "water_J_per_K", "quantity": "missing_heat", "unit": "W"}}},
            effects=[thermopower.Effect("open_lid", submodel="kettle.loss", parameters=[thermopower.parameter("W_per_K", "W/K", 0.0, 50.0, [0.5, 5.0])])])

        def logged(seed, element_C):
            t = np.arange(0.0, 3600.0, 20.0)
            inputs = {"power_W": np.where((t // 600.0) % 2 == seed % 2, 300.0, 0.0), "room_C": np.full(len(t), 20.0)}
            water = element(plant.constants, {"water": 20.0, "element": element_C}, t, inputs, {"open_lid": {"W_per_K": 1.5}})["water_C"]
            return {"t_s": t, "power_W": inputs["power_W"], "water_C": water + np.random.default_rng(seed).normal(0.0, 0.1, len(t))}

        found = thermopower.diagnose(plant, logged(1, 140.0), logged(2, 60.0))
        self.assertEqual([one.effect for one in found.cause], ["open_lid"])
        self.assertAlmostEqual(found.cause[0].parameters.W_per_K.value, 1.5, delta=0.15)
        self.assertEqual(found.augmented.constants["water_J_per_K"], 4200.0)

    def test_what_a_plant_cannot_be_is_told(self):
        made = lambda **given: thermopower.Plant("kettle", kettle, **{"constants": {"loss_W_per_K": 2.0}, "inputs": {"power_W": "W"}, "states": {},
                                                                     "signals": {"water_C": {}}, **given})
        for given, told in (({"constants": {"k": {"worth": 2.0}}}, "constant 'k' has no 'worth'"), ({"constants": {"k": {"unit": "W"}}}, "'k' has no value"),
                            ({"inputs": {"power_W": {"default": 1.0}}}, "input 'power_W' has no 'default'"),
                            ({"signals": {"water_C": {"colour": "red"}}}, "signal 'water_C' has no 'colour'"),
                            ({"signals": {"water_C": {"balance": {"constant": "no_such"}}}}, "its balance names 'no_such'"),
                            ({"states": {"water": {"measured_by": "steam_C"}}}, "names the signal 'steam_C'")):
            with self.assertRaises(thermopower.InvalidInput) as caught:
                made(**given)
            self.assertIn(told, str(caught.exception))
        self.assertEqual(made(constants={"offset_K": {"value": -1.0, "above_zero": False}}).constants, {"offset_K": -1.0})

    def test_what_goes_wrong_in_its_function_is_told(self):
        def silent(*_):
            return {"end": {"water": 1.0}}

        def falling(*_):
            raise ZeroDivisionError("no water")

        for function, error, told in ((silent, thermopower.InvalidInput, "did not answer 'water_C'"), (falling, ZeroDivisionError, "no water")):
            with self.assertRaises(error) as caught:
                thermopower.simulate(kettle_plant(function), boiled(1, 0.0))
            self.assertIn(told, str(caught.exception))
        with self.assertRaises(thermopower.InvalidInput):
            kettle_plant().changed({"no_such": 1.0})


class Interrupting(unittest.TestCase):
    def test_ctrl_c_ends_a_diagnosis(self):
        script = textwrap.dedent("""
            import sys, time
            sys.path.insert(0, sys.argv[1])
            import test_thermopower as t, thermopower
            def slow(*arguments):
                time.sleep(0.02)
                print("begun", flush=True)
                return t.kettle(*arguments)
            try:
                thermopower.diagnose(t.kettle_plant(slow), t.boiled(1, 1.5), t.boiled(2, 1.5))
            except KeyboardInterrupt:
                print("interrupted", flush=True)
        """)
        child = subprocess.Popen([sys.executable, "-B", "-c", script, os.path.dirname(os.path.abspath(__file__))],
                                 stdout=subprocess.PIPE, text=True)
        for _ in range(10):
            self.assertEqual(child.stdout.readline(), "begun\n")
        child.send_signal(signal.SIGINT)
        began = time.monotonic()
        said = child.communicate(timeout=60)[0]
        self.assertIn("interrupted", said)
        self.assertEqual(child.returncode, 0)
        self.assertLess(said.count("begun"), 400)  # the whole of it takes thousands
        self.assertLess(time.monotonic() - began, 30.0)


class Package(unittest.TestCase):
    HERE = os.path.dirname(os.path.abspath(__file__))
    ROOT = os.path.dirname(os.path.dirname(HERE))

    def test_stubs_say_what_there_is(self):
        with open(os.path.splitext(thermopower.__file__)[0] + ".pyi", encoding="utf-8") as file:
            stubs = {one.name: one for one in ast.parse(file.read()).body if hasattr(one, "name")}
        self.assertEqual(sorted(stubs), sorted(thermopower.__all__))

        def names(function):
            given = function.args
            return [one.arg for one in given.posonlyargs + given.args + given.kwonlyargs]

        for name, stub in stubs.items():
            real = getattr(thermopower, name)
            if isinstance(stub, ast.FunctionDef):
                taken = [one for one, what in inspect.signature(real).parameters.items() if what.kind != what.VAR_KEYWORD]
                self.assertEqual(names(stub)[: len(taken)], taken, name)
                options = [one for one in names(stub)[len(taken):] if one not in dir(thermopower._thermopower.Options)]
                self.assertEqual(options, [], name)
                continue
            for member in stub.body:
                if isinstance(member, ast.FunctionDef) and hasattr(real, member.name) and not issubclass(real, ValueError):
                    function = inspect.getattr_static(real, member.name)
                    if isinstance(function, property):
                        continue
                    self.assertEqual(names(member), list(inspect.signature(function).parameters), f"{name}.{member.name}")
                elif isinstance(member, ast.FunctionDef):
                    self.fail(f"there is no {name}.{member.name}")

    def test_pip_installs_it_without_network(self):
        build = os.environ.get("THERMOPOWER_BUILD")
        if subprocess.run([sys.executable, "-m", "pip", "--version"], capture_output=True).returncode != 0 or not build:
            self.skipTest("no pip (Debian: python3-pip)")
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--disable-pip-version-check",
                                   "--root-user-action=ignore", "--target", folder, "--config-settings", f"build-dir={build}", self.ROOT],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            version = subprocess.run([sys.executable, "-B", "-c", "import importlib.metadata, thermopower;"
                                      "print(thermopower.__file__, importlib.metadata.version('thermopower'), len(thermopower.effects()) > 100)"],
                                     env=dict(os.environ, PYTHONPATH=folder), capture_output=True, text=True, check=True).stdout
            self.assertIn(folder, version)
            self.assertIn("True", version)

    def test_the_notebook_runs(self):
        with open(os.path.join(self.ROOT, "examples", "notebook", "known_gap.ipynb"), encoding="utf-8") as file:
            cells = json.load(file)["cells"]
        os.environ.setdefault("MPLBACKEND", "Agg")
        names = {}
        code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        self.assertGreater(len(code), 5)
        for cell in code:
            exec(compile(cell, "known_gap.ipynb", "exec"), names)
        self.assertEqual(names["found"].verdict, "explained")
        self.assertTrue(all(not cell.get("outputs") for cell in cells))  # as it was written, not as it ran somewhere

    def test_plot_draws_every_curve(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("no matplotlib (Debian: python3-matplotlib)")
        matplotlib.use("Agg")
        found = thermopower.diagnose(MODEL, motor(600, 1), motor(400, 2))
        figure = found.plot()
        self.assertEqual(len(figure.axes), len(found.series))
        for axis, one in zip(figure.axes, found.series):
            self.assertEqual(axis.get_ylabel(), f"{one['signal']} / {one['unit']}")
            measured, baseline, augmented = axis.get_lines()
            np.testing.assert_array_equal(measured.get_ydata(), one["measured"])
            np.testing.assert_array_equal(baseline.get_ydata(), one["baseline"])
            np.testing.assert_array_equal(augmented.get_ydata(), one["augmented"])


def load_tests(loader, tests, pattern):
    tests.addTests(doctest.DocTestSuite(thermopower))
    return tests


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
