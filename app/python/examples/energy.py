"""The energy of a bouncing ball, from tables of a run and of its events (pandas), with matplotlib.

usage: energy.py [FILE], FILE energy.pdf if it is not given. In a notebook the cells are the parts between # %%.
"""

# %% A run as a table, and its events as another.
import sys

import matplotlib.pyplot as plt

import achilles

run = achilles.simulate("ball_on_sine", values={"e": 0.6})
states, events = run.to_dataframe(), run.events_to_dataframe()
print(events[events.kind == "zeno"][["t", "x", "y", "impacts", "zeno_low", "zeno_high"]].to_string(index=False))

# %% Energy over time: it falls at impacts, and is constant between them. The ball rests where the background is gray.
figure, axes = plt.subplots(figsize=(7, 3.5), constrained_layout=True)
for phase in run.phases:
    if phase.held:
        axes.axvspan(phase.start, phase.end, color="0.92", lw=0)
axes.plot(states.t, states.energy, "C0-", lw=1.2)
impacts = events[events.kind == "impact"].t
axes.plot(impacts, run.evaluate("energy", impacts), "s", ms=3, color="C3", label="after an impact")
axes.set(xlabel="$t$ [s]", ylabel=f"energy [{states.attrs['units']['energy']}]", title=run.system.title)
axes.legend(frameon=False)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "energy.pdf", dpi=150)
