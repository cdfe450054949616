"""When a ball reaches its first Zeno point, over its restitution and its initial speed: a sweep of two values, with matplotlib.

usage: map.py [FILE], FILE map.pdf if it is not given. In a notebook the cells are the parts between # %%.
"""

# %% 60 x 60 runs on all cores. Where a run has no Zeno point, the table has NaN.
import sys

import matplotlib.pyplot as plt
import numpy as np

import achilles

sweep = achilles.sweep("ball_on_sine", over={"e": (0.1, 0.9, 60), "x'": (0.5, 3.0, 60)}, quantities="zeno_time(1)")
times = sweep["zeno_time(1)"]
print(f"{np.isfinite(times).sum()} of {times.size} runs have a Zeno point")

# %% The map. The first axis of the table is e.
speed_unit = sweep.units["x'"]
figure, axes = plt.subplots(figsize=(6, 4.5), constrained_layout=True)
colors = axes.pcolormesh(sweep.axes["e"], sweep.axes["x'"], times.T, shading="nearest", rasterized=True)
figure.colorbar(colors, label=f"first Zeno point [{sweep.units['zeno_time(1)']}]")
axes.set(xlabel="restitution $e$", ylabel=f"initial rate $x'$ [{speed_unit}]")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "map.pdf", dpi=150)
