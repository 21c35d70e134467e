# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
from os import PathLike
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

Model = Union[Mapping[str, Any], str, PathLike[str]]
Recording = Union[Mapping[str, Any], str, PathLike[str], Any]
Recordings = Union[Recording, Sequence[Recording]]
Signals = Dict[str, np.ndarray]

class InputError(ValueError): ...
class InvalidInput(ValueError): ...

class Part:
    def __getattr__(self, name: str) -> Any: ...
    def __getitem__(self, name: str) -> Any: ...
    def __contains__(self, name: object) -> bool: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def as_dict(self) -> Dict[str, Any]: ...

class Diagnosis(Part):
    verdict: str
    reason: str
    where: List[Part]
    cause: List[Part]
    alternatives: List[List[str]]
    gap: Part
    findings: List[Part]
    next_experiment: str
    @property
    def augmented(self) -> Dict[str, Any]: ...
    @property
    def recalibrated(self) -> Dict[str, Any]: ...
    @property
    def series(self) -> List[Dict[str, Any]]: ...
    def html(self) -> str: ...
    def header(self) -> Tuple[str, List[str]]: ...
    def table(self) -> Any: ...
    def plot(self) -> Any: ...

def read_model(path: Union[str, PathLike[str]]) -> Dict[str, Any]: ...
def diagnose(
    model: Model,
    recordings: Recordings,
    held_out: Optional[Recordings] = ...,
    columns: Sequence[str] = ...,
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
    *,
    horizon_s: float = ...,
    as_recorded: bool = ...,
) -> Part: ...
def simulate(
    models: Union[Model, Sequence[Model]],
    recordings: Recordings,
    horizon_s: float = ...,
    threads: int = ...,
    columns: Sequence[str] = ...,
) -> Any: ...
def predict(
    models: Union[Model, Sequence[Model]],
    recordings: Recordings,
    start: Optional[Mapping[str, float]] = ...,
    horizon_s: float = ...,
    threads: int = ...,
    columns: Sequence[str] = ...,
) -> Any: ...
def effects() -> str: ...
