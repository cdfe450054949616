"""Periodic runs."""

from __future__ import annotations

import functools
import json
import math
import os
import sys
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _core
from ._asked import Asked, number_in, text_of, with_options
from ._errors import AchillesWarning, InputError, NoOrbit, as_arguments
from ._figure import Figure, figure_of
from ._records import Event, OrbitPoint, Record, records
from ._run import Run, _made
from ._system import System, system_of


class Branch:
    """A periodic run followed in a parameter: arrays along it, and what happens on the way as lists of points."""

    parameter: str
    """Its name."""
    points: list[OrbitPoint]
    """Along the branch, n of them."""
    value: np.ndarray
    """Of the parameter."""
    period: np.ndarray
    """s."""
    t: np.ndarray
    """When the period begins, s."""
    q: np.ndarray
    """The coordinates there, n x dof."""
    v: np.ndarray
    """Their rates, n x dof."""
    multipliers: np.ndarray
    """n x 2 dof complex numbers."""
    stable: np.ndarray
    """n booleans."""
    a_inf: np.ndarray
    """The least -hddot at a Zeno point; NaN where there is none."""
    psi: np.ndarray
    """a_inf^(1/kappa(e)), linear in the parameter where a Zeno point is lost."""
    folds: list[OrbitPoint]
    """Where the parameter turns back."""
    flips: list[OrbitPoint]
    """Where a multiplier is -1: the period doubles."""
    circles: list[OrbitPoint]
    """Where two conjugate multipliers are 1 in size."""
    lost: list[OrbitPoint]
    """Where a release overtakes a Zeno point: there the branch ends."""
    changes: list[OrbitPoint]
    """The first points past a change of the sequence of events."""
    ends: list[str]
    """Why it goes no further at its first point and at its last."""

    def __init__(self, told: Record) -> None:
        self.parameter, self.ends = told.parameter, list(told.ends)
        for name in ("points", "folds", "flips", "circles", "lost", "changes"):
            setattr(self, name, [OrbitPoint(each) for each in told[name]])
        points = self.points
        self.value = _numbers(point.value for point in points)
        self.period = _numbers(point.period for point in points)
        self.t = _numbers(point.state.t for point in points)
        self.q, self.v = (np.array([point.state[name] for point in points]) for name in ("q", "v"))
        self.multipliers = np.array([point.multipliers for point in points])
        self.stable = np.array([point.stable for point in points], dtype=bool)
        self.a_inf = _numbers(point.margins.a_inf for point in points)
        self.psi = _numbers(point.psi for point in points)

    def __repr__(self) -> str:
        ends = " to ".join(f"{value:g}" for value in self.value[[0, -1]])
        return f"<achilles.Branch in {self.parameter}, {ends}: {len(self.points)} points>"


def _numbers(values: Any) -> np.ndarray:
    """What is None is NaN."""
    return np.array([math.nan if value is None else value for value in values], dtype=float)


class Orbit:
    """A periodic run: one that comes back to its start after a period, or moved on by a shift."""

    system: System

    def __init__(self, system: System, core: Any, asked: tuple[Any, ...]) -> None:
        self.system = system
        self._core = core
        self._asked = asked

    @functools.cached_property
    def _told(self) -> Record:
        return records(self._core.json())

    @property
    def period(self) -> float:
        """s."""
        return self._told["period"]

    @property
    def state(self) -> Record:
        """Where the period begins: t, q, v."""
        return self._told["state"]

    @property
    def section(self) -> str:
        """What is there: "release", past a Zeno point, or "flight"; of a drive "time", the start time."""
        return self._told["section"]

    @property
    def multipliers(self) -> np.ndarray:
        """How much of a small change is left after a period: 2 dof complex numbers, the greatest first, but that of a shift in
        time, 1, before all; a drive has none. The last `zero_multipliers` are exactly 0."""
        return self._told["multipliers"]

    @property
    def zero_multipliers(self) -> int:
        """So many are exactly 0: a Zeno point forgets two directions."""
        return self._told["zero_multipliers"]

    @property
    def stable(self) -> bool:
        """Whether all multipliers but that of a shift in time are less than 1 in size."""
        return self._told["stable"]

    @property
    def margins(self) -> Record:
        """How near the run is to where it has no derivative: grazing_speed, gap_minimum, a_inf, release_jerk."""
        return self._told["margins"]

    @property
    def psi(self) -> float | None:
        """a_inf^(1/kappa(e)), linear in a parameter where a Zeno point is lost."""
        return self._told["psi"]

    @property
    def events(self) -> list[Event]:
        """Those of one period, as Run.events has them."""
        return self._told["events"]

    @property
    def derivatives(self) -> Record:
        """What a parameter changes: derivatives["e"].period, .q and .v, of the state where the period begins."""
        return self._told["derivatives"]

    @property
    def newton(self) -> Record:
        """How it was found: the steps of Newton's method, and error, the last of them, of the state's own size."""
        return self._told["newton"]

    @property
    def parameters(self) -> dict[str, float]:
        """Of this run."""
        return dict(self._told["system"]["parameters"])

    @property
    def options(self) -> Record:
        """Of this run, which is made as exactly as double precision allows where nothing else was asked for."""
        return self._told["options"]

    @property
    def warnings(self) -> list[str]:
        """What a person should know of what was asked for."""
        return self._core.warnings

    @functools.cached_property
    def run(self) -> Run:
        """One period as a run, from a flight to that flight."""
        return _made(self.system, *self._core.of_period())

    @functools.cached_property
    def branch(self) -> Branch | None:
        """Along the parameter of `continue_`, where one was given."""
        told = self._told["branch"]
        return None if told is None else Branch(told)

    @property
    def command(self) -> str:
        """What `achilles` is asked to find the same. Where the search began at a state of Python's, orbit.json, run.json or
        state.json stands for a file that holds it; pictures carry it."""
        return self._core.command

    def to_json(self) -> str:
        """What `achilles orbit --json` writes, the same bytes."""
        return self._core.json()

    def figure(self, *views: str, size: tuple[int, int] = (1200, 800), scale: float = 1.0, width_mm: float = 0.0,
               height_mm: float = 0.0, font_pt: float = 0.0, dpi: float = 0.0, dark: bool = False,
               transparent: bool = False) -> Figure:
        """Views of one period for print, all if none is named, or the branch, as `achilles orbit --out` draws them."""
        paper = {"width_mm": width_mm, "height_mm": height_mm, "font_pt": font_pt, "dpi": dpi}
        return figure_of(self._core, self.system.views, views, size, scale, paper, 0, dark, transparent)

    def _repr_svg_(self) -> str:
        return self.figure()._repr_svg_()

    def __reduce__(self) -> tuple[Any, ...]:
        """It is found again: the same search has the same bytes."""
        return _found, (self.system, *self._asked)

    def __str__(self) -> str:
        """What `achilles orbit` prints."""
        return self._core.summary()

    def __repr__(self) -> str:
        stability = "stable" if self.stable else "not stable"
        branch = "" if self.branch is None else f", with {len(self.branch.points)} points in {self.branch.parameter}"
        return f"<achilles.Orbit of {self.system.name}: period {self.period:.10g} s, {stability}{branch}>"


def _found(system: System, *asked: Any) -> Orbit:
    return _answer(system, _core.orbit(system._core, *asked), asked)


def _answer(system: System, core: Any, asked: tuple[Any, ...]) -> Orbit:
    if core.why:
        raise NoOrbit(as_arguments(core.why))
    return Orbit(system, core, asked)


@with_options
def orbit(system: System | str | os.PathLike[str], *,
          from_: str | os.PathLike[str] | Orbit | Run | Mapping[str, Any] | None = None, period: float | str | None = None,
          shift: Mapping[str, float | str] | str | Sequence[str] | None = None,
          continue_: Mapping[str, tuple[float | str, float | str]] | str | None = None,
          set: Mapping[str, float | str] | None = None, **values: float | str) -> Orbit:
    """A periodic run of a system, with its multipliers, and its branch in a parameter, as `achilles orbit` finds it.

    The search begins at `from_`: the "start" or the "end" of the system's run, where an Orbit, a point of a branch or a dict with q,
    v and t is, at the end of a Run, or at the state in a file of JSON; without it at [orbit] of the system, else at the start.
    `period` is that of a drive, "2*pi/om"; without a drive a guess. With shift={"x": "2*pi"} the run comes back moved on by so much.
    continue_={"e": (0.1, 0.9)} follows it in a parameter, both ways and through folds; the branch ends where a Zeno point is lost.
    Runs are made as exactly as double precision allows (tolerance 1e-14, eps 1e-11), but for options that are given.

    Raises NoOrbit where none is found, and InputError. Other threads run meanwhile; Ctrl-C ends the search with KeyboardInterrupt.
    """
    what = system_of(system)
    of_run = Asked(what._core, set, values)
    asked = (*_place(what, from_), "" if period is None else text_of("period", period), _shifts(shift), _along(continue_),
             of_run.settings, of_run.options)
    core = _core.orbit(what._core, *asked)
    for warning in core.warnings:
        warnings.warn(as_arguments(warning), AchillesWarning, stacklevel=2)
    return _answer(what, core, asked)


def _place(system: System, from_: Any) -> tuple[str, str | None]:
    """Where the search begins as --from has it, and what that file holds."""
    if from_ is None:
        return "", None
    if isinstance(from_, (str, os.PathLike)):
        name = os.fspath(from_)
        return name, None if name in ("start", "end") else _core.read_text(name)
    if isinstance(from_, Orbit):
        return "orbit.json", _state(system, from_.state, from_.period)
    if isinstance(from_, Run):
        return "run.json", _state(system, from_.end, None)
    if isinstance(from_, Mapping):
        return "state.json", _state(system, from_.get("state", from_), from_.get("period"))
    raise TypeError('from_: "start", "end", a file, an Orbit, a Run or a dict with q, v and t is expected, '
                    f"not {type(from_).__name__}")


def _state(system: System, state: Mapping[str, Any], period: Any) -> str:
    """A state as JSON."""
    told: dict[str, Any] = {"t": _time("t", state.get("t", 0.0))}
    for name in ("q", "v"):
        if name not in state:
            raise InputError(f"from_: it has no {name}, a number for each of {', '.join(system.coordinates)}")
        numbers = np.asarray(state[name])
        if numbers.dtype.kind not in "iuf":
            raise TypeError(f"from_: {name} are numbers, not {numbers.dtype}")
        if numbers.shape != (len(system.coordinates),) or not np.isfinite(numbers).all():
            raise InputError(f"from_: {name} is a finite number for each of {', '.join(system.coordinates)}, not {state[name]}")
        told[name] = numbers.astype(float).tolist()
    whole: dict[str, Any] = {"state": told}
    if period is not None:
        whole["period"] = _time("period", period)
    return json.dumps(whole)


def _time(name: str, value: Any) -> float:
    return number_in(f"from_: {name}", value, -sys.float_info.max, sys.float_info.max)


def _shifts(shift: Any) -> list[str]:
    """As --shift has them."""
    if shift is None:
        return []
    if isinstance(shift, str):
        return [shift]
    if isinstance(shift, Mapping):
        return [f"{name}={text_of(f'shift: {name}', value)}" for name, value in shift.items()]
    if isinstance(shift, Sequence) and all(isinstance(text, str) for text in shift):
        return list(shift)
    raise TypeError('shift: a dict such as {"x": "2*pi"} or a text such as "x=2*pi" is expected')


def _along(range_: Any) -> str:
    """As --continue has it."""
    if range_ is None:
        return ""
    if isinstance(range_, str):
        return range_
    if isinstance(range_, Mapping) and len(range_) == 1:
        ((name, limits),) = range_.items()
        if isinstance(limits, Sequence) and not isinstance(limits, str) and len(limits) == 2:
            return f"{name}=" + ":".join(text_of(f"continue_: {name}", limit) for limit in limits)
    raise TypeError('continue_: a dict such as {"e": (0.1, 0.9)} or a text such as "e=0.1:0.9" is expected')
