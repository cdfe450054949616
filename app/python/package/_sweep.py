"""Many runs as one table."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from . import _core
from ._asked import Asked, text_of, texts_in, with_options
from ._errors import AchillesWarning, InputError, as_arguments
from ._system import System, system_of


class Sweep(Mapping):
    """What was asked of many runs: a dict of NumPy arrays by what was printed, and "outcome".

    Of a grid an array has its shape, the first axis slowest; of random points and sections it has a row for each, and a
    section has "t" and "contact", too. What does not exist is NaN. Axes are found by their names, too.
    """

    system: System
    axes: dict[str, np.ndarray]
    """The values along each axis of a grid, else those of every row."""
    units: dict[str, str]
    """Of axes and prints, where they are known."""
    shape: tuple[int, ...]
    """Of the arrays."""
    command: str
    """What `achilles` is asked to make the same table."""

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
            elif kind == "held":
                self._values[name] = words[told["held"]].reshape(self.shape)
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
        """The table as the CSV has it, column by column: pandas.DataFrame(sweep.rows()). An axis that is also printed is "x(0)"."""
        table = {name + "(0)" if name in self._values else name: column for name, column in self._axis_rows.items()}
        return table | {name: array.ravel() for name, array in self._values.items()}

    def _failures(self, points: np.ndarray) -> Iterator[str]:
        """Of each way in which runs failed, how many did, and the first of them."""
        _, first_rows = np.unique(points, return_index=True)  # a section has several rows of a run
        outcomes = self._values["outcome"].ravel()[first_rows]
        for outcome in dict.fromkeys(outcomes.tolist()):
            if outcome != "end time":
                where = np.flatnonzero(outcomes == outcome)
                row = first_rows[where[0]]
                first = ", ".join(f"{name} = {column[row]!r}" for name, column in self._axis_rows.items())
                yield f"{len(where)} of the runs: {outcome}; the first has {first}"

    def __repr__(self) -> str:
        return f"<achilles.Sweep {'x'.join(map(str, self.shape))}: {self.command}>"


@with_options
def sweep(system: System | str | os.PathLike[str], over: Mapping[str, Any] | str | Sequence[str], print: str | Sequence[str],
          *, at: str | None = None, after: float | str | None = None, random: int | None = None, seed: int | None = None,
          threads: int | None = None, progress: Callable[[int, int], object] | None = None,
          set: Mapping[str, float | str] | None = None, **values: float | str) -> Sweep:
    """Many runs as a table, as `achilles sweep` makes it, on all cores.

    `over` says what varies: {"e": (0, 0.95, 200)}, {"e": ("log", 1e-3, 0.9, 100)}, an array of equidistant values, or the
    command's own texts, "e=0:0.95:200". Several axes make a grid, the first slowest. With random=N, seed=S it is
    {"x": (-1, 1)}, and N points are drawn. `print` is what is asked of the runs: expressions over the end, zeno_time(k),
    impact_time(k), impact_speed(k), release_time(k), zeno_points, impacts, releases, least_gap, held, outcome; or the derivative
    of one of these numbers by a start, a rate or a parameter, "d(zeno_time(1), e)". `at` asks at
    every "impact", "zeno" or "release", or where an expression passes zero upwards, from time `after` on. A failed run is
    a point with an outcome, and a warning counts them.

    progress(done, count) is called a few times a second; what it raises ends the sweep, as Ctrl-C does, when the chunks under
    way (of a quarter of a second) have ended. Other threads run meanwhile. Raises InputError.
    """
    what = system_of(system)
    if threads is not None and not (isinstance(threads, int) and 1 <= threads <= 1024):
        raise InputError(f"threads={threads}: a whole number from 1 to 1024 is expected")
    if progress is not None and not callable(progress):
        raise TypeError("progress: a function of (done, count) is expected")
    asked = Asked(what._core, set, values)
    prints = texts_in("print", print, "zeno_time(2)")

    def text(name: str, value: object) -> str | None:
        return None if value is None else text_of(name, value)

    told = _core.sweep(what._core, _axes(over), prints, at, text("after", after), text("random", random),
                       text("seed", seed), asked.settings, asked.options, threads or 0, progress)
    result = Sweep(what, told)
    for warning in told["warnings"] + list(result._failures(told["points"])):
        warnings.warn(as_arguments(warning), AchillesWarning, stacklevel=2)
    return result


def _axes(over: Any) -> list[str]:
    """The axes as --over has them."""
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
        raise TypeError(f"over: {name} has (low, high, count), (\"log\", low, high, count) or an array of values")
    low, high, count = float(values[0]), float(values[-1]), values.size
    limits = f"{low!r}:{high!r}:{count}"
    if np.allclose(values, np.linspace(low, high, count), rtol=0, atol=1e-12 * max(abs(low), abs(high))):
        return limits
    if low > 0 and high > 0 and np.allclose(values, np.exp(np.linspace(math.log(low), math.log(high), count)), rtol=1e-12, atol=0):
        return "log:" + limits
    raise InputError(f"over: the values of {name} are neither at equal distances nor in equal ratios; write (low, high, count)")
