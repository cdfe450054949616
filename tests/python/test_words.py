"""Systems, errors, the stub, the examples of README and the manual, the installed module."""

import ast
import inspect
import os
import pathlib
import pickle
import re
import subprocess
import sys

import numpy as np
import pytest

import achilles


def test_systems(source):
    ball = achilles.System("ball_on_sine")
    file = source / "assets/systems/ball_on_sine.toml"
    for same in (achilles.System.from_file(file), achilles.System(file.read_text()), pickle.loads(pickle.dumps(ball))):
        assert same.text == ball.text and same.title == ball.title
        assert achilles.simulate(same, end=3).to_json() == achilles.simulate("ball_on_sine", end=3).to_json()
    assert achilles.simulate(file, end=3).to_json() == achilles.simulate(str(file), end=3).to_json()
    assert ball.coordinates == ["x", "y"] and ball.parameters["e"] == 0.5 and ball.start["x'"] == 1.5
    assert ball.units["x'"] == "m/s" and "height" in ball.views and ball.contacts == ["contact"]
    assert ball.options["end_time"] == 20.0 and ball.options["method"] == "taylor"
    assert achilles.gallery()["ball_on_sine"] == ball.title


def bytes_of(system):
    return achilles.simulate(system, end=1.5).to_json()


@pytest.mark.filterwarnings("ignore::achilles.AchillesWarning")
def test_the_file_of_a_system_gives_the_same_bytes(source, tmp_path, program):
    files = sorted([*source.glob("assets/systems/*.toml"), *source.glob("tests/reference/mechanisms/*.toml")])
    assert len(files) > 35
    for file in files:
        system = achilles.System.from_file(file)
        assert system.to_toml() == file.read_text() and system.to_toml(expand=True) == program("check", str(file), "--expand")
        expected = bytes_of(system)
        for expand in (False, True):
            assert (text := system.to_toml(tmp_path / "other.toml", expand=expand)) == (tmp_path / "other.toml").read_text()
            other = achilles.System.from_file(tmp_path / "other.toml")
            assert bytes_of(other) == expected, file
            assert not (expand and re.search(r"(?m)^(body *=|\[\[body)", text)), file


@pytest.mark.parametrize("head", ["", "# A ball.\n", "\ufeff", "extra = {title = 3}\n"])
def test_a_file_without_a_title_is_written_with_it(tmp_path, head):
    text = achilles.System("ball_on_floor").text
    (tmp_path / "my ball.toml").write_text(head + text.replace("title =", "# title ="), encoding="utf-8")
    ball = achilles.System.from_file(tmp_path / "my ball.toml")
    assert ball.title == "my ball" and ball.to_toml().startswith('title = "my ball"\n') and ball.to_toml().endswith(text[-200:])
    for other in (achilles.System(ball.to_toml()), achilles.System(ball.to_toml(expand=True)), achilles.System(ball.to_toml(), "x.toml")):
        assert other.title == "my ball" and bytes_of(other) == bytes_of(ball)


def test_control_characters_of_a_title_are_escaped():
    text = achilles.System("ball_on_floor").text
    ball = achilles.System(text.replace('title = "', r'title = "\u007f\u0001\t\"\\'))
    assert ball.title.startswith('\x7f\x01\t"\\') and achilles.System(ball.to_toml(expand=True)).title == ball.title


def test_a_system_made_of_bodies(source, program):
    file = source / "tests/reference/mechanisms/kneed_leg.toml"
    leg = achilles.System.from_file(file)
    assert leg.coordinates == ["z", "theta", "kappa"] and leg.contacts == ["knee", "foot"] and leg.units["kappa'"] == "rad/s"
    assert leg.parameters["weight"] == pytest.approx(31 * 9.81) and leg.title == "Kneed leg with foot strike, by bodies"
    run = achilles.simulate(leg, end=1)
    assert run.to_json() == achilles.simulate(achilles.System(file.read_text()), end=1).to_json()
    assert run.to_json() == program("simulate", str(file), "--end", "1", "--json", "-")
    assert str(run) == program("simulate", str(file), "--end", "1") and "Kneed leg" in str(run)
    assert {event.contact for event in run.events} >= {"foot"} and run.figure(*leg.views[:1]).svg.startswith("<?xml")
    words = [words for words, _ in leg.equations]
    assert words.count("Contact knee: gap") == words.count("Contact foot: contact force while held") == 1
    assert "mass matrix" in words and bytes_of(pickle.loads(pickle.dumps(leg))) == bytes_of(leg)
    lines = file.read_text().replace('at = "hip"', 'at = "hib"').splitlines()
    with pytest.raises(achilles.InputError, match="'hib'.*did you mean.*'hip'") as problem:
        achilles.System("\n".join(lines))
    assert "hib" in lines[problem.value.line - 1] and "^" in problem.value.caret


def test_equations_are_latex():
    latex = achilles.System("double_pendulum")._repr_latex_()
    assert latex.startswith("$$") and latex.endswith("$$") and "\\text{mass matrix}" in latex
    assert "&M = \\begin{pmatrix}" in latex and "\\ddot{h}" in latex
    for left, right in (("{", "}"), ("\\begin{", "\\end{")):
        assert latex.count(left) == latex.count(right)


def test_values_are_read_as_the_command_line_reads_them():
    run = achilles.simulate("double_pendulum", set={"theta1": "30 deg", "theta2": "pi/12"}, e=np.float64(0.25), end=np.int64(2))
    assert run.start.q.tolist() == [np.pi / 6, np.pi / 12] and run.parameters["e"] == 0.25 and run.end.t == 2
    assert achilles.simulate("ball_on_sine", e=1 / 3).parameters["e"] == 1 / 3
    assert achilles.simulate("ball_on_sine", end_time=2).end.t == achilles.simulate("ball_on_sine", end=2).end.t == 2


def test_a_value_that_is_called_like_an_option_goes_into_set():
    text = achilles.System("ball_on_floor").text.replace('"g"', '"memory"').replace("*g", "*memory")
    ball = achilles.System(text)
    with pytest.warns(achilles.AchillesWarning, match="memory is taken as the option; the value .* goes into values"):
        assert achilles.simulate(ball, memory=1e8).options.memory == 1e8
    assert achilles.simulate(ball, set={"memory": 8.0}).parameters["memory"] == 8.0


WRONG = """title = "Ball"
[[coordinate]]
name = "y"
start = 1.0
rate = 0.0
[lagrangian]
kinetic = "m/2*y'^2"
potential = "g*yy"
[[parameter]]
name = "m"
value = 1.0
[[constraint]]
gap = "y +"
restitution = 0.5
"""


def test_mistakes_of_a_file_are_told_with_their_places(tmp_path, program):
    path = tmp_path / "wrong.toml"
    path.write_text(WRONG)
    with pytest.raises(achilles.InputError) as problem:
        achilles.simulate(path)
    error = problem.value
    assert program("simulate", str(path), status=2).rstrip("\n").removeprefix("achilles: ") == str(error)
    assert isinstance(error, ValueError) and error.file == str(path) and error.line == 8 and error.column == 14
    assert error.caret == '    potential = "g*yy"\n                 ^' and "'g'" in error.message
    assert len(error.mistakes) >= 2 and error.mistakes[0] is error and error.mistakes[-1].line == 13
    with pytest.raises(achilles.InputError, match="^<text>:8:14: "):
        achilles.System(WRONG)
    path.write_bytes('title = "Fall"\nsource = "Kn\u00f6del, '.encode() + b'Kn\xf6del"\n')
    with pytest.raises(achilles.InputError, match="wrong.toml:2:21: this character is not UTF-8") as problem:
        achilles.System.from_file(path)
    assert problem.value.caret.endswith("\n" + 24 * " " + "^") and problem.value.hint == "save the file as UTF-8"
    path.write_text("#" + "\u00f6" * 3_000_000, encoding="utf-8")  # read in blocks: the last character is cut
    with pytest.raises(achilles.InputError, match="the file is larger than 4 MB"):
        achilles.System.from_file(path)
    with pytest.raises(achilles.InputError, match="no.such.toml"):
        achilles.System.from_file("no/such.toml")


@pytest.mark.parametrize("words, told", [
    ({"ee": 0.3}, "there is no value or option 'ee'"),
    ({"tolerence": 1e-9}, "there is no value or option 'tolerence'; did you mean 'tolerance'"),
    ({"set": {"xdot": 1}}, "rates are written x'"),
    ({"e": 2}, "^e=2: "),
    ({"e": float("nan")}, "^e=nan: "),
    ({"e": "1/0"}, "^e=1/0: "),
    ({"method": "tailor"}, "there is no such choice; did you mean 'taylor'"),
    ({"end": -1}, "^end"),
    ({"max_steps": 1.5}, "max_steps 1.5: a whole number is expected"),
    ({"set": {"y": -3}}, "^y=-3: "),
])
def test_what_is_wrong(words, told):
    with pytest.raises(achilles.InputError, match=told) as problem:
        achilles.simulate("ball_on_sine", **words)
    assert "--" not in str(problem.value)


@pytest.mark.parametrize("words, told", [
    ({"e": [0.3]}, "e: a number or a text such as 'pi/6' is expected, not list"),
    ({"e": None}, "e: a number or a text"),
    ({"e": True}, "e: a number or a text"),
    ({"e": 1j}, "e: a number or a text"),
    ({"set": ["e=0.3"]}, "set: a dict such as"),
    ({"e": 0.3, "set": {"e": 0.4}}, "e is given twice"),
    ({"end": 3, "end_time": 4}, "end_time is given twice"),
])
def test_what_is_of_a_wrong_kind(words, told):
    with pytest.raises(TypeError, match=told):
        achilles.simulate("ball_on_sine", **words)


def test_a_system_that_there_is_not():
    with pytest.raises(achilles.InputError, match="no system 'ball_on_sin'; did you mean 'ball_on_sine'"):
        achilles.simulate("ball_on_sin")
    for wrong in (3, None, b"ball_on_sine", "title = 'text'\n"):
        with pytest.raises(TypeError, match="a System, a path or a name of the gallery is expected"):
            achilles.simulate(wrong)


def members_of(stub):
    return {node.name: node for node in stub.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}


def test_the_stub_says_what_the_module_says():
    stub = members_of(ast.parse(pathlib.Path(achilles.__file__).with_name("__init__.pyi").read_text()))
    assert sorted(stub) == sorted(achilles.__all__)
    for name, node in stub.items():
        live = getattr(achilles, name)
        assert inspect.isclass(live) == isinstance(node, ast.ClassDef)
        if not inspect.isclass(live):
            check_signature(node, live)
            continue
        functions = [part for part in node.body if isinstance(part, ast.FunctionDef)]
        for function in functions:
            attribute = inspect.getattr_static(live, function.name)
            if not function.decorator_list:
                check_signature(function, attribute)
        public = {key for key in vars(live) if not key.startswith("_")} - set(getattr(live, "_fields", ()))
        assert public == {function.name for function in functions if not function.name.startswith("_")}, name


def check_signature(node, live):
    words = inspect.signature(live).parameters
    arguments = node.args
    named = [*arguments.args, *([arguments.vararg] if arguments.vararg else []), *arguments.kwonlyargs]
    named += [arguments.kwarg] if arguments.kwarg else []
    # Any other name is a value of the system, which a type checker does not know.
    assert [each.arg for each in named] == [name for name, each in words.items() if each.kind is not each.VAR_KEYWORD], node.name
    for each in named[1:] if named and named[0].arg in ("self", "cls") else named:
        assert each.annotation is not None, f"{node.name}: {each.arg}"
        annotation = words[each.arg].annotation.replace("np.ndarray", "Array")
        assert ast.unparse(ast.parse(annotation)) == ast.unparse(each.annotation)
    defaults = [ast.literal_eval(d) for d in [*arguments.defaults, *arguments.kw_defaults] if d is not None]
    assert defaults == [word.default for word in words.values() if word.default is not word.empty], node.name


def test_everything_public_is_explained():
    for name in achilles.__all__:
        live = getattr(achilles, name)
        assert live.__doc__, name
        for key, member in vars(live).items() if inspect.isclass(live) else ():
            if not key.startswith("_") and (callable(member) or isinstance(member, property)):
                assert member.__doc__, f"{name}.{key}"


def test_every_option_of_the_table_is_an_argument(program):
    for function in (achilles.simulate, achilles.sweep, achilles.orbit):
        names = inspect.signature(function).parameters
        text = program("simulate", "--help")
        flags = {word.strip(",") for word in text.split() if word.startswith("--eps") or word in ("--end", "--method", "--memory")}
        assert len(flags) >= 7 and {flag[2:].replace("-", "_") for flag in flags} <= set(names)
        assert "tolerance: local error per step" in function.__doc__


def python_of(text, begin="import achilles"):
    """Returns the first indented block of a page that begins with this line."""
    lines = text[text.index(f"    {begin}\n"):].splitlines()
    code = []
    for line in lines:
        if line and not line.startswith("    "):
            break
        code.append(line[4:])
    return "\n".join(code)


@pytest.mark.parametrize("page", ["README.md", "assets/manual/python.md"])
def test_the_example_of_a_page_runs(source, tmp_path, monkeypatch, page):
    monkeypatch.chdir(tmp_path)
    text = python_of((source / page).read_text())
    names = {}
    exec(text, names)
    assert len(text.splitlines()) >= 6 and names["curve"]["zeno_time(2)"].shape == (200,)
    assert (tmp_path / "ball.pdf").exists() == ("ball.pdf" in text)
    assert page == "README.md" or "ball.pdf" in text


def test_the_examples_with_sympy_run(source, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    page = (source / "assets/manual/python.md").read_text()
    names = {"achilles": achilles}
    for begin in ("import sympy as sp", 'more = achilles.System(pendulum.to_toml() + """'):
        exec(python_of(page, begin), names)
    pendulum, more = names["pendulum"], names["more"]
    assert "contact begins" in capsys.readouterr().out and pendulum.coordinates == ["theta"] and pendulum.contacts == ["wall"]
    assert (tmp_path / "pendulum.toml").read_text() == pendulum.text and more.views == ["wall"]
    assert achilles.simulate(more).to_json() == achilles.simulate(pendulum).to_json()


@pytest.mark.parametrize("example, told", [
    ("figure4", "Zeno points at 2.725142, 12.465775 s"), ("energy", "zeno_low"), ("map", "of 3600 runs have a Zeno point"),
    ("branch", "period doubling (multiplier -1)")])
def test_an_example_draws_its_picture(source, tmp_path, example, told):
    assert {file.stem for file in (source / "app/python/examples").glob("*.py")} == {"figure4", "energy", "map", "branch"}
    picture = tmp_path / f"{example}.png"
    done = subprocess.run([sys.executable, source / f"app/python/examples/{example}.py", picture], capture_output=True, text=True,
                          env=os.environ | {"MPLBACKEND": "Agg"})
    assert done.returncode == 0 and not done.stderr, done.stderr
    assert told in done.stdout and picture.stat().st_size > 20000


def test_it_is_found_where_it_is_installed(tmp_path):
    build = pathlib.Path(os.environ["ACHILLES_PROGRAM"]).parent
    for component in ("python", "Unspecified"):
        subprocess.run(["cmake", "--install", build, "--prefix", tmp_path, "--component", component], check=True,
                       stdout=subprocess.DEVNULL)
    (package,) = tmp_path.glob("lib/python3*/*-packages/achilles")
    assert (package / "py.typed").exists() and (package / "__init__.pyi").exists()
    code = "import achilles; print(achilles.__file__, achilles.simulate('ball_on_floor').figure().svg[:5])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd="/",
                          env={"PYTHONPATH": str(package.parent)})
    assert done.stdout.split() == [str(package / "__init__.py"), "<?xml"], done.stderr


@pytest.mark.parametrize("kind", ["System", "Run", "Orbit"])
def test_an_object_without_a_value_cannot_be_made(kind):
    """Objects cannot be made by __new__, which would leave their memory uninitialized."""
    program = f"""
import copy, achilles
kind = getattr(achilles._core, {kind!r})
class Child(kind): pass
made = {{"System": lambda: achilles.System("ball_on_sine")._core, "Run": lambda: achilles.simulate("ball_on_sine", end=1)._core,
        "Orbit": lambda: achilles.orbit("ball_down_a_wave")._core}}[{kind!r}]()
ways = [kind, lambda: kind.__new__(kind), lambda: object.__new__(kind), lambda: kind.__base__.__new__(kind), Child,
        lambda: Child.__new__(Child), lambda: copy.copy(made), lambda: copy.deepcopy(made)]
for way in ways:
    try:
        broken = way()
    except TypeError:
        continue
    [getattr(broken, name) for name in dir(broken)]
    raise SystemExit("an object without a value was made")
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, (done.returncode, done.stderr)
