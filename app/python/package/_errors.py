"""Errors and warnings."""

from __future__ import annotations

import keyword
import re


class AchillesWarning(UserWarning):
    """Something in the input or the result of a run that is allowed, but may not be intended."""


class NoOrbit(RuntimeError):
    """No periodic run was found near the start of the search. Its text says why."""


class InputError(ValueError):
    """Wrong input. Its text is that of the command line: the place, what is wrong, the line with a caret, a hint.

    If a file has several mistakes, the attributes are those of the first; `mistakes` has all.
    """

    file: str
    """The file or the argument; empty if there is neither."""
    line: int | None
    """Line in the file, from 1; None if the mistake has no place in a file."""
    column: int | None
    """Column in the line, from 1; None if there is no line."""
    message: str
    """What is wrong."""
    hint: str
    """What to write instead; may be empty."""
    caret: str
    """The line, and below it a caret at the place; empty if there is no line."""
    mistakes: tuple[InputError, ...]
    """All mistakes, this one first."""

    def __init__(self, told: str, mistakes: list[tuple[str, str, int, int, str, str]] | None = None) -> None:
        mistakes = mistakes or [(told, "", 0, 0, told, "")]
        one, file, line, column, message, hint = mistakes[0]
        is_located = line > 0
        super().__init__(told if is_located else as_arguments(told))
        self.file = file if is_located else as_arguments(file)
        self.line = line if is_located else None
        self.column = column if is_located else None
        self.message, self.hint = (message, hint) if is_located else (as_arguments(message), as_arguments(hint))
        self.caret = "\n".join(one.split("\n")[1:3]) if "^" in one and is_located else ""
        self.mistakes = (self,) + tuple(InputError(each[0], [each]) for each in mistakes[1:])


def as_arguments(text: str) -> str:
    """Replaces the flags of the command line by the arguments of Python: `--set e=2` is e=2, `--eps-q` eps_q, `--from` from_."""

    def argument(flag: re.Match[str]) -> str:
        name = flag[1].replace("-", "_")
        return name + "_" if keyword.iskeyword(name) else name

    text = re.sub(r"--set (?=\S)", "", text)
    return re.sub(r"--([a-z][a-z0-9]*(?:-[a-z0-9]+)*)", argument, text)
