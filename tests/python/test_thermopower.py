# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""The Python module against a motor that is integrated here, in NumPy, and knows nothing of the library."""

import ast
import doctest
import inspect
import json
import os
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
