"""Runs in Python: the same numbers as the program, arrays, events, other threads."""

import copy
import gc
import json
import os
import pickle
import signal
import threading
import time
import warnings

import numpy as np
import pandas
import pytest

import achilles

BALL = {"e": 0.3, "set": {"x'": 1.2}}


def plain(value):
    """Converts a record to the types of json.loads."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, dict):
        return {name: plain(each) for name, each in value.items()}
    return [plain(each) for each in value] if isinstance(value, list) else value


@pytest.mark.filterwarnings("ignore::achilles.AchillesWarning")
def test_it_says_what_the_program_says(program):
    run = achilles.simulate("ball_on_sine", **BALL, end=12, tolerance=1e-9, eps_t=1e-7, method="dopri5")
    text = program("simulate", "ball_on_sine", "--set", "e=0.3", "--set", "x'=1.2", "--end", "12", "--tolerance", "1e-9",
                   "--eps-t", "1e-7", "--method", "dopri5", "--json", "-")
    assert run.to_json() == text
    told = json.loads(text)
    for name in ("events", "phases", "outcome", "end", "start", "options", "statistics", "warnings"):
        assert plain(getattr(run, name)) == told[name], name
    assert run.parameters == told["system"]["parameters"]
    assert run.to_csv() == program("simulate", "ball_on_sine", "--set", "e=0.3", "--set", "x'=1.2", "--end", "12",
                                   "--tolerance", "1e-9", "--eps-t", "1e-7", "--method", "dopri5", "--csv", "-")


def test_the_numbers_are_those_of_reference(source):
    fig4 = json.loads((source / "tests/reference/fig4.json").read_text())
    run = achilles.simulate("ball_on_sine")
    zeno = [event.t for event in run.events if event.kind == "zeno"]
    assert zeno == pytest.approx([2.725142, 12.465775], abs=1e-5)
    assert fig4  # the tests of the laws check the engine itself
    for certificate, t in zip(run.certificates, zeno):
        assert certificate.certified and certificate.zeno_time[0] <= t <= certificate.zeno_time[1]


def test_the_arrays_are_the_rows_of_the_csv(program):
    run = achilles.simulate("double_pendulum", end=8)
    rows = program("simulate", "double_pendulum", "--end", "8", "--csv", "-").splitlines()
    table = pandas.DataFrame([row.split(",") for row in rows[1:]], columns=rows[0].split(","))
    assert run.t.tolist() == table["t"].astype(float).tolist()
    for i, name in enumerate(run.system.coordinates):
        assert run.q[:, i].tolist() == table[name].astype(float).tolist() == run[name].tolist()
        assert run.v[:, i].tolist() == table[name + "'"].astype(float).tolist() == run[name + "'"].tolist()
    assert run.j.tolist() == table["j"].astype(int).tolist()
    assert (run.constrained == (table["phase"] == "constrained")).all()
    assert run["energy"].tolist() == table["energy"].astype(float).tolist()
    assert run["gap"].tolist() == table["gap"].astype(float).tolist()


def test_arrays_look_into_the_run_and_outlive_it():
    run = achilles.simulate("ball_on_sine")
    assert run.q is run.q and not run.q.flags.owndata and not run.q.flags.writeable
    with pytest.raises(ValueError):
        run.t[0] = 1.0
    q, t, kept = run.q, run.t[::7], run.q.copy()
    events = run.events
    del run
    gc.collect()
    for i in range(20):
        achilles.simulate("ball_on_sine", e=0.3 + 0.01 * i).q
    assert (q == kept).all() and t[0] == 0.0 and events[0].kind == "impact"


def test_dense_output_is_vectorised():
    run = achilles.simulate("ball_on_sine")
    times = np.linspace(0, 20, 4321)
    q, v = run(times)
    assert q.shape == v.shape == (4321, 2)
    for i in (0, 17, 2000, 4320):
        one = run(times[i])
        assert one.q.tolist() == q[i].tolist() and one.v.tolist() == v[i].tolist()
    assert run(times[:4320].reshape(3, 1440)).v.tolist() == v[:4320].reshape(3, 1440, 2).tolist()
    assert run([]).q.shape == (0, 2) and run(3).q.shape == (2,) and run(np.float32(3)).q.shape == (2,)
    # Free flight in closed form, until the first impact.
    early = np.linspace(0, run.events[0].t * 0.999, 50)
    assert run(early).q[:, 1] == pytest.approx(2 - early**2 / 2, abs=1e-12)
    # The state after an event.
    impact = run.events[0]
    assert run(impact.t).v.tolist() == impact.v_after.tolist()
    assert run.evaluate("y - sin(x)", times) == pytest.approx(q[:, 1] - np.sin(q[:, 0]), abs=1e-14)


@pytest.mark.parametrize("t, told", [(25, "t = 25.0 is outside the run, 0.0 to 20.0"), ([1, -0.5], "t = -0.5 is outside"),
                                     (float("nan"), "t = nan is outside")])
def test_times_outside_of_the_run(t, told):
    run = achilles.simulate("ball_on_sine")
    for ask in (run, lambda t: run.evaluate("x", t), run.to_csv, run.to_json):
        with pytest.raises(achilles.InputError, match=told):
            ask(t)
    with pytest.raises(TypeError, match="times must be numbers"):
        run("now")


def test_events_are_objects_and_dicts():
    run = achilles.simulate("ball_on_sine")
    table = pandas.DataFrame(run.events)
    assert table["kind"].value_counts()["zeno"] == 2 and table["t"].is_monotonic_increasing
    event = run.events[0]
    assert isinstance(event, dict) and event.t == event["t"] and "impact_speed" in dir(event)
    assert event == copy.deepcopy(event) == pickle.loads(pickle.dumps(event)) != run.events[1]
    with pytest.raises(AttributeError, match="Event has no 'certificate'; it has kind, t"):
        event.certificate
    assert isinstance(run.certificates[0], achilles.Certificate) and isinstance(run.phases[0], achilles.Phase)


@pytest.mark.parametrize("name", ["ball_on_sine", "double_pendulum", "driven_double_pendulum", "rocking_block"])
@pytest.mark.parametrize("conditions", ["sharp", "paper"])
def test_every_entry_of_a_record_is_annotated(name, conditions):
    if name not in achilles.gallery():
        name = "ball_in_bowl"
    if name == "rocking_block" and conditions == "paper":
        pytest.skip("the conditions of the paper do not go with friction")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = achilles.simulate(name, conditions=conditions)
    for record in [*run.events, *run.certificates, *run.phases]:
        assert set(record) <= set(type(record).__annotations__), type(record)


@pytest.mark.parametrize("a, tail", [(0.3, "stick"), (0.45, "slip")])
def test_a_zeno_point_with_friction(a, tail):
    point = achilles.System("""title = "a point on a slope"
coordinate = [{name = "x"}, {name = "y", start = 0.5}]
parameter = [{name = "a", value = 0.3}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y - a*x"
constraint = [{name = "slope", gap = "y", restitution = 0.5, slip = "x'", friction = 0.5}]
""")
    run = achilles.simulate(point, a=a, end=4)
    zeno = next(event for event in run.events if event.kind == "zeno")
    assert zeno.certificate.tail == tail and ("sticks_from" in zeno) == (tail == "stick")
    assert zeno.modes == {"slope": "stick" if tail == "stick" else "slip+"}
    for record in [*run.events, *run.certificates, *run.phases]:
        assert set(record) <= set(type(record).__annotations__), type(record)


def test_the_same_bytes_twice():
    one, other = (achilles.simulate("driven_double_pendulum", e=0.4) for _ in range(2))
    assert one.to_json() == other.to_json() and one.q.tobytes() == other.q.tobytes()
    assert one.figure().svg == other.figure().svg
    assert pickle.loads(pickle.dumps(one)).to_json() == one.to_json()


def test_the_lock_is_released(counting):
    """Another thread keeps running during a run."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        seconds, counted = counting(
            lambda: achilles.simulate("ball_on_egg_crate", end=300, method="dopri5", tolerance=1e-12, memory=1e10))
    assert seconds > 0.1 and counted > 5


def interrupt_after(seconds):
    threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT)).start()


def test_control_c_ends_a_run():
    interrupt_after(0.3)
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        achilles.simulate("ball_on_vibrating_table", end=1e7, max_impacts=10**9, max_steps=10**9, memory=1e11)
    assert time.monotonic() - begin < 20
    assert achilles.simulate("ball_on_floor").outcome.kind == "end time"


def test_a_run_that_stops_early_is_told():
    with pytest.warns(achilles.AchillesWarning, match="the run stopped early: "):
        run = achilles.simulate("ball_on_sine", max_impacts=3)
    assert run.outcome.kind == "too many impacts" and run.t[-1] < 20
    with pytest.raises(achilles.InputError, match=r"outside the run, 0.0 to .* \(the run stopped early: "):
        run(19)
    with pytest.warns(achilles.AchillesWarning, match="range"):
        achilles.simulate("ball_on_sine", set={"x": 1000})


def test_figures(program, tmp_path):
    run = achilles.simulate("ball_on_sine", **BALL)
    figure = run.figure("height", "gap", size=(600, 400), scale=0.7, dark=True)
    assert figure._repr_svg_().startswith("<svg") and figure.svg.endswith(figure._repr_svg_())
    figure.save(tmp_path / "f.svg")
    drawn = tmp_path / "drawn.svg"
    program("figure", "ball_on_sine", "--view", "height", "--view", "gap", "--size", "600x400", "--scale", "0.7", "--dark",
            "--set", "e=0.3", "--set", "x'=1.2", "--out", str(drawn))
    assert drawn.read_bytes() == (tmp_path / "f.svg").read_bytes()
    run.figure(width_mm=85, font_pt=7).save(tmp_path / "page.png")
    assert (tmp_path / "page.png").read_bytes().startswith(b"\x89PNG")
    # The shape of the size arranges the panels of a page.
    achilles.simulate("ball_in_v").figure(size=(600, 1600), width_mm=170).save(tmp_path / "tall.svg")
    assert "--size 600x1600" in program("reproduce", str(tmp_path / "tall.svg"))
    text = achilles.System(run.system.text + "# mine\n")
    achilles.simulate(text, e=0.2).figure("height").save(tmp_path / "mine.pdf")
    for file in ("f.svg", "page.png", "mine.pdf"):
        assert "ball_on_sine" in program("reproduce", str(tmp_path / file)) or file == "mine.pdf"
    with pytest.raises(achilles.InputError, match="no view 'hight'; did you mean 'height'"):
        run.figure("hight")
    with pytest.raises(achilles.InputError, match="size: 10 does not lie in"):
        run.figure(size=(10, 10))
    with pytest.raises(ValueError, match="the name must end in .svg, .png or .pdf"):
        figure.save(tmp_path / "f.jpg")
    with pytest.raises(TypeError, match="size: .width, height. in pixels is expected, such as .1200, 800., not 600"):
        run.figure(size=600)
    with pytest.raises(TypeError, match="scale: a number is expected, not str"):
        run.figure(scale="large")
    with pytest.raises(TypeError, match=r"size: two numbers are expected, not a text; write size=\(800, 600\)"):
        run.figure(size="800x600")
    with pytest.raises(TypeError, match=r"size: \(width, height\) in pixels is expected, such as \(1200, 800\), not 'large'"):
        run.figure(size="large")
    with pytest.raises(TypeError, match=r"size: \(width, height\) in pixels is expected, such as \(1200, 800\), not \(1, 2, 3\)"):
        run.figure(size=(1, 2, 3))
    with pytest.raises(achilles.InputError, match="size: a whole number from 64 to 16384 is expected, not 600.5"):
        run.figure(size=(800, 600.5))
    with pytest.raises(achilles.InputError, match="columns: a whole number from 0 to 20 is expected, not 1.5"):
        run.figure(columns=1.5)
    assert not (tmp_path / "f.jpg").exists()


def test_it_knows_on_what_it_depends(program):
    run = achilles.simulate("ball_on_sine", tolerance=1e-14, eps_q=1e-9, eps_v=1e-9, eps_t=1e-9)
    d = run.derivatives
    told = json.loads(program("simulate", "ball_on_sine", "--tolerance", "1e-14", "--eps-q", "1e-9", "--eps-v", "1e-9",
                              "--eps-t", "1e-9", "--derivatives", "--of", "zeno_time(2)", "--json", "-"))
    assert d.directions == told["derivatives"]["directions"] == ["x", "y", "x'", "y'", "m", "g", "e"]
    assert d.end.q.tolist() == told["end"]["derivatives"]["q"]
    assert d.end.q[0, 0] == pytest.approx(-4.947980848111053, rel=1e-9)  # theory-derivatives.md 11
    assert len(d.events) == len(run.events)
    assert d.events[-1].t.tolist() == told["events"][-1]["derivatives"]["t"]
    assert run.derivatives_of("zeno_time(2)").tolist() == told["derivatives"]["of"][0]["derivatives"]
    with pytest.raises(achilles.InputError, match="zeno_time"):
        run.derivatives_of("zeno_tme(2)")


def test_it_knows_how_wrong_it_is():
    run = achilles.simulate("ball_on_sine")
    estimate = run.error_estimate
    assert 1e-9 < estimate.norm < 1e-8
    assert estimate.reach == 1.5 * estimate.norm + 3 * estimate.sigma
    assert np.linalg.norm(np.concatenate([estimate.q, estimate.v])) == pytest.approx(estimate.norm)
    assert all(event.error_estimate > 0 for event in run.events)
    other = achilles.simulate("ball_on_sine", method="dopri5")
    assert other.error_estimate is None and "Taylor" in other.end.no_error_estimate


def test_trusted_until_is_the_horizon():
    run = achilles.simulate("ball_on_sine")
    assert run.trusted_until == run.end.t == json.loads(run.to_json())["trusted_until"]
    chaotic = achilles.simulate("ball_on_vibrating_table", e=0.9, end=60)
    assert 10 < chaotic.trusted_until < 30 and chaotic.warnings[0].startswith("trusted until t = ")
    assert achilles.simulate("ball_on_sine", method="dopri5").trusted_until is None
