"""Figures of a run and of a periodic run."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from typing import Any

from . import _core
from ._arguments import number_in, whole_number_in
from ._errors import InputError


class Figure:
    """Views of a run, drawn as by `achilles figure`, or of a periodic run, as by `achilles orbit`. A notebook shows it; `save`
    writes it to a file. Returned by Run.figure and Orbit.figure."""

    def __init__(self, drawn: Any, look: tuple[Any, ...]) -> None:
        self._drawn, self._look = drawn, look

    @property
    def svg(self) -> str:
        """The figure as SVG."""
        return self.bytes("svg").decode()

    def bytes(self, format: str) -> bytes:
        """The figure as a file: "svg", "png" (needs a renderer) or "pdf" (needs rsvg-convert)."""
        if format not in ("svg", "png", "pdf"):
            raise ValueError(f"the format of a figure is svg, png or pdf, not {format!r}")
        return self._drawn.figure(self._look, format)

    def save(self, path: str | os.PathLike[str], format: str | None = None) -> None:
        """Writes the figure; the name ends in .svg, .png or .pdf. The file contains the command that reproduces it."""
        name = os.fspath(path)
        ending = os.path.splitext(name)[1].lower()
        if format is None and ending not in (".svg", ".png", ".pdf"):
            raise ValueError(f"{name}: the name must end in .svg, .png or .pdf, or format must be given")
        content = self.bytes(format or ending[1:])
        with open(name, "wb") as file:
            file.write(content)

    def __repr__(self) -> str:
        views, (width, height) = self._look[0], self._look[1]
        return f"<achilles.Figure of {', '.join(views) or 'all views'}: {width} x {height} pixels>"

    def _repr_svg_(self) -> str:
        svg = self.svg
        return svg[svg.index("<svg") :]  # HTML does not allow the XML declaration


def known_views(known: Sequence[str], views: Sequence[str]) -> None:
    """Raises InputError for a view that is not in `known`."""
    for view in views:
        if view not in known:
            guess = _core.did_you_mean(view, list(known)) if isinstance(view, str) else ""
            raise InputError(f"this system has no view '{view}'{guess}\nits views are: {', '.join(known)}")


def figure_of(drawn: Any, known: Sequence[str], views: Sequence[str], size: tuple[int, int], scale: float,
              paper: dict[str, float], columns: int, dark: bool, transparent: bool) -> Figure:
    """Checks the arguments and makes a figure. Raises InputError for a view that is not in `known`."""
    known_views(known, views)
    pixels = _pixels(size)
    page = tuple(number_in(name, value, 0, 1e6) for name, value in paper.items())
    return Figure(drawn, (list(views), pixels, number_in("scale", scale, 0.25, 8), page,
                          whole_number_in("columns", columns, 0, 20), bool(dark), bool(transparent)))


def _pixels(size: Any) -> tuple[int, int]:
    """Checks (width, height) in pixels. For the command-line form "800x600" the error names the Python form."""
    typed = re.fullmatch(r"\s*(\d+)\s*[x*,]\s*(\d+)\s*", size) if isinstance(size, str) else None
    if typed:
        raise TypeError(f"size: two numbers are expected, not a text; write size=({typed[1]}, {typed[2]})")
    try:
        if isinstance(size, str):
            raise TypeError
        width, height = size
    except (TypeError, ValueError):
        raise TypeError(f"size: (width, height) in pixels is expected, such as (1200, 800), not {size!r}") from None
    return whole_number_in("size", width, 64, 16384), whole_number_in("size", height, 64, 16384)
