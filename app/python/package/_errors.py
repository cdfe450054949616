"""What is told to a person."""

from __future__ import annotations

import keyword
import re


class AchillesWarning(UserWarning):
    """What a run asks for or came to is no mistake, but perhaps not what was meant."""


class NoOrbit(RuntimeError):
    """No periodic run was found near where the search began. Its text says why."""


class InputError(ValueError):
    """What was asked for cannot be. Its text is that of the command line: where, what is wrong, the line with a caret, a hint.

    Of several mistakes in one file the attributes are those of the first; `mistakes` has all.
    """

    file: str
    """Which file, or which argument; empty where it is none."""
    line: int | None
    """In the file, from 1; None where it stands at no place."""
    column: int | None
    """In the line, from 1."""
    message: str
    """What is wrong."""
    hint: str
    """What would be right; may be empty."""
    caret: str
    """The line, and below it a caret under the place; empty where there is none."""
    mistakes: tuple[InputError, ...]
    """All of them, this one first."""

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
    """The flags of a command line as the arguments that they are here: `--set e=2` is e=2, `--eps-q` eps_q, `--from` from_."""

    def argument(flag: re.Match[str]) -> str:
        name = flag[1].replace("-", "_")
        return name + "_" if keyword.iskeyword(name) else name

    text = re.sub(r"--set (?=\S)", "", text)
    return re.sub(r"--([a-z][a-z0-9]*(?:-[a-z0-9]+)*)", argument, text)
