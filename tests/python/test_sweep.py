"""Sweeps in Python."""

import csv
import os
import signal
import threading
import time

import numpy as np
import pandas
import pytest

import achilles


def frame(text):
    """Parses CSV output of the program."""
    rows = [row.split(",") for row in text.splitlines()]
    return pandas.DataFrame(rows[1:], columns=rows[0])


def same(numbers, texts):
    return np.array_equal(numbers, [float(text) if text else np.nan for text in texts], equal_nan=True)


def test_a_curve_is_the_programs(program):
    curve = achilles.sweep("ball_on_sine", over={"e": (0, 0.95, 40)}, print=["zeno_time(2)", "held"], end=10)
    table = frame(program("sweep", "ball_on_sine", "--over", "e=0:0.95:40", "--print", "zeno_time(2)", "--print", "held",
                          "--end", "10"))
    assert curve.shape == (40,) and list(curve) == ["zeno_time(2)", "held", "outcome", "e"]
    for name in ("e", "zeno_time(2)"):
        assert same(curve[name], table[name]), name
    assert curve["held"].tolist() == table["held"].tolist() and curve["outcome"].tolist() == table["outcome"].tolist()
    assert curve.units["zeno_time(2)"] == "s" and np.isnan(curve["zeno_time(2)"]).any()
    assert curve.command.startswith("achilles sweep ball_on_sine --over e=0:0.95:40")


def test_a_map_has_the_shape_of_the_grid(program):
    ask = {"x": (-3, 3, 5), "x'": ("log", 0.5, 2, 4)}
    many = achilles.sweep("ball_on_sine", ask, ["x", "impacts"], threads=1)
    table = frame(program("sweep", "ball_on_sine", "--over", "x=-3:3:5", "--over", "x'=log:0.5:2:4", "--print", "x + 0",
                          "--print", "impacts"))
    assert many["x"].shape == (5, 4) and many.axes["x"].shape == (5,) and many.axes["x'"][-1] == 2.0
    assert same(many["x"].ravel(), table["x + 0"]) and same(many["impacts"].ravel(), table["impacts"])
    rows = pandas.DataFrame(many.rows())
    assert list(rows) == ["x(0)", "x'", "x", "impacts", "outcome"] and same(rows["x(0)"], table["x"])
    for threads in (None, 2):
        other = achilles.sweep("ball_on_sine", ask, ["x", "impacts"], threads=threads)
        assert all(other[name].tobytes() == many[name].tobytes() for name in many)


def test_modes_of_friction_are_the_programs(program):
    many = achilles.sweep("block_on_incline", {"mu": (0.2, 1, 5)}, ["modes", "sticks"])
    table = frame(program("sweep", "block_on_incline", "--over", "mu=0.2:1:5", "--print", "modes", "--print", "sticks"))
    assert many["modes"].tolist() == table["modes"].tolist() and set(many["modes"]) == {"incline:slip+", "incline:stick"}
    assert same(many["sticks"], table["sticks"])


def test_the_hdf5_of_the_program_has_the_same_arrays(program, tmp_path):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "map.h5"
    program("sweep", "ball_on_sine", "--over", "x=-3:3:6", "--over", "e=0.1:0.9:5", "--print", "zeno_time(2)", "--print", "held",
            "--hdf5", str(path))
    many = achilles.sweep("ball_on_sine", {"x": (-3, 3, 6), "e": (0.1, 0.9, 5)}, ["zeno_time(2)", "held"])
    with h5py.File(path) as file:
        for name in many.axes:
            assert np.array_equal(file["axes/" + name][:], many.axes[name])
        assert np.array_equal(file["values/zeno_time(2)"][:], many["zeno_time(2)"], equal_nan=True)
        for name in ("held", "outcome"):
            assert file["values/" + name].asstr()[:].tolist() == many[name].tolist()


def test_equal_distances_and_ratios_are_axes():
    by_array = achilles.sweep("ball_on_floor", {"e": np.linspace(0.1, 0.9, 5)}, "zeno_time")
    assert by_array.axes["e"].tolist() == achilles.sweep("ball_on_floor", "e=0.1:0.9:5", "zeno_time").axes["e"].tolist()
    assert "log:" in achilles.sweep("ball_on_floor", {"e": np.geomspace(0.1, 0.9, 5)}, "zeno_time").command
    with pytest.raises(achilles.InputError, match="neither at equal distances nor in equal ratios"):
        achilles.sweep("ball_on_floor", {"e": [0.1, 0.2, 0.5]}, "zeno_time")
    # A ball that starts at rest at height y: t1 = sqrt(2 y / g), and comes to rest at t1 (1 + e)/(1 - e).
    floor = achilles.simulate("ball_on_floor", e=0.5)
    assert achilles.sweep("ball_on_floor", {"e": (0.5, 0.6, 2)}, "zeno_time")["zeno_time"][0] == pytest.approx(
        [event.t for event in floor.events if event.kind == "zeno"][0], abs=1e-8)


def test_random_points_and_sections(program):
    drawn = achilles.sweep("ball_on_sine", {"x": (-1, 1), "e": (0.2, 0.8)}, "zeno_time(1)", random=30, seed=3)
    table = frame(program("sweep", "ball_on_sine", "--over", "x=-1:1", "--over", "e=0.2:0.8", "--random", "30", "--seed",
                          "3", "--print", "zeno_time(1)"))
    assert drawn.shape == (30,) and same(drawn.axes["x"], table["x"]) and same(drawn["zeno_time(1)"], table["zeno_time(1)"])
    section = achilles.sweep("ball_on_vibrating_table", {"om": (5, 15, 5)}, "y'", at="impact", after=2, end=4)
    table = frame(program("sweep", "ball_on_vibrating_table", "--over", "om=5:15:5", "--print", "y'", "--at", "impact",
                          "--after", "2", "--end", "4"))
    assert same(section["t"], table["t"]) and same(section["y'"], table["y'"]) and same(section["om"], table["om"])
    assert section["contact"].tolist() == table["contact"].tolist()


def test_a_run_that_fails_is_a_point():
    with pytest.warns(achilles.AchillesWarning, match="3 of the runs: cannot start; first at y = -3.0"):
        below = achilles.sweep("ball_on_sine", {"y": (-3, 3, 7)}, "t")
    assert below["outcome"][0] == "cannot start" and np.isnan(below["t"][0]) and below["outcome"][-1] == "end time"


def test_the_lock_is_released(counting):
    """Another thread keeps running during a sweep without Python callbacks."""
    seconds, counted = counting(lambda: achilles.sweep("ball_on_sine", {"e": (0.1, 0.9, 20000)}, "zeno_time(2)"))
    assert seconds > 0.05 and counted > 5


def test_progress():
    told = []
    achilles.sweep("ball_on_sine", {"e": (0.1, 0.9, 20000)}, "zeno_time(2)", progress=lambda *words: told.append(words))
    assert told[-1] == (20000, 20000) and told == sorted(told) and all(count == 20000 for _, count in told)


def test_what_progress_raises_ends_it():
    with pytest.raises(ZeroDivisionError):
        achilles.sweep("ball_on_sine", {"e": (0.1, 0.9, 10**8)}, "zeno_time(2)", progress=lambda done, count: 1 / 0)


def test_control_c_ends_it_within_a_chunk():
    threading.Timer(0.4, os.kill, (os.getpid(), signal.SIGINT)).start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        achilles.sweep("ball_on_sine", {"e": (0.1, 0.9, 10**8)}, "zeno_time(2)")
    assert time.monotonic() - begin < 20  # for a busy machine; alone it takes half a second


@pytest.mark.parametrize("over, asked, words, told", [
    ({"ee": (0, 1, 5)}, "t", {}, "^over ee=0:1:5: 'ee' is not a parameter, coordinate or rate of this system; did you mean 'e'"),
    ({"e": (0, 1)}, "t", {}, "the number of values is missing"),
    ({"e": (0, 1, 1)}, "t", {}, "a whole number of at least 2"),
    ({"e": (0, 1, 5)}, "zeno_tim(2)", {}, "zeno_tim"),
    ({"e": (0, 1, 5)}, [], {}, "name at least one quantity to print"),
    ({}, "t", {}, "nothing is varied"),
    ({"e": (0, 1, 5)}, "t", {"threads": 0}, "threads=0: a whole number from 1 to 1024"),
    ({"e": (0, 1, 5)}, "t", {"seed": 4}, "this has an effect only with random N"),
    ({"e": (0, 1, 5)}, "t", {"tolerance": -1}, "tolerance: the value must be positive"),
])
def test_what_is_wrong(over, asked, words, told):
    with pytest.raises(achilles.InputError, match=told) as problem:
        achilles.sweep("ball_on_sine", over, asked, **words)
    assert "--" not in str(problem.value)


@pytest.mark.parametrize("over, asked, words, told", [
    (5, "t", {}, "over: a dict such as"),
    ({"e": 0.5}, "t", {}, "over: e must be"),
    ({"e": (0, None, 3)}, "t", {}, "e: a number or a text such as 'pi/6' is expected, not None"),
    ({"e": (0, 1, 5)}, [3], {}, "print: a text"),
    ({"e": (0, 1, 5)}, "t", {"progress": 3}, "progress: a function"),
])
def test_what_is_of_a_wrong_kind(over, asked, words, told):
    with pytest.raises(TypeError, match=told):
        achilles.sweep("ball_on_sine", over, asked, **words)


def test_derivatives_are_those_of_runs_and_of_the_program(program):
    print = ["zeno_time(1)", "d(zeno_time(1), e)", "d(x, x')"]
    curve = achilles.sweep("ball_on_sine", over={"e": (0.3, 0.5, 3)}, print=print, end=5)
    text = program("sweep", "ball_on_sine", "--over", "e=0.3:0.5:3", *(w for p in print for w in ("--print", p)), "--end", "5")
    rows = list(csv.reader(text.splitlines()))
    assert rows[0] == ["e", *print, "outcome"]
    for k, name in enumerate(print):
        assert same(curve[name], [row[k + 1] for row in rows[1:]]), name
    for e, slope in zip(curve["e"], curve["d(zeno_time(1), e)"]):
        run = achilles.simulate("ball_on_sine", e=e, end=5)
        assert run.derivatives_of("zeno_time(1)")[list(run.derivatives.directions).index("e")] == slope
    assert curve.units["d(zeno_time(1), e)"] == "s" and curve.units["d(x, x')"] == "s"
    with pytest.raises(achilles.InputError, match="'impacts' is a whole number, and has no derivative"):
        achilles.sweep("ball_on_sine", over={"e": (0.3, 0.5, 3)}, print="d(impacts, e)")
