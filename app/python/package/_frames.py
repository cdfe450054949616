"""Tables for pandas, which is imported only when a table is made."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

_texts = ("phase", "held", "inactive", "latched", "modes", "event")


def pandas_for(what: str) -> Any:
    """The module pandas. Raises ImportError, with what to install, if there is none."""
    try:
        import pandas
    except ImportError:
        raise ImportError(f"{what} needs pandas: install python3-pandas, or run pip install pandas") from None
    return pandas


def frame_of(pandas: Any, columns: Mapping[str, Sequence[str]], units: Mapping[str, str]) -> Any:
    """A pandas.DataFrame of the columns of a CSV file. An empty cell of a column of numbers is NaN."""
    frame = pandas.DataFrame({name: list(column) if name in _texts else _numbers(column) for name, column in columns.items()})
    frame = frame.astype({"j": int})
    frame.attrs["units"] = {name: unit for name, unit in units.items() if unit}
    return frame


def _numbers(column: Sequence[str]) -> list[float]:
    return [float(text) if text else float("nan") for text in column]
