"""Figures of a run."""

from __future__ import annotations

import os
from typing import Any


class Figure:
    """Views of a run, drawn as `achilles figure` draws them. A notebook shows it; `save` writes it. Made by Run.figure."""

    def __init__(self, run: Any, views: list[str], size: tuple[int, int], scale: float,
                 page: tuple[float, float, float, float], columns: int, dark: bool, transparent: bool) -> None:
        self._run = run
        self._look = (views, size, float(scale), page, columns, dark, transparent)

    @property
    def svg(self) -> str:
        """The figure as SVG."""
        return self.bytes("svg").decode()

    def bytes(self, format: str) -> bytes:
        """The figure as a file: "svg", "png" (where there is a renderer) or "pdf" (where there is rsvg-convert)."""
        if format not in ("svg", "png", "pdf"):
            raise ValueError(f"a figure is svg, png or pdf, not {format!r}")
        return self._run.figure(*self._look, format)

    def save(self, path: str | os.PathLike[str], format: str | None = None) -> None:
        """Writes it; the ending of the name says as what, .svg, .png or .pdf. It carries the command that makes it again."""
        name = os.fspath(path)
        ending = os.path.splitext(name)[1].lower()
        if format is None and ending not in (".svg", ".png", ".pdf"):
            raise ValueError(f"{name}: its name ends in none of .svg, .png and .pdf, which say what it is")
        content = self.bytes(format or ending[1:])
        with open(name, "wb") as file:
            file.write(content)

    def _repr_svg_(self) -> str:
        svg = self.svg
        return svg[svg.index("<svg") :]  # a page has no room for the head of a file
