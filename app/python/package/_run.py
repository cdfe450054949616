"""Runs: simulation, results, and states at given times."""

from __future__ import annotations

import csv
import functools
import html
import io
import json
import os
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._arguments import RunArguments, with_options
from ._errors import AchillesWarning, InputError, as_arguments
from ._figure import Figure, figure_of, known_views
from ._frames import frame_of, pandas_for
from ._records import Certificate, Event, Phase, Record, _Result, derivative_records, entry
from ._system import System, system_of


class State(NamedTuple):
    """The state of a system: q, v = run(t)."""

    q: np.ndarray
    """Coordinates, the last axis in the order of the file."""
    v: np.ndarray
    """Rates, in the same order."""


class Run(_Result):
    """A completed execution. Its arrays have a row at every step end and two at every event, before it and after it.

    The arrays are views of the memory of the run, not copies. They are read-only and stay valid after the run is deleted.
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
        """The n times, s."""
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
        """The number of events so far: (t, j) is the hybrid time."""
        return self._arrays["j"]

    @property
    def constrained(self) -> np.ndarray:
        """Whether the run is in a constrained phase: n booleans."""
        return self._arrays["constrained"]

    def __call__(self, t: float | Sequence[float] | np.ndarray) -> State:
        """The state at a time, or at an array of times of any shape. At an event it is the state after the event."""
        times = self._times(t)
        arrays = self._core.arrays(times.ravel())
        shape = (*times.shape, len(self.system.coordinates))
        return State(arrays["q"].reshape(shape), arrays["v"].reshape(shape))

    def __getitem__(self, expression: str) -> np.ndarray:
        """A quantity along run.t: "x", "x'", "energy", "gap", "lambda", "y - sin(x)", or any other expression of a [[view]]."""
        return self.evaluate(expression)

    def evaluate(self, expression: str, t: float | Sequence[float] | np.ndarray | None = None) -> np.ndarray:
        """An expression of t, coordinates, rates, parameters, gap, gap', lambda, energy, work, loss (with friction slip, friction_force, heat): along run.t, or at times t."""
        if not isinstance(expression, str):
            raise TypeError(f"an expression such as \"y - sin(x)\" is expected, not {type(expression).__name__}")
        if t is None:
            return self._core.values(expression, None)
        times = self._times(t)
        return self._core.values(expression, times.ravel()).reshape(times.shape)[()]

    def _times(self, t: Any) -> np.ndarray:
        times = np.asarray(t)
        if times.dtype.kind not in "iuf" and times.size:
            raise TypeError(f"times must be numbers, not {times.dtype}")
        times = times.astype(float)
        start, end = self._core.start_time, self._core.end_time
        wrong = ~((times >= start) & (times <= end))
        if wrong.any():
            early = "" if self._core.outcome == "end time" else f" (the run stopped early: {self._core.message})"
            told = f"t = {times[wrong].ravel()[0]} is outside the run, {start} to {end}{early}"
            raise InputError(told)
        return times

    events: list[Event] = entry(
        "events", "Impacts, Zeno points, releases and events of friction, in time: dicts with attributes. events_to_dataframe() is a table.")

    @property
    def certificates(self) -> list[Certificate]:
        """The certificates of the Zeno points."""
        return [event["certificate"] for event in self.events if "certificate" in event]

    @functools.cached_property
    def derivatives(self) -> Record:
        """Derivatives of the run, as from `achilles simulate --derivatives`. `directions` are the initial coordinates, rates and
        parameters. events[i].t, .q and .v (of an impact v_before, v_after) follow event i; end.q and end.v are at the end time. The
        last axis of each is `directions`. `margins` say how close the run is to a point without derivatives; NaN: no derivative."""
        told = json.loads(self._core.dependence([]))
        parts = {**told["derivatives"], "events": [event["derivatives"] for event in told["events"]],
                 "end": told["end"]["derivatives"]}
        return derivative_records(parts)

    def derivatives_of(self, expression: str) -> np.ndarray:
        """Derivatives of an expression at the end, such as "zeno_time(2)", one for each of derivatives.directions."""
        of = json.loads(self._core.dependence([expression]))["derivatives"]["of"][0]["derivatives"]
        return np.array(of, dtype=float)

    phases: list[Phase] = entry("phases", "The parts of the run, in time.")
    outcome: Record = entry("outcome", 'Why the run ended: kind, "end time" if it was completed, and message.')
    end: Record = entry("end", "The end of the run: t, q, v, phase, held, work, loss, error_estimate; with friction heat and modes.")

    @property
    def error_estimate(self) -> Record | None:
        """Estimated error of the final state, not proved: q, v (true minus computed), norm, sigma, reach. If it is None,
        no_error_estimate of `end` says why. Every event has an estimate for its time, s."""
        return self.end["error_estimate"]

    @property
    def trusted_until(self) -> float | None:
        """Time, s, of the first step end or event where the estimated error of some coordinate or rate exceeds 1e-3 of its range so
        far; the end of the run if that never happens. Later digits mean nothing. If it is None there is no estimate, and
        no_error_estimate of `end` says why. Computing it takes longer than the run, so it is computed on first use."""
        return self._core.trusted_until

    start: Record = entry("start", "The start of the run: t, q, v.")

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters of this run."""
        return dict(self._record["system"]["parameters"])

    options: Record = entry("options", "The options of this run.")
    statistics: Record = entry("statistics", "Steps, evaluations, impacts, energy_drift, least_gap.")
    warnings: list[str] = entry("warnings", "Warnings about the run.")

    def to_json(self, t: Sequence[float] | np.ndarray | None = None) -> str:
        """The same bytes that `achilles simulate --json` writes; with times t the array `samples` has the states at these times."""
        return self._core.json(None if t is None else self._times(t).ravel())

    def to_csv(self, t: Sequence[float] | np.ndarray | None = None, plain_names: bool = False, units: bool = False) -> str:
        """The text that `achilles simulate --csv` writes; with times t it has a row for each of them."""
        return self._core.csv(None if t is None else self._times(t).ravel(), plain_names, units)

    def to_dataframe(self, t: Sequence[float] | np.ndarray | None = None) -> Any:
        """A pandas.DataFrame with the columns of to_csv(): time, phase, coordinates, rates, gaps, forces, energy. It has a row at
        every step end and two at every event, or a row for each of the times t. Units are in its attrs["units"]."""
        pandas = pandas_for("Run.to_dataframe")
        names, units, *rows = csv.reader(io.StringIO(self.to_csv(t, units=True)))
        return frame_of(pandas, dict(zip(names, zip(*rows) if rows else ((),) * len(names))), dict(zip(names, units)))

    def events_to_dataframe(self) -> Any:
        """The events as a pandas.DataFrame, a row each: kind, t, contacts, the coordinates, the rates before ("x' before") and
        after the event ("x'"), and what else its kind has as a number or a text. Of a certificate: the enclosure of the Zeno time."""
        pandas = pandas_for("Run.events_to_dataframe")
        rows = [_row_of(event, self.system.coordinates) for event in self.events]
        return pandas.DataFrame(rows, columns=list(dict.fromkeys(name for row in rows for name in row)) or ["kind", "t"])

    def html(self, path: str | os.PathLike[str] | None = None, *, views: Sequence[str] = ()) -> str:
        """One page for a browser, with the mechanism in motion, plots (of these views, or all) and events, as from
        `achilles html`; also written to `path` if that is given. It needs no other file, no server and no network."""
        known_views(self.system.views, views)
        page = self._core.html(list(views))
        if path is not None:
            with open(path, "w", encoding="utf-8", newline="") as file:
                file.write(page)
        return page

    def _repr_html_(self) -> str:
        # In a frame of its own, the page and the notebook cannot change each other.
        return ('<iframe sandbox="allow-scripts" style="width: 100%; height: 640px; border: 0" title="run" srcdoc="'
                f'{html.escape(self.html())}"></iframe>')

    def figure(self, *views: str, size: tuple[int, int] = (1200, 800), scale: float = 1.0, width_mm: float = 0.0,
               height_mm: float = 0.0, font_pt: float = 0.0, dpi: float = 0.0, columns: int = 0, dark: bool = False,
               transparent: bool = False) -> Figure:
        """Views of the run for print (all views if none is named), sized in pixels, or with width_mm in millimeters on paper."""
        paper = {"width_mm": width_mm, "height_mm": height_mm, "font_pt": font_pt, "dpi": dpi}
        return figure_of(self._core, self.system.views, views, size, scale, paper, columns, dark, transparent)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles the settings of the run, which is repeated: it gives the same bytes."""
        return _made, (self.system, self._core.settings, self._core.given)

    def __str__(self) -> str:
        """The summary that `achilles simulate` prints."""
        return self._core.summary()

    def __repr__(self) -> str:
        is_whole = self._core.outcome == "end time"
        end = "" if is_whole else f", stopped early: {self._core.outcome}"
        return f"<achilles.Run of {self.system.name}: to t = {self._core.end_time:g} s{end}>"


def _row_of(event: Event, coordinates: Sequence[str]) -> dict[str, Any]:
    """The entries of an event that are numbers or texts."""
    row: dict[str, Any] = {}
    states = {"q": "{}", "v": "{}'", "v_after": "{}'", "v_before": "{}' before", "q_before": "{} before"}
    for name, value in event.items():
        if name in states:
            row |= {states[name].format(coordinate): x for coordinate, x in zip(coordinates, value)}
        elif name == "certificate":
            row |= {"certified": value.certified, "zeno_low": value.zeno_time[0], "zeno_high": value.zeno_time[1]}
        elif isinstance(value, list) and all(isinstance(each, str) for each in value):
            row[name] = "+".join(value)
        elif value is None or isinstance(value, (bool, int, float, str)):
            row[name] = value
    return row


def _made(system: System, settings: list[str], options: dict[str, str]) -> Run:
    return Run(system, _core.simulate(system._core, settings, options))


@with_options
def simulate(system: System | str | os.PathLike[str], *, values: Mapping[str, float | str] | None = None,
             set: Mapping[str, float | str] | None = None, **named: float | str) -> Run:
    """Simulates one completed execution of a system: a System, a path, or a name from the gallery.

    `values`, also called `set`, has what differs from the file: {"e": 0.3, "x'": 1.5}. A name that is valid in Python may also
    be an argument, e=0.3; type checkers, which do not know the system, accept it only in `values`. An expression is a string,
    "pi/6" or "30 deg". A run that stops early is returned with a warning, and its `outcome` says why.
    Other threads keep running; Ctrl-C ends the run with KeyboardInterrupt. Raises InputError.
    """
    what = system_of(system)
    asked = RunArguments(what._core, set, values, named)
    run = _made(what, asked.settings, asked.options)
    core = run._core
    told = core.warnings + core.remarks()
    if core.outcome != "end time":
        told.append(f"the run stopped early: {core.message}")
    for warning in told:
        warnings.warn(as_arguments(warning), AchillesWarning, stacklevel=2)
    return run
