"""Runs."""

from __future__ import annotations

import functools
import json
import os
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._asked import Asked, with_options
from ._errors import AchillesWarning, InputError, as_arguments
from ._figure import Figure, figure_of
from ._records import Certificate, Event, Phase, Record, derivative_records, records
from ._system import System, system_of


class State(NamedTuple):
    """Where a system is: q, v = run(t)."""

    q: np.ndarray
    """Coordinates, the last axis in the order of the file."""
    v: np.ndarray
    """Their rates."""


class Run:
    """A completed execution. Its arrays have a row at every step end and two at every event, before it and after it.

    They are the run's own memory, not copies, may not be written to, and outlive it.
    """

    system: System

    def __init__(self, system: System, core: Any) -> None:
        self.system = system
        self._core = core

    @functools.cached_property
    def _arrays(self) -> dict[str, np.ndarray]:
        return self._core.arrays(None)

    @property
    def t(self) -> np.ndarray:
        """The times, s: n of them."""
        return self._arrays["t"]

    @property
    def q(self) -> np.ndarray:
        """The coordinates, n x dof."""
        return self._arrays["q"]

    @property
    def v(self) -> np.ndarray:
        """The rates, n x dof."""
        return self._arrays["v"]

    @property
    def j(self) -> np.ndarray:
        """How many events there were until then: (t, j) is the hybrid time."""
        return self._arrays["j"]

    @property
    def constrained(self) -> np.ndarray:
        """Whether it is in a constrained phase, n booleans."""
        return self._arrays["constrained"]

    def __call__(self, t: float | Sequence[float] | np.ndarray) -> State:
        """The state at a time, at an event that after it; of an array of times, of any shape, all of them at once."""
        times = self._times(t)
        arrays = self._core.arrays(times.ravel())
        shape = (*times.shape, len(self.system.coordinates))
        return State(arrays["q"].reshape(shape), arrays["v"].reshape(shape))

    def __getitem__(self, expression: str) -> np.ndarray:
        """A quantity along run.t: "x", "x'", "energy", "gap", "lambda", "y - sin(x)", whatever a [[view]] may have."""
        return self.evaluate(expression)

    def evaluate(self, expression: str, t: float | Sequence[float] | np.ndarray | None = None) -> np.ndarray:
        """An expression of t, coordinates, rates, parameters, gap, gap', lambda, energy, work, loss: along run.t, or at times t."""
        if not isinstance(expression, str):
            raise TypeError(f"an expression such as \"y - sin(x)\" is expected, not {type(expression).__name__}")
        if t is None:
            return self._core.values(expression, None)
        times = self._times(t)
        return self._core.values(expression, times.ravel()).reshape(times.shape)[()]

    def _times(self, t: Any) -> np.ndarray:
        times = np.asarray(t)
        if times.dtype.kind not in "iuf" and times.size:
            raise TypeError(f"times are numbers, not {times.dtype}")
        times = times.astype(float)
        start, end = self._core.start_time, self._core.end_time
        wrong = ~((times >= start) & (times <= end))
        if wrong.any():
            early = "" if self._core.outcome == "end time" else f" (the run stopped early: {self._core.message})"
            told = f"t = {times[wrong].ravel()[0]} is outside the run, {start} to {end}{early}"
            raise InputError(told)
        return times

    @functools.cached_property
    def _told(self) -> Record:
        return records(self._core.json(None))

    @property
    def events(self) -> list[Event]:
        """Impacts, Zeno points and releases, in time. Dicts with attributes: pandas.DataFrame(run.events) is a table."""
        return self._told["events"]

    @property
    def certificates(self) -> list[Certificate]:
        """Those of the Zeno points."""
        return [event["certificate"] for event in self.events if "certificate" in event]

    @functools.cached_property
    def derivatives(self) -> Record:
        """On what the run depends: what `achilles simulate --derivatives` says. `directions` are the starts, rates and parameters;
        events[i].t, .q and .v (of an impact v_before, v_after) follow event i, end.q and end.v are at the end time, each with a
        last axis of directions; `margins` say how near the run is to where there are none. NaN where there are none."""
        told = json.loads(self._core.dependence([]))
        parts = {**told["derivatives"], "events": [event["derivatives"] for event in told["events"]],
                 "end": told["end"]["derivatives"]}
        return derivative_records(parts)

    def derivatives_of(self, expression: str) -> np.ndarray:
        """Of an expression at the end, as --of has it ("zeno_time(2)"), one for each of derivatives.directions."""
        of = json.loads(self._core.dependence([expression]))["derivatives"]["of"][0]["derivatives"]
        return np.array(of, dtype=float)

    @property
    def phases(self) -> list[Phase]:
        """The parts of the run, in time."""
        return self._told["phases"]

    @property
    def outcome(self) -> Record:
        """Why it ended: kind, "end time" if all went well, and message."""
        return self._told["outcome"]

    @property
    def end(self) -> Record:
        """Where it ended: t, q, v, phase, held, work, loss, error_estimate."""
        return self._told["end"]

    @property
    def error_estimate(self) -> Record | None:
        """How wrong the end is, estimated and not proved: q, v (true less computed), norm, sigma, reach. None: no_error_estimate
        of `end` says why. Every event has one of its time, s."""
        return self.end["error_estimate"]

    @property
    def trusted_until(self) -> float | None:
        """s: the first step end or event where the estimated error of some coordinate or rate exceeds 1e-3 of its range so far, and
        the end of the run where that never happens. Digits that come later mean nothing. None: there is no estimate, and
        no_error_estimate of `end` says why. Making it takes longer than the run: it is made when it is asked for."""
        return self._core.trusted_until

    @property
    def start(self) -> Record:
        """Where it started: t, q, v."""
        return self._told["start"]

    @property
    def parameters(self) -> dict[str, float]:
        """Of this run."""
        return dict(self._told["system"]["parameters"])

    @property
    def options(self) -> Record:
        """Of this run."""
        return self._told["options"]

    @property
    def statistics(self) -> Record:
        """Steps, evaluations, impacts, energy_drift, least_gap."""
        return self._told["statistics"]

    @property
    def warnings(self) -> list[str]:
        """What a person should know of how the run was made."""
        return self._told["warnings"]

    def to_json(self, t: Sequence[float] | np.ndarray | None = None) -> str:
        """What `achilles simulate --json` writes, the same bytes; with times t the array `samples` has the states there."""
        return self._core.json(None if t is None else self._times(t).ravel())

    def to_csv(self, t: Sequence[float] | np.ndarray | None = None, plain_names: bool = False, units: bool = False) -> str:
        """What `achilles simulate --csv` writes; with times t the rows are those."""
        return self._core.csv(None if t is None else self._times(t).ravel(), plain_names, units)

    def figure(self, *views: str, size: tuple[int, int] = (1200, 800), scale: float = 1.0, width_mm: float = 0.0,
               height_mm: float = 0.0, font_pt: float = 0.0, dpi: float = 0.0, columns: int = 0, dark: bool = False,
               transparent: bool = False) -> Figure:
        """Views of the run for print, all if none is named: in pixels, or with width_mm as wide as that on paper."""
        paper = {"width_mm": width_mm, "height_mm": height_mm, "font_pt": font_pt, "dpi": dpi}
        return figure_of(self._core, self.system.views, views, size, scale, paper, columns, dark, transparent)

    def __reduce__(self) -> tuple[Any, ...]:
        """It is made again: the same run has the same bytes."""
        return _made, (self.system, self._core.settings, self._core.given)

    def __str__(self) -> str:
        """The summary that `achilles simulate` prints."""
        return self._core.summary()

    def __repr__(self) -> str:
        return f"<achilles.Run of {self.system.name} to t = {self._core.end_time:g}: {self._core.outcome}>"


def _made(system: System, settings: list[str], options: dict[str, str]) -> Run:
    return Run(system, _core.simulate(system._core, settings, options))


@with_options
def simulate(system: System | str | os.PathLike[str], *, set: Mapping[str, float | str] | None = None,
             **values: float | str) -> Run:
    """One completed execution of a system: a System, a path, or a name of the gallery.

    Values that differ from the file are arguments, e=0.3, or stand in `set` where their name is none in Python,
    set={"x'": 1.5}; an expression is a text, "pi/6" or "30 deg". A run that stops early is returned, with a warning, and its
    `outcome` says why. Other threads run meanwhile; Ctrl-C ends it with KeyboardInterrupt. Raises InputError.
    """
    what = system_of(system)
    asked = Asked(what._core, set, values)
    run = _made(what, asked.settings, asked.options)
    core = run._core
    told = core.warnings + core.remarks()
    if core.outcome != "end time":
        told.append(f"the run stopped early: {core.message}")
    for warning in told:
        warnings.warn(as_arguments(warning), AchillesWarning, stacklevel=2)
    return run
