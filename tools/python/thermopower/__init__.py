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

import json
import os

import numpy as np

from . import _thermopower
from ._thermopower import InputError, InvalidInput

__all__ = ["InputError", "InvalidInput", "Part", "Diagnosis", "check", "diagnose", "effects", "predict", "read_model", "simulate"]


class Part:
    """Part of a result: keys of the report are attributes, and items, too."""

    def __init__(self, content):
        self._content = content

    def __getattr__(self, name):
        if name.startswith("_") or name not in self._content:
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


class Diagnosis(Part):
    """What a diagnosis found: the keys of the JSON report as attributes, and what can be written from it."""

    def __init__(self, result):
        super().__init__(json.loads(result.report()))
        self._result = result

    def __repr__(self):
        return self._result.summary()

    def __str__(self):
        return self._result.summary()

    def __dir__(self):
        return super().__dir__() + ["augmented", "recalibrated", "series", "html", "header", "table", "plot"]

    def _repr_html_(self):
        page = self.html().replace("&", "&amp;").replace('"', "&quot;")
        return f'<iframe srcdoc="{page}" style="width:100%;height:720px;border:0"></iframe>'

    @property
    def augmented(self):
        """The model with the causes added and its constants moved along, as a dict."""
        return json.loads(self._result.augmented())

    @property
    def recalibrated(self):
        """The model with its own constants refitted and nothing added, as a dict."""
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


def _recording(data, name, columns=()):
    if isinstance(data, _thermopower.Recording):
        return data
    if isinstance(data, (str, os.PathLike)):
        return _thermopower.read_recording(os.fspath(data), list(columns))
    if columns:
        raise InputError("columns= is for recordings that are files; rename and convert the columns of others")
    if not hasattr(data, "keys"):
        raise InputError(f"{name}: is a {type(data).__name__}; expected a dict of arrays, a DataFrame or a path")
    taken = {str(key): np.asarray(data[key]) for key in data.keys()}
    if "t_s" not in taken:
        raise InputError(f"{name}: there is no column 't_s'; expected the time of each row in seconds")
    rows = len(taken["t_s"])
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


def _recordings(data, name, columns=()):
    if data is None:
        return []
    if isinstance(data, (list, tuple)):
        return [_recording(one, f"{name}[{i}]", columns) for i, one in enumerate(data)]
    return [_recording(data, name, columns)]


def _model(model):
    if isinstance(model, (str, os.PathLike)):
        model = read_model(model)
    return json.dumps(model)


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


def diagnose(model, recordings, held_out=None, columns=(), **options):
    """Finds where the model and the recordings part, and which effect is missing.

    held_out: recordings to judge on; without them the last 30 % of each recording. columns: for files only, as the
    program's --column. Options are those of the program: horizon_s, tolerance, held_out_fraction, effects_at_once,
    without, as_recorded, threads, seed.
    """
    return Diagnosis(
        _thermopower.diagnose(
            _model(model),
            _recordings(recordings, "recordings", columns),
            _recordings(held_out, "held_out", columns),
            _options(options),
        )
    )


def check(model, recordings, held_out=None, columns=(), **options):
    """What is wrong with recordings, and what they can show; nothing is fitted."""
    return Part(
        json.loads(
            _thermopower.check(
                _model(model),
                _recordings(recordings, "recordings", columns),
                _recordings(held_out, "held_out", columns),
                _options(options),
            )
        )
    )


def _simulate(models, recordings, starts, horizon_s, from_inputs, threads, columns):
    many_models, many = isinstance(models, (list, tuple)), isinstance(recordings, (list, tuple))
    sources = list(recordings) if many else [recordings]
    taken = _recordings(sources, "recording", columns)
    found = _thermopower.simulate(
        [_model(one) for one in (models if many_models else [models])], taken, starts, horizon_s, from_inputs, threads or os.cpu_count() or 1
    )
    results = [
        [{**({"t_s": np.asarray(source["t_s"], float)} if hasattr(source, "keys") else {}), **dict(signals)}
         for source, signals in zip(sources, found[row * len(sources):(row + 1) * len(sources)])]
        for row in range(len(found) // max(len(sources), 1))
    ]
    if not many:
        results = [row[0] for row in results]
    return results if many_models else results[0]


def simulate(models, recordings, horizon_s=0.5, threads=0, columns=()):
    """Simulates recordings as a gap is judged: each run from its measured start, an axis in windows of horizon_s.

    One model or a list, one recording or a list; lists give lists, the outer one over models. Each result is a dict
    of arrays, nan where a signal could not be simulated.
    """
    return _simulate(models, recordings, {}, horizon_s, False, threads, columns)


def predict(models, recordings, start=None, horizon_s=float("inf"), threads=0, columns=()):
    """Predicts from inputs alone: what was not measured starts at the air's temperature and at rest, or as start says
    (such as {"motor_C": 40.0}). Lists as in simulate()."""
    return _simulate(models, recordings, dict(start or {}), horizon_s, True, threads, columns)


def effects():
    """The catalogue of effects as text."""
    return _thermopower.effects()
