"""Fig. 4 of the paper (Or and Ames, 2009) with matplotlib: the ball on a sinusoidal surface, the double pendulum.

usage: figure4.py [FILE], FILE figure4.pdf if it is not given. In a notebook the cells are the parts between # %%.
"""

# %% The two runs.
import sys

import matplotlib.pyplot as plt
import numpy as np

import achilles

ball = achilles.simulate("ball_on_sine")
pendulum = achilles.simulate("double_pendulum")
for run in (ball, pendulum):
    zeno = [event.t for event in run.events if event.kind == "zeno"]
    print(f"{run.system.title}: Zeno points at {', '.join(f'{t:.6f}' for t in zeno)} s")


# %% Hybrid phases are dashed, constrained ones solid; squares are impacts.
def plot(axes, run, x, y, factor=1.0):
    for phase in run.phases:
        t = np.linspace(phase.start, phase.end, 2000)
        axes.plot(run.evaluate(x, t), factor * run.evaluate(y, t), "C0-" if phase.held else "C0--", lw=1)
    t = [event.t for event in run.events if event.kind == "impact"]
    axes.plot(run.evaluate(x, t), factor * run.evaluate(y, t), "s", ms=2.5, color="C3")


# %% The six panels.
figure, panels = plt.subplots(3, 2, figsize=(7, 7), constrained_layout=True)
degrees = 180 / np.pi
for axes, letter, run, x, y, factor, label in zip(
    panels.flat, "abcdef", [ball] * 4 + [pendulum] * 2, ["t", "t", "t", "x", "t", "t"],
    ["x", "y", "gap", "y", "theta1", "theta2"], [1, 1, 1, 1, degrees, degrees],
    ["$x$ [m]", "$y$ [m]", "$h$ [m]", "$y$ [m]", r"$\theta_1$ [°]", r"$\theta_2$ [°]"],
):
    plot(axes, run, x, y, factor)
    axes.set(title=f"({letter})", xlabel="$t$ [s]" if x == "t" else "$x$ [m]", ylabel=label)
x = np.linspace(*panels[1, 1].get_xlim(), 1000)
panels[1, 1].plot(x, np.sin(x), "0.6", lw=0.8, zorder=0)
panels[1, 1].set_aspect("equal", adjustable="datalim")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "figure4.pdf", dpi=150)
