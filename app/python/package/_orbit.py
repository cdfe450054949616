"""Periodic orbits and their branches."""

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
from ._arguments import RunArguments, number_in, one_of, text_of, with_options
from ._errors import AchillesWarning, InputError, NoOrbit, as_arguments
from ._figure import Figure, figure_of
from ._records import Event, OrbitPoint, Record, _Result, entry
from ._run import Run, _made
from ._system import System, system_of


class Branch:
    """A branch of periodic runs in a parameter: arrays along the branch, and lists of its special points."""

    parameter: str
    """Name of the parameter."""
    points: list[OrbitPoint]
    """The n points of the branch."""
    value: np.ndarray
    """Values of the parameter."""
    period: np.ndarray
    """Periods, s."""
    t: np.ndarray
    """Start times of the period, s."""
    q: np.ndarray
    """Coordinates at the start of the period, n x dof."""
    v: np.ndarray
    """Rates at the start of the period, n x dof."""
    multipliers: np.ndarray
    """n x 2 dof complex numbers."""
    stable: np.ndarray
    """Whether each point is stable: n booleans."""
    a_inf: np.ndarray
    """The minimum of -hddot over the Zeno points; NaN if there is none."""
    psi: np.ndarray
    """a_inf^(1/kappa(e)), linear in the parameter where a Zeno point is lost."""
    folds: list[OrbitPoint]
    """Folds: the parameter turns back."""
    flips: list[OrbitPoint]
    """Period doublings: a multiplier is -1."""
    circles: list[OrbitPoint]
    """Neimark-Sacker points: two conjugate multipliers have size 1."""
    lost: list[OrbitPoint]
    """Points where a release overtakes a Zeno point; the branch ends there."""
    changes: list[OrbitPoint]
    """The first points after a change of the sequence of events."""
    ends: list[str]
    """Why the branch ends at its first point and at its last."""

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
    """Makes an array with NaN in place of None."""
    return np.array([math.nan if value is None else value for value in values], dtype=float)


class Orbit(_Result):
    """A periodic run: it returns to its start after one period, possibly moved by a shift."""

    system: System

    def __init__(self, system: System, core: Any, asked: tuple[Any, ...]) -> None:
        self.system = system
        self._core = core
        self._asked = asked

    period: float = entry("period", "The period, s.")
    state: Record = entry("state", "The state at the start of the period: t, q, v.")
    section: str = entry(
        "section", 'Where the period starts: "release", after a Zeno point, "flight", or with a drive "time", the start time.')
    multipliers: np.ndarray = entry("multipliers", """\
        The factors by which small perturbations grow per period: 2 dof complex numbers, the largest first. Without a drive the
        multiplier 1 of a shift in time comes before all others. The last `zero_multipliers` are exactly 0.""")
    zero_multipliers: int = entry(
        "zero_multipliers", "The number of multipliers that are exactly 0: a Zeno point removes two directions.")
    shift: dict[str, float] = entry("shift", "How far the coordinates with a free shift move in a period.")
    stable: bool = entry(
        "stable", "Whether all multipliers, except those of shifts in time and of free coordinates, are less than 1 in size.")
    margins: Record = entry(
        "margins", "How close the run is to a point without derivatives: grazing_speed, gap_minimum, a_inf, release_jerk.")
    psi: float | None = entry("psi", "a_inf^(1/kappa(e)), linear in a parameter where a Zeno point is lost.")
    events: list[Event] = entry("events", "The events of one period, in the form of Run.events.")
    derivatives: Record = entry(
        "derivatives", 'Derivatives with respect to a parameter: derivatives["e"].period, and .q and .v at the start of the period.')
    newton: Record = entry(
        "newton", "The steps of Newton's method, and error, the size of the last step relative to the state.")

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters of this run."""
        return dict(self._record["system"]["parameters"])

    options: Record = entry(
        "options", "The options of this run. By default its tolerances are the smallest that double precision supports.")

    @property
    def warnings(self) -> list[str]:
        """Warnings about the input."""
        return self._core.warnings

    @functools.cached_property
    def run(self) -> Run:
        """One period as a run, from flight to flight."""
        return _made(self.system, *self._core.of_period())

    @functools.cached_property
    def branch(self) -> Branch | None:
        """The branch in the parameter of the argument `branch`; None if that was not given."""
        told = self._record["branch"]
        return None if told is None else Branch(told)

    @property
    def command(self) -> str:
        """The `achilles` command that finds the same orbit. If the search began at a state from Python, orbit.json, run.json or
        state.json stands for a file with that state; figures contain this command."""
        return self._core.command

    def to_json(self) -> str:
        """The same bytes that `achilles orbit --json` writes."""
        return self._core.json()

    def figure(self, *views: str, size: tuple[int, int] = (1200, 800), scale: float = 1.0, width_mm: float = 0.0,
               height_mm: float = 0.0, font_pt: float = 0.0, dpi: float = 0.0, dark: bool = False,
               transparent: bool = False) -> Figure:
        """Views of one period for print (all views if none is named), or of the branch, as drawn by `achilles orbit --out`."""
        paper = {"width_mm": width_mm, "height_mm": height_mm, "font_pt": font_pt, "dpi": dpi}
        return figure_of(self._core, self.system.views, views, size, scale, paper, 0, dark, transparent)

    def _repr_svg_(self) -> str:
        return self.figure()._repr_svg_()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles the search, which is repeated: it gives the same bytes."""
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
          begin: str | os.PathLike[str] | Orbit | Run | Mapping[str, Any] | None = None,
          from_: str | os.PathLike[str] | Orbit | Run | Mapping[str, Any] | None = None, period: float | str | None = None,
          shift: Mapping[str, float | str] | str | Sequence[str] | None = None,
          branch: Mapping[str, tuple[float | str, float | str]] | str | None = None,
          continue_: Mapping[str, tuple[float | str, float | str]] | str | None = None,
          values: Mapping[str, float | str] | None = None, set: Mapping[str, float | str] | None = None,
          **named: float | str) -> Orbit:
    """Finds a periodic run of a system, its multipliers, and its branch in a parameter, as `achilles orbit` does.

    The search begins at `begin`, also called `from_`: the "start" or the "end" of the system's run, an Orbit, a point of a branch,
    a dict with q, v and t, the end of a Run, or the state in a JSON file. Without it the search begins at [orbit] of the system,
    else at the start.
    `period` is that of a drive, "2*pi/om"; without a drive it is a guess. With shift={"x": "2*pi"} the run returns moved by 2 pi.
    branch={"e": (0.1, 0.9)}, also called continue_, follows the run in a parameter, in both directions and through folds, until a
    Zeno point is lost. `values` are as in simulate().
    Options that are not given have the smallest tolerances that double precision supports (tolerance 1e-14, eps 1e-11).

    Raises NoOrbit if no periodic run is found, and InputError. Other threads keep running; Ctrl-C ends the search with
    KeyboardInterrupt.
    """
    what = system_of(system)
    of_run = RunArguments(what._core, set, values, named)
    place = _place(what, "from_" if begin is None else "begin", one_of("from_", from_, "begin", begin))
    along = _along("continue_" if branch is None else "branch", one_of("continue_", continue_, "branch", branch))
    asked = (*place, "" if period is None else text_of("period", period), _shifts(shift), along, of_run.settings, of_run.options)
    core = _core.orbit(what._core, *asked)
    for warning in core.warnings:
        warnings.warn(as_arguments(warning), AchillesWarning, stacklevel=2)
    return _answer(what, core, asked)


def _place(system: System, name: str, begin: Any) -> tuple[str, str | None]:
    """Returns the start of the search in the form of --from, and the content of that file or None."""
    if begin is None:
        return "", None
    if isinstance(begin, (str, os.PathLike)):
        file = os.fspath(begin)
        return file, None if file in ("start", "end") else _core.read_text(file)
    if isinstance(begin, Orbit):
        return "orbit.json", _state(system, name, begin.state, begin.period)
    if isinstance(begin, Run):
        return "run.json", _state(system, name, begin.end, None)
    if isinstance(begin, Mapping):
        return "state.json", _state(system, name, begin.get("state", begin), begin.get("period"))
    raise TypeError(f'{name}: "start", "end", a file, an Orbit, a Run or a dict with q, v and t is expected, '
                    f"not {type(begin).__name__}")


def _state(system: System, argument: str, state: Mapping[str, Any], period: Any) -> str:
    """Checks a state and converts it to JSON."""
    told: dict[str, Any] = {"t": _time(f"{argument}: t", state.get("t", 0.0))}
    for name in ("q", "v"):
        if name not in state:
            raise InputError(f"{argument}: {name} is missing: give a number for each of {', '.join(system.coordinates)}")
        numbers = np.asarray(state[name])
        if numbers.dtype.kind not in "iuf":
            raise TypeError(f"{argument}: {name} must be numbers, not {numbers.dtype}")
        if numbers.shape != (len(system.coordinates),) or not np.isfinite(numbers).all():
            raise InputError(f"{argument}: {name} needs a finite number for each of {', '.join(system.coordinates)}, not {state[name]}")
        told[name] = numbers.astype(float).tolist()
    whole: dict[str, Any] = {"state": told}
    if period is not None:
        whole["period"] = _time(f"{argument}: period", period)
    return json.dumps(whole)


def _time(name: str, value: Any) -> float:
    return number_in(name, value, -sys.float_info.max, sys.float_info.max)


def _shifts(shift: Any) -> list[str]:
    """Converts the shifts to the form of --shift."""
    if shift is None:
        return []
    if isinstance(shift, str):
        return [shift]
    if isinstance(shift, Mapping):
        return [f"{name}={text_of(f'shift: {name}', value)}" for name, value in shift.items()]
    if isinstance(shift, Sequence) and all(isinstance(text, str) for text in shift):
        return list(shift)
    raise TypeError('shift: a dict such as {"x": "2*pi"} or a text such as "x=2*pi" is expected')


def _along(argument: str, range_: Any) -> str:
    """Converts the parameter range of a branch to the form of --continue."""
    if range_ is None:
        return ""
    if isinstance(range_, str):
        return range_
    if isinstance(range_, Mapping) and len(range_) == 1:
        ((name, limits),) = range_.items()
        if isinstance(limits, Sequence) and not isinstance(limits, str) and len(limits) == 2:
            return f"{name}=" + ":".join(text_of(f"{argument}: {name}", limit) for limit in limits)
    raise TypeError(argument + ': a dict such as {"e": (0.1, 0.9)} or a text such as "e=0.1:0.9" is expected')
