# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
from os import PathLike
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

Recording = Union[Mapping[str, Any], str, PathLike[str], Any]
Recordings = Union[Recording, Sequence[Recording]]
Signals = Dict[str, np.ndarray]

class InputError(ValueError): ...
class OutputError(OSError): ...
class InvalidInput(ValueError): ...

def parameter(
    name: str,
    unit: str = ...,
    lower: float = ...,
    upper: float = ...,
    starts: Sequence[float] = ...,
    logarithmic: bool = ...,
    *,
    standard: Optional[float] = ...,
    exceeds: str = ...,
    starts_as_shares_of: str = ...,
    degenerate_at_bounds: bool = ...,
    periods_in_travel: float = ...,
) -> Dict[str, Any]: ...
def curve(x: Any, at: Sequence[float], values: Sequence[Any]) -> Any: ...

class Effect:
    id: str
    def __init__(
        self,
        id: str,
        act: Union[Callable[[Any, Any], None], Mapping[str, Callable[[Any, Any], None]], None] = ...,
        *,
        on: Optional[str] = ...,
        parameters: Sequence[Mapping[str, Any]] = ...,
        submodel: Optional[str] = ...,
        equation: str = ...,
        prose: str = ...,
        experiment: str = ...,
        states: Optional[Mapping[str, str]] = ...,
        needs: Sequence[str] = ...,
        costly: bool = ...,
        strikes: bool = ...,
    ) -> None: ...
    @property
    def is_traced(self) -> bool: ...

class Plant:
    def __init__(
        self,
        name: str,
        simulate: Callable[..., Mapping[str, Any]],
        *,
        constants: Mapping[str, Union[float, Tuple[float, str], Mapping[str, Any]]],
        inputs: Union[Mapping[str, Union[str, Mapping[str, Any]]], Sequence[str]],
        states: Mapping[str, Mapping[str, Any]],
        signals: Mapping[str, Mapping[str, Any]],
        effects: Sequence[Effect] = ...,
        windowed: bool = ...,
    ) -> None: ...
    @property
    def constants(self) -> Dict[str, float]: ...
    @property
    def acting(self) -> Dict[str, Dict[str, float]]: ...
    def changed(
        self, constants: Optional[Mapping[str, float]] = ..., effects: Optional[Mapping[str, Mapping[str, float]]] = ...
    ) -> "Plant": ...

Model = Union[Mapping[str, Any], str, PathLike[str], Plant]

class Part:
    def __getattr__(self, name: str) -> Any: ...
    def __getitem__(self, name: str) -> Any: ...
    def __contains__(self, name: object) -> bool: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def as_dict(self) -> Dict[str, Any]: ...

class Text(str): ...

class Check(Part):
    believable: bool
    findings: List[Part]

class Columns(Dict[str, str]):
    @property
    def choices(self) -> List[str]: ...

class Design:
    ending: str
    csv: str
    header: str
    @property
    def schedule(self) -> Dict[str, np.ndarray]: ...
    def html(self) -> str: ...

class Diagnosis(Part):
    verdict: str
    reason: str
    where: List[Part]
    cause: List[Part]
    alternatives: List[List[str]]
    gap: Part
    findings: List[Part]
    next_experiment: str
    words: List[str]
    @property
    def augmented(self) -> Any: ...
    @property
    def recalibrated(self) -> Any: ...
    @property
    def series(self) -> List[Dict[str, Any]]: ...
    def html(self) -> str: ...
    def header(self) -> Tuple[str, List[str]]: ...
    def markdown(self) -> Text: ...
    def mjcf(self) -> Tuple[str, List[str]]: ...
    def urdf(self) -> Tuple[str, List[str]]: ...
    def design(self, limits: Union[Mapping[str, Any], str, PathLike[str]], seed: int = ...) -> Design: ...
    def table(self) -> Any: ...
    def plot(self) -> Any: ...

class Fleet(Part):
    units: List[Part]
    families: List[Part]
    @property
    def out(self) -> str: ...
    @property
    def page(self) -> str: ...
    @property
    def complete(self) -> bool: ...
    def table(self, of: str = ...) -> Any: ...

def read_model(path: Union[str, PathLike[str]]) -> Dict[str, Any]: ...
def diagnose(
    model: Model,
    recordings: Recordings,
    held_out: Optional[Recordings] = ...,
    columns: Sequence[str] = ...,
    effects: Sequence[Effect] = ...,
    constants: Optional[Mapping[str, float]] = ...,
    rows_per_s: float = ...,
    *,
    horizon_s: float = ...,
    tolerance: float = ...,
    held_out_fraction: float = ...,
    effects_at_once: int = ...,
    without: List[str] = ...,
    as_recorded: bool = ...,
    threads: int = ...,
    seed: int = ...,
) -> Diagnosis: ...
def check(
    model: Model,
    recordings: Recordings,
    held_out: Optional[Recordings] = ...,
    columns: Sequence[str] = ...,
    effects: Sequence[Effect] = ...,
    constants: Optional[Mapping[str, float]] = ...,
    rows_per_s: float = ...,
    *,
    horizon_s: float = ...,
    as_recorded: bool = ...,
) -> Check: ...
def simulate(
    models: Union[Model, Sequence[Model]],
    recordings: Recordings,
    horizon_s: float = ...,
    threads: int = ...,
    columns: Sequence[str] = ...,
    effects: Sequence[Effect] = ...,
    constants: Optional[Mapping[str, float]] = ...,
) -> Any: ...
def predict(
    models: Union[Model, Sequence[Model]],
    recordings: Recordings,
    start: Optional[Mapping[str, float]] = ...,
    horizon_s: float = ...,
    threads: int = ...,
    columns: Sequence[str] = ...,
    effects: Sequence[Effect] = ...,
    constants: Optional[Mapping[str, float]] = ...,
) -> Any: ...
def fleet(
    logs: Any,
    out: Union[str, PathLike[str]],
    workers: int = ...,
    pages: bool = ...,
    columns: Sequence[str] = ...,
    without: Sequence[str] = ...,
    horizon_s: Optional[float] = ...,
) -> Fleet: ...
def effects() -> Text: ...
def explain(code: str) -> Text: ...
def compare(a: Union[Diagnosis, str, PathLike[str]], b: Union[Diagnosis, str, PathLike[str]]) -> Text: ...
def columns(path: Union[str, PathLike[str]], joint: str = ...) -> Columns: ...
