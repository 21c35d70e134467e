# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""The Python module against a motor that is integrated here, in NumPy, and knows nothing of the library."""

import doctest
import json
import os
import subprocess
import sys
import tempfile
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


def load_tests(loader, tests, pattern):
    tests.addTests(doctest.DocTestSuite(thermopower))
    return tests


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
