"""System files from SymPy expressions. SymPy is imported only here, when it is needed."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable, Mapping
from typing import Any, NoReturn

from . import _core
from ._arguments import kind_of, text_of
from ._errors import InputError


def system_text(q: Any, T: Any, V: Any, gaps: Any, *, parameters: Any, rates: Any, start: Any, forces: Any, dissipation: Any,
                units: Any, names: Any, title: Any) -> str:
    """The text of the system file for the arguments of System.from_energies."""
    try:
        import sympy
    except ImportError:
        raise ImportError("System.from_energies needs SymPy: install python3-sympy, or run pip install sympy") from None
    try:
        known = _Names(sympy, q, rates, parameters, names)
        return _core.toml(_tables(_Writer(sympy, known), T, V, gaps, start, forces, dissipation, units, title))
    except RecursionError:
        raise InputError("the expressions are nested too deeply") from None


def _tables(writer: _Writer, T: Any, V: Any, gaps: Any, start: Any, forces: Any, dissipation: Any, units: Any,
            title: Any) -> dict[str, Any]:
    """The system file as a dict."""
    known = writer.names
    coordinates, rates = known.coordinates, [name + "'" for name in known.coordinates]

    def texts(argument: str, values: Any, names: list[str], example: str, write: Callable[[str, Any], Any]) -> dict[str, Any]:
        return {name: write(f"{argument}: {name}", value) for name, value in known.by_name(argument, values, names, example).items()}

    def rows(names: list[str], **columns: dict[str, Any]) -> list[dict[str, Any]]:
        return [{"name": name} | {key: column[name] for key, column in columns.items() if name in column} for name in names]

    at = texts("start", start, coordinates + rates, "{theta1: 0.5}", writer.value)
    pushed = texts("forces", forces, coordinates, "{theta1: tau}", writer.expression)
    unit = texts("units", units, coordinates + list(known.values), "{theta1: 'rad'}", _checked_text)
    lagrangian = {"kinetic": writer.expression("T", T), "potential": writer.expression("V", V)}
    if dissipation is not None:
        lagrangian["dissipation"] = writer.expression("dissipation", dissipation)
    constraints = []
    for name, gap, restitution in _gaps(gaps):
        argument = f"gaps: {name}" if name else "gaps"
        row = {"gap": writer.expression(argument, gap), "restitution": writer.value(argument, restitution)}
        constraints.append({"name": name} | row if name else row)
    values = {name: writer.value(f"parameters: {name}", value) for name, value in known.values.items()}
    known.refuse_missing()
    speeds = {name: at[rate] for name, rate in zip(coordinates, rates) if rate in at}
    tables = {"title": _checked_text("title", title or "") or f"Lagrangian system in {', '.join(coordinates)}",
              "coordinate": rows(coordinates, start=at, rate=speeds, force=pushed, unit=unit),
              "parameter": rows(list(values), value=values, unit=unit), "lagrangian": lagrangian, "constraint": constraints}
    return {key: table for key, table in tables.items() if table}


def _gaps(gaps: Any) -> list[tuple[str, Any, Any]]:
    """The name, gap and restitution of each contact; a single one may be without a name."""
    entries = list(gaps.items()) if isinstance(gaps, Mapping) else [("", gaps)]
    for name, pair in entries:
        if not isinstance(name, str):
            raise TypeError(f"gaps: the name of a contact must be a text, not {kind_of(name)}")
        if not isinstance(pair, (tuple, list)) or len(pair) != 2:
            raise TypeError(f"gaps: {name or 'one pair or a dict'}: a gap and its restitution are expected, such as "
                            f"{{'knee': (theta2, 0.5)}}, not {kind_of(pair)}")
    if not entries:
        _refuse("gaps", "a system needs at least one gap", "such as {'knee': (theta2, 0.5)}")
    return [(name, *pair) for name, pair in entries]


def _refuse(argument: str, message: str, hint: str = "") -> NoReturn:
    text = f"{argument}: {message}" + (f"\n{hint}" if hint else "")
    raise InputError(text, [(text, argument, 0, 0, message, hint)])


def _mapping(argument: str, value: Any, example: str) -> dict[Any, Any]:
    if value is not None and not isinstance(value, Mapping):
        raise TypeError(f"{argument}: a dict such as {example} is expected, not {kind_of(value)}")
    return dict(value or {})


def _listed(argument: str, value: Any) -> list[Any]:
    try:
        return list(value if not isinstance(value, (str, Mapping)) else None)  # a SymPy matrix is a list of its elements
    except TypeError:
        raise TypeError(f"{argument}: a list such as [theta1, theta2] is expected, not {kind_of(value)}") from None


def _checked_text(argument: str, value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{argument}: a text is expected, not {kind_of(value)}")
    return value


def _shown(expression: Any) -> str:
    text = str(expression)
    return text if len(text) <= 80 else text[:77] + "..."


class _Names:
    """The names of coordinates, rates, the time and parameters. No two symbols have the same one."""

    coordinates: list[str]
    values: dict[str, Any]
    """The values of parameters, by name."""

    def __init__(self, sympy: Any, q: Any, rates: Any, parameters: Any, names: Any) -> None:
        self._sympy = sympy
        self._renamed = _mapping("names", names, "{theta: 'theta1'}")
        self._texts: dict[Any, str] = {}  # of symbols, functions and their derivatives
        self._owners: dict[str, Any] = {}  # the symbol of a name; None until the symbol of a typed name occurs
        self._missing: dict[str, str] = {}  # parameters without a value, and the argument where they occur
        self.coordinates, self.values = [], {}
        self._add_coordinates(q, rates)
        for key, value in _mapping("parameters", parameters, "{m: 1.0}").items():
            if not isinstance(key, (str, sympy.Expr)):
                raise TypeError(f"parameters: a symbol or its name is expected, not {kind_of(key)}")
            name = self._checked("parameters", key, key) if isinstance(key, str) else self._name_of("parameters", key)
            if name in self.values or isinstance(key, str) and name in self._owners:
                _refuse("parameters", f"the name '{name}' is used twice")
            if isinstance(key, str):
                self._owners[name] = None
            else:
                self._add("parameters", key, name)
            self.values[name] = value

    def _add_coordinates(self, q: Any, rates: Any) -> None:
        coordinates = _listed("q", q)
        if not coordinates:
            _refuse("q", "a system needs at least one coordinate")
        given = _listed("rates", rates) if rates is not None else [None] * len(coordinates)
        if len(given) != len(coordinates):
            _refuse("rates", f"there are {len(given)} for {len(coordinates)} coordinates")
        times = [self._time_of("q", each) for each in coordinates]
        for each, coordinate in zip(given, coordinates):
            is_derivative = self._is_function(coordinate) and each == coordinate.diff(coordinate.args[0])
            times.append(None if is_derivative or each is None else self._time_of("rates", each))
        different = list(dict.fromkeys(time for time in times if time is not None))
        if len(different) > 1:
            _refuse("q", f"the functions depend on different symbols, {' and '.join(map(str, different))}")
        for time in different:
            self._add("q", time, "t")
        for coordinate, rate in zip(coordinates, given):
            name = self._name_of("q", coordinate)
            self._add("q", coordinate, name)
            self.coordinates.append(name)
            derivative = coordinate.diff(*different) if self._is_function(coordinate) else None
            if derivative is not None:
                self._texts[derivative] = name + "'"
            if rate is None and derivative is None:
                _refuse("q", f"{coordinate} is a symbol, so its rate needs a symbol, too",
                        f"give rates=[...], or make it a function of time: dynamicsymbols('{coordinate}')")
            if rate is not None and rate != derivative:
                self._add("rates", rate, name + "'")

    def _is_function(self, expression: Any) -> bool:
        """Whether this is an undefined function of one symbol, such as x(t)."""
        return (isinstance(expression, self._sympy.core.function.AppliedUndef) and len(expression.args) == 1
                and expression.args[0].is_Symbol)

    def _time_of(self, argument: str, expression: Any) -> Any:
        """The argument of a function of time; None for a symbol."""
        if not self._is_function(expression) and not isinstance(expression, self._sympy.Symbol):
            _refuse(argument, f"{_shown(expression)} is neither a symbol x nor a function x(t)",
                    "sympy.physics.mechanics.dynamicsymbols('x') makes a function of time")
        return expression.args[0] if self._is_function(expression) else None

    def _name_of(self, argument: str, symbol: Any) -> str:
        name = self._renamed.get(symbol)
        if name is None:
            name = symbol.func.__name__ if self._is_function(symbol) else getattr(symbol, "name", str(symbol))
        return self._checked(argument, name, symbol)

    @staticmethod
    def _checked(argument: str, name: Any, symbol: Any) -> str:
        if not isinstance(name, str):
            raise TypeError(f"names: the name of {symbol} must be a text, not {kind_of(name)}")
        is_name = _core.is_name(name)
        if not is_name or _core.is_reserved(name):
            better = re.sub(r"\W|^[\W\d_]+", "", _core.spelled_out(name), flags=re.ASCII) or "x"
            better += "_" if _core.is_reserved(better) else ""
            _refuse(argument, f"the name '{name}' is reserved" if is_name else
                    f"'{name}' is not a name: a name is a letter followed by letters, digits and underscores",
                    f"choose another name for the file: names={{symbol: '{better}'}}")
        return name

    def _add(self, argument: str, symbol: Any, name: str) -> None:
        other = self._owners.get(name)
        if symbol in self._texts:
            _refuse(argument, f"{_shown(symbol)} is given twice")
        if other is not None:
            assumptions = "; their assumptions differ" if str(other) == str(symbol) else ""
            _refuse(argument, f"the name '{name}' is that of two symbols, {_shown(other)} and {_shown(symbol)}{assumptions}",
                    "use one symbol everywhere, or name one of them in the file: names={symbol: 'name'}")
        self._owners[name] = symbol
        self._texts[symbol] = name

    def of(self, argument: str, expression: Any) -> str | None:
        """The name of a coordinate, a rate, the time or a parameter, which may be new; None for any other expression."""
        if expression in self._texts:
            return self._texts[expression]
        if not isinstance(expression, self._sympy.Symbol):
            return None
        is_time = expression.name == "t" and expression not in self._renamed
        name = "t" if is_time else self._name_of(argument, expression)
        if name not in self._owners and not is_time:
            self._missing[name] = argument
        self._add(argument, expression, name)
        return name

    def by_name(self, argument: str, values: Any, names: list[str], example: str) -> dict[str, Any]:
        """A dict of these symbols or names, by name."""
        result: dict[str, Any] = {}
        for key, value in _mapping(argument, values, example).items():
            name = key if isinstance(key, str) else self._texts.get(key, str(key))
            if name not in names:
                _refuse(argument, f"{_shown(key)} is not one of {', '.join(names)}{_core.did_you_mean(name, names)}")
            if name in result:
                _refuse(argument, f"{name} is given twice")
            result[name] = value
        return result

    def refuse_missing(self) -> None:
        if self._missing:
            places = ", ".join(dict.fromkeys(self._missing.values()))
            _refuse("parameters", f"no value is given for {', '.join(self._missing)} in {places}",
                    f"parameters={{{', '.join(f'{name}: ...' for name in self._missing)}}}; the coordinates are "
                    f"{', '.join(self.coordinates)}")


# How tightly a text binds: a sum, a product with a sign, a product, a power, an atom.
_SUM, _SIGNED, _PRODUCT, _POWER, _ATOM = range(5)

# Functions that system files lack, in terms of those that they have.
_REWRITTEN = {"cot": "cos({0})/sin({0})", "sec": "1/cos({0})", "csc": "1/sin({0})",
              "coth": "cosh({0})/sinh({0})", "sech": "1/cosh({0})", "csch": "1/sinh({0})"}
# SymPy's functions with corners or jumps, by the function for which the language has advice.
_CORNERS = {"Abs": "abs", "Max": "max", "Min": "min", "sign": "sign", "floor": "floor", "ceiling": "ceil", "Mod": "mod",
            "frac": "mod", "Heaviside": "floor", "Piecewise": "floor"}


class _Writer:
    """Writes SymPy expressions in the language of system files."""

    def __init__(self, sympy: Any, names: _Names) -> None:
        self._sympy = sympy
        self.names = names
        self._argument = ""  # that is written

    def expression(self, argument: str, value: Any) -> str:
        """The text of an expression, exactly. A text is taken as it is."""
        if isinstance(value, str):
            return value
        sympy = self._sympy
        try:
            expression = sympy.sympify(value, strict=True)
        except sympy.SympifyError:
            expression = None
        is_matrix = getattr(expression, "is_Matrix", False)
        if not isinstance(expression, sympy.Expr) or is_matrix:
            more = ": take its element [0]" if is_matrix else ""
            raise TypeError(f"{argument}: a SymPy expression is expected, not {kind_of(value)}{more}")
        if any(not isinstance(each.expr, sympy.core.function.AppliedUndef) for each in expression.atoms(sympy.Derivative)):
            expression = expression.doit()  # an unevaluated derivative, such as that of cos(theta(t))
        self._argument = argument
        return self._text(expression)[0]

    def value(self, argument: str, value: Any) -> float | str:
        """A number, or the text of an expression. A text is taken as it is."""
        if isinstance(value, str):
            return value
        is_symbolic = isinstance(value, self._sympy.Basic)
        text = self.expression(argument, value) if is_symbolic else text_of(argument, value)
        if is_symbolic and not (value.is_Integer or value.is_Float):
            return text
        number = float(text)
        if not math.isfinite(number):
            _refuse(argument, f"{_shown(value)} is not a finite number")
        return number

    def _refuse(self, expression: Any, why: str, hint: str = "") -> NoReturn:
        _refuse(self._argument, f"{_shown(expression)} {why}", hint)

    def _text(self, e: Any) -> tuple[str, int]:
        """The text of an expression, and how tightly it binds."""
        name = self.names.of(self._argument, e)
        if name is not None:
            return name, _ATOM
        if e.is_Number:
            return self._number(e)
        if e.is_Add:
            return self._sum(e)
        if e.is_Mul or e.is_Pow and e.exp.is_Rational and e.exp.is_negative:
            return self._product(e)
        if e.is_Pow:
            return self._power(e.base, e.exp)
        if e is self._sympy.pi:
            return "pi", _ATOM
        if e is self._sympy.E:
            return "exp(1)", _ATOM
        name = type(e).__name__
        is_of_sympy = type(e) is getattr(self._sympy, name, None)
        if is_of_sympy and name in _core.functions:
            return f"{name}({self._text(e.args[0])[0]})", _ATOM
        if is_of_sympy and name in _REWRITTEN:
            return _REWRITTEN[name].format(self._text(e.args[0])[0]), _PRODUCT
        self._refuse_other(e)

    def _number(self, e: Any) -> tuple[str, int]:
        if not (e.is_real and e.is_finite):
            self._refuse(e, "is not a finite number")
        if e.is_Rational:
            return str(e), _SIGNED if e.is_negative else _ATOM if e.is_Integer else _PRODUCT
        number = float(e)
        if math.isinf(number) or (number == 0) != (e == 0):
            self._refuse(e, "is beyond the range of a double")
        text = repr(number) if e._prec == 53 else self._shortest(e)
        return text, _SIGNED if text.startswith("-") else _ATOM

    @staticmethod
    def _shortest(e: Any) -> str:
        """The shortest decimal that is this number in its own precision."""
        from mpmath import libmp

        texts = (libmp.to_str(e._mpf_, digits) for digits in itertools.count(1))
        return next(text for text in texts if libmp.from_str(text, e._prec, "n") == e._mpf_)

    def _sum(self, e: Any) -> tuple[str, int]:
        text = ""
        for term in e.as_ordered_terms():
            part = _in_brackets(*self._text(term), _SIGNED)
            text += part if not text else " - " + part[1:] if part.startswith("-") else " + " + part
        return text, _SUM

    def _product(self, e: Any) -> tuple[str, int]:
        number, rest = e.as_coeff_Mul()
        sign = "-" if number.is_negative else ""
        over, under = abs(number).as_numer_denom()
        above = [] if over == 1 else [self._text(over)[0]]
        below = [] if under == 1 else [self._text(under)[0]]
        for factor in rest.as_ordered_factors() if rest != 1 else ():
            if factor.is_Pow and factor.exp.is_Rational and factor.exp.is_negative:
                below.append(_in_brackets(*self._power(factor.base, -factor.exp), _POWER))
            else:
                above.append(_in_brackets(*self._text(factor), _POWER))
        text = sign + ("*".join(above) or "1")
        if below:
            text += "/" + (below[0] if len(below) == 1 else f"({'*'.join(below)})")
        return text, _SIGNED if sign else _PRODUCT

    def _power(self, base: Any, exponent: Any) -> tuple[str, int]:
        if exponent == 1:
            return self._text(base)
        if exponent == self._sympy.S.Half:
            return f"sqrt({self._text(base)[0]})", _ATOM
        if not exponent.is_number and not (base.is_number and base.is_positive):
            self._refuse(base**exponent, "cannot be written: the exponent must be a number, or the base a positive number",
                         "if x is positive, exp(n*log(x)) is x^n")
        if exponent.is_number and not exponent.is_integer and base.is_negative and base.is_number:
            self._refuse(base**exponent, "is not a real number")
        return f"{_in_brackets(*self._text(base), _ATOM)}^{_in_brackets(*self._text(exponent), _ATOM)}", _POWER

    def _refuse_other(self, e: Any) -> NoReturn:
        name = type(e).__name__
        if name in _CORNERS:
            self._refuse(e, "is not smooth, and the equations of motion need derivatives",
                         _core.instead_of_corner(_CORNERS[name]))
        if isinstance(e, self._sympy.Derivative):
            self._refuse(e, "is neither a coordinate nor a rate", "energies, forces and gaps contain no accelerations; a "
                         "function of time that is not in q is replaced by its expression")
        if isinstance(e, self._sympy.core.function.AppliedUndef):
            self._refuse(e, "is not a coordinate", f"the coordinates are {', '.join(self.names.coordinates)}; add it to q, or "
                         "replace it by its expression in t")
        if e.is_real is False:
            self._refuse(e, "is not a real number")
        self._refuse(e, "is unknown in a system file", f"the functions are {', '.join(_core.functions)}")


def _in_brackets(text: str, binding: int, least: int) -> str:
    """The text of an operand, in parentheses if it binds less tightly than needed."""
    return text if binding >= least else f"({text})"
