"""Lagrangian hybrid systems, simulated past their Zeno points.

    import achilles

    run = achilles.simulate("ball_on_sine", values={"e": 0.3, "x'": 1.5}, end=20)
    run.t, run.q, run.v                  # NumPy arrays: every step and every event
    q, v = run(3.2)                      # the state at a time, or at an array of them
    run["y - sin(x)"]                    # any expression of the run, along run.t
    run.events[0].kind, run.certificates # the events, and the certificates
    run.figure("height").save("f.pdf")   # as `achilles figure` draws it; a notebook shows it
    run.html("run.html")                 # a page for a browser: the mechanism in motion, plots, events
    run.to_dataframe()                   # a table for pandas

    map = achilles.sweep("ball_on_sine", over={"e": (0, 0.95, 200)}, quantities="zeno_time(2)")
    map["zeno_time(2)"]                  # an array in the shape of the grid

    orbit = achilles.orbit("ball_down_a_wave", branch={"e": (0.1, 0.9)})
    orbit.period, orbit.multipliers      # a periodic run, and its multipliers
    orbit.branch.value, orbit.branch.q   # the same along a parameter

A system is a name from `achilles list` (`achilles.gallery()`), the path of a file, or a `System` made from text or from SymPy
expressions (`System.from_energies`). Numbers are in the units of the file, angles in radians, times in seconds. Wrong input
raises `InputError`.
"""

from . import _core

_core.look_for_assets_beside(_core.__file__)

from ._errors import AchillesWarning, InputError, NoOrbit
from ._figure import Figure
from ._orbit import Branch, Orbit, orbit
from ._records import Certificate, Event, OrbitPoint, Phase, Record
from ._run import Run, State, simulate
from ._sweep import Sweep, sweep
from ._system import System, gallery

__version__: str = _core.version
__all__ = [
    "AchillesWarning",
    "Branch",
    "Certificate",
    "Event",
    "Figure",
    "InputError",
    "NoOrbit",
    "Orbit",
    "OrbitPoint",
    "Phase",
    "Record",
    "Run",
    "State",
    "Sweep",
    "System",
    "gallery",
    "orbit",
    "simulate",
    "sweep",
]
