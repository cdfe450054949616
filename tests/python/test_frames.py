"""Tables for pandas."""

import io
import subprocess
import sys

import numpy as np
import pandas
import pytest

import achilles


@pytest.mark.parametrize("system", ["ball_on_sine", "block_on_incline", "double_pendulum_two_stops"])
def test_states_are_those_of_the_csv(system):
    run = achilles.simulate(system, end=5)
    frame = run.to_dataframe()
    csv = pandas.read_csv(io.StringIO(run.to_csv()), float_precision="round_trip", keep_default_na=False, na_values=[""])
    assert list(frame) == list(csv) and len(frame) == len(csv) == len(run.t)
    for name in frame:
        if frame[name].dtype == object:
            assert frame[name].tolist() == csv[name].fillna("").tolist(), name
        else:
            assert np.array_equal(frame[name], csv[name].astype(float), equal_nan=True), name
    for i, name in enumerate(run.system.coordinates):
        assert frame[name].to_numpy().tobytes() == (run.q[:, i] + 0.0).tobytes()
        assert frame.attrs["units"].get(name) == run.system.units.get(name)
    assert frame["j"].dtype == int and frame["phase"].isin(["hybrid", "constrained"]).all() and "s" == frame.attrs["units"]["t"]
    assert frame["energy"].dtype == float


def test_states_at_times():
    run = achilles.simulate("ball_on_sine")
    frame = run.to_dataframe([0, 1.5, 20])
    assert frame["t"].tolist() == [0, 1.5, 20] and frame["x"].tolist() == run([0, 1.5, 20]).q[:, 0].tolist()
    assert frame["event"].str.contains("zeno").any() and run.to_dataframe([]).empty
    assert frame["lambda"][1] == 0 and frame["lambda"][2] > 0


def test_events_are_rows():
    run = achilles.simulate("ball_on_sine")
    frame = run.events_to_dataframe()
    assert frame["kind"].tolist() == [event.kind for event in run.events] and frame["t"].tolist() == [e.t for e in run.events]
    impact, zeno = run.events[0], next(event for event in run.events if event.kind == "zeno")
    assert frame["x'"][0] == impact.v_after[0] and frame["y' before"][0] == impact.v_before[1] and frame["y"][0] == impact.q[1]
    row = frame[frame.kind == "zeno"].iloc[0]
    assert [row["zeno_low"], row["zeno_high"]] == zeno.certificate.zeno_time and row["certified"] and row["impacts"] == zeno.impacts
    assert row["x'"] == zeno.v[0] and np.isnan(row["x' before"])
    several = achilles.simulate("double_pendulum_two_stops").events_to_dataframe()
    assert set(several["contact"]) == set(achilles.System("double_pendulum_two_stops").contacts)
    assert list(achilles.simulate("ball_on_floor", end=0.01).events_to_dataframe()) == ["kind", "t"]


def test_a_sweep_is_its_rows():
    sweep = achilles.sweep("ball_on_sine", {"x": (-3, 3, 5), "e": (0.2, 0.4, 2)}, ["x", "zeno_time(1)"])
    frame = sweep.to_dataframe()
    assert list(frame) == ["x(0)", "e", "x", "zeno_time(1)", "outcome"] and len(frame) == 10
    assert frame["x"].tolist() == sweep["x"].ravel().tolist() and frame["e"].tolist() == [0.2, 0.4] * 5
    assert frame.attrs["units"] == {"x(0)": "m", "x": "m", "zeno_time(1)": "s"}


@pytest.mark.parametrize("call, name", [("run.to_dataframe()", "Run.to_dataframe"), ("run.events_to_dataframe()", "Run.events_to_dataframe"),
                                        ("achilles.sweep('ball_on_floor', 'e=0:1:3', 'impacts').to_dataframe()", "Sweep.to_dataframe")])
def test_without_pandas_it_says_what_to_install(call, name):
    code = f"import sys; sys.modules['pandas'] = None\nimport achilles\nrun = achilles.simulate('ball_on_floor', end=1)\n{call}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 1 and f"ImportError: {name} needs pandas: install python3-pandas, or run pip install pandas" in done.stderr
