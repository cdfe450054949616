"""What type checkers and editors know about the module: mypy reads the stub."""

import inspect
import pathlib
import shutil
import subprocess

import pytest

import achilles

MYPY = shutil.which("mypy")
PACKAGE = pathlib.Path(achilles.__file__).parent
HEAD = "import numpy as np\n\nimport achilles\n\n"


@pytest.fixture(scope="module")
def mypy(tmp_path_factory):
    """Checks a program strictly and returns its complaints."""
    if MYPY is None:
        pytest.skip("mypy is not installed")
    folder = tmp_path_factory.mktemp("mypy")

    def check(text):
        (folder / "program.py").write_text(HEAD + text)
        done = subprocess.run([MYPY, "--strict", "--cache-dir", folder / "cache", folder / "program.py"], capture_output=True,
                              text=True, env={"MYPYPATH": str(PACKAGE.parent), "PATH": "/usr/bin:/bin"})
        return [line for line in done.stdout.splitlines() if "error:" in line]

    return check


def options():
    """An argument for every option of the program's table."""
    given = {}
    for row in achilles._core.option_table():
        name = row["flag"][2:].replace("-", "_")
        given[name] = repr(row["words"][0]) if row["words"] else "100000" if isinstance(row["default"], int) else "1e-9"
    assert len(given) > 15
    return ", ".join(f"{name}={value}" for name, value in given.items())


PROGRAM = f"""
run = achilles.simulate("ball_on_sine", values={{"e": 0.3, "x'": "1.5"}}, {options()})
other = achilles.simulate("ball_on_sine", set={{"e": 0.3}}, eps_t=1e-8)
sweep = achilles.sweep("ball_on_sine", over={{"e": (0, 0.95, 200)}}, quantities=["zeno_time(1)", "held"], at="zeno", after=1.0,
                       random=None, seed=None, threads=2, progress=lambda done, count: None, values={{"m": 2}}, {options()})
again = achilles.sweep(run.system, "e=0:0.95:20", print="impacts", set={{"m": 2}}, random=3, seed=4)
orbit = achilles.orbit("ball_down_a_wave", begin=run, period="2*pi", shift={{"x": "2*pi"}}, branch={{"e": (0.1, 0.9)}},
                       values={{"b": 0.05}}, {options()})
found = achilles.orbit(run.system, from_="end", continue_="e=0.1:0.9", set={{"b": 0.05}})
figure = run.figure("height", "path", size=(800, 600), scale=1.5, width_mm=85, height_mm=60, font_pt=8, dpi=300, columns=2,
                    dark=True, transparent=True)
figure.save("ball.pdf", format="pdf")
orbit.figure("path", size=(800, 600), scale=1, width_mm=85.0, height_mm=60.0, font_pt=8.0, dpi=300.0, dark=False, transparent=False)
page: str = run.html("run.html", views=["height"])
latest: float = np.max(run.t)
q, v = run([1.0, 2.0])
number: float = run.certificates[0].zeno_time[0]
table, events, rows = run.to_dataframe(np.linspace(0, 1, 5)), run.events_to_dataframe(), sweep.to_dataframe()
text: str = run.to_csv(plain_names=True, units=True) + run.to_json() + run.events[0].kind
system = achilles.System.from_energies(["x"], T=1, V=2, gaps={{"wall": (3, 0.5)}}, parameters={{"m": 1}}, rates=["v"], start={{}},
                                       forces=None, dissipation=None, units={{}}, names={{}}, title="one")
system.to_toml("one.toml", expand=True)
"""


def test_every_option_is_accepted(mypy):
    assert mypy(PROGRAM) == []


@pytest.mark.parametrize("call, told", [
    ('achilles.simulate("ball_on_sine", tolerence=1e-9)', 'Unexpected keyword argument "tolerence" for "simulate"; did you mean "tolerance"?'),
    ('achilles.sweep("ball_on_sine", "e=0:1:3", "impacts", thread=2)', 'Unexpected keyword argument "thread" for "sweep"'),
    ('achilles.orbit("ball_on_sine", perod=1)', 'Unexpected keyword argument "perod" for "orbit"'),
    ('achilles.simulate("ball_on_sine").figure(widht_mm=85)', 'Unexpected keyword argument "widht_mm" for "figure" of "Run"'),
    ('achilles.simulate("ball_on_sine").html(paht="run.html")', 'Unexpected keyword argument "paht" for "html" of "Run"'),
    ('achilles.simulate("ball_on_sine", method="tailor")', 'has incompatible type "Literal[\'tailor\']"'),
    ('achilles.simulate("ball_on_sine", max_impacts=1.5)', 'has incompatible type "float"'),
])
def test_a_wrong_option_is_refused(mypy, call, told):
    complaints = mypy(call)
    assert len(complaints) == 1 and told in complaints[0], complaints


def test_completion_shows_each_option_and_its_help():
    """An editor reads the same from the stub as help() does from the module."""
    stub = (PACKAGE / "__init__.pyi").read_text()
    for name in ("simulate", "sweep", "orbit"):
        text = stub[stub.index(f"def {name}("):]
        head, rest = text[: text.index("->")], text[: text.index("...\n")]
        assert "**" not in head and "method: Literal['dopri5', 'taylor'] | None=None" in head
        for option in inspect.signature(getattr(achilles, name)).parameters.values():
            assert option.kind is option.VAR_KEYWORD or f"{option.name}:" in head, option.name
        assert "max_impacts: " in rest and "Options, where they differ from those of the file" in rest


PLAIN = [
    (achilles.simulate, ("ball_on_sine",), "values", "set", {"e": 0.3}),
    (achilles.sweep, ("ball_on_sine", "e=0:0.5:3", "impacts"), "values", "set", {"m": 2.0}),
    (achilles.sweep, ("ball_on_sine", "e=0:0.5:3"), "quantities", "print", "impacts"),
    (achilles.orbit, ("ball_down_a_wave",), "begin", "from_", {"q": [0.86, 0.38], "v": [1.64, 0.53]}),
    (achilles.orbit, ("ball_down_a_wave",), "branch", "continue_", {"e": (0.49, 0.51)}),
]


@pytest.mark.parametrize("function, first, plain, other, value", PLAIN)
def test_plain_names_are_the_same_arguments(function, first, plain, other, value):
    def told(made):
        return made.to_json() if hasattr(made, "to_json") else made.command + repr({name: made[name].tolist() for name in made})

    assert told(function(*first, **{plain: value})) == told(function(*first, **{other: value}))
    with pytest.raises(TypeError, match=f"^{plain} and {other} are two names of the same argument: give only one of them$"):
        function(*first, **{plain: value, other: value})


def test_messages_use_the_name_that_was_given():
    with pytest.raises(TypeError, match="^begin: "):
        achilles.orbit("ball_down_a_wave", begin=3)
    with pytest.raises(TypeError, match="^branch: "):
        achilles.orbit("ball_down_a_wave", branch=3)
    with pytest.raises(TypeError, match="^values: "):
        achilles.simulate("ball_on_sine", values=3)
    with pytest.raises(TypeError, match="^e is given twice: as an argument and in values"):
        achilles.simulate("ball_on_sine", e=0.3, values={"e": 0.3})
    with pytest.raises(TypeError, match="^quantities: a text such as"):
        achilles.sweep("ball_on_sine", "e=0:1:3", quantities=3)
    with pytest.raises(TypeError, match='^quantities is missing: say what to tabulate, such as quantities="zeno_time'):
        achilles.sweep("ball_on_sine", "e=0:1:3")
