"""Parameter sweeps: many runs as one table."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from . import _core
from ._arguments import RunArguments, one_of, text_of, texts_in, with_options
from ._errors import AchillesWarning, InputError, as_arguments
from ._frames import pandas_for
from ._system import System, system_of


class Sweep(Mapping[str, np.ndarray]):
    """Results of many runs: a dict of NumPy arrays, one for each quantity of `print`, and "outcome".

    For a grid, an array has the shape of the grid, the first axis slowest. For random points and sections it has one row per
    point; a section also has "t" and "contact". A value that does not exist is NaN. Axes can be read by their names, too.
    """

    system: System
    axes: dict[str, np.ndarray]
    """The values along each axis of a grid; otherwise the values of every row."""
    units: dict[str, str]
    """Units of axes and quantities, where they are known."""
    shape: tuple[int, ...]
    """Shape of the arrays."""
    command: str
    """The `achilles` command that makes the same table."""

    def __init__(self, system: System, told: Mapping[str, Any]) -> None:
        self.system = system
        rows = len(told["points"])
        is_grid = not told["is_section"] and all(len(along) for _, along, _, _ in told["axes"])
        self.shape = tuple(len(along) for _, along, _, _ in told["axes"]) if is_grid else (rows,)
        self.axes = {name: along if is_grid else of_rows for name, along, of_rows, _ in told["axes"]}
        self.units = {name: unit for name, _, _, unit in told["axes"] if unit}
        self._axis_rows = {name: of_rows for name, _, of_rows, _ in told["axes"]}
        self.command = f"achilles sweep {system.name} {told['text']}"
        words = np.array(told["words"] or [""])
        self._values: dict[str, np.ndarray] = {}
        if told["is_section"]:
            self._values["t"] = told["times"]
            self._values["contact"] = words[told["contacts"]]
        numbers = iter(told["numbers"].T)
        for kind, name, unit in told["prints"]:
            if kind == "number":
                self._values[name] = next(numbers).reshape(self.shape)
            elif kind in ("held", "modes"):
                self._values[name] = words[told[kind]].reshape(self.shape)
            if unit:
                self.units[name] = unit
        self._values["outcome"] = words[told["ends"]].reshape(self.shape)

    def __getitem__(self, name: str) -> np.ndarray:
        if name in self._values:
            return self._values[name]
        if name in self.axes:
            return self.axes[name]
        raise KeyError(f"{name}{_core.did_you_mean(str(name), list(self))}")

    def __iter__(self) -> Iterator[str]:
        yield from self._values
        yield from (name for name in self.axes if name not in self._values)

    def __len__(self) -> int:
        return len({*self._values, *self.axes})

    def rows(self) -> dict[str, np.ndarray]:
        """The table of the CSV, column by column: pandas.DataFrame(sweep.rows()). An axis that is also printed is "x(0)"."""
        table = {name + "(0)" if name in self._values else name: column for name, column in self._axis_rows.items()}
        return table | {name: array.ravel() for name, array in self._values.items()}

    def to_dataframe(self) -> Any:
        """The table of rows() as a pandas.DataFrame. Units are in its attrs["units"]."""
        frame = pandas_for("Sweep.to_dataframe").DataFrame(self.rows())
        frame.attrs["units"] = {name: unit for name in frame if (unit := self.units.get(name.removesuffix("(0)")))}
        return frame

    def _failures(self, points: np.ndarray) -> Iterator[str]:
        """Yields a message for each kind of failure: the number of runs and the first of them."""
        _, first_rows = np.unique(points, return_index=True)  # a section has several rows per run
        outcomes = self._values["outcome"].ravel()[first_rows]
        for outcome in dict.fromkeys(outcomes.tolist()):
            if outcome != "end time":
                where = np.flatnonzero(outcomes == outcome)
                row = first_rows[where[0]]
                first = ", ".join(f"{name} = {column[row]!r}" for name, column in self._axis_rows.items())
                yield f"{len(where)} of the runs: {outcome}; first at {first}"

    def __repr__(self) -> str:
        return f"<achilles.Sweep {'x'.join(map(str, self.shape))}: {self.command}>"


@with_options
def sweep(system: System | str | os.PathLike[str], over: Mapping[str, Any] | str | Sequence[str],
          print: str | Sequence[str] | None = None, *, quantities: str | Sequence[str] | None = None, at: str | None = None, after: float | str | None = None, random: int | None = None, seed: int | None = None,
          threads: int | None = None, progress: Callable[[int, int], object] | None = None,
          values: Mapping[str, float | str] | None = None, set: Mapping[str, float | str] | None = None,
          **named: float | str) -> Sweep:
    """Simulates many runs on all cores and returns a table, as `achilles sweep` does.

    `over` has the axes: {"e": (0, 0.95, 200)}, {"e": ("log", 1e-3, 0.9, 100)}, an array of equidistant values, or strings as on
    the command line, "e=0:0.95:200". Several axes make a grid, the first slowest. With random=N and seed=S, give {"x": (-1, 1)},
    and N random points are drawn. `quantities`, also called `print`, are tabulated: expressions at the end of the run, zeno_time(k),
    impact_time(k), impact_speed(k), release_time(k), zeno_points, impacts, releases, least_gap, held, outcome; with friction also heat, sticks,
    slips, reversals, collapse_time(k), collapses, stick_time(k), slip_time(k), reversal_time(k), modes; or the derivative of one of these numbers with respect to an initial coordinate,
    rate or parameter, "d(zeno_time(1), e)". With `at` they are
    tabulated at every "impact", "zeno" or "release" ("jump", "pass"), or where an expression crosses zero upward, from time `after` on. A failed
    run is a point with its outcome, and a warning gives the number of such runs. `values` are as in simulate().

    progress(done, count) is called a few times per second. An exception from it ends the sweep, as Ctrl-C does, once the current
    chunks (a quarter of a second each) are done. Other threads keep running. Raises InputError.
    """
    what = system_of(system)
    if threads is not None and not (isinstance(threads, int) and 1 <= threads <= 1024):
        raise InputError(f"threads={threads}: a whole number from 1 to 1024 is expected")
    if progress is not None and not callable(progress):
        raise TypeError("progress: a function of (done, count) is expected")
    asked = RunArguments(what._core, set, values, named)
    chosen = one_of("print", print, "quantities", quantities)
    if chosen is None:
        raise TypeError('quantities is missing: say what to tabulate, such as quantities="zeno_time(1)"')
    prints = texts_in("print" if quantities is None else "quantities", chosen, "zeno_time(2)")

    def text(name: str, value: object) -> str | None:
        return None if value is None else text_of(name, value)

    told = _core.sweep(what._core, _axes(over), prints, at, text("after", after), text("random", random),
                       text("seed", seed), asked.settings, asked.options, threads or 0, progress)
    result = Sweep(what, told)
    for warning in told["warnings"] + list(result._failures(told["points"])):
        warnings.warn(as_arguments(warning), AchillesWarning, stacklevel=2)
    return result


def _axes(over: Any) -> list[str]:
    """Converts the axes to the form of --over."""
    if isinstance(over, str):
        return [over]
    if isinstance(over, Mapping):
        return [f"{name}={_span(str(name), span)}" for name, span in over.items()]
    if isinstance(over, Sequence) and all(isinstance(text, str) for text in over):
        return list(over)
    raise TypeError('over: a dict such as {"e": (0, 0.95, 200)} or a text such as "e=0:0.95:200" is expected')


def _span(name: str, span: Any) -> str:
    if isinstance(span, str):
        return span
    if isinstance(span, tuple):
        is_log = len(span) > 0 and span[0] == "log"
        limits = [text_of(name, value) for value in span[is_log:]]
        return ":".join(["log", *limits] if is_log else limits)
    values = np.asarray(span)
    if values.ndim != 1 or values.size < 2 or values.dtype.kind not in "iuf":
        raise TypeError(f"over: {name} must be (low, high, count), (\"log\", low, high, count) or an array of values")
    low, high, count = float(values[0]), float(values[-1]), values.size
    limits = f"{low!r}:{high!r}:{count}"
    if np.allclose(values, np.linspace(low, high, count), rtol=0, atol=1e-12 * max(abs(low), abs(high))):
        return limits
    if low > 0 and high > 0 and np.allclose(values, np.exp(np.linspace(math.log(low), math.log(high), count)), rtol=1e-12, atol=0):
        return "log:" + limits
    raise InputError(f"over: the values of {name} are neither at equal distances nor in equal ratios; write (low, high, count)")
