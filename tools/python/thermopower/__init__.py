# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Where a simulated actuator and the real one part, and which effect is missing.

Models are dicts, spelt as in a model file. Recordings are dicts of arrays, pandas DataFrames, or paths of CSV files;
columns are named as in those files (`t_s`, `motor_C`, `drive_A`, ...), and a column `run` labels independent runs.

>>> import numpy as np
>>> import thermopower
>>> t = np.arange(0.0, 60.0, 1.0)
>>> motor = {"format": "thermopower-model/1", "supply": {"nominal_V": 12.0},
...          "current": {"law": "ohmic", "resistance_ohm": 8.0},
...          "thermal": {"law": "lumped", "heat_capacity_J_per_K": 60.0, "conductance_W_per_K": 0.1}}
>>> heated = thermopower.predict(motor, {"t_s": t, "power_param": np.full(60, 255.0), "ambient_C": np.full(60, 20.0)})
>>> sorted(heated)
['current_A', 'motor_C', 't_s']
>>> round(float(heated["current_A"][0]), 3)  # 12 V at 8 ohm, which are those at 25 degrees
1.5
"""

import csv
import json
import os
import shlex

import numpy as np

from . import _thermopower
from ._thermopower import InputError, InvalidInput, OutputError

__version__ = _thermopower.version

__all__ = ["Check", "Columns", "Design", "Diagnosis", "Effect", "Fleet", "InputError", "InvalidInput", "OutputError", "Part", "Plant", "Text", "check", "columns",
           "compare", "curve", "diagnose", "effects", "explain", "fleet", "parameter", "predict", "read_model", "simulate"]


class Text(str):
    """A text that a prompt shows with its lines."""

    def __repr__(self):
        return str(self)


class Part:
    """Part of a result: keys of the report are attributes, and items, too."""

    def __init__(self, content):
        self._content = content

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._content:
            raise AttributeError(f"there is no '{name}' here; there is {', '.join(self._content)}")
        return _part(self._content[name])

    def __getitem__(self, name):
        return _part(self._content[name])

    def __contains__(self, name):
        return name in self._content

    def __iter__(self):
        return iter(self._content)

    def __len__(self):
        return len(self._content)

    def __dir__(self):
        return list(self._content) + ["as_dict"]

    def __repr__(self):
        return f"Part({self._content!r})"

    def as_dict(self):
        """The plain dict behind it, as in the JSON report."""
        return self._content


def _part(value):
    if isinstance(value, dict):
        return Part(value)
    if isinstance(value, list):
        return [_part(one) for one in value]
    return value


def parameter(name, unit="1", lower=0.0, upper=1.0, starts=(), logarithmic=False, *, standard=None, exceeds="", starts_as_shares_of="",
              degenerate_at_bounds=False, periods_in_travel=0.0):
    """A parameter of an effect of one's own: bounds, and where fits begin; logarithmic where only its order of magnitude is known.

    standard: its value where a model leaves it out. exceeds: another parameter that it must exceed, or nothing shows it.
    starts_as_shares_of: an input ("drive_A", "power_param" or "supply_V") of whose largest magnitude the starts are shares.
    degenerate_at_bounds: a fit that ends at a bound explains nothing. periods_in_travel: it counts periods of the angle, so
    many of which must lie within the recorded travel.

    >>> parameter("Nm_s2_per_rad2", "N m s^2/rad^2", 0.0, 1.0, [1e-5])["upper"]
    1.0
    """
    starts = [float(one) for one in starts] or [(lower * upper) ** 0.5 if logarithmic else 0.5 * (lower + upper)]
    return {"name": name, "unit": unit, "lower": float(lower), "upper": float(upper), "starts": starts, "logarithmic": bool(logarithmic),
            "standard": None if standard is None else float(standard), "exceeds": exceeds, "starts_as_shares_of": starts_as_shares_of,
            "degenerate_at_bounds": bool(degenerate_at_bounds), "periods_in_travel": float(periods_in_travel)}


def curve(x, at, values):
    """A curve over a variable: straight between points, level beyond the outer ones. For equations of effects, too.

    x: a number. at: numbers that increase. values: as many, such as parameters of an effect.

    >>> curve(2.5, [0.0, 2.0, 4.0], [1.0, 1.0, 3.0])
    1.5
    >>> def rail(p, terms):
    ...     terms.load_Nm += curve(terms.angle_rad, [-1.0, 0.0, 1.0], list(vars(p).values()))
    """
    if len(at) != len(values) or len(at) == 0:
        raise InvalidInput(f"a curve has {len(at)} points and {len(values)} values; expected as many of each, and one at least")
    if any(not low < high for low, high in zip(at, at[1:])):
        raise InvalidInput(f"the points of a curve are {list(at)}; expected numbers that increase")
    if not x > at[0]:
        return values[0]
    for low, high, first, last in zip(at, at[1:], values, values[1:]):
        if x < high:
            return first + (last - first) * ((x - low) / (high - low))
    return values[-1]


class Effect:
    """An effect of one's own, which is simulated, fitted, weighed and reported like those of the catalogue.

    act(p, terms): its equation, called with its parameters and the terms of the place it acts on, both with attributes. It
    changes terms in place, and answers equal calls equally. It is called once, with numbers that write down what is done to them,
    and then computed without Python. They know +, -, *, /, **, abs(), comparisons, curve() and NumPy's exp, log, sin, cos, tan, tanh
    and sqrt. A function that does more is called at each step: is_traced is False then. In fits its numbers carry their derivatives.
    on: "electrical", "air", "thermal", "bench_readings", "drive", "axis", "friction" or "axis_readings"; terms are those of the
    C++ documentation (plant/terms.hpp), such as terms.rate_rad_per_s and terms.load_Nm on an axis. "thermal_structure" and
    "axis_structure" set the model's shape once per simulation: a second mass, a spring.
    An effect that acts on several places is a dict of functions by place, without on.
    states: what the joint remembers because of it, name to unit, on "axis" or "friction": terms.own.<name> has its value,
    and the function sets slope and per_s of d(value)/dt = slope - per_s value.
    needs: what must be recorded or modelled for it, as in lists of effects ("airspeed_mps"), beside what its places need.
    costly: looked at only where no cheaper cause alone explains the data.
    strikes: sides meet and part in it, so that a fit of its parameters stands in one of many hollows: the diagnosis looks beside it.
    For an effect that a Plant switches on itself, leave act and on out, and say the submodel.

    >>> def hose(p, terms):
    ...     terms.load_Nm -= p.Nm_per_rad3 * terms.angle_rad**3
    >>> Effect("stiffening_hose", hose, on="axis", parameters=[parameter("Nm_per_rad3", starts=[1e-3])]).id
    'stiffening_hose'
    """

    _submodels = {"electrical": "electrical", "air": "thermal.loss", "thermal": "thermal.heating", "thermal_structure": "thermal.storage",
                  "bench_readings": "sensing.temperature", "drive": "mechanical.drive", "axis": "mechanical.load",
                  "friction": "mechanical.friction", "axis_structure": "mechanical.structure", "axis_readings": "sensing.angle"}

    def __init__(self, id, act=None, *, on=None, parameters=(), submodel=None, equation="", prose="", experiment="", states=None, needs=(),
                 costly=False, strikes=False):
        if hasattr(act, "items"):
            if on is not None or not act:
                raise InvalidInput(f"effect '{id}': a dict of functions says itself on what they act")
            acts = dict(act)
        else:
            if (act is None) != (on is None):
                raise InvalidInput(f"effect '{id}': act and on go together")
            acts = {} if act is None else {on: act}
        for place in acts:
            if place not in self._submodels:
                raise InvalidInput(f"effect '{id}': on is '{place}', expected one of {', '.join(self._submodels)}")
        submodel = submodel or (self._submodels[next(iter(acts))] if acts else None)
        if submodel is None:
            raise InvalidInput(f"effect '{id}': expected the submodel that it acts in")
        words = [one.__doc__ for one in acts.values() if one.__doc__]
        self.id = id
        self._given = {"id": id, "acts": acts, "parameters": list(parameters), "submodel": submodel,
                       "equation": equation or f"{id}: a function in Python",
                       "prose": prose or (words[0] if words else id).strip().splitlines()[0], "experiment": experiment or "vary every input",
                       "states": list(dict(states or {}).items()), "needs": list(needs), "costly": bool(costly),
                       "strikes": bool(strikes)}

    @property
    def is_traced(self):
        """Whether it is computed without Python, but for what shapes the model."""
        return _thermopower.is_traced(self._given)

    def __repr__(self):
        return f"Effect({self.id!r})"


class Plant:
    """A plant of one's own: a Python function that simulates it.

    simulate(constants, start, t_s, inputs, effects) gets dicts by name: numbers, numbers, arrays, and of each effect that acts a
    dict of its parameters; t_s begins at 0. It answers with a dict of arrays, one for each signal, and "end", a dict of the
    states at the last row, where states are not measured. It must answer equal calls equally. Derivatives are taken from
    differences, so a fit calls it some hundred times.

    constants: name to value, to (value, unit), or to a dict of value, unit, part, may_be_cause (False: it is known) and
    above_zero (False: it may have any value). inputs: name to unit, or to a dict of unit and otherwise, its value where it is
    not recorded. states: name to a dict of measured_by (a signal) or shows_in (the signal that tells its start), initial,
    spread and unit. signals: name to a dict of unit, submodel, note (how it is judged, for the evidence) and balance: a dict of
    constant, quantity, unit and leaves_by, which makes a missing heat, torque or flow of a missing rate.
    windowed: runs in windows that start from measured states, as an axis does, else over whole runs.
    """

    def __init__(self, name, simulate, *, constants, inputs, states, signals, effects=(), windowed=False):
        order = list(signals)

        def place(state, key, otherwise):
            if key not in state:
                return otherwise
            if state[key] not in order:
                raise InvalidInput(f"plant '{name}': a state names the signal '{state[key]}'; there is {', '.join(order)}")
            return order.index(state[key])

        def spelt_out(kind, key, given, standard):
            for one in given:
                if one not in standard:
                    raise InvalidInput(f"plant '{name}': {kind} '{key}' has no '{one}'; there is {', '.join(standard)}")
            return {"name": key, **standard, **given}

        def constant(key, given):
            if isinstance(given, (list, tuple)):
                given = dict(zip(("value", "unit"), given))
            given = given if hasattr(given, "items") else {"value": given}
            one = spelt_out("constant", key, given, {"value": None, "unit": "1", "part": name, "may_be_cause": True, "above_zero": True})
            if one["value"] is None:
                raise InvalidInput(f"plant '{name}': constant '{key}' has no value")
            return {**one, "value": float(one["value"])}

        def fed(key, given):
            return spelt_out("input", key, given if hasattr(given, "items") else {"unit": given}, {"unit": "1", "otherwise": None})

        def shown(key, given):
            one = spelt_out("signal", key, given, {"unit": "1", "submodel": f"{name}.{key}", "note": "", "balance": None})
            if one["balance"] is not None:
                one["balance"] = spelt_out("balance of", key, one["balance"], {"constant": "", "quantity": "", "unit": "1", "leaves_by": []})
            return one

        self._effects = [one._given for one in effects]
        self._model = _thermopower.own_plant(
            name, simulate, [constant(*one) for one in constants.items()],
            [fed(*one) for one in (inputs.items() if hasattr(inputs, "items") else ((one, "1") for one in inputs))],
            [{"name": key, "unit": state.get("unit", "1"), "measured_by": place(state, "measured_by", -1),
              "initial": float(state.get("initial", 0.0)), "spread": float(state.get("spread", 1.0)),
              "shows_in": place(state, "shows_in", 0)} for key, state in states.items()],
            [shown(*one) for one in signals.items()], self._effects, windowed)

    @property
    def constants(self):
        """Its constants by name."""
        return self._model.constants()

    @property
    def acting(self):
        """The effects that act in it, each a dict of its parameters."""
        return self._model.effects()

    def changed(self, constants=None, effects=None):
        """The same plant with other constants, and with effects that act: dicts by name."""
        return self._of(self._model.with_(constants or {}, effects or {}))

    def _of(self, model):
        other = object.__new__(Plant)
        other._effects, other._model = self._effects, model
        return other

    def __repr__(self):
        return f"Plant({self._model.name!r}, constants={self.constants!r}, acting={self.acting!r})"


class Check(Part):
    """What is wrong with recordings, and what they can show: the keys of its JSON as attributes; it prints as the program's."""

    def __init__(self, content, text):
        super().__init__(content)
        self._text = text

    def __repr__(self):
        return self._text

    def __str__(self):
        return self._text


class Columns(dict):
    """What the columns of a file seem to be, name of the format to header and unit; it prints as the program's list.

    list(found.choices) goes to columns= of diagnose() and the others.
    """

    def __init__(self, proposed, text):
        super().__init__(proposed)
        self._text = text

    @property
    def choices(self):
        """The proposals as NAME=HEADER:UNIT."""
        return [f"{name}={header}" for name, header in self.items()]

    def __repr__(self):
        return self._text

    def __reduce__(self):
        return (Columns, (dict(self), self._text))


class _Stored:
    """What a pickled diagnosis keeps: everything that was written from it."""

    _texts = ("report", "html", "augmented", "recalibrated", "summary", "markdown", "series", "header", "mjcf", "urdf")

    def __init__(self, result):
        self._kept = {}
        for one in self._texts:
            try:
                self._kept[one] = (getattr(result, one)(), None)
            except ValueError as error:  # a model without a joint has no MJCF
                self._kept[one] = (None, str(error))

    def __getattr__(self, name):
        if name not in _Stored._texts:
            raise AttributeError(name)
        kept, error = self._kept[name]
        if error is not None:
            raise InvalidInput(error)
        return lambda: kept


class Diagnosis(Part):
    """What a diagnosis found: the keys of the JSON report as attributes, and what can be written from it."""

    def __init__(self, result, plant=None):
        super().__init__(json.loads(result.report()))
        self._result = result
        self._plant = plant

    def __repr__(self):
        return self._result.summary()

    def __str__(self):
        return self._result.summary()

    def __dir__(self):
        return super().__dir__() + ["augmented", "recalibrated", "series", "html", "header", "markdown", "mjcf", "urdf", "design", "table", "plot"]

    def __getstate__(self):
        if self._plant is not None:
            raise TypeError("a diagnosis of a Plant holds its Python function; keep as_dict() and html() instead")
        result = self._result if isinstance(self._result, _Stored) else _Stored(self._result)
        return {"_content": self._content, "_kept": result._kept}

    def __setstate__(self, state):
        stored = object.__new__(_Stored)
        stored._kept = state["_kept"]
        self.__dict__.update(_content=state["_content"], _result=stored, _plant=None)

    def __copy__(self):
        other = object.__new__(Diagnosis)
        other.__dict__.update(self.__dict__)
        return other

    def _repr_html_(self):
        page = self.html().replace("&", "&amp;").replace('"', "&quot;")
        return f'<iframe srcdoc="{page}" style="width:100%;height:720px;border:0"></iframe>'

    @property
    def augmented(self):
        """The model with the causes added and its constants moved along: a dict, or a Plant of one's own."""
        if self._plant is not None:
            return self._plant._of(self._result.augmented_model())
        return json.loads(self._result.augmented())

    @property
    def recalibrated(self):
        """The model with its own constants refitted and nothing added: a dict, or a Plant of one's own."""
        if self._plant is not None:
            return self._plant._of(self._result.recalibrated_model())
        return json.loads(self._result.recalibrated())

    @property
    def series(self):
        """Measured and simulated curves of each signal and held-out recording: a list of dicts of arrays."""
        return self._result.series()

    def html(self):
        """The report for people, one self-contained page."""
        return self._result.html()

    def header(self):
        """A C++11 header for firmware, and a list of what it cannot express."""
        return self._result.header()

    def markdown(self):
        """The answer as Markdown, to be pasted into an issue."""
        return Text(self._result.markdown())

    def mjcf(self):
        """The axis with what was found as a model of MuJoCo, and a list of what the format cannot express."""
        return self._result.mjcf()

    def urdf(self):
        """The same as a joint of URDF."""
        return self._result.urdf()

    def design(self, limits, seed=1):
        """The experiment that best tells apart what is left open, within limits: a dict as in a limits file, or its path."""
        if isinstance(limits, (str, os.PathLike)):
            with open(limits, encoding="utf-8") as file:
                limits = json.load(file)
        if self._plant is not None:
            raise InvalidInput("design: a Plant's experiment is designed by hand; expected a diagnosis of a model of the library")
        if isinstance(self._result, _Stored):
            return Design(*_thermopower.design(self._result.report(), json.dumps(limits), seed))
        return Design(*self._result.design(json.dumps(limits), seed))

    def table(self):
        """The table of the gap as a pandas DataFrame, one row per signal."""
        import pandas

        frame = pandas.DataFrame.from_dict(self._content["gap"], orient="index")
        frame.index.name = "signal"
        return frame

    def plot(self):
        """Measured and simulated curves with matplotlib; returns the figure."""
        from matplotlib import pyplot

        series = self.series
        figure, axes = pyplot.subplots(max(len(series), 1), squeeze=False, figsize=(9, 2.6 * max(len(series), 1)))
        for one, axis in zip(series, axes[:, 0]):
            axis.plot(one["t_s"], one["measured"], color="0.5", linewidth=3, label="measured")
            axis.plot(one["t_s"], one["baseline"], color="#d55e00", linestyle="--", label="as configured")
            axis.plot(one["t_s"], one["augmented"], color="#0072b2", label="with the effect")
            axis.set_ylabel(f"{one['signal']} / {one['unit']}")
            axis.set_title(one["recording"], fontsize="small")
        axes[-1, 0].set_xlabel("time / s")
        if series:
            axes[0, 0].legend(loc="best", fontsize="small")
        figure.tight_layout()
        return figure


class Design:
    """The next experiment: what tells apart what a diagnosis leaves open; it prints as the program's.

    ending: "schedule", "enough", "none_of_these", "cannot_decide" or "nothing_possible". schedule: a dict of arrays, t_s and
    each input, which holds until the next row; csv and header are the same as files. They are empty without a schedule.
    """

    def __init__(self, ending, text, schedule, header, page):
        self.ending, self.csv, self.header = ending, schedule, header
        self._text, self._page = text, page

    @property
    def schedule(self):
        """The schedule as arrays by name."""
        rows = list(csv.reader(self.csv.splitlines()))
        return {name: np.array([float(row[i]) for row in rows[1:]]) for i, name in enumerate(rows[0])} if rows else {}

    def html(self):
        """A page with the curves that each explanation predicts."""
        return self._page

    def __repr__(self):
        return self._text


class Fleet(Part):
    """What many logs say together: the keys of fleet.json as attributes; it prints as the program's summary."""

    def __init__(self, out, complete):
        with open(os.path.join(out, "fleet.json"), encoding="utf-8") as file:
            super().__init__(json.load(file))
        self._out, self._complete = out, complete

    def __repr__(self):
        with open(os.path.join(self._out, "summary.txt"), encoding="utf-8") as file:
            return file.read()

    __str__ = __repr__

    def __dir__(self):
        return super().__dir__() + ["complete", "out", "page", "table"]

    def __getstate__(self):
        return dict(self.__dict__)

    def __setstate__(self, state):
        self.__dict__.update(state)

    @property
    def out(self):
        """Folder of the results."""
        return self._out

    @property
    def page(self):
        """Path of the fleet's page; each log has one of its own behind it."""
        return os.path.join(self._out, "fleet.html")

    @property
    def complete(self):
        """Whether every log has a report; table("logs") says why one has none."""
        return self._complete

    def table(self, of="units"):
        """The units, or the "logs", as a pandas DataFrame, one row each."""
        import pandas

        if of not in ("units", "logs"):
            raise InvalidInput(f"table: of is '{of}'; expected units or logs")
        return pandas.read_csv(os.path.join(self._out, of + ".csv"))


def _cell(value):
    """A cell of a manifest: nothing for None and nan, a date as ISO 8601."""
    if value is None or value != value:
        return ""
    return value.isoformat() if hasattr(value, "isoformat") else str(value)


def _manifest(logs, out):
    """Writes rows as a manifest, with paths from its folder on."""
    rows = logs.to_dict("records") if hasattr(logs, "to_dict") else [dict(one) for one in logs]
    names = list(dict.fromkeys(name for row in rows for name in row))
    os.makedirs(out, exist_ok=True)
    path = os.path.join(out, "manifest.csv")
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(names)
        for row in rows:
            cells = {name: _cell(row.get(name)) for name in names}
            for name in ("log", "model", "heldout", "map"):
                if cells.get(name):
                    cells[name] = os.path.relpath(cells[name], out)
            table.writerow([cells[name] for name in names])
    return path


def _choices(columns):
    """columns= as a list of NAME=HEADER[:UNIT]; a text is what a finding says to type: '--column a=b --column c=d'."""
    words = shlex.split(columns) if isinstance(columns, str) else [str(one) for one in columns]
    return [one[len("--column "):] if one.startswith("--column ") else one for one in words if one != "--column"]


def _supply_of(taken, reading, rows):
    """The supply's voltage in each row of a frame, or nothing where only the model knows it."""
    if "supply_V" in reading.constants:
        return np.full(rows, reading.constants["supply_V"])
    for text in reading.choices:
        column, header = _thermopower.choice_of(text)
        if column == "supply_V" and header in taken:
            return _thermopower.chosen_values(text, np.asarray(taken[header], float), reading.how, np.zeros(0))
    return np.asarray(taken["supply_V"], float) if "supply_V" in taken else np.zeros(0)


class _Reading:
    """How recordings are read: what they do not say of themselves, and what of it a model says."""

    def __init__(self, columns=(), constants=None, rows_per_s=0.0, model=None):
        self.choices = _choices(columns)
        self.constants = {str(name): float(value) for name, value in dict(constants or {}).items()}
        self.rows_per_s = float(rows_per_s)
        for name in self.constants:
            if name in ("t_s", "run"):
                raise InvalidInput(f"constants: {name} is not a constant")
        self.how = _thermopower.Reading(self.choices, list(self.constants.items()), self.rows_per_s, model)


def _chosen(taken, name, reading):
    """The columns of a frame by the names of the format, in its units."""
    choices = reading.choices
    chosen = {}
    supply = np.zeros(0)
    for text in choices:
        column, header = _thermopower.choice_of(text)
        if header not in taken:
            raise InputError(f"{name}: there is no column '{header}' (asked for as {column}); found {', '.join(taken)}")
        try:
            values = np.asarray(taken[header], dtype=float)
        except (TypeError, ValueError):
            raise InputError(f"{name}: column '{header}' (asked for as {column}) holds {taken[header].dtype}; expected numbers") from None
        if column == "voltage_V":
            supply = _supply_of(taken, reading, len(values))
        chosen[column] = _thermopower.chosen_values(text, values, reading.how, supply)
    used = {_thermopower.choice_of(text)[1] for text in choices}
    return {**{key: values for key, values in taken.items() if key not in used and key not in chosen}, **chosen}


def _seconds(values):
    """Stamps in seconds: dates count from the first, time deltas are what they are."""
    values = np.asarray(values)
    if values.dtype.kind == "M":
        return (values - values[0]) / np.timedelta64(1, "s") if len(values) else values.astype(float)
    if values.dtype.kind == "m":
        return values / np.timedelta64(1, "s")
    if values.dtype.kind == "O" and len(values) and all(hasattr(one, "timestamp") for one in values):
        first = values[0].timestamp()
        return np.array([one.timestamp() - first for one in values])
    return values


def _stamps_of_index(data):
    """The index of a frame where it is time: named t_s, or dates, or time deltas."""
    index = getattr(data, "index", None)
    if index is None or callable(index) or not hasattr(index, "dtype"):
        return None
    is_time = getattr(index, "name", None) == "t_s" or getattr(index.dtype, "kind", "") in "Mm"
    return np.asarray(index) if is_time else None


def _recording(data, name, reading):
    if isinstance(data, _thermopower.Recording):
        return data
    if isinstance(data, (str, os.PathLike)):
        return _thermopower.read_recording(os.fspath(data), reading.how)
    if not hasattr(data, "keys"):
        raise InputError(f"{name}: is a {type(data).__name__}; expected a dict of arrays, a DataFrame or a path")
    taken = {str(key): np.asarray(data[key]) for key in data.keys()}
    taken = _chosen(taken, name, reading)
    if "t_s" not in taken and _stamps_of_index(data) is not None:
        taken["t_s"] = _stamps_of_index(data)
    if "t_s" not in taken and reading.rows_per_s > 0.0 and taken:
        taken["t_s"] = np.arange(len(next(iter(taken.values())))) / reading.rows_per_s
    if "t_s" in taken:
        taken["t_s"] = _seconds(taken["t_s"])
    if "t_s" not in taken:
        raise InputError(f"{name}: there is no column 't_s'; expected the time of each row in seconds, or rows_per_s=")
    rows = len(taken["t_s"])
    for key, value in reading.constants.items():
        if key in taken:
            raise InputError(f"{name}: column '{key}' is there, and is given as a constant, too; expected one of the two")
        taken[key] = np.full(rows, value)
    arrays = {}
    for key, values in taken.items():
        if values.ndim != 1 or len(values) != rows:
            raise InputError(f"{name}: column '{key}' has the shape {values.shape}; expected ({rows},) as t_s has")
        if key == "run":
            continue
        if values.dtype.kind not in "biuf":
            try:
                values = values.astype(float)
            except (TypeError, ValueError):
                if key not in _thermopower.known_columns:
                    continue  # text, as in a file
                raise InputError(f"{name}: column '{key}' holds {values.dtype}; expected numbers") from None
        values = values.astype(float)
        infinite = np.flatnonzero(np.isinf(values))
        if len(infinite):
            raise InputError(f"{name}: column '{key}' is infinite in row {infinite[0]}; expected a number, or nan where it is missing")
        arrays[key] = values
    runs = []
    if "run" in taken:
        labels = [str(one) for one in taken["run"]]
        runs = [(row, label) for row, label in enumerate(labels) if row == 0 or label != labels[row - 1]]
    t_s = arrays.pop("t_s")
    return _thermopower.Recording(name, t_s, runs, list(arrays.items()))


def _recordings(data, name, reading):
    if data is None:
        return []
    if isinstance(data, (list, tuple)):
        return [_recording(one, f"{name}[{i}]", reading) for i, one in enumerate(data)]
    return [_recording(data, name, reading)]


def _own(effects):
    return [one._given for one in effects]


def _model(model, effects=()):
    if isinstance(model, Plant):
        if effects:
            raise InvalidInput("effects= is for models of the library; a Plant has its own from the start")
        return model._model
    if isinstance(model, (str, os.PathLike)):
        if not effects:
            model = read_model(model)
        else:
            with open(model, encoding="utf-8") as file:
                model = json.load(file)
    return _thermopower.model(json.dumps(model), _own(effects))


def _options(options):
    made = _thermopower.Options()
    made.threads = os.cpu_count() or 1
    for name, value in options.items():
        if not hasattr(made, name):
            known = ", ".join(one for one in dir(made) if not one.startswith("_"))
            raise TypeError(f"there is no option '{name}'; there is {known}")
        setattr(made, name, value)
    return made


def read_model(path):
    """A model file as a dict, checked as the program checks it."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    try:
        return json.loads(_thermopower.normalised(text))
    except InputError as error:
        raise InputError(f"{os.fspath(path)}{str(error)[len('model'):]}") from None


def diagnose(model, recordings, held_out=None, columns=(), effects=(), constants=None, rows_per_s=0.0, **options):
    """Finds where the model and the recordings part, and which effect is missing.

    held_out: recordings to judge on; without them the last 30 % of each recording. columns: as the program's --column, a
    list of NAME=HEADER[:UNIT]. constants: columns that the recordings lack and that did not change, such as
    {"ambient_C": 24.0}. rows_per_s: of recordings without time. A finding's mend says in these words what to pass. effects: of
    one's own (Effect), beside those of the catalogue. Ctrl-C ends it. Options are those of the program: horizon_s, tolerance,
    held_out_fraction, effects_at_once, without, as_recorded, threads, seed.
    """
    known = _model(model, effects)
    reading = _Reading(columns, constants, rows_per_s, known)
    found = _thermopower.diagnose(known, _own(effects), _recordings(recordings, "recordings", reading),
                                  _recordings(held_out, "held_out", reading), _options(options), reading.how)
    return Diagnosis(found, model if isinstance(model, Plant) else None)


def check(model, recordings, held_out=None, columns=(), effects=(), constants=None, rows_per_s=0.0, **options):
    """What is wrong with recordings, and what they can show; nothing is fitted. Arguments as in diagnose()."""
    known = _model(model, effects)
    reading = _Reading(columns, constants, rows_per_s, known)
    content, text = _thermopower.check(known, _own(effects), _recordings(recordings, "recordings", reading),
                                       _recordings(held_out, "held_out", reading), _options(options), reading.how)
    return Check(json.loads(content), text)


def _stamps(source):
    return np.asarray(_seconds(source["t_s"] if "t_s" in source.keys() else _stamps_of_index(source)), float)


def _simulate(models, recordings, starts, horizon_s, from_inputs, threads, columns, effects, constants):
    many_models, many = isinstance(models, (list, tuple)), isinstance(recordings, (list, tuple))
    sources = list(recordings) if many else [recordings]
    known = [_model(one, effects) for one in (models if many_models else [models])]
    taken = _recordings(sources, "recording", _Reading(columns, constants, 0.0, known[0] if known else None))
    found = _thermopower.simulate(
        known, _own(effects), taken, starts, horizon_s, from_inputs, threads or os.cpu_count() or 1
    )
    results = [
        [{**({"t_s": _stamps(source)} if hasattr(source, "keys") else {}), **dict(signals)}
         for source, signals in zip(sources, found[row * len(sources):(row + 1) * len(sources)])]
        for row in range(len(found) // max(len(sources), 1))
    ]
    if not many:
        results = [row[0] for row in results]
    return results if many_models else results[0]


def simulate(models, recordings, horizon_s=0.5, threads=0, columns=(), effects=(), constants=None):
    """Simulates recordings as a gap is judged: each run from its measured start, an axis in windows of horizon_s.

    One model or a list, one recording or a list; lists give lists, the outer one over models. Each result is a dict
    of arrays, nan where a signal could not be simulated.
    """
    return _simulate(models, recordings, {}, horizon_s, False, threads, columns, effects, constants)


def predict(models, recordings, start=None, horizon_s=float("inf"), threads=0, columns=(), effects=(), constants=None):
    """Predicts from inputs alone: what was not measured starts at the air's temperature and at rest, or as start says
    (such as {"motor_C": 40.0}). Lists as in simulate()."""
    return _simulate(models, recordings, dict(start or {}), horizon_s, True, threads, columns, effects, constants)


def fleet(logs, out, workers=0, pages=True, columns=(), without=(), horizon_s=None):
    """Diagnoses every log of a table, several at a time, and says what all of them say together. The same call resumes.

    logs: path of a table (CSV) whose paths count from its folder; or its rows, a DataFrame or a list of dicts, which are
    written to out/manifest.csv. Columns are log and model, and where needed unit, time (a date), heldout and map.
    out: folder of the results, the same as those of the program. workers: processes at a time, 0 for one per core.
    pages: a page for each log, too. columns, without, horizon_s: as in diagnose(), for every log. Ctrl-C ends it; the reports
    so far stay.
    """
    out = os.fspath(out)
    manifest = os.fspath(logs) if isinstance(logs, (str, os.PathLike)) else _manifest(logs, out)
    return Fleet(out, _thermopower.fleet(manifest, out, workers, pages, _choices(columns), list(without), horizon_s))


def effects():
    """The catalogue of effects as text."""
    return Text(_thermopower.effects())


def explain(code):
    """What an effect, finding, verdict or reason of a report means.

    >>> "temperature" in explain("winding_tempco")
    True
    """
    return Text(_thermopower.explain(code))


def compare(a, b):
    """In what two diagnoses differ, by what their uncertainties say: diagnoses, or paths of JSON reports."""

    def text_of(one):
        if isinstance(one, Diagnosis):
            return json.dumps(one.as_dict())
        with open(one, encoding="utf-8") as file:
            return file.read()

    return Text(_thermopower.compare(text_of(a), text_of(b)))


def columns(path, joint=""):
    """What is in a file of a log, and what its columns seem to be. joint: a word in the headers of the one that is meant."""
    text, proposed = _thermopower.columns(os.fspath(path), joint)
    return Columns(proposed, text)
