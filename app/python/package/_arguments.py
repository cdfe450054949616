"""Conversion and checks of Python arguments: values and options of a run, by the option table of the command line."""

from __future__ import annotations

import inspect
import numbers
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from . import _core
from ._errors import AchillesWarning, InputError

_table: list[dict[str, Any]] = _core.option_table()


def _name(flag: str) -> str:
    return flag[2:].replace("-", "_")


# Flags by their Python names, such as end, end_time, eps_q.
_flags: dict[str, str] = {row["key"]: row["flag"] for row in _table} | {_name(row["flag"]): row["flag"] for row in _table}


def text_of(name: str, value: object) -> str:
    """Text of a value: a number in the shortest form that reads back the same, or an expression as typed."""
    if isinstance(value, str):
        return value
    if hasattr(value, "item") and getattr(value, "ndim", 0) == 0:
        value = value.item()  # a NumPy scalar
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name}: a number or a text such as 'pi/6' is expected, not {kind_of(value)}")
    return repr(int(value)) if isinstance(value, numbers.Integral) else repr(float(value))


def number_in(name: str, value: object, least: float, most: float) -> float:
    """Checks and returns a number in the range [least, most]."""
    if isinstance(value, str):
        raise TypeError(f"{name}: a number is expected, not {kind_of(value)}")
    number = float(text_of(name, value))
    if not least <= number <= most:
        raise InputError(f"{name}: {value} does not lie in [{least}, {most}]")
    return number


def whole_number_in(name: str, value: object, least: int, most: int) -> int:
    """Checks and returns an integer in the range [least, most]."""
    number = number_in(name, value, least, most)
    if number != int(number):
        raise InputError(f"{name}: a whole number from {least} to {most} is expected, not {value}")
    return int(number)


def texts_in(name: str, value: object, example: str) -> list[str]:
    """Checks a string or a list of strings and returns a list."""
    texts = [value] if isinstance(value, str) else list(value) if isinstance(value, Iterable) else [value]
    for text in texts:
        if not isinstance(text, str):
            raise TypeError(f"{name}: a text such as {example!r} is expected, or a list of them, not {kind_of(text)}")
    return texts


def one_of(name: str, value: Any, plain_name: str, plain: Any) -> Any:
    """The value of an argument that has two names, of which at most one may be given; None if neither is."""
    if value is not None and plain is not None:
        raise TypeError(f"{plain_name} and {name} are two names of the same argument: give only one of them")
    return value if plain is None else plain


def kind_of(value: object) -> str:
    """The type of a wrong argument, and its value, for messages."""
    return "None" if value is None else f"{type(value).__name__} ({value!r})"[:80]


class RunArguments:
    """Arguments of a run: settings in the form of --set, and options by flag."""

    settings: list[str]
    options: dict[str, str]

    def __init__(self, system: Any, set: Mapping[str, object] | None, plain: Mapping[str, object] | None,
                 given: Mapping[str, object]) -> None:
        self.settings, self.options = [], {}
        place = "set" if plain is None else "values"
        listed = one_of("set", set, "values", plain)
        if listed is not None and not isinstance(listed, Mapping):
            raise TypeError(f"{place}: a dict such as {{\"x'\": 1.5}} is expected, not {kind_of(listed)}")
        values = dict(listed or {})
        for name, value in given.items():
            if name in _flags:
                if value is not None:
                    self._take(name, value)
                    if name in system.settable:
                        told = f"{name} is taken as the option; the value of the system with this name goes into values"
                        warnings.warn(told, AchillesWarning, stacklevel=3)
            elif name in values:
                raise TypeError(f"{name} is given twice: as an argument and in {place}")
            else:
                _check_name(system, name)
                values[name] = value
        for name, value in values.items():
            self.settings.append(f"{name}={text_of(name, value)}")

    def _take(self, name: str, value: object) -> None:
        flag = _flags[name]
        if flag in self.options:
            raise TypeError(f"{name} is given twice, under two names")
        self.options[flag] = text_of(name, value)


def _check_name(system: Any, name: str) -> None:
    if name in system.settable:
        return
    options = [_name(row["flag"]) for row in _table]
    guess = _core.did_you_mean(name, system.settable) or _core.did_you_mean(name, options)
    known = ", ".join(system.settable)
    told = f"there is no value or option '{name}'{guess}"
    hint = f"its values are {known}; a name that is not valid in Python goes into values={{\"x'\": 1.5}}"
    raise InputError(f"{told}\n{hint}", [(told, name, 0, 0, told, hint)])


def with_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator that adds all options to the signature and docstring of a function with a **named parameter."""
    signature = inspect.signature(function)
    kept = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
    rest = [p for p in signature.parameters.values() if p.kind is p.VAR_KEYWORD]
    lines = []
    for row in _table:
        name = _name(row["flag"])
        kind = f"Literal[{', '.join(map(repr, row['words']))}]" if row["words"] else "int | str" if isinstance(row["default"], int) else "float | str"
        kept.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=f"{kind} | None"))
        unit, choice = f", {row['unit']}" if row["unit"] else "", f": {' or '.join(row['words'])}" if row["words"] else ""
        lines.append(f"    {name}: {row['about']}{unit}{choice}")
    function.__signature__ = signature.replace(parameters=kept + rest)  # type: ignore[attr-defined]
    head = "\n\n    Options, where they differ from those of the file:\n\n"
    function.__doc__ = (function.__doc__ or "").rstrip() + head + "\n".join(lines) + "\n    "
    return function
