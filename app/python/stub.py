"""Writes the stub of the module, for editors and type checkers: what the module says of itself, without how it does it.

usage: stub.py FILE
"""

import ast
import inspect
import sys
import textwrap

import achilles

HEAD = '''\
# Made by stub.py of what the module says of itself.
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

__version__: str
__all__: list[str]
'''
KEPT_DECORATORS = {"property": "property", "functools.cached_property": "property", "classmethod": "classmethod"}


def is_public(name: str) -> bool:
    return not name.startswith("_") or name.endswith("_")


def signature(live: object, name: str) -> ast.FunctionDef:
    """Of a function as it is called: its signature is made of the table of options."""
    words, is_keyword = [], False
    called = inspect.signature(live)
    for p in called.parameters.values():
        if p.kind is p.KEYWORD_ONLY and not is_keyword:
            words.append("*")
            is_keyword = True
        default = "" if p.default is p.empty else f" = {p.default!r}"
        words.append(f"{'**' if p.kind is p.VAR_KEYWORD else ''}{p.name}: {p.annotation}{default}")
    return ast.parse(f"def {name}({', '.join(words)}) -> {called.return_annotation}: ...").body[0]


def stripped(node: ast.FunctionDef, live: object) -> ast.FunctionDef:
    result = signature(live, node.name) if hasattr(live, "__signature__") else node
    text = inspect.cleandoc(live.__doc__) if getattr(live, "__doc__", None) else None
    # Of a method that is called by none of its own words Python says something general.
    if ast.get_docstring(node) is None:
        text = None
    result.body = [ast.Expr(ast.Constant(text))] if text else []
    result.body.append(ast.Expr(ast.Constant(...)))
    names = [ast.unparse(decorator) for decorator in node.decorator_list]
    result.decorator_list = [ast.Name(KEPT_DECORATORS[name]) for name in names if name in KEPT_DECORATORS]
    return result


def of_class(node: ast.ClassDef, live: type) -> ast.ClassDef:
    body = []
    for part in node.body:
        if isinstance(part, ast.FunctionDef):
            if is_public(part.name):
                attribute = inspect.getattr_static(live, part.name)
                function = getattr(attribute, "fget", None) or getattr(attribute, "func", None) or attribute
                body.append(stripped(part, getattr(function, "__func__", function)))
        elif isinstance(part, ast.AnnAssign):
            if is_public(part.target.id):
                body.append(part)
        elif isinstance(part, ast.Expr):
            body.append(part)
    node.body = body or [ast.Expr(ast.Constant(...))]
    return node


def stub() -> str:
    parts = [HEAD]
    for name in achilles.__all__:
        live = getattr(achilles, name)
        tree = ast.parse(inspect.getsource(sys.modules[live.__module__]))
        node = next(n for n in tree.body if getattr(n, "name", None) == name)
        made = of_class(node, live) if isinstance(node, ast.ClassDef) else stripped(node, live)
        parts.append(ast.unparse(ast.fix_missing_locations(made)))
    return "\n\n".join(parts) + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(textwrap.dedent(__doc__))
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write(stub())
