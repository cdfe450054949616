"""Systems from SymPy expressions: what is written, SymPy's own equations of motion, a run of the gallery, wrong use."""

import random
import subprocess
import sys

import mpmath
import numpy as np
import pytest
import sympy as sp
from sympy import Float, Function, Rational, Symbol, cos, exp, pi, sin, sqrt, symbols
from sympy.physics import mechanics
from sympy.physics.mechanics import dynamicsymbols

import achilles

t = dynamicsymbols._t
x, y = dynamicsymbols("x y")
xd, yd = x.diff(t), y.diff(t)
m, g, k = symbols("m g k")


def made(q=(x, y), T=(xd**2 + yd**2) / 2, V=g * y, gaps=(y, 0.5), parameters={g: 9.81}, **more):
    return achilles.System.from_energies(q, T, V, gaps, parameters, **more)


def potential_of(system):
    (line,) = [line for line in system.text.splitlines() if line.startswith("lagrangian.potential = ")]
    return line.removeprefix('lagrangian.potential = "').removesuffix('"')


@pytest.mark.parametrize("expression, text", [
    (Rational(1, 3) * x, "x/3"),
    (-Rational(2, 3) * g * x, "-2*g*x/3"),
    (Rational(1, 3) * x / (g * y), "x/(3*g*y)"),
    (0.1 * x, "0.1*x"),
    (1e-7 * x - 1e22, "1e-07*x - 1e+22"),
    (Float("0.1", 30) * x, "0.1*x"),
    (Float(1, 30) / 3, "0.3333333333333333333333333333333"),
    (Float("0.1", 5), "0.1"),
    (x**2 + g * x - 1, "g*x + x^2 - 1"),
    ((x - g) * (x + y) / 2, "(-g + x)*(x + y)/2"),
    (-(x + y), "-x - y"),
    (sp.Mul(-1, x + y, evaluate=False), "-(x + y)"),
    (sp.Add(x, sp.Add(y, g, evaluate=False), evaluate=False), "(g + y) + x"),
    (sp.Add(x, sp.Add(y, -x, evaluate=False), evaluate=False), "(-x + y) + x"),  # str() gives -(x + y) + x
    (1 / x, "1/x"),
    (x**-2 / 3, "1/(3*x^2)"),
    (sqrt(x), "sqrt(x)"),
    (1 / sqrt(x + y), "1/sqrt(x + y)"),
    (x**Rational(3, 2), "x^(3/2)"),
    (x**Rational(-2, 3), "1/x^(2/3)"),
    (x**0.25, "x^0.25"),
    (x**-0.25, "x^(-0.25)"),
    (x**pi, "x^pi"),
    (x ** (pi / 2), "x^(pi/2)"),
    (2**x, "2^x"),
    (Rational(1, 2) ** x, "(1/2)^x"),
    ((x**2) ** 3, "x^6"),
    ((x**g) ** 0, "1"),
    (sqrt(2) * x, "sqrt(2)*x"),
    (exp(-x) * sp.E, "exp(1)*exp(-x)"),
    (sp.E * x, "exp(1)*x"),
    (sp.log(x, 10), "log(x)/log(10)"),
    (sin(x) ** 2 * cos(g * t), "sin(x)^2*cos(g*t)"),
    (sp.tan(x) + sp.asin(x) + sp.acos(x) + sp.atan(x), "tan(x) + acos(x) + asin(x) + atan(x)"),
    (sp.sinh(x) * sp.cosh(x) * sp.tanh(x), "sinh(x)*cosh(x)*tanh(x)"),
    (2 * sp.cot(x), "2*(cos(x)/sin(x))"),
    (1 / sp.sec(x), "1/(1/cos(x))"),
    (sp.Derivative(sin(x), x, evaluate=False), "cos(x)"),
    (pi * x / 180, "pi*x/180"),
])
def test_what_is_written(expression, text):
    writer = achilles._energies._Writer(sp, achilles._energies._Names(sp, [x, y], None, {g: 1.0}, None))
    assert writer.expression("V", expression) == text


def random_expression(dice, depth):
    """A random expression in x, y and g, real and of moderate size where they are between 0.5 and 1.5."""
    if depth == 0:
        return dice.choice([x, y, g, pi, sp.Integer(dice.randint(-3, 3)), Rational(dice.randint(1, 9), 7),
                            Float(dice.uniform(-2, 2)), Float(dice.uniform(0, 1e-3))])
    a, b = random_expression(dice, depth - 1), random_expression(dice, depth - 1)
    bounded = sin(a) + Rational(5, 2)
    return dice.choice([
        lambda: a + b, lambda: a - b, lambda: a * b, lambda: a / (2 + cos(b)), lambda: -a, lambda: bounded ** dice.randint(-3, 3),
        lambda: bounded ** Rational(dice.randint(-7, 7), 3), lambda: sqrt(bounded) * b, lambda: bounded**-0.5, lambda: 3 ** sin(b),
        lambda: sp.Mul(a, a + b, evaluate=False),
        lambda: dice.choice([sin, cos, sp.atan, sp.tanh, sp.sec])(a / 10), lambda: exp(sin(a)), lambda: sp.log(bounded),
        lambda: sp.sinh(sin(a)) - sp.cosh(sin(b)), lambda: sp.asin(sin(b) / 2) + sp.acos(cos(a) / 2), lambda: sp.tan(sin(a))])()


def test_random_expressions_have_the_values_that_sympy_gives():
    dice = random.Random(7)
    writer = achilles._energies._Writer(sp, achilles._energies._Names(sp, [x, y], None, {g: 1.0}, None))
    system = made()
    written = 0
    for _ in range(200):
        expression = random_expression(dice, dice.randint(1, 3))
        # Rounding errors are bounded by the largest part of the expression.
        parts = [part for part in sp.preorder_traversal(expression) if part != t]
        at = [dice.uniform(0.5, 1.5) for _ in range(3)]
        with mpmath.workdps(30):
            try:
                values = [mpmath.mpmathify(value) for value in sp.lambdify([x, y, g], parts, "mpmath")(*at)]
            except ZeroDivisionError:
                continue
        if any(isinstance(value, mpmath.mpc) for value in values):
            continue
        run = achilles.simulate(system, set=dict(zip("xyg", at)), end=1e-3)
        value = run.evaluate(writer.expression("V", expression), 0)
        assert value == pytest.approx(float(values[0]), abs=1e-13 * float(max(map(abs, values)))), expression
        written += 1
    assert written > 150


def accelerations(system, states):
    """Accelerations in these states (t, q, v). Every coordinate has a contact named after it, whose gap it is, far away."""
    result = []
    for time, q, v in states:
        at = dict(zip(system.coordinates, q)) | {name + "'": rate for name, rate in zip(system.coordinates, v)}
        run = achilles.simulate(system, set=at, start_time=time, end=time + 1e-3)
        result.append([run.evaluate(f"gap_{name}''", time) for name in system.coordinates])
    return np.array(result)


def compare(system, method, values, seed, count=100):
    """Compares the accelerations with those of SymPy's equations in random states, to 1e-12 of the largest."""
    draw = np.random.default_rng(seed)
    n = len(method.q)
    states = [(draw.uniform(0, 3), draw.uniform(-2, 2, n), draw.uniform(-3, 3, n)) for _ in range(count)]
    equations = [part.subs(values) for part in (method.mass_matrix, method.forcing)]
    evaluate = sp.lambdify([t, *method.q, *method.u], equations, "mpmath")
    with mpmath.workdps(30):
        expected = np.array([[float(a) for a in mpmath.lu_solve(*evaluate(time, *q.tolist(), *v.tolist()))] for time, q, v in states])
    assert accelerations(system, states) == pytest.approx(expected, rel=0, abs=1e-12 * np.abs(expected).max())


def double_pendulum():
    """Two point masses in sympy.physics.mechanics: the frame, the particles, q, and parameters with values."""
    a, b = dynamicsymbols("a b")
    m1, m2, L1, L2 = symbols("m_1 m_2 L_1 L_2", positive=True)
    N = mechanics.ReferenceFrame("N")
    A, B = N.orientnew("A", "Axis", [a, N.z]), N.orientnew("B", "Axis", [a + b, N.z])
    O = mechanics.Point("O")
    O.set_vel(N, 0)
    P = O.locatenew("P", L1 * A.x)
    Q = P.locatenew("Q", L2 * B.x)
    P.v2pt_theory(O, N, A)
    Q.v2pt_theory(P, N, B)
    bodies = [mechanics.Particle("first", P, m1), mechanics.Particle("second", Q, m2)]
    for body, point in zip(bodies, (P, Q)):
        body.potential_energy = -body.mass * g * point.pos_from(O).dot(N.x)
    return N, bodies, [a, b], {m1: 1.3, m2: Rational(7, 10), L1: 1, L2: 0.8, g: 9.81}


def test_a_double_pendulum_has_the_accelerations_of_sympys_lagranges_method():
    N, bodies, q, values = double_pendulum()
    method = mechanics.LagrangesMethod(mechanics.Lagrangian(N, *bodies), q)
    method.form_lagranges_equations()
    system = achilles.System.from_energies(
        q, mechanics.kinetic_energy(N, *bodies), mechanics.potential_energy(*bodies),
        {"a": (q[0] + 100, 0.5), "b": (q[1] + 100, 0.5)}, values)
    assert system.coordinates == ["a", "b"] and system.parameters["m_2"] == 0.7
    compare(system, method, values, seed=1)


def test_forces_damping_and_a_driven_pivot_are_those_of_sympy():
    """A cart that carries a pendulum whose pivot is moved up and down by time, with a drive and dampers."""
    s, a = dynamicsymbols("s a")
    M, L, c, F, h, om = symbols("M L c F h om")
    place = sp.Matrix([s + L * sin(a), h * cos(om * t) - L * cos(a)])
    T = M * s.diff(t) ** 2 / 2 + (m * place.diff(t).T * place.diff(t))[0] / 2
    V = m * g * place[1] + k * s**2 / 2
    values = {m: 0.4, M: 1.5, L: 0.7, c: 0.3, F: 2.0, h: 0.1, om: 5.0, g: 9.81, k: 3}
    N = mechanics.ReferenceFrame("N")
    cart, frame = mechanics.Point("cart"), N.orientnew("frame", "Axis", [a, N.z])
    cart.set_vel(N, s.diff(t) * N.x)
    frame.set_ang_vel(N, a.diff(t) * N.z)
    forces = [(cart, (F * cos(om * t) - c * s.diff(t)) * N.x), (frame, -c * a.diff(t) * N.z)]
    method = mechanics.LagrangesMethod(T - V, [s, a], forcelist=forces, frame=N)
    method.form_lagranges_equations()
    system = achilles.System.from_energies([s, a], T, V, {"s": (s + 100, 0.5), "a": (a + 100, 0.5)}, values,
                                           forces={s: F * cos(om * t)},
                                           dissipation=c / 2 * (s.diff(t) ** 2 + a.diff(t) ** 2))
    compare(system, method, values, seed=2)


def gallery_pendulum(**more):
    """The gallery's double pendulum with a stop."""
    a, b = dynamicsymbols("theta1 theta2")
    m1, m2, L1, L2, e = symbols("m1 m2 L1 L2 e")
    ad, bd = a.diff(t), b.diff(t)
    T = m1 * L1**2 / 6 * ad**2 + m2 / 2 * (L1**2 * ad**2 + L1 * L2 * ad * (ad + bd) * cos(b) + L2**2 / 3 * (ad + bd) ** 2)
    V = -m1 * g * L1 / 2 * cos(a) - m2 * g * (L1 * cos(a) + L2 / 2 * cos(a + b))
    return achilles.System.from_energies([a, b], T, V, (b, e), {m1: 1, m2: 1, L1: 1, L2: 1, g: 1, e: 0.5},
                                         start={a: pi / 6, b: "25 deg"}, units={a: "rad", b: "rad"}, **more)


def test_the_gallerys_double_pendulum_runs_as_in_the_gallery():
    run, known = achilles.simulate(gallery_pendulum(), end=20, tolerance=1e-10), achilles.simulate("double_pendulum")
    assert len(run.events) == len(known.events) == 35 and run.outcome == known.outcome
    for event, other in zip(run.events, known.events):
        # SymPy orders factors in its own way. Today this changes no bit; a rounding error grows to 1e-10 here at most.
        assert event.kind == other.kind and event.t == pytest.approx(other.t, abs=1e-10)
        assert event.q == pytest.approx(other.q, abs=1e-10)
    assert run.end.q == pytest.approx(known.end.q, abs=1e-10) and run.end.v == pytest.approx(known.end.v, abs=1e-10)


def test_symbols_with_rates_give_the_same_file_as_functions():
    a, b, ad, bd = symbols("x y u v")
    plain = made([a, b], (ad**2 + bd**2) / 2, g * b + sin(Symbol("t")) * a, (b, 0.5), rates=[ad, bd], start={a: 1, bd: 2})
    functions = made(V=g * y + sin(t) * x, start={"x": 1, yd: 2})
    u, v = dynamicsymbols("u v")
    speeds = made(T=(u**2 + v**2) / 2, V=g * y + sin(t) * x, rates=[u, v], start={x: 1, v: 2})
    assert plain.text == functions.text == speeds.text
    assert plain.start == {"x": 1, "y": 0, "x'": 0, "y'": 2}


def test_the_file_has_what_is_given():
    e, alpha = symbols("e alpha")
    parameters = {m: Rational(1, 3), "g": np.float64(9.81), e: "1/2", alpha: 2 * m, k: 1e-3, "unused": 7}
    system = achilles.System.from_energies(
        sp.Matrix([x, y]), m * (xd**2 + yd**2) / 2, m * g * y, {"floor": (y, e), "slope": (y - alpha * x + 1, "e/2")}, parameters,
        start={x: Rational(1, 7), y: sqrt(2), "x'": -1}, forces={x: -k * xd}, names={k: "drag"}, dissipation=m * yd**2,
        units={x: "m", "m": "kg"}, title='A "ball"')
    assert system.text == '''title = "A \\"ball\\""

coordinate = [
    {name = "x", start = "1/7", rate = -1.0, force = "-drag*x'", unit = "m"},
    {name = "y", start = "sqrt(2)"},
]

parameter = [
    {name = "m", value = "1/3", unit = "kg"},
    {name = "g", value = 9.81},
    {name = "e", value = "1/2"},
    {name = "alpha", value = "2*m"},
    {name = "drag", value = 0.001},
    {name = "unused", value = 7.0},
]

lagrangian.kinetic = "m*(x'^2 + y'^2)/2"
lagrangian.potential = "g*m*y"
lagrangian.dissipation = "m*y'^2"

constraint = [
    {name = "floor", gap = "y", restitution = "e"},
    {name = "slope", gap = "-alpha*x + y + 1", restitution = "e/2"},
]
'''
    assert system.title == 'A "ball"' and system.parameters["alpha"] == 2 / 3 and system.contacts == ["floor", "slope"]
    assert system.start == {"x": 1 / 7, "y": 2**0.5, "x'": -1, "y'": 0}
    assert made(title="a\x7fb\tc").title == "a\x7fb\tc"
    assert made().title == "Lagrangian system in x, y" and made().contacts == ["contact"] and made().parameters == {"g": 9.81}


f, theta_, lam, tau = Function("f"), Symbol(r"\theta"), Symbol("lambda"), Symbol("tau")


@pytest.mark.parametrize("more, told", [
    ({"V": sp.Abs(x)}, r"^V: Abs\(x\(t\)\) is not smooth, and the equations of motion need derivatives\nsqrt\(x\^2 \+ w\^2\)"),
    ({"V": g * y + k * sp.Max(0, -y) ** 2, "parameters": {g: 1, k: 1}}, r"^V: Max\(0, -y\(t\)\) is not smooth"),
    ({"V": sp.Piecewise((x, x > 0), (0, True))}, r"^V: Piecewise\(.* is not smooth"),
    ({"V": sp.atan2(y, x)}, r"^V: atan2\(y\(t\), x\(t\)\) is unknown in a system file\nthe functions are sqrt, sin, "),
    ({"V": sp.I * x}, r"^V: I is not a real number"),
    ({"V": (-8) ** Rational(1, 3) * x}, r"^V: \(-1\)\*\*\(1/3\) is not a real number"),
    ({"V": sp.oo * y}, r"^V: oo is not a finite number"),
    ({"V": sp.zoo}, "^V: zoo is not a real number"),
    ({"V": x * Float("1e400")}, r"^V: 10+\.\.\. is beyond the range of a double"),
    ({"V": Float("1e-400") * x}, r"^V: 1.0+e-400 is beyond the range of a double"),
    ({"V": x**k, "parameters": {k: 2}}, r"^V: x\(t\)\*\*k cannot be written: the exponent must be a number.*\n.*exp\(n\*log\(x\)\)"),
    ({"V": f(t) * x}, r"^V: f\(t\) is not a coordinate\nthe coordinates are x, y; add it to q, or replace it"),
    ({"V": f(x)}, r"^V: f\(x\(t\)\) is not a coordinate"),
    ({"V": x * y.diff(t, 2)}, r"^V: Derivative\(y\(t\), \(t, 2\)\) is neither a coordinate nor a rate\nenergies,"),
    ({"gaps": {"floor": (sp.floor(y), 0.5)}}, r"^gaps: floor: floor\(y\(t\)\) is not smooth"),
    ({"gaps": (y - k, 0.5)}, r"^parameters: no value is given for k in gaps\nparameters=\{k: ...\}; the coordinates are x, y"),
    ({"V": m * g * y}, "^parameters: no value is given for m in V"),
    ({"parameters": {g: m}}, "^parameters: no value is given for m in parameters: g"),
    ({"V": g * Symbol("y")}, r"^V: the name 'y' is that of two symbols, y\(t\) and y\nuse one symbol everywhere, or name one of"),
    ({"V": Symbol("g", positive=True) * y}, "^V: the name 'g' is that of two symbols, g and g; their assumptions differ"),
    ({"V": cos(Symbol("t", real=True)) * y}, "^V: the name 't' is that of two symbols, t and t; their assumptions differ"),
    ({"parameters": {theta_: 1}}, r"^parameters: '\\theta' is not a name: .*\nchoose another name .* names=\{symbol: 'theta'\}"),
    ({"parameters": {Symbol("θ_1"): 1}}, r"'theta_1'"),
    ({"parameters": {Symbol("2"): 1}}, r"'x'"),
    ({"V": lam * y}, r"^V: the name 'lambda' is reserved\nchoose another name .* names=\{symbol: 'lambda_'\}"),
    ({"parameters": {"t": 1}}, "^parameters: the name 't' is reserved"),
    ({"parameters": {"x": 1}}, "^parameters: the name 'x' is used twice"),
    ({"parameters": {g: 1, "g": 2}}, "^parameters: the name 'g' is used twice"),
    ({"parameters": {g: float("nan")}}, "^parameters: g: nan is not a finite number"),
    ({"q": []}, "^q: a system needs at least one coordinate"),
    ({"q": [x, x]}, r"^q: x\(t\) is given twice"),
    ({"q": [x, 2 * y]}, r"^q: 2\*y\(t\) is neither a symbol x nor a function x\(t\)\nsympy.physics.mechanics.dynamicsymbols"),
    ({"q": [x, f(tau)]}, "^q: the functions depend on different symbols, t and tau"),
    ({"q": [x, k]}, r"^q: k is a symbol, so its rate needs a symbol, too\ngive rates=\[...\], or make it a function of time"),
    ({"rates": [xd]}, "^rates: there are 1 for 2 coordinates"),
    ({"rates": [m, m]}, "^rates: m is given twice"),
    ({"rates": [yd, xd]}, r"^rates: Derivative\(y\(t\), t\) is neither a symbol x nor a function x\(t\)"),
    ({"rates": [x.diff(t, 2), yd]}, r"^rates: Derivative\(x\(t\), \(t, 2\)\) is neither a symbol x nor"),
    ({"V": Function("sin")(x)}, r"^V: sin\(x\(t\)\) is not a coordinate"),
    ({"parameters": {g: 10**400}}, r"^parameters: g: 10+\.\.\. is not a finite number"),
    ({"parameters": {g: sp.Integer(10) ** 400}}, r"^parameters: g: 10+\.\.\. is not a finite number"),
    ({"start": {"z": 1}}, "^start: z is not one of x, y, x', y'"),
    ({"start": {"xdot": 1}}, "rates are written x'"),
    ({"start": {x: 1, "x": 2}}, "^start: x is given twice"),
    ({"forces": {xd: 1}}, r"^forces: Derivative\(x\(t\), t\) is not one of x, y"),
    ({"units": {k: "m"}}, "^units: k is not one of x, y, g"),
    ({"gaps": {}}, "^gaps: a system needs at least one gap"),
    # What is found when the file is read has a place in it.
    ({"T": xd**2 / 2 + yd}, r"^<text>:\d+:\d+: .*[^$]\n    lagrangian.kinetic"),
    ({"gaps": (g, 0.5)}, r"^<text>:\d+:\d+: "),
    ({"start": {x: g}}, r"^<text>:\d+:\d+: .*'g'.*pi is the only name allowed"),
    ({"V": "g*yy"}, r"^<text>:\d+:\d+: unknown name 'yy'"),
])
def test_what_is_wrong(more, told):
    with pytest.raises(achilles.InputError, match=told):
        made(**more)


@pytest.mark.parametrize("more, told", [
    ({"q": "x y"}, r"^q: a list such as \[theta1, theta2\] is expected, not str \('x y'\)"),
    ({"q": x}, "^q: a list such as"),
    ({"T": None}, "^T: a SymPy expression is expected, not None"),
    ({"T": sp.Matrix([xd**2])}, r"^T: a SymPy expression is expected, not .*Matrix.*: take its element \[0\]"),
    ({"gaps": (y >= 0, 0.5)}, "^gaps: a SymPy expression is expected, not "),
    ({"V": mechanics.ReferenceFrame("N").x}, "^V: a SymPy expression is expected, not Vector"),
    ({"gaps": y}, r"^gaps: one pair or a dict: a gap and its restitution are expected, such as \{'knee': \(theta2, 0.5\)\}"),
    ({"gaps": {"floor": y}}, "^gaps: floor: a gap and its restitution are expected"),
    ({"gaps": {"floor": (y, [0.5])}}, "^gaps: floor: a number or a text such as 'pi/6' is expected, not list"),
    ({"gaps": {y: (y, 0.5)}}, "^gaps: the name of a contact must be a text"),
    ({"gaps": (y, None)}, "^gaps: a number or a text such as 'pi/6' is expected, not None"),
    ({"parameters": [1]}, "^parameters: a dict such as {m: 1.0} is expected, not list"),
    ({"parameters": {1: 1}}, "^parameters: a symbol or its name is expected, not int"),
    ({"parameters": {g: True}}, "^parameters: g: a number or a text"),
    ({"names": {g: 1}}, "^names: the name of g must be a text, not int"),
    ({"title": 1}, "^title: a text is expected, not int"),
    ({"units": {x: 1}}, "^units: x: a text is expected, not int"),
])
def test_what_is_of_a_wrong_kind(more, told):
    with pytest.raises(TypeError, match=told):
        made(**more)


def test_an_expression_may_be_nested_too_deeply():
    expression = x
    for _ in range(5000):
        expression = sp.Pow(expression, 3, evaluate=False)
    with pytest.raises(achilles.InputError, match="nested"):
        made(V=expression)


def test_without_sympy_the_rest_works():
    code = """
import sys
sys.modules["sympy"] = None
import achilles
achilles.simulate("ball_on_floor", end=1)
try:
    achilles.System.from_energies([], 0, 0, (0, 0))
except ImportError as problem:
    print(problem)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "System.from_energies needs SymPy: install python3-sympy, or run pip install sympy\n"
