"""A system: its file, and what is derived from it."""

from __future__ import annotations

import functools
import os
from collections.abc import Mapping, Sequence
from typing import Any

from . import _core
from ._energies import system_text


class System:
    """A system, read and derived from the text of a system file, or from a name in the gallery.

    All runs of one System share the derived equations. Raises InputError with every mistake, each with its line and a caret.
    """

    name: str
    """Name in the gallery, or the path of the file, or "<text>"."""
    title: str
    source: str
    text: str
    """Text of the file."""
    coordinates: list[str]
    parameters: dict[str, float]
    """The values in the file, including derived parameters."""
    start: dict[str, float]
    """Initial coordinates and rates, x and x'."""
    options: dict[str, Any]
    """Options of its runs, from the file or by default."""
    contacts: list[str]
    views: list[str]
    """The views that figures can show."""
    units: dict[str, str]
    """Units of coordinates, rates and parameters, where the file gives them."""

    def __init__(self, text: str, name: str | None = None) -> None:
        if not isinstance(text, str):
            raise TypeError(f"the text of a system, or its name, is expected, not {type(text).__name__}")
        is_name = name is None and "\n" not in text and "=" not in text and text != ""
        self._core = _of_file(text) if is_name else _derived(text, name or "<text>")
        core = self._core
        self.name, self.title, self.source, self.text = core.name, core.title, core.source, core.text
        self.coordinates = [coordinate for coordinate, _, _ in core.start]
        self.start = {coordinate: q for coordinate, q, _ in core.start}
        self.start |= {coordinate + "'": v for coordinate, _, v in core.start}
        self.parameters, self.options, self.units = core.parameters, core.options, core.units
        self.contacts, self.views = core.contacts, core.views

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> System:
        """The system of a file."""
        file = os.fspath(path)
        return cls(_core.read_text(file), file)

    @classmethod
    def from_energies(cls, q: Sequence[Any], T: Any, V: Any, gaps: Mapping[str, tuple[Any, Any]] | tuple[Any, Any],
                      parameters: Mapping[Any, Any] | None = None, *, rates: Sequence[Any] | None = None,
                      start: Mapping[Any, Any] | None = None, forces: Mapping[Any, Any] | None = None, dissipation: Any = None,
                      units: Mapping[Any, str] | None = None, names: Mapping[Any, str] | None = None,
                      title: str | None = None) -> System:
        """The system with these coordinates q, kinetic energy T, potential energy V and gaps, which are SymPy expressions.

        q: functions of time, as from sympy.physics.mechanics.dynamicsymbols, whose derivatives are the rates; or symbols
        gaps: {"knee": (gap, restitution), "wall": ...}, or one pair
        parameters: the value of every other symbol: a number, a text such as "pi/6", or an expression in other parameters
        rates: symbols or functions for the rates of q, in the same order; needed if q has symbols
        start: initial coordinates and rates, {theta1: pi/6, theta1.diff(t): -0.3} or {"theta1'": -0.3}; otherwise 0
        forces: generalized forces by coordinate, {theta1: tau*cos(om*t)}
        dissipation: the function R whose negative derivative with respect to each rate is a force
        units: units of coordinates and parameters, {theta1: "rad"}
        names: names in the file for symbols whose own names it does not allow, {Symbol("lambda"): "lam"}

        Fractions, pi and roots are written exactly, floats with the fewest digits that read back the same. The time is the
        argument of the functions, or the symbol t. Raises InputError, which names the part of an expression that a system file
        cannot contain, such as Abs(x). Views, drawings and options can be appended to `to_toml()`. Needs SymPy.
        """
        return cls(system_text(q, T, V, gaps, parameters=parameters, rates=rates, start=start, forces=forces,
                               dissipation=dissipation, units=units, names=names, title=title))

    def to_toml(self, path: str | os.PathLike[str] | None = None, *, expand: bool = False) -> str:
        """The text of the system file, also written to `path` if that is given. Its runs have the same bytes.

        It is the text that the system was made from, with its comments, and with a title if it has none. With expand=True, the
        energies, forces, gaps and drawings that are derived from bodies, springs and contacts stand in place of those, as from
        `achilles check --expand`.
        """
        text = self._core.to_toml(expand)
        if path is not None:
            with open(path, "w", encoding="utf-8", newline="") as file:
                file.write(text)
        return text

    @functools.cached_property
    def equations(self) -> list[tuple[str, str]]:
        """The derived equations as pairs (description, LaTeX). They are simplified, which may take a second."""
        return self._core.equations()

    def latex(self) -> str:
        """All equations as one LaTeX display."""
        lines = []
        for words, formula in self.equations:
            if words:
                lines.append(rf"&\text{{{_escaped(words)}}}")
            lines.append("&" + formula)
        return "\\begin{aligned}\n" + " \\\\\n".join(lines) + "\n\\end{aligned}"

    def _repr_latex_(self) -> str:
        return f"$$\n{self.latex()}\n$$"

    def __repr__(self) -> str:
        return f"<achilles.System {self.name}: {self.title}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return System, (self.text, self.name)


def gallery() -> dict[str, str]:
    """The systems that come with Achilles: name and title."""
    return {name: _of_file(name).title for name in _core.system_names()}


def system_of(system: System | str | os.PathLike[str]) -> System:
    """Returns the system that an argument specifies: a System, a path or a name."""
    if isinstance(system, System):
        return system
    if isinstance(system, os.PathLike):
        return System.from_file(system)
    if not isinstance(system, str):
        raise TypeError(f"a System, a path or a name of the gallery is expected, not {type(system).__name__}")
    if "\n" in system:
        raise TypeError("a System, a path or a name of the gallery is expected; for the text of a system use achilles.System(text)")
    return System(_core.read_text(_core.find_system(system)), system)


def _of_file(name: str) -> Any:
    return _derived(_core.read_text(_core.find_system(name)), name)


@functools.lru_cache(maxsize=64)
def _derived(text: str, name: str) -> Any:
    """Derives a system; cached, so that each file is derived once."""
    return _core.system(text, name)


def _escaped(words: str) -> str:
    """Escapes plain text for LaTeX's \\text{}."""
    return "".join("\\" + c if c in "&%$#_{}" else c for c in words.replace("\\", ""))
