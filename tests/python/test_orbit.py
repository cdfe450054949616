"""Periodic orbits in Python."""

import json
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import achilles

WAVE = "ball_down_a_wave"


@pytest.fixture(scope="module")
def wave():
    return achilles.orbit(WAVE)


@pytest.fixture(scope="module")
def branch():
    return achilles.orbit(WAVE, e=0.3, continue_={"b": (0.05, 0.08)}).branch


def pairs(multipliers):
    return np.stack([multipliers.real, multipliers.imag], axis=-1).tolist()


def test_it_says_what_the_program_says(program):
    found = achilles.orbit(WAVE, e=0.3, continue_={"b": (0.05, 0.08)}, tolerance=1e-13)
    words = ["orbit", WAVE, "--continue", "b=0.05:0.08", "--set", "e=0.3", "--tolerance", "1e-13"]
    assert found.command == " ".join(["achilles", *words])
    text = program(*words, "--json", "-")
    assert found.to_json() == text and str(found) == program(*words)
    told = json.loads(text)
    for name in ("period", "zero_multipliers", "shift", "stable", "margins", "psi", "section", "newton", "options"):
        assert getattr(found, name) == told[name], name
    assert found.parameters == told["system"]["parameters"] and found.parameters["e"] == 0.3
    assert found.options.tolerance == 1e-13 and found.options.eps_q == 1e-11
    assert found.state.q.tolist() == told["state"]["q"] and found.state.v.tolist() == told["state"]["v"]
    assert pairs(found.multipliers) == told["multipliers"] and found.multipliers.dtype == complex
    assert [event.t for event in found.events] == [event["t"] for event in told["events"]]
    assert found.derivatives["b"].q.tolist() == told["derivatives"]["b"]["q"]
    branch, points = found.branch, told["branch"]["points"]
    assert branch.parameter == "b" and branch.ends == told["branch"]["ends"] and len(branch.points) == len(points) > 5
    for name in ("value", "period", "stable", "psi"):
        assert getattr(branch, name).tolist() == [point[name] for point in points], name
    for name in ("t", "q", "v"):
        assert getattr(branch, name).tolist() == [point["state"][name] for point in points], name
    assert branch.a_inf.tolist() == [point["margins"]["a_inf"] for point in points]
    assert pairs(branch.multipliers) == [point["multipliers"] for point in points]
    assert branch.q.shape == branch.v.shape == (len(points), 2) and branch.multipliers.shape == (len(points), 4)
    for name in ("folds", "flips", "circles", "lost", "changes"):
        assert [point.value for point in getattr(branch, name)] == [point["value"] for point in told["branch"][name]], name


# theory-derivatives.md 11.
def test_the_numbers_are_those_of_theory(wave):
    assert wave.period == pytest.approx(3.544294646668781307, rel=1e-12)
    assert wave.state.q[0] == pytest.approx(0.8593599338715185793874, rel=1e-12)
    assert wave.multipliers[0] == 1 and wave.multipliers[1] == pytest.approx(-0.7014332700695572695, rel=1e-10)
    assert wave.multipliers[2:].tolist() == [0, 0] and wave.zero_multipliers == 2 and wave.stable
    assert wave.section == "release" and wave.margins.a_inf == pytest.approx(2.873801974252921, rel=1e-9)
    assert wave.derivatives["b"].q[0] == pytest.approx(-1.62553706857792739, rel=1e-9)
    assert wave.derivatives["e"].period == pytest.approx(-0.00642568784374441, rel=1e-9)
    (zeno,) = [event for event in wave.events if event.kind == "zeno"]
    assert isinstance(zeno, achilles.Event) and zeno.t - wave.state.t == pytest.approx(2.436860155357754023, rel=1e-11)
    assert wave.branch is None
    assert repr(wave) == "<achilles.Orbit of ball_down_a_wave: period 3.544294647 s, stable>"


def test_a_flip_is_found_on_a_branch(branch):
    (flip,) = branch.flips
    assert flip.value == pytest.approx(0.06669076049860875, rel=1e-11) and -1 in flip.multipliers.round(9)
    assert flip.period == pytest.approx(3.50627824305801994, rel=1e-11)
    assert isinstance(flip, achilles.OrbitPoint) and set(flip) == set(achilles.OrbitPoint.__annotations__)
    assert (branch.stable == (branch.value < flip.value)).all()
    assert branch.value[[0, -1]] == pytest.approx([0.05, 0.08]) and branch.folds == branch.lost == []
    assert repr(branch) == f"<achilles.Branch in b, 0.05 to 0.08: {len(branch.points)} points>"


def test_a_branch_ends_where_its_zeno_point_is_lost():
    found = achilles.orbit(WAVE, continue_="e=0.4:0.9")
    (lost,) = found.branch.lost
    assert lost.value == pytest.approx(0.6632133961, abs=1e-8) and "Zeno point" in " ".join(found.branch.ends)
    assert found.branch.value.max() <= lost.value
    # psi is linear near the loss of the Zeno point.
    near = found.branch.psi[found.branch.value > 0.6]
    assert len(near) > 3 and (np.diff(near) < 0).all() and near[-1] < 0.05 * found.branch.psi.max()


def test_it_begins_where_it_is_told(wave, branch, tmp_path, program):
    file = tmp_path / "orbit.json"
    file.write_text(wave.to_json())
    near = {"e": 0.51, "b": 0.051}
    by_file = achilles.orbit(WAVE, from_=file, **near)
    assert by_file.to_json() == program("orbit", WAVE, "--from", str(file), "--set", "e=0.51", "--set", "b=0.051", "--json", "-")
    for from_ in (wave, str(file), wave.state | {"period": wave.period}, {"state": wave.state, "period": wave.period}):
        assert achilles.orbit(WAVE, from_=from_, **near).to_json() == by_file.to_json()
    flip = branch.flips[0]
    at_flip = achilles.orbit(WAVE, e=0.3, b=flip.value, from_=flip)
    assert at_flip.period == pytest.approx(flip.period, rel=1e-12)
    run = achilles.simulate(WAVE, end=3 * wave.period)
    assert achilles.orbit(WAVE, from_=run).period == pytest.approx(wave.period, rel=1e-12)
    assert achilles.orbit(WAVE, from_="start").period == pytest.approx(wave.period, rel=1e-12)


def test_of_a_drive(program):
    found = achilles.orbit("ball_on_table", period="2*pi/om", from_="end")
    assert found.to_json() == program("orbit", "ball_on_table", "--from", "end", "--period", "2*pi/om", "--json", "-")
    assert found.section == "time" and len(found.multipliers) == 2 * len(found.system.coordinates)
    with pytest.raises(achilles.InputError, match="the period of the drive must be given"):
        achilles.orbit("ball_on_table")


def test_a_shift_is_said_in_three_ways(wave):
    text = wave.system.text.replace(', shift = ["2*pi", 0]', "")
    plain = achilles.System(text)
    for shift in ({"x": "2*pi", "y": 0}, "x=2*pi", ["x=2*pi", "y=0"]):
        other = achilles.orbit(plain, from_=wave, shift=shift)
        assert other.period == pytest.approx(wave.period, rel=1e-12)
        assert "--shift 'x=2*pi'" in other.command


def test_it_is_a_run(wave):
    run = wave.run
    assert isinstance(run, achilles.Run)
    assert [(event.kind, event.t) for event in run.events] == [(event.kind, event.t) for event in wave.events]
    assert run.end.t - run.start.t == pytest.approx(wave.period, abs=1e-13)
    assert run.end.q - run.start.q == pytest.approx([2 * np.pi, 0], abs=1e-11)
    assert run.q.shape[1] == 2 and run["y - A*sin(x)"].min() > -1e-9


def test_it_is_found_again_by_pickle(wave):
    again = pickle.loads(pickle.dumps(achilles.orbit(WAVE, from_=wave, e=0.45, continue_="b=0.045:0.055")))
    assert again.to_json() == achilles.orbit(WAVE, from_=wave, e=0.45, continue_="b=0.045:0.055").to_json()


def test_figures_are_made_again(wave, program, tmp_path):
    words = ["orbit", WAVE, "--continue", "b=0.05:0.08", "--set", "e=0.3", "--view", "path", "--size", "600x400", "--scale", "0.7",
             "--dark"]
    found = achilles.orbit(WAVE, e=0.3, continue_={"b": (0.05, 0.08)})
    figure = found.figure("path", size=(600, 400), scale=0.7, dark=True)
    figure.save(tmp_path / "f.svg")
    program(*words, "--out", str(tmp_path / "drawn.svg"))
    assert (tmp_path / "f.svg").read_bytes() == (tmp_path / "drawn.svg").read_bytes()
    assert figure._repr_svg_().startswith("<svg") and found._repr_svg_() == found.figure()._repr_svg_()
    # Without a branch, sized for paper, as PNG; and started at a state, which the picture stores.
    wave.figure(width_mm=85).save(tmp_path / "page.png")
    achilles.orbit(WAVE, from_=wave, e=0.4, continue_="e=0.35:0.45").figure().save(tmp_path / "from.svg")
    for file in ("f.svg", "page.png", "from.svg"):
        assert program("reproduce", str(tmp_path / file)).startswith(f"achilles orbit {WAVE} ")
    assert "--from orbit.json" in program("reproduce", str(tmp_path / "from.svg"))
    with pytest.raises(achilles.InputError, match="no view 'pth'; did you mean 'path'"):
        wave.figure("pth")
    with pytest.raises(achilles.InputError, match="scale: 100 does not lie in"):
        wave.figure(scale=100)


def test_none_is_told():
    with pytest.raises(achilles.NoOrbit, match="^Newton's method converges too slowly: the periodic orbit is not isolated") as problem:
        achilles.orbit("ball_on_floor")
    assert isinstance(problem.value, RuntimeError) and "--" not in str(problem.value)


@pytest.mark.parametrize("words, told", [
    ({"continue_": {"ee": (0, 1)}}, "^continue_ ee=0:1: there is no parameter 'ee'; did you mean 'e'"),
    ({"continue_": "e=0:0.3"}, "the search starts at e = 0.5, outside this range\\nstart inside it, for example with e=0.15"),
    ({"continue_": "e=0.3"}, "a range is expected"),
    ({"shift": {"z": 1}}, "^shift z=1: there is no coordinate 'z'"),
    ({"shift": "x=2*pie"}, "unknown name 'pie'; did you mean 'pi'"),
    ({"from_": "nothing.json"}, "nothing.json: there is no such file"),
    ({"from_": {"q": [1, 2]}}, "from_: v is missing: give a number for each of x, y"),
    ({"from_": {"q": [1, 2], "v": [1]}}, "from_: v needs a finite number for each of x, y, not"),
    ({"from_": {"q": [1, np.nan], "v": [1, 1]}}, "from_: q needs a finite number for each of x, y, not"),
    ({"from_": {"q": [1, 1], "v": [1, 1], "t": np.inf}}, "from_: t: inf does not lie in"),
    ({"reinitialization": "euclidean"}, "they need the kinetic reinitialization"),
    ({"e": 2}, "^e=2: "),
    ({"tolerence": 1e-9}, "there is no value or option 'tolerence'; did you mean 'tolerance'"),
    ({"period": "2*pie"}, "unknown name 'pie'"),
])
def test_what_is_wrong(words, told):
    with pytest.raises(achilles.InputError, match=told) as problem:
        achilles.orbit(WAVE, **words)
    assert "--" not in str(problem.value)


@pytest.mark.parametrize("words, told", [
    ({"continue_": {"e": 0.5}}, "continue_: a dict such as"),
    ({"continue_": {"e": (0.1, 0.9), "b": (0, 1)}}, "continue_: a dict such as"),
    ({"continue_": ("e", 0.1, 0.9)}, "continue_: a dict such as"),
    ({"continue_": {"e": (None, 0.9)}}, "continue_: e: a number or a text"),
    ({"shift": 5}, "shift: a dict such as"),
    ({"shift": {"x": None}}, "shift: x: a number or a text"),
    ({"period": [1]}, "period: a number or a text"),
    ({"from_": 3}, "from_: \"start\", \"end\", a file"),
    ({"from_": {"q": ["a", "b"], "v": [1, 1]}}, "from_: q must be numbers"),
    ({"from_": {"q": [1, 1], "v": [1, 1], "t": "now"}}, "from_: t: a number is expected"),
])
def test_what_is_of_a_wrong_kind(words, told):
    with pytest.raises(TypeError, match=told):
        achilles.orbit(WAVE, **words)


def test_a_value_beyond_its_range_is_told():
    with pytest.warns(achilles.AchillesWarning, match="range"):
        try:
            achilles.orbit(WAVE, from_="start", set={"x": 1000})
        except achilles.NoOrbit:
            pass


def test_the_lock_is_released(counting):
    """Another thread keeps running during a search."""
    seconds, counted = counting(lambda: achilles.orbit("driven_double_pendulum", continue_={"e": (0.1, 0.9)}))
    assert seconds > 0.05 and counted > 5


def test_control_c_ends_a_search():
    """Also while the run before the search is computed, which would take an hour."""
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begin = time.process_time()
    with pytest.raises(KeyboardInterrupt):
        achilles.orbit(WAVE, from_="end", end=1e8, max_impacts=10**9, max_steps=10**9, memory=1e12)
    assert time.process_time() - begin < 4
