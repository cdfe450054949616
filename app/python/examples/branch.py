"""A periodic orbit followed in a parameter, with matplotlib: period, and the multipliers that decide its stability.

usage: branch.py [FILE], FILE branch.pdf if it is not given. In a notebook the cells are the parts between # %%.
"""

# %% The orbit, and its branch in b.
import sys

import matplotlib.pyplot as plt
import numpy as np

import achilles

orbit = achilles.orbit("ball_down_a_wave", values={"e": 0.3}, branch={"b": (0.05, 0.08)})
branch = orbit.branch
print(orbit)

# %% Solid where the orbit is stable. A period doubles where a multiplier is -1.
figure, (above, below) = plt.subplots(2, sharex=True, figsize=(6, 5), constrained_layout=True)
sizes = np.abs(branch.multipliers[:, 1 : branch.multipliers.shape[1] - orbit.zero_multipliers])
for axes, curve in (above, branch.period), (below, sizes[:, 0]):
    axes.plot(branch.value, np.where(branch.stable, curve, np.nan), "C0-", label="stable")
    axes.plot(branch.value, np.where(branch.stable, np.nan, curve), "C0--", label="unstable")
below.axhline(1, color="0.6", lw=0.8)
for point in branch.flips:
    above.plot(point.value, point.period, "o", color="C3", label="period doubling")
above.set(ylabel="period [s]")
below.set(xlabel=f"${branch.parameter}$", ylabel="size of the largest multiplier")
above.legend(frameon=False)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "branch.pdf", dpi=150)
